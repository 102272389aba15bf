//! What the cut-off of the near part leaves out.

use super::System;
use core::f64::consts::PI;
use std::collections::BTreeMap;

/// Step of the inner integral's trapezoidal rule, which is right to about 1e-4 with it.
const INNER_STEP: f64 = 0.2;
/// Step of the outer integral's.
const OUTER_STEP: f64 = 0.3;
/// Where the substitution t = exp(x − e⁻ˣ) starts: t = 3·10⁻¹².
const START: f64 = -3.15;
/// Exponents further than this below the largest are left out: e⁻³⁰ ≈ 10⁻¹³.
const NEGLIGIBLE_EXPONENT: f64 = 30.0;
/// More terms than any valid splitting and cut-off take.
const MOST_TERMS: usize = 512;
/// (αr_c)² below this, or above [`LARGEST_REACH`], belongs to no valid splitting and cut-off.
const SMALLEST_REACH: f64 = 1e-15;
/// See [`SMALLEST_REACH`]; beyond it the force is e⁻¹⁰⁰⁰⁰ at most.
const LARGEST_REACH: f64 = 1e4;

/// The root mean square force, kBT/R0, of the near parts beyond a cut-off r_c, for any splitting α.
///
/// Under the root ρ⟨f²⟩²·∫_{r_c}^∞ (r·g(r²))² 2πr dr with g(s) = V0 ∫_{α²}^∞ exp(−κ²/4u − su) du. In the units z = (αr)²
/// and c = κ/2α that is πρ⟨f²⟩²V0²·∫ z·G(z)² dz from (αr_c)², G(z) = ∫₁^∞ exp(−c²/v − zv) dv. Without screening it is
/// πρ⟨f²⟩²V0²·E₁(2α²r_c²).
pub(super) struct NearError<'a> {
    system: &'a System,
    /// Nodes and weights of the integral over v.
    inner: Vec<(f64, f64)>,
    /// Nodes and weights of the integral over z.
    outer: Vec<(f64, f64)>,
    /// What was found for the bits of a splitting and a cut-off: a search comes back to the same ones.
    known: BTreeMap<(u64, u64), f64>,
}

impl<'a> NearError<'a> {
    /// That of a system.
    pub(super) fn new(system: &'a System) -> Self {
        let (inner, outer) = (exponential_rule(INNER_STEP), exponential_rule(OUTER_STEP));
        Self { system, inner, outer, known: BTreeMap::new() }
    }

    /// That of the splitting α (1/R0) and the cut-off r_c (R0).
    pub(super) fn evaluate(&mut self, splitting: f64, cutoff: f64) -> f64 {
        let key = (splitting.to_bits(), cutoff.to_bits());
        if let Some(error) = self.known.get(&key) {
            return *error;
        }
        let reach = splitting * cutoff * splitting * cutoff;
        let screening = 0.5 * self.system.screening() / splitting;
        let error = self.system.force_scale() * (PI * self.tail(reach, screening)).sqrt();
        self.known.insert(key, error);
        error
    }

    /// ∫ z·G(z)² dz from z = `reach`, with z = reach + scale·t.
    fn tail(&self, reach: f64, screening: f64) -> f64 {
        if reach > LARGEST_REACH || screening.is_infinite() {
            return 0.0;
        }
        if reach.is_nan() || reach < SMALLEST_REACH || screening.is_nan() {
            return f64::INFINITY;
        }
        let scale = reach.min(1.0);
        let least = least_exponent(reach, screening);
        let mut sum = 0.0;
        for (t, weight) in &self.outer {
            let z = reach + scale * t;
            if 2.0 * (least_exponent(z, screening) - least) > NEGLIGIBLE_EXPONENT {
                break;
            }
            let near = self.pair_force(z, screening);
            sum += scale * weight * z * near * near;
        }
        sum
    }

    /// G(z), with v = 1 + t.
    fn pair_force(&self, z: f64, screening: f64) -> f64 {
        let largest = (least_exponent(z, screening) + NEGLIGIBLE_EXPONENT) / z;
        let squared = screening * screening;
        let mut sum = 0.0;
        for (t, weight) in &self.inner {
            let v = 1.0 + t;
            if v > largest {
                break;
            }
            sum += weight * libm::exp(-squared / v - z * v);
        }
        sum
    }
}

/// The least of c²/v + zv over v ≥ 1.
fn least_exponent(z: f64, screening: f64) -> f64 {
    let root = z.sqrt();
    if screening > root { 2.0 * screening * root } else { screening * screening + z }
}

/// Nodes t and weights of ∫₀^∞ f(t) dt by the trapezoidal rule after t = exp(x − e⁻ˣ), which copes with an end at 0 and
/// with any decay.
fn exponential_rule(step: f64) -> Vec<(f64, f64)> {
    let node = |term: usize| {
        let x = START + step * term as f64;
        let inner = libm::exp(-x);
        let t = libm::exp(x - inner);
        (t, step * t * (1.0 + inner))
    };
    (0..MOST_TERMS).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bessel::scaled_k0_k1;

    fn system(capillary_length: f64) -> System {
        System {
            side: 1.0,
            particles: 1,
            capillary_strength: 1.0,
            capillary_length,
            mean_square_strength: 1.0,
        }
    }

    /// E₁(x) = e⁻ˣ ∫₀^∞ e⁻ᵗ/(x + t) dt by Simpson's rule in ln t.
    fn exponential_integral(x: f64) -> f64 {
        let (intervals, least, most) = (20_000, -60.0, 4.0);
        let step = (most - least) / f64::from(intervals);
        let mut sum = 0.0;
        for i in 0..=intervals {
            let t = libm::exp(least + step * f64::from(i));
            let weight = if i == 0 || i == intervals {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            sum += weight * t * libm::exp(-t) / (x + t);
        }
        libm::exp(-x) * sum * step / 3.0
    }

    #[test]
    fn without_screening_it_is_the_exponential_integral() {
        assert!((exponential_integral(1.0) - 0.219_383_934_395_520_3).abs() < 1e-10, "table 5.1 of A&S");
        for reach in [1e-6, 0.03, 0.3, 1.0, 2.5, 3.0, 4.0, 10.0] {
            let expected = (PI * exponential_integral(2.0 * reach * reach)).sqrt();
            let found = NearError::new(&system(f64::INFINITY)).evaluate(0.5, 2.0 * reach);
            assert!((found / expected - 1.0).abs() < 1e-3, "{reach}: {found} instead of {expected}");
        }
    }

    #[test]
    fn with_strong_screening_it_is_the_whole_force() {
        // For κ ≫ α² r all of the pair force is near: 2π ∫ r (κ K₁(κ r))² dr = π x² (K₀K₂ − K₁²) at x = κ r_c.
        for (kappa, cutoff) in [(1.0, 5.0), (0.3, 20.0), (5.0, 3.0)] {
            let x: f64 = kappa * cutoff;
            let (k0, k1) = scaled_k0_k1(x);
            let bracket = k0 * (k0 + 2.0 * k1 / x) - k1 * k1;
            let expected = libm::exp(-x) * (PI * x * x * bracket).sqrt();
            let found = NearError::new(&system(1.0 / kappa)).evaluate(1e-3, cutoff);
            assert!((found / expected - 1.0).abs() < 1e-2, "{kappa}: {found} instead of {expected}");
        }
    }

    #[test]
    fn with_some_screening_it_is_the_double_integral() {
        // z-integral done in closed form: ∫∫ exp(−c²/v − c²/w − Z(v+w)) [Z/(v+w) + 1/(v+w)²] dv dw, midpoints.
        let (screening, reach): (f64, f64) = (1.3, 2.0);
        let step = 0.01;
        let mut sum = 0.0;
        for i in 0..800 {
            for j in 0..800 {
                let (v, w) = (1.0 + step * (f64::from(i) + 0.5), 1.0 + step * (f64::from(j) + 0.5));
                let exponent = screening * screening * (1.0 / v + 1.0 / w) + reach * (v + w);
                sum += step * step * libm::exp(-exponent) * (reach + 1.0 / (v + w)) / (v + w);
            }
        }
        let found = NearError::new(&system(1.0)).tail(reach, screening);
        assert!((found / sum - 1.0).abs() < 1e-3, "{found} instead of {sum}");
    }

    #[test]
    fn it_falls_with_splitting_and_cutoff() {
        for capillary_length in [0.5, 20.0, f64::INFINITY] {
            let system = system(capillary_length);
            let mut last = f64::INFINITY;
            for step in 1..30 {
                let error = NearError::new(&system).evaluate(0.1 * f64::from(step), 3.0);
                assert!(error < last, "{capillary_length}, {step}");
                last = error;
            }
        }
    }
}
