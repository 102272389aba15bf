//! The last sweep: lines of the field along y, to complex numbers one after another.

use super::GROUP;
use crate::lanes::{Comb, Kernel, LOWER, Lanes, Level, Runs, Sixteen, UPPER};
use crate::transform::{Along, Complex, Elements, LinePlaces, LineSink, Source, load_reversed, prefetch};
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
        for group in self.field.chunks_exact_mut(GROUP * pitch) {
            let next = group.as_ptr_range().end;
            for (line, scratch) in scratch.chunks_exact_mut(blocks).enumerate() {
                along.begin(lanes, scratch, Halves { group: &group[line..], half: blocks / 2 });
            }
            // All that was in the group is in the scratch memory, so that rows can take its place.
            let rows = group.chunks_exact_mut(pitch).zip(scratch.chunks_exact_mut(blocks));
            for (number, (row, scratch)) in rows.enumerate() {
                let next = next.wrapping_add(number * pitch);
                along.finish(lanes, scratch, Row { row, next });
            }
        }
    }
}

/// A line of a group: frequencies 0 … M/2 − 1, then their mirrors, see [`super`].
#[derive(Clone, Copy)]
struct Halves<'a> {
    group: &'a [Sixteen],
    half: usize,
}

impl<'a> Source for Halves<'a> {
    type Elements<const COUNT: usize> = Mirrored<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        let Self { group, half } = self;
        let distance = (stride * GROUP) as isize;
        // Block index of the second half is the mirror of blocks 2·half − index and 2·half − index − 1, which begin after
        // `half` others; the first one's mirror is the zeroth.
        Some(Mirrored {
            lower: Runs::new(group, base * GROUP, distance)?,
            mirror: Runs::new(group, (3 * half).checked_sub(base)? * GROUP, -distance)?,
            mirrors: Runs::new(group, (3 * half).checked_sub(base + 1)? * GROUP, -distance)?,
            middle: group.get((half + ((half.checked_sub(base)?) & (half - 1))) * GROUP)?,
        })
    }
}

struct Mirrored<'a, const COUNT: usize> {
    lower: Runs<'a, Sixteen, COUNT, 1, LOWER>,
    mirror: Runs<'a, Sixteen, COUNT, 1, UPPER>,
    mirrors: Runs<'a, Sixteen, COUNT, 1, UPPER>,
    /// As `mirror`, in the middle of the line.
    middle: &'a Sixteen,
}

impl<const COUNT: usize> Elements for Mirrored<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        if J < COUNT / 2 {
            return load_reversed(lanes, &self.lower.get::<J>()[0], part);
        }
        let mirror = if J == COUNT / 2 { self.middle } else { &self.mirror.get::<J>()[0] };
        let mirrors = &self.mirrors.get::<J>()[0];
        Complex {
            re: lanes.mirrored_reversed(mirror.re(), mirrors.re(), part),
            im: lanes.mirrored_reversed(mirror.im(), mirrors.im(), part),
        }
    }
}

/// A row of the field: complex numbers one after another.
struct Row<'a> {
    row: &'a mut [Sixteen],
    /// What is needed soon.
    next: *const Sixteen,
}

impl LineSink for Row<'_> {
    type Places<'a>
        = RowPlaces<'a>
    where
        Self: 'a;

    #[inline(always)]
    fn places(&mut self, first: usize, distance: usize) -> Option<RowPlaces<'_>> {
        Some(RowPlaces {
            places: Comb::new(self.row, first, distance)?,
            next: self.next.wrapping_add(first),
            distance,
        })
    }
}

struct RowPlaces<'a> {
    places: Comb<'a, 16>,
    next: *const Sixteen,
    distance: usize,
}

impl LinePlaces for RowPlaces<'_> {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(&mut self, lanes: L, part: usize, value: Complex<L>) {
        let (first, second) = lanes.interleave(value.re, value.im);
        let numbers = &mut self.places.get_mut::<I>().0[2 * part..];
        lanes.store_f32(first, numbers);
        lanes.store_f32(second, &mut numbers[L::WIDTH..]);
        prefetch(lanes, self.next.wrapping_add(I * self.distance), part);
    }
}
