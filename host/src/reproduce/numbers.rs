//! Numbers as reports have them: with the digits that count.
//!
//! ```
//! use meniscus::reproduce::numbers::{plain, with_error};
//! use meniscus::statistics::Estimate;
//!
//! assert_eq!(with_error(Estimate::new(1.1498, 0.0123)), "1.150 ± 0.012");
//! assert_eq!(plain(500.0), "500");
//! ```

use crate::statistics::Estimate;

/// A number and its standard error, both with the digits that leave two of the error, and in brackets the degrees of
/// freedom ν of that, if there are not infinitely many.
#[must_use]
pub fn with_error(estimate: Estimate) -> String {
    let Estimate { value, error, degrees } = estimate;
    let number = match estimate.digits() {
        Some(digits) => format!("{value:.digits$} ± {error:.digits$}"),
        None => plain(value),
    };
    match degrees {
        0.0 => format!("{number} (one run)"),
        f64::INFINITY => number,
        _ => format!("{number} (ν = {degrees})"),
    }
}

/// A number with four significant digits and no more zeros than it needs.
#[must_use]
pub fn plain(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = libm::floor(libm::log10(value.abs()));
    if !(-4.0..6.0).contains(&exponent) {
        return format!("{value:.2e}");
    }
    let digits = (3.0 - exponent).max(0.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_their_errors_leave() {
        assert_eq!(with_error(Estimate::new(1.1498, 0.0123)), "1.150 ± 0.012");
        assert_eq!(with_error(Estimate::new(2500.0, 13.0)), "2500 ± 13");
        assert_eq!(with_error(Estimate::exact(0.25)), "0.25");
        assert_eq!(with_error(Estimate::single(0.25)), "0.25 (one run)");
        assert_eq!(with_error(Estimate::new(0.25, 0.01).of_degrees(0.0)), "0.250 ± 0.010 (one run)");
        assert_eq!(with_error(Estimate::new(0.25, 0.01).of_degrees(9.0)), "0.250 ± 0.010 (ν = 9)");
        assert_eq!(plain(1.234_56e-7), "1.23e-7");
        assert_eq!(plain(500.0), "500");
        assert_eq!(plain(-0.123_456), "-0.1235");
    }
}
