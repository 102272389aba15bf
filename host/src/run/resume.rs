//! Going on with a run from its newest checkpoint.

use super::directory::{self, CONFIGURATION, Directory};
use super::lock::Lock;
use super::manifest::Ending;
use super::progress::Progress;
use super::{Checkpoints, GoldenRequest, Outcome, Run, RunError, Schedule};
use crate::checkpoint::{Checkpoint, store};
use crate::configuration::Configuration;
use crate::engine::Machinery;
use crate::files::FileError;
use crate::files::state::State;
use crate::golden::Golden;
use crate::simulation::Simulation;
use meniscus_core::units::time_from_units;
use std::path::Path;
use std::time::{Duration, Instant};

/// Keys that may differ from those of the checkpoint: they change no step.
const FREE_KEYS: [&str; 3] = ["time.until", "output.checkpoint_steps", "output.checkpoint_minutes"];

/// A run that was found in a directory.
#[derive(Debug)]
pub enum Resumed {
    /// It can go on.
    Ready {
        /// The run.
        run: Box<Run>,
        /// What somebody should know: checkpoints that were refused, files that were missing.
        warnings: Vec<String>,
    },
    /// It has finished; nothing was changed.
    Finished(Box<Outcome>),
}

impl Run {
    /// Goes on with the run in `directory` from its newest whole checkpoint: the same run to the last bit, whatever the
    /// machinery. Its files are cut to where they were then. `until` is another end, in the unit of `time.until`, which
    /// takes the place of that in `config.toml`.
    ///
    /// # Errors
    /// A [`RunError`]; nothing was changed then, unless it was writing that failed.
    pub fn resume(directory: &Path, machinery: Machinery, until: Option<f64>) -> Result<Resumed, RunError> {
        // Where there is no checkpoint, no lock is to be left.
        if ![store::CURRENT, store::PREVIOUS].iter().any(|name| directory.join(name).exists()) {
            store::latest(directory)?;
        }
        let lock = Lock::take(directory)?;
        let latest = store::latest(directory)?;
        let mut warnings: Vec<String> = latest.warnings().collect();
        let (path, checkpoint) = (latest.path, latest.checkpoint);
        let progress = read_progress(&path, &checkpoint)?;

        let configuration = configuration(directory, &path, &checkpoint, until, &mut warnings)?;
        let simulation = simulation(&path, &checkpoint, configuration, &progress, machinery)?;
        let clock = simulation.engine.clock();
        let golden_request = GoldenRequest::resumed(directory, &progress.golden);
        let outcome = Outcome {
            stop: None,
            clock,
            digest: simulation.engine.state().digest(),
            mesh_reuse: simulation.engine.mesh_reuse(),
            directory: directory.to_owned(),
        };
        if clock.time >= simulation.end() {
            refuse_the_past(directory, &path, &checkpoint, &simulation)?;
            if directory::is_finished(directory, &outcome) {
                return Ok(Resumed::Finished(Box::new(outcome)));
            }
        }
        let golden = read_golden(&golden_request, &simulation.configuration, progress.golden.records)?;

        let (output, scale) = (&simulation.configuration.output, simulation.configuration.time_scale());
        let schedule = |interval: f64, next| Schedule::resumed(interval * scale, next);
        let run = Self {
            directory: Directory::resume(directory, lock, &simulation, &progress)?,
            golden,
            golden_request,
            golden_written: None,
            trajectory: schedule(output.trajectory, progress.trajectory.next),
            snapshots: schedule(output.snapshots, progress.snapshots.next),
            checkpoints: Checkpoints {
                written: progress.checkpoints,
                step: clock.step,
                at: Instant::now(),
                took: Duration::ZERO,
            },
            deadline: None,
            simulation,
        };
        run.write_manifest(Ending::Running)?;
        Ok(Resumed::Ready { run: Box::new(run), warnings })
    }
}

fn read_progress(path: &Path, checkpoint: &Checkpoint) -> Result<Progress, RunError> {
    let foreign = |reason: String| RunError::Foreign { path: path.to_owned(), reason };
    let text = &checkpoint.progress;
    let value: serde_json::Value = serde_json::from_str(text).map_err(|error| foreign(error.to_string()))?;
    // Another version may say other things.
    match value["version"].as_str() {
        Some(version) if version != env!("CARGO_PKG_VERSION") => {
            Err(RunError::Version { path: path.to_owned(), found: version.to_owned() })
        }
        _ => Progress::from_text(text).map_err(|error| foreign(error.to_string())),
    }
}

/// The configuration to go on with: that of `config.toml`, which has to be the checkpoint's.
fn configuration(
    directory: &Path,
    path: &Path,
    checkpoint: &Checkpoint,
    until: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<Configuration, RunError> {
    let overrides: Vec<String> =
        until.map(|until| format!("time.until={}", toml_edit::Value::from(until))).into_iter().collect();
    let name = format!("{}: configuration", path.display());
    let recorded = Configuration::from_text(&name, &checkpoint.configuration, &[])?;
    let written = directory.join(CONFIGURATION);
    if !written.exists() {
        let warning = format!("{}: missing, written again from the checkpoint", written.display());
        warnings.push(warning);
        return Ok(Configuration::from_text(&name, &checkpoint.configuration, &overrides)?);
    }
    let configuration = Configuration::read(&written, &overrides)?;
    match configuration.difference(&recorded, &FREE_KEYS) {
        None => Ok(configuration),
        Some((key, [found, expected])) => {
            let said = |value: Option<String>| value.unwrap_or_else(|| "nothing".to_owned());
            Err(RunError::Mismatch { path: written, key, found: said(found), expected: said(expected) })
        }
    }
}

/// The run as it stood.
fn simulation(
    path: &Path,
    checkpoint: &Checkpoint,
    configuration: Configuration,
    progress: &Progress,
    machinery: Machinery,
) -> Result<Simulation, RunError> {
    let state = State::from_bytes(&checkpoint.state)
        .map_err(|problem| RunError::State { path: path.to_owned(), problem })?;
    if state.positions.len() != configuration.system.particles {
        return Err(RunError::Unlike(path.to_owned()));
    }
    let failed = |source| RunError::Simulation { path: path.to_owned(), source: Box::new(source) };
    let mut simulation = Simulation::at(configuration, state, machinery).map_err(failed)?;
    simulation.engine.count_crossings_from(&checkpoint.crossings)?;
    simulation.engine.count_mesh_reuse_from(progress.mesh_reuse);
    let mut bytes = Vec::with_capacity(checkpoint.state.len());
    simulation.engine.state().write(|part| bytes.extend_from_slice(part));
    if bytes == checkpoint.state { Ok(simulation) } else { Err(RunError::Unlike(path.to_owned())) }
}

/// Refuses an end that the run had not been meant to have when it passed it.
fn refuse_the_past(
    directory: &Path,
    path: &Path,
    checkpoint: &Checkpoint,
    simulation: &Simulation,
) -> Result<(), RunError> {
    let recorded = Configuration::from_text(&path.display().to_string(), &checkpoint.configuration, &[])?;
    let until = simulation.configuration.time.until;
    if recorded.time.until == until {
        return Ok(());
    }
    let clock = simulation.engine.clock();
    let now = time_from_units(clock.time) / simulation.configuration.time_scale();
    Err(RunError::Past { directory: directory.to_owned(), until, now, step: clock.step })
}

/// The golden file with its first `records` records.
fn read_golden(
    request: &GoldenRequest,
    configuration: &Configuration,
    records: usize,
) -> Result<Golden, RunError> {
    if !request.path.exists() {
        return Err(RunError::Gone(request.path.clone()));
    }
    let mut golden = Golden::read(&request.path)?;
    if golden.records.len() < records {
        return Err(RunError::Lost(FileError::Extent {
            path: request.path.clone(),
            found: format!("{} records", golden.records.len()),
            expected: format!("{records} records"),
        }));
    }
    golden.records.truncate(records);
    golden.configuration = configuration.to_toml();
    Ok(golden)
}
