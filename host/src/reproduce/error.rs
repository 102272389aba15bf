//! Why the paper could not be reproduced for reasons that are not physics.

use crate::configuration::ConfigurationError;
use crate::engine::EngineError;
use crate::ensemble::EnsembleError;
use crate::figures::FigureError;
use crate::files::FileError;
use crate::simulation::SimulationError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a report could not be made. Every message is one line.
#[derive(Debug, Error)]
pub enum ReproduceError {
    /// Runs could not be made or gathered.
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
    /// A configuration is refused.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A start could not be placed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Forces could not be computed.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A table or the trajectory of a finished run is gone or lacks something.
    #[error(
        "{}: {problem}: this file of a finished run is gone, cut or changed; remove {} and reproduce again, that run is repeated",
        path.display(),
        path.parent().unwrap_or(path).display()
    )]
    Table {
        /// The file, in the run's directory.
        path: PathBuf,
        /// What is wrong with it.
        problem: crate::files::FormatError,
    },
    /// A directory could not be made.
    #[error("{}: cannot be made: {source}; name another directory by --out", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
