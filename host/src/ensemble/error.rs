//! Why an ensemble, or a member of it, could not be run or gathered. Every message is one line.

use crate::configuration::{ConfigurationError, Place};
use crate::files::{FileError, FormatError};
use crate::run::RunError;
use crate::simulation::SimulationError;
use std::path::PathBuf;
use thiserror::Error;

/// Why an ensemble could not be run or gathered.
#[derive(Debug, Error)]
pub enum EnsembleError {
    /// The sweep's file, or the configuration it names, is not what it should be.
    #[error(transparent)]
    Sweep(#[from] ConfigurationError),
    /// A member's configuration is refused.
    #[error("{source} (in the member with {settings})")]
    Member {
        /// What is wrong, with the place in the sweep's file.
        source: Box<ConfigurationError>,
        /// The member's swept values.
        settings: String,
    },
    /// Two members are the same run.
    #[error("{place}: the members with {} and with {} are the same run: leave one of them out", .settings[0], .settings[1])]
    Same {
        /// The sweep's file.
        place: Place,
        /// Their swept values.
        settings: [String; 2],
    },
    /// A member was asked for that is not there.
    #[error("--index {index}: the sweep has members 1 to {count}")]
    Index {
        /// The number asked for.
        index: usize,
        /// How many members there are.
        count: usize,
    },
    /// A directory is not that of an ensemble.
    #[error("{}: found no sweep.toml, expected the directory of an ensemble: name the one that `meniscus ensemble` wrote", .0.display())]
    NoSweep(PathBuf),
    /// A file or directory could not be read, made or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table of a finished run does not hold all of it.
    #[error(
        "{}: {problem}: this table of a finished run is gone, cut or changed; remove {} and run the ensemble again, it \
         repeats that run",
        path.display(),
        path.parent().unwrap_or(path).display()
    )]
    Table {
        /// The table, in the run's directory.
        path: PathBuf,
        /// What is wrong with it.
        problem: FormatError,
    },
    /// Gathering was stopped.
    #[error("interrupted: the gathered tables in {} are as they were; `meniscus ensemble gather {}` makes them", .0.display(), .0.display())]
    Interrupted(PathBuf),
    /// Several threads were at work and one has not said how it ended.
    #[error("a thread of the ensemble broke off; run the same command again, it goes on")]
    Thread,
}

/// Why a member could not be run.
#[derive(Debug, Error)]
pub enum MemberError {
    /// Its configuration cannot be brought to life.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The run failed or cannot go on.
    #[error(transparent)]
    Run(#[from] RunError),
    /// There is another run in its directory.
    #[error("{}: {key}: found {found}, expected {expected}: this is another run; remove the directory, and the member is run anew", path.display())]
    Foreign {
        /// The configuration of the run that is there.
        path: PathBuf,
        /// The first key that differs.
        key: &'static str,
        /// Its value there, as TOML.
        found: String,
        /// Its value in the member's configuration.
        expected: String,
    },
    /// The run has finished, and its files are not what they were then.
    #[error("{}: {reason}: remove the directory, and the member is run anew", path.display())]
    Damaged {
        /// The file or directory.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}
