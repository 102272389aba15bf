//! How concentric shells attract each other, as the rate d(R²)/dt of each.
//!
//! R² is smooth where a shell meets the centre, R is not: for λ → ∞ it falls at a constant rate. With x = R/λ and
//! F the outward force, d(R²)/dt = 2RF: a shell of m discs within adds −2V0·m·I₀(x')·xK₁(x), one further out
//! +2V0·m·K₀(x')·xI₁(x), a shell itself −V0·m·x(I₀K₁ − I₁K₀)(x), images +2V0·Σ m I₀(x')·S·xI₁(x), and a disc
//! that does not act upon itself +V0. For λ → ∞ that is I₀ = xK₁ = 1, xI₁ = 0, S·xI₁ = πR²/L².

use super::AttractionError;
use crate::bessel::{scaled_i0_i1, scaled_k0_k1};
use core::f64::consts::{PI, TAU};

/// V0, λ and the surroundings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attraction {
    /// V0, kBT
    pub strength: f64,
    /// λ, R0
    pub length: f64,
    /// What the images add, if there are any.
    pub images: Option<Images>,
    /// 1 if a disc acts upon itself, as a part of its shell, else 0.
    pub acts_on_itself: f64,
}

/// What the images of a box add to a force.
#[derive(Clone, Copy, Debug)]
pub(super) enum Images {
    /// Σ K₀(D/λ) over all lattice vectors D but 0.
    Screened(f64),
    /// π/L², R0⁻², for λ → ∞.
    Background(f64),
}

/// The Bessel functions of one shell at x = R/λ, free of their exponentials.
#[derive(Clone, Copy, Debug)]
struct OfRadius {
    x: f64,
    /// e⁻ˣI₀
    i0: f64,
    /// e⁻ˣxI₁
    x_i1: f64,
    /// eˣK₀
    k0: f64,
    /// eˣxK₁
    x_k1: f64,
}

impl OfRadius {
    fn new(x: f64) -> Self {
        if x <= 0.0 {
            // K₀ diverges, but acts within the shell only, where there is no room.
            return Self { x: 0.0, i0: 1.0, x_i1: 0.0, k0: 0.0, x_k1: 1.0 };
        }
        let ((i0, i1), (k0, k1)) = (scaled_i0_i1(x), scaled_k0_k1(x));
        Self { x, i0, x_i1: x * i1, k0, x_k1: x * k1 }
    }
}

impl Attraction {
    /// V0 = `strength` (kBT) and λ = `length` (R0), which may be infinite, in the open plane, of discs that act upon
    /// themselves.
    pub(super) fn new(strength: f64, length: f64) -> Result<Self, AttractionError> {
        AttractionError::check(strength, length)?;
        Ok(Self { strength, length, images: None, acts_on_itself: 1.0 })
    }

    /// The same in a box of `side` (R0) that shells up to the radius `largest` (R0) are in.
    pub(super) fn periodic(self, side: f64, largest: f64) -> Result<Self, AttractionError> {
        AttractionError::check_side(side, 2.0 * largest)?;
        Ok(Self { images: Some(lattice_sum(self.length, side)), ..self })
    }

    /// d(R²)/dt of shells with the squared radii `squares` (R0², below 0 is 0) and numbers of discs `discs`, given
    /// from the inside outwards. The order counts, not the radii: it is smooth where two meet.
    pub(super) fn rates(&self, squares: &[f64], discs: &[f64], rates: &mut Vec<f64>) {
        let shells: Vec<OfRadius> =
            squares.iter().map(|square| OfRadius::new(square.max(0.0).sqrt() / self.length)).collect();
        let images = self.images_of(&shells, discs);
        rates.clear();
        // Σ m e^(x' − x)·e^(−x')I₀(x') of the shells within.
        let (mut within, mut before) = (0.0, 0.0);
        for ((shell, number), square) in shells.iter().zip(discs).zip(squares) {
            within *= libm::exp(before - shell.x);
            let itself = 0.5 * number * (shell.i0 * shell.x_k1 - shell.x_i1 * shell.k0);
            let image = match images {
                ImageSum::PerSquare(rate) => rate * square.max(0.0),
                ImageSum::PerCurrent(rate) => rate * shell.x_i1 * libm::exp(shell.x),
            };
            rates.push(0.5 * (1.0 - self.acts_on_itself) + image - itself - within * shell.x_k1);
            within += number * shell.i0;
            before = shell.x;
        }
        // Σ m e^(x − x')·e^(x')K₀(x') of those further out.
        let mut beyond = 0.0;
        for ((shell, number), rate) in shells.iter().zip(discs).zip(rates.iter_mut()).rev() {
            beyond *= libm::exp(shell.x - before);
            *rate = 2.0 * self.strength * (*rate + beyond * shell.x_i1);
            beyond += number * shell.k0;
            before = shell.x;
        }
    }

    /// What all images together do.
    fn images_of(&self, shells: &[OfRadius], discs: &[f64]) -> ImageSum {
        match self.images {
            None => ImageSum::PerSquare(0.0),
            Some(Images::Background(per_area)) => ImageSum::PerSquare(discs.iter().sum::<f64>() * per_area),
            Some(Images::Screened(lattice)) => {
                let charge = |(shell, number): (&OfRadius, &f64)| number * shell.i0 * libm::exp(shell.x);
                ImageSum::PerCurrent(lattice * shells.iter().zip(discs).map(charge).sum::<f64>())
            }
        }
    }
}

/// What images add to RF/V0.
#[derive(Clone, Copy, Debug)]
enum ImageSum {
    /// This times R², R0⁻².
    PerSquare(f64),
    /// This times xI₁(x).
    PerCurrent(f64),
}

/// What the images in a box of `side` (R0) add at λ = `length` (R0).
///
/// K₀(κD) = ½∫₀^∞ (dt/t) exp(−κ²t − D²/4t), so S = ½∫ (dt/t) exp(−κ²t) [θ(t)² − 1] with θ(t) = Σ_n exp(−n²L²/4t). In ln t the
/// integrand decays doubly exponentially on either side, and the trapezoidal rule is as exact as the numbers are.
fn lattice_sum(length: f64, side: f64) -> Images {
    /// In ln t.
    const STEP: f64 = 0.05;
    /// exp(−this) is nothing.
    const NEGLIGIBLE_EXPONENT: f64 = 45.0;
    if length.is_infinite() {
        return Images::Background(PI / (side * side));
    }
    // Times in L²/4: from exp(−1/t) to exp(−(L/2λ)²t) negligible.
    let screening = 0.25 * (side / length) * (side / length);
    let first = -libm::log(NEGLIGIBLE_EXPONENT);
    let last = libm::log(NEGLIGIBLE_EXPONENT / screening);
    let points = libm::ceil((last - first) / STEP).max(0.0) as usize;
    let term = |point: usize| {
        let time = libm::exp(first + STEP * point as f64);
        libm::exp(-screening * time) * squared_theta_less_one(time)
    };
    Images::Screened(0.5 * STEP * (0..=points).map(term).sum::<f64>())
}

/// θ² − 1 with θ = Σ_n exp(−n²/t), by Jacobi's identity √(πt) Σ_n exp(−π²n²t) for large t.
fn squared_theta_less_one(time: f64) -> f64 {
    // Six terms leave out exp(−49/t) on one side of t = 1/π and exp(−49π²t) on the other.
    let twice_sum =
        |exponent: f64| 2.0 * (1..=6).rev().map(|n| libm::exp(-exponent * f64::from(n * n))).sum::<f64>();
    if PI * time < 1.0 {
        let beyond_one = twice_sum(1.0 / time);
        return beyond_one * (2.0 + beyond_one);
    }
    let theta = (PI * time).sqrt() * (1.0 + twice_sum(0.25 * TAU * TAU * time));
    theta * theta - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Screened shells in a box, pair by pair.
    #[test]
    fn rates_are_sums_over_pairs() {
        let attraction = Attraction::new(0.89, 40.0).unwrap().periodic(200.0, 90.0).unwrap();
        let (radii, discs) = ([5.0, 30.0, 30.1, 60.0, 90.0], [1.0, 12.0, 4.0, 40.0, 30.0]);
        let mut rates = Vec::new();
        attraction.rates(&radii.map(|radius| radius * radius), &discs, &mut rates);
        let Some(Images::Screened(lattice)) = attraction.images else { panic!("the length is finite") };
        let of = |radius: f64| {
            let x = radius / 40.0;
            let ((i0, i1), (k0, k1)) = (scaled_i0_i1(x), scaled_k0_k1(x));
            let (grows, falls) = (libm::exp(x), libm::exp(-x));
            [i0 * grows, x * i1 * grows, k0 * falls, x * k1 * falls]
        };
        for (own, &radius) in radii.iter().enumerate() {
            let [i0, x_i1, k0, x_k1] = of(radius);
            let mut sum = -0.5 * discs[own] * (i0 * x_k1 - x_i1 * k0);
            for (other, &number) in discs.iter().enumerate() {
                let [other_i0, _, other_k0, _] = of(radii[other]);
                sum += number * other_i0 * lattice * x_i1;
                match other.cmp(&own) {
                    core::cmp::Ordering::Less => sum -= number * other_i0 * x_k1,
                    core::cmp::Ordering::Equal => (),
                    core::cmp::Ordering::Greater => sum += number * other_k0 * x_i1,
                }
            }
            let expected = 2.0 * 0.89 * sum;
            assert!(
                (rates[own] - expected).abs() < 1e-12 * expected.abs(),
                "{own}: {}, not {expected}",
                rates[own]
            );
        }
    }

    #[test]
    fn the_lattice_sum_is_that_over_the_lattice() {
        for (length, side) in [(10.0, 100.0), (270.0, 500.0), (270.0, 100.0)] {
            let shells = 1 + (45.0 * length / side) as i32;
            let mut expected = 0.0;
            for l in -shells..=shells {
                for m in (-shells..=shells).filter(|&m| (l, m) != (0, 0)) {
                    let x = side / length * libm::sqrt(f64::from(l * l + m * m));
                    expected += libm::exp(-x) * scaled_k0_k1(x).0;
                }
            }
            let Images::Screened(sum) = lattice_sum(length, side) else { panic!("the length is finite") };
            assert!((sum / expected - 1.0).abs() < 1e-12, "{length}, {side}: {sum}, not {expected}");
        }
    }

    /// S·xI₁(x) → πR²/L².
    #[test]
    fn a_long_range_has_the_background_of_an_infinite_one() {
        let Images::Screened(sum) = lattice_sum(1e5, 500.0) else { panic!("the length is finite") };
        let x = 1e-3;
        assert!((0.5 * sum * x * x / (PI * (100.0 / 500.0) * (100.0 / 500.0)) - 1.0).abs() < 1e-4, "{sum}");
    }
}
