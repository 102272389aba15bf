//! The first step, and in it the first stage, in which two engines part.

use crate::configuration::Configuration;
use crate::engine::{Engine, EngineError, Kind, Machinery, StageDifference, Trace};
use crate::golden::{Difference, Record};
use meniscus_core::dynamics::Clock;
use std::fmt;

/// A run that can be looked at stage by stage.
pub trait Steps {
    /// Does a step; what the stages hand on goes into `trace`.
    ///
    /// # Errors
    /// An [`EngineError`] when the step is refused.
    fn traced_step(&mut self, trace: &mut Trace) -> Result<Clock, EngineError>;

    /// Where the run stands.
    fn clock(&self) -> Clock;

    /// Digests of its state.
    fn record(&self) -> Record;
}

impl Steps for Engine {
    fn traced_step(&mut self, trace: &mut Trace) -> Result<Clock, EngineError> {
        Self::traced_step(self, trace).map(|step| step.clock)
    }

    fn clock(&self) -> Clock {
        Self::clock(self)
    }

    fn record(&self) -> Record {
        self.state().digest_by_field().into()
    }
}

/// Where two engines part that ought not to.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// The step that leads to other states, counted from 1: the state after it differs, that before it does not.
    pub step: u64,
    /// What differs.
    pub parting: Parting,
}

/// What differs in a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Parting {
    /// A stage hands on another value.
    Stage(StageDifference),
    /// All stages agree, and the states do not: something that is in the state and in no stage.
    State(Difference),
    /// One of them refuses the step, or both for other reasons.
    Refusal([Option<EngineError>; 2]),
}

impl fmt::Display for Contradiction {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.parting {
            Parting::Stage(difference) => write!(formatter, "step {}, {difference}", self.step),
            Parting::State(difference) => {
                write!(formatter, "all stages agree, the states do not: {difference}")
            }
            Parting::Refusal(refusals) => {
                let said = refusals
                    .map(|refusal| refusal.map_or_else(|| "none".to_owned(), |refusal| refusal.to_string()));
                write!(formatter, "step {}, refusals: {} and {}", self.step, said[0], said[1])
            }
        }
    }
}

/// Runs two engines that stand at the same state up to step `last` side by side and compares every stage of every step;
/// None if no value differs.
///
/// # Errors
/// An [`EngineError`] when both refuse a step for the same reason.
pub fn first_contradiction(
    one: &mut impl Steps,
    other: &mut impl Steps,
    last: u64,
) -> Result<Option<Contradiction>, EngineError> {
    let state_difference = |one: &Record, other: &Record| one.difference(other).map(Parting::State);
    let mut traces = [Trace::default(), Trace::default()];
    while one.clock().step < last {
        let step = one.clock().step + 1;
        let steps = [one.traced_step(&mut traces[0]), other.traced_step(&mut traces[1])];
        let stage_difference = traces[0].first_difference(&traces[1]).map(Parting::Stage);
        let parting = match (stage_difference, steps) {
            (Some(difference), _) => Some(difference),
            (None, [Ok(_), Ok(_)]) => state_difference(&one.record(), &other.record()),
            (None, [Err(refusal), Err(same)]) if refusal == same => return Err(refusal),
            (None, refusals) => Some(Parting::Refusal(refusals.map(Result::err))),
        };
        if let Some(parting) = parting {
            return Ok(Some(Contradiction { step, parting }));
        }
    }
    Ok(None)
}

/// An engine that stands where `engine` does, held mesh forces and all, with the discs stored in reverse and worked by the
/// other kind of stages: the core's for the wide ones, the wide ones in one thread for the core's.
///
/// # Errors
/// An [`EngineError`] when it cannot be set up.
pub fn reversed(engine: &Engine, configuration: &Configuration) -> Result<Engine, EngineError> {
    let kind = match engine.kind() {
        Kind::Host => Kind::Core,
        Kind::Core => Kind::Host,
    };
    let machinery = Machinery { kind, threads: 1 };
    let discs = engine.discs().into_iter().rev();
    let mut other = Engine::with_machinery(machinery, &configuration.parameters(), engine.clock(), discs)?;
    if let Some(held) = engine.held() {
        other.hold(&held)?;
    }
    Ok(other)
}
