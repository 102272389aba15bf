//! How fast modes grow, thermal motion taken into account.
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
//!
//! In: powers, pure numbers. Out: the measured rate over that of theory.
//!
//! ```
//! use meniscus::observables::modes::growth::{Growth, growth_ratio};
//!
//! // Modes that have grown by e² without noise, as theory has it.
//! let mode = |initial_power: f64| Growth {
//!     initial_power,
//!     later_power: initial_power * libm::exp(2.0),
//!     thermal_power: 0.0,
//!     exponent: 1.0,
//! };
//! let ratio = growth_ratio(&[mode(1.0), mode(3.0)]).unwrap();
//! assert!((ratio.value - 1.0).abs() < 1e-6);
//! ```

use crate::statistics::{Estimate, jackknife};

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

/// The measured growth rate over that of theory, 0.01 to 4, from the powers of all modes together.
///
/// The error is the jackknife's, which leaves out one mode at a time: in linear theory the modes of a run are as
/// independent of each other as runs are, and so it has one degree of freedom less than there are modes. None with fewer than two modes, of which there is no scatter.
#[must_use]
pub fn growth_ratio(modes: &[Growth]) -> Option<Estimate> {
    if modes.len() < 2 {
        return None;
    }
    jackknife(modes.len(), |left_out| {
        let kept = modes.iter().enumerate().filter(|&(index, _)| Some(index) != left_out);
        Some(ratio(&kept.map(|(_, &mode)| mode).collect::<Vec<_>>()))
    })
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
