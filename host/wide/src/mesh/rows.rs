//! The second sweep: rows of the spectrum along x, multiplied with influence function and gradient in between.
//!
//! With S = influence · ρ̂ and the gradient g, F̂ = i g S, written exchanged as the core does (`multiply` in
//! [`meniscus_core::mesh`]): (g_y S_re − g_x S_im) − i (g_x S_re + g_y S_im) at k, and
//! −(g_y S_re + g_x S_im) + i (g_x S_re − g_y S_im) at −k.

use crate::lanes::{
    Addresses, Comb, Kernel, LOWER, Lanes, Level, REST, Row, RowMut, Rows, Runs, Sixteen, UPPER,
};
use crate::transform::{Complex, Elements, Places, Plan, Sink, Source, load, prefetch, store};
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
            let Some((upper, next)) = tiles.upper.row_and_next(tile) else { break };
            let Some((lower, soon)) = tiles.lower.row_and_next(tile) else { break };
            across.run(lanes, spectrum, OfTile(upper.shared()), Stay { soon: lower.addresses() });
            let first = 16 * (tiles.first + tile);
            let mut along_y = [0.0; 16];
            along_y.copy_from_slice(&tables.gradient[first..first + 16]);
            let spectrum = Spectrum {
                spectrum,
                influence: &tables.influence[first..],
                pitch: side / 2 + 1,
                along_x: tables.gradient,
                along_y,
                side,
            };
            across.run(lanes, scratch, Upper(spectrum), ToTile { row: upper, next });
            let sink = ToTile { row: lower, next: soon };
            if first == 0 {
                across.run(lanes, scratch, LowerWithNyquist { spectrum, nyquist }, sink);
            } else {
                across.run(lanes, scratch, Lower(spectrum), sink);
            }
        }
    }
}

/// The blocks of a tile.
#[derive(Clone, Copy)]
struct OfTile<'a>(Row<'a>);

impl<'a> Source for OfTile<'a> {
    type Elements<const COUNT: usize> = Runs<'a, Sixteen, COUNT, 1>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        self.0.runs(base, stride)
    }
}

/// Elements stay where they are, while the blocks of a tile are brought near.
struct Stay {
    soon: Addresses,
}

impl Sink for Stay {
    type Places<'a, const COUNT: usize> = Soon;

    #[inline(always)]
    fn places<const COUNT: usize>(&mut self, base: usize, stride: usize) -> Option<Soon> {
        Some(Soon::new(self.soon, base, stride))
    }
}

/// Addresses of blocks that are of use soon.
struct Soon {
    first: *const Sixteen,
    distance: usize,
}

impl Soon {
    /// At columns base + i·stride of a row; the stride is a multiple of [`Rows::TOGETHER`].
    #[inline(always)]
    fn new(row: Addresses, base: usize, stride: usize) -> Self {
        Self { first: row.at(base), distance: row.offset(stride) }
    }

    #[inline(always)]
    fn prefetch<L: Lanes, const I: usize>(&self, lanes: L, part: usize) {
        prefetch(lanes, self.first.wrapping_add(I * self.distance), part);
    }
}

impl Places for Soon {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(
        &mut self,
        lanes: L,
        here: &mut Sixteen,
        part: usize,
        value: Complex<L>,
    ) {
        store(lanes, value, here, part);
        self.prefetch::<L, I>(lanes, part);
    }
}

/// To the blocks of a tile, while those of the next are brought near.
struct ToTile<'a> {
    row: RowMut<'a>,
    next: Addresses,
}

impl Sink for ToTile<'_> {
    type Places<'a, const COUNT: usize>
        = TilePlaces<'a, COUNT>
    where
        Self: 'a;

    #[inline(always)]
    fn places<const COUNT: usize>(&mut self, base: usize, stride: usize) -> Option<TilePlaces<'_, COUNT>> {
        let soon = Soon::new(self.next, base, stride);
        Some(TilePlaces { places: self.row.comb(base, stride)?, soon })
    }
}

struct TilePlaces<'a, const COUNT: usize> {
    places: Comb<'a, COUNT>,
    soon: Soon,
}

impl<const COUNT: usize> Places for TilePlaces<'_, COUNT> {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(
        &mut self,
        lanes: L,
        _here: &mut Sixteen,
        part: usize,
        value: Complex<L>,
    ) {
        store(lanes, value, self.places.get_mut::<I>(), part);
        self.soon.prefetch::<L, I>(lanes, part);
    }
}

/// The spectrum of the density in rows `first` … `first` + 15, and what it is multiplied with.
#[derive(Clone, Copy)]
struct Spectrum<'a> {
    spectrum: &'a [Sixteen],
    /// The influence function from element `first` on: with its symmetry, row l has that of the tile's rows at l.
    influence: &'a [f32],
    /// From a row of the influence function to the next.
    pitch: usize,
    /// The gradient along x.
    along_x: &'a [f32],
    /// The gradient along y of the tile's rows.
    along_y: [f32; 16],
    side: usize,
}

impl<'a> Spectrum<'a> {
    /// The factors of elements base + j·stride: those in the second half have the frequencies base + j·stride − side.
    #[inline(always)]
    fn factors<const COUNT: usize>(self, base: usize, stride: usize) -> Option<FactorRuns<'a, COUNT>> {
        let Self { influence, pitch, side, along_y, .. } = self;
        let distance = (stride * pitch) as isize;
        Some(FactorRuns {
            rising: Runs::new(influence, base * pitch, distance)?,
            falling: Runs::new(influence, side.checked_sub(base)? * pitch, -distance)?,
            along_y,
        })
    }
}

/// What elements of the spectrum are multiplied with.
struct FactorRuns<'a, const COUNT: usize> {
    rising: Runs<'a, f32, COUNT, 16, LOWER>,
    falling: Runs<'a, f32, COUNT, 16, UPPER>,
    along_y: [f32; 16],
}

/// g_x S and g_y S of the same lanes.
struct Products<L: Lanes> {
    along_x: Complex<L>,
    along_y: Complex<L>,
}

impl<const COUNT: usize> FactorRuns<'_, COUNT> {
    /// Of element J, which is `block` and has the gradient `along_x`.
    #[inline(always)]
    fn products<L: Lanes, const J: usize>(
        &self,
        lanes: L,
        block: &Sixteen,
        along_x: f32,
        part: usize,
    ) -> Products<L> {
        let value = load(lanes, block, part);
        let influence = if J < COUNT / 2 { self.rising.get::<J>() } else { self.falling.get::<J>() };
        let factor = lanes.load_f32(&influence[part..]);
        let along_x = lanes.splat(along_x);
        let along_y = lanes.load_f32(&self.along_y[part..]);
        let (re, im) = (lanes.mul(factor, value.re), lanes.mul(factor, value.im));
        Products {
            along_x: Complex { re: lanes.mul(along_x, re), im: lanes.mul(along_x, im) },
            along_y: Complex { re: lanes.mul(along_y, re), im: lanes.mul(along_y, im) },
        }
    }
}

/// The force's spectrum in the rows themselves.
#[derive(Clone, Copy)]
struct Upper<'a>(Spectrum<'a>);

impl<'a> Source for Upper<'a> {
    type Elements<const COUNT: usize> = UpperRuns<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        Some(UpperRuns {
            blocks: Runs::new(self.0.spectrum, base, stride as isize)?,
            along_x: Runs::new(self.0.along_x, base, stride as isize)?,
            factors: self.0.factors(base, stride)?,
        })
    }
}

struct UpperRuns<'a, const COUNT: usize> {
    blocks: Runs<'a, Sixteen, COUNT, 1>,
    along_x: Runs<'a, f32, COUNT, 1>,
    factors: FactorRuns<'a, COUNT>,
}

impl<const COUNT: usize> Elements for UpperRuns<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        let (block, along_x) = (&self.blocks.get::<J>()[0], self.along_x.get::<J>()[0]);
        let Products { along_x, along_y } = self.factors.products::<L, J>(lanes, block, along_x, part);
        Complex { re: lanes.sub(along_y.re, along_x.im), im: lanes.sub(lanes.negate(along_x.re), along_y.im) }
    }
}

/// The force's spectrum in the mirrors of the rows.
#[derive(Clone, Copy)]
struct Lower<'a>(Spectrum<'a>);

impl<'a> Source for Lower<'a> {
    type Elements<const COUNT: usize> = LowerRuns<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        let Spectrum { spectrum, along_x, side, .. } = self.0;
        // Element 0 is its own mirror.
        let (mirror, step) = (side.checked_sub(base)?, -(stride as isize));
        Some(LowerRuns {
            zeroth: spectrum.get(mirror & (side - 1))?,
            blocks: Runs::new(spectrum, mirror, step)?,
            zeroth_along_x: *along_x.get(mirror & (side - 1))?,
            along_x: Runs::new(along_x, mirror, step)?,
            factors: self.0.factors(base, stride)?,
        })
    }
}

struct LowerRuns<'a, const COUNT: usize> {
    zeroth: &'a Sixteen,
    blocks: Runs<'a, Sixteen, COUNT, 1, REST>,
    zeroth_along_x: f32,
    along_x: Runs<'a, f32, COUNT, 1, REST>,
    factors: FactorRuns<'a, COUNT>,
}

impl<const COUNT: usize> Elements for LowerRuns<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        let (block, along_x) = if J == 0 {
            (self.zeroth, self.zeroth_along_x)
        } else {
            (&self.blocks.get::<J>()[0], self.along_x.get::<J>()[0])
        };
        let Products { along_x, along_y } = self.factors.products::<L, J>(lanes, block, along_x, part);
        Complex { re: lanes.sub(lanes.negate(along_y.re), along_x.im), im: lanes.sub(along_x.re, along_y.im) }
    }
}

/// As [`Lower`] for the first tile; row M/2 in the place of the mirror of 0.
#[derive(Clone, Copy)]
struct LowerWithNyquist<'a> {
    spectrum: Spectrum<'a>,
    nyquist: &'a [Complex32],
}

impl<'a> Source for LowerWithNyquist<'a> {
    type Elements<const COUNT: usize> = LowerWithNyquistRuns<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        Some(LowerWithNyquistRuns {
            lower: Lower(self.spectrum).elements(base, stride)?,
            nyquist: Runs::new(self.nyquist, base, stride as isize)?,
        })
    }
}

struct LowerWithNyquistRuns<'a, const COUNT: usize> {
    lower: LowerRuns<'a, COUNT>,
    nyquist: Runs<'a, Complex32, COUNT, 1>,
}

impl<const COUNT: usize> Elements for LowerWithNyquistRuns<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        let value = self.lower.load::<L, J>(lanes, part);
        if part > 0 {
            return value;
        }
        let first = lanes.equal(lanes.load_u32(&FIRST), lanes.splat_u32(1));
        let row = self.nyquist.get::<J>()[0];
        Complex {
            re: lanes.select(first, lanes.splat(row.re), value.re),
            im: lanes.select(first, lanes.splat(row.im), value.im),
        }
    }
}

/// One in the first lane.
const FIRST: [u32; 16] = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
