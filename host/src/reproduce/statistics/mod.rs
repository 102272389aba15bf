//! Curves measured in several runs: means with standard errors, and numbers read off them with jackknife errors.
//!
//! In: for each run, which its seed names, a value per bin of time. Out: means over runs per bin, and what a function of
//! the mean curve (where it is highest, how steep it is) comes to, with the error that leaving out one run at a time tells.
//! Runs of several quantities that have the same seed belong together and are left out together.
//!
//! ```
//! use meniscus::reproduce::statistics::{Curves, Row, Run, maximum};
//!
//! let rows = |shift: f64| {
//!     let row = move |bin: u64| {
//!         let time = 0.1 * bin as f64;
//!         Row { bin, time, value: Some(2.0 - (time - shift) * (time - shift)) }
//!     };
//!     (0..41).map(row).collect()
//! };
//! let runs = [(1, 1.4), (2, 1.5), (3, 1.6)].map(|(seed, shift)| Run { seed, rows: rows(shift) });
//! let peak = Curves::new(&runs).jackknife(|curve| maximum(curve, 0.4).map(|(time, _)| time)).unwrap();
//! assert!((peak.value - 1.5).abs() < 1e-6 && (peak.error - 0.0577).abs() < 1e-3);
//! assert_eq!(peak.degrees, 2.0);
//! ```

mod curves;
mod readings;

pub use curves::{Curve, Curves, Row, Run};
pub use readings::{average, interpolated, line, maximum, reaches};
