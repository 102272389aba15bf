//! The near part of the Ewald sum: a pair's short-ranged force and energy as functions of r².

use core::f64::consts::PI;

/// The near part of a pair's force and energy as functions of r², tabulated.
#[derive(Clone, Debug)]
pub(super) struct NearPart {
    splitting_square: f64,
    integral: NearIntegral,
    cutoff_square: f64,
    force: OctaveTable,
    potential: OctaveTable,
}

impl NearPart {
    /// The near part for α = `splitting` (1/R₀) and `screened` = κ²/4α², up to r = `cutoff` (R₀).
    pub(super) fn new(splitting: f64, screened: f64, cutoff: f64) -> Self {
        let splitting_square = splitting * splitting;
        let integral = NearIntegral::new(screened);
        let cutoff_square = cutoff * cutoff;
        let force = OctaveTable::new(cutoff_square, |square| integral.force(splitting_square * square));
        let potential =
            OctaveTable::new(cutoff_square, |square| integral.potential(splitting_square * square));
        Self { splitting_square, integral, cutoff_square, force, potential }
    }

    /// Square of the separation (R₀²) beyond which the near part is left out.
    pub(super) fn cutoff_square(&self) -> f64 {
        self.cutoff_square
    }

    /// r F_near(r)/V₀ at r² = `square` (R₀²).
    pub(super) fn force_times_distance(&self, square: f64) -> f64 {
        self.force.value(square).unwrap_or_else(|| self.integral.force(self.splitting_square * square))
    }

    /// −U_near(r)/V₀ at r² = `square` (R₀²).
    pub(super) fn potential(&self, square: f64) -> f64 {
        self.potential
            .value(square)
            .unwrap_or_else(|| self.integral.potential(self.splitting_square * square))
    }
}

/// Magnitude (k_B T/R₀) of the near part at splitting α = `splitting` (1/R₀) of the attraction of two discs
/// `separation` (R₀) apart, no images: (V₀r/4) ∫₀^{t*} t⁻² exp(−κ²t − r²/4t) dt with t* = 1/(4α²).
pub fn near_force(separation: f64, capillary_strength: f64, capillary_length: f64, splitting: f64) -> f64 {
    let screened = 0.25 / (capillary_length * capillary_length * splitting * splitting);
    let argument = splitting * splitting * separation * separation;
    capillary_strength / separation * NearIntegral::new(screened).force(argument)
}

/// The integrals of the near part, dimensionless: with a = α²r², b = κ²/4α² and t = 1/(4α²v),
/// r F_near/V₀ = (r²/4) ∫₀^{t*} t⁻² exp(−κ²t − r²/4t) dt = a ∫₁^∞ exp(−av − b/v) dv and
/// −U_near/V₀ = ½ ∫₀^{t*} t⁻¹ exp(−κ²t − r²/4t) dt = ½ ∫₁^∞ exp(−av − b/v) dv/v.
///
/// With v = e^τ both integrands are entire, and the double-exponential rule of Takahasi and Mori (1974) on
/// [0, τ_max] converges to rounding.
#[derive(Clone, Debug)]
struct NearIntegral {
    screened: f64,
    /// Abscissas on (0, 1) and their weights.
    rule: Vec<[f64; 2]>,
}

impl NearIntegral {
    /// Step of the rule: halving it changes no result by more than rounding.
    const STEP: f64 = 1.0 / 40.0;
    /// The rule ends this far on each side of its middle, where the weights are below 1e-17.
    const HALF_LENGTH: f64 = 3.3;
    /// The integral ends where the exponent has fallen this far below its largest value.
    const NEGLIGIBLE_EXPONENT: f64 = 45.0;

    fn new(screened: f64) -> Self {
        Self::with_step(screened, Self::STEP)
    }

    fn with_step(screened: f64, step: f64) -> Self {
        let last = (Self::HALF_LENGTH / step) as i32;
        let node = |i: i32| {
            let s = step * f64::from(i);
            let growth = libm::exp(-PI * libm::sinh(s));
            let abscissa = 1.0 / (1.0 + growth);
            [abscissa, step * PI * libm::cosh(s) * abscissa * abscissa * growth]
        };
        Self { screened, rule: (-last..=last).map(node).collect() }
    }

    fn force(&self, a: f64) -> f64 {
        self.integrate(a, |v| a * v)
    }

    fn potential(&self, a: f64) -> f64 {
        self.integrate(a, |_| 0.5)
    }

    /// ∫ factor(v) exp(−av − b/v) dτ over v = e^τ from 1 to where nothing is left.
    fn integrate(&self, a: f64, factor: impl Fn(f64) -> f64) -> f64 {
        let exponent = |v: f64| a * v + self.screened / v;
        let least = exponent((self.screened / a).sqrt().max(1.0));
        let end = libm::log((least + Self::NEGLIGIBLE_EXPONENT) / a);
        let mut sum = 0.0;
        for [abscissa, weight] in &self.rule {
            let v = libm::exp(end * abscissa);
            sum += weight * factor(v) * libm::exp(-exponent(v));
        }
        end * sum
    }
}

/// A function of a positive number, analytic but for a branch point at 0, interpolated by Chebyshev
/// polynomials on a quarter of an octave each: there the branch point is at least nine half-widths away
/// from the middle, so that every further coefficient is about 18 times smaller.
#[derive(Clone, Debug)]
struct OctaveTable {
    first: u64,
    pieces: Vec<[f64; OctaveTable::COEFFICIENTS]>,
}

impl OctaveTable {
    const COEFFICIENTS: usize = 14;
    const OCTAVES: u64 = 24;
    /// Above this bit of an f64 are its exponent and the two leading bits of its mantissa, which number the
    /// quarters of octaves.
    const QUARTER: u32 = 50;

    /// Tabulates the octaves up to and including the one of `highest`.
    fn new(highest: f64, function: impl Fn(f64) -> f64) -> Self {
        let last = highest.to_bits() >> Self::QUARTER;
        let first = last + 1 - 4 * Self::OCTAVES;
        let cosines = Self::cosines();
        let piece = |quarter: u64| {
            let [lower, upper] = Self::ends(quarter);
            Self::fit(&cosines, |x| function(0.5 * (upper + lower) + 0.5 * (upper - lower) * x))
        };
        Self { first, pieces: (first..=last).map(piece).collect() }
    }

    /// The value at `x`, or nothing outside the table.
    fn value(&self, x: f64) -> Option<f64> {
        let quarter = x.to_bits() >> Self::QUARTER;
        let piece = self.pieces.get(quarter.checked_sub(self.first)? as usize)?;
        let [lower, upper] = Self::ends(quarter);
        let twice = 4.0 * (x - lower) / (upper - lower) - 2.0;
        let mut next = 0.0;
        let mut last = 0.0;
        for coefficient in piece[1..].iter().rev() {
            let sum = coefficient + twice * next - last;
            last = next;
            next = sum;
        }
        Some(piece[0] + 0.5 * twice * next - last)
    }

    fn ends(quarter: u64) -> [f64; 2] {
        [f64::from_bits(quarter << Self::QUARTER), f64::from_bits((quarter + 1) << Self::QUARTER)]
    }

    /// cos(πj/2n) for j = 0 … 4n−1.
    fn cosines() -> Vec<f64> {
        let count = Self::COEFFICIENTS;
        (0..4 * count).map(|j| libm::cos(PI * j as f64 / (2 * count) as f64)).collect()
    }

    /// Chebyshev coefficients of `function` on [−1, 1] from its values at the zeros of T_n.
    fn fit(cosines: &[f64], function: impl Fn(f64) -> f64) -> [f64; Self::COEFFICIENTS] {
        let count = Self::COEFFICIENTS;
        let mut coefficients = [0.0; Self::COEFFICIENTS];
        for node in 0..count {
            let value = function(cosines[2 * node + 1]);
            for (order, coefficient) in coefficients.iter_mut().enumerate() {
                let share = if order == 0 { 1.0 } else { 2.0 } / count as f64;
                *coefficient += share * value * cosines[order * (2 * node + 1) % (4 * count)];
            }
        }
        coefficients
    }
}

#[cfg(test)]
mod tests {
    use super::super::RandomNumbers;
    use super::super::bessel::{k0, k1};
    use super::*;

    /// κ²/4α² from no screening to λ = 0.01 L at α = 12/L.
    const SCREENED: [f64; 6] = [0.0, 1e-6, 0.01, 1.0, 9.8, 18.0];

    /// Values of α²r² from 1e-10 to the cut-off, evenly spread in their logarithm.
    fn arguments(count: usize) -> Vec<f64> {
        let mut random = RandomNumbers::new(5);
        (0..count).map(|_| 36.0 * libm::exp(-26.0 * random.uniform())).collect()
    }

    #[test]
    fn half_the_step_gives_the_same_integrals() {
        for screened in SCREENED {
            let rule = NearIntegral::new(screened);
            let finer = NearIntegral::with_step(screened, 0.5 * NearIntegral::STEP);
            for a in arguments(200) {
                assert!((rule.force(a) / finer.force(a) - 1.0).abs() < 1e-13, "{screened} {a}");
                assert!((rule.potential(a) / finer.potential(a) - 1.0).abs() < 1e-13, "{screened} {a}");
            }
        }
    }

    #[test]
    fn without_screening_the_force_is_a_gauss_curve() {
        let integral = NearIntegral::new(0.0);
        for a in arguments(200) {
            assert!((integral.force(a) / libm::exp(-a) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn the_near_force_has_its_dimensions() {
        // V₀/r · exp(−α²r²) without screening, (V₀/λ)·K₁(r/λ) with much of it.
        let gauss = 0.89 / 3.0 * libm::exp(-0.81);
        assert!((near_force(3.0, 0.89, f64::INFINITY, 0.3) / gauss - 1.0).abs() < 1e-13);
        let bare = 0.89 / 2.0 * k1(1.5);
        assert!((near_force(3.0, 0.89, 2.0, 0.01) / bare - 1.0).abs() < 1e-13);
    }

    #[test]
    fn under_strong_screening_the_near_part_is_everything() {
        let integral = NearIntegral::new(50.0);
        for a in [1e-4, 0.01, 0.1, 0.5] {
            let x = 2.0 * (50.0_f64 * a).sqrt();
            assert!((integral.force(a) / (x * k1(x)) - 1.0).abs() < 1e-13);
            assert!((integral.potential(a) / k0(x) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn tables_hold_the_integrals() {
        for screened in SCREENED {
            let near = NearPart::new(1.0, screened, 6.0);
            for a in arguments(300) {
                let force_error = near.force_times_distance(a) - near.integral.force(a);
                let potential_error = near.potential(a) - near.integral.potential(a);
                assert!(force_error.abs() < 4e-15, "{screened} {a}: {force_error:e}");
                assert!(potential_error.abs() < 2e-14, "{screened} {a}: {potential_error:e}");
            }
        }
    }
}
