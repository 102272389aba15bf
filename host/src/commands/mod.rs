//! The command line: one file a command, each from parsed arguments to an exit code.
//!
//! Exit codes: 0 ok, 1 a comparison failed, 2 an error (one line on standard error; of arguments clap's several); a closed pipe changes none of them.

mod analyze;
mod convert;
mod digest;
mod drawing;
mod ensemble;
mod forces;
mod machinery;
mod members;
mod plot;
mod presets;
mod progress;
mod reporter;
mod reproduce;
mod resume;
mod run;
mod stop;
mod verify;

use crate::configuration::{Configuration, ConfigurationError};
use crate::engine::EngineError;
use crate::ensemble::EnsembleError;
use crate::figures::FigureError;
use crate::figures::tables::TablesError;
use crate::files::FileError;
use crate::golden::GoldenError;
use crate::observables::series::SeriesError;
use crate::reproduce::ReproduceError;
use crate::run::RunError;
use crate::simulation::SimulationError;
use clap::{Args, Parser, Subcommand};
use meniscus_core::torus::{LARGEST_SIDE, SMALLEST_SIDE};
use reporter::{Reporter, Reporting, say};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use thiserror::Error;

/// Brownian dynamics of discs at a fluid interface, with the same bits everywhere.
#[derive(Debug, Parser)]
#[command(name = "meniscus", version, max_term_width = 100)]
struct Arguments {
    #[command(flatten)]
    reporting: Reporting,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run a simulation: by default Table I of the paper to five Jeans' times.
    Run(run::Arguments),
    /// Go on with a run that was stopped, from its newest checkpoint, as if it had not been.
    Resume(resume::Arguments),
    /// Print the force on every disc of a file of positions: `id,x,y,fx,fy` in R0 and kBT/R0.
    Forces(forces::Arguments),
    /// Write a file of positions or a trajectory in another format.
    Convert(convert::Arguments),
    /// Write tables of observables of a trajectory, as `run` does on the way.
    Analyze(analyze::Arguments),
    /// Print length and SHA-256 of a state: of a run's directory, of a state file, or of a trajectory.
    Digest(digest::Arguments),
    /// Repeat a golden run and compare.
    Verify(verify::Arguments),
    /// Run a sweep, seeds times values of keys, over all processors, and gather tables of means and errors.
    Ensemble(ensemble::Arguments),
    /// Draw the tables of a run or an ensemble: clusters, energies, Minkowski functionals, modes and others.
    Plot(plot::Arguments),
    /// Make figures of the paper again, with error bars, and a report of what it says and what is found.
    Reproduce(reproduce::Arguments),
    /// List the presets, or print one as a complete configuration.
    Presets(presets::Arguments),
}

/// Which configuration, with what changed.
#[derive(Debug, Args)]
struct Source {
    /// A configuration file, or the name of a preset (see `meniscus presets`).
    #[arg(value_name = "CONFIG|PRESET", default_value = "table-1")]
    configuration: String,
    #[command(flatten)]
    overrides: Overrides,
}

/// Changes to a configuration.
#[derive(Debug, Args)]
struct Overrides {
    /// Set a key of the configuration, for example `--set mesh.assignment=cic`.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Why a command failed.
#[derive(Debug, Error)]
enum CommandError {
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
    #[error("{campaign}, member {index}: {reason}")]
    Reproduction { campaign: String, index: usize, reason: String },
    #[error(transparent)]
    Golden(#[from] GoldenError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
    #[error("{failed} of {members} members failed; the first is member {index}: {reason}")]
    Members { failed: usize, members: usize, index: usize, reason: String },
    #[error(transparent)]
    Figure(#[from] FigureError),
    #[error(transparent)]
    Tables(#[from] TablesError),
    #[error(
        "--threads {threads}: --engine core takes one thread; leave --threads out, or take --engine host"
    )]
    CoreThreads { threads: u16 },
    #[error("--box {side}: a box has a side of {SMALLEST_SIDE} to {LARGEST_SIDE} R0")]
    Side { side: f64 },
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(
        "--series radii: which discs belong together is not known: give --width W for shells of W R0, or by --configuration \
         that of a run that starts from rings or a disc"
    )]
    Groups,
    #[error(
        "{}: {key} is {found}, that of the configuration {configured}: name the run's own with --configuration",
        path.display()
    )]
    OtherSystem { path: PathBuf, key: &'static str, found: f64, configured: f64 },
    #[error("{}: this is a file: name the directory that it is in", .0.display())]
    OneTable(PathBuf),
    #[error("{}: this directory holds no tables itself; name one in it that does: {names}", directory.display())]
    TablesInside { directory: PathBuf, names: String },
    #[error("--thresholds: found {above} after {below}, expected increasing numbers")]
    Thresholds { below: f64, above: f64 },
    #[error("{}: this file exists: name {another}, or remove it", path.display())]
    Exists { path: PathBuf, another: &'static str },
    #[error("interrupted: nothing was written to {}", path.display())]
    Interrupted { path: PathBuf },
    #[error(
        "interrupted: the report and the figures in {} are as they were; the same command goes on, with --out {}",
        .0.display(),
        run::quoted(&.0.display().to_string())
    )]
    NoReport(PathBuf),
    #[error("Ctrl-C cannot be caught: {0}")]
    Signal(std::io::Error),
    #[error("{}: there is no final.state in this directory; name a run's directory or a file", .0.display())]
    NoState(PathBuf),
    #[error("{}: there is no config.toml in this directory; name a run's directory, or a trajectory", .0.display())]
    NoRun(PathBuf),
    #[error("{}: {found}; a golden file needs at least one record", path.display())]
    GoldenRecords { path: PathBuf, found: &'static str },
    #[error("--stages {step}: the run begins after step {start}; name a later step")]
    StageBeforeStart { step: u64, start: u64 },
    #[error("standard output cannot be written: {0}")]
    Output(#[from] std::io::Error),
}

/// How a command that did not fail ended.
enum Verdict {
    Ok,
    Different,
}

/// Parses the command line and does what it says.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    stop::outlive_limits_of_files();
    let output = &mut std::io::stdout().lock();
    let reporter = &mut Reporter::new(arguments.reporting, output);
    let result = match &arguments.command {
        Command::Run(arguments) => run::run(arguments, reporter),
        Command::Resume(arguments) => resume::run(arguments, reporter),
        Command::Forces(arguments) => forces::run(arguments, reporter),
        Command::Convert(arguments) => convert::run(arguments, reporter),
        Command::Analyze(arguments) => analyze::run(arguments, reporter),
        Command::Digest(arguments) => digest::run(arguments, reporter),
        Command::Verify(arguments) => verify::run(arguments, reporter),
        Command::Ensemble(arguments) => ensemble::run(arguments, reporter),
        Command::Plot(arguments) => plot::run(arguments, reporter),
        Command::Reproduce(arguments) => reproduce::run(arguments, reporter),
        Command::Presets(arguments) => presets::run(arguments, reporter),
    };
    match result {
        Ok(Verdict::Ok) => ExitCode::SUCCESS,
        Ok(Verdict::Different) => ExitCode::from(1),
        Err(error) => {
            say(&format!("error: {error}"));
            ExitCode::from(2)
        }
    }
}

impl Source {
    /// Reads the configuration, `more` being further overrides.
    fn read(&self, more: impl IntoIterator<Item = String>) -> Result<Configuration, ConfigurationError> {
        let overrides: Vec<String> = self.overrides.set.iter().cloned().chain(more).collect();
        Configuration::from_argument(&self.configuration, &overrides)
    }

    /// The configuration's name, for a directory.
    fn name(&self) -> &str {
        Path::new(&self.configuration).file_stem().and_then(|name| name.to_str()).unwrap_or("run")
    }
}
