//! Rows as text.

use meniscus_core::units::time_from_units;
use std::fmt::Display;
use std::fmt::Write as _;

/// When a state was: what its rows begin with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Steps made.
    pub step: u64,
    /// Time, R0²/D; None if it is not known.
    pub time: Option<f64>,
    /// Time in Jeans' times; None where there is none.
    pub time_over_jeans: Option<f64>,
}

impl Moment {
    /// At step `step` and time `time` (unit 2⁻⁴⁰ R0²/D), Jeans' time being `jeans_time` (R0²/D).
    #[must_use]
    pub fn new(step: u64, time: u64, jeans_time: Option<f64>) -> Self {
        let time = time_from_units(time);
        Self { step, time: Some(time), time_over_jeans: jeans_time.map(|jeans| time / jeans) }
    }
}

/// The rows of one state.
pub(super) struct Rows {
    head: String,
    text: String,
}

impl Rows {
    pub(super) fn of(moment: &Moment) -> Self {
        let Moment { step, time, time_over_jeans } = *moment;
        Self { head: format!("{step},{},{}", cell(time), cell(time_over_jeans)), text: String::new() }
    }

    /// Adds a row of these cells.
    pub(super) fn add(&mut self, cells: &[&dyn Display]) {
        self.text.push_str(&self.head);
        for cell in cells {
            // Writing to a String cannot fail.
            let _ = write!(self.text, ",{cell}");
        }
        self.text.push('\n');
    }

    pub(super) fn into_text(self) -> String {
        self.text
    }
}

/// A number with the fewest digits that read back to it; empty where there is none.
pub(super) fn cell(value: impl Into<Option<f64>>) -> String {
    let value: Option<f64> = value.into();
    value.filter(|value| value.is_finite()).map_or(String::new(), |value| value.to_string())
}
