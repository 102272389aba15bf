//! The modified Bessel functions free of their exponentials: eˣ·K₀(x) and eˣ·K₁(x) for x > 0, e⁻ˣ·I₀(x) and e⁻ˣ·I₁(x) for
//! x ≥ 0.

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
pub(crate) fn scaled_k0_k1(x: f64) -> (f64, f64) {
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

/// Where the power series of I₀ and I₁ gives way to the asymptotic one, whose least term is then about e⁻²ˣ.
const SERIES_LIMIT: f64 = 20.0;

/// (e⁻ˣ·I₀(x), e⁻ˣ·I₁(x)), to about 1e-15 relative.
///
/// I_ν(x) = (x/2)^ν Σ_j (x²/4)^j/(j! (j+ν)!) (Abramowitz & Stegun 9.6.10), all of whose terms are positive, and for large x
/// its asymptotic expansion (9.7.1).
pub(crate) fn scaled_i0_i1(x: f64) -> (f64, f64) {
    if x > SERIES_LIMIT {
        let root = (core::f64::consts::TAU * x).sqrt();
        return (asymptotic_sum(x, 0.0) / root, asymptotic_sum(x, 4.0) / root);
    }
    let quarter_square = 0.25 * x * x;
    let (mut zeroth, mut first) = (0.0, 0.0);
    let (mut term, mut order) = (1.0, 1.0);
    while term > f64::EPSILON * 1e-3 * zeroth {
        zeroth += term;
        first += term / order;
        term *= quarter_square / (order * order);
        order += 1.0;
    }
    let decay = libm::exp(-x);
    (decay * zeroth, decay * 0.5 * x * first)
}

/// 1 − (μ − 1)/8x + (μ − 1)(μ − 9)/2!(8x)² − … to its least term, μ = 4ν².
fn asymptotic_sum(x: f64, mu: f64) -> f64 {
    let (mut sum, mut term, mut order) = (0.0, 1.0_f64, 1.0);
    loop {
        sum += term;
        let odd = 2.0 * order - 1.0;
        let next = -term * (mu - odd * odd) / (8.0 * order * x);
        if next.abs() >= term.abs() || next.abs() < f64::EPSILON * 1e-2 {
            return sum;
        }
        term = next;
        order += 1.0;
    }
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

    /// x, e⁻ˣ·I₀(x), e⁻ˣ·I₁(x) computed by mpmath at 40 digits and rounded to f64.
    const GROWING: [(f64, f64, f64); 11] = [
        (1e-6, 0.99999900000075, 4.999995000003125e-7),
        (0.001, 0.9990007495835156, 0.0004995003123542213),
        (0.1, 0.9071009257823011, 0.045298446808809324),
        (1.0, 0.46575960759364043, 0.20791041534970844),
        (5.0, 0.18354081260932836, 0.16397226694454237),
        (10.0, 0.12783333716342862, 0.12126268138445552),
        (19.9, 0.09000858886438959, 0.0877171021317061),
        (20.1, 0.08955376362061344, 0.0872968518432016),
        (30.0, 0.0731459464822373, 0.07191633059864755),
        (100.0, 0.03994437929909668, 0.039744153025130256),
        (500.0, 0.017845706500153168, 0.017827851852898056),
    ];

    #[test]
    fn growing_values_are_those_of_the_table() {
        for (x, zeroth, first) in GROWING {
            let (i0, i1) = scaled_i0_i1(x);
            // The argument of the exponential is rounded once: x units in the last place.
            let tolerance = 1e-15 + 1e-16 * x;
            assert!((i0 / zeroth - 1.0).abs() < tolerance, "I0({x}) = {i0}");
            assert!((i1 / first - 1.0).abs() < tolerance, "I1({x}) = {i1}");
        }
        assert_eq!(scaled_i0_i1(0.0), (1.0, 0.0));
    }

    /// I₀K₁ + I₁K₀ = 1/x (Abramowitz & Stegun 9.6.15).
    #[test]
    fn the_wronskian_is_one_over_x() {
        for x in [1e-3, 0.2, 1.0, 4.7, 19.0, 21.0, 300.0] {
            let ((i0, i1), (k0, k1)) = (scaled_i0_i1(x), scaled_k0_k1(x));
            assert!((x * (i0 * k1 + i1 * k0) - 1.0).abs() < 3e-15, "at {x}");
        }
    }
}
