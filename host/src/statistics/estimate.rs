//! A measured number and how well it is known.

use super::student_errors;
use core::fmt;

/// A value and its standard error, in the unit of the value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error; 0 for what was given and not measured, not a number where it is not known.
    pub error: f64,
    /// Of how many degrees of freedom the error is: infinitely many where it is not itself an estimate from a few values,
    /// none for a single one.
    pub degrees: f64,
}

impl Estimate {
    /// A value whose error is known, as that of a fit to many samples.
    #[must_use]
    pub const fn new(value: f64, error: f64) -> Self {
        Self { value, error, degrees: f64::INFINITY }
    }

    /// What is given and has no error.
    #[must_use]
    pub const fn exact(value: f64) -> Self {
        Self::new(value, 0.0)
    }

    /// What was measured once: of its error nothing is known.
    #[must_use]
    pub const fn single(value: f64) -> Self {
        Self { value, error: f64::NAN, degrees: 0.0 }
    }

    /// The same, its error being of at most so many degrees of freedom.
    #[must_use]
    pub const fn of_degrees(self, most: f64) -> Self {
        Self { degrees: self.degrees.min(most), ..self }
    }

    /// How much larger it is than `other`, which is independent of it. The error has the fewer degrees of freedom of the
    /// two: that never makes it surer than it is.
    #[must_use]
    pub fn less(self, other: Self) -> Self {
        let error = libm::hypot(self.error, other.error);
        Self { value: self.value - other.value, error, degrees: self.degrees.min(other.degrees) }
    }

    /// How far off the value may be with the confidence that so many standard errors have of a normal distribution: more
    /// errors than that by Student's t if they have few degrees of freedom.
    #[must_use]
    pub fn margin(&self, standard_errors: f64) -> f64 {
        if self.error != 0.0 {
            student_errors(standard_errors, self.degrees) * self.error
        } else if (1.0..2.0).contains(&self.degrees) {
            // Two that agree by chance, as whole numbers do.
            f64::INFINITY
        } else {
            0.0
        }
    }

    /// Whether `expected` is within the [margin](Estimate::margin) of so many standard errors.
    #[must_use]
    pub fn agrees_with(&self, expected: f64, standard_errors: f64) -> bool {
        (self.value - expected).abs() <= self.margin(standard_errors)
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
        let Self { value, error, .. } = self;
        match self.digits() {
            Some(digits) => write!(formatter, "{value:.digits$} +- {error:.digits$}"),
            None => write!(formatter, "{value}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_have_the_digits_of_the_error() {
        assert_eq!(Estimate::new(1.152, 0.004).to_string(), "1.1520 +- 0.0040");
        assert_eq!(Estimate::exact(1.152).to_string(), "1.152");
    }

    #[test]
    fn few_degrees_of_freedom_take_more_errors() {
        let many = Estimate::new(1.0, 0.1);
        let few = many.of_degrees(2.0);
        assert_eq!(many.margin(2.0), 0.2);
        assert!((few.margin(2.0) - 0.4527).abs() < 1e-4);
        assert!(!many.agrees_with(1.4, 2.0) && few.agrees_with(1.4, 2.0));
        assert_eq!(few.of_degrees(9.0), few);
        assert_eq!(Estimate::exact(1.0).margin(2.0), 0.0);
        assert_eq!(Estimate::exact(1.0).of_degrees(2.0).margin(2.0), 0.0);
        assert_eq!(Estimate::exact(1.0).of_degrees(1.0).margin(2.0), f64::INFINITY);
        assert!(Estimate::single(1.0).margin(2.0).is_nan());
    }

    #[test]
    fn a_difference_has_the_fewer_degrees_of_the_two() {
        let [few, many] = [(4.0, 0.3, 2.0), (1.0, 0.4, 9.0)];
        let [few, many] = [few, many].map(|(value, error, degrees)| Estimate { value, error, degrees });
        assert_eq!(few.less(many), Estimate { value: 3.0, error: 0.5, degrees: 2.0 });
        assert_eq!(many.less(Estimate::exact(1.0)), Estimate { value: 0.0, error: 0.4, degrees: 9.0 });
    }
}
