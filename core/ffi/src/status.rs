//! What every call answers: `Ok`, or which of the core's errors it was.

use core::ffi::{CStr, c_char};
use meniscus_core::dynamics::{ForceError, InitError, StepError};
use meniscus_core::environment::EnvironmentError;
use meniscus_core::parameters::ParameterError;
use meniscus_core::torus::TorusError;

/// What became of a call.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusStatus {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A pointer is not aligned for what it points to.
    Misaligned = 2,
    /// The memory is shorter than meniscus_size says.
    MemoryTooShort = 3,
    /// The capacity is not 1 to 4194304, or no memory is so large.
    Capacity = 4,
    /// An array has fewer elements than there are discs.
    ArrayTooShort = 5,
    /// The side is not a finite positive number.
    Side = 16,
    /// The side exceeds 65536 R0.
    SideTooLarge = 17,
    /// Half the side does not exceed the cut-off of the repulsion.
    SideTooSmall = 18,
    /// The capillary strength is not 0 to 1000 kBT.
    CapillaryStrength = 19,
    /// The capillary length is not a number of at least 0.01 R0.
    CapillaryLength = 20,
    /// The mesh is not a power of two from 16 to 4096.
    Grid = 21,
    /// The mesh spacing exceeds 16 R0.
    GridTooCoarse = 22,
    /// The mesh spacing is below 0.125 R0.
    GridTooFine = 23,
    /// The ceiling of the time step is not 2^-40 to 1 R0^2/D.
    MaxStep = 24,
    /// The largest displacement by force is not 2^-40 to 0.5 R0.
    MaxDisplacement = 25,
    /// The seed exceeds 2^63 - 1.
    Seed = 26,
    /// The mass assignment is no MeniscusAssignment.
    Assignment = 27,
    /// The influence function is no MeniscusInfluence.
    Influence = 28,
    /// The gradient is no MeniscusGradient.
    Gradient = 29,
    /// The noise is no MeniscusNoise.
    Noise = 30,
    /// The repulsion is neither 0 nor 1.
    Repulsion = 31,
    /// A coordinate is not in 0 <= coordinate < side.
    Coordinate = 32,
    /// The method is no MeniscusMethod.
    Method = 33,
    /// The splitting is not 1e-5 to 8 per R0.
    Splitting = 34,
    /// The splitting exceeds 0.7 over the mesh spacing.
    SplittingTooLarge = 35,
    /// The cut-off of the near part is not a number of at least 1 R0.
    Cutoff = 36,
    /// The cut-off of the near part is not below half the side.
    CutoffTooLarge = 37,
    /// The influence function does not belong to the method: the optimal one to P3m, the others to the particle mesh.
    InfluenceOfMethod = 38,
    /// The gradient does not belong to the method: P3m takes the spectral one.
    GradientOfMethod = 39,
    /// An external field is not finite, exceeds 1e8 kBT/R0 somewhere, or is a trap of negative stiffness or with a centre
    /// outside the box.
    Fields = 40,
    /// The distance of mesh_refresh is neither 0 nor 2^-20 to 16 R0.
    MeshRefresh = 41,
    /// The distance of mesh_refresh is not below a quarter of the side.
    MeshRefreshTooLarge = 42,
    /// The program flushes subnormal numbers to zero, which would change the bits.
    SubnormalsFlushed = 48,
    /// The program does not round to nearest, which would change the bits.
    Rounding = 49,
    /// The parameters ask for another mesh than the engine was created for.
    GridMismatch = 50,
    /// No disc was given.
    NoParticles = 51,
    /// More discs were given than the engine was created for.
    TooManyParticles = 52,
    /// The ids are not 0 to count - 1, each once.
    Id = 53,
    /// A strength exceeds 1000, or the capillary strength times its square exceeds 1000 kBT.
    Strength = 54,
    /// Mesh forces are to be held, and the memory is shorter than meniscus_size_to_hold says.
    NoRoomToHold = 55,
    /// The held forces are not those of a run of these discs: one is larger than a mesh can exert.
    HeldForce = 56,
    /// There are no discs: no run was set, or setting it failed.
    NotInitialised = 64,
    /// A mesh node would hold more than 4095 discs, or strengths of more than 2047, or, of more than 524288 discs, more than
    /// 32768 would be in one cell of a division of the box into at most 256 x 256.
    Crowded = 65,
    /// The largest force allows no step of even 2^-40 R0^2/D.
    StepTooShort = 66,
    /// Time would exceed 2^24 R0^2/D, or the number of steps 2^64 - 1.
    TimeOverflow = 67,
    /// A disc would move by half a box or more.
    HalfBox = 68,
    /// The engine's memory was written to by somebody else.
    Memory = 69,
    /// No mesh forces are held.
    NothingHeld = 70,
}

use MeniscusStatus as S;

/// What each status means.
const MESSAGES: [(MeniscusStatus, &CStr); 49] = [
    (S::Ok, c"done"),
    (S::NullPointer, c"a pointer is null"),
    (S::Misaligned, c"a pointer is not aligned for what it points to"),
    (S::MemoryTooShort, c"the memory is shorter than meniscus_size says"),
    (S::Capacity, c"the capacity is not 1 to 4194304, or no memory is so large"),
    (S::ArrayTooShort, c"an array has fewer elements than there are discs"),
    (S::Side, c"the side is not a finite positive number"),
    (S::SideTooLarge, c"the side exceeds 65536 R0"),
    (S::SideTooSmall, c"half the side does not exceed the cut-off of the repulsion"),
    (S::CapillaryStrength, c"the capillary strength is not 0 to 1000 kBT"),
    (S::CapillaryLength, c"the capillary length is not a number of at least 0.01 R0"),
    (S::Grid, c"the mesh is not a power of two from 16 to 4096"),
    (S::GridTooCoarse, c"the mesh spacing exceeds 16 R0"),
    (S::GridTooFine, c"the mesh spacing is below 0.125 R0"),
    (S::MaxStep, c"the ceiling of the time step is not 2^-40 to 1 R0^2/D"),
    (S::MaxDisplacement, c"the largest displacement by force is not 2^-40 to 0.5 R0"),
    (S::Seed, c"the seed exceeds 2^63 - 1"),
    (S::Assignment, c"the mass assignment is no MeniscusAssignment"),
    (S::Influence, c"the influence function is no MeniscusInfluence"),
    (S::Gradient, c"the gradient is no MeniscusGradient"),
    (S::Noise, c"the noise is no MeniscusNoise"),
    (S::Repulsion, c"the repulsion is neither 0 nor 1"),
    (S::Coordinate, c"a coordinate is not in 0 <= coordinate < side"),
    (S::Method, c"the method is no MeniscusMethod"),
    (S::Splitting, c"the splitting is not 1e-5 to 8 per R0"),
    (S::SplittingTooLarge, c"the splitting exceeds 0.7 over the mesh spacing"),
    (S::Cutoff, c"the cut-off of the near part is not a number of at least 1 R0"),
    (S::CutoffTooLarge, c"the cut-off of the near part is not below half the side"),
    (
        S::InfluenceOfMethod,
        c"the influence function does not belong to the method: the optimal one to P3m, the others to the particle mesh",
    ),
    (S::GradientOfMethod, c"the gradient does not belong to the method: P3m takes the spectral one"),
    (
        S::Fields,
        c"an external field is not finite, exceeds 1e8 kBT/R0 somewhere, or is a trap of negative stiffness or with a centre outside the box",
    ),
    (S::MeshRefresh, c"the distance of mesh_refresh is neither 0 nor 2^-20 to 16 R0"),
    (S::MeshRefreshTooLarge, c"the distance of mesh_refresh is not below a quarter of the side"),
    (S::SubnormalsFlushed, c"the program flushes subnormal numbers to zero, which would change the bits"),
    (S::Rounding, c"the program does not round to nearest, which would change the bits"),
    (S::GridMismatch, c"the parameters ask for another mesh than the engine was created for"),
    (S::NoParticles, c"no disc was given"),
    (S::TooManyParticles, c"more discs were given than the engine was created for"),
    (S::Id, c"the ids are not 0 to count - 1, each once"),
    (S::Strength, c"a strength exceeds 1000, or the capillary strength times its square exceeds 1000 kBT"),
    (S::NoRoomToHold, c"mesh forces are to be held, and the memory is shorter than meniscus_size_to_hold says"),
    (S::HeldForce, c"the held forces are not those of a run of these discs: one is larger than a mesh can exert"),
    (S::NotInitialised, c"there are no discs: no run was set, or setting it failed"),
    (S::Crowded, c"too many discs in one place: a mesh node holds 4095 discs, or strengths of 2047; of more than 524288 discs a cell 32768"),
    (S::StepTooShort, c"the largest force allows no step of even 2^-40 R0^2/D"),
    (S::TimeOverflow, c"time would exceed 2^24 R0^2/D, or the number of steps 2^64 - 1"),
    (S::HalfBox, c"a disc would move by half a box or more"),
    (S::Memory, c"the engine's memory was written to by somebody else"),
    (S::NothingHeld, c"no mesh forces are held"),
];

/// What a MeniscusStatus means, in one line that lives as long as the program. Never null.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_status_message(status: i32) -> *const c_char {
    let found = MESSAGES.iter().find(|(known, _)| *known as i32 == status);
    found.map_or(c"no status of Meniscus", |(_, message)| message).as_ptr()
}

impl From<ParameterError> for MeniscusStatus {
    fn from(error: ParameterError) -> Self {
        match error {
            ParameterError::Side => Self::Side,
            ParameterError::SideTooLarge => Self::SideTooLarge,
            ParameterError::SideTooSmall => Self::SideTooSmall,
            ParameterError::CapillaryStrength => Self::CapillaryStrength,
            ParameterError::CapillaryLength => Self::CapillaryLength,
            ParameterError::Grid => Self::Grid,
            ParameterError::GridTooCoarse => Self::GridTooCoarse,
            ParameterError::GridTooFine => Self::GridTooFine,
            ParameterError::Splitting => Self::Splitting,
            ParameterError::SplittingTooLarge => Self::SplittingTooLarge,
            ParameterError::Cutoff => Self::Cutoff,
            ParameterError::CutoffTooLarge => Self::CutoffTooLarge,
            ParameterError::MeshRefresh => Self::MeshRefresh,
            ParameterError::MeshRefreshTooLarge => Self::MeshRefreshTooLarge,
            ParameterError::Influence => Self::InfluenceOfMethod,
            ParameterError::Gradient => Self::GradientOfMethod,
            ParameterError::Fields => Self::Fields,
            ParameterError::MaxStep => Self::MaxStep,
            ParameterError::MaxDisplacement => Self::MaxDisplacement,
            ParameterError::Seed => Self::Seed,
        }
    }
}

impl From<InitError> for MeniscusStatus {
    fn from(error: InitError) -> Self {
        match error {
            InitError::Parameters(error) => error.into(),
            InitError::Environment(EnvironmentError::SubnormalsFlushed) => Self::SubnormalsFlushed,
            InitError::Environment(EnvironmentError::Rounding) => Self::Rounding,
            InitError::GridMismatch => Self::GridMismatch,
            InitError::NoParticles => Self::NoParticles,
            InitError::TooManyParticles { .. } => Self::TooManyParticles,
            InitError::Id { .. } => Self::Id,
            InitError::Strength { .. } => Self::Strength,
            InitError::Memory => Self::Memory,
            InitError::NoRoomToHold => Self::NoRoomToHold,
            InitError::HeldForce { .. } => Self::HeldForce,
        }
    }
}

impl From<StepError> for MeniscusStatus {
    fn from(error: StepError) -> Self {
        match error {
            StepError::NotInitialised => Self::NotInitialised,
            StepError::Memory => Self::Memory,
            StepError::Crowded => Self::Crowded,
            StepError::StepTooShort => Self::StepTooShort,
            StepError::TimeOverflow => Self::TimeOverflow,
            StepError::HalfBox => Self::HalfBox,
        }
    }
}

impl From<ForceError> for MeniscusStatus {
    fn from(error: ForceError) -> Self {
        StepError::from(error).into()
    }
}

impl From<TorusError> for MeniscusStatus {
    fn from(error: TorusError) -> Self {
        match error {
            TorusError::Side => Self::Side,
            TorusError::SideTooLarge => Self::SideTooLarge,
            TorusError::Coordinate => Self::Coordinate,
        }
    }
}
