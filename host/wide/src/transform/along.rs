//! The transform of a single line with lanes along it.
//!
//! Lane r first has the elements 16j + r, of which each lane is transformed by itself. Squares of 16 × 16 are then
//! transposed, so that lanes are consecutive frequencies, and four more stages join the sixteen parts.

use super::butterflies::{Complex, Stages};
use super::factors::{self, SideBySide, SideBySideFromZero};
use super::passes::{FromSlice, Numbers, Plan, Source};
use crate::lanes::{Kernel, Lanes, Sixteen};
use meniscus_core::grid::Grid;

/// Where the frequencies go.
pub(crate) trait LineSink {
    /// Takes frequencies 16·`block` + `part` …, lane by lane.
    fn store<L: Lanes>(&mut self, lanes: L, block: usize, part: usize, value: Complex<L>);
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

    /// The first pass: from element 16j + r of a line, lane r of block j of `source`, to `scratch`.
    #[inline(always)]
    pub(crate) fn begin<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], source: &impl Source) {
        self.plan.begin(lanes, scratch, source);
    }

    /// The rest, which destroys what is in `scratch`.
    #[inline(always)]
    pub(crate) fn finish<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], sink: &mut impl LineSink) {
        self.plan.finish(lanes, scratch);
        lanes.apart(JoinParts { scratch, factors: &self.factors, sink });
    }
}

/// The last four stages.
struct JoinParts<'a, K> {
    scratch: &'a [Sixteen],
    factors: &'a [[Sixteen; 8]],
    sink: &'a mut K,
}

impl<K: LineSink> Kernel for JoinParts<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let groups = self.factors.len();
        let (squares, _) = self.scratch.as_chunks::<16>();
        let mut squares = squares.iter().zip(self.factors);
        let mut square = [Sixteen::ZERO; 16];
        if let Some((from, factors)) = squares.next() {
            lanes.transpose(from, &mut square);
            for part in (0..16).step_by(L::WIDTH) {
                let factors = SideBySide { factors, part };
                let lane = if part == 0 { 0 } else { u32::MAX };
                let zero = lanes.equal(lanes.load_u32(&LANES), lanes.splat_u32(lane));
                let x = <[Complex<L>; 16]>::from_source(lanes, &FromSlice(&square), 0, 1, part);
                let x = x.joined(lanes, SideBySideFromZero { factors, zero });
                put(lanes, x, 0, groups, part, self.sink);
            }
        }
        for (group, (from, factors)) in squares.enumerate() {
            lanes.transpose(from, &mut square);
            for part in (0..16).step_by(L::WIDTH) {
                let x = <[Complex<L>; 16]>::from_source(lanes, &FromSlice(&square), 0, 1, part);
                let x = x.joined(lanes, SideBySide { factors, part });
                put(lanes, x, group + 1, groups, part, self.sink);
            }
        }
    }
}

const LANES: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Part q of the frequencies begins at block q·M/256.
#[inline(always)]
fn put<L: Lanes>(
    lanes: L,
    x: [Complex<L>; 16],
    group: usize,
    groups: usize,
    part: usize,
    sink: &mut impl LineSink,
) {
    let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = x;
    sink.store(lanes, group, part, a);
    sink.store(lanes, group + groups, part, b);
    sink.store(lanes, group + 2 * groups, part, c);
    sink.store(lanes, group + 3 * groups, part, d);
    sink.store(lanes, group + 4 * groups, part, e);
    sink.store(lanes, group + 5 * groups, part, f);
    sink.store(lanes, group + 6 * groups, part, g);
    sink.store(lanes, group + 7 * groups, part, h);
    sink.store(lanes, group + 8 * groups, part, i);
    sink.store(lanes, group + 9 * groups, part, j);
    sink.store(lanes, group + 10 * groups, part, k);
    sink.store(lanes, group + 11 * groups, part, l);
    sink.store(lanes, group + 12 * groups, part, m);
    sink.store(lanes, group + 13 * groups, part, n);
    sink.store(lanes, group + 14 * groups, part, o);
    sink.store(lanes, group + 15 * groups, part, p);
}
