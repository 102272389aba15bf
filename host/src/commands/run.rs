//! `meniscus run [CONFIG|PRESET] …`

use super::machinery::MachineryArguments;
use super::progress::Progress;
use super::stop::StopSignal;
use super::{CommandError, Reporter, Source, Verdict};
use crate::configuration::Start;
use crate::run::{GOLDEN_INTERVAL, GoldenRequest, Outcome, Run, Stop};
use crate::simulation::Simulation;
use crate::start::overlap_line;
use crate::strengths::{Strengths, all_one};
use meniscus_core::units::time_from_units;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// Directory for the results; it must be new or empty. By default one below `runs`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Seed of start and noise, 0 to 2^63 - 1.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// When to end, in Jeans' times (in R0^2/D without attraction).
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    until: Option<f64>,
    #[command(flatten)]
    wall_time: WallTime,
    #[command(flatten)]
    machinery: MachineryArguments,
    /// Where to write the golden file, which must not exist, instead of `golden.toml` in the directory.
    #[arg(long, value_name = "FILE")]
    golden: Option<PathBuf>,
    /// Steps between golden records.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..), default_value_t = GOLDEN_INTERVAL)]
    every: u64,
}

/// `--max-wall`.
#[derive(Debug, clap::Args)]
pub(super) struct WallTime {
    /// Stop after this many seconds of wall time, a checkpoint written by then.
    #[arg(long, value_name = "S", value_parser = wall_time, allow_negative_numbers = true)]
    max_wall: Option<Duration>,
}

impl WallTime {
    /// When the wall time is over, as of now.
    pub(super) fn deadline(&self) -> Option<Instant> {
        self.max_wall.and_then(|limit| Instant::now().checked_add(limit))
    }
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let deadline = arguments.wall_time.deadline();
    let seed = arguments.seed.map(|seed| format!("seed={seed}"));
    let until = arguments.until.map(|until| format!("time.until={}", toml_edit::Value::from(until)));
    let configuration = arguments.source.read(seed.into_iter().chain(until))?;
    let directory = match &arguments.out {
        Some(directory) => directory.clone(),
        None => free_directory(arguments.source.name(), configuration.seed),
    };
    let golden = match &arguments.golden {
        Some(path) => GoldenRequest { path: path.clone(), every: arguments.every },
        None => GoldenRequest { every: arguments.every, ..GoldenRequest::in_directory(&directory) },
    };
    let simulation = Simulation::with_machinery(configuration, arguments.machinery.read()?)?;
    announce(&simulation, &directory, reporter);
    // A run that is stopped before its first step has a checkpoint too.
    let stop = StopSignal::catch()?;
    let run = Run::create(simulation, &directory, golden)?.until(deadline);
    go(run, &stop, reporter)
}

/// Runs to the end, or until somebody stops it, and tells how it ended. Whoever stops it twice has the checkpoint
/// nevertheless.
pub(super) fn go(run: Run, stop: &StopSignal, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let first_step = run.simulation().engine.clock().step;
    let mut progress = Progress::new(run.simulation(), reporter);
    let begun = Instant::now();
    let outcome = run.to_end(|simulation| {
        progress.show(simulation, reporter);
        stop.is_raised().then_some(Stop::Interrupted)
    });
    progress.finish();
    let outcome = outcome?;
    let seconds = begun.elapsed().as_secs_f64();
    let steps = outcome.clock.step - first_step;
    reporter.detail(&format!("{steps} steps in {seconds:.1} s, {:.0} steps/s", steps as f64 / seconds));
    conclude(&outcome, reporter)?;
    Ok(Verdict::Ok)
}

/// Tells what is about to be run.
pub(super) fn announce(simulation: &Simulation, directory: &Path, reporter: &Reporter<'_>) {
    let configuration = &simulation.configuration;
    let system = &configuration.system;
    reporter.detail(&format!(
        "{} discs in a box of {} R0, V0 = {} kBT, lambda = {} R0, seed {}",
        system.particles, system.side, system.capillary_strength, system.capillary_length, configuration.seed
    ));
    reporter.detail(&configuration.scheme_line());
    if let Some(line) = configuration.mesh_refresh_line() {
        reporter.note(&line);
    }
    if let (Start::File { path, .. }, true) = (&configuration.start, system.repulsion)
        && let Some(line) = overlap_line(path, &simulation.torus, &simulation.engine.positions())
    {
        reporter.note(&line);
    }
    let (strengths, count) = (&configuration.strengths, system.particles);
    if !all_one(strengths.repeated()) {
        let whose = match strengths {
            Strengths::Pattern(_) => "the configuration",
            Strengths::OfFile(_) => "the start's file",
        };
        reporter
            .detail(&format!("capillary strengths f of {whose}, <f^2> = {}", strengths.mean_square(count)));
    }
    if let Some(jeans) = configuration.jeans_time() {
        let seconds = configuration.seconds_per_time_unit().map(|unit| format!(" = {:.0} s", jeans * unit));
        reporter.detail(&format!("Jeans' time T = {jeans:.4} R0^2/D{}", seconds.unwrap_or_default()));
    }
    reporter.note(&format!("results in {}", directory.display()));
}

/// Tells how the run ended; if early, how to go on.
pub(super) fn conclude(outcome: &Outcome, reporter: &mut Reporter<'_>) -> std::io::Result<()> {
    if let Some(stop) = outcome.stop {
        let why = match stop {
            Stop::Interrupted => "interrupted",
            Stop::WallTime => "the wall time is over",
        };
        let directory = quoted(&outcome.directory.display().to_string());
        reporter.note(&format!("{why}; to go on: meniscus resume {directory}"));
    }
    if let Some(reuse) = outcome.mesh_reuse {
        let error = reuse.error().map_or("nothing to compare".to_owned(), |error| {
            format!(
                "rms error of a force as old as it got {error:.1e}, relative to the rms force of the mesh"
            )
        });
        reporter.note(&format!(
            "force.mesh_refresh: {} transforms in {} steps, {:.1} % saved; {error}",
            reuse.transforms,
            reuse.steps,
            100.0 * reuse.saved()
        ));
    }
    let (step, time) = (outcome.clock.step, time_from_units(outcome.clock.time));
    let (length, digest) = (outcome.digest.length, outcome.digest);
    reporter.text(&format!("step {step}, t = {time} R0^2/D, {length} bytes, digest {digest}\n"))?;
    reporter.json(|| {
        serde_json::json!({
            "directory": outcome.directory.display().to_string(),
            "ended": outcome.stop.map_or("finished", Stop::word),
            "step": step,
            "time": time,
            "length": length,
            "digest": digest.to_string(),
        })
    })
}

/// A word as a shell reads it back.
pub(super) fn quoted(word: &str) -> String {
    let plain = |character: char| character.is_ascii_alphanumeric() || "/._-+,:=@%".contains(character);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// The first of `runs/NAME-seed-N`, `runs/NAME-seed-N-2`, … that does not exist.
fn free_directory(name: &str, seed: u64) -> PathBuf {
    let base = format!("{name}-seed-{seed}");
    let names = std::iter::once(base.clone()).chain((2_u64..).map(|number| format!("{base}-{number}")));
    let mut paths = names.map(|name| Path::new("runs").join(name));
    paths.find(|path| !path.exists()).unwrap_or_else(|| Path::new("runs").join(base))
}

fn wall_time(text: &str) -> Result<Duration, String> {
    text.parse()
        .ok()
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected a number of seconds of at least 0".into())
}
