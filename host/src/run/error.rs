//! Why a run could not be made.

use crate::checkpoint::store::LatestError;
use crate::configuration::ConfigurationError;
use crate::engine::EngineError;
use crate::files::FileError;
use crate::files::state::StateError;
use crate::golden::GoldenError;
use crate::observables::series::SeriesError;
use crate::simulation::SimulationError;
use crate::snapshot::SnapshotError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a run could not be made.
#[derive(Debug, Error)]
pub enum RunError {
    /// The directory has something in it that a run would overwrite.
    #[error("{}: the directory is not empty; name another with --out, or remove it", .0.display())]
    NotEmpty(PathBuf),
    /// Another run is at work in the directory.
    #[error("{}: another run is at work in this directory; wait until it has ended, or stop it", .0.display())]
    Locked(PathBuf),
    /// The golden file is there already.
    #[error("{}: this golden file exists; `meniscus verify` compares with it, or name another with --golden", .0.display())]
    GoldenExists(PathBuf),
    /// The golden file cannot be where it is asked for.
    #[error("{}: the golden file cannot be here: {reason} with --golden", path.display())]
    GoldenPlace {
        /// The golden file.
        path: PathBuf,
        /// Why not, and what to do.
        reason: &'static str,
    },
    /// A file or directory could not be made or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A picture could not be made.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// How far the run has come could not be put in words.
    #[error("the progress of the run cannot be written: {0}")]
    Progress(#[from] serde_json::Error),
    /// Writing failed under way.
    #[error(
        "{source}; when that is mended, `meniscus resume {}` goes on from the checkpoint at step {step}",
        directory.display()
    )]
    Unwritten {
        /// What failed.
        source: Box<RunError>,
        /// The run's directory.
        directory: PathBuf,
        /// Step of the newest checkpoint.
        step: u64,
    },
    /// A file was removed while the run was writing it.
    #[error(
        "{}: the file was removed or replaced while the run was writing it; put it back and resume, or go on from \
         final.state in another directory by `start.kind=file`", .0.display()
    )]
    Removed(PathBuf),
    /// A file was cut or written to by somebody else while the run was writing it.
    #[error(
        "{}: found {found} bytes, the run has written {expected}: the file was changed while the run was writing it; put \
         the whole file back and resume, or go on from final.state in another directory by `start.kind=file`",
        path.display()
    )]
    Changed {
        /// The file.
        path: PathBuf,
        /// Its length, bytes.
        found: u64,
        /// The length it should have, bytes.
        expected: u64,
    },
    /// The run failed, and what it had come to could not be written.
    #[error("{}; and the last state could not be written: {}", .0[0], .0[1])]
    Both(Box<[RunError; 2]>),
    /// A step was refused. The state before it has been written.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// There is no checkpoint to go on from.
    #[error(transparent)]
    Checkpoint(#[from] LatestError),
    /// The configuration cannot be read.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The configuration is not the one that the checkpoint was written with.
    #[error(
        "{}: {key}: found {found}, the checkpoint was written with {expected}: put that back, or begin a new run with \
         `meniscus run`", path.display()
    )]
    Mismatch {
        /// The configuration.
        path: PathBuf,
        /// The first key that differs.
        key: &'static str,
        /// Its value, as TOML.
        found: String,
        /// Its value in the checkpoint.
        expected: String,
    },
    /// The checkpoint was written by another version of this program, whose bits may be others.
    #[error(
        "{}: written by meniscus {found}, this is {}: resume with that version", path.display(), env!("CARGO_PKG_VERSION")
    )]
    Version {
        /// The checkpoint.
        path: PathBuf,
        /// The version that wrote it.
        found: String,
    },
    /// The checkpoint does not say how far the run had come.
    #[error("{}: the section PROG cannot be read ({reason}): resume with the program that wrote it", path.display())]
    Foreign {
        /// The checkpoint.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The state of the checkpoint is none.
    #[error("{}: {problem}", path.display())]
    State {
        /// The checkpoint.
        path: PathBuf,
        /// What is wrong with it.
        problem: StateError,
    },
    /// The run cannot be brought to life where it stood.
    #[error("{}: {source}", path.display())]
    Simulation {
        /// The checkpoint.
        path: PathBuf,
        /// Why not.
        source: Box<SimulationError>,
    },
    /// State and configuration of the checkpoint do not belong together.
    #[error("{}: its state is not one of a run of its configuration: begin the run anew", .0.display())]
    Unlike(PathBuf),
    /// A file that the run was writing is not there.
    #[error("{}: the file is gone; put it back, or begin the run anew in another directory", .0.display())]
    Gone(PathBuf),
    /// The checkpoint does not tell of a table that the configuration asks for.
    #[error(
        "{}: the checkpoint does not tell of the series {series}, which config.toml asks for: begin the run anew", directory.display()
    )]
    NoTable {
        /// The run's directory.
        directory: PathBuf,
        /// The series.
        series: &'static str,
    },
    /// A series cannot be made.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// The state at the start is another than when the run began.
    #[error("{}: not the state that the run began with; put the file back, or begin the run anew", .0.display())]
    Start(PathBuf),
    /// A file has less in it than when the checkpoint was written.
    #[error("{0}; put the whole file back, or begin the run anew in another directory")]
    Lost(FileError),
    /// The golden file cannot be read.
    #[error(transparent)]
    Golden(#[from] GoldenError),
    /// The run has come further than it is to go.
    #[error(
        "{}: time.until = {until}: the run is at {now} already (step {step}); name a later end", directory.display()
    )]
    Past {
        /// The run's directory.
        directory: PathBuf,
        /// The end asked for, in the unit of `time.until`.
        until: f64,
        /// Where the run is.
        now: f64,
        /// Steps done.
        step: u64,
    },
}
