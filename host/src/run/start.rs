//! `start.state`: where the discs were when a run began, for tables that compare with it.
//!
//! It is there only if there are such tables. The checkpoints know its digest, so that a run that goes on compares with
//! the same.

use super::{RunError, manifest};
use crate::files::state::State;
use crate::simulation::Simulation;
use meniscus_core::torus::Position;
use std::path::Path;

/// Name of the file.
const FILE: &str = "start.state";

/// A state to compare with.
#[derive(Debug)]
pub(super) struct StartingState {
    pub positions: Vec<Position>,
    /// SHA-256 of the file.
    pub digest: String,
}

impl StartingState {
    /// Writes the present state of `simulation` to `directory`.
    pub(super) fn write(directory: &Path, simulation: &Simulation) -> Result<Self, RunError> {
        let state = simulation.state();
        state.write(&directory.join(FILE))?;
        Ok(Self { digest: manifest::sha256(&state.to_bytes()), positions: state.positions })
    }

    /// Reads what [`StartingState::write`] wrote when its digest was `digest`.
    pub(super) fn read(directory: &Path, digest: &str) -> Result<Self, RunError> {
        let path = directory.join(FILE);
        if !path.exists() {
            return Err(RunError::Gone(path));
        }
        let state = State::read(&path)?;
        if manifest::sha256(&state.to_bytes()) != digest {
            return Err(RunError::Start(path));
        }
        Ok(Self { positions: state.positions, digest: digest.to_owned() })
    }
}
