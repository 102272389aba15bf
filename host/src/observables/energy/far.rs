//! The far part of the capillary potential: what is smooth, summed over waves on a mesh.
//!
//! φ_far of `near` is in the periodic box (1/L²) Σ_k Ĝ(k) exp(ik·r), Ĝ = 2π exp(−(k²+κ²)/4α²)/(k²+κ²) for V0 = 1. The
//! discs are spread over M × M nodes by B-splines, their density ρ̂ is transformed, and the sum over all pairs, each disc
//! with itself included, is (1/2L²) Σ G|ρ̂|². The influence function G makes the error of that least, averaged over where
//! discs lie between nodes (Hockney and Eastwood, section 8-3-3):
//! G(k) = Σ_m U²(k_m)Ĝ(k_m)/[Σ_m U²(k_m)]², with the window U of the B-spline and the aliases k_m = k + 2πm/h.
//! What a disc has with itself on the mesh is, on the same average, (1/2L²) Σ_k Σ_m U²Ĝ/Σ_m U².
//!
//! k = 0 is left out. In: positions and strengths. Out: Σ f_i f_j φ_far over pairs, a pure number.

use super::Discs;
use core::f64::consts::{PI, TAU};
use meniscus_core::torus::Fraction;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use std::fmt;
use std::sync::Arc;

/// Order of the B-spline: nodes along an axis over which a disc is spread.
const ORDER: usize = 10;

/// Columns of the mesh transformed at a time.
const COLUMNS: usize = 8;

/// The far part of one box.
#[derive(Clone)]
pub(super) struct FarPart {
    nodes: usize,
    /// G/2L² of the waves (l, m), 0 ≤ l, m ≤ M/2, as element l·(M/2 + 1) + m.
    influence: Vec<f64>,
    /// What a disc of strength 1 has with itself.
    own: f64,
    /// The transform of a line. The scalar one has one order of operations on every processor; its sines and cosines are
    /// the platform's, so that the last digits of an energy may differ between platforms.
    transform: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for FarPart {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("FarPart").field("nodes", &self.nodes).finish_non_exhaustive()
    }
}

impl FarPart {
    /// The far part in a box of `side` (R0) with κ² = `screening_square` (R0⁻²) and α = `splitting` (1/R0), by a mesh of
    /// `nodes` nodes a side, a power of two above [`ORDER`].
    pub(super) fn new(side: f64, screening_square: f64, splitting: f64, nodes: usize) -> Self {
        let waves: Vec<Wave> =
            (0..=nodes / 2).map(|order| Wave::new(order as f64, side, splitting, nodes as f64)).collect();
        let scale = PI * libm::exp(-0.25 * screening_square / (splitting * splitting)) / (side * side);
        let mut influence = Vec::with_capacity(waves.len() * waves.len());
        let mut own = 0.0;
        for (l, along_x) in waves.iter().enumerate() {
            for (m, along_y) in waves.iter().enumerate() {
                if l == 0 && m == 0 {
                    influence.push(0.0);
                    continue;
                }
                let target = scale * along_x.aliased_target(along_y, screening_square);
                let windows = along_x.windows * along_y.windows;
                influence.push(target / (windows * windows));
                own += multiplicity(l, nodes) * multiplicity(m, nodes) * target / windows;
            }
        }
        Self { nodes, influence, own, transform: FftPlannerScalar::new().plan_fft_forward(nodes) }
    }

    /// Σ f_i f_j φ_far over pairs; `squares` is Σ f_i².
    pub(super) fn sum_over_pairs(&self, discs: &Discs, squares: f64) -> f64 {
        let mut mesh = self.density(discs);
        let mut scratch = vec![Complex::default(); self.transform.get_inplace_scratch_len()];
        self.transform.process_with_scratch(&mut mesh, &mut scratch);
        let half = self.nodes / 2;
        let mut columns = vec![Complex::default(); COLUMNS * self.nodes];
        let mut sum = 0.0;
        // The density is real: waves beyond M/2 are those below it again.
        for first in (0..=half).step_by(COLUMNS) {
            let count = COLUMNS.min(half + 1 - first);
            for (row, line) in mesh.chunks_exact(self.nodes).enumerate() {
                for (column, value) in line[first..first + count].iter().enumerate() {
                    columns[column * self.nodes + row] = *value;
                }
            }
            let columns = &mut columns[..count * self.nodes];
            self.transform.process_with_scratch(columns, &mut scratch);
            for (m, column) in (first..).zip(columns.chunks_exact(self.nodes)) {
                sum += multiplicity(m, self.nodes) * self.energy_of_column(m, column);
            }
        }
        sum - self.own * squares
    }

    /// Σ G|ρ̂|²/2L² over the waves (l, `m`), l = 0 … M − 1, whose ρ̂ are given.
    fn energy_of_column(&self, m: usize, column: &[Complex<f64>]) -> f64 {
        let influence = |l: usize| self.influence[m * (self.nodes / 2 + 1) + l.min(self.nodes - l)];
        column.iter().enumerate().map(|(l, wave)| influence(l) * wave.norm_sqr()).sum()
    }

    /// Strengths spread over the nodes; node (x, y) is element x·M + y.
    fn density(&self, discs: &Discs) -> Vec<Complex<f64>> {
        let mut mesh = vec![Complex::default(); self.nodes * self.nodes];
        for ((&x, &y), &strength) in discs.x.iter().zip(&discs.y).zip(&discs.strengths) {
            let (first_row, along_x) = self.spread(x);
            let (first_column, along_y) = self.spread(y);
            for (row, weight) in along_x.iter().enumerate() {
                let line = ((first_row + row) & (self.nodes - 1)) * self.nodes;
                let share = strength * weight;
                for (column, weight) in along_y.iter().enumerate() {
                    mesh[line + ((first_column + column) & (self.nodes - 1))].re += share * weight;
                }
            }
        }
        mesh
    }

    /// The first of the nodes along an axis that share a disc, and all their shares.
    fn spread(&self, coordinate: Fraction) -> (usize, [f64; ORDER]) {
        let exponent = self.nodes.trailing_zeros();
        let bits = u64::from(coordinate.to_bits()) << exponent;
        let node = (bits >> 32) as usize;
        let above = f64::from(bits as u32) / meniscus_core::torus::UNITS;
        (node + self.nodes + 1 - ORDER / 2, spline(above))
    }
}

/// How many of the waves 0 … M − 1 along an axis are ±`order`.
fn multiplicity(order: usize, nodes: usize) -> f64 {
    if order == 0 || 2 * order == nodes { 1.0 } else { 2.0 }
}

/// The B-spline of [`ORDER`] at its knots for a point `above` past the middle one, in knots. With w⁽ⁿ⁾_j the value of
/// order n, (n−1) w⁽ⁿ⁾_j = (above + n−1−j) w⁽ⁿ⁻¹⁾_{j−1} + (1 − above + j) w⁽ⁿ⁻¹⁾_j (de Boor).
fn spline(above: f64) -> [f64; ORDER] {
    let mut weights = [0.0; ORDER];
    weights[0] = 1.0;
    for order in 2..=ORDER {
        let inverse = 1.0 / (order - 1) as f64;
        let mut previous = 0.0;
        for (j, weight) in weights.iter_mut().enumerate().take(order) {
            let own = *weight;
            let left = above + (order - 1 - j) as f64;
            *weight = inverse * (left * previous + (order as f64 - left) * own);
            previous = own;
        }
    }
    weights
}

/// A wave along one axis with its aliases. U² of those beyond the first is 3⁻²⁰ of the wave's at most.
struct Wave {
    /// For each alias k², and U² times exp(−k²/4α²).
    aliases: [[f64; 2]; 3],
    /// Σ U².
    windows: f64,
}

impl Wave {
    /// The wave of k = 2π·`order`/L.
    fn new(order: f64, side: f64, splitting: f64, nodes: f64) -> Self {
        let mut windows = 0.0;
        let aliases = [0.0, -1.0, 1.0].map(|alias| {
            let order = order + alias * nodes;
            let window = squared_window(PI * order / nodes);
            windows += window;
            let square = (TAU * order / side) * (TAU * order / side);
            [square, window * libm::exp(-0.25 * square / (splitting * splitting))]
        });
        Self { aliases, windows }
    }

    /// Σ U² exp(−k²/4α²)/(k² + κ²) over the aliases of this wave along x and of the `other` along y.
    fn aliased_target(&self, other: &Self, screening_square: f64) -> f64 {
        let mut sum = 0.0;
        for [square_x, damped_x] in self.aliases {
            for [square_y, damped_y] in other.aliases {
                sum += damped_x * damped_y / (square_x + square_y + screening_square);
            }
        }
        sum
    }
}

/// U² = (sin(kh/2)/(kh/2))^(2·[`ORDER`]) for `half` = kh/2.
fn squared_window(half: f64) -> f64 {
    if half == 0.0 {
        return 1.0;
    }
    let square = (libm::sin(half) / half) * (libm::sin(half) / half);
    let mut power = 1.0;
    for _ in 0..ORDER {
        power *= square;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spline_shares_out_exactly_one_around_its_point() {
        for above in [0.0, 0.25, 0.5, 0.999] {
            let weights = spline(above);
            let sum: f64 = weights.iter().sum();
            let middle: f64 = weights.iter().zip(0..).map(|(weight, node)| weight * f64::from(node)).sum();
            assert!((sum - 1.0).abs() < 1e-15, "{above}: {sum}");
            assert!((middle - (above + 4.0)).abs() < 1e-14, "{above}: {middle}");
        }
    }

    #[test]
    fn the_middle_of_the_spline_is_the_tabulated_one() {
        // The B-spline of order 10 at integers, times 9!: Euler's numbers.
        let eulerian = [1.0, 502.0, 14608.0, 88234.0, 156190.0, 88234.0, 14608.0, 502.0, 1.0, 0.0];
        for (weight, expected) in spline(0.0).iter().zip(eulerian) {
            assert!((weight * 362_880.0 - expected).abs() < 1e-9, "{weight} {expected}");
        }
    }
}
