//! What the mean-field theory predicts: in closed form where there is one, and by integrating its equations where not.
//!
//! Equations are those of Bleibel, Dietrich, Domínguez and Oettel (2011). Lengths are in R0, energies in kBT, times in
//! R0²/D; the mobility is 1.
//!
//! - [`Instability`], [`jeans_time`], [`jeans_wavenumber`]: growth of small waves (Eqs. 7, 8, 10, 11, 22)
//! - [`cold_collapse_radius`], [`collapse_fit`]: radii of a collapsing patch (Eqs. 13, 30)
//! - [`Pressure`]: equations of state (Eq. 2)
//! - [`shells`]: cold collapse of concentric shells at any capillary length
//! - [`patch`]: collapse of a round patch with pressure and thermal motion
//! - [`continuity`]: the density as a function of place and time (Eq. 6)
//!
//! ```
//! use meniscus::theory::Instability;
//!
//! let table_1 = Instability::of_ideal_gas(0.89, 0.01, 270.0).expect("there is attraction");
//! assert!((table_1.jeans_time - 17.88).abs() < 0.005);
//! let critical = table_1.critical_wavenumber().expect("the capillary length exceeds Jeans' length");
//! assert!(table_1.growth_rate(0.5 * critical) > 0.0);
//! assert!(table_1.growth_rate(2.0 * critical) < 0.0);
//! ```

mod attraction;
mod cold_collapse;
pub mod continuity;
mod error;
mod linear;
pub mod patch;
mod pressure;
pub mod shells;

pub use cold_collapse::{cold_collapse_radius, collapse_fit};
pub use error::{AttractionError, EvolutionError};
pub use linear::{Instability, jeans_time, jeans_wavenumber};
pub use pressure::{DISC_RADIUS, Pressure};
