//! The second sweep: rows of the spectrum along x, multiplied with influence function and gradient in between.
//!
//! With S = influence · ρ̂ and the gradient g, F̂ = i g S, written exchanged as the core does (`multiply` in
//! [`meniscus_core::mesh`]): (g_y S_re − g_x S_im) − i (g_x S_re + g_y S_im) at k, and
//! −(g_y S_re + g_x S_im) + i (g_x S_re − g_y S_im) at −k.

use crate::lanes::{Kernel, Lanes, Level, Rows, Sixteen};
use crate::transform::{Complex, Plan, Sink, Source, load, prefetch, store};
use meniscus_core::grid::Grid;
use meniscus_core::mesh::Tables;
use meniscus_core::transform::{AnySize, Complex32, LineTransform};

/// Row M/2: from the density's spectrum to the force's, not yet transformed back.
pub(super) fn nyquist(grid: Grid, tables: &Tables<'_>, row: &mut [Complex32]) {
    AnySize.forward(row);
    let side = grid.nodes();
    let half = side / 2;
    let along_y = tables.gradient[half];
    let influence = &tables.influence[half * (half + 1)..][..=half];
    for (x, (value, &along_x)) in row.iter_mut().zip(tables.gradient).enumerate() {
        let factor = influence[x.min(side - x)];
        let (real, imaginary) = (factor * value.re, factor * value.im);
        *value =
            Complex32::new(along_y * real - along_x * imaginary, -(along_x * real) - along_y * imaginary);
    }
}

/// What all rows share.
#[derive(Clone, Copy)]
pub(super) struct Force<'a> {
    pub(super) level: Level,
    pub(super) across: &'a Plan,
    pub(super) grid: Grid,
    pub(super) tables: &'a Tables<'a>,
    /// Row M/2 of the force.
    pub(super) nyquist: &'a [Complex32],
}

impl Force<'_> {
    /// Rows 0 … M/2 − 1 from the density's spectrum to the force's, transformed back along x, and their mirrors; row
    /// M/2 in the place of the mirror of 0.
    pub(super) fn transform(self, rows: Rows<'_>, scratch: &mut [Sixteen], pieces: usize) {
        let tiles = self.grid.nodes() / 32;
        let (upper, lower) = rows.split(tiles);
        let (lower, _) = lower.split(tiles);
        self.divide(Tiles { first: 0, upper, lower }, scratch, pieces);
    }

    fn divide(self, tiles: Tiles<'_>, scratch: &mut [Sixteen], pieces: usize) {
        let count = tiles.upper.count();
        if pieces == 1 {
            self.level.dispatch(Work { force: self, tiles, scratch });
            return;
        }
        let few = pieces / 2;
        let (scratch, scratch_after) = scratch.split_at_mut(scratch.len() / pieces * few);
        let (tiles, tiles_after) = tiles.split(count * few / pieces);
        rayon::join(
            || self.divide(tiles, scratch, few),
            || self.divide(tiles_after, scratch_after, pieces - few),
        );
    }
}

/// Tiles of sixteen rows from 16·`first` on, and their mirrors.
struct Tiles<'a> {
    first: usize,
    upper: Rows<'a>,
    lower: Rows<'a>,
}

impl Tiles<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        let (upper, upper_after) = self.upper.split(count);
        let (lower, lower_after) = self.lower.split(count);
        let after = Self { first: self.first + count, upper: upper_after, lower: lower_after };
        (Self { first: self.first, upper, lower }, after)
    }
}

struct Work<'a> {
    force: Force<'a>,
    tiles: Tiles<'a>,
    scratch: &'a mut [Sixteen],
}

impl Kernel for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { force: Force { across, grid, tables, nyquist, .. }, mut tiles, scratch } = self;
        let side = grid.nodes();
        let (spectrum, scratch) = scratch.split_at_mut(side);
        let scratch = &mut scratch[..side];
        for tile in 0..tiles.upper.count() {
            let stay = &mut Stay { soon: &tiles.lower, tile };
            across.run(lanes, spectrum, &OfTile { rows: &tiles.upper, tile }, stay);
            let first = 16 * (tiles.first + tile);
            let mut along_y = [0.0; 16];
            along_y.copy_from_slice(&tables.gradient[first..first + 16]);
            let spectrum =
                Spectrum { spectrum, influence: &tables.influence[first..], tables, along_y, side };
            across.run(
                lanes,
                scratch,
                &Upper(&spectrum),
                &mut ToTile { rows: &mut tiles.upper, tile, next: true },
            );
            let sink = &mut ToTile { rows: &mut tiles.lower, tile, next: false };
            if first == 0 {
                across.run(lanes, scratch, &LowerWithNyquist { spectrum: &spectrum, nyquist }, sink);
            } else {
                across.run(lanes, scratch, &Lower(&spectrum), sink);
            }
        }
    }
}

/// The blocks of a tile.
struct OfTile<'a, 'b> {
    rows: &'a Rows<'b>,
    tile: usize,
}

impl Source for OfTile<'_, '_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, _upper: bool, part: usize) -> Complex<L> {
        let block = self.rows.get(self.tile, index).unwrap_or(&Sixteen::ZERO);
        load(lanes, block, part)
    }
}

/// Elements stay where they are, while the blocks of a tile are brought near.
struct Stay<'a, 'b> {
    soon: &'a Rows<'b>,
    tile: usize,
}

impl Sink for Stay<'_, '_> {
    #[inline(always)]
    fn store<L: Lanes>(
        &mut self,
        lanes: L,
        place: &mut Sixteen,
        index: usize,
        part: usize,
        value: Complex<L>,
    ) {
        store(lanes, value, place, part);
        if let Some(soon) = self.soon.get(self.tile, index) {
            prefetch(lanes, soon, part);
        }
    }
}

/// To the blocks of a tile, while those of the next are brought near.
struct ToTile<'a, 'b> {
    rows: &'a mut Rows<'b>,
    tile: usize,
    next: bool,
}

impl Sink for ToTile<'_, '_> {
    #[inline(always)]
    fn store<L: Lanes>(
        &mut self,
        lanes: L,
        _place: &mut Sixteen,
        index: usize,
        part: usize,
        value: Complex<L>,
    ) {
        if let Some(block) = self.rows.get_mut(self.tile, index) {
            store(lanes, value, block, part);
        }
        if self.next
            && let Some(next) = self.rows.get(self.tile + 1, index)
        {
            prefetch(lanes, next, part);
        }
    }
}

/// The spectrum of the density in rows `first` … `first` + 15, and what it is multiplied with.
struct Spectrum<'a> {
    spectrum: &'a [Sixteen],
    /// The influence function from element `first` on: with its symmetry, row l has that of the tile's rows at l.
    influence: &'a [f32],
    tables: &'a Tables<'a>,
    /// The gradient along y of the tile's rows.
    along_y: [f32; 16],
    side: usize,
}

/// g_x S and g_y S of the same lanes.
struct Products<L: Lanes> {
    along_x: Complex<L>,
    along_y: Complex<L>,
}

impl Spectrum<'_> {
    /// Of element x, whose frequency is ± `frequency`.
    #[inline(always)]
    fn products<L: Lanes>(&self, lanes: L, x: usize, frequency: usize, part: usize) -> Products<L> {
        let value = load(lanes, &self.spectrum[x], part);
        let factor = lanes.load_f32(&self.influence[frequency * (self.side / 2 + 1)..][..16][part..]);
        let along_x = lanes.splat(self.tables.gradient[x]);
        let along_y = lanes.load_f32(&self.along_y[part..]);
        let (re, im) = (lanes.mul(factor, value.re), lanes.mul(factor, value.im));
        Products {
            along_x: Complex { re: lanes.mul(along_x, re), im: lanes.mul(along_x, im) },
            along_y: Complex { re: lanes.mul(along_y, re), im: lanes.mul(along_y, im) },
        }
    }
}

/// The force's spectrum in the rows themselves.
struct Upper<'a>(&'a Spectrum<'a>);

impl Source for Upper<'_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, upper: bool, part: usize) -> Complex<L> {
        let frequency = if upper { self.0.side - index } else { index };
        let Products { along_x, along_y } = self.0.products(lanes, index, frequency, part);
        Complex { re: lanes.sub(along_y.re, along_x.im), im: lanes.sub(lanes.negate(along_x.re), along_y.im) }
    }
}

/// The force's spectrum in the mirrors of the rows.
struct Lower<'a>(&'a Spectrum<'a>);

impl Source for Lower<'_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, upper: bool, part: usize) -> Complex<L> {
        let side = self.0.side;
        let frequency = if upper { side - index } else { index };
        let Products { along_x, along_y } =
            self.0.products(lanes, (side - index) & (side - 1), frequency, part);
        Complex { re: lanes.sub(lanes.negate(along_y.re), along_x.im), im: lanes.sub(along_x.re, along_y.im) }
    }
}

/// As [`Lower`] for the first tile; row M/2 in the place of the mirror of 0.
struct LowerWithNyquist<'a> {
    spectrum: &'a Spectrum<'a>,
    nyquist: &'a [Complex32],
}

impl Source for LowerWithNyquist<'_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, upper: bool, part: usize) -> Complex<L> {
        let value = Lower(self.spectrum).load(lanes, index, upper, part);
        if part > 0 {
            return value;
        }
        let first = lanes.equal(lanes.load_u32(&FIRST), lanes.splat_u32(1));
        let row = self.nyquist[index];
        Complex {
            re: lanes.select(first, lanes.splat(row.re), value.re),
            im: lanes.select(first, lanes.splat(row.im), value.im),
        }
    }
}

/// One in the first lane.
const FIRST: [u32; 16] = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
