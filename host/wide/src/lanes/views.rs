//! Other views of the same memory.

use meniscus_core::torus::Fraction;

/// The bits of coordinates.
#[must_use]
pub fn bits_of_fractions(fractions: &[Fraction]) -> &[u32] {
    const { assert!(size_of::<Fraction>() == 4 && align_of::<Fraction>() == 4) };
    // SAFETY: a `Fraction` is a `repr(transparent)` wrapper of the `u32` of its bits (documented by `fixed`), so that
    // both slices have the same layout, and every value of the one is a value of the other.
    unsafe { core::slice::from_raw_parts(fractions.as_ptr().cast(), fractions.len()) }
}
