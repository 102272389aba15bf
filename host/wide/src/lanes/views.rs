//! Other views of the same memory.

use meniscus_core::torus::Fraction;
use meniscus_core::transform::Complex32;

/// The bits of coordinates.
#[must_use]
pub fn bits_of_fractions(fractions: &[Fraction]) -> &[u32] {
    const { assert!(size_of::<Fraction>() == 4 && align_of::<Fraction>() == 4) };
    // SAFETY: a `Fraction` is a `repr(transparent)` wrapper of the `u32` of its bits (documented by `fixed`), so that
    // both slices have the same layout, and every value of the one is a value of the other.
    unsafe { core::slice::from_raw_parts(fractions.as_ptr().cast(), fractions.len()) }
}

/// The bits of coordinates, to be changed.
#[must_use]
pub fn bits_of_fractions_mut(fractions: &mut [Fraction]) -> &mut [u32] {
    const { assert!(size_of::<Fraction>() == 4 && align_of::<Fraction>() == 4) };
    // SAFETY: as above; the one slice is borrowed for as long as the other lives.
    unsafe { core::slice::from_raw_parts_mut(fractions.as_mut_ptr().cast(), fractions.len()) }
}

/// The real and imaginary parts of complex numbers, by turns.
#[must_use]
pub fn parts_of_complex(numbers: &[Complex32]) -> &[f32] {
    const { assert!(size_of::<Complex32>() == 8 && align_of::<Complex32>() == 4) };
    // SAFETY: a `Complex32` is `repr(C)` and holds two `f32`, the real part and the imaginary part, nothing else.
    unsafe { core::slice::from_raw_parts(numbers.as_ptr().cast(), 2 * numbers.len()) }
}

macro_rules! unsigned {
    ($($shared:ident $unique:ident $signed:ty => $unsigned:ty;)*) => { $(
        /// Signed integers in two's complement.
        #[must_use]
        pub fn $shared(signed: &[$signed]) -> &[$unsigned] {
            // SAFETY: the types have the same size, alignment and values of bits.
            unsafe { core::slice::from_raw_parts(signed.as_ptr().cast(), signed.len()) }
        }

        /// Signed integers in two's complement, to be changed.
        #[must_use]
        pub fn $unique(signed: &mut [$signed]) -> &mut [$unsigned] {
            // SAFETY: the types have the same size, alignment and values of bits, and the one slice is borrowed for as
            // long as the other lives.
            unsafe { core::slice::from_raw_parts_mut(signed.as_mut_ptr().cast(), signed.len()) }
        }
    )* };
}

unsigned! {
    bits_of_i32 bits_of_i32_mut i32 => u32;
    bits_of_i64 bits_of_i64_mut i64 => u64;
}
