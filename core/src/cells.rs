//! Pairs of discs closer than a cut-off, by a list of cells in caller-owned memory.
//!
//! The torus is divided into c × c equal cells at least as wide as the cut-off; a disc's cell follows from its
//! coordinates by integer arithmetic. With fewer than three cells a side every pair is looked at.
//!
//! ```
//! use meniscus_core::cells::{for_each_pair, Separation};
//! use meniscus_core::torus::Fraction;
//!
//! let x = [0x0000_0010, 0xFFFF_FFF0, 0x8000_0000].map(Fraction::from_bits);
//! let y = [0, 0, 0].map(Fraction::from_bits);
//! let (mut heads, mut next) = ([0; 16], [0; 3]);
//! let mut pairs = 0;
//! for_each_pair((&x, &y), 1 << 24, &mut heads, &mut next, |first, second, separation| {
//!     let along_x = if first < second { 0x20 } else { -0x20 };
//!     assert_eq!(separation, Separation { x: along_x, y: 0 });
//!     pairs += 1;
//! });
//! assert_eq!(pairs, 1);
//! ```

use crate::torus::{Fraction, minimum_image};

/// Marks the end of a chain.
const END: u32 = u32::MAX;

/// The separation of the nearest images of two discs, first minus second, unit L·2⁻³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Separation {
    /// Along x.
    pub x: i32,
    /// Along y.
    pub y: i32,
}

/// Calls `visit(first, second, separation)` once for every pair of discs whose separation along x and along y
/// is at most `reach` (unit L·2⁻³², below 2³¹); which of the two is first depends on storage.
///
/// `heads` is working memory: more of it gives finer cells, its square root is the largest number of cells a
/// side. `next` has an element for each disc.
pub fn for_each_pair(
    (x, y): (&[Fraction], &[Fraction]),
    reach: u32,
    heads: &mut [u32],
    next: &mut [u32],
    mut visit: impl FnMut(usize, usize, Separation),
) {
    let mut consider = |first: usize, second: usize| {
        let (Some(&x_first), Some(&y_first)) = (x.get(first), y.get(first)) else { return };
        let (Some(&x_second), Some(&y_second)) = (x.get(second), y.get(second)) else { return };
        let separation =
            Separation { x: minimum_image(x_first, x_second), y: minimum_image(y_first, y_second) };
        if separation.x.unsigned_abs() <= reach && separation.y.unsigned_abs() <= reach {
            visit(first, second, separation);
        }
    };
    let cells = cells_per_side(reach, heads.len());
    if cells < 3 {
        for first in 0..x.len() {
            for second in 0..first {
                consider(first, second);
            }
        }
        return;
    }
    let list = CellList::fill(cells, (x, y), heads, next);
    for (first, (&x, &y)) in x.iter().zip(y).enumerate() {
        list.for_each_in_chain(list.next_of(first), |second| consider(first, second));
        let (column, row) = (cell_of(x, cells), cell_of(y, cells));
        let (right, left) = ((column + 1) % cells, (column + cells - 1) % cells);
        let above = (row + 1) % cells;
        for (column, row) in [(right, row), (left, above), (column, above), (right, above)] {
            list.for_each_in_chain(list.head_of(column, row), |second| consider(first, second));
        }
    }
}

/// The number of cells a side: as many as fit `memory`, none narrower than `reach`.
fn cells_per_side(reach: u32, memory: usize) -> usize {
    let fit = (1_u64 << 32) / u64::from(reach.max(1));
    memory.isqrt().min(fit as usize)
}

/// The cell of a coordinate along its axis.
fn cell_of(coordinate: Fraction, cells: usize) -> usize {
    ((u64::from(coordinate.to_bits()) * cells as u64) >> 32) as usize
}

/// Chains of discs, one a cell.
struct CellList<'a> {
    cells: usize,
    heads: &'a [u32],
    next: &'a [u32],
}

impl<'a> CellList<'a> {
    fn fill(
        cells: usize,
        (x, y): (&[Fraction], &[Fraction]),
        heads: &'a mut [u32],
        next: &'a mut [u32],
    ) -> Self {
        heads.iter_mut().take(cells * cells).for_each(|head| *head = END);
        for (disc, ((&x, &y), next)) in x.iter().zip(y).zip(next.iter_mut()).enumerate() {
            if let Some(head) = heads.get_mut(cell_of(y, cells) * cells + cell_of(x, cells)) {
                *next = *head;
                *head = disc as u32;
            }
        }
        Self { cells, heads, next }
    }

    fn head_of(&self, column: usize, row: usize) -> u32 {
        self.heads.get(row * self.cells + column).copied().unwrap_or(END)
    }

    fn next_of(&self, disc: usize) -> u32 {
        self.next.get(disc).copied().unwrap_or(END)
    }

    fn for_each_in_chain(&self, head: u32, mut visit: impl FnMut(usize)) {
        let mut disc = head;
        while disc != END {
            visit(disc as usize);
            disc = self.next_of(disc as usize);
        }
    }
}
