//! The nodes that share a disc's mass, and their integer weights.
//!
//! The weight of a node is the product of two one-dimensional weights, the B-spline of order P (P = 2: cloud in cell;
//! P = 3: triangular shaped cloud; Hockney and Eastwood, *Computer Simulation Using Particles*, section 5-3), rounded
//! once to an integer of unit 2⁻²⁰ discs; what rounding left over goes to the node nearest to the disc. So the weights
//! of a disc sum to exactly 2²⁰. One-dimensional weights are integers of unit 2⁻³⁰ in orders 2 and 3, binary32 in
//! orders 4 to 7, of which the rounding is a tenth of the quantum.
//!
//! ```
//! use meniscus_core::grid::Grid;
//! use meniscus_core::stencil::{Stencil, Weights};
//! use meniscus_core::torus::Fraction;
//!
//! let (x, y) = (Fraction::from_bits(12345), Fraction::from_bits(u32::MAX));
//! let mut sum = 0;
//! Stencil::<5>::new(x, y, Grid::SMALLEST).for_each(Grid::SMALLEST, |_node, weight| sum += weight);
//! assert_eq!(sum, 1 << 20);
//! ```

use crate::assignment::DISC;
use crate::grid::Grid;
use crate::torus::Fraction;

/// One-dimensional integer weights have unit 2⁻³⁰.
pub const ONE: u32 = 1 << 30;

/// The position within a mesh cell has unit 2⁻²⁸ cells: exact, as a cell has at least 2²⁰ and at most 2²⁸
/// units of position.
pub const CELL: u32 = 1 << 28;

/// What a product of one-dimensional binary32 weights of order P is multiplied by to have unit 2⁻²⁰: 2²⁰/((P − 1)!)².
#[must_use]
pub const fn scale<const P: usize>() -> f32 {
    let (mut factorial, mut factor) = (1, 2);
    while factor < P {
        factorial *= factor;
        factor += 1;
    }
    DISC as f32 / (factorial * factorial) as f32
}

/// The P × P nodes that share a disc's mass, with integer weights of unit 2⁻²⁰ that sum to exactly [`DISC`].
#[derive(Clone, Copy, Debug)]
pub struct Stencil<const P: usize> {
    first: (usize, usize),
    nearest: (usize, usize),
    weights: [[u32; P]; P],
}

/// How the weights of an order are found.
pub trait Weights {
    /// The stencil of a disc at (`x`, `y`).
    fn new(x: Fraction, y: Fraction, grid: Grid) -> Self;
}

impl<const P: usize> Stencil<P> {
    /// Rounds products of one-dimensional weights and gives what is left over to the nearest node.
    #[inline]
    fn of_products<T: Copy>(x: &Axis<P, T>, y: &Axis<P, T>, rounded: impl Fn(T, T) -> u32) -> Self {
        let mut weights = [[0; P]; P];
        let mut left = DISC;
        for (row, &weight_x) in weights.iter_mut().zip(&x.weights) {
            for (weight, &weight_y) in row.iter_mut().zip(&y.weights) {
                *weight = rounded(weight_x, weight_y);
                left = left.wrapping_sub(*weight);
            }
        }
        let nearest = (x.nearest, y.nearest);
        if let Some(weight) = weights.get_mut(nearest.0).and_then(|row| row.get_mut(nearest.1)) {
            *weight = weight.wrapping_add(left);
        }
        Self { first: (x.first, y.first), nearest, weights }
    }

    /// Calls `visit` with the element `x·M + y` and the weight of each node, row by row.
    #[inline]
    pub fn for_each(&self, grid: Grid, mut visit: impl FnMut(usize, u32)) {
        for (row, weights) in self.weights.iter().enumerate() {
            let line = grid.wrap(self.first.0 + row) * grid.nodes();
            for (column, &weight) in weights.iter().enumerate() {
                visit(line + grid.wrap(self.first.1 + column), weight);
            }
        }
    }

    /// Calls `visit` with the element and the share of each node in `strength` (unit 2⁻²⁰), row by row: the weight's
    /// part of it rounded to nearest, halves away from zero, the remainder to the nearest node.
    #[inline]
    pub fn for_each_share(&self, grid: Grid, strength: i32, mut visit: impl FnMut(usize, i32)) {
        let modulus = u64::from(strength.unsigned_abs());
        let mut shares = [[0_u32; P]; P];
        let mut left = strength.unsigned_abs();
        for (row, weights) in shares.iter_mut().zip(&self.weights) {
            for (share, &weight) in row.iter_mut().zip(weights) {
                *share = ((u64::from(weight) * modulus + u64::from(DISC / 2)) / u64::from(DISC)) as u32;
                left = left.wrapping_sub(*share);
            }
        }
        if let Some(share) = shares.get_mut(self.nearest.0).and_then(|row| row.get_mut(self.nearest.1)) {
            *share = share.wrapping_add(left);
        }
        let with_sign = |share: u32| if strength < 0 { (share as i32).wrapping_neg() } else { share as i32 };
        let signed = Stencil { first: self.first, nearest: self.nearest, weights: shares };
        signed.for_each(grid, |node, share| visit(node, with_sign(share)));
    }
}

/// The nodes along one axis that share a disc's mass.
#[derive(Clone, Copy)]
struct Axis<const P: usize, T> {
    first: usize,
    nearest: usize,
    weights: [T; P],
}

/// The node at or below a coordinate, and the distance to it in units of 2⁻²⁸ cells.
fn node_below(bits: u32, grid: Grid) -> (usize, u32) {
    let node = bits >> (32 - grid.exponent());
    (node as usize, (bits << grid.exponent()) >> 4)
}

/// Cloud in cell.
impl Axis<2, u32> {
    fn new(coordinate: Fraction, grid: Grid) -> Self {
        let (first, distance) = node_below(coordinate.to_bits(), grid);
        let upper = distance * (ONE / CELL);
        Self { first, nearest: usize::from(distance > CELL / 2), weights: [ONE - upper, upper] }
    }
}

/// Triangular shaped cloud.
impl Axis<3, u32> {
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

/// Orders 4 to 7; weights are (P − 1)! times the B-spline's.
impl<const P: usize> Axis<P, f32> {
    #[inline]
    fn new(coordinate: Fraction, grid: Grid) -> Self {
        let odd = P % 2 == 1;
        let half_cell = if odd { 1 << (31 - grid.exponent()) } else { 0 };
        let (node, distance) = node_below(coordinate.to_bits().wrapping_add(half_cell), grid);
        let first = grid.wrap(node.wrapping_sub((P - 1) / 2));
        let nearest = (P - 1) / 2 + usize::from(!odd && distance > CELL / 2);
        // 24 bits are exact in binary32, and so is what is missing to 1.
        let above = (distance >> 4) as f32 * (1.0 / (CELL >> 4) as f32);
        Self { first, nearest, weights: spline(above, 1.0 - above) }
    }
}

/// (P − 1)! times the B-spline of order P at its P knots, for a point `above` past one and `below` before the next,
/// by the recursion w_j(q) = (above + q − 1 − j) w_{j−1}(q−1) + (below + j) w_j(q−1).
#[inline]
fn spline<const P: usize>(above: f32, below: f32) -> [f32; P] {
    let mut weights = [0.0; P];
    for (weight, linear) in weights.iter_mut().zip([below, above]) {
        *weight = linear;
    }
    for order in 3..=P {
        let mut previous = 0.0;
        for (j, weight) in weights.iter_mut().enumerate().take(order) {
            let own = *weight;
            *weight = (above + (order - 1 - j) as f32) * previous + (below + j as f32) * own;
            previous = own;
        }
    }
    weights
}

macro_rules! integer_weights {
    ($($order:literal)*) => { $(
        impl Weights for Stencil<$order> {
            #[inline]
            fn new(x: Fraction, y: Fraction, grid: Grid) -> Self {
                let (x, y) = (Axis::<$order, u32>::new(x, grid), Axis::<$order, u32>::new(y, grid));
                Self::of_products(&x, &y, |along_x, along_y| {
                    ((u64::from(along_x) * u64::from(along_y) + (1 << 39)) >> 40) as u32
                })
            }
        }
    )* };
}

macro_rules! binary32_weights {
    ($($order:literal)*) => { $(
        impl Weights for Stencil<$order> {
            #[inline]
            fn new(x: Fraction, y: Fraction, grid: Grid) -> Self {
                const SCALE: f32 = scale::<$order>();
                let (x, y) = (Axis::<$order, f32>::new(x, grid), Axis::<$order, f32>::new(y, grid));
                Self::of_products(&x, &y, |along_x, along_y| nearest_integer(along_x * along_y * SCALE))
            }
        }
    )* };
}

integer_weights!(2 3);
binary32_weights!(4 5 6 7);

/// The integer nearest to a number from 0 to 2²², ties to even.
#[inline]
fn nearest_integer(value: f32) -> u32 {
    const ALL_INTEGERS: f32 = 8_388_608.0;
    ((value + ALL_INTEGERS) - ALL_INTEGERS) as u32
}
