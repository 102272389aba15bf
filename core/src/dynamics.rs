//! The step as a whole, over caller-owned memory: forces → largest force → Δt → noise → positions.
//!
//! [`Dynamics`] holds what a run is made of and where it stands; [`Memory`] lends it the arrays. One direction, no
//! way back: nothing is written to the state before everything that can fail has succeeded.
//! [`crate::engine::Engine`] owns such memory as plain arrays; a host may own it as vectors.
//!
//! ```
//! use meniscus_core::dynamics::{Clock, Dynamics, Memory};
//! use meniscus_core::influence::influence_length;
//! use meniscus_core::parameters::Parameters;
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
//!     displacement_x: &mut [0; 2], displacement_y: &mut [0; 2], next: &mut [0; 2],
//!     nodes: &mut [0; M * M], field: &mut [zero; M * M], lines: &mut [zero; 2 * M],
//!     influence: &mut [0.0; influence_length(M)], gradient: &mut [0.0; M],
//! };
//! let parameters = Parameters { grid: M, side: 16.0, ..Parameters::default() };
//! let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 31, 0))];
//! let mut dynamics = Dynamics::new(&parameters, Clock::START, discs, &mut memory).unwrap();
//! let step = dynamics.step(&AnySize, &mut memory).unwrap();
//! assert_eq!(dynamics.clock().step, 1);
//! assert!(step.length > 0);
//! ```

use crate::assignment::{self, Crowded};
use crate::cells::for_each_pair;
use crate::digest::State;
use crate::environment::{self, EnvironmentError};
use crate::ermak::{Displacement, StepLimits, displace, largest_force};
use crate::grid::Grid;
use crate::influence::{fill_gradient, fill_influence, influence_length};
use crate::mesh::{Tables, solve};
use crate::noise::{Purpose, StepKey, ThermalKick};
use crate::parameters::{Assignment, LARGEST_PARTICLE_COUNT, Noise, ParameterError, Parameters};
use crate::repulsion::Repulsion;
use crate::torus::{Fraction, Position, UNITS};
use crate::transform::{Complex32, LineTransform};
use crate::units::TIME_UNITS;

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
    /// Steps done and time reached after it.
    pub clock: Clock,
}

/// Why forces could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceError {
    /// There is nothing to move: the engine was not initialised, or its initialisation failed.
    NotInitialised,
    /// The memory lent does not fit the run.
    Memory,
    /// A mesh node would hold more than 4095 discs.
    Crowded,
}

/// Why a step was refused; the state is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepError {
    /// There is nothing to move: the engine was not initialised, or its initialisation failed.
    NotInitialised,
    /// The memory lent does not fit the run.
    Memory,
    /// A mesh node would hold more than 4095 discs.
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
    /// An array of the memory is too short.
    Memory,
}

/// The arrays a run works in. The first group has an element for each disc, in storage order except `slots`; n is
/// at most the length of `ids`.
#[derive(Debug)]
pub struct Memory<'a> {
    /// Id of each disc.
    pub ids: &'a mut [u32],
    /// Where the disc of each id is stored.
    pub slots: &'a mut [u32],
    /// x, unit L·2⁻³².
    pub x: &'a mut [Fraction],
    /// y, unit L·2⁻³².
    pub y: &'a mut [Fraction],
    /// Borders crossed along x, + to the right.
    pub crossings_x: &'a mut [i32],
    /// Borders crossed along y.
    pub crossings_y: &'a mut [i32],
    /// Force along x, unit 2⁻²⁴ kBT/R0.
    pub force_x: &'a mut [i64],
    /// Force along y.
    pub force_y: &'a mut [i64],
    /// Displacement along x, unit L·2⁻³².
    pub displacement_x: &'a mut [i32],
    /// Displacement along y.
    pub displacement_y: &'a mut [i32],
    /// Chains of the cell list.
    pub next: &'a mut [u32],
    /// M × M: node masses, unit 2⁻²⁰ discs; then, the field being solved, the heads of the cell list.
    pub nodes: &'a mut [u32],
    /// M × M: the force field, kBT/R0.
    pub field: &'a mut [Complex32],
    /// Working memory of the solver, 2M elements or a multiple.
    pub lines: &'a mut [Complex32],
    /// The influence table, (M/2+1)² elements.
    pub influence: &'a mut [f32],
    /// The gradient table, M elements.
    pub gradient: &'a mut [f32],
}

impl Memory<'_> {
    /// How many discs fit.
    fn capacity(&self) -> usize {
        let by_u32 = [self.ids.len(), self.slots.len(), self.next.len()];
        let by_coordinate = [self.x.len(), self.y.len()];
        let by_i32 = [
            self.crossings_x.len(),
            self.crossings_y.len(),
            self.displacement_x.len(),
            self.displacement_y.len(),
        ];
        let by_i64 = [self.force_x.len(), self.force_y.len()];
        let lengths = by_u32.into_iter().chain(by_coordinate).chain(by_i32).chain(by_i64);
        lengths.min().unwrap_or(0).min(LARGEST_PARTICLE_COUNT)
    }

    /// Whether the mesh arrays are large enough for M nodes a side.
    fn holds_grid(&self, grid: usize) -> bool {
        self.nodes.len() == grid * grid
            && self.field.len() == grid * grid
            && self.lines.len() >= 2 * grid
            && self.influence.len() >= influence_length(grid)
            && self.gradient.len() >= grid
    }
}

/// What a run is made of and where it stands, without its arrays.
#[derive(Clone, Copy, Debug)]
pub struct Dynamics {
    count: usize,
    clock: Clock,
    seed: u64,
    limits: StepLimits,
    repulsion: Repulsion,
    /// Units of position in 1 R0, 2³²/L.
    units: f32,
    grid: Grid,
    assignment: Assignment,
    noise: Noise,
    attracts: bool,
    repels: bool,
}

impl Dynamics {
    /// No run: no disc, all bits zero.
    #[must_use]
    pub const fn blank() -> Self {
        Self {
            count: 0,
            clock: Clock::START,
            seed: 0,
            limits: StepLimits::blank(),
            repulsion: Repulsion::blank(),
            units: 0.0,
            grid: Grid::SMALLEST,
            assignment: Assignment::CloudInCell,
            noise: Noise::Uniform,
            attracts: false,
            repels: false,
        }
    }

    /// Sets up a run that stands at `clock`: checks the parameters and the floating-point environment, fills the
    /// tables and takes the discs, each with its id, in any order.
    ///
    /// # Errors
    /// An [`InitError`]; the memory may have been written to.
    pub fn new(
        parameters: &Parameters,
        clock: Clock,
        discs: impl IntoIterator<Item = (u32, Position)>,
        memory: &mut Memory<'_>,
    ) -> Result<Self, InitError> {
        parameters.validate().map_err(InitError::Parameters)?;
        environment::check().map_err(InitError::Environment)?;
        let grid = Grid::new(parameters.grid).ok_or(InitError::Parameters(ParameterError::Grid))?;
        if !memory.holds_grid(parameters.grid) {
            return Err(InitError::Memory);
        }
        let count = take_discs(discs, memory)?;
        fill_influence(parameters, memory.influence);
        fill_gradient(parameters, memory.gradient);
        Ok(Self {
            count,
            clock,
            seed: parameters.seed,
            limits: StepLimits::new(parameters.max_step, parameters.max_displacement),
            repulsion: Repulsion::new(parameters.side),
            units: (UNITS / parameters.side) as f32,
            grid,
            assignment: parameters.assignment,
            noise: parameters.noise,
            attracts: parameters.capillary_strength > 0.0,
            repels: parameters.repulsion,
        })
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

    /// The state as its canonical bytes see it.
    #[must_use]
    pub fn state<'a>(&self, slots: &'a [u32], x: &'a [Fraction], y: &'a [Fraction]) -> State<'a> {
        let slots = slots.get(..self.count).unwrap_or(&[]);
        State { step: self.clock.step, time: self.clock.time, slots, x, y }
    }

    /// Computes the force on every disc at its present position into `force_x` and `force_y`.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub fn forces<T: LineTransform>(&self, transform: &T, memory: &mut Memory<'_>) -> Result<(), ForceError> {
        if self.count == 0 {
            return Err(ForceError::NotInitialised);
        }
        if memory.capacity() < self.count || !memory.holds_grid(self.grid.nodes()) {
            return Err(ForceError::Memory);
        }
        let discs = memory.discs(self.count);
        if self.attracts {
            self.attract(transform, discs)?;
        } else {
            discs.force_x.fill(0);
            discs.force_y.fill(0);
        }
        if self.repels {
            self.repel(memory.discs(self.count));
        }
        Ok(())
    }

    /// The capillary attraction by the mesh.
    fn attract<T: LineTransform>(&self, transform: &T, discs: Memory<'_>) -> Result<(), ForceError> {
        assignment::deposit(self.assignment, self.grid, discs.x, discs.y, discs.nodes)
            .map_err(|Crowded| ForceError::Crowded)?;
        let tables = Tables { influence: discs.influence, gradient: discs.gradient };
        solve(transform, self.grid, &tables, discs.nodes, discs.field, discs.lines);
        assignment::gather(
            self.assignment,
            self.grid,
            (discs.x, discs.y),
            discs.field,
            (discs.force_x, discs.force_y),
        );
        Ok(())
    }

    /// Adds the repulsion of all pairs.
    fn repel(&self, discs: Memory<'_>) {
        let Memory { ids, x, y, force_x, force_y, next, nodes, .. } = discs;
        let id = |disc: usize| ids.get(disc);
        let mut add = |disc: usize, (x, y): (i64, i64)| {
            if let (Some(force_x), Some(force_y)) = (force_x.get_mut(disc), force_y.get_mut(disc)) {
                *force_x += x;
                *force_y += y;
            }
        };
        for_each_pair((x, y), self.repulsion.reach(), nodes, next, |first, second, separation| {
            if let Some((x, y)) = self.repulsion.force(separation, id(first) < id(second)) {
                add(first, (x, y));
                add(second, (-x, -y));
            }
        });
    }

    /// Computes the forces and tells how long the next step will be (unit 2⁻⁴⁰ R0²/D, 0 if none is possible) and the
    /// largest force that decides it (rounded up, unit 2⁻²⁴ kBT/R0). Looking changes nothing.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub fn next_step<T: LineTransform>(
        &self,
        transform: &T,
        memory: &mut Memory<'_>,
    ) -> Result<(u64, u64), ForceError> {
        self.forces(transform, memory)?;
        let discs = memory.discs(self.count);
        let largest_force = largest_force(discs.force_x, discs.force_y);
        Ok((self.limits.step_length(largest_force).unwrap_or(0), largest_force))
    }

    /// Does one step.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then as it was.
    pub fn step<T: LineTransform>(
        &mut self,
        transform: &T,
        memory: &mut Memory<'_>,
    ) -> Result<Step, StepError> {
        let (length, largest_force) = self.next_step(transform, memory)?;
        if length == 0 {
            return Err(StepError::StepTooShort);
        }
        let clock = Clock {
            step: self.clock.step.checked_add(1).ok_or(StepError::TimeOverflow)?,
            time: self.clock.time.checked_add(length).ok_or(StepError::TimeOverflow)?,
        };
        self.find_displacements(length, memory.discs(self.count))?;
        displace_all(memory.discs(self.count));
        self.clock = clock;
        Ok(Step { length, largest_force, clock })
    }

    /// Turns forces and noise into displacements.
    fn find_displacements(&self, length: u64, discs: Memory<'_>) -> Result<(), StepError> {
        let step_length = length as f32 / TIME_UNITS as f32;
        let key = StepKey::new(self.seed, Purpose::Motion, self.clock.step);
        let kick = ThermalKick::new(self.noise, step_length, key);
        let displacement = Displacement { step_length, units: self.units, kick };
        let forces = discs.force_x.iter().zip(discs.force_y.iter());
        let targets = discs.displacement_x.iter_mut().zip(discs.displacement_y);
        for ((&id, (&force_x, &force_y)), (x, y)) in discs.ids.iter().zip(forces).zip(targets) {
            (*x, *y) = displacement.of(id, (force_x, force_y)).map_err(|_| StepError::HalfBox)?;
        }
        Ok(())
    }
}

impl Memory<'_> {
    /// The same memory, cut to `count` discs.
    fn discs(&mut self, count: usize) -> Memory<'_> {
        Memory {
            ids: cut(self.ids, count),
            slots: cut(self.slots, count),
            x: cut(self.x, count),
            y: cut(self.y, count),
            crossings_x: cut(self.crossings_x, count),
            crossings_y: cut(self.crossings_y, count),
            force_x: cut(self.force_x, count),
            force_y: cut(self.force_y, count),
            displacement_x: cut(self.displacement_x, count),
            displacement_y: cut(self.displacement_y, count),
            next: cut(self.next, count),
            nodes: self.nodes,
            field: self.field,
            lines: self.lines,
            influence: self.influence,
            gradient: self.gradient,
        }
    }
}

/// The first `count` elements, or none if there are fewer.
fn cut<T>(all: &mut [T], count: usize) -> &mut [T] {
    all.get_mut(..count).unwrap_or(&mut [])
}

/// Adds the displacements to the positions.
fn displace_all(discs: Memory<'_>) {
    let along_x = discs.x.iter_mut().zip(discs.crossings_x).zip(discs.displacement_x);
    let along_y = discs.y.iter_mut().zip(discs.crossings_y).zip(discs.displacement_y);
    for ((coordinate, crossings), units) in along_x.chain(along_y) {
        displace(coordinate, crossings, *units);
    }
}

/// Takes the discs in the order given; checks that their ids are 0 … n−1, each once.
fn take_discs(
    discs: impl IntoIterator<Item = (u32, Position)>,
    memory: &mut Memory<'_>,
) -> Result<usize, InitError> {
    const FREE: u32 = u32::MAX;
    let capacity = memory.capacity();
    let mut count = 0;
    let places = memory.ids.iter_mut().zip(memory.x.iter_mut().zip(memory.y.iter_mut()));
    let mut places = places.take(capacity);
    for (id, position) in discs {
        let (place, (x, y)) = places.next().ok_or(InitError::TooManyParticles { capacity })?;
        (*place, *x, *y) = (id, position.x, position.y);
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
