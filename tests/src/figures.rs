//! Measured figures: shown, and held against what is accepted.

use crate::tolerances::Within;

/// Shows a measured `value` beside what is accepted, and fails unless it is.
///
/// # Panics
/// If the value is not accepted, or not a number.
#[track_caller]
#[expect(clippy::print_stdout, reason = "--nocapture shows the figures of a test that passes")]
pub fn assert_within(value: f64, Within(least, most): Within, what: &str) {
    println!("{what}: {value:.4e}, accepted {least:.4e} to {most:.4e}");
    assert!((least..=most).contains(&value), "{what}: {value} is not within {least} to {most}");
}
