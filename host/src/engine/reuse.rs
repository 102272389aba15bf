//! How much work held mesh forces save, and how far they are off.

use meniscus_core::dynamics::Step;
use serde::{Deserialize, Serialize};

/// The steps of a run that holds mesh forces (`force.mesh_refresh`), and the error of what it held.
///
/// Whenever forces are computed anew, those that they take the place of are as old as they get: the difference, rms over
/// all discs and all such moments, relative to the rms of the fresh mesh force, is the error measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshReuse {
    /// Steps done.
    pub steps: u64,
    /// Steps in which the force of the mesh was computed.
    pub transforms: u64,
    /// Sum of the squares of the differences, and of the fresh forces they go with.
    squares: Option<(f64, f64)>,
}

impl MeshReuse {
    /// Counts a step.
    pub(super) fn count(&mut self, step: &Step) {
        self.steps += 1;
        self.transforms += u64::from(step.refreshed);
    }

    /// Compares forces computed anew, `fresh`, with those they took the place of, `old`, along one axis.
    pub(super) fn compare(&mut self, fresh: &[i64], old: &[i64]) {
        let (mut difference, mut force) = self.squares.unwrap_or_default();
        for (&fresh, &old) in fresh.iter().zip(old) {
            let off = fresh.saturating_sub(old) as f64;
            difference += off * off;
            force += fresh as f64 * fresh as f64;
        }
        self.squares = Some((difference, force));
    }

    /// The share of steps that did without computing the force of the mesh, 0 to 1.
    #[must_use]
    pub fn saved(&self) -> f64 {
        if self.steps == 0 { 0.0 } else { 1.0 - self.transforms as f64 / self.steps as f64 }
    }

    /// The rms error of a held force as old as it gets, relative to the rms force of the mesh; None if no held forces
    /// were computed anew, or there is no force.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        let (difference, force) = self.squares?;
        (force > 0.0).then(|| (difference / force).sqrt())
    }
}
