//! Density modes ρ̂_k = Σ exp(−ik·r) of the box, and how fast they grow.
//!
//! Linear theory adds to the growth of a mode what the thermal motion of N independent discs adds,
//!
//! ⟨|ρ̂_k(t)|²⟩ = |ρ̂_k(0)|² exp(2t/τ) + N k² τ [exp(2t/τ) − 1]  (D = 1),
//!
//! and the rate 1/τ of which this is true of measured powers is the measured rate. Neither of two simpler estimates
//! would do. The mean of ln |ρ̂_k(t)/ρ̂_k(0)| counts what noise adds as growth, most where |ρ̂_k(0)| happens to be
//! small. The correlation of ρ̂_k(t) with ρ̂_k(0) has no noise in it, but loses exp(−k²σ²/2) to the displacements σ
//! that longer waves have made meanwhile, 2 % of the rate at k = 0.2 K after 0.5 T; powers do not see where a wave
//! has been carried to.

use core::f64::consts::TAU;

use meniscus_core::torus::Position;

/// A wave vector, l and m of k = 2π(l, m)/L.
pub type Wave = (i32, i32);

/// One of each pair ±k of wave vectors with 0 < |k| < `limit`, a multiple of 2π/L.
pub fn waves(limit: f64) -> Vec<Wave> {
    let most = limit as i32 + 1;
    let half_plane = |&(l, m): &Wave| l > 0 || (l == 0 && m > 0);
    let all = (0..=most).flat_map(|l| (-most..=most).map(move |m| (l, m)));
    all.filter(half_plane).filter(|&wave| order(wave) < limit).collect()
}

/// |k| in units of 2π/L.
pub fn order((l, m): Wave) -> f64 {
    f64::from(l * l + m * m).sqrt()
}

/// |ρ̂_k|² of `discs`.
pub fn power(discs: &[Position], (l, m): Wave) -> f64 {
    let (mut real, mut imaginary) = (0.0, 0.0);
    for disc in discs {
        // A phase wraps as positions do, and so it is exact.
        let along_x = disc.x.to_bits().wrapping_mul(l as u32);
        let along_y = disc.y.to_bits().wrapping_mul(m as u32);
        let turns = f64::from(along_x.wrapping_add(along_y)) / 4_294_967_296.0;
        let (sine, cosine) = libm::sincos(TAU * turns);
        real += cosine;
        imaginary -= sine;
    }
    real * real + imaginary * imaginary
}

/// One mode of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// |ρ̂_k(0)|²
    pub initial_power: f64,
    /// |ρ̂_k(t)|²
    pub later_power: f64,
    /// 2 N k² t, what thermal motion adds without growth.
    pub thermal_power: f64,
    /// t/τ as theory has it, not zero.
    pub exponent: f64,
}

impl Growth {
    /// The mean of |ρ̂_k(t)|² if the rate is `ratio` times that of theory.
    fn expected_power(&self, ratio: f64) -> f64 {
        let twice = 2.0 * ratio * self.exponent;
        let gain = libm::expm1(twice);
        self.initial_power * (1.0 + gain) + self.thermal_power * gain / twice
    }
}

/// The measured growth rate over that of theory, from the powers of all modes together, and its standard error.
///
/// The error is the jackknife's, which leaves out one mode at a time: in linear theory the modes of a run are as
/// independent of each other as runs are.
///
/// # Panics
/// If there are fewer than two modes.
pub fn growth_ratio(modes: &[Growth]) -> (f64, f64) {
    assert!(modes.len() > 1, "one mode has no scatter");
    let without = |left_out: usize| {
        let kept = modes.iter().enumerate().filter(|&(index, _)| index != left_out);
        ratio(&kept.map(|(_, &mode)| mode).collect::<Vec<_>>())
    };
    let ratios: Vec<f64> = (0..modes.len()).map(without).collect();
    let count = modes.len() as f64;
    let mean = ratios.iter().sum::<f64>() / count;
    let scatter: f64 = ratios.iter().map(|ratio| (ratio - mean) * (ratio - mean)).sum();
    (ratio(modes), (scatter * (count - 1.0) / count).sqrt())
}

/// The ratio at which the expected powers sum up to the measured ones, by bisection between 0.01 and 4.
fn ratio(modes: &[Growth]) -> f64 {
    let measured: f64 = modes.iter().map(|mode| mode.later_power).sum();
    let (mut least, mut most) = (0.01, 4.0);
    while most - least > 1e-7 {
        let middle = 0.5 * (least + most);
        let expected: f64 = modes.iter().map(|mode| mode.expected_power(middle)).sum();
        if expected < measured { least = middle } else { most = middle }
    }
    0.5 * (least + most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::RandomNumbers;
    use crate::states::{lattice, scattered};

    #[test]
    fn half_of_the_plane_has_each_wave_once() {
        assert_eq!(waves(1.1), [(0, 1), (1, 0)]);
        // 37 points of the square lattice within a circle of radius 3.4, but for the middle.
        assert_eq!(waves(3.4).len(), 18);
    }

    #[test]
    fn a_lattice_scatters_at_its_own_waves_only() {
        let discs = lattice(8);
        assert!((power(&discs, (8, 0)) - 4096.0).abs() < 1e-6);
        assert!((power(&discs, (-8, 16)) - 4096.0).abs() < 1e-6);
        assert!(power(&discs, (3, 2)) < 1e-6);
    }

    #[test]
    fn scattered_discs_have_the_power_of_shot_noise() {
        let discs = scattered(1, 1000);
        let waves = waves(12.0);
        let mean = waves.iter().map(|&wave| power(&discs, wave)).sum::<f64>() / waves.len() as f64;
        // Powers are exponentially distributed: each scatters by its mean.
        assert!((mean / 1000.0 - 1.0).abs() < 4.0 / (waves.len() as f64).sqrt());
    }

    #[test]
    fn the_growth_of_made_up_modes_is_found_within_its_error() {
        let mut random = RandomNumbers::new(1);
        // Box and Muller.
        let mut normal_pair = move |variance: f64| {
            let radius = (-variance * libm::log(1.0 - random.uniform())).sqrt();
            let (sine, cosine) = libm::sincos(TAU * random.uniform());
            [radius * cosine, radius * sine]
        };
        let (faster, thermal_power) = (1.1, 0.05);
        let modes: Vec<Growth> = (0..400)
            .map(|index| {
                let exponent = 0.5 + 0.001 * f64::from(index);
                let twice = 2.0 * faster * exponent;
                let initial = normal_pair(1.0);
                let noise = normal_pair(thermal_power * libm::expm1(twice) / twice);
                let later = [0, 1].map(|part| initial[part] * libm::exp(0.5 * twice) + noise[part]);
                let square = |[real, imaginary]: [f64; 2]| real * real + imaginary * imaginary;
                Growth { initial_power: square(initial), later_power: square(later), thermal_power, exponent }
            })
            .collect();
        let (ratio, error) = growth_ratio(&modes);
        assert!((ratio - faster).abs() < 3.0 * error, "{ratio} ± {error}");
        assert!(error > 0.002 && error < 0.02, "{error}");
    }
}
