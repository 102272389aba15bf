//! Fourier transforms of many numbers at a time, with microfft's graph of operations.
//!
//! Two ways, the same bits: sixteen lines side by side, a lane each ([`Transform::forward`]), and one line with lanes
//! along it ([`Transform::forward_along`]). Every number goes through the butterflies of
//! [`meniscus_core::transform`]; passes do up to four stages of them between memory and memory.
//!
//! ```
//! use meniscus_core::grid::Grid;
//! use meniscus_wide::lanes::{Level, Sixteen};
//! use meniscus_wide::transform::Transform;
//!
//! let mut transform = Transform::new(Grid::SMALLEST, Level::best());
//! let mut lines = [Sixteen::ZERO; 16];
//! lines[0].re_mut()[3] = 1.0; // an impulse in the fourth line
//! transform.forward(&mut lines);
//! assert!(lines.iter().all(|block| block.re()[3] == 1.0 && block.re()[4] == 0.0));
//! ```

/// Does something with the parts of a block, one register after the other: with two of them twice the same text, so that what is
/// the same for both is done once.
macro_rules! parts {
    ($lanes:ty, $part:ident, $body:block) => {
        if <$lanes>::WIDTH == 8 {
            {
                let $part = 0;
                $body
            }
            {
                let $part = 8;
                $body
            }
        } else {
            for $part in (0..16).step_by(<$lanes>::WIDTH) $body
        }
    };
}
pub(crate) use parts;

mod along;
mod butterflies;
mod factors;
mod passes;

pub(crate) use along::{Along, LinePlaces, LineSink};
pub(crate) use butterflies::Complex;
pub(crate) use factors::turns;
pub(crate) use passes::{
    Elements, FromSlice, InPlace, Places, Plan, Sink, Source, load, load_reversed, prefetch, store,
};

use crate::lanes::{Comb, Kernel, Lanes, Level, Runs, Sixteen};
use meniscus_core::grid::Grid;

/// Forward transforms of M points, not normalised, and the memory they need.
#[derive(Clone, Debug)]
pub struct Transform {
    level: Level,
    plan: Plan,
    along: Option<Along>,
    scratch: Vec<Sixteen>,
}

impl Transform {
    /// Transforms of lines of as many elements as a grid has nodes along a side.
    #[must_use]
    pub fn new(grid: Grid, level: Level) -> Self {
        let points = grid.nodes();
        let along = (points >= Along::SMALLEST).then(|| Along::new(grid, level.width()));
        let plan = Plan::new(grid.exponent(), &turns(points), level.width());
        Self { level, plan, along, scratch: vec![Sixteen::ZERO; points] }
    }

    /// Replaces sixteen lines by their transforms: block j has the elements j of all of them.
    ///
    /// Fewer than M blocks are left as they are, and so are those after M.
    pub fn forward(&mut self, lines: &mut [Sixteen]) {
        if let Some(lines) = lines.get_mut(..self.plan.points()) {
            self.level.dispatch(Across { plan: &self.plan, scratch: &mut self.scratch, lines });
        }
    }

    /// Replaces a line by its transform: lane r of block j has element 16j + r.
    ///
    /// Gives whether it was done: not with fewer than M/16 blocks, nor with less than 256 points.
    pub fn forward_along(&mut self, line: &mut [Sixteen]) -> bool {
        let Some(along) = &self.along else { return false };
        let Some(line) = line.get_mut(..along.blocks()) else { return false };
        self.level.dispatch(OneLine { along, scratch: &mut self.scratch, line });
        true
    }
}

struct Across<'a> {
    plan: &'a Plan,
    scratch: &'a mut [Sixteen],
    lines: &'a mut [Sixteen],
}

impl Kernel for Across<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.plan.run(lanes, self.scratch, FromSlice(self.lines), InPlace);
        self.lines.copy_from_slice(self.scratch);
    }
}

struct OneLine<'a> {
    along: &'a Along,
    scratch: &'a mut [Sixteen],
    line: &'a mut [Sixteen],
}

impl Kernel for OneLine<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.along.begin(lanes, self.scratch, Reversed(self.line));
        self.along.finish(lanes, &mut self.scratch[..self.along.blocks()], ToSlice(self.line));
    }
}

/// Blocks of a slice with their lanes in bit-reversed order.
#[derive(Clone, Copy)]
struct Reversed<'a>(&'a [Sixteen]);

impl<'a> Source for Reversed<'a> {
    type Elements<const COUNT: usize> = ReversedRuns<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        Some(ReversedRuns(Runs::new(self.0, base, stride as isize)?))
    }
}

struct ReversedRuns<'a, const COUNT: usize>(Runs<'a, Sixteen, COUNT, 1>);

impl<const COUNT: usize> Elements for ReversedRuns<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        load_reversed(lanes, &self.0.get::<J>()[0], part)
    }
}

/// Blocks to a slice.
struct ToSlice<'a>(&'a mut [Sixteen]);

impl LineSink for ToSlice<'_> {
    type Places<'a>
        = Comb<'a, 16>
    where
        Self: 'a;

    #[inline(always)]
    fn places(&mut self, first: usize, distance: usize) -> Option<Self::Places<'_>> {
        Comb::new(self.0, first, distance)
    }
}

/// Blocks in memory are places.
impl LinePlaces for Comb<'_, 16> {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(&mut self, lanes: L, part: usize, value: Complex<L>) {
        store(lanes, value, self.get_mut::<I>(), part);
    }
}
