//! Repeating a golden run, and finding where two engines part.
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

mod search;

pub use search::{Contradiction, Parting, Steps, first_contradiction, reversed};

use crate::engine::{Engine, EngineError};
use crate::golden::{Difference, Golden, Record};

/// What is told while a golden run is repeated.
#[derive(Clone, Copy, Debug)]
pub enum Repeated<'a> {
    /// A step was done, so many since the beginning.
    Step(u64),
    /// A record agrees.
    Record(&'a Record),
}

/// Runs `engine` from its state to the last record of `golden` and compares at each record; `report` is told of steps
/// and of the records that agree.
///
/// Returns the first difference, at which it stops.
///
/// # Errors
/// An [`EngineError`] when a step is refused.
pub fn compare(
    golden: &Golden,
    engine: &mut Engine,
    mut report: impl FnMut(Repeated<'_>),
) -> Result<Option<Difference>, EngineError> {
    for record in &golden.records {
        while engine.clock().step < record.step {
            engine.step()?;
            report(Repeated::Step(engine.clock().step));
        }
        let found = Record::from(engine.state().digest_by_field());
        if let Some(difference) = record.difference(&found) {
            return Ok(Some(difference));
        }
        report(Repeated::Record(record));
    }
    Ok(None)
}
