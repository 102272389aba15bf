//! Mass assignment: from discs to mesh nodes (deposit) and from nodes back to discs (gather).
//!
//! A disc's mass 1 is spread over P × P nodes with B-spline weights (P = 2: cloud in cell; P = 3: triangular
//! shaped cloud; Hockney and Eastwood, *Computer Simulation Using Particles*, section 5-3). The weight of a
//! node is the product of two one-dimensional weights, rounded once to an integer of unit 2⁻²⁰ discs; what
//! rounding left over goes to the node nearest to the disc. So a disc deposits exactly 2²⁰ units wherever it
//! is, node sums are sums of integers and free of order, and the gather uses the very same integers.
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
use crate::torus::Fraction;
use crate::transform::Complex32;
use crate::units::{FORCE_UNITS, round_half_even};

/// The mass of one disc, unit 2⁻²⁰ discs.
pub const DISC: u32 = 1 << 20;

/// The largest number of discs a single node may hold.
pub const LARGEST_NODE_MASS: u32 = 4095;

/// One-dimensional weights have unit 2⁻³⁰.
const ONE: u32 = 1 << 30;

/// The position within a mesh cell has unit 2⁻²⁸ cells: exact, as a cell has at least 2²⁰ and at most 2²⁸
/// units of position.
const CELL: u32 = 1 << 28;

/// A node would hold more than [`LARGEST_NODE_MASS`] discs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crowded;

/// The nodes along one axis that share a disc's mass.
#[derive(Clone, Copy)]
struct Axis<const P: usize> {
    first: usize,
    nearest: usize,
    weights: [u32; P],
}

/// The node at or below a coordinate, and the distance to it in units of 2⁻²⁸ cells.
fn node_below(bits: u32, grid: Grid) -> (usize, u32) {
    let node = bits >> (32 - grid.exponent());
    (node as usize, (bits << grid.exponent()) >> 4)
}

/// How a coordinate is shared among the nodes along its axis.
trait Share {
    fn new(coordinate: Fraction, grid: Grid) -> Self;
}

/// Cloud in cell.
impl Share for Axis<2> {
    fn new(coordinate: Fraction, grid: Grid) -> Self {
        let (first, distance) = node_below(coordinate.to_bits(), grid);
        let upper = distance * (ONE / CELL);
        Self { first, nearest: usize::from(distance > CELL / 2), weights: [ONE - upper, upper] }
    }
}

/// Triangular shaped cloud.
impl Share for Axis<3> {
    fn new(coordinate: Fraction, grid: Grid) -> Self {
        let half_cell = 1 << (31 - grid.exponent());
        let (nearest, distance) = node_below(coordinate.to_bits().wrapping_add(half_cell), grid);
        // The outer weights (½ ± δ)²/2, δ the distance from the nearest node in −½ … ½.
        let outer = |to_edge: u32| {
            let square = u64::from(to_edge) * u64::from(to_edge);
            ((square + (1 << 26)) >> 27) as u32
        };
        let (below, above) = (outer(CELL - distance), outer(distance));
        let first = grid.wrap(nearest.wrapping_sub(1));
        Self { first, nearest: 1, weights: [below, ONE - below - above, above] }
    }
}

/// The nodes that share a disc's mass, with integer weights of unit 2⁻²⁰ that sum to exactly [`DISC`].
struct Stencil<const P: usize> {
    first: (usize, usize),
    weights: [[u32; P]; P],
}

impl<const P: usize> Stencil<P>
where
    Axis<P>: Share,
{
    #[inline]
    fn new(x: Fraction, y: Fraction, grid: Grid) -> Self {
        let (x, y) = (Axis::<P>::new(x, grid), Axis::<P>::new(y, grid));
        let mut weights = [[0; P]; P];
        let mut left = DISC;
        for (row, &weight_x) in weights.iter_mut().zip(&x.weights) {
            for (weight, &weight_y) in row.iter_mut().zip(&y.weights) {
                let product = u64::from(weight_x) * u64::from(weight_y);
                *weight = ((product + (1 << 39)) >> 40) as u32;
                left = left.wrapping_sub(*weight);
            }
        }
        if let Some(weight) = weights.get_mut(x.nearest).and_then(|row| row.get_mut(y.nearest)) {
            *weight = weight.wrapping_add(left);
        }
        Self { first: (x.first, y.first), weights }
    }

    /// Calls `visit` with the element and the weight of each node, row by row.
    #[inline]
    fn for_each(&self, grid: Grid, mut visit: impl FnMut(usize, u32)) {
        for (row, weights) in self.weights.iter().enumerate() {
            let line = grid.wrap(self.first.0 + row) * grid.nodes();
            for (column, &weight) in weights.iter().enumerate() {
                visit(line + grid.wrap(self.first.1 + column), weight);
            }
        }
    }
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
    match assignment {
        Assignment::CloudInCell => deposit_with::<2>(grid, x, y, nodes),
        Assignment::TriangularShapedCloud => deposit_with::<3>(grid, x, y, nodes),
    }
    // Fewer discs cannot crowd a node. A saturated sum exceeds the limit, so order does not matter here either.
    let limit = LARGEST_NODE_MASS * DISC;
    if x.len() > LARGEST_NODE_MASS as usize && nodes.iter().any(|&mass| mass > limit) {
        return Err(Crowded);
    }
    Ok(())
}

fn deposit_with<const P: usize>(grid: Grid, x: &[Fraction], y: &[Fraction], nodes: &mut [u32])
where
    Axis<P>: Share,
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
    let forces = force_x.iter_mut().zip(force_y);
    match assignment {
        Assignment::CloudInCell => gather_with::<2>(grid, x, y, field, forces),
        Assignment::TriangularShapedCloud => gather_with::<3>(grid, x, y, field, forces),
    }
}

fn gather_with<'a, const P: usize>(
    grid: Grid,
    x: &[Fraction],
    y: &[Fraction],
    field: &[Complex32],
    forces: impl Iterator<Item = (&'a mut i64, &'a mut i64)>,
) where
    Axis<P>: Share,
{
    const QUANTA_PER_WEIGHT: f32 = FORCE_UNITS / DISC as f32;
    for ((&x, &y), (force_x, force_y)) in x.iter().zip(y).zip(forces) {
        let (mut sum_x, mut sum_y) = (0.0_f32, 0.0_f32);
        Stencil::<P>::new(x, y, grid).for_each(grid, |node, weight| {
            if let Some(value) = field.get(node) {
                sum_x += weight as f32 * value.re;
                sum_y += weight as f32 * value.im;
            }
        });
        *force_x = round_half_even(sum_x * QUANTA_PER_WEIGHT);
        *force_y = round_half_even(sum_y * QUANTA_PER_WEIGHT);
    }
}
