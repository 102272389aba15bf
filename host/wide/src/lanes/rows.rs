//! A matrix of blocks, whose rows are shared by threads.

use super::{Comb, Runs, Sixteen};
use core::marker::PhantomData;
use core::ops::Range;

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

    /// A row to write to and where the one after it is or would be, counted from the first of these; none if there is no
    /// such row.
    #[inline(always)]
    #[must_use]
    pub fn row_and_next(&mut self, row: usize) -> Option<(RowMut<'_>, Addresses)> {
        let inside = row < self.count();
        inside.then(|| (RowMut(self.view(row)), self.view(row.wrapping_add(1)).addresses()))
    }

    /// A row, of which nothing may be read if it is not there.
    #[inline(always)]
    fn view<'b>(&self, row: usize) -> Row<'b> {
        let first = self.blocks.wrapping_add(self.rows.start.wrapping_add(row).wrapping_mul(Self::TOGETHER));
        Row { first, pitch: self.pitch, columns: self.columns, lifetime: PhantomData }
    }
}

/// A row of a matrix of blocks.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    first: *mut Sixteen,
    pitch: usize,
    columns: usize,
    lifetime: PhantomData<&'a Sixteen>,
}

impl<'a> Row<'a> {
    /// Where its blocks are.
    #[inline(always)]
    #[must_use]
    pub fn addresses(self) -> Addresses {
        Addresses { first: self.first, pitch: self.pitch }
    }

    /// From one of the blocks at columns whose distance is a multiple of [`Rows::TOGETHER`] to the next; none unless there
    /// are all these columns.
    #[inline(always)]
    fn step<const COUNT: usize>(self, first: usize, distance: usize) -> Option<usize> {
        let last = distance.checked_mul(COUNT - 1)?.checked_add(first)?;
        let all = last < self.columns && distance.is_multiple_of(Rows::TOGETHER);
        all.then(|| self.addresses().offset(distance))
    }

    /// The blocks at columns first + i · distance; none unless there are all of them and the distance is a multiple of
    /// [`Rows::TOGETHER`].
    #[inline(always)]
    #[must_use]
    pub fn runs<const COUNT: usize>(
        self,
        first: usize,
        distance: usize,
    ) -> Option<Runs<'a, Sixteen, COUNT, 1>> {
        // SAFETY of what they do: with a column < 8 · ⌊length / pitch⌋ and the row < ⌊pitch / 8⌋ a place is inside the slice
        // that `Rows::new` borrowed, and no other row and column have it. A row has one owner, since only `split` makes
        // another `Rows` of one, and that is borrowed as long as this is.
        let step = self.step::<COUNT>(first, distance)?;
        Some(Runs { first: self.addresses().at(first), distance: step as isize, lifetime: PhantomData })
    }
}

/// Where the blocks of a row are, to bring them near.
#[derive(Clone, Copy, Debug)]
pub struct Addresses {
    first: *const Sixteen,
    pitch: usize,
}

impl Addresses {
    /// The block of a column; the address may be one where nothing is.
    #[inline(always)]
    #[must_use]
    pub fn at(self, column: usize) -> *const Sixteen {
        let place = (column / Rows::TOGETHER).wrapping_mul(self.pitch).wrapping_add(column % Rows::TOGETHER);
        self.first.wrapping_add(place)
    }

    /// From a block to that `columns` further, a multiple of [`Rows::TOGETHER`], in blocks.
    #[inline(always)]
    #[must_use]
    pub fn offset(self, columns: usize) -> usize {
        (columns / Rows::TOGETHER).wrapping_mul(self.pitch)
    }
}

/// A row of a matrix of blocks to write to.
#[derive(Debug)]
pub struct RowMut<'a>(Row<'a>);

impl RowMut<'_> {
    /// The row to read only.
    #[inline(always)]
    #[must_use]
    pub fn shared(&self) -> Row<'_> {
        self.0
    }

    /// Where its blocks are.
    #[inline(always)]
    #[must_use]
    pub fn addresses(&self) -> Addresses {
        self.0.addresses()
    }

    /// As [`Row::runs`], to write to.
    #[inline(always)]
    #[must_use]
    pub fn comb<const TEETH: usize>(&mut self, first: usize, distance: usize) -> Option<Comb<'_, TEETH>> {
        // SAFETY of what it does: as in `Row::runs`; there is one `RowMut` of a row and no other view of it, and `self` is
        // borrowed exclusively. With a step of 0 one block would have several teeth.
        let step = self.0.step::<TEETH>(first, distance).filter(|&step| step > 0)?;
        Some(Comb { first: self.0.addresses().at(first).cast_mut(), distance: step, lifetime: PhantomData })
    }
}
