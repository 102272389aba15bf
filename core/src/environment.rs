//! The floating-point environment the bits rest on.
//!
//! The core needs IEEE 754 binary32 with rounding to nearest, ties to even, and subnormal numbers kept.
//! A program can switch either off (flush-to-zero, another rounding mode), so every constructor looks once.
//!
//! ```
//! assert_eq!(meniscus_core::environment::check(), Ok(()));
//! ```

use core::hint::black_box;

/// What is broken in the floating-point environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnvironmentError {
    /// Subnormal numbers are flushed to zero.
    SubnormalsFlushed,
    /// Rounding is not to nearest, ties to even.
    Rounding,
}

/// Checks one subnormal result, one subnormal operand and three roundings.
///
/// # Errors
/// An [`EnvironmentError`] that names what was found broken.
pub fn check() -> Result<(), EnvironmentError> {
    let smallest_normal = black_box(f32::MIN_POSITIVE);
    let half = black_box(smallest_normal * black_box(0.5));
    if half.to_bits() != 0x0040_0000 || (half * black_box(2.0)).to_bits() != f32::MIN_POSITIVE.to_bits() {
        return Err(EnvironmentError::SubnormalsFlushed);
    }
    let one = black_box(1.0_f32);
    let half_unit = black_box(f32::EPSILON * 0.5);
    let above_half_unit = black_box(f32::EPSILON * 0.75);
    let tie_is_even = black_box(one + half_unit) == one && black_box(-one - half_unit) == -one;
    let nearest = black_box(one + above_half_unit) == one + f32::EPSILON;
    if tie_is_even && nearest { Ok(()) } else { Err(EnvironmentError::Rounding) }
}
