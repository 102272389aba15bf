//! The near part of the split capillary force: what a coarse mesh cannot hold, pair by pair.
//!
//! V0·K0(κr) = (V0/2)∫₀^∞ (dt/t) exp(−κ²t − r²/4t) is cut at t* = 1/(4α²). What lies below is short-ranged: an
//! attraction of modulus V0·E(r²)/r with
//!
//! E(s) = s·∫_{α²}^∞ exp(−κ²/(4u) − s·u) du = exp(−α²s)·∫₀^∞ exp(−v − κ²s/(4(α²s + v))) dv,
//!
//! which is exp(−α²r²) without screening. What lies above is smooth and belongs to the mesh, see
//! [`crate::optimal`].
//!
//! E is tabulated over s in [`SEGMENTS_PER_OCTAVE`] segments an octave, from s = ½ R0² to the cut-off, each a cubic
//! through four of its points: off by less than 10⁻⁶ of its largest value, 1. The table is computed in binary64 with
//! libm and evaluated in binary32.
//!
//! ```
//! use meniscus_core::near_part::{evaluate, fill_table, table_length};
//!
//! let mut table = [[0.0; 4]; table_length(6.0)];
//! fill_table(0.5, f64::INFINITY, &mut table);
//! assert!((evaluate(&table, 4.0) - (-1.0_f32).exp()).abs() < 1e-6);
//! ```

/// The coefficients of a cubic, from the constant up, in the fraction of the segment.
pub type Segment = [f32; 4];

/// Segments in each octave of the squared distance.
pub const SEGMENTS_PER_OCTAVE: usize = 8;

/// Binary logarithm of [`SEGMENTS_PER_OCTAVE`].
const SEGMENT_BITS: u32 = SEGMENTS_PER_OCTAVE.trailing_zeros();

/// Bits of a binary32 number that tell where in its segment it is.
pub const FRACTION_BITS: u32 = 23 - SEGMENT_BITS;

/// Where the table begins, R0²: below the square of [`crate::repulsion::SMALLEST_DISTANCE`].
pub const FIRST: f32 = 0.5;

/// Length of a table that serves every cut-off, as no box is larger than 2¹⁶ R0.
pub const LARGEST_TABLE: usize = 31 * SEGMENTS_PER_OCTAVE;

/// The number of segments that reach to a cut-off of `cutoff` R0, at most [`LARGEST_TABLE`]; 0 for no cut-off.
#[must_use]
pub const fn table_length(cutoff: f64) -> usize {
    let squared = (cutoff * cutoff) as f32;
    if squared < FIRST {
        return 0;
    }
    let length = index_of(squared) + 1;
    if length > LARGEST_TABLE { LARGEST_TABLE } else { length }
}

/// The segment of a squared distance of at least [`FIRST`]: its exponent and the first bits of its mantissa.
const fn index_of(squared: f32) -> usize {
    ((squared.to_bits() - FIRST.to_bits()) >> FRACTION_BITS) as usize
}

/// Fills the table for splitting `splitting` (α, 1/R0) and capillary length `capillary_length` (λ, R0; infinity
/// allowed), as far as its length goes. Both are in the ranges of [`crate::parameters`].
pub fn fill_table(splitting: f64, capillary_length: f64, table: &mut [Segment]) {
    let kappa = 1.0 / capillary_length;
    let mut begin = f64::from(FIRST);
    for (index, segment) in table.iter_mut().enumerate() {
        let octave = f64::from(FIRST) * (1_u64 << (index / SEGMENTS_PER_OCTAVE).min(63)) as f64;
        let width = octave / SEGMENTS_PER_OCTAVE as f64;
        let value = |thirds: f64| force_times_distance(begin + thirds / 3.0 * width, splitting, kappa);
        *segment = cubic_through([value(0.0), value(1.0), value(2.0), value(3.0)]);
        begin += width;
    }
}

/// E(s) from a table that reaches to `squared` (s, R0², at least 0.81): the near part in units of V0/r. 0 beyond the
/// table.
#[inline]
#[must_use]
pub fn evaluate(table: &[Segment], squared: f32) -> f32 {
    const UNIT: f32 = 1.0 / (1_u32 << FRACTION_BITS) as f32;
    let bits = squared.to_bits().wrapping_sub(FIRST.to_bits());
    let Some(&[constant, linear, quadratic, cubic]) = table.get((bits >> FRACTION_BITS) as usize) else {
        return 0.0;
    };
    let fraction = (bits & ((1 << FRACTION_BITS) - 1)) as f32 * UNIT;
    ((cubic * fraction + quadratic) * fraction + linear) * fraction + constant
}

/// The cubic through four values at 0, 1/3, 2/3 and 1.
fn cubic_through([a, b, c, d]: [f64; 4]) -> Segment {
    let linear = 0.5 * (-11.0 * a + 18.0 * b - 9.0 * c + 2.0 * d);
    let quadratic = 4.5 * (2.0 * a - 5.0 * b + 4.0 * c - d);
    let cubic = 4.5 * (-a + 3.0 * b - 3.0 * c + d);
    [kept(a), kept(linear), kept(quadratic), kept(cubic)]
}

/// A coefficient in binary32, nothing instead of next to nothing: subnormal numbers are slow on many machines.
fn kept(coefficient: f64) -> f32 {
    if coefficient.abs() < 1e-30 { 0.0 } else { coefficient as f32 }
}

/// E(s), by the trapezoidal rule on ∫₀^∞ exp(−v − b/(a + v)) dv with v = exp(y − exp(−y)), which makes the integrand
/// decay doubly exponentially at both ends (Takahasi and Mori, 1974); a = α²s, b = κ²s/4.
fn force_times_distance(squared: f64, splitting: f64, kappa: f64) -> f64 {
    const STEP: f64 = 0.125;
    const POINTS: i32 = 34;
    let a = splitting * splitting * squared;
    let b = 0.25 * kappa * kappa * squared;
    let front = libm::exp(-a);
    if b == 0.0 || front == 0.0 {
        return front;
    }
    let mut sum = 0.0;
    for point in -POINTS..=POINTS + 6 {
        let y = f64::from(point) * STEP;
        let decay = libm::exp(-y);
        let v = libm::exp(y - decay);
        let weight = v * (1.0 + decay);
        sum += weight * libm::exp(-v - b / (a + v));
    }
    front * STEP * sum
}
