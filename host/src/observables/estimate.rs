//! A measured number and how well it is known.
//!
//! ```
//! use meniscus::observables::estimate::Estimate;
//!
//! let delay = Estimate { value: 1.152, error: 0.004 };
//! assert!(delay.agrees_with(1.16, 3.0));
//! assert_eq!(delay.to_string(), "1.1520 +- 0.0040");
//! ```

use std::fmt;

/// A value and its standard error, in the unit of the value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error; 0 for what was given and not measured.
    pub error: f64,
}

impl Estimate {
    /// What is given and has no error.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// Whether `expected` is at most so many standard errors away.
    #[must_use]
    pub fn agrees_with(&self, expected: f64, standard_errors: f64) -> bool {
        (self.value - expected).abs() <= standard_errors * self.error
    }

    /// How many digits after the point leave two of the error; None unless it is finite and above 0.
    #[must_use]
    pub fn digits(&self) -> Option<usize> {
        let measured = self.error > 0.0 && self.error.is_finite();
        measured.then(|| (1.0 - libm::floor(libm::log10(self.error))).clamp(0.0, 17.0) as usize)
    }
}

/// Both with the digits that leave two of the error.
impl fmt::Display for Estimate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, error } = self;
        match self.digits() {
            Some(digits) => write!(formatter, "{value:.digits$} +- {error:.digits$}"),
            None => write!(formatter, "{value}"),
        }
    }
}
