//! The quanta in which sums are made, and why they cannot overflow.
//!
//! | quantity | held as | unit |
//! |---|---|---|
//! | mass on a mesh node | `u32` | 2⁻²⁰ discs, see [`crate::assignment`] |
//! | force component | `i64` | 2⁻²⁴ kBT/R0 |
//! | time step, time | `u64` | 2⁻⁴⁰ R0²/D |
//!
//! # The bound of the total force
//! A pair repels with at most [`crate::repulsion::LARGEST_FORCE`] ≈ 7.7·10⁵ kBT/R0, below 1.3·10¹³ units. Up to
//! 2¹⁹ discs may all be in one place: together they repel with less than 2¹⁹ · 1.3·10¹³ < 6.9·10¹⁸ units. Of more discs, up to
//! [`LARGEST_PARTICLE_COUNT`](crate::parameters::LARGEST_PARTICLE_COUNT) = 2²², those within the cut-off lie in 3 × 3
//! cells of at most 2¹⁵ discs each, see [`crate::crowding`], and repel with less than 9 · 2¹⁵ · 1.3·10¹³ < 3.9·10¹⁸ units.
//!
//! The mesh adds, with V0 f_i f_j ≤ 1000 kBT and h ≥ R0/8, at most 6 N V0/h: the sum of the moduli of all modes of
//! the influence function times its gradient is about 3.0 V0/h per disc in the paper's schemes, whatever the mesh, and
//! at most 5.5 V0/h of an optimal influence function with α·h ≤ 0.7. That is below 4.3·10¹⁷ units for 2¹⁹ discs and
//! below 3.4·10¹⁸ for 2²². The near part adds at most V0/0.9 R0 a pair, below 10¹⁶ or 8·10¹⁶ units, external fields
//! at most 10⁸ kBT/R0, below 1.7·10¹⁵.
//!
//! | discs | repulsion | mesh | near part | fields | sum |
//! |---|---|---|---|---|---|
//! | 2¹⁹ | 6.9·10¹⁸ | 4.3·10¹⁷ | 1.0·10¹⁶ | 1.7·10¹⁵ | 7.4·10¹⁸ |
//! | 2²² | 3.9·10¹⁸ | 3.4·10¹⁸ | 8·10¹⁶ | 1.7·10¹⁵ | 7.4·10¹⁸ |
//!
//! Both are below 2⁶³ ≈ 9.2·10¹⁸ units, whatever the positions are and in whatever order is added; a squared modulus is
//! below 2¹²⁷.
//!
//! ```
//! use meniscus_core::units::{force_from_units, round_half_even, TIME_UNITS};
//!
//! assert_eq!(round_half_even(2.5), 2);
//! assert_eq!(round_half_even(-3.5), -4);
//! assert_eq!(force_from_units(1 << 24), 1.0);
//! assert_eq!(TIME_UNITS, 1_u64 << 40);
//! ```

/// Units of force in 1 kBT/R0, 2²⁴.
pub const FORCE_UNITS: f32 = 16_777_216.0;

/// Units of time in 1 R0²/D, 2⁴⁰.
pub const TIME_UNITS: u64 = 1 << 40;

/// 2²³: from here on every binary32 number is an integer.
const ALL_INTEGERS: f32 = 8_388_608.0;

/// 2²².
const SMALL: f32 = 4_194_304.0;

/// 1.5·2²³: added to a number of modulus up to 2²², it leaves the nearest integer in the last bits of the sum.
const INTEGERS: f32 = 12_582_912.0;

/// The integer nearest to `value`, ties to even; saturates at the ends of `i64`.
///
/// Exact for every finite `value`, and made of one comparison, one addition and one subtraction, so that
/// lanes of any width can do the same: up to 2²², adding 1.5·2²³ rounds to an integer, which is the difference of the
/// bits; from 2²³ on `value` is one, and in between adding and subtracting 2²³ rounds.
#[must_use]
pub fn round_half_even(value: f32) -> i64 {
    if value.abs() <= SMALL {
        let bits = (value + INTEGERS).to_bits();
        return i64::from(bits as i32 - INTEGERS.to_bits() as i32);
    }
    if value.abs() < ALL_INTEGERS {
        let shift = ALL_INTEGERS.copysign(value);
        return ((value + shift) - shift) as i64;
    }
    value as i64
}

/// A force component in kBT/R0, from units of 2⁻²⁴ kBT/R0.
#[must_use]
pub fn force_from_units(units: i64) -> f64 {
    units as f64 / f64::from(FORCE_UNITS)
}

/// A time in R0²/D, from units of 2⁻⁴⁰ R0²/D.
#[must_use]
pub fn time_from_units(units: u64) -> f64 {
    units as f64 / TIME_UNITS as f64
}
