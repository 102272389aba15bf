//! Repeating a golden run.
//!
//! ```
//! use meniscus::configuration::Configuration;
//! use meniscus::golden::Golden;
//! use meniscus::simulation::Simulation;
//! use meniscus::verification::compare;
//!
//! let overrides = ["system.particles=10".to_owned(), "mesh.grid=64".to_owned()];
//! let mut simulation = Simulation::new(Configuration::from_preset("table-1", &overrides)?)?;
//! let mut golden = Golden::new(simulation.configuration.to_toml(), "an example");
//! simulation.engine.step()?;
//! golden.record(simulation.engine.state().digest_by_field());
//!
//! let mut again = Simulation::new(Configuration::from_text("golden", &golden.configuration, &[])?)?;
//! assert_eq!(compare(&golden, &mut again.engine, |_| ())?, None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::engine::{Engine, EngineError, Kind, Machinery};
use crate::golden::{Difference, Golden, Record};
use crate::simulation::{Simulation, SimulationError};

/// Runs `engine` from its state to the last record of `golden` and compares at each record; `report` sees the
/// records that agree.
///
/// Returns the first difference, at which it stops.
///
/// # Errors
/// An [`EngineError`] when a step is refused.
pub fn compare(
    golden: &Golden,
    engine: &mut Engine,
    mut report: impl FnMut(&Record),
) -> Result<Option<Difference>, EngineError> {
    for record in &golden.records {
        while engine.clock().step < record.step {
            engine.step()?;
        }
        let found = Record::from(engine.state().digest_by_field());
        if let Some(difference) = record.difference(&found) {
            return Ok(Some(difference));
        }
        report(record);
    }
    Ok(None)
}

/// Runs the simulation twice, in its engine and in the core's with the discs stored in reverse, up to step `last`,
/// comparing after every step: by contract no step differs.
///
/// # Errors
/// A [`SimulationError`] when the run cannot be set up or a step is refused.
pub fn compare_with_core(simulation: Simulation, last: u64) -> Result<Option<Difference>, SimulationError> {
    let Simulation { configuration, mut engine, .. } = simulation;
    let reversed = engine.discs().into_iter().rev();
    let core = Machinery { kind: Kind::Core, threads: 1 };
    let mut other = Engine::with_machinery(core, &configuration.parameters(), engine.clock(), reversed)?;
    if let Some(held) = engine.held() {
        other.hold(&held)?;
    }
    while engine.clock().step < last {
        engine.step()?;
        other.step()?;
        let [expected, found] =
            [&engine, &other].map(|engine| Record::from(engine.state().digest_by_field()));
        if let Some(difference) = expected.difference(&found) {
            return Ok(Some(difference));
        }
    }
    Ok(None)
}
