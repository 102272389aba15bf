//! Sixteen complex numbers side by side, and a matrix of such blocks shared by threads.

use core::marker::PhantomData;
use core::ops::Range;
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

/// Rows of a matrix of blocks that other owners have other rows of.
///
/// Element (row, column) of the matrix is block (column / 8) · `pitch` + row · 8 + column mod 8: eight columns lie
/// together.
#[derive(Debug)]
pub struct Rows<'a> {
    blocks: *mut Sixteen,
    pitch: usize,
    columns: usize,
    rows: Range<usize>,
    lifetime: PhantomData<&'a mut [Sixteen]>,
}

// SAFETY: it stands for exclusive references to the blocks of its rows, and those may be sent.
unsafe impl Send for Rows<'_> {}

impl<'a> Rows<'a> {
    /// Columns that lie together.
    pub const TOGETHER: usize = 8;

    /// All rows of a matrix, `pitch` / 8 of them, and as many columns as there are blocks for.
    #[must_use]
    pub fn new(blocks: &'a mut [Sixteen], pitch: usize) -> Self {
        let columns = blocks.len().checked_div(pitch).unwrap_or(0) * Self::TOGETHER;
        let rows = 0..pitch / Self::TOGETHER;
        Self { blocks: blocks.as_mut_ptr(), pitch, columns, rows, lifetime: PhantomData }
    }

    /// The first `count` rows, and those after them.
    #[must_use]
    pub fn split(self, count: usize) -> (Self, Self) {
        let Range { start, end } = self.rows;
        let middle = start + count.min(end - start);
        (Self { rows: start..middle, ..self }, Self { rows: middle..end, ..self })
    }

    /// How many rows.
    #[must_use]
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Where a block is, the row counted from the first of these; none if there is no such row or column.
    #[inline(always)]
    fn place(&self, row: usize, column: usize) -> Option<usize> {
        let inside = row < self.rows.end - self.rows.start && column < self.columns;
        inside.then(|| {
            let row = self.rows.start + row;
            column / Self::TOGETHER * self.pitch + row * Self::TOGETHER + column % Self::TOGETHER
        })
    }

    /// A block, the row counted from the first of these.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, row: usize, column: usize) -> Option<&Sixteen> {
        let place = self.place(row, column)?;
        // SAFETY: with column < 8 · ⌊length / pitch⌋ and row < ⌊pitch / 8⌋ the place is inside the slice that `new`
        // borrowed, and no other row and column have it. A row has one owner, since only `split` makes another of one.
        Some(unsafe { &*self.blocks.add(place) })
    }

    /// A block to write to, the row counted from the first of these.
    #[inline(always)]
    #[must_use]
    pub fn get_mut(&mut self, row: usize, column: usize) -> Option<&mut Sixteen> {
        let place = self.place(row, column)?;
        // SAFETY: as in `get`; `self` is borrowed exclusively, so that there is no other reference to its blocks.
        Some(unsafe { &mut *self.blocks.add(place) })
    }
}
