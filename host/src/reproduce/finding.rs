//! Findings: what the paper says beside what was measured, and the verdict that follows from the two.
//!
//! A verdict is never written down: it is computed from numbers by a [`Criterion`], which says what would count as the
//! paper's claim. So the same report from other seeds may come to other verdicts.
//!
//! ```
//! use meniscus::reproduce::finding::{Criterion, Finding, Verdict};
//! use meniscus::statistics::Estimate;
//!
//! let finding = Finding::new("A0 of ring 7", "1.15", Criterion::equals(1.15, 0.01))
//!     .measured(Some(Estimate::new(1.1498, 0.0004)));
//! assert_eq!(finding.verdict(), Verdict::Reproduced);
//! assert_eq!(finding.ours(), "1.14980 ± 0.00040");
//!
//! // Had it been measured in two runs only, that error would say little.
//! let few = Finding { measured: Some(Estimate { value: 1.165, error: 0.005, degrees: 1.0 }), ..finding };
//! assert_eq!((few.verdict(), few.ours().as_str()), (Verdict::Undecided, "1.1650 ± 0.0050 (ν = 1)"));
//! ```

use super::numbers::{plain, with_error};
use crate::statistics::{Estimate, confidence};

/// Standard errors that a measured value may lie outside of what counts, unless a criterion says otherwise; of few degrees
/// of freedom as many as are as sure ([`Estimate::margin`]).
const STANDARD_ERRORS: f64 = 2.0;

/// What a comparison came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// What was measured is what the paper says.
    Reproduced,
    /// It is not.
    NotReproduced,
    /// Two statements of the paper exclude each other.
    PaperInconsistent,
    /// There are too few finished runs to tell.
    Undecided,
}

impl Verdict {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 4] =
        [Self::Reproduced, Self::NotReproduced, Self::PaperInconsistent, Self::Undecided];

    /// How reports call it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::PaperInconsistent => "paper's text inconsistent",
            Self::Undecided => "undecided",
        }
    }
}

/// Who says the bounds within which a value has to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The paper: as a number, or a word such as "increase", which has but one bound.
    Paper,
    /// We: the paper says it in words, or not how exactly its number is meant.
    Ours,
}

/// What counts as the paper's claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Criterion {
    /// The value lies between two bounds, either of which may be infinite.
    Between {
        /// The least value that counts.
        least: f64,
        /// The largest.
        most: f64,
        /// Standard errors it may lie outside, if their number of degrees of freedom were large.
        standard_errors: f64,
        /// The largest standard error of that kind with which a value that close to a bound says anything.
        resolution: f64,
        /// Who says the bounds.
        source: Source,
    },
    /// Two numbers that the paper gives, or that follow from what it gives, are the same within their rounding.
    Consistent {
        /// One of them.
        printed: f64,
        /// The other.
        implied: f64,
        /// How far rounding may part them.
        rounding: f64,
    },
}

impl Criterion {
    /// `expected`, give or take `tolerance`: the rounding of what is printed and what else is not known of it.
    #[must_use]
    pub fn equals(expected: f64, tolerance: f64) -> Self {
        Self::between(expected - tolerance, expected + tolerance)
    }

    /// At least `least` and at most `most`; as exactly as that, or with no error where one of them is infinite.
    #[must_use]
    pub fn between(least: f64, most: f64) -> Self {
        let width = most - least;
        let resolution = if width.is_finite() { 0.5 * width } else { 0.0 };
        let source = Source::Paper;
        Self::Between { least, most, standard_errors: STANDARD_ERRORS, resolution, source }
    }

    /// At least `least`.
    #[must_use]
    pub fn at_least(least: f64) -> Self {
        Self::between(least, f64::INFINITY)
    }

    /// At most `most`.
    #[must_use]
    pub fn at_most(most: f64) -> Self {
        Self::between(f64::NEG_INFINITY, most)
    }

    /// Two numbers of the paper that are to be the same.
    #[must_use]
    pub const fn consistent(printed: f64, implied: f64, rounding: f64) -> Self {
        Self::Consistent { printed, implied, rounding }
    }

    /// The same with this many standard errors, and no more than `resolution` of one.
    #[must_use]
    pub const fn with_errors(self, standard_errors: f64, resolution: f64) -> Self {
        match self {
            Self::Between { least, most, source, .. } => {
                Self::Between { least, most, standard_errors, resolution, source }
            }
            Self::Consistent { .. } => self,
        }
    }

    /// The same, the bounds being ours and not the paper's.
    #[must_use]
    pub const fn ours(self) -> Self {
        match self {
            Self::Between { least, most, standard_errors, resolution, .. } => {
                Self::Between { least, most, standard_errors, resolution, source: Source::Ours }
            }
            Self::Consistent { .. } => self,
        }
    }

    /// The verdict on a measured value; None if nothing was measured.
    #[must_use]
    pub fn verdict(&self, measured: Option<Estimate>) -> Verdict {
        match *self {
            Self::Consistent { printed, implied, rounding } if (printed - implied).abs() <= rounding => {
                Verdict::Reproduced
            }
            Self::Consistent { .. } => Verdict::PaperInconsistent,
            Self::Between { least, most, standard_errors, resolution, .. } => {
                let Some(estimate) = measured else { return Verdict::Undecided };
                let (value, margin) = (estimate.value, estimate.margin(standard_errors));
                let within = |margin: f64| (least + margin..=most - margin).contains(&value);
                if value.is_nan() || !margin.is_finite() {
                    Verdict::Undecided
                } else if !within(-margin) {
                    Verdict::NotReproduced
                } else if within(margin) || margin <= standard_errors * resolution {
                    Verdict::Reproduced
                } else {
                    Verdict::Undecided
                }
            }
        }
    }

    /// What counts, in words.
    #[must_use]
    pub fn words(&self) -> String {
        match *self {
            Self::Consistent { printed, implied, rounding } => {
                format!("{} and {} differ by at most {}", plain(printed), plain(implied), plain(rounding))
            }
            Self::Between { least, most, standard_errors, resolution, source } => {
                let range = match (least.is_finite(), most.is_finite()) {
                    (true, true) => format!("{} to {}", plain(least), plain(most)),
                    (true, false) => format!("at least {}", plain(least)),
                    _ => format!("at most {}", plain(most)),
                };
                let source = match source {
                    Source::Paper => "",
                    Source::Ours if least.is_finite() && most.is_finite() => " (bounds ours)",
                    Source::Ours => " (bound ours)",
                };
                let margin = format!("{standard_errors} s.e. ({:.2} %)", 100.0 * confidence(standard_errors));
                if resolution > 0.0 {
                    let most = plain(standard_errors * resolution);
                    format!("{range}{source}, or up to {margin} outside if they are at most {most}")
                } else {
                    format!("{range}{source}, with a margin of {margin}")
                }
            }
        }
    }
}

/// A statement of the paper, what was measured of it, and how the two are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What is measured, with its unit.
    pub quantity: String,
    /// What the paper says of it.
    pub paper: String,
    /// What was measured, in the same unit; an error without degrees of freedom is that of a single run.
    pub measured: Option<Estimate>,
    /// What counts as the paper's claim.
    pub criterion: Criterion,
}

impl Finding {
    /// A finding of which nothing was measured.
    #[must_use]
    pub fn new(quantity: impl Into<String>, paper: impl Into<String>, criterion: Criterion) -> Self {
        Self { quantity: quantity.into(), paper: paper.into(), measured: None, criterion }
    }

    /// The same with what was measured.
    #[must_use]
    pub fn measured(self, measured: Option<Estimate>) -> Self {
        Self { measured, ..self }
    }

    /// What follows.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.criterion.verdict(self.measured)
    }

    /// What was measured, in words.
    #[must_use]
    pub fn ours(&self) -> String {
        self.measured.map_or_else(|| "–".to_owned(), with_error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(criterion: Criterion, value: f64, error: f64) -> Verdict {
        criterion.verdict(Some(Estimate::new(value, error)))
    }

    #[test]
    fn a_value_within_its_bounds_or_their_errors_is_reproduced() {
        let delay = Criterion::equals(1.16, 0.01);
        assert_eq!(verdict(delay, 1.165, 0.0), Verdict::Reproduced);
        assert_eq!(verdict(delay, 1.175, 0.003), Verdict::Reproduced);
        assert_eq!(verdict(delay, 1.175, 0.002), Verdict::NotReproduced);
        assert_eq!(verdict(delay, 1.14, 0.0), Verdict::NotReproduced);
    }

    #[test]
    fn bounds_on_one_side_only_hold_there() {
        assert_eq!(verdict(Criterion::at_least(0.9), 4.0, 0.1), Verdict::Reproduced);
        assert_eq!(verdict(Criterion::at_least(0.9), 0.6, 0.1), Verdict::NotReproduced);
        assert_eq!(verdict(Criterion::at_most(0.9), -4.0, 0.1), Verdict::Reproduced);
        assert_eq!(verdict(Criterion::at_most(0.9), 1.2, 0.1), Verdict::NotReproduced);
    }

    #[test]
    fn what_is_not_known_well_enough_is_undecided() {
        let delay = Criterion::equals(1.16, 0.01);
        assert_eq!(delay.verdict(None), Verdict::Undecided);
        assert_eq!(delay.verdict(Some(Estimate::single(1.16))), Verdict::Undecided);
        assert_eq!(verdict(delay, 1.16, f64::NAN), Verdict::Undecided);
        assert_eq!(verdict(delay, f64::NAN, 0.001), Verdict::Undecided);
        assert_eq!(verdict(delay, 1.4, 0.2), Verdict::Undecided);
        assert_eq!(verdict(delay.with_errors(2.0, 0.3), 1.4, 0.2), Verdict::Reproduced);
        // What is far from any bound does not have to be known well.
        let grows = Criterion::at_least(1.0).with_errors(2.0, 0.05);
        assert_eq!(verdict(grows, 0.8, 0.2), Verdict::Undecided);
        assert_eq!(verdict(grows, 1.8, 0.2), Verdict::Reproduced);
        assert_eq!(verdict(grows, 0.2, 0.2), Verdict::NotReproduced);
    }

    /// 0.64 ± 0.13 of three runs, of which 2 s.e. are 4.53, is no evidence against 0.9; of ten, 2.32, or of many it is.
    #[test]
    fn few_runs_decide_less() {
        let share = Criterion::at_least(0.9).with_errors(2.0, 0.1);
        let of = |degrees| share.verdict(Some(Estimate { value: 0.57, error: 0.13, degrees }));
        assert_eq!(of(1.0), Verdict::Undecided);
        assert_eq!(of(2.0), Verdict::Undecided);
        assert_eq!(of(9.0), Verdict::NotReproduced);
        assert_eq!(of(f64::INFINITY), Verdict::NotReproduced);
        // Nor does a value near its bound count that few runs do not tell from one beyond.
        let slope = Criterion::equals(0.0, 0.03).with_errors(2.0, 0.015);
        let of = |degrees| slope.verdict(Some(Estimate { value: 0.023, error: 0.009, degrees }));
        assert_eq!((of(2.0), of(9.0)), (Verdict::Undecided, Verdict::Reproduced));
        // Without degrees of freedom an error says nothing, however small.
        assert_eq!(of(0.0), Verdict::Undecided);
    }

    #[test]
    fn a_bound_on_one_side_has_no_width_to_allow_an_error() {
        let least = Criterion::at_least(0.9);
        assert_eq!(verdict(least, 0.89, 0.01), Verdict::Undecided);
        assert_eq!(verdict(least, 0.91, 0.01), Verdict::Undecided);
        assert_eq!(verdict(least, 0.91, 0.0), Verdict::Reproduced);
    }

    #[test]
    fn words_say_the_confidence_and_whose_the_bounds_are() {
        assert_eq!(
            Criterion::at_most(0.7).with_errors(2.0, 0.1).ours().words(),
            "at most 0.7 (bound ours), or up to 2 s.e. (95.45 %) outside if they are at most 0.2"
        );
        assert_eq!(
            Criterion::between(3.0, 4.0).with_errors(3.0, 0.5).words(),
            "3 to 4, or up to 3 s.e. (99.73 %) outside if they are at most 1.5"
        );
        assert!(Criterion::equals(1.5, 0.25).ours().words().starts_with("1.25 to 1.75 (bounds ours), or"));
        assert_eq!(Criterion::at_least(1.0).words(), "at least 1, with a margin of 2 s.e. (95.45 %)");
    }

    #[test]
    fn numbers_of_the_paper_that_exclude_each_other_are_named() {
        let density = Criterion::consistent(10.0, 0.01, 0.005);
        assert_eq!(density.verdict(None), Verdict::PaperInconsistent);
        assert_eq!(Criterion::consistent(17.9, 17.88, 0.05).verdict(None), Verdict::Reproduced);
    }
}
