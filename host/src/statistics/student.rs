//! Student's t: how many standard errors of few values are as sure as some of many.

use core::f64::consts::FRAC_1_SQRT_2;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// From here on the quantile is that of the normal distribution within 3e-4 of it, up to three standard errors; the
/// library's loses its digits as its incomplete beta function comes close to 1.
const MANY: f64 = 1e4;

/// The confidence of `standard_errors` to both sides of a normally distributed value, 0 to 1: erf(k/√2), 0.9545 of two.
#[must_use]
pub fn confidence(standard_errors: f64) -> f64 {
    libm::erf(standard_errors * FRAC_1_SQRT_2)
}

/// How many standard errors it takes, if they were estimated with so many `degrees` of freedom, for the confidence that
/// `standard_errors` (at least 0) have of a normal distribution: the quantile of Student's t.
///
/// The same with ten thousand degrees or more; infinite without any, of which nothing is known.
#[must_use]
pub fn student_errors(standard_errors: f64, degrees: f64) -> f64 {
    if standard_errors.is_nan() || degrees >= MANY {
        return standard_errors;
    }
    // The tail rather than the whole: nothing cancels.
    let tail = 0.5 * libm::erfc(standard_errors * FRAC_1_SQRT_2);
    StudentsT::new(0.0, 1.0, degrees).map_or(f64::INFINITY, |distribution| -distribution.inverse_cdf(tail))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: f64, expected: f64, what: &str) {
        assert!((found / expected - 1.0).abs() < 1e-9, "{what}: {found}, not {expected}");
    }

    /// So many standard errors of a normal distribution have the confidence 0.95, 0.99, 0.999.
    const TABLED: [f64; 3] = [1.959_963_984_540_054, 2.575_829_303_548_901, 3.290_526_731_491_926];

    /// Of printed tables of the t distribution.
    #[test]
    fn tables_are_met() {
        for (degrees, expected) in [
            (1.0, [12.706, 63.657, 636.619]),
            (2.0, [4.303, 9.925, 31.599]),
            (3.0, [3.182, 5.841, 12.924]),
            (9.0, [2.262, 3.250, 4.781]),
            (19.0, [2.093, 2.861, 3.883]),
            (120.0, [1.980, 2.617, 3.373]),
        ] {
            for (errors, expected) in TABLED.into_iter().zip(expected) {
                let found = student_errors(errors, degrees);
                assert!((found - expected).abs() <= 6e-4, "{degrees}: {found}, not {expected}");
            }
        }
    }

    /// t = cot πp of one degree, (1 − 2p)/√(2p(1 − p)) of two, and 2√(cos(⅓ arccos √a)/√a − 1) with a = 4p(1 − p) of
    /// four, p being the tail.
    #[test]
    fn closed_forms_are_met() {
        for errors in [0.5, 1.0, 2.0, 3.0, 4.0] {
            let tail = 0.5 * libm::erfc(errors * FRAC_1_SQRT_2);
            let one = 1.0 / libm::tan(core::f64::consts::PI * tail);
            assert_close(student_errors(errors, 1.0), one, "one degree");
            let two = (1.0 - 2.0 * tail) / (2.0 * tail * (1.0 - tail)).sqrt();
            assert_close(student_errors(errors, 2.0), two, "two degrees");
            let root = (4.0 * tail * (1.0 - tail)).sqrt();
            let four = 2.0 * (libm::cos(libm::acos(root) / 3.0) / root - 1.0).sqrt();
            assert_close(student_errors(errors, 4.0), four, "four degrees");
        }
    }

    #[test]
    fn two_errors_of_two_or_three_values_are_many_more() {
        assert!((student_errors(2.0, 1.0) - 13.968).abs() < 1e-3);
        assert!((student_errors(2.0, 2.0) - 4.527).abs() < 1e-3);
        assert!((student_errors(3.0, 2.0) - 19.206).abs() < 1e-3);
        assert!((confidence(2.0) - 0.954_499_7).abs() < 1e-7 && (confidence(3.0) - 0.997_300_2).abs() < 1e-7);
    }

    /// k + (k³ + k)/4ν + (5k⁵ + 16k³ + 3k)/96ν², of Abramowitz and Stegun, 26.7.5.
    #[test]
    fn many_degrees_come_down_to_the_normal_distribution() {
        for errors in [1.0, 2.0, 3.0] {
            let third = errors * errors * errors;
            let fifth = third * errors * errors;
            for degrees in [200.0, 1000.0, 9999.0] {
                let expected = errors
                    + (third + errors) / (4.0 * degrees)
                    + (5.0 * fifth + 16.0 * third + 3.0 * errors) / (96.0 * degrees * degrees);
                let found = student_errors(errors, degrees);
                assert!((found - expected).abs() < 1e-5, "{errors}, {degrees}: {found}, not {expected}");
            }
            assert!((student_errors(errors, 9999.0) / errors - 1.0).abs() < 2.6e-4);
            assert_eq!([1e4, f64::INFINITY].map(|degrees| student_errors(errors, degrees)), [errors; 2]);
        }
    }

    #[test]
    fn nothing_is_known_without_degrees() {
        for degrees in [0.0, -1.0, f64::NAN] {
            assert_eq!(student_errors(2.0, degrees), f64::INFINITY);
        }
        assert_eq!(student_errors(0.0, 3.0).abs(), 0.0);
        assert!(student_errors(f64::NAN, 3.0).is_nan());
    }
}
