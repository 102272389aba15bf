//! Whoever watches an ensemble being run.

use super::member::Member;
use super::pool::Fate;
use crate::simulation::Simulation;

/// Fewer members are run side by side than there are workers, for want of memory; each has more threads instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limited {
    /// How many at a time.
    pub side_by_side: usize,
    /// How many there might be.
    pub workers: usize,
    /// Bytes of memory that can be had, and who says so.
    pub available: Option<(u64, &'static str)>,
}

/// Whoever watches an ensemble being run; called from all threads that run members. It can change nothing.
pub trait Observer: Sync {
    /// Memory limits how many members are run side by side. Called before any begins.
    fn limited(&self, _limited: &Limited) {}

    /// A member is about to step for the first time, or for the first time since it was stopped.
    fn began(&self, _member: &Member, _simulation: &Simulation) {}

    /// A member has made a step.
    fn stepped(&self, _member: &Member, _simulation: &Simulation) {}

    /// Something should be known of a member that goes on: a checkpoint that was refused, a file that was missing.
    fn warned(&self, _member: &Member, _line: &str) {}

    /// Nothing more is done for a member.
    fn ended(&self, _member: &Member, _fate: &Fate) {}
}

/// Nobody.
#[derive(Clone, Copy, Debug)]
pub struct Nobody;

impl Observer for Nobody {}
