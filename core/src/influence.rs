//! Influence functions and gradients: what the mesh multiplies a spectrum with.
//!
//! The interface Û(k) = 2πV0·ρ̂(k)/(k² + κ²), in units where f·U is an energy (Eq. 18), and the force
//! F̂ = +i k Û (Eq. 21 with the sign that attracts); the far part of the split force has another Û, see
//! [`crate::optimal`]. Two tables hold all of it, computed once in binary64
//! with libm and rounded to binary32:
//!
//! - the influence table, (M/2+1) × (M/2+1) entries, element `|m|·(M/2+1) + |l|` for k = 2π(l, m)/L;
//! - the gradient table, M entries, the k of each index (or its difference form), odd, zero at Nyquist.
//!
//! ```
//! use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
//! use meniscus_core::parameters::Parameters;
//!
//! let parameters = Parameters { grid: 16, side: 16.0, ..Parameters::default() };
//! let mut influence = [0.0; influence_length(16)];
//! let mut gradient = [0.0; 16];
//! fill_influence(&parameters, &mut influence);
//! fill_gradient(&parameters, &mut gradient);
//! assert_eq!((influence[0], gradient[8]), (0.0, 0.0));
//! assert_eq!(gradient[3], -gradient[13]);
//! ```

use crate::assignment::DISC;
use crate::optimal::OptimalInfluence;
use crate::parameters::{Gradient, Influence, Parameters};
use core::f64::consts::PI;

/// Length of the influence table for M nodes a side, (M/2+1)².
#[must_use]
pub const fn influence_length(grid: usize) -> usize {
    (grid / 2 + 1).saturating_mul(grid / 2 + 1)
}

/// Fills the influence table, unit kBT·R0⁰ per unit of node mass and per 1/R0 of gradient.
///
/// It holds ½·2πV0/L²·2⁻²⁰ over the denominator of the influence function, so that the sum over all modes
/// needs no further factor: 2⁻²⁰ is the unit of mass, and ½ belongs to the split of two real columns
/// that share a transform. k = 0 exerts no force and is 0. `parameters` is valid; entries beyond the table's
/// length are left as they are.
pub fn fill_influence(parameters: &Parameters, influence: &mut [f32]) {
    let half = parameters.grid / 2;
    let scale = PI * parameters.capillary_strength / (parameters.side * parameters.side) / f64::from(DISC);
    if parameters.influence == Influence::Optimal {
        fill_optimal(parameters, scale, influence);
        return;
    }
    let kappa = 1.0 / parameters.capillary_length;
    for (m, row) in influence.chunks_exact_mut(half + 1).take(half + 1).enumerate() {
        let along_y = squared_wave_number(parameters, m);
        for (l, entry) in row.iter_mut().enumerate() {
            let along_x = squared_wave_number(parameters, l);
            *entry =
                if l == 0 && m == 0 { 0.0 } else { (scale / (along_x + along_y + kappa * kappa)) as f32 };
        }
    }
}

/// Fills the influence table with the optimal influence function times `scale`, which costs the most in the sums over
/// aliases: the half of the table below its diagonal is the mirror image of the other.
fn fill_optimal(parameters: &Parameters, scale: f64, influence: &mut [f32]) {
    let row = parameters.grid / 2 + 1;
    let optimal = OptimalInfluence {
        grid: parameters.grid,
        side: parameters.side,
        order: parameters.assignment.order(),
        splitting: parameters.splitting,
        capillary_length: parameters.capillary_length,
    };
    for m in 0..row {
        for l in 0..=m {
            let value = scale * optimal.at(l, m);
            // Nothing instead of next to nothing: subnormal numbers are slow on many machines.
            let value = if value.abs() < 1e-30 { 0.0 } else { value as f32 };
            for element in [m * row + l, l * row + m] {
                if let Some(entry) = influence.get_mut(element) {
                    *entry = value;
                }
            }
        }
    }
}

/// k² along one axis as the influence function sees it, R0⁻².
fn squared_wave_number(parameters: &Parameters, index: usize) -> f64 {
    let wave_number = 2.0 * PI * index as f64 / parameters.side;
    match parameters.influence {
        Influence::Continuum | Influence::Optimal => wave_number * wave_number,
        Influence::Paper => {
            let spacing = parameters.side / parameters.grid as f64;
            let sine = libm::sin(wave_number * spacing * 0.5) * 2.0 / spacing;
            sine * sine
        }
    }
}

/// Fills the gradient table, unit 1/R0, for the M indices of an axis.
///
/// `parameters` is valid; entries beyond M are left as they are.
pub fn fill_gradient(parameters: &Parameters, gradient: &mut [f32]) {
    let grid = parameters.grid;
    for (index, entry) in gradient.iter_mut().take(grid).enumerate() {
        let frequency = if index > grid / 2 { grid - index } else { index };
        let magnitude = if frequency == grid / 2 { 0.0 } else { wave_number(parameters, frequency) as f32 };
        *entry = if index > grid / 2 { -magnitude } else { magnitude };
    }
}

/// The wave number of a frequency below Nyquist as the gradient sees it, R0⁻¹.
fn wave_number(parameters: &Parameters, frequency: usize) -> f64 {
    let spacing = parameters.side / parameters.grid as f64;
    let phase = 2.0 * PI * frequency as f64 / parameters.grid as f64;
    match parameters.gradient {
        Gradient::Spectral => phase / spacing,
        Gradient::Difference2 => libm::sin(phase) / spacing,
        Gradient::Difference4 => (8.0 * libm::sin(phase) - libm::sin(2.0 * phase)) / (6.0 * spacing),
    }
}
