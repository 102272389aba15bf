//! From discs to mesh nodes.

use super::shares::Shares;
use super::weights::{Stencil, first_node, last_node};
use crate::lanes::{Kernel, LARGEST_WIDTH, Lanes, Level};
use crate::pieces::Divisible;
use meniscus_core::grid::Grid;

/// Nodes side by side in memory that a row of a disc's nodes is added to, those beyond the order with zeros.
const ROW: usize = 8;

/// Spreads the shares of discs over the columns of the mesh that it owns; gives the largest sum on one of their nodes if
/// the shares are counted.
pub(super) struct Deposit<'a, const P: usize, const PAIRS: usize> {
    pub level: Level,
    pub grid: Grid,
    /// Bits of the coordinates of all discs.
    pub x: &'a [u32],
    pub y: &'a [u32],
    pub shares: Shares<'a>,
    /// Whether what a node holds could overflow: then additions saturate, and the largest sum is looked for.
    pub counted: bool,
    /// The first column owned, and the nodes of all that are.
    pub first_column: usize,
    pub nodes: &'a mut [u32],
}

impl<const P: usize, const PAIRS: usize> Divisible for Deposit<'_, P, PAIRS> {
    type Output = u32;

    fn divide(self, first: usize, pieces: usize) -> (Self, Self) {
        // Where the discs of these columns are divided evenly if they are sorted by x. If they are not, it is somewhere.
        let Self { level, grid, x, y, shares, counted, first_column, nodes } = self;
        let column = |x: u32| (x >> (32 - grid.exponent())) as usize;
        let end_column = first_column + nodes.len() / grid.nodes();
        let begin = x.partition_point(|&x| column(x) < first_column);
        let end = x.partition_point(|&x| column(x) < end_column).max(begin);
        let divider = x.get(begin + (end - begin) / pieces * first).copied().map_or(end_column, column);
        let at = divider.clamp(first_column, end_column) - first_column;
        let (before, after) = nodes.split_at_mut(at * grid.nodes());
        (
            Self { level, grid, x, y, shares, counted, first_column, nodes: before },
            Self { level, grid, x, y, shares, counted, first_column: first_column + at, nodes: after },
        )
    }

    fn run(self) -> u32 {
        self.level.dispatch(self)
    }

    fn unite(first: u32, second: u32) -> u32 {
        first.max(second)
    }
}

impl<const P: usize, const PAIRS: usize> Kernel for Deposit<'_, P, PAIRS> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> u32 {
        let Self { grid, x, y, shares, counted, first_column, nodes, .. } = self;
        if nodes.is_empty() {
            return 0;
        }
        nodes.fill(0);
        let mut mesh = Columns { grid, first: first_column, nodes, largest: [0; ROW] };
        let mut rows = [[[0; ROW]; LARGEST_WIDTH]; P];
        let discs = x.chunks(L::WIDTH).zip(y.chunks(L::WIDTH));
        for (group, (x, y)) in discs.enumerate() {
            let count = x.len();
            let (x, y) = (lanes.load_u32(x), lanes.load_u32(y));
            if !mesh.touched_by::<L, P>(lanes, x) {
                continue;
            }
            let mut stencil = Stencil::<L, P>::new(lanes, x, y, grid);
            shares.apply(lanes, group * L::WIDTH, &mut stencil);
            for (rows, weights) in rows.iter_mut().zip(stencil.weights) {
                let mut columns = [lanes.splat_u32(0); ROW];
                for (column, weight) in columns.iter_mut().zip(weights) {
                    *column = weight;
                }
                lanes.store_eights(columns, rows);
            }
            let first_x = lanes.array_u32(stencil.first.0);
            let first_y = lanes.array_u32(stencil.first.1);
            for (disc, (&x, &y)) in first_x.iter().zip(&first_y).enumerate().take(count) {
                let (x, y) = (x as usize, y as usize);
                if counted {
                    for (row, shares) in rows.iter().enumerate() {
                        mesh.add::<P, true>(x + row, y, &shares[disc]);
                    }
                } else {
                    for (row, shares) in rows.iter().enumerate() {
                        mesh.add::<P, false>(x + row, y, &shares[disc]);
                    }
                }
            }
        }
        mesh.largest.into_iter().fold(0, u32::max)
    }
}

/// Columns of the mesh.
struct Columns<'a> {
    grid: Grid,
    first: usize,
    nodes: &'a mut [u32],
    /// The largest sums found.
    largest: [u32; ROW],
}

impl Columns<'_> {
    /// Whether a disc at one of these `x` shares out to a node of the columns.
    #[inline(always)]
    fn touched_by<L: Lanes, const P: usize>(&self, lanes: L, x: L::U32) -> bool {
        let columns = self.nodes.len() / self.grid.nodes() + P - 1;
        let last = first_node::<L, P>(lanes, x, self.grid);
        let last = lanes.add_u32(last, lanes.splat_u32((P - 1) as u32));
        let beyond = lanes.sub_u32(last, lanes.splat_u32(self.first as u32));
        let beyond = lanes.and(beyond, last_node(lanes, self.grid));
        lanes.bits(lanes.less_i32(beyond, lanes.splat_u32(columns as u32))) != 0
    }

    /// Adds a row of shares to the nodes from (`x`, `y`) on, if they are of these columns.
    #[inline(always)]
    fn add<const P: usize, const COUNTED: bool>(&mut self, x: usize, y: usize, shares: &[u32; ROW]) {
        let grid = self.grid;
        // Columns that are not there are as far away as can be.
        let line = grid.wrap(x).wrapping_sub(self.first).wrapping_mul(grid.nodes());
        if y <= grid.nodes() - ROW {
            let row = self.nodes.get_mut(line.wrapping_add(y)..).and_then(|nodes| nodes.first_chunk_mut());
            if let Some(row) = row {
                *row = sums::<COUNTED>(row, shares, &mut self.largest);
            }
            return;
        }
        for (column, &share) in shares.iter().enumerate().take(P) {
            if let Some(node) = self.nodes.get_mut(line.wrapping_add(grid.wrap(y + column))) {
                let mut row = [0; ROW];
                row[0] = *node;
                [*node, ..] = sums::<COUNTED>(&row, &[share, 0, 0, 0, 0, 0, 0, 0], &mut self.largest);
            }
        }
    }
}

/// The sums of nodes and shares; if counted they saturate, and the largest of each column is kept.
#[inline(always)]
fn sums<const COUNTED: bool>(
    nodes: &[u32; ROW],
    shares: &[u32; ROW],
    largest: &mut [u32; ROW],
) -> [u32; ROW] {
    let mut sums = *nodes;
    for ((sum, share), largest) in sums.iter_mut().zip(shares).zip(largest) {
        if COUNTED {
            *sum = sum.saturating_add(*share);
            *largest = (*largest).max(*sum);
        } else {
            *sum = sum.wrapping_add(*share);
        }
    }
    sums
}
