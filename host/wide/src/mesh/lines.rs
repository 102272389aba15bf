//! The last sweep: lines of the field along y, to complex numbers one after another.

use super::GROUP;
use crate::lanes::{Kernel, Lanes, Level, Sixteen};
use crate::transform::{Along, Complex, LineSink, Source, load_reversed, prefetch};
use meniscus_core::grid::Grid;
use rayon::prelude::*;

/// What all lines share.
#[derive(Clone, Copy)]
pub(super) struct Lines<'a> {
    pub(super) level: Level,
    pub(super) along: &'a Along,
    pub(super) grid: Grid,
    /// Blocks of a line of the field.
    pub(super) pitch: usize,
}

impl Lines<'_> {
    /// Replaces each group of lines of the spectrum by as many rows of the field.
    pub(super) fn transform(self, field: &mut [Sixteen], scratch: &mut [Sixteen], pieces: usize) {
        if pieces == 1 {
            self.level.dispatch(Work { lines: self, field, scratch });
            return;
        }
        let groups = (self.grid.nodes() / GROUP).div_ceil(pieces);
        let field = field.par_chunks_mut(groups * GROUP * self.pitch);
        let scratch = scratch.par_chunks_mut(scratch.len() / pieces);
        field.zip(scratch).for_each(|(field, scratch)| {
            self.level.dispatch(Work { lines: self, field, scratch });
        });
    }
}

struct Work<'a> {
    lines: Lines<'a>,
    field: &'a mut [Sixteen],
    scratch: &'a mut [Sixteen],
}

impl Kernel for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Lines { along, pitch, .. } = self.lines;
        let blocks = along.blocks();
        let scratch = &mut self.scratch[..GROUP * blocks];
        let mut groups = self.field.chunks_exact_mut(GROUP * pitch).peekable();
        while let Some(group) = groups.next() {
            for (line, scratch) in scratch.chunks_exact_mut(blocks).enumerate() {
                along.begin(lanes, scratch, &Halves { group: &group[line..], half: blocks / 2 });
            }
            // All that was in the group is in the scratch memory, so that rows can take its place.
            let rows = group.chunks_exact_mut(pitch).zip(scratch.chunks_exact_mut(blocks));
            for (number, (row, scratch)) in rows.enumerate() {
                let next = groups.peek().map_or(&[][..], |next| &next[number * pitch..]);
                along.finish(lanes, scratch, &mut Row { row, next });
            }
        }
    }
}

/// A line of a group: frequencies 0 … M/2 − 1, then their mirrors, see [`super`].
struct Halves<'a> {
    group: &'a [Sixteen],
    half: usize,
}

impl Source for Halves<'_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, upper: bool, part: usize) -> Complex<L> {
        if upper {
            let mirror = &self.group[(self.half + ((2 * self.half - index) & (self.half - 1))) * GROUP];
            let mirrors = &self.group[(3 * self.half - index - 1) * GROUP];
            Complex {
                re: lanes.mirrored_reversed(mirror.re(), mirrors.re(), part),
                im: lanes.mirrored_reversed(mirror.im(), mirrors.im(), part),
            }
        } else {
            load_reversed(lanes, &self.group[index * GROUP], part)
        }
    }
}

/// A row of the field: complex numbers one after another.
struct Row<'a> {
    row: &'a mut [Sixteen],
    /// What is needed soon.
    next: &'a [Sixteen],
}

impl LineSink for Row<'_> {
    #[inline(always)]
    fn store<L: Lanes>(&mut self, lanes: L, block: usize, part: usize, value: Complex<L>) {
        let (first, second) = lanes.interleave(value.re, value.im);
        let numbers = &mut self.row[block].0[2 * part..];
        lanes.store_f32(first, numbers);
        lanes.store_f32(second, &mut numbers[L::WIDTH..]);
        if let Some(next) = self.next.get(block) {
            prefetch(lanes, next, part);
        }
    }
}
