//! The discs in the order of cells: columns of cells from left to right, in a column from bottom to top.
//!
//! Discs that are stored in this order have their neighbours near them in memory, and those after each other go to
//! nodes of a mesh, x·M + y, that are near each other. Discs of one cell keep their order.
//!
//! ```
//! use meniscus_wide::order::{Cells, Order, permute};
//!
//! // Cells of a quarter of the box, unit L·2⁻³².
//! let (mut x, y) = ([0xF000_0000, 0x1000_0000, 0x0800_0000], [0, 0x8000_0000, 0]);
//! let mut order = Order::default();
//! order.sort(Cells::new(1 << 30, x.len()), &x, &y);
//! assert_eq!(order.discs(), [2, 1, 0]);
//! permute(order.discs(), &mut x, &mut [0; 3]);
//! assert_eq!(x, [0x0800_0000, 0x1000_0000, 0xF000_0000]);
//! ```

use std::ops::Range;

/// How the torus is divided: columns at least as wide as a reach, and each into rows that may be finer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    columns: u32,
    rows: u32,
    /// How many rows beyond its own a disc can reach.
    span: u32,
}

impl Cells {
    /// Rows in a reach, if there are enough discs: what is looked at in vain above and below is less with more.
    const ROWS_IN_REACH: u64 = 8;

    /// Cells for neighbours up to `reach` (unit L·2⁻³²) among `count` discs.
    #[must_use]
    pub fn new(reach: u32, count: usize) -> Self {
        let count = count.clamp(1, 1 << 28) as u64;
        let fit = |reach: u64| (1 << 32) / reach.max(1);
        // More columns than that hold less than a disc in a length of their width.
        let columns = fit(u64::from(reach)).min(2 * count.isqrt() + 1);
        // With two columns, the one on the left would be the one on the right.
        let columns = if columns < 3 { 1 } else { columns };
        let rows = fit(u64::from(reach)) * Self::ROWS_IN_REACH;
        let rows = rows.min(2 * count / columns).max(1);
        let span = ((u64::from(reach) * rows) >> 32) + 1;
        Self { columns: columns as u32, rows: rows as u32, span: span as u32 }
    }

    /// How many columns there are: one, or at least three as wide as the reach.
    #[must_use]
    pub fn columns(self) -> u32 {
        self.columns
    }

    /// The column of a coordinate along x.
    #[inline(always)]
    #[must_use]
    pub fn column(self, x: u32) -> u32 {
        ((u64::from(x) * u64::from(self.columns)) >> 32) as u32
    }

    /// The row of a coordinate along y.
    #[inline(always)]
    #[must_use]
    pub fn row(self, y: u32) -> u32 {
        ((u64::from(y) * u64::from(self.rows)) >> 32) as u32
    }

    #[inline(always)]
    fn cell(self, x: u32, y: u32) -> usize {
        self.column(x) as usize * self.rows as usize + self.row(y) as usize
    }

    fn count(self) -> usize {
        self.columns as usize * self.rows as usize
    }
}

/// A permutation of discs into the order of their cells.
#[derive(Clone, Debug, Default)]
pub struct Order {
    cells: Cells,
    /// Where each cell begins, and where the last one ends.
    begins: Vec<u32>,
    discs: Vec<u32>,
    is_identity: bool,
}

impl Order {
    /// Sorts the discs at `x`, `y` (unit L·2⁻³²), fewer than 2³².
    pub fn sort(&mut self, cells: Cells, x: &[u32], y: &[u32]) {
        self.cells = cells;
        self.discs.resize(x.len().min(y.len()), 0);
        self.begins.clear();
        self.begins.resize(cells.count() + 2, 0);
        // Counted two places on, so that after the second pass each begin is in its place.
        for (&x, &y) in x.iter().zip(y) {
            if let Some(count) = self.begins.get_mut(cells.cell(x, y) + 2) {
                *count += 1;
            }
        }
        let mut sum = 0;
        for begin in &mut self.begins {
            sum += *begin;
            *begin = sum;
        }
        self.is_identity = true;
        for (disc, (&x, &y)) in (0..).zip(x.iter().zip(y)) {
            if let Some(next) = self.begins.get_mut(cells.cell(x, y) + 1) {
                self.is_identity &= *next == disc;
                if let Some(place) = self.discs.get_mut(*next as usize) {
                    *place = disc;
                }
                *next += 1;
            }
        }
    }

    /// Which disc comes at each place.
    #[must_use]
    pub fn discs(&self) -> &[u32] {
        &self.discs
    }

    /// Whether the discs were in this order already.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        self.is_identity
    }

    /// About how many pairs are within reach of each other along both axes: those of the same column, a pair counted twice
    /// and each disc with itself, but for those across the seam.
    #[must_use]
    pub fn close_pairs(&self) -> u64 {
        let Cells { rows, span, .. } = self.cells;
        let in_rows = |column: &[u32], rows: Range<usize>| {
            let at = |row: usize| column.get(row.min(column.len() - 1)).copied().map_or(0, u64::from);
            at(rows.end) - at(rows.start)
        };
        let (rows, span) = (rows as usize, span as usize);
        // The end of a column is the beginning of the next.
        let columns = (0..self.cells.count()).step_by(rows.max(1));
        let columns = columns.filter_map(|first| self.begins.get(first..=first + rows));
        let close = |column: &[u32]| -> u64 {
            let around = |row: usize| in_rows(column, row.saturating_sub(span)..row + span + 1);
            (0..rows).map(|row| in_rows(column, row..row + 1) * around(row)).sum()
        };
        columns.map(close).sum()
    }

    /// The cells.
    #[must_use]
    pub fn cells(&self) -> Cells {
        self.cells
    }

    /// The places of all discs in the rows of a column that a disc in `row` may reach, from its own row upwards, or
    /// from as far below: one range, or two where the torus closes.
    #[inline]
    #[must_use]
    pub fn reached(&self, column: u32, row: u32, reached: Reached) -> [Range<u32>; 2] {
        let Cells { rows, span, .. } = self.cells;
        let (below, above) = match reached {
            Reached::Upwards => (0, span),
            Reached::Downwards => (span, 0),
            Reached::Both => (span, span),
        };
        let length = below + above + 1;
        if length >= rows {
            return [self.places(column, 0..rows), 0..0];
        }
        let begin = if row >= below { row - below } else { row + rows - below };
        let end = begin + length;
        if end <= rows {
            [self.places(column, begin..end), 0..0]
        } else {
            [self.places(column, begin..rows), self.places(column, 0..end - rows)]
        }
    }

    #[inline]
    fn places(&self, column: u32, rows: Range<u32>) -> Range<u32> {
        let first = column as usize * self.cells.rows as usize;
        let begin = |row: u32| self.begins.get(first + row as usize).copied().unwrap_or(0);
        begin(rows.start)..begin(rows.end)
    }
}

/// Which rows are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reached {
    /// The own and those above.
    Upwards,
    /// The own and those below.
    Downwards,
    /// All of these.
    Both,
}

/// Brings the values of discs into an order: the one at place i is that of the disc `order[i]`. `scratch` is
/// working memory of as many elements. Nothing happens if there are not as many of each as places.
pub fn permute<T: Copy>(order: &[u32], values: &mut [T], scratch: &mut [T]) {
    if order.len() != values.len() || scratch.len() != values.len() {
        return;
    }
    for (place, &disc) in scratch.iter_mut().zip(order) {
        if let Some(&value) = values.get(disc as usize) {
            *place = value;
        }
    }
    values.copy_from_slice(scratch);
}
