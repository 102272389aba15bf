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

    /// Compares forces computed anew, `fresh`, with those they took the place of, `old`, along one axis. Sums over the
    /// discs are of integers, for the order in which discs are stored is not to be seen.
    pub(super) fn compare(&mut self, fresh: &[i64], old: &[i64]) {
        let (mut difference, mut force) = (0_u128, 0_u128);
        for (&fresh, &old) in fresh.iter().zip(old) {
            difference = difference.saturating_add(square(fresh.abs_diff(old)));
            force = force.saturating_add(square(fresh.unsigned_abs()));
        }
        let (differences, forces) = self.squares.unwrap_or_default();
        self.squares = Some((differences + difference as f64, forces + force as f64));
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

fn square(number: u64) -> u128 {
    u128::from(number) * u128::from(number)
}

#[cfg(test)]
mod tests {
    use super::MeshReuse;

    #[test]
    fn the_order_of_discs_does_not_show() {
        let (fresh, old) = ([1_i64 << 53, 5 << 24, -5 << 24], [0_i64; 3]);
        let squares = |order: [usize; 3]| order.map(|disc| fresh[disc] as f64 * fresh[disc] as f64);
        let sum = |order| squares(order).into_iter().fold(0.0, |sum, square| sum + square);
        assert_ne!(sum([0, 1, 2]), sum([2, 1, 0]), "sums in binary64 would show it");
        let error = |order: [usize; 3]| {
            let mut reuse = MeshReuse::default();
            reuse.compare(&order.map(|disc| fresh[disc]), &order.map(|disc| old[disc]));
            reuse.squares
        };
        for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            assert_eq!(error(order), error([0, 1, 2]));
        }
        let mut reuse = MeshReuse::default();
        reuse.compare(&[3, -4], &[0, -4]);
        reuse.compare(&[0, i64::MAX], &[0, i64::MAX]);
        let large = i64::MAX as f64;
        assert_eq!(reuse.squares, Some((9.0, 25.0 + large * large)));
    }
}
