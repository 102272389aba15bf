//! Pairs of discs closer than a cut-off, by a list of cells in caller-owned memory.
//!
//! The torus is divided into c × c equal cells, as wide as the cut-off or half as wide; a disc's cell follows from its
//! coordinates by integer arithmetic, and the discs are listed in the order of their cells. With too few cells a side
//! every pair is looked at. Which pairs are found does not depend on the cells.
//!
//! ```
//! use meniscus_core::cells::{for_each_pair, Separation};
//! use meniscus_core::torus::Fraction;
//!
//! let x = [0x0000_0010, 0xFFFF_FFF0, 0x8000_0000].map(Fraction::from_bits);
//! let y = [0, 0, 0].map(Fraction::from_bits);
//! let (mut ends, mut order) = ([0; 16], [0; 3]);
//! let mut pairs = 0;
//! for_each_pair((&x, &y), 1 << 24, &mut ends, &mut order, |first, second, separation| {
//!     let along_x = if first < second { 0x20 } else { -0x20 };
//!     assert_eq!(separation, Separation { x: along_x, y: 0 });
//!     pairs += 1;
//! });
//! assert_eq!(pairs, 1);
//! ```

use crate::torus::{Fraction, minimum_image};
use core::ops::Range;

/// The separation of the nearest images of two discs, first minus second, unit L·2⁻³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Separation {
    /// Along x.
    pub x: i32,
    /// Along y.
    pub y: i32,
}

/// Calls `visit(first, second, separation)` once for every pair of discs whose separation along x and along y
/// is at most `reach` (unit L·2⁻³², below 2³¹), except for those farther apart than `reach` by more than a part in
/// 2¹⁶; which of the two is first depends on storage.
///
/// `ends` is working memory: more of it gives finer cells, its square root is the largest number of cells a
/// side. `order` has an element for each disc.
pub fn for_each_pair(
    (x, y): (&[Fraction], &[Fraction]),
    reach: u32,
    ends: &mut [u32],
    order: &mut [u32],
    mut visit: impl FnMut(usize, usize, Separation),
) {
    let mut search = Search::new((x, y), reach);
    let Some(cells) = Cells::new(reach, x.len(), ends.len()) else {
        for first in 0..x.len() {
            search.look(first, 0..first, &mut visit);
            search.finish(first, &mut visit);
        }
        return;
    };
    let list = CellList::fill(cells, (x, y), ends, order);
    for row in 0..cells.per_side {
        for column in 0..cells.per_side {
            let own = list.discs_of(row * cells.per_side + column);
            if own.is_empty() {
                continue;
            }
            let around = list.around(row, column);
            for (place, &first) in own.iter().enumerate() {
                let first = first as usize;
                let later = own.get(place + 1..).unwrap_or(&[]);
                for near in core::iter::once(later).chain(around) {
                    search.look(first, near.iter().map(|&second| second as usize), &mut visit);
                }
                search.finish(first, &mut visit);
            }
        }
    }
}

/// How many neighbours are collected before they are visited: so that the search, whose outcome no processor can
/// foresee, is free of branches.
const BATCH: usize = 32;

/// A search for the neighbours of one disc after the other.
struct Search<'a> {
    x: &'a [Fraction],
    y: &'a [Fraction],
    reach: u32,
    /// Square of the reach and a little more.
    reach_squared: u64,
    batch: [(u32, Separation); BATCH],
    length: usize,
}

impl<'a> Search<'a> {
    fn new((x, y): (&'a [Fraction], &'a [Fraction]), reach: u32) -> Self {
        let farthest = u64::from(reach) + u64::from(reach >> 16) + 1;
        let batch = [(0, Separation::default()); BATCH];
        Self { x, y, reach, reach_squared: farthest * farthest, batch, length: 0 }
    }

    /// Looks at `seconds` for neighbours of `first`.
    #[inline]
    fn look(
        &mut self,
        first: usize,
        seconds: impl Iterator<Item = usize>,
        visit: &mut impl FnMut(usize, usize, Separation),
    ) {
        let (Some(&x_first), Some(&y_first)) = (self.x.get(first), self.y.get(first)) else { return };
        for second in seconds {
            let (Some(&x_second), Some(&y_second)) = (self.x.get(second), self.y.get(second)) else { return };
            let separation =
                Separation { x: minimum_image(x_first, x_second), y: minimum_image(y_first, y_second) };
            if let Some(place) = self.batch.get_mut(self.length) {
                *place = (second as u32, separation);
            }
            self.length += usize::from(self.is_near(separation));
            if self.length == BATCH {
                self.finish(first, visit);
            }
        }
    }

    #[inline]
    fn is_near(&self, separation: Separation) -> bool {
        let (x, y) = (u64::from(separation.x.unsigned_abs()), u64::from(separation.y.unsigned_abs()));
        let reach = u64::from(self.reach);
        (x <= reach) & (y <= reach) & (x * x + y * y <= self.reach_squared)
    }

    /// Visits what was found of `first`.
    #[inline]
    fn finish(&mut self, first: usize, visit: &mut impl FnMut(usize, usize, Separation)) {
        for &(second, separation) in self.batch.iter().take(self.length) {
            visit(first, second as usize, separation);
        }
        self.length = 0;
    }
}

/// How the torus is divided.
#[derive(Clone, Copy)]
struct Cells {
    per_side: usize,
    /// How many cells on either side can hold a neighbour.
    around: usize,
}

impl Cells {
    /// Cells for `reach`, `count` discs and room for `memory` cells; `None` if there would be so few a side that a cell
    /// were its own neighbour.
    fn new(reach: u32, count: usize, memory: usize) -> Option<Self> {
        // More cells than that are empty, and looked at in vain.
        let most = memory.min(8 * count).isqrt();
        let fit = |width: u32| most.min(((1_u64 << 32) / u64::from(width.max(1))) as usize);
        // Half as wide leaves fewer discs to look at in vain, unless most cells are empty.
        let half = Self { per_side: fit(reach.div_ceil(2)), around: 2 };
        let whole = Self { per_side: fit(reach), around: 1 };
        let is_filled = half.per_side * half.per_side <= 4 * count;
        [half, whole]
            .into_iter()
            .skip(usize::from(!is_filled))
            .find(|cells| cells.per_side > 2 * cells.around)
    }

    /// The cell of a coordinate along its axis.
    fn of(&self, coordinate: Fraction) -> usize {
        ((u64::from(coordinate.to_bits()) * self.per_side as u64) >> 32) as usize
    }
}

/// The discs in the order of their cells, row by row.
struct CellList<'a> {
    cells: Cells,
    /// Where each cell ends in the order.
    ends: &'a [u32],
    order: &'a [u32],
}

impl<'a> CellList<'a> {
    fn fill(
        cells: Cells,
        (x, y): (&[Fraction], &[Fraction]),
        ends: &'a mut [u32],
        order: &'a mut [u32],
    ) -> Self {
        let cell_of = |x: Fraction, y: Fraction| cells.of(y) * cells.per_side + cells.of(x);
        let ends = ends.get_mut(..cells.per_side * cells.per_side).unwrap_or(&mut []);
        ends.fill(0);
        for (&x, &y) in x.iter().zip(y) {
            if let Some(count) = ends.get_mut(cell_of(x, y)) {
                *count += 1;
            }
        }
        let mut begin = 0;
        for end in ends.iter_mut() {
            (begin, *end) = (begin + *end, begin);
        }
        for (disc, (&x, &y)) in x.iter().zip(y).enumerate() {
            if let Some(end) = ends.get_mut(cell_of(x, y)) {
                if let Some(place) = order.get_mut(*end as usize) {
                    *place = disc as u32;
                }
                *end += 1;
            }
        }
        Self { cells, ends, order }
    }

    /// The discs of consecutive cells.
    fn discs_in(&self, cells: Range<usize>) -> &'a [u32] {
        let end_of = |cell: usize| self.ends.get(cell).map_or(0, |&end| end as usize);
        let begin = cells.start.checked_sub(1).map_or(0, end_of);
        let end = cells.end.checked_sub(1).map_or(0, end_of);
        self.order.get(begin..end).unwrap_or(&[])
    }

    fn discs_of(&self, cell: usize) -> &'a [u32] {
        self.discs_in(cell..cell + 1)
    }

    /// The discs of the cells around one that come after it: to the right, and in the rows above. Consecutive cells of
    /// a row are one piece, or two where the torus closes.
    fn around(&self, row: usize, column: usize) -> [&'a [u32]; 6] {
        let (side, around) = (self.cells.per_side, self.cells.around);
        let mut pieces = [&[][..]; 6];
        for (above, pair) in pieces.chunks_exact_mut(2).enumerate().take(around + 1) {
            let line = (row + above) % side * side;
            let (begin, length) =
                if above == 0 { (column + 1, around) } else { (column + side - around, 2 * around + 1) };
            let begin = begin % side;
            let beyond = (begin + length).saturating_sub(side);
            if let [piece, wrapped] = pair {
                *piece = self.discs_in(line + begin..line + begin + length - beyond);
                *wrapped = self.discs_in(line..line + beyond);
            }
        }
        pieces
    }
}
