//! The near part of the capillary potential as a function of r², tabulated.
//!
//! K₀(κr) = ½ ∫₀^∞ (du/u) exp(−κ²/4u − r²u) is cut at u = α². What lies above is short-ranged and belongs here:
//! φ_near = ½ ∫₁^∞ (dv/v) exp(−b/v − av), φ_far = ½ ∫₀¹ (dv/v) exp(−b/v − av), with a = α²r² and b = κ²/4α².
//!
//! In: α (1/R0), b, r_c (R0). Out: φ_near, a pure number, for a pair of strengths 1 and V0 = 1; a pair's energy is
//! −V0 f_i f_j times it. Below [`SMALLEST_DISTANCE`] it is what makes φ_near + φ_far a straight line in r.

use meniscus_core::repulsion::SMALLEST_DISTANCE;

/// The near part up to its cut-off.
#[derive(Clone, Debug)]
pub(super) struct NearPart {
    cutoff: f64,
    /// The near part from [`SMALLEST_DISTANCE`] on.
    outer: Vec<Cubic>,
    /// Number of the piece of `outer` that comes first.
    first: u64,
    /// Value and slope (1/R0) of the straight line at [`SMALLEST_DISTANCE`].
    held: [f64; 2],
    /// How much larger the far part is than at [`SMALLEST_DISTANCE`], at smaller distances.
    inner: Vec<Cubic>,
}

impl NearPart {
    /// Square of the distance below which the potential is a straight line, R0².
    const SMALLEST_SQUARE: f64 = SMALLEST_DISTANCE * SMALLEST_DISTANCE;
    /// Above this bit of a binary64 number are its exponent and the 7 leading bits of its mantissa, which number the
    /// 128ths of octaves. The cubics are good to 3e-11 then.
    const PIECE: u32 = 45;
    /// Pieces of equal length in r² below [`SMALLEST_DISTANCE`].
    const INNER_PIECES: usize = 256;
    /// The far part of the integral is negligible from exp(−40) down: its integrand goes as v.
    const LOWEST_LOGARITHM: f64 = -40.0;
    /// The near part ends where exp(−av) has fallen to exp(−100) for the smallest a.
    const LARGEST_EXPONENT: f64 = 100.0;

    /// The near part for α = `splitting` (1/R0), b = `screened`, r_c = `cutoff` (R0).
    pub(super) fn new(splitting: f64, screened: f64, cutoff: f64) -> Self {
        let splitting_square = splitting * splitting;
        let held = splitting_square * Self::SMALLEST_SQUARE;
        let highest = libm::log(Self::LARGEST_EXPONENT / held).max(1.0);
        let near = Integral::new(screened, 0.0, highest);
        let far = Integral::new(screened, Self::LOWEST_LOGARITHM, 0.0);

        let number = |square: f64| square.to_bits() >> Self::PIECE;
        let first = number(Self::SMALLEST_SQUARE);
        let outer_ends =
            (first..=number(cutoff * cutoff) + 1).map(|piece| f64::from_bits(piece << Self::PIECE));
        let inner_piece = Self::SMALLEST_SQUARE / Self::INNER_PIECES as f64;
        let inner_ends = (0..=Self::INNER_PIECES).map(|piece| piece as f64 * inner_piece);

        let [near_value, near_decline] = near.at(held);
        let [_, far_decline] = far.at(held);
        // dφ/dr = 2α²r dφ/da.
        let slope = 2.0 * splitting_square * SMALLEST_DISTANCE * (near_decline + far_decline);
        Self {
            cutoff,
            outer: Cubic::along(outer_ends, splitting_square, |a| near.at(a)),
            first,
            held: [near_value, slope],
            inner: Cubic::along(inner_ends, splitting_square, |a| far.rise(held, a)),
        }
    }

    /// r_c, R0.
    pub(super) fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// φ_near at r² = `square` (R0²).
    #[inline]
    pub(super) fn potential(&self, square: f64) -> f64 {
        if square >= self.cutoff * self.cutoff {
            return 0.0;
        }
        if square < Self::SMALLEST_SQUARE {
            return self.potential_of_overlap(square);
        }
        let piece = (square.to_bits() >> Self::PIECE) - self.first;
        self.outer.get(piece as usize).map_or(0.0, |cubic| cubic.at(square))
    }

    fn potential_of_overlap(&self, square: f64) -> f64 {
        let piece = (square / Self::SMALLEST_SQUARE * Self::INNER_PIECES as f64) as usize;
        let rise = self.inner.get(piece).map_or(0.0, |cubic| cubic.at(square));
        let [value, slope] = self.held;
        value + slope * (SMALLEST_DISTANCE - square.sqrt()) - rise
    }
}

/// A cubic with given values and slopes at the ends of an interval (Hermite).
#[derive(Clone, Copy, Debug)]
struct Cubic {
    lower: f64,
    per_length: f64,
    coefficients: [f64; 4],
}

impl Cubic {
    /// Cubics between neighbouring `ends` (squares of distances, R0²) for a function of a = α²r² of which `function` gives
    /// the value and minus the slope.
    fn along(
        ends: impl Iterator<Item = f64>,
        splitting_square: f64,
        function: impl Fn(f64) -> [f64; 2],
    ) -> Vec<Self> {
        let knots: Vec<(f64, [f64; 2])> = ends.map(|end| (end, function(splitting_square * end))).collect();
        let between = |pair: &[(f64, [f64; 2])]| {
            let &[(lower, [value, decline]), (upper, [next_value, next_decline])] = pair else { return None };
            let length = upper - lower;
            let slope = -decline * splitting_square * length;
            let next_slope = -next_decline * splitting_square * length;
            let rise = next_value - value;
            let coefficients =
                [value, slope, 3.0 * rise - 2.0 * slope - next_slope, slope + next_slope - 2.0 * rise];
            Some(Self { lower, per_length: 1.0 / length, coefficients })
        };
        knots.windows(2).filter_map(between).collect()
    }

    #[inline]
    fn at(&self, square: f64) -> f64 {
        let along = (square - self.lower) * self.per_length;
        let [constant, linear, quadratic, cubic] = self.coefficients;
        constant + along * (linear + along * (quadratic + along * cubic))
    }
}

/// ½ ∫ (dv/v) exp(−b/v − av) as a function of a, by Gauss and Legendre's rule on pieces of ln v.
#[derive(Clone, Debug)]
struct Integral {
    /// v and half the weight times exp(−b/v).
    rule: Vec<[f64; 2]>,
}

impl Integral {
    /// Length of a piece of ln v, on which the integrand is nearly a polynomial.
    const PIECE: f64 = 0.5;
    /// Positive zeros of the Legendre polynomial P₈ and their weights (Abramowitz and Stegun, table 25.4).
    const GAUSS_LEGENDRE: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_29],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_47],
        [0.960_289_856_497_536_2, 0.101_228_536_290_376_26],
    ];

    /// The integral over ln v from `lowest` to `highest`, with b = `screened`.
    fn new(screened: f64, lowest: f64, highest: f64) -> Self {
        let pieces = libm::ceil((highest - lowest) / Self::PIECE) as usize;
        let half = 0.5 * (highest - lowest) / pieces as f64;
        let mut rule = Vec::with_capacity(8 * pieces);
        for piece in 0..pieces {
            let middle = lowest + half * (2 * piece + 1) as f64;
            for [zero, weight] in Self::GAUSS_LEGENDRE {
                for abscissa in [-zero, zero] {
                    let v = libm::exp(middle + half * abscissa);
                    rule.push([v, 0.5 * half * weight * libm::exp(-screened / v)]);
                }
            }
        }
        rule.retain(|[_, weight]| *weight > 0.0);
        Self { rule }
    }

    /// The value at `a` and minus the slope.
    fn at(&self, a: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for &[v, weight] in &self.rule {
            let term = weight * libm::exp(-a * v);
            sums[0] += term;
            sums[1] += v * term;
        }
        sums
    }

    /// The value at `a` minus that at `held`, exact even where both are infinite, and minus the slope.
    fn rise(&self, held: f64, a: f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for &[v, weight] in &self.rule {
            let term = weight * libm::exp(-held * v);
            let growth = libm::expm1((held - a) * v);
            sums[0] += term * growth;
            sums[1] += v * term * (1.0 + growth);
        }
        sums
    }
}
