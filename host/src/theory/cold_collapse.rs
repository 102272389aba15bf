//! Cold collapse of a patch of discs, in closed form.
//!
//! In: radii in R0 and times over Jeans' time. Out: radii in R0.
//!
//! ```
//! use meniscus::theory::{cold_collapse_radius, collapse_fit};
//!
//! assert_eq!(cold_collapse_radius(135.0, 0.75), 67.5);
//! // Ring 7 of Fig. 12, with the paper's A0 and R_f.
//! assert!(collapse_fit(135.0, 18.0, 1.15, 0.75) > 67.5);
//! ```

/// Radius of a ring in cold collapse of a top-hat patch for λ → ∞, R(t) = R(0)√(1 − t/T), R0 (Eq. 13).
///
/// `initial_radius` is R(0) in R0, `time_over_jeans` is t/T. 0 once collapsed.
#[must_use]
pub fn cold_collapse_radius(initial_radius: f64, time_over_jeans: f64) -> f64 {
    collapse_fit(initial_radius, 0.0, 1.0, time_over_jeans)
}

/// The fit of a collapsing ring, R(t) = R_f + (R_i − R_f)√(1 − t/(A0·T)), R0 (Eq. 30).
///
/// `initial_radius` R_i and `final_radius` R_f in R0, `delay` A0 and `time_over_jeans` t/T are pure
/// numbers. R_f once collapsed, for t ≥ A0·T.
#[must_use]
pub fn collapse_fit(initial_radius: f64, final_radius: f64, delay: f64, time_over_jeans: f64) -> f64 {
    let left = (1.0 - time_over_jeans / delay).max(0.0);
    final_radius + (initial_radius - final_radius) * left.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
    }

    #[test]
    fn cold_collapse_ends_at_jeans_time() {
        assert_eq!(cold_collapse_radius(135.0, 0.0), 135.0);
        assert_near(cold_collapse_radius(135.0, 0.75), 67.5, 1e-12);
        assert_eq!(cold_collapse_radius(135.0, 1.0), 0.0);
        assert_eq!(cold_collapse_radius(135.0, 2.0), 0.0);
    }

    #[test]
    fn the_fit_starts_at_the_initial_and_ends_at_the_final_radius() {
        assert_eq!(collapse_fit(135.0, 18.0, 1.15, 0.0), 135.0);
        assert_eq!(collapse_fit(135.0, 18.0, 1.15, 1.15), 18.0);
        assert_eq!(collapse_fit(135.0, 18.0, 1.15, 3.0), 18.0);
        assert_near(collapse_fit(135.0, 18.0, 1.16, 0.87), 18.0 + 117.0 / 2.0, 1e-12);
    }
}
