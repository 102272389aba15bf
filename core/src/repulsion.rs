//! Repulsion of discs at contact: the Lennard-Jones potential cut off and shifted at its minimum.
//!
//! V(d) = 4[(2/d)¹² − (2/d)⁶ + 1/4] for d ≤ d_c = 2·2^(1/6), else 0, in kBT and R0 (Eq. 15). Below
//! [`SMALLEST_DISTANCE`] the force is that at this distance; coinciding discs are pushed along x, the one with
//! the lower id to the right.
//!
//! A pair's force is quantised once and given to both discs with opposite signs, so that the sum over all discs
//! is exactly zero.
//!
//! ```
//! use meniscus_core::cells::Separation;
//! use meniscus_core::repulsion::Repulsion;
//! use meniscus_core::units::force_from_units;
//!
//! let repulsion = Repulsion::new(64.0);
//! // Two discs in contact, d = 2 R0: 24/d = 12 kBT/R0, the first one pushed to the right.
//! let separation = Separation { x: (1 << 27), y: 0 };
//! let (x, y) = repulsion.force(separation, true).unwrap();
//! assert!((force_from_units(x) - 12.0).abs() < 1e-5 && y == 0);
//! ```

use crate::cells::Separation;
use crate::pair_force::Pair;
use crate::torus::UNITS;

/// Cut-off distance d_c = 2·2^(1/6), R0 (Eq. 15).
pub const CUTOFF: f64 = 2.244_924_096_618_746;

/// Distance below which the force of a pair no longer grows, R0.
pub const SMALLEST_DISTANCE: f64 = 0.9;

/// The force at [`SMALLEST_DISTANCE`], rounded up, kBT/R0.
pub const LARGEST_FORCE: f64 = 770_300.0;

/// The repulsion in a box of given side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion {
    reach: u32,
    unit: f32,
}

impl Repulsion {
    /// The repulsion in a box of side `side` (R0), above twice the cut-off.
    #[must_use]
    pub fn new(side: f64) -> Self {
        Self { reach: libm::ceil(CUTOFF / side * UNITS) as u32, unit: (side / UNITS) as f32 }
    }

    /// The cut-off in units of L·2⁻³², rounded up.
    #[must_use]
    pub fn reach(&self) -> u32 {
        self.reach
    }

    /// The force on the first disc of a pair, unit 2⁻²⁴ kBT/R0; `None` at or beyond the cut-off.
    ///
    /// The force on the second is the negative, bit for bit the same as with the discs exchanged.
    /// `first_is_lower` says whether the first disc has the lower id.
    #[must_use]
    pub fn force(&self, separation: Separation, first_is_lower: bool) -> Option<(i64, i64)> {
        let pair = Pair { separation, first_is_lower };
        pair.force(self.unit, CUTOFF_SQUARED, force_over_distance)
    }
}

/// The square of [`CUTOFF`], R0².
pub(crate) const CUTOFF_SQUARED: f32 = (CUTOFF * CUTOFF) as f32;

/// F(d)/d = (24/d²)[2(2/d)¹² − (2/d)⁶] from d², in kBT/R0².
pub(crate) fn force_over_distance(squared: f32) -> f32 {
    let inverse = 4.0 / squared;
    let sixth = inverse * inverse * inverse;
    6.0 * inverse * (2.0 * sixth * sixth - sixth)
}
