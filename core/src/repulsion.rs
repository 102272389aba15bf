//! Repulsion of discs at contact: the Lennard-Jones potential cut off and shifted at its minimum.
//!
//! V(d) = 4[(2/d)¹² − (2/d)⁶ + 1/4] for d ≤ d_c = 2·2^(1/6), else 0, in kBT and R0 (Eq. 15). Below
//! [`SMALLEST_DISTANCE`] the force is that at this distance; coinciding discs are pushed along x, the one with
//! the lower id to the right.
//!
//! The law alone is here; [`crate::pair_force`] quantises it.
//!
//! ```
//! use meniscus_core::repulsion::force_over_distance;
//!
//! // Two discs in contact, d = 2 R0: F = 24/d = 12 kBT/R0.
//! assert_eq!(2.0 * force_over_distance(4.0), 12.0);
//! ```

/// Cut-off distance d_c = 2·2^(1/6), R0 (Eq. 15).
pub const CUTOFF: f64 = 2.244_924_096_618_746;

/// Distance below which the force of a pair no longer grows, R0.
pub const SMALLEST_DISTANCE: f64 = 0.9;

/// The force at [`SMALLEST_DISTANCE`], rounded up, kBT/R0.
pub const LARGEST_FORCE: f64 = 770_300.0;

/// The square of [`CUTOFF`], R0².
pub(crate) const CUTOFF_SQUARED: f32 = (CUTOFF * CUTOFF) as f32;

/// F(d)/d = (24/d²)[2(2/d)¹² − (2/d)⁶] from d² = `squared` (R0²), in kBT/R0²; of use from [`SMALLEST_DISTANCE`] to
/// [`CUTOFF`].
#[must_use]
pub fn force_over_distance(squared: f32) -> f32 {
    let inverse = 4.0 / squared;
    let sixth = inverse * inverse * inverse;
    6.0 * inverse * (2.0 * sixth * sixth - sixth)
}
