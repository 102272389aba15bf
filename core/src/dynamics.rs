//! The step as a whole, over caller-owned memory: forces → largest force → Δt → noise → positions.
//!
//! [`Dynamics`] holds what a run is made of and where it stands; [`Memory`] lends it the arrays; the [`Stages`] do the
//! work. One direction, no way back: nothing is written to the state before everything that can fail has succeeded.
//! [`crate::engine::Engine`] owns such memory as plain arrays; a host may own it as vectors.
//!
//! ```
//! use meniscus_core::dynamics::{Clock, Dynamics, Memory};
//! use meniscus_core::influence::influence_length;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::stages::Scalar;
//! use meniscus_core::torus::{Fraction, Position};
//! use meniscus_core::transform::{AnySize, Complex32};
//!
//! const M: usize = 16;
//! let zero = Complex32::new(0.0, 0.0);
//! let mut memory = Memory {
//!     ids: &mut [0; 2], slots: &mut [0; 2],
//!     x: &mut [Fraction::ZERO; 2], y: &mut [Fraction::ZERO; 2],
//!     crossings_x: &mut [0; 2], crossings_y: &mut [0; 2],
//!     force_x: &mut [0; 2], force_y: &mut [0; 2],
//!     displacement_x: &mut [0; 2], displacement_y: &mut [0; 2], strengths: &mut [0; 2], next: &mut [0; 2],
//!     nodes: &mut [0; M * M], field: &mut [zero; M * M], lines: &mut [zero; 2 * M],
//!     influence: &mut [0.0; influence_length(M)], gradient: &mut [0.0; M], ..Memory::default()
//! };
//! let parameters = Parameters { grid: M, side: 16.0, ..Parameters::default() };
//! let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 31, 0))];
//! let mut dynamics = Dynamics::new(&parameters, Clock::START, discs, &mut memory).unwrap();
//! let step = dynamics.step(&mut Scalar(AnySize), &mut memory).unwrap();
//! assert_eq!(dynamics.clock().step, 1);
//! assert!(step.length > 0);
//! ```

use crate::assignment::DISC;
use crate::digest::State;
use crate::environment::{self, EnvironmentError};
use crate::ermak::{Displacement, HalfBox, StepLimits};
use crate::forces::Forces;
use crate::grid::Grid;
use crate::influence::{fill_gradient, fill_influence};
use crate::near_part::{fill_table, table_length};
use crate::noise::{Purpose, StepKey, ThermalKick};
use crate::pair_force::near_cutoff;
use crate::parameters::{LARGEST_CAPILLARY_STRENGTH, LARGEST_STRENGTH, Noise, ParameterError, Parameters};
use crate::refresh::{HeldForce, HeldForces, Refresh};
use crate::stages::Stages;
use crate::torus::{Fraction, Position, UNITS};
use crate::units::TIME_UNITS;

use core::mem::swap;

pub use crate::forces::ForceError;
pub use crate::memory::Memory;

/// Where a run stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clock {
    /// Steps done.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
}

impl Clock {
    /// The beginning.
    pub const START: Self = Self { step: 0, time: 0 };
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Δt, unit 2⁻⁴⁰ R0²/D.
    pub length: u64,
    /// The largest modulus of the forces before the step, rounded up, unit 2⁻²⁴ kBT/R0.
    pub largest_force: u64,
    /// Whether the force of the mesh was computed anew, as it is in every step that does not find it held. If forces are
    /// held, it is held from now on, and the one before is in `fresh_x` and `fresh_y` of the [`Memory`].
    pub refreshed: bool,
    /// Steps done and time reached after it.
    pub clock: Clock,
}

/// Why a step was refused; the state is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepError {
    /// There is nothing to move: the engine was not initialised, or its initialisation failed.
    NotInitialised,
    /// The memory lent does not fit the run.
    Memory,
    /// A mesh node would hold more than 4095 discs, or strengths of more than 2047, or too many discs are in one place,
    /// see [`crate::crowding`].
    Crowded,
    /// The largest force allows no step of even 2⁻⁴⁰ R0²/D.
    StepTooShort,
    /// Time would exceed 2²⁴ R0²/D, or the number of steps 2⁶⁴ − 1.
    TimeOverflow,
    /// A disc would move by half a box or more.
    HalfBox,
}

impl From<ForceError> for StepError {
    fn from(error: ForceError) -> Self {
        match error {
            ForceError::NotInitialised => Self::NotInitialised,
            ForceError::Memory => Self::Memory,
            ForceError::Crowded => Self::Crowded,
        }
    }
}

/// Why a run could not be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitError {
    /// A parameter is out of range.
    Parameters(ParameterError),
    /// The floating-point environment would change the bits.
    Environment(EnvironmentError),
    /// The parameters ask for another mesh than this memory is for.
    GridMismatch,
    /// No disc was given.
    NoParticles,
    /// More discs were given than fit.
    TooManyParticles {
        /// How many fit.
        capacity: usize,
    },
    /// The ids are not a permutation of 0 … n−1: `id` is out of range or was given twice.
    Id {
        /// The first id at fault.
        id: u32,
    },
    /// A disc's capillary strength f exceeds [`LARGEST_STRENGTH`], or V0·f² exceeds
    /// [`LARGEST_CAPILLARY_STRENGTH`].
    Strength {
        /// The first disc at fault.
        id: u32,
    },
    /// An array of the memory is too short.
    Memory,
    /// `mesh_refresh` is not 0, and there is no room to hold the mesh forces of so many discs.
    NoRoomToHold,
    /// The forces to go on with are not those of a run of these discs: not as many, or that of disc `id` is larger than a
    /// mesh can exert.
    HeldForce {
        /// The first disc at fault.
        id: u32,
    },
}

/// A disc where a run begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Disc {
    /// Its number, 0 … n−1.
    pub id: u32,
    /// Where it is.
    pub position: Position,
    /// Capillary strength f, unit 2⁻²⁰, of either sign: discs i and j attract each other with V0·f_i·f_j. [`DISC`]
    /// stands for 1.
    pub strength: i32,
}

/// A disc of strength 1.
impl From<(u32, Position)> for Disc {
    fn from((id, position): (u32, Position)) -> Self {
        Self { id, position, strength: DISC as i32 }
    }
}

/// What a run is made of and where it stands, without its arrays.
#[derive(Clone, Copy, Debug)]
pub struct Dynamics {
    count: usize,
    /// Whether mesh forces are held.
    is_held: bool,
    clock: Clock,
    seed: u64,
    limits: StepLimits,
    forces: Forces,
    /// Units of position in 1 R0, 2³²/L.
    units: f32,
    noise: Noise,
}

impl Dynamics {
    /// No run: no disc, all bits zero.
    #[must_use]
    pub const fn blank() -> Self {
        Self {
            count: 0,
            is_held: false,
            clock: Clock::START,
            seed: 0,
            limits: StepLimits::blank(),
            forces: Forces::blank(),
            units: 0.0,
            noise: Noise::Uniform,
        }
    }

    /// Sets up a run that stands at `clock`: checks the parameters and the floating-point environment, fills the
    /// tables and takes the discs, each with its id, in any order: [`Disc`]s, or pairs of an id and a position.
    ///
    /// # Errors
    /// An [`InitError`]; the memory may have been written to.
    pub fn new(
        parameters: &Parameters,
        clock: Clock,
        discs: impl IntoIterator<Item: Into<Disc>>,
        memory: &mut Memory<'_>,
    ) -> Result<Self, InitError> {
        parameters.validate().map_err(InitError::Parameters)?;
        environment::check().map_err(InitError::Environment)?;
        let grid = Grid::new(parameters.grid).ok_or(InitError::Parameters(ParameterError::Grid))?;
        let near = table_length(near_cutoff(parameters));
        if !memory.holds_tables(parameters.grid, near) {
            return Err(InitError::Memory);
        }
        let count = take_discs(discs, memory)?;
        if parameters.mesh_refresh > 0.0 && memory.room_to_hold() < count {
            return Err(InitError::NoRoomToHold);
        }
        check_strengths(parameters.capillary_strength, &memory.discs(count))?;
        fill_influence(parameters, memory.influence);
        fill_gradient(parameters, memory.gradient);
        if let Some(table) = memory.near.get_mut(..near) {
            fill_table(parameters.splitting, parameters.capillary_length, table);
        }
        Ok(Self {
            count,
            is_held: false,
            clock,
            seed: parameters.seed,
            limits: StepLimits::new(parameters.max_step, parameters.max_displacement),
            forces: Forces::new(parameters, grid, memory.discs(count).strengths),
            units: (UNITS / parameters.side) as f32,
            noise: parameters.noise,
        })
    }

    /// Goes on with the mesh forces that were held where the run stands, given in the order of ids, so that it does so
    /// bit for bit. A run that holds none ignores them.
    ///
    /// # Errors
    /// [`InitError::HeldForce`], or [`InitError::NoRoomToHold`] if the memory has become too short; nothing is held then.
    pub fn hold(
        &mut self,
        held: impl IntoIterator<Item = HeldForce>,
        memory: &mut Memory<'_>,
    ) -> Result<(), InitError> {
        self.is_held = false;
        if !self.refresh().holds() {
            return Ok(());
        }
        if memory.room_to_hold().min(memory.capacity()) < self.count {
            return Err(InitError::NoRoomToHold);
        }
        let Memory { slots, held_x, held_y, reference_x, reference_y, .. } = memory.discs(self.count);
        let mut held = held.into_iter();
        for (id, &slot) in (0..).zip(slots.iter()) {
            let possible = held.next().filter(|held| held.is_possible(self.count));
            let HeldForce { reference, force } = possible.ok_or(InitError::HeldForce { id })?;
            let slot = slot as usize;
            let forces = held_x.get_mut(slot).zip(held_y.get_mut(slot));
            let places = reference_x.get_mut(slot).zip(reference_y.get_mut(slot));
            if let (Some(target), Some(place)) = (forces, places) {
                (*target.0, *target.1) = force;
                (*place.0, *place.1) = (reference.x, reference.y);
            }
        }
        if held.next().is_some() {
            return Err(InitError::HeldForce { id: self.count as u32 });
        }
        self.is_held = true;
        Ok(())
    }

    /// When held mesh forces are computed anew; [`Refresh::NEVER`] if none are held, also for want of attraction.
    #[must_use]
    pub fn refresh(&self) -> Refresh {
        self.forces.refresh()
    }

    /// Whether the next step finds the force of the mesh held, unless a disc has moved too far.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Number of discs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Steps done and time reached.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// The state as its canonical bytes see it, from the arrays of the memory.
    #[must_use]
    pub fn state<'a>(
        &self,
        slots: &'a [u32],
        (x, y): (&'a [Fraction], &'a [Fraction]),
        strengths: &'a [i32],
        held: HeldForces<'a>,
    ) -> State<'a> {
        let slots = slots.get(..self.count).unwrap_or(&[]);
        let strengths = if self.forces.strengths_are_equal() { &[] } else { strengths };
        let held = if self.is_held { held } else { HeldForces::default() };
        State { step: self.clock.step, time: self.clock.time, slots, x, y, strengths, held }
    }

    /// Computes the force on every disc at its present position into `force_x` and `force_y`.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub fn forces<S: Stages>(&self, stages: &mut S, memory: &mut Memory<'_>) -> Result<(), ForceError> {
        self.compute(stages, memory).map(|_| ())
    }

    /// Computes the forces and tells whether that of the mesh was computed anew.
    fn compute<S: Stages>(&self, stages: &mut S, memory: &mut Memory<'_>) -> Result<bool, ForceError> {
        self.forces.compute(stages, self.count, self.is_held, memory)
    }

    /// Computes the forces and tells how long the next step will be (unit 2⁻⁴⁰ R0²/D, 0 if none is possible) and the
    /// largest force that decides it (rounded up, unit 2⁻²⁴ kBT/R0). Looking changes nothing.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub fn next_step<S: Stages>(
        &self,
        stages: &mut S,
        memory: &mut Memory<'_>,
    ) -> Result<(u64, u64), ForceError> {
        self.forces(stages, memory)?;
        let largest_force = stages.largest_force(&mut memory.discs(self.count));
        Ok((self.limits.step_length(largest_force).unwrap_or(0), largest_force))
    }

    /// Does one step.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then as it was.
    pub fn step<S: Stages>(&mut self, stages: &mut S, memory: &mut Memory<'_>) -> Result<Step, StepError> {
        let refreshed = self.compute(stages, memory)?;
        let discs = &mut memory.discs(self.count);
        let largest_force = stages.largest_force(discs);
        let length = self.limits.step_length(largest_force).ok_or(StepError::StepTooShort)?;
        let clock = Clock {
            step: self.clock.step.checked_add(1).ok_or(StepError::TimeOverflow)?,
            time: self.clock.time.checked_add(length).ok_or(StepError::TimeOverflow)?,
        };
        stages.displacements(&self.displacement(length), discs).map_err(|HalfBox| StepError::HalfBox)?;
        // Nothing fails any more.
        if refreshed && self.refresh().holds() {
            keep_forces(discs);
            self.is_held = true;
        }
        stages.displace(discs);
        self.clock = clock;
        Ok(Step { length, largest_force, refreshed, clock })
    }

    /// What moves the discs in a step of this length.
    fn displacement(&self, length: u64) -> Displacement {
        let step_length = length as f32 / TIME_UNITS as f32;
        let key = StepKey::new(self.seed, Purpose::Motion, self.clock.step);
        let kick = ThermalKick::new(self.noise, step_length, key);
        Displacement { step_length, units: self.units, kick }
    }
}

/// Keeps the fresh mesh forces and where the discs are; what was held before becomes fresh.
fn keep_forces(discs: &mut Memory<'_>) {
    discs.held_x.iter_mut().zip(discs.fresh_x.iter_mut()).for_each(|(held, fresh)| swap(held, fresh));
    discs.held_y.iter_mut().zip(discs.fresh_y.iter_mut()).for_each(|(held, fresh)| swap(held, fresh));
    discs.reference_x.iter_mut().zip(discs.x.iter()).for_each(|(reference, &x)| *reference = x);
    discs.reference_y.iter_mut().zip(discs.y.iter()).for_each(|(reference, &y)| *reference = y);
}

/// Takes the discs in the order given; checks that their ids are 0 … n−1, each once.
fn take_discs(
    discs: impl IntoIterator<Item: Into<Disc>>,
    memory: &mut Memory<'_>,
) -> Result<usize, InitError> {
    const FREE: u32 = u32::MAX;
    let capacity = memory.capacity();
    let mut count = 0;
    let coordinates = memory.x.iter_mut().zip(memory.y.iter_mut());
    let places = memory.ids.iter_mut().zip(memory.strengths.iter_mut()).zip(coordinates);
    let mut places = places.take(capacity);
    for disc in discs {
        let ((id, strength), (x, y)) = places.next().ok_or(InitError::TooManyParticles { capacity })?;
        let disc: Disc = disc.into();
        (*id, *strength, *x, *y) = (disc.id, disc.strength, disc.position.x, disc.position.y);
        count += 1;
    }
    if count == 0 {
        return Err(InitError::NoParticles);
    }
    let discs = memory.discs(count);
    discs.crossings_x.fill(0);
    discs.crossings_y.fill(0);
    discs.slots.fill(FREE);
    for (slot, &id) in discs.ids.iter().enumerate() {
        match discs.slots.get_mut(id as usize) {
            Some(place) if *place == FREE => *place = slot as u32,
            _ => return Err(InitError::Id { id }),
        }
    }
    Ok(count)
}

/// Checks that no two discs of these strengths are coupled more strongly than
/// [`LARGEST_CAPILLARY_STRENGTH`], and none deposits more than a mesh node may hold.
fn check_strengths(capillary_strength: f64, discs: &Memory<'_>) -> Result<(), InitError> {
    for (&id, &strength) in discs.ids.iter().zip(discs.strengths.iter()) {
        let modulus = f64::from(strength).abs() / f64::from(DISC);
        if modulus > LARGEST_STRENGTH || capillary_strength * modulus * modulus > LARGEST_CAPILLARY_STRENGTH {
            return Err(InitError::Strength { id });
        }
    }
    Ok(())
}
