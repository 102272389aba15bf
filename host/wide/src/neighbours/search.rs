//! The search for the neighbours of a piece's discs.

use super::slices::{Slices, WINDOW};
use crate::lanes::{Kernel, LARGEST_WIDTH, Lanes};
use crate::order::{Order, Reached};
use std::ops::Range;

/// The neighbours of the discs that a piece owns, and working memory to find them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Piece {
    /// Pairs of two discs of the piece, each once.
    pub(crate) inner: Slices,
    /// Neighbours that another piece owns, which finds the same pair from the other side.
    pub(crate) outer: Slices,
    found: [Found; 2],
}

impl Piece {
    /// Pairs in the lists.
    pub(super) fn count(&self) -> usize {
        self.inner.count() + self.outer.count()
    }

    /// Bytes of the lists in use.
    pub(super) fn bytes(&self) -> usize {
        self.inner.bytes() + self.outer.bytes()
    }
}

/// What was found of consecutive discs.
#[derive(Clone, Debug, Default)]
struct Found {
    discs: Vec<u32>,
    length: usize,
    /// Where what was found of each disc begins, and the last one's ends.
    begins: Vec<u32>,
}

impl Found {
    fn clear(&mut self) {
        self.length = 0;
        self.begins.clear();
        self.begins.push(0);
    }

    #[inline(always)]
    fn push<L: Lanes>(&mut self, lanes: L, mask: L::Mask, discs: L::U32) {
        if self.discs.len() < self.length + LARGEST_WIDTH {
            self.grow();
        }
        if let Some(place) = self.discs.get_mut(self.length..).and_then(|rest| rest.first_chunk_mut()) {
            self.length += lanes.compress(mask, discs, place);
        }
    }

    #[cold]
    fn grow(&mut self) {
        self.discs.resize(2 * (self.length + 1024), 0);
    }

    #[inline(always)]
    fn end(&mut self) {
        self.begins.push(self.length as u32);
    }

    fn discs(&self) -> &[u32] {
        self.discs.get(..self.length).unwrap_or(&[])
    }
}

/// The search of one piece.
pub(super) struct Search<'a> {
    /// Coordinates of the discs as stored.
    pub(super) x: &'a [u32],
    pub(super) y: &'a [u32],
    pub(super) order: &'a Order,
    /// Coordinates and numbers of the discs in order, and at least [`LARGEST_WIDTH`] more of whatever value.
    pub(super) ordered: [&'a [u32]; 3],
    /// Pairs are neighbours if the square of their distance, (L·2⁻³²)², is below.
    pub(super) bound: f32,
    /// The discs of the piece.
    pub(super) owned: Range<u32>,
    pub(super) piece: &'a mut Piece,
}

/// The places where neighbours of the discs of a cell are looked for.
#[derive(Clone, Default)]
struct Around {
    cell: (u32, u32),
    /// In the own column upwards and in the next column: each pair is found from one side.
    ahead: [[Range<u32>; 2]; 2],
    /// In the own column downwards and in the last column.
    behind: [[Range<u32>; 2]; 2],
}

/// Which discs of the own column are looked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Above,
    Below,
}

impl Search<'_> {
    fn around(&self, column: u32, row: u32) -> Around {
        let columns = self.order.cells().columns();
        let reached = |side| self.order.reached(column, row, side);
        let beside = |column| match columns {
            1 => [0..0, 0..0],
            _ => self.order.reached(column, row, Reached::Both),
        };
        let next = if column + 1 == columns { 0 } else { column + 1 };
        let last = if column == 0 { columns - 1 } else { column - 1 };
        Around {
            cell: (column, row),
            ahead: [reached(Reached::Upwards), beside(next)],
            behind: [reached(Reached::Downwards), beside(last)],
        }
    }

    /// Whether these places hold discs of the piece only, as far as that is easily seen.
    fn owns(&self, places: &Range<u32>) -> bool {
        places.is_empty()
            || self.order.is_identity() && places.start >= self.owned.start && places.end <= self.owned.end
    }

    /// Looks at `places` for neighbours of a disc. `side` is that of the own column; `inner` says whether pairs inside
    /// the piece are meant too.
    #[inline(always)]
    fn look<L: Lanes>(
        &mut self,
        lanes: L,
        disc: &Disc<L>,
        places: &Range<u32>,
        side: Option<Side>,
        inner: bool,
    ) {
        let [x, y, discs] = self.ordered;
        let all_inner = self.owns(places);
        if all_inner && !inner {
            return;
        }
        let mut begin = places.start;
        while begin < places.end {
            let here = begin as usize;
            let x = lanes.load_u32(x.get(here..).unwrap_or(&[]));
            let y = lanes.load_u32(y.get(here..).unwrap_or(&[]));
            let discs = lanes.load_u32(discs.get(here..).unwrap_or(&[]));
            let along_x = lanes.of_i32(lanes.sub_u32(x, disc.x));
            let away = lanes.sub_u32(y, disc.y);
            let along_y = lanes.of_i32(away);
            let squared = lanes.add(lanes.mul(along_x, along_x), lanes.mul(along_y, along_y));
            let left = lanes.splat_u32(places.end - begin);
            let mut near =
                lanes.both(lanes.less(squared, disc.bound), lanes.less_u32(disc.lane_numbers, left));
            if let Some(side) = side {
                let zero = lanes.splat_u32(0);
                // Two discs at the same height: the one that is stored later counts as above.
                let (beyond, later) = match side {
                    Side::Above => (lanes.less_i32(zero, away), lanes.less_u32(disc.number, discs)),
                    Side::Below => (lanes.less_i32(away, zero), lanes.less_u32(discs, disc.number)),
                };
                let level = lanes.both(lanes.equal(away, zero), later);
                near = lanes.both(near, lanes.either(beyond, level));
            }
            let [found_inner, found_outer] = &mut self.piece.found;
            if all_inner {
                found_inner.push(lanes, near, discs);
            } else {
                let from_first = lanes.sub_u32(discs, lanes.splat_u32(self.owned.start));
                let count = lanes.splat_u32(self.owned.end - self.owned.start);
                let is_owned = lanes.less_u32(from_first, count);
                let is_foreign = lanes.less_u32(lanes.sub_u32(count, lanes.splat_u32(1)), from_first);
                if inner {
                    found_inner.push(lanes, lanes.both(near, is_owned), discs);
                }
                found_outer.push(lanes, lanes.both(near, is_foreign), discs);
            }
            begin += L::WIDTH as u32;
        }
    }
}

/// A disc whose neighbours are looked for, in all lanes.
struct Disc<L: Lanes> {
    x: L::U32,
    y: L::U32,
    number: L::U32,
    bound: L::F32,
    lane_numbers: L::U32,
}

impl Kernel for Search<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let lane_numbers = lanes.load_u32(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]);
        let cells = self.order.cells();
        let mut around = Around { cell: (u32::MAX, 0), ..Around::default() };
        self.piece.inner.clear();
        self.piece.outer.clear();
        let mut first = self.owned.start;
        while first < self.owned.end {
            let end = self.owned.end.min(first + WINDOW as u32);
            self.piece.found.iter_mut().for_each(Found::clear);
            for number in first..end {
                let (Some(&x), Some(&y)) = (self.x.get(number as usize), self.y.get(number as usize)) else {
                    return;
                };
                let cell = (cells.column(x), cells.row(y));
                if around.cell != cell {
                    around = self.around(cell.0, cell.1);
                }
                let disc = Disc::<L> {
                    x: lanes.splat_u32(x),
                    y: lanes.splat_u32(y),
                    number: lanes.splat_u32(number),
                    bound: lanes.splat(self.bound),
                    lane_numbers,
                };
                let [own, next] = &around.ahead;
                for places in own {
                    self.look(lanes, &disc, places, Some(Side::Above), true);
                }
                for places in next {
                    self.look(lanes, &disc, places, None, true);
                }
                let [own, last] = &around.behind;
                for places in own {
                    self.look(lanes, &disc, places, Some(Side::Below), false);
                }
                for places in last {
                    self.look(lanes, &disc, places, None, false);
                }
                self.piece.found.iter_mut().for_each(Found::end);
            }
            let Piece { inner, outer, found: [found_inner, found_outer] } = &mut *self.piece;
            inner.append(lanes, first, &found_inner.begins, found_inner.discs());
            if found_outer.length > 0 {
                outer.append(lanes, first, &found_outer.begins, found_outer.discs());
            }
            first = end;
        }
    }
}
