//! The modified Bessel functions K₀ and K₁, free of their exponential: eˣ·K₀(x) and eˣ·K₁(x) for x > 0.

/// Step of the trapezoidal rule in t: for small x it errs by about exp(−π²/step), for large x as below.
const STEP: f64 = 0.2;
/// Exponents beyond this are left out: e⁻⁴² ≈ 6·10⁻¹⁹.
const NEGLIGIBLE_EXPONENT: f64 = 42.0;
/// More terms than any x ≥ 10⁻³⁰⁰ takes.
const MOST_TERMS: usize = 8192;

/// (eˣ·K₀(x), eˣ·K₁(x)), to about 1e-15 relative.
///
/// The trapezoidal rule on ∫₀^∞ exp(−x(cosh t − 1)) cosh(νt) dt (Abramowitz & Stegun 9.6.24), whose integrand is
/// entire and decays doubly exponentially; its width is 1/√x for large x, and the step follows.
pub(super) fn scaled_k0_k1(x: f64) -> (f64, f64) {
    let step = STEP / (1.0 + 0.1 * x).sqrt();
    let (mut zeroth, mut first) = (0.5, 0.5);
    for term in 1..MOST_TERMS {
        let t = step * term as f64;
        let half_sinh = libm::sinh(0.5 * t);
        let exponent = 2.0 * x * half_sinh * half_sinh;
        if exponent - t > NEGLIGIBLE_EXPONENT {
            break;
        }
        let weight = libm::exp(-exponent);
        zeroth += weight;
        first += weight * libm::cosh(t);
    }
    (step * zeroth, step * first)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x, K₀(x), K₁(x) of Abramowitz & Stegun, table 9.8 and the series 9.6.11 and 9.6.13.
    const TABLE: [(f64, f64, f64); 5] = [
        (0.001, 7.023688800562382, 999.9962381560856),
        (0.1, 2.4270690247020164, 9.853844780870606),
        (1.0, 0.42102443824070834, 0.6019072301972346),
        (10.0, 1.778006231616765e-05, 1.8648773453825585e-05),
        (500.0, 3.992321609117793e-219, 3.9963119385460035e-219),
    ];

    #[test]
    fn values_are_those_of_the_table() {
        for (x, zeroth, first) in TABLE {
            let (k0, k1) = scaled_k0_k1(x);
            let decay = libm::exp(-x);
            assert!((k0 * decay / zeroth - 1.0).abs() < 1e-13, "K0({x})");
            assert!((k1 * decay / first - 1.0).abs() < 1e-13, "K1({x})");
        }
    }
}
