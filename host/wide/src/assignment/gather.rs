//! From mesh nodes back to discs.

use super::Field;
use super::shares::Shares;
use super::weights::{Stencil, last_node};
use crate::lanes::{Kernel, LARGEST_WIDTH, Lanes, Level, parts_of_complex};
use crate::pieces::{Divisible, place};
use meniscus_core::assignment::DISC;
use meniscus_core::grid::Grid;
use meniscus_core::units::{FORCE_UNITS, round_half_even};

/// From weights of unit 2⁻²⁰ times kBT/R0 to units of 2⁻²⁴ kBT/R0.
const QUANTA_PER_WEIGHT: f32 = FORCE_UNITS / DISC as f32;

/// Gathers the force on discs, the P nodes of a row as `PAIRS` pairs.
pub(super) struct Gather<'a, const P: usize, const PAIRS: usize> {
    pub level: Level,
    pub grid: Grid,
    /// Bits of coordinates.
    pub x: &'a [u32],
    pub y: &'a [u32],
    pub shares: Shares<'a>,
    pub field: Field<'a>,
    /// Bits of forces, unit 2⁻²⁴ kBT/R0.
    pub force_x: &'a mut [u64],
    pub force_y: &'a mut [u64],
}

impl<const P: usize, const PAIRS: usize> Divisible for Gather<'_, P, PAIRS> {
    type Output = ();

    fn divide(self, first: usize, pieces: usize) -> (Self, Self) {
        let Self { level, grid, x, y, shares, field, force_x, force_y } = self;
        let lengths = [x.len(), y.len(), force_x.len(), force_y.len()];
        let at = place(lengths.into_iter().min().unwrap_or(0), first, pieces);
        let ((x, x_after), (y, y_after)) = (x.split_at(at), y.split_at(at));
        let (force_x, force_x_after) = force_x.split_at_mut(at);
        let (force_y, force_y_after) = force_y.split_at_mut(at);
        let (shares, shares_after) = shares.divide(at);
        let before = Self { level, grid, x, y, shares, field, force_x, force_y };
        let (x, y, shares, force_x, force_y) = (x_after, y_after, shares_after, force_x_after, force_y_after);
        (before, Self { level, grid, x, y, shares, field, force_x, force_y })
    }

    fn run(self) {
        self.level.dispatch(self);
    }

    fn unite((): (), (): ()) {}
}

impl<const P: usize, const PAIRS: usize> Kernel for Gather<'_, P, PAIRS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { grid, x, y, shares, field, force_x, force_y, .. } = self;
        let positions = x.chunks(L::WIDTH).zip(y.chunks(L::WIDTH));
        let forces = force_x.chunks_mut(L::WIDTH).zip(force_y.chunks_mut(L::WIDTH));
        for (group, ((x, y), (force_x, force_y))) in positions.zip(forces).enumerate() {
            let mut stencil = Stencil::<L, P>::new(lanes, lanes.load_u32(x), lanes.load_u32(y), grid);
            shares.apply(lanes, group * L::WIDTH, &mut stencil);
            let (mut sum_x, mut sum_y) = sums::<L, P, PAIRS>(lanes, grid, field, &stencil);
            let seam = lanes.bits(across_seam::<L, PAIRS>(lanes, grid, stencil.first.1));
            if seam != 0 {
                (sum_x, sum_y) = corrected(lanes, grid, field, &stencil, seam, (sum_x, sum_y));
            }
            lanes.store_u64(quantised(lanes, sum_x), force_x);
            lanes.store_u64(quantised(lanes, sum_y), force_y);
        }
    }
}

/// The weighted sums of the field over each disc's nodes, of no use for discs across the seam of y.
#[inline(always)]
fn sums<L: Lanes, const P: usize, const PAIRS: usize>(
    lanes: L,
    grid: Grid,
    field: Field<'_>,
    stencil: &Stencil<L, P>,
) -> (L::F32, L::F32) {
    let (mut sum_x, mut sum_y) = (lanes.splat(0.0), lanes.splat(0.0));
    let table = parts_of_complex(field.nodes);
    let pitch = lanes.splat_u32(2 * field.pitch as u32);
    let column = lanes.shl(stencil.first.1, 1);
    for (row, weights) in stencil.weights.iter().enumerate() {
        let line =
            lanes.and(lanes.add_u32(stencil.first.0, lanes.splat_u32(row as u32)), last_node(lanes, grid));
        let begin = lanes.add_u32(lanes.mul_u32(line, pitch), column);
        let runs = lanes.gather_runs::<PAIRS>(table, begin);
        let (pairs, _) = runs.as_flattened().as_chunks::<2>();
        for (&[force_x, force_y], &weight) in pairs.iter().zip(weights) {
            let weight = lanes.of_i32(weight);
            sum_x = lanes.add(sum_x, lanes.mul(weight, force_x));
            sum_y = lanes.add(sum_y, lanes.mul(weight, force_y));
        }
    }
    (sum_x, sum_y)
}

/// Discs whose pairs would reach beyond the last column.
#[inline(always)]
fn across_seam<L: Lanes, const PAIRS: usize>(lanes: L, grid: Grid, first_y: L::U32) -> L::Mask {
    let last = grid.nodes() - 2 * PAIRS;
    lanes.less_i32(lanes.splat_u32(last as u32), first_y)
}

/// The sums, those of discs across the seam done one by one.
#[inline(always)]
fn corrected<L: Lanes, const P: usize>(
    lanes: L,
    grid: Grid,
    field: Field<'_>,
    stencil: &Stencil<L, P>,
    seam: u32,
    (sum_x, sum_y): (L::F32, L::F32),
) -> (L::F32, L::F32) {
    let mut weights = [[[0; LARGEST_WIDTH]; P]; P];
    for (place, &weight) in weights.as_flattened_mut().iter_mut().zip(stencil.weights.as_flattened()) {
        lanes.store_u32(weight, place);
    }
    let (first_x, first_y) = (lanes.array_u32(stencil.first.0), lanes.array_u32(stencil.first.1));
    let (mut sums_x, mut sums_y) = (lanes.array_f32(sum_x), lanes.array_f32(sum_y));
    for disc in (0..L::WIDTH).filter(|disc| seam >> disc & 1 == 1) {
        let first = (first_x[disc] as usize, first_y[disc] as usize);
        (sums_x[disc], sums_y[disc]) = sum_of_one(grid, field, first, &weights, disc);
    }
    (lanes.load_f32(&sums_x), lanes.load_f32(&sums_y))
}

/// The weighted sum of the field over the nodes of the disc in this lane.
#[inline(never)]
fn sum_of_one<const P: usize>(
    grid: Grid,
    field: Field<'_>,
    first: (usize, usize),
    weights: &[[[u32; LARGEST_WIDTH]; P]; P],
    lane: usize,
) -> (f32, f32) {
    let (mut sum_x, mut sum_y) = (0.0, 0.0);
    for (row, weights) in weights.iter().enumerate() {
        let line = grid.wrap(first.0 + row) * field.pitch;
        for (column, weights) in weights.iter().enumerate() {
            let weight = weights[lane] as i32 as f32;
            if let Some(force) = field.nodes.get(line + grid.wrap(first.1 + column)) {
                sum_x += weight * force.re;
                sum_y += weight * force.im;
            }
        }
    }
    (sum_x, sum_y)
}

/// In units of 2⁻²⁴ kBT/R0.
#[inline(always)]
fn quantised<L: Lanes>(lanes: L, sum: L::F32) -> L::U64 {
    const BEYOND: f32 = 9_223_372_036_854_775_808.0;
    let quanta = lanes.mul(sum, lanes.splat(QUANTA_PER_WEIGHT));
    if lanes.bits(lanes.less(lanes.abs(quanta), lanes.splat(BEYOND))) == (1 << L::WIDTH) - 1 {
        return lanes.round_i64(quanta);
    }
    // Numbers that saturate, or none.
    let mut rounded = [0; LARGEST_WIDTH];
    for (rounded, value) in rounded.iter_mut().zip(lanes.array_f32(quanta)) {
        *rounded = round_half_even(value) as u64;
    }
    lanes.load_u64(&rounded)
}
