//! The first sweep: columns of the mesh along y, two real ones as a complex line.

use super::GROUP;
use crate::lanes::{Comb, Kernel, Lanes, Level, Runs, Sixteen};
use crate::transform::{
    Along, Complex, Elements, LinePlaces, LineSink, Source, load, parts, prefetch, store,
};
use meniscus_core::grid::Grid;
use meniscus_core::transform::Complex32;
use rayon::prelude::*;

/// What all columns share.
#[derive(Clone, Copy)]
pub(super) struct Columns<'a> {
    pub(super) level: Level,
    pub(super) along: &'a Along,
    pub(super) grid: Grid,
    /// Blocks of a line of the field.
    pub(super) pitch: usize,
    pub(super) signed: bool,
}

impl Columns<'_> {
    /// Frequencies 0 … M/2 − 1 of all columns into the field, M/2 into `nyquist`.
    ///
    /// As in the core they are twice the spectra of the columns.
    pub(super) fn transform(
        self,
        nodes: &[u32],
        field: &mut [Sixteen],
        nyquist: &mut [Complex32],
        scratch: &mut [Sixteen],
        pieces: usize,
    ) {
        let side = self.grid.nodes();
        let (nodes, nodes_after) = nodes.split_at(nodes.len() / 2);
        let (field, field_after) = field.split_at_mut(field.len() / 2);
        let (nyquist, nyquist_after) = nyquist.split_at_mut(nyquist.len() / 2);
        if pieces == 1 {
            let fields = [field, field_after];
            let piece =
                Piece { nodes: [nodes, nodes_after], fields, nyquist: [nyquist, nyquist_after], scratch };
            self.level.dispatch(Work { columns: self, piece });
            return;
        }
        let lines = (side / 2 / GROUP).div_ceil(pieces) * GROUP;
        let nodes = nodes.par_chunks(lines * side).zip(nodes_after.par_chunks(lines * side));
        let blocks = lines * self.pitch;
        let fields = field.par_chunks_mut(blocks).zip(field_after.par_chunks_mut(blocks));
        let nyquist = nyquist.par_chunks_mut(lines).zip(nyquist_after.par_chunks_mut(lines));
        let scratch = scratch.par_chunks_mut(scratch.len() / pieces);
        nodes.zip(fields).zip(nyquist).zip(scratch).for_each(|(((nodes, fields), nyquist), scratch)| {
            let (nodes, fields, nyquist) = (nodes.into(), fields.into(), nyquist.into());
            self.level.dispatch(Work { columns: self, piece: Piece { nodes, fields, nyquist, scratch } });
        });
    }
}

/// Some columns x < M/2, and as many from x + M/2 on.
struct Piece<'a> {
    nodes: [&'a [u32]; 2],
    fields: [&'a mut [Sixteen]; 2],
    nyquist: [&'a mut [Complex32]; 2],
    scratch: &'a mut [Sixteen],
}

struct Work<'a> {
    columns: Columns<'a>,
    piece: Piece<'a>,
}

impl Kernel for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { columns: Columns { along, grid, pitch, signed, .. }, piece } = self;
        let Piece {
            nodes: [left_nodes, right_nodes],
            fields: [first, second],
            nyquist: [nyquist, nyquist_after],
            scratch,
        } = piece;
        let side = grid.nodes();
        let blocks = along.blocks();
        let (scratch, spectrum) = scratch.split_at_mut(blocks);
        let spectrum = &mut spectrum[..blocks];
        let masses = left_nodes.chunks_exact(side).zip(right_nodes.chunks_exact(side));
        let ends = nyquist.iter_mut().zip(nyquist_after);
        for (x, ((left, right), (end, end_after))) in masses.zip(ends).enumerate() {
            let (left, right) = (left.as_chunks().0, right.as_chunks().0);
            along.begin(lanes, scratch, Masses { left, right, signed });
            let next = x + 1;
            let place = next / GROUP * GROUP * pitch + next % GROUP;
            let next = Next {
                left: left_nodes.as_ptr().wrapping_add(next * side),
                right: right_nodes.as_ptr().wrapping_add(next * side),
                first: first.as_ptr().wrapping_add(place),
                second: second.as_ptr().wrapping_add(place),
            };
            along.finish(lanes, scratch, Spectrum { spectrum, next });
            let place = x / GROUP * GROUP * pitch + x % GROUP;
            lanes.apart(Split { spectrum, first: &mut first[place..], second: &mut second[place..] });
            // Frequency M/2 is its own mirror.
            let (re, im) = (spectrum[blocks / 2].re()[0], spectrum[blocks / 2].im()[0]);
            (*end, *end_after) = split_own_mirror(re, im);
        }
    }
}

/// Splits what is its own mirror into twice the left and the right column's.
#[allow(clippy::eq_op, reason = "the core's operations; of what is not a number the difference is none")]
fn split_own_mirror(re: f32, im: f32) -> (Complex32, Complex32) {
    (Complex32::new(re + re, im - im), Complex32::new(im + im, re - re))
}

/// Two columns of node masses as a complex line.
#[derive(Clone, Copy)]
struct Masses<'a> {
    left: &'a [[u32; 16]],
    right: &'a [[u32; 16]],
    signed: bool,
}

impl<'a> Source for Masses<'a> {
    type Elements<const COUNT: usize> = MassRuns<'a, COUNT>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        Some(MassRuns {
            left: Runs::new(self.left, base, stride as isize)?,
            right: Runs::new(self.right, base, stride as isize)?,
            signed: self.signed,
        })
    }
}

struct MassRuns<'a, const COUNT: usize> {
    left: Runs<'a, [u32; 16], COUNT, 1>,
    right: Runs<'a, [u32; 16], COUNT, 1>,
    signed: bool,
}

impl<const COUNT: usize> Elements for MassRuns<'_, COUNT> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        let left = lanes.load_reversed_u32(&self.left.get::<J>()[0], part);
        let right = lanes.load_reversed_u32(&self.right.get::<J>()[0], part);
        if self.signed {
            Complex { re: lanes.of_i32(left), im: lanes.of_i32(right) }
        } else {
            Complex { re: lanes.of_u32(left), im: lanes.of_u32(right) }
        }
    }
}

/// A line of frequencies in their order.
struct Spectrum<'a> {
    spectrum: &'a mut [Sixteen],
    next: Next,
}

/// Addresses of what is needed for the next columns.
#[derive(Clone, Copy)]
struct Next {
    left: *const u32,
    right: *const u32,
    first: *const Sixteen,
    second: *const Sixteen,
}

impl LineSink for Spectrum<'_> {
    type Places<'a>
        = SpectrumPlaces<'a>
    where
        Self: 'a;

    #[inline(always)]
    fn places(&mut self, first: usize, distance: usize) -> Option<SpectrumPlaces<'_>> {
        let next = Next {
            left: self.next.left.wrapping_add(16 * first),
            right: self.next.right.wrapping_add(16 * first),
            first: self.next.first.wrapping_add(GROUP * first),
            second: self.next.second.wrapping_add(GROUP * first),
        };
        Some(SpectrumPlaces { places: Comb::new(self.spectrum, first, distance)?, next, distance })
    }
}

struct SpectrumPlaces<'a> {
    places: Comb<'a, 16>,
    next: Next,
    distance: usize,
}

impl LinePlaces for SpectrumPlaces<'_> {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(&mut self, lanes: L, part: usize, value: Complex<L>) {
        store(lanes, value, self.places.get_mut::<I>(), part);
        let Next { left, right, first, second } = self.next;
        if part == 0 {
            lanes.prefetch(left.wrapping_add(16 * I * self.distance));
            lanes.prefetch(right.wrapping_add(16 * I * self.distance));
        }
        let place = GROUP * (I % 8) * self.distance;
        let next = if I < 8 { first.wrapping_add(place) } else { second.wrapping_add(place) };
        prefetch(lanes, next, part);
    }
}

/// Separates the spectra of the two columns in a line, frequencies 0 … M/2 − 1.
struct Split<'a> {
    spectrum: &'a [Sixteen],
    first: &'a mut [Sixteen],
    second: &'a mut [Sixteen],
}

impl Kernel for Split<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { spectrum, first, second } = self;
        let places = first.iter_mut().step_by(GROUP).zip(second.iter_mut().step_by(GROUP));
        // The mirrors of a block are the first of one and the others of the one before it; the first block's first is its own.
        let Some(mut mirror) = spectrum.first() else { return };
        let blocks = spectrum.iter().zip(spectrum.iter().rev()).take(spectrum.len() / 2);
        for ((block, mirrors), (first, second)) in blocks.zip(places) {
            parts!(L, part, {
                let z = load(lanes, block, part);
                let w: Complex<L> = Complex {
                    re: lanes.mirrored(mirror.re(), mirrors.re(), part),
                    im: lanes.mirrored(mirror.im(), mirrors.im(), part),
                };
                let left = Complex { re: lanes.add(z.re, w.re), im: lanes.sub(z.im, w.im) };
                let right = Complex { re: lanes.add(z.im, w.im), im: lanes.sub(w.re, z.re) };
                store(lanes, left, first, part);
                store(lanes, right, second, part);
            });
            mirror = mirrors;
        }
    }
}
