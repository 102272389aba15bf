//! A configuration brought to life: its start, made or read, in an engine.
//!
//! ```
//! use meniscus::configuration::Configuration;
//! use meniscus::simulation::Simulation;
//!
//! let overrides = ["system.particles=100".to_owned(), "system.box=100".to_owned()];
//! let configuration = Configuration::from_preset("table-1", &overrides)?;
//! let mut simulation = Simulation::new(configuration)?;
//! simulation.engine.step()?;
//! assert_eq!(simulation.engine.count(), 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::configuration::{Configuration, Lattice, Start};
use crate::engine::{Engine, EngineError, Machinery};
use crate::files::state::State;
use crate::memory::{self, MemoryError};
use crate::start::{self, StartError};
use meniscus_core::dynamics::{Clock, Disc};
use meniscus_core::torus::{Torus, TorusError};
use meniscus_core::units::{TIME_UNITS, time_from_units};
use thiserror::Error;

/// Why a configuration could not be brought to life.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The discs could not be placed or read.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The engine refused them.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// There is not enough memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// The side is no side.
    #[error("system.box: the side {side} R0 is out of range")]
    Side {
        /// The side, R0.
        side: f64,
    },
}

/// A run in the making.
#[derive(Debug)]
pub struct Simulation {
    /// What it was made from.
    pub configuration: Configuration,
    /// The box.
    pub torus: Torus,
    /// The discs.
    pub engine: Engine,
}

impl Simulation {
    /// Places the discs as the configuration says. A start from a file takes its step and time too, if it has
    /// them: the run goes on where that state was, bit for bit from a state file, held mesh forces and all (the time in extended XYZ is exact up
    /// to 8192 R0²/D). Capillary strengths in the file take the place of the default in the configuration kept here,
    /// and so in its Jeans' time.
    ///
    /// # Errors
    /// A [`SimulationError`].
    pub fn new(configuration: Configuration) -> Result<Self, SimulationError> {
        Self::with_machinery(configuration, Machinery::default())
    }

    /// As [`Simulation::new`], in an engine that works as asked for.
    ///
    /// # Errors
    /// A [`SimulationError`].
    pub fn with_machinery(
        configuration: Configuration,
        machinery: Machinery,
    ) -> Result<Self, SimulationError> {
        memory::check(&configuration)?;
        let torus = torus(&configuration)?;
        let state = initial_state(&configuration, &torus)?;
        // What the start takes is in the estimate: it is not to be compared with what is left beside the start.
        Self::made(configuration, torus, state, machinery)
    }

    /// A run that stands at `state`, wherever the configuration says that it started; otherwise as
    /// [`Simulation::with_machinery`].
    ///
    /// # Errors
    /// A [`SimulationError`].
    pub fn at(
        configuration: Configuration,
        state: State,
        machinery: Machinery,
    ) -> Result<Self, SimulationError> {
        memory::check(&configuration)?;
        let torus = torus(&configuration)?;
        Self::made(configuration, torus, state, machinery)
    }

    fn made(
        mut configuration: Configuration,
        torus: Torus,
        state: State,
        machinery: Machinery,
    ) -> Result<Self, SimulationError> {
        let State { positions, step, time, strengths, held } = state;
        if let (Some(strengths), Start::File { path, .. }) = (strengths, &configuration.start) {
            configuration.strengths = start::settle_strengths(configuration.strengths, strengths, path)?;
        }
        let strengths = &configuration.strengths;
        let discs = (0..).zip(positions).map(|(id, position)| Disc {
            id,
            position,
            strength: strengths.of(id as usize),
        });
        let clock = Clock { step, time };
        let mut engine = Engine::with_machinery(machinery, &configuration.parameters(), clock, discs)?;
        if let Some(held) = held {
            engine.hold(&held)?;
        }
        Ok(Self { configuration, torus, engine })
    }

    /// The present state.
    #[must_use]
    pub fn state(&self) -> State {
        let Clock { step, time } = self.engine.clock();
        let (positions, strengths) = (self.engine.positions(), Some(self.engine.strengths()));
        State { step, time, positions, strengths, held: self.engine.held() }
    }

    /// The end of the run, unit 2⁻⁴⁰ R0²/D, rounded up.
    #[must_use]
    pub fn end(&self) -> u64 {
        time_units(self.configuration.end_time())
    }

    /// The present time in Jeans' times, if there is attraction.
    #[must_use]
    pub fn time_over_jeans(&self) -> Option<f64> {
        self.configuration.jeans_time().map(|jeans| time_from_units(self.engine.clock().time) / jeans)
    }
}

/// A time in R0²/D as units of 2⁻⁴⁰ R0²/D, rounded up.
#[must_use]
pub fn time_units(time: f64) -> u64 {
    (time * TIME_UNITS as f64).ceil() as u64
}

/// The box of a configuration.
///
/// # Errors
/// [`SimulationError::Side`].
pub fn torus(configuration: &Configuration) -> Result<Torus, SimulationError> {
    let side = configuration.system.side;
    Torus::new(side).map_err(|_: TorusError| SimulationError::Side { side })
}

/// Where the discs start, and when.
fn initial_state(configuration: &Configuration, torus: &Torus) -> Result<State, StartError> {
    let count = configuration.system.particles;
    match configuration.start {
        Start::Random => start::random(torus, count, configuration.seed).map(State::at_start),
        Start::Disc { radius } => start::disc(torus, count, radius, configuration.seed).map(State::at_start),
        Start::Rings { rings, spacing, per_ring } => {
            start::rings(torus, rings, per_ring, spacing).map(State::at_start)
        }
        Start::Lattice { lattice: Lattice::Square } => start::square_lattice(count).map(State::at_start),
        Start::Lattice { lattice: Lattice::Hexagonal } => {
            start::hexagonal_lattice(count).map(State::at_start)
        }
        Start::File { ref path, .. } => start::file(torus, path, count),
    }
}
