//! The host's engine: memory in vectors, with mesh and capacity chosen at run time, and stages chosen among the wide ones,
//! in as many threads as asked for, and the core's own. All give the same bits.
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

mod chosen;
mod error;
mod reuse;
mod trace;

use chosen::ChosenStages;
pub use error::EngineError;
pub use reuse::MeshReuse;
pub use trace::{ShowsField, Stage, StageDifference, Trace, Traced};

use meniscus_core::digest::State;
use meniscus_core::dynamics::{Clock, Disc, Dynamics, InitError, Memory, Step, StepError};
use meniscus_core::influence::influence_length;
use meniscus_core::mesh::LINES;
use meniscus_core::near_part::{Segment, table_length};
use meniscus_core::pair_force::near_cutoff;
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, Parameters};
use meniscus_core::refresh::{HeldForce, HeldForces};
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::Complex32;
use meniscus_core::units::force_from_units;
use rayon::ThreadPool;

/// Who does the stages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// The wide stages of [`meniscus_wide`].
    #[default]
    Host,
    /// The core's own, one disc after the other.
    Core,
}

impl Kind {
    /// Its word on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Host => "host",
            Self::Core => "core",
        }
    }
}

/// How an engine works; nothing of it can be seen in the bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Machinery {
    /// Who does the stages.
    pub kind: Kind,
    /// Threads, at least 1. The core's own stages use one.
    pub threads: usize,
}

/// The wide stages in one thread.
impl Default for Machinery {
    fn default() -> Self {
        Self { kind: Kind::Host, threads: 1 }
    }
}

/// A run in memory of its own.
#[derive(Debug)]
pub struct Engine {
    dynamics: Dynamics,
    stages: ChosenStages,
    /// None if one thread is enough.
    threads: Option<ThreadPool>,
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
    held_x: Vec<i64>,
    held_y: Vec<i64>,
    fresh_x: Vec<i64>,
    fresh_y: Vec<i64>,
    reference_x: Vec<Fraction>,
    reference_y: Vec<Fraction>,
    next: Vec<u32>,
    nodes: Vec<u32>,
    field: Vec<Complex32>,
    lines: Vec<Complex32>,
    influence: Vec<f32>,
    gradient: Vec<f32>,
    near: Vec<Segment>,
    reuse: MeshReuse,
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
        Self::with_machinery(Machinery::default(), parameters, clock, discs)
    }

    /// As [`Engine::with_ids`], worked as asked for.
    ///
    /// # Errors
    /// [`EngineError::Init`], or [`EngineError::Threads`] if they cannot be started.
    pub fn with_machinery(
        machinery: Machinery,
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
        let stages = ChosenStages::new(machinery, parameters, count);
        let held = if parameters.mesh_refresh > 0.0 { count } else { 0 };
        let zero = Complex32::new(0.0, 0.0);
        let mesh_of_core = if machinery.kind == Kind::Core { grid } else { 0 };
        let mut engine = Self {
            dynamics: Dynamics::blank(),
            threads: stages.threads()?,
            stages,
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
            held_x: vec![0; held],
            held_y: vec![0; held],
            fresh_x: vec![0; held],
            fresh_y: vec![0; held],
            reference_x: vec![Fraction::ZERO; held],
            reference_y: vec![Fraction::ZERO; held],
            next: vec![0; count],
            nodes: vec![0; grid * grid],
            field: vec![zero; mesh_of_core * mesh_of_core],
            lines: vec![zero; mesh_of_core * LINES],
            influence: vec![0.0; influence_length(grid)],
            gradient: vec![0.0; grid],
            near: vec![[0.0; 4]; table_length(near_cutoff(parameters))],
            reuse: MeshReuse::default(),
        };
        engine.work(|dynamics, _, memory| {
            *dynamics = Dynamics::new(parameters, clock, discs, memory).map_err(EngineError::Init)?;
            Ok(())
        })?;
        Ok(engine)
    }

    /// Goes on with the mesh forces that were held in the state the run starts from, in the order of ids. A run that
    /// holds none ignores them.
    ///
    /// # Errors
    /// [`EngineError::Init`]; the run then computes them anew.
    pub fn hold(&mut self, held: &[HeldForce]) -> Result<(), EngineError> {
        self.work(|dynamics, _, memory| dynamics.hold(held.iter().copied(), memory))
            .map_err(EngineError::Init)
    }

    /// Goes on with the borders that each disc has crossed along x and y before, in the order of ids.
    ///
    /// # Errors
    /// [`EngineError::Crossings`] unless there is one for each disc.
    pub fn count_crossings_from(&mut self, crossings: &[[i32; 2]]) -> Result<(), EngineError> {
        if crossings.len() != self.slots.len() {
            return Err(EngineError::Crossings { found: crossings.len(), expected: self.slots.len() });
        }
        for (&slot, &[x, y]) in self.slots.iter().zip(crossings) {
            self.crossings_x[slot as usize] = x;
            self.crossings_y[slot as usize] = y;
        }
        Ok(())
    }

    /// Goes on with what an engine before this one has told by [`Engine::mesh_reuse`].
    pub fn count_mesh_reuse_from(&mut self, reuse: MeshReuse) {
        self.reuse = reuse;
    }

    /// Does one step and tells what happened.
    ///
    /// # Errors
    /// [`EngineError::Step`]; the state is then as it was.
    pub fn step(&mut self) -> Result<Step, EngineError> {
        self.step_by(|dynamics, stages, memory| dynamics.step(stages, memory))
    }

    /// As [`Engine::step`]; what the stages hand on goes into `trace`.
    ///
    /// # Errors
    /// [`EngineError::Step`]; the state is then as it was, and the trace ends where the step did.
    pub fn traced_step(&mut self, trace: &mut Trace) -> Result<Step, EngineError> {
        let step =
            self.step_by(|dynamics, stages, memory| dynamics.step(&mut Traced::new(stages, trace), memory))?;
        trace.note_step(&step);
        Ok(step)
    }

    fn step_by(
        &mut self,
        step: impl FnOnce(&mut Dynamics, &mut ChosenStages, &mut Memory<'_>) -> Result<Step, StepError> + Send,
    ) -> Result<Step, EngineError> {
        let (clock, was_held) = (self.clock(), self.dynamics.is_held());
        let step = self.work(step).map_err(|error| EngineError::Step(error, clock))?;
        self.reuse.count(&step);
        if was_held && step.refreshed {
            self.reuse.compare(&self.held_x, &self.fresh_x);
            self.reuse.compare(&self.held_y, &self.fresh_y);
        }
        Ok(step)
    }

    /// How long the next step will be (unit 2⁻⁴⁰ R0²/D, 0 if none is possible) and the largest force that decides it
    /// (rounded up, unit 2⁻²⁴ kBT/R0). Looking changes nothing.
    ///
    /// # Errors
    /// [`EngineError::Force`].
    pub fn next_step(&mut self) -> Result<(u64, u64), EngineError> {
        self.work(|dynamics, stages, memory| dynamics.next_step(stages, memory)).map_err(EngineError::Force)
    }

    /// The forces on all discs at their present positions, in the order of ids, kBT/R0.
    ///
    /// # Errors
    /// [`EngineError::Force`].
    pub fn forces(&mut self) -> Result<Vec<[f64; 2]>, EngineError> {
        self.work(|dynamics, stages, memory| dynamics.forces(stages, memory)).map_err(EngineError::Force)?;
        let force = |slot: u32| {
            let slot = slot as usize;
            [force_from_units(self.force_x[slot]), force_from_units(self.force_y[slot])]
        };
        Ok(self.slots.iter().map(|&slot| force(slot)).collect())
    }

    /// Who does the stages.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.stages.kind()
    }

    /// Threads that the stages work in.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.threads.as_ref().map_or(1, ThreadPool::current_num_threads)
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
        self.dynamics.state(&self.slots, (&self.x, &self.y), &self.strengths, self.held_forces())
    }

    /// The mesh forces that are held, in the order of ids, as [`Engine::hold`] takes them; None if none are.
    #[must_use]
    pub fn held(&self) -> Option<Vec<HeldForce>> {
        let held = self.held_forces();
        let all = || self.slots.iter().filter_map(|&slot| held.at(slot as usize)).collect();
        self.dynamics.is_held().then(all)
    }

    /// What holding mesh forces has saved and how far it was off; None for a run that holds none.
    #[must_use]
    pub fn mesh_reuse(&self) -> Option<MeshReuse> {
        self.dynamics.refresh().holds().then_some(self.reuse)
    }

    fn held_forces(&self) -> HeldForces<'_> {
        HeldForces {
            reference_x: &self.reference_x,
            reference_y: &self.reference_y,
            force_x: &self.held_x,
            force_y: &self.held_y,
        }
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

    /// How many borders each disc has crossed along x and y since the run began, in the order of ids.
    #[must_use]
    pub fn crossings(&self) -> Vec<[i32; 2]> {
        let of = |slot: u32| [self.crossings_x[slot as usize], self.crossings_y[slot as usize]];
        self.slots.iter().map(|&slot| of(slot)).collect()
    }

    /// Does something with the run, its stages and its memory, in the threads of this engine.
    fn work<R: Send>(
        &mut self,
        task: impl FnOnce(&mut Dynamics, &mut ChosenStages, &mut Memory<'_>) -> R + Send,
    ) -> R {
        let (dynamics, stages) = (&mut self.dynamics, &mut self.stages);
        let mut memory = Memory {
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
            held_x: &mut self.held_x,
            held_y: &mut self.held_y,
            fresh_x: &mut self.fresh_x,
            fresh_y: &mut self.fresh_y,
            reference_x: &mut self.reference_x,
            reference_y: &mut self.reference_y,
            next: &mut self.next,
            nodes: &mut self.nodes,
            field: &mut self.field,
            lines: &mut self.lines,
            influence: &mut self.influence,
            gradient: &mut self.gradient,
            near: &mut self.near,
        };
        match &self.threads {
            Some(threads) => threads.install(|| task(dynamics, stages, &mut memory)),
            None => task(dynamics, stages, &mut memory),
        }
    }
}
