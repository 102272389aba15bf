//! Fits of one parameter by least squares.
//!
//! ```
//! use meniscus_tests::fits::minimum;
//!
//! let lowest = minimum(|x| (x - 1.25) * (x - 1.25), 0.0, 3.0);
//! assert!((lowest - 1.25).abs() < 1e-7);
//! ```

use meniscus::theory::collapse_fit;

/// (√5 − 1)/2
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Where between `least` and `most` a function with a single minimum there is lowest, by golden section (Kiefer 1953).
///
/// Of a smooth function it is found to 1e-8 of the interval: closer than that its values do not differ.
pub fn minimum(function: impl Fn(f64) -> f64, mut least: f64, mut most: f64) -> f64 {
    let width = 1e-9 * (most - least);
    let mut left = most - GOLDEN * (most - least);
    let mut right = least + GOLDEN * (most - least);
    let (mut at_left, mut at_right) = (function(left), function(right));
    while most - least > width {
        if at_left < at_right {
            (most, right, at_right) = (right, left, at_left);
            left = most - GOLDEN * (most - least);
            at_left = function(left);
        } else {
            (least, left, at_left) = (left, right, at_right);
            right = least + GOLDEN * (most - least);
            at_right = function(right);
        }
    }
    0.5 * (least + most)
}

/// A0 of Eq. 30, R = R_f + (R_i − R_f)√(1 − t/(A0·T)), that fits `samples` (t/T, R) best, with R_i and R_f held.
pub fn delay_of_collapse(samples: &[(f64, f64)], initial_radius: f64, final_radius: f64) -> f64 {
    let deviation = |delay: f64| {
        let squared = |&(time, radius): &(f64, f64)| {
            let difference = radius - collapse_fit(initial_radius, final_radius, delay, time);
            difference * difference
        };
        samples.iter().map(squared).sum()
    };
    minimum(deviation, 0.95, 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_of_a_skewed_well_is_found() {
        // x − ln x
        assert!((minimum(|x| x - libm::log(x), 0.1, 7.0) - 1.0).abs() < 1e-6);
        assert!((minimum(|x| (x - 0.3).abs(), 0.0, 1.0) - 0.3).abs() < 1e-8);
    }

    #[test]
    fn a_minimum_at_the_border_is_found() {
        assert!(minimum(|x| x, 2.0, 3.0) - 2.0 < 1e-8);
    }

    #[test]
    fn the_delay_of_a_made_up_collapse_is_found() {
        let samples: Vec<(f64, f64)> =
            (0..90).map(|k| 0.01 * f64::from(k)).map(|t| (t, collapse_fit(135.0, 18.0, 1.15, t))).collect();
        assert!((delay_of_collapse(&samples, 135.0, 18.0) - 1.15).abs() < 1e-6);
    }
}
