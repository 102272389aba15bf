//! The integer weights of a register of discs: the core's [`meniscus_core::stencil`], a disc a lane.

use crate::lanes::Lanes;
use meniscus_core::assignment::DISC;
use meniscus_core::grid::Grid;
use meniscus_core::stencil::{CELL, ONE, scale};

/// The P × P nodes that share a disc's mass, a disc a lane.
pub(super) struct Stencil<L: Lanes, const P: usize> {
    /// The first node along x and along y.
    pub first: (L::U32, L::U32),
    /// The weights, unit 2⁻²⁰; they sum to [`DISC`].
    pub weights: [[L::U32; P]; P],
    /// Where, in even orders, the nearest node is the upper one of the middle two.
    upper: (L::Mask, L::Mask),
}

/// The nodes along one axis.
struct Axis<L: Lanes, T, const P: usize> {
    first: L::U32,
    upper: L::Mask,
    weights: [T; P],
}

impl<L: Lanes, const P: usize> Stencil<L, P> {
    /// The stencils of discs at (x, y), bits of coordinates.
    #[inline(always)]
    pub fn new(lanes: L, x: L::U32, y: L::U32, grid: Grid) -> Self {
        if P <= 3 { Self::of_integers(lanes, x, y, grid) } else { Self::of_binary32(lanes, x, y, grid) }
    }

    /// Orders 2 and 3.
    #[inline(always)]
    fn of_integers(lanes: L, x: L::U32, y: L::U32, grid: Grid) -> Self {
        let (x, y) = (integer_axis::<L, P>(lanes, x, grid), integer_axis::<L, P>(lanes, y, grid));
        let mut weights = [[lanes.splat_u32(0); P]; P];
        for (row, along_x) in weights.iter_mut().zip(x.weights) {
            for (weight, along_y) in row.iter_mut().zip(y.weights) {
                // Rounding at 2⁴⁰, of which the lower 32 bits of the product are no part.
                let product = lanes.add_u32(lanes.high_product(along_x, along_y), lanes.splat_u32(1 << 7));
                *weight = lanes.shr(product, 8);
            }
        }
        Self { first: (x.first, y.first), weights, upper: (x.upper, y.upper) }.with_remainder(lanes)
    }

    /// Orders 4 to 7.
    #[inline(always)]
    fn of_binary32(lanes: L, x: L::U32, y: L::U32, grid: Grid) -> Self {
        // 2²³: added to a number up to 2²², it leaves the nearest integer in the last bits of the sum.
        const INTEGERS: f32 = 8_388_608.0;
        let (x, y) = (binary32_axis::<L, P>(lanes, x, grid), binary32_axis::<L, P>(lanes, y, grid));
        let (integers, scale) = (lanes.splat(INTEGERS), lanes.splat(const { scale::<P>() }));
        let mut weights = [[lanes.splat_u32(0); P]; P];
        for (row, along_x) in weights.iter_mut().zip(x.weights) {
            for (weight, along_y) in row.iter_mut().zip(y.weights) {
                let product = lanes.mul(lanes.mul(along_x, along_y), scale);
                *weight = lanes.sub_u32(lanes.to_bits(lanes.add(product, integers)), lanes.to_bits(integers));
            }
        }
        Self { first: (x.first, y.first), weights, upper: (x.upper, y.upper) }.with_remainder(lanes)
    }

    /// Gives what rounding left over to the nearest node.
    #[inline(always)]
    fn with_remainder(mut self, lanes: L) -> Self {
        self.complete(lanes, lanes.splat_u32(DISC));
        self
    }

    /// Makes the weights sum to `whole` by what the nearest node gets.
    #[inline(always)]
    fn complete(&mut self, lanes: L, whole: L::U32) {
        let mut left = whole;
        for weight in self.weights.as_flattened() {
            left = lanes.sub_u32(left, *weight);
        }
        let middle = (P - 1) / 2;
        if P % 2 == 1 {
            self.give(lanes, (middle, middle), left);
            return;
        }
        let none = lanes.splat_u32(0);
        let right = lanes.select_u32(self.upper.0, left, none);
        for (row, part) in [(middle, lanes.sub_u32(left, right)), (middle + 1, right)] {
            let above = lanes.select_u32(self.upper.1, part, none);
            self.give(lanes, (row, middle), lanes.sub_u32(part, above));
            self.give(lanes, (row, middle + 1), above);
        }
    }

    /// Adds to the weight of a node.
    #[inline(always)]
    fn give(&mut self, lanes: L, (row, column): (usize, usize), part: L::U32) {
        let weight = &mut self.weights[row][column];
        *weight = lanes.add_u32(*weight, part);
    }

    /// Turns weights into shares in a whole of `modulus` (unit 2⁻²⁰): each rounded to nearest, halves away from zero, and
    /// the remainder to the nearest node.
    #[inline(always)]
    pub fn share(&mut self, lanes: L, modulus: L::U32) {
        let half = lanes.splat_u64(u64::from(DISC / 2));
        for weight in self.weights.as_flattened_mut() {
            let product = lanes.add_u64(lanes.product(*weight, modulus), half);
            *weight = lanes.low(lanes.shr_u64(product, DISC.trailing_zeros()));
        }
        self.complete(lanes, modulus);
    }
}

/// The first of the nodes along an axis that share a disc's mass.
#[inline(always)]
pub(super) fn first_node<L: Lanes, const P: usize>(lanes: L, coordinate: L::U32, grid: Grid) -> L::U32 {
    let node = node_below(lanes, shifted::<L, P>(lanes, coordinate, grid), grid).0;
    lanes.and(lanes.sub_u32(node, lanes.splat_u32((P as u32 - 1) / 2)), last_node(lanes, grid))
}

/// M − 1, by which an index is wrapped.
#[inline(always)]
pub(super) fn last_node<L: Lanes>(lanes: L, grid: Grid) -> L::U32 {
    lanes.splat_u32(grid.nodes() as u32 - 1)
}

/// Odd orders are centred on the nearest node, even ones on a cell.
#[inline(always)]
fn shifted<L: Lanes, const P: usize>(lanes: L, coordinate: L::U32, grid: Grid) -> L::U32 {
    if P % 2 == 1 {
        lanes.add_u32(coordinate, lanes.splat_u32(1 << (31 - grid.exponent())))
    } else {
        coordinate
    }
}

/// The node at or below a coordinate, and the distance to it in units of 2⁻²⁸ cells.
#[inline(always)]
fn node_below<L: Lanes>(lanes: L, coordinate: L::U32, grid: Grid) -> (L::U32, L::U32) {
    let node = lanes.shr(coordinate, 32 - grid.exponent());
    (node, lanes.shr(lanes.shl(coordinate, grid.exponent()), 4))
}

/// Orders 2 and 3: weights of unit 2⁻³⁰.
#[inline(always)]
fn integer_axis<L: Lanes, const P: usize>(lanes: L, coordinate: L::U32, grid: Grid) -> Axis<L, L::U32, P> {
    let distance = node_below(lanes, shifted::<L, P>(lanes, coordinate, grid), grid).1;
    let one = lanes.splat_u32(ONE);
    let mut weights = [one; P];
    match &mut weights[..] {
        [lower, upper] => {
            *upper = lanes.shl(distance, (ONE / CELL).trailing_zeros());
            *lower = lanes.sub_u32(one, *upper);
        }
        [below, middle, above] => {
            *above = outer(lanes, distance);
            *below = outer(lanes, lanes.sub_u32(lanes.splat_u32(CELL), distance));
            *middle = lanes.sub_u32(lanes.sub_u32(one, *below), *above);
        }
        _ => {}
    }
    let upper = lanes.less_i32(lanes.splat_u32(CELL / 2), distance);
    Axis { first: first_node::<L, P>(lanes, coordinate, grid), upper, weights }
}

/// An outer weight of order 3, (½ ± δ)²/2, δ the distance from the nearest node in −½ … ½.
#[inline(always)]
fn outer<L: Lanes>(lanes: L, to_edge: L::U32) -> L::U32 {
    let square = lanes.product(to_edge, to_edge);
    lanes.low(lanes.shr_u64(lanes.add_u64(square, lanes.splat_u64(1 << 26)), 27))
}

/// Orders 4 to 7: weights are (P − 1)! times the B-spline's.
#[inline(always)]
fn binary32_axis<L: Lanes, const P: usize>(lanes: L, coordinate: L::U32, grid: Grid) -> Axis<L, L::F32, P> {
    let distance = node_below(lanes, shifted::<L, P>(lanes, coordinate, grid), grid).1;
    let above = lanes.mul(lanes.of_i32(lanes.shr(distance, 4)), lanes.splat(1.0 / (CELL >> 4) as f32));
    let weights = spline(lanes, above, lanes.sub(lanes.splat(1.0), above));
    let upper = lanes.less_i32(lanes.splat_u32(CELL / 2), distance);
    Axis { first: first_node::<L, P>(lanes, coordinate, grid), upper, weights }
}

/// (P − 1)! times the B-spline of order P at its P knots, for a point `above` past one and `below` before the next.
///
/// Terms that are zero are left out; the others are not below zero, so that adding one would change no bit.
#[inline(always)]
fn spline<L: Lanes, const P: usize>(lanes: L, above: L::F32, below: L::F32) -> [L::F32; P] {
    let mut weights = [lanes.splat(0.0); P];
    weights[0] = below;
    weights[1] = above;
    for order in 3..=P {
        let mut previous = weights[0];
        weights[0] = lanes.mul(below, previous);
        for (j, weight) in weights.iter_mut().enumerate().take(order - 1).skip(1) {
            let own = *weight;
            let from_previous = lanes.mul(lanes.add(above, lanes.splat((order - 1 - j) as f32)), previous);
            let from_own = lanes.mul(lanes.add(below, lanes.splat(j as f32)), own);
            *weight = lanes.add(from_previous, from_own);
            previous = own;
        }
        weights[order - 1] = lanes.mul(above, previous);
    }
    weights
}
