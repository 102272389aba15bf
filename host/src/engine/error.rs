//! Why a run could not start or go on.

use meniscus_core::dynamics::{Clock, ForceError, InitError, StepError};
use meniscus_core::parameters::{LARGEST_CAPILLARY_STRENGTH, LARGEST_STRENGTH};
use meniscus_core::units::time_from_units;
use thiserror::Error;

/// Why a run could not start or go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum EngineError {
    /// The engine could not be set up.
    #[error("the run cannot be set up: {}", init_message(*.0))]
    Init(InitError),
    /// A step was refused; the state is as it was.
    #[error("the step after step {} at time {} R0^2/D is refused: {}", .1.step, time_from_units(.1.time), step_message(*.0))]
    Step(StepError, Clock),
    /// The threads could not be started.
    #[error("{0} threads cannot be started; ask for fewer by --threads")]
    Threads(usize),
    /// There is not one pair of crossings for each disc.
    #[error("the crossings of {found} discs were given, those of {expected} are needed")]
    Crossings {
        /// Discs whose crossings were given.
        found: usize,
        /// Discs there are.
        expected: usize,
    },
    /// The forces could not be computed.
    #[error("the forces cannot be computed: {}", step_message(StepError::from(*.0)))]
    Force(ForceError),
}

fn init_message(error: InitError) -> String {
    match error {
        InitError::Parameters(error) => format!("parameter out of range ({error:?})"),
        InitError::Environment(error) => format!(
            "this process's floating-point environment would change the bits ({error:?}); \
             run without flush-to-zero and with rounding to nearest"
        ),
        InitError::Strength { id } => format!(
            "the capillary strength f of disc {id} is too large; at most {LARGEST_STRENGTH}, and V0*f^2 at most \
             {LARGEST_CAPILLARY_STRENGTH} kBT"
        ),
        InitError::GridMismatch | InitError::Memory => "the memory does not fit the mesh".into(),
        InitError::NoRoomToHold => {
            "the memory has no room to hold the forces of the mesh; leave force.mesh_refresh out".into()
        }
        InitError::HeldForce { id } => format!(
            "the held forces do not belong to these discs (that of disc {id} is missing, too many or too large); \
             start from the state without them"
        ),
        InitError::NoParticles => "there is no disc; at least 1 is needed".into(),
        InitError::TooManyParticles { capacity } => format!("too many discs; at most {capacity} fit"),
        InitError::Id { id } => {
            format!("id {id} is out of range or given twice; ids are 0 to n - 1, each once")
        }
    }
}

fn step_message(error: StepError) -> &'static str {
    match error {
        StepError::NotInitialised => "there are no discs",
        StepError::Memory => "the memory does not fit the run",
        StepError::Crowded => {
            "too many discs are in one place (a mesh node holds 4095 discs, or strengths of 2047; of more than 524288 discs, \
             a 256th of the box along x and y holds 32768); spread them, or use a finer mesh or fewer discs"
        }
        StepError::StepTooShort => {
            "the largest force allows no step of 2^-40 R0^2/D; \
             separate overlapping discs or raise motion.max_displacement"
        }
        StepError::TimeOverflow => {
            "time would exceed 2^24 R0^2/D, or the number of steps 2^64 - 1: a run cannot go on longer"
        }
        StepError::HalfBox => "a disc would move by half a box; lower motion.max_step",
    }
}
