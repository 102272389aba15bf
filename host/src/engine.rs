//! The host's engine: the core's stages over vectors, with mesh and capacity chosen at run time.
//!
//! ```
//! use meniscus::engine::Engine;
//! use meniscus_core::dynamics::Clock;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::torus::Position;
//!
//! let discs = vec![Position::from_bits(0, 0), Position::from_bits(1 << 27, 0)];
//! let mut engine = Engine::new(&Parameters::default(), Clock::START, &discs)?;
//! let step = engine.step()?;
//! assert_eq!(step.clock.step, 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use meniscus_core::digest::State;
use meniscus_core::dynamics::{Clock, Disc, Dynamics, ForceError, InitError, Memory, Step, StepError};
use meniscus_core::influence::influence_length;
use meniscus_core::mesh::LINES;
use meniscus_core::near_part::{Segment, table_length};
use meniscus_core::pair_force::near_cutoff;
use meniscus_core::parameters::{
    LARGEST_CAPILLARY_STRENGTH, LARGEST_PARTICLE_COUNT, LARGEST_STRENGTH, Parameters,
};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_core::units::{force_from_units, time_from_units};
use thiserror::Error;

/// Why a run could not start or go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum EngineError {
    /// The engine could not be set up.
    #[error("the run cannot be set up: {}", init_message(*.0))]
    Init(InitError),
    /// A step was refused; the state is as it was.
    #[error("the step after step {} at time {} R0²/D is refused: {}", .1.step, time_from_units(.1.time), step_message(*.0))]
    Step(StepError, Clock),
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
        InitError::NoParticles => "there is no disc; at least 1 is needed".into(),
        InitError::TooManyParticles { capacity } => format!("too many discs; at most {capacity} fit"),
        InitError::Id { id } => {
            format!("id {id} is out of range or given twice; ids are 0 to n − 1, each once")
        }
    }
}

fn step_message(error: StepError) -> &'static str {
    match error {
        StepError::NotInitialised => "there are no discs",
        StepError::Memory => "the memory does not fit the run",
        StepError::Crowded => "a mesh node would hold more than 4095 discs; use a finer mesh or fewer discs",
        StepError::StepTooShort => {
            "the largest force allows no step of 2⁻⁴⁰ R0²/D; \
             separate overlapping discs or raise motion.max_displacement"
        }
        StepError::TimeOverflow => "time would exceed 2²⁴ R0²/D",
        StepError::HalfBox => "a disc would move by half a box; lower motion.max_step",
    }
}

/// A run in memory of its own.
#[derive(Debug)]
pub struct Engine {
    dynamics: Dynamics,
    ids: Vec<u32>,
    slots: Vec<u32>,
    x: Vec<Fraction>,
    y: Vec<Fraction>,
    crossings_x: Vec<i32>,
    crossings_y: Vec<i32>,
    force_x: Vec<i64>,
    force_y: Vec<i64>,
    displacement_x: Vec<i32>,
    displacement_y: Vec<i32>,
    strengths: Vec<i32>,
    next: Vec<u32>,
    nodes: Vec<u32>,
    field: Vec<Complex32>,
    lines: Vec<Complex32>,
    influence: Vec<f32>,
    gradient: Vec<f32>,
    near: Vec<Segment>,
}

impl Engine {
    /// A run that stands at `clock`, with discs given in the order of their ids.
    ///
    /// # Errors
    /// [`EngineError::Init`].
    pub fn new(parameters: &Parameters, clock: Clock, discs: &[Position]) -> Result<Self, EngineError> {
        Self::with_ids(parameters, clock, (0..).zip(discs.iter().copied()))
    }

    /// A run that stands at `clock`, with discs stored in the order given, each with its id.
    ///
    /// # Errors
    /// [`EngineError::Init`].
    pub fn with_ids(
        parameters: &Parameters,
        clock: Clock,
        discs: impl IntoIterator<Item: Into<Disc>>,
    ) -> Result<Self, EngineError> {
        // A mesh that is refused must not be allocated first.
        parameters.validate().map_err(|error| EngineError::Init(InitError::Parameters(error)))?;
        let discs: Vec<Disc> = discs.into_iter().map(Into::into).take(LARGEST_PARTICLE_COUNT + 1).collect();
        if discs.len() > LARGEST_PARTICLE_COUNT {
            let capacity = LARGEST_PARTICLE_COUNT;
            return Err(EngineError::Init(InitError::TooManyParticles { capacity }));
        }
        let (count, grid) = (discs.len(), parameters.grid);
        let zero = Complex32::new(0.0, 0.0);
        let mut engine = Self {
            dynamics: Dynamics::blank(),
            ids: vec![0; count],
            slots: vec![0; count],
            x: vec![Fraction::ZERO; count],
            y: vec![Fraction::ZERO; count],
            crossings_x: vec![0; count],
            crossings_y: vec![0; count],
            force_x: vec![0; count],
            force_y: vec![0; count],
            displacement_x: vec![0; count],
            displacement_y: vec![0; count],
            strengths: vec![0; count],
            next: vec![0; count],
            nodes: vec![0; grid * grid],
            field: vec![zero; grid * grid],
            lines: vec![zero; grid * LINES],
            influence: vec![0.0; influence_length(grid)],
            gradient: vec![0.0; grid],
            near: vec![[0.0; 4]; table_length(near_cutoff(parameters))],
        };
        let (dynamics, mut memory) = engine.parts();
        *dynamics = Dynamics::new(parameters, clock, discs, &mut memory).map_err(EngineError::Init)?;
        Ok(engine)
    }

    /// Does one step and tells what happened.
    ///
    /// # Errors
    /// [`EngineError::Step`]; the state is then as it was.
    pub fn step(&mut self) -> Result<Step, EngineError> {
        let clock = self.clock();
        let (dynamics, mut memory) = self.parts();
        dynamics.step(&mut Scalar(AnySize), &mut memory).map_err(|error| EngineError::Step(error, clock))
    }

    /// How long the next step will be (unit 2⁻⁴⁰ R0²/D, 0 if none is possible) and the largest force that decides it
    /// (rounded up, unit 2⁻²⁴ kBT/R0). Looking changes nothing.
    ///
    /// # Errors
    /// [`EngineError::Force`].
    pub fn next_step(&mut self) -> Result<(u64, u64), EngineError> {
        let (dynamics, mut memory) = self.parts();
        dynamics.next_step(&mut Scalar(AnySize), &mut memory).map_err(EngineError::Force)
    }

    /// The forces on all discs at their present positions, in the order of ids, kBT/R0.
    ///
    /// # Errors
    /// [`EngineError::Force`].
    pub fn forces(&mut self) -> Result<Vec<[f64; 2]>, EngineError> {
        let (dynamics, mut memory) = self.parts();
        dynamics.forces(&mut Scalar(AnySize), &mut memory).map_err(EngineError::Force)?;
        let force = |slot: u32| {
            let slot = slot as usize;
            [force_from_units(self.force_x[slot]), force_from_units(self.force_y[slot])]
        };
        Ok(self.slots.iter().map(|&slot| force(slot)).collect())
    }

    /// Number of discs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.dynamics.count()
    }

    /// Steps done and time reached.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.dynamics.clock()
    }

    /// The state as its canonical bytes see it; gives the digest.
    #[must_use]
    pub fn state(&self) -> State<'_> {
        self.dynamics.state(&self.slots, (&self.x, &self.y), &self.strengths)
    }

    /// The positions in the order of ids.
    #[must_use]
    pub fn positions(&self) -> Vec<Position> {
        let at = |slot: u32| Position { x: self.x[slot as usize], y: self.y[slot as usize] };
        self.slots.iter().map(|&slot| at(slot)).collect()
    }

    /// The capillary strengths in the order of ids, unit 2⁻²⁰.
    #[must_use]
    pub fn strengths(&self) -> Vec<i32> {
        self.slots.iter().map(|&slot| self.strengths[slot as usize]).collect()
    }

    /// The discs in the order of ids, as [`Engine::with_ids`] takes them.
    #[must_use]
    pub fn discs(&self) -> Vec<Disc> {
        let strengths = self.strengths().into_iter();
        let discs = (0..).zip(self.positions()).zip(strengths);
        discs.map(|((id, position), strength)| Disc { id, position, strength }).collect()
    }

    /// How many borders each disc has crossed along x and y since the run was set up, in the order of ids.
    #[must_use]
    pub fn crossings(&self) -> Vec<[i32; 2]> {
        let of = |slot: u32| [self.crossings_x[slot as usize], self.crossings_y[slot as usize]];
        self.slots.iter().map(|&slot| of(slot)).collect()
    }

    /// The run and its memory.
    fn parts(&mut self) -> (&mut Dynamics, Memory<'_>) {
        let memory = Memory {
            ids: &mut self.ids,
            slots: &mut self.slots,
            x: &mut self.x,
            y: &mut self.y,
            crossings_x: &mut self.crossings_x,
            crossings_y: &mut self.crossings_y,
            force_x: &mut self.force_x,
            force_y: &mut self.force_y,
            displacement_x: &mut self.displacement_x,
            displacement_y: &mut self.displacement_y,
            strengths: &mut self.strengths,
            next: &mut self.next,
            nodes: &mut self.nodes,
            field: &mut self.field,
            lines: &mut self.lines,
            influence: &mut self.influence,
            gradient: &mut self.gradient,
            near: &mut self.near,
        };
        (&mut self.dynamics, memory)
    }
}
