//! Sixteen complex numbers side by side.

use meniscus_core::transform::Complex32;

/// Sixteen complex numbers, two cache lines: the real parts, then the imaginary parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Sixteen(pub [f32; 32]);

impl Sixteen {
    /// All zero.
    pub const ZERO: Self = Self([0.0; 32]);

    /// The real parts.
    #[inline(always)]
    #[must_use]
    pub fn re(&self) -> &[f32; 16] {
        &self.0.as_chunks().0[0]
    }

    /// The imaginary parts.
    #[inline(always)]
    #[must_use]
    pub fn im(&self) -> &[f32; 16] {
        &self.0.as_chunks().0[1]
    }

    /// The real parts, to write to.
    #[inline(always)]
    pub fn re_mut(&mut self) -> &mut [f32; 16] {
        &mut self.0.as_chunks_mut().0[0]
    }

    /// The imaginary parts, to write to.
    #[inline(always)]
    pub fn im_mut(&mut self) -> &mut [f32; 16] {
        &mut self.0.as_chunks_mut().0[1]
    }
}

/// Blocks that hold complex numbers one after another, real part before imaginary part, seen as such.
#[must_use]
pub const fn complex_of_sixteens(blocks: &[Sixteen]) -> &[Complex32] {
    // SAFETY: a block is 32 numbers without padding, and a `Complex32` is two (`repr(C)`), aligned no more strictly.
    unsafe { core::slice::from_raw_parts(blocks.as_ptr().cast(), 16 * blocks.len()) }
}

/// As [`complex_of_sixteens`], to write to.
#[must_use]
pub const fn complex_of_sixteens_mut(blocks: &mut [Sixteen]) -> &mut [Complex32] {
    // SAFETY: as above; every value of the one is a value of the other.
    unsafe { core::slice::from_raw_parts_mut(blocks.as_mut_ptr().cast(), 16 * blocks.len()) }
}
