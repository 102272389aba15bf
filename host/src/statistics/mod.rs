//! Numbers that were measured several times: means, standard errors, and what errors of few values are worth.
//!
//! In: numbers of any unit. Out: an [`Estimate`] in that unit, which knows of how many degrees of freedom its error is,
//! so that a comparison by it is not surer than so few values allow.
//!
//! ```
//! use meniscus::statistics::{Sample, jackknife};
//!
//! let values = [1.0, 2.0, 4.0, 9.0];
//! let mean = values.into_iter().collect::<Sample>().estimate().unwrap();
//! assert_eq!((mean.value, mean.degrees), (4.0, 3.0));
//!
//! // The jackknife of a mean has the same error; it can do as much for any function of the values.
//! let without = |left_out: Option<usize>| {
//!     let kept = values.iter().enumerate().filter(|(index, _)| Some(*index) != left_out);
//!     kept.map(|(_, value)| *value).collect::<Sample>().mean()
//! };
//! let same = jackknife(4, without).unwrap();
//! assert!((same.error - mean.error).abs() < 1e-12);
//!
//! // Of four values, 3.3 standard errors are as sure as 2 of many are.
//! assert!((mean.margin(2.0) / mean.error - 3.307).abs() < 1e-3);
//! ```

mod estimate;
mod jackknife;
mod sample;
mod student;

pub use estimate::Estimate;
pub use jackknife::jackknife;
pub use sample::Sample;
pub use student::{confidence, student_errors};
