//! Mass assignment: from discs to mesh nodes (deposit) and from nodes back to discs (gather).
//!
//! A disc's mass 1 is spread over P × P nodes with integer weights of unit 2⁻²⁰ discs that sum to exactly 2²⁰ wherever
//! it is (see [`crate::stencil`]); node sums are sums of integers and free of order, and the gather uses the very
//! same integers.
//!
//! Discs of unequal capillary strength f deposit f instead of 1: an integer of unit 2⁻²⁰ too, of either sign, whose
//! shares are rounded once more and sum to exactly f. Node sums are then in two's complement.
//!
//! Node (x, y) of an M × M mesh is element `x·M + y` and lies at (x, y)·L/M.
//!
//! ```
//! use meniscus_core::assignment::{deposit, DISC};
//! use meniscus_core::grid::Grid;
//! use meniscus_core::parameters::Assignment;
//! use meniscus_core::torus::Fraction;
//!
//! let mut nodes = [0; 256];
//! let (x, y) = ([Fraction::from_bits(12345)], [Fraction::from_bits(u32::MAX)]);
//! deposit(Assignment::TriangularShapedCloud, Grid::SMALLEST, &x, &y, &mut nodes).unwrap();
//! assert_eq!(nodes.iter().sum::<u32>(), DISC);
//! ```

use crate::grid::Grid;
use crate::parameters::Assignment;
use crate::stencil::{Stencil, Weights};
use crate::torus::Fraction;
use crate::transform::Complex32;
use crate::units::{FORCE_UNITS, round_half_even};

/// The mass of one disc, unit 2⁻²⁰ discs.
pub const DISC: u32 = 1 << 20;

/// The largest number of discs a single node may hold.
pub const LARGEST_NODE_MASS: u32 = 4095;

/// The largest sum of the moduli of capillary strengths that a single node may hold: half of the other, for the sign.
pub const LARGEST_NODE_STRENGTH: u32 = 2047;

/// A node would hold more than [`LARGEST_NODE_MASS`] discs, or strengths of more than [`LARGEST_NODE_STRENGTH`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crowded;

/// Calls a function generic over the order P with the P of an assignment.
macro_rules! by_order {
    ($assignment:expr, $function:ident($($argument:expr),*)) => {
        match $assignment {
            Assignment::CloudInCell => $function::<2>($($argument),*),
            Assignment::TriangularShapedCloud => $function::<3>($($argument),*),
            Assignment::Order4 => $function::<4>($($argument),*),
            Assignment::Order5 => $function::<5>($($argument),*),
            Assignment::Order6 => $function::<6>($($argument),*),
            Assignment::Order7 => $function::<7>($($argument),*),
        }
    };
}

/// Spreads the mass of the discs at (`x`, `y`) over `nodes`, M × M elements of unit 2⁻²⁰ discs; what they
/// held before is forgotten.
///
/// # Errors
/// [`Crowded`] if a node holds more than [`LARGEST_NODE_MASS`] discs; `nodes` is then of no use.
pub fn deposit(
    assignment: Assignment,
    grid: Grid,
    x: &[Fraction],
    y: &[Fraction],
    nodes: &mut [u32],
) -> Result<(), Crowded> {
    by_order!(assignment, deposit_equal(grid, x, y, nodes));
    // Fewer discs cannot crowd a node. A saturated sum exceeds the limit, so order does not matter here either.
    let limit = LARGEST_NODE_MASS * DISC;
    if x.len() > LARGEST_NODE_MASS as usize && nodes.iter().any(|&mass| mass > limit) {
        return Err(Crowded);
    }
    Ok(())
}

fn deposit_equal<const P: usize>(grid: Grid, x: &[Fraction], y: &[Fraction], nodes: &mut [u32])
where
    Stencil<P>: Weights,
{
    nodes.fill(0);
    for (&x, &y) in x.iter().zip(y) {
        Stencil::<P>::new(x, y, grid).for_each(grid, |node, weight| {
            if let Some(mass) = nodes.get_mut(node) {
                *mass = mass.saturating_add(weight);
            }
        });
    }
}

/// Spreads the capillary strengths (unit 2⁻²⁰) of the discs at (`x`, `y`) over `nodes`, M × M elements of unit 2⁻²⁰
/// in two's complement; what they held before is forgotten.
///
/// # Errors
/// [`Crowded`] if the moduli of the shares of a node sum to more than [`LARGEST_NODE_STRENGTH`]; `nodes` is then of no
/// use.
pub fn deposit_strengths(
    assignment: Assignment,
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    strengths: &[i32],
    nodes: &mut [u32],
) -> Result<(), Crowded> {
    let limit = LARGEST_NODE_STRENGTH * DISC;
    let total: u64 = strengths.iter().map(|strength| u64::from(strength.unsigned_abs())).sum();
    // Moduli only ever add up, so that saturation is free of order; the signed sums then cannot overflow. Without the
    // first pass neither: a node takes at most 9/16 of what a disc spreads in order 3 and above, rounding included, and in
    // order 2 all of it and two units, for which there is room above the limit.
    if total > u64::from(limit) {
        let add = |sum: u32, share: i32| sum.saturating_add(share.unsigned_abs());
        by_order!(assignment, deposit_shares(grid, (x, y), strengths, nodes, add));
        if nodes.iter().any(|&modulus| modulus > limit) {
            return Err(Crowded);
        }
    }
    by_order!(assignment, deposit_shares(grid, (x, y), strengths, nodes, u32::wrapping_add_signed));
    Ok(())
}

/// Spreads the shares of discs of these strengths over the nodes; `add` puts a share to what a node holds.
fn deposit_shares<const P: usize>(
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    strengths: &[i32],
    nodes: &mut [u32],
    add: impl Fn(u32, i32) -> u32,
) where
    Stencil<P>: Weights,
{
    nodes.fill(0);
    for ((&x, &y), &strength) in x.iter().zip(y).zip(strengths) {
        Stencil::<P>::new(x, y, grid).for_each_share(grid, strength, |node, share| {
            if let Some(sum) = nodes.get_mut(node) {
                *sum = add(*sum, share);
            }
        });
    }
}

/// Gathers the force field at the discs with the weights of the deposit and quantises it.
///
/// `field` holds F_x + i·F_y in kBT/R0 on M × M nodes; `force_x` and `force_y` receive units of
/// 2⁻²⁴ kBT/R0. The sum over a disc's nodes runs row by row in binary32.
pub fn gather(
    assignment: Assignment,
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    field: &[Complex32],
    (force_x, force_y): (&mut [i64], &mut [i64]),
) {
    by_order!(assignment, gather_equal(grid, (x, y), field, force_x.iter_mut().zip(force_y)));
}

fn gather_equal<'a, const P: usize>(
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    field: &[Complex32],
    forces: impl Iterator<Item = (&'a mut i64, &'a mut i64)>,
) where
    Stencil<P>: Weights,
{
    for ((&x, &y), (force_x, force_y)) in x.iter().zip(y).zip(forces) {
        let mut sum = WeightedSum::default();
        Stencil::<P>::new(x, y, grid).for_each(grid, |node, weight| sum.add(weight as f32, field.get(node)));
        (*force_x, *force_y) = sum.quantised();
    }
}

/// As [`gather`], for discs of the given capillary strengths (unit 2⁻²⁰): with the shares they deposited.
pub fn gather_strengths(
    assignment: Assignment,
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    strengths: &[i32],
    field: &[Complex32],
    (force_x, force_y): (&mut [i64], &mut [i64]),
) {
    by_order!(assignment, gather_shares(grid, (x, y), strengths, field, force_x.iter_mut().zip(force_y)));
}

fn gather_shares<'a, const P: usize>(
    grid: Grid,
    (x, y): (&[Fraction], &[Fraction]),
    strengths: &[i32],
    field: &[Complex32],
    forces: impl Iterator<Item = (&'a mut i64, &'a mut i64)>,
) where
    Stencil<P>: Weights,
{
    for (((&x, &y), &strength), (force_x, force_y)) in x.iter().zip(y).zip(strengths).zip(forces) {
        let mut sum = WeightedSum::default();
        let stencil = Stencil::<P>::new(x, y, grid);
        stencil.for_each_share(grid, strength, |node, share| sum.add(share as f32, field.get(node)));
        (*force_x, *force_y) = sum.quantised();
    }
}

/// Weights of unit 2⁻²⁰ times forces in kBT/R0, summed.
#[derive(Default)]
struct WeightedSum {
    x: f32,
    y: f32,
}

impl WeightedSum {
    #[inline]
    fn add(&mut self, weight: f32, force: Option<&Complex32>) {
        if let Some(force) = force {
            self.x += weight * force.re;
            self.y += weight * force.im;
        }
    }

    /// In units of 2⁻²⁴ kBT/R0.
    fn quantised(&self) -> (i64, i64) {
        const QUANTA_PER_WEIGHT: f32 = FORCE_UNITS / DISC as f32;
        (round_half_even(self.x * QUANTA_PER_WEIGHT), round_half_even(self.y * QUANTA_PER_WEIGHT))
    }
}
