//! The transform of a single line with lanes along it.
//!
//! Lane r first has the elements 16j + r, of which each lane is transformed by itself. Squares of 16 × 16 are then
//! transposed, so that lanes are consecutive frequencies, and four more stages join the sixteen parts.

use super::butterflies::{Complex, Factors, Stages};
use super::factors::{self, SideBySide, SideBySideFromZero};
use super::passes::{Numbers, Plan, Source, store};
use crate::lanes::{Comb, Kernel, Lanes, Sixteen, combs};
use meniscus_core::grid::Grid;

/// Where the frequencies go.
pub(crate) trait LineSink {
    /// Places of sixteen blocks at equal distances.
    type Places<'a>: LinePlaces
    where
        Self: 'a;
    /// The places of blocks `first` + i·`distance` of sixteen frequencies each; none if there are no such blocks.
    fn places(&mut self, first: usize, distance: usize) -> Option<Self::Places<'_>>;
}

/// Places of sixteen blocks.
pub(crate) trait LinePlaces {
    /// Takes frequencies `part` … of block `I`, lane by lane.
    fn store<L: Lanes, const I: usize>(&mut self, lanes: L, part: usize, value: Complex<L>);
}

/// Tables for lines of at least [`Along::SMALLEST`] elements.
#[derive(Clone, Debug)]
pub(crate) struct Along {
    plan: Plan,
    factors: Vec<[Sixteen; 8]>,
}

impl Along {
    /// With fewer elements there are no sixteen consecutive frequencies in a part.
    pub(crate) const SMALLEST: usize = 256;

    pub(crate) fn new(grid: Grid, width: usize) -> Self {
        let turns = factors::turns(grid.nodes());
        let plan = Plan::new(grid.exponent() - 4, &turns, width);
        let factors = factors::side_by_side(&turns, plan.points());
        Self { plan, factors }
    }

    /// Blocks of a line, M/16.
    pub(crate) const fn blocks(&self) -> usize {
        self.plan.points()
    }

    /// The first pass: element 16j + r of a line is in the lane of block j of `source` that has r's bits reversed.
    #[inline(always)]
    pub(crate) fn begin<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], source: impl Source) {
        self.plan.begin(lanes, scratch, source);
    }

    /// The rest, which destroys what is in `scratch`.
    #[inline(always)]
    pub(crate) fn finish<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], sink: impl LineSink) {
        self.plan.finish(lanes, scratch);
        lanes.apart(JoinParts { scratch, factors: &self.factors, sink });
    }
}

/// The last four stages.
struct JoinParts<'a, K> {
    scratch: &'a [Sixteen],
    factors: &'a [[Sixteen; 8]],
    sink: K,
}

impl<K: LineSink> Kernel for JoinParts<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { scratch, factors, mut sink } = self;
        let groups = factors.len();
        let (squares, _) = scratch.as_chunks::<16>();
        let mut square = [Sixteen::ZERO; 16];
        for (group, (rows, factors)) in squares.iter().zip(factors).enumerate() {
            let Some(mut places) = sink.places(group, groups) else { return };
            parts!(L, part, {
                let factors = SideBySide { factors, part };
                if group == 0 {
                    let lane = if part == 0 { 0 } else { u32::MAX };
                    let zero = lanes.equal(lanes.load_u32(&LANES), lanes.splat_u32(lane));
                    join(lanes, rows, SideBySideFromZero { factors, zero }, &mut square, part, &mut places);
                } else {
                    join(lanes, rows, factors, &mut square, part, &mut places);
                }
            });
        }
    }
}

/// The last four stages for frequencies `part` … of a square: two with the columns as they come, two more by way of memory.
#[inline(always)]
fn join<L: Lanes, F: Factors<L>>(
    lanes: L,
    rows: &[Sixteen; 16],
    factors: F,
    square: &mut [Sixteen; 16],
    part: usize,
    places: &mut impl LinePlaces,
) {
    for (quarter, held) in square.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let [[a, b, c, d], [e, f, g, h]] = lanes.columns(rows, quarter, part);
        let x: [Complex<L>; 4] = [
            Complex { re: a, im: e },
            Complex { re: b, im: f },
            Complex { re: c, im: g },
            Complex { re: d, im: h },
        ];
        let [a, b, c, d] = x.joined(lanes, factors);
        let [first, second, third, fourth] = held;
        store(lanes, a, first, part);
        store(lanes, b, second, part);
        store(lanes, c, third, part);
        store(lanes, d, fourth, part);
    }
    let mut combs = combs::<4>(square);
    later::<L, F, 0, 4, 8, 12>(lanes, combs.next(), factors, part, places);
    later::<L, F, 1, 5, 9, 13>(lanes, combs.next(), factors, part, places);
    later::<L, F, 2, 6, 10, 14>(lanes, combs.next(), factors, part, places);
    later::<L, F, 3, 7, 11, 15>(lanes, combs.next(), factors, part, places);
}

/// The third and fourth stage of places `A`, `B` = `A` + 4, `C` = `A` + 8 and `D` = `A` + 12: part q of the frequencies
/// begins at block q·M/256.
#[inline(always)]
fn later<L: Lanes, F: Factors<L>, const A: usize, const B: usize, const C: usize, const D: usize>(
    lanes: L,
    comb: Option<Comb<'_, 4>>,
    factors: F,
    part: usize,
    places: &mut impl LinePlaces,
) {
    let Some(comb) = comb else { return };
    let x = <[Complex<L>; 4]>::from_comb(lanes, &comb, part);
    let [a, b, c, d] = x.joined(lanes, Later::<F, A>(factors));
    places.store::<L, A>(lanes, part, a);
    places.store::<L, B>(lanes, part, b);
    places.store::<L, C>(lanes, part, c);
    places.store::<L, D>(lanes, part, d);
}

/// Factors of the third and fourth stage as those of a first and second.
#[derive(Clone, Copy)]
struct Later<F, const NUMBER: usize>(F);

impl<L: Lanes, F: Factors<L>, const NUMBER: usize> Factors<L> for Later<F, NUMBER> {
    #[inline(always)]
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        match (index, NUMBER) {
            (0, 0 | 1) => self.0.times(lanes, 2 + NUMBER, x),
            (0, _) => self.0.times_turned(lanes, NUMBER, x),
            _ => self.0.times(lanes, 4 + NUMBER, x),
        }
    }

    #[inline(always)]
    fn times_turned(self, lanes: L, _index: usize, x: Complex<L>) -> Complex<L> {
        self.0.times_turned(lanes, 4 + NUMBER, x)
    }
}

const LANES: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
