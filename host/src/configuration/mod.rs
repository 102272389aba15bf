//! A run's configuration: read, checked, and written back.
//!
//! In: TOML from a file, a text or a preset, and overrides `key=value` as on the command line. Out: a
//! [`Configuration`] in which every number is in its range, in units of R0, kBT and R0²/D; or a
//! [`ConfigurationError`] of one line that names the place, the key, what was found and what is
//! accepted. [`Configuration::to_toml`] writes a complete configuration that reads back to an equal one.
//!
//! ```
//! use meniscus::configuration::Configuration;
//!
//! let overrides = ["system.capillary_length=1500".to_owned(), "mesh.assignment=cic".to_owned()];
//! let configuration = Configuration::from_preset("table-1", &overrides)?;
//! assert_eq!(configuration.system.particles, 2500);
//! assert_eq!(configuration.system.capillary_length, 1500.0);
//! let text = configuration.to_toml();
//! assert_eq!(Configuration::from_text("written.toml", &text, &[])?, configuration);
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

mod error;
mod sections;
mod system;

pub use error::{ConfigurationError, Place};
pub use meniscus_core::parameters::{Assignment, Gradient, Influence, Noise};
pub use sections::{
    DEFAULT_DIFFUSION_TIMES, DEFAULT_JEANS_TIMES, Force, Lattice, Mesh, Method, Motion, Output, Start, Time,
    default_grid,
};
pub use system::{Attraction, BOLTZMANN_CONSTANT, Physical, System};

use core::f64::consts::PI;

use meniscus_core::parameters::Parameters;

use crate::theory::Instability;

/// The version of the format that this program reads and writes.
pub const VERSION: u32 = 1;

/// Everything a run is made of.
///
/// Made by reading, so that its numbers are in range. To change one, read again with an override: the
/// fields are free for those who look, and nothing checks a field that is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Version of the format, [`VERSION`].
    pub version: u32,
    /// Seed of the start and of the noise, 0 to 2⁶³ − 1.
    pub seed: u64,
    /// The system as it was given in SI, if it was.
    pub physical: Option<Physical>,
    /// The system in R0 and kBT; that of `physical`, reduced, if there is one.
    pub system: System,
    /// How the capillary force is summed.
    pub force: Force,
    /// The mesh.
    pub mesh: Mesh,
    /// Thermal motion and the step rule.
    pub motion: Motion,
    /// Where the discs are at time zero.
    pub start: Start,
    /// When the run ends.
    pub time: Time,
    /// What is written how often.
    pub output: Output,
}

impl Configuration {
    /// What the engine needs.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        Parameters {
            side: self.system.side,
            capillary_strength: self.system.capillary_strength,
            capillary_length: self.system.capillary_length,
            repulsion: self.system.repulsion,
            grid: self.mesh.grid,
            assignment: self.mesh.assignment,
            influence: self.mesh.influence,
            gradient: self.mesh.gradient,
            noise: self.motion.noise,
            max_step: self.motion.max_step,
            max_displacement: self.motion.max_displacement,
            seed: self.seed,
        }
    }

    /// Mean density ρ_h of the discs where they start, R0⁻²: the density in Jeans' time.
    ///
    /// N/L² for a start that fills the box, N/(πR²) for a disc of radius R. In rings of spacing s each
    /// of the `per_ring`·n discs of ring n stands for the same area πs²·2/`per_ring` if ring n owns the
    /// annulus up to s√(n(n+1)); the discs around the central one so fill a patch of radius
    /// s√(rings·(rings+1)) and their density is `per_ring`/(2πs²). (Figs. 12 and 13: 183 R0.) A start
    /// from a file counts as filling the box.
    #[must_use]
    pub fn mean_density(&self) -> f64 {
        let particles = self.system.particles as f64;
        match self.start {
            Start::Disc { radius } => particles / (PI * radius * radius),
            Start::Rings { spacing, per_ring, .. } => f64::from(per_ring) / (2.0 * PI * spacing * spacing),
            Start::Random | Start::Lattice { .. } | Start::File { .. } => {
                particles / (self.system.side * self.system.side)
            }
        }
    }

    /// Jeans' instability of the start taken as an ideal gas; None without attraction.
    #[must_use]
    pub fn instability(&self) -> Option<Instability> {
        let System { capillary_strength, capillary_length, .. } = self.system;
        Instability::of_ideal_gas(capillary_strength, self.mean_density(), capillary_length)
    }

    /// Jeans' time T of the start, R0²/D (Eq. 7); None without attraction.
    #[must_use]
    pub fn jeans_time(&self) -> Option<f64> {
        self.instability().map(|instability| instability.jeans_time)
    }

    /// What one unit of `time.until` and of the output intervals is, R0²/D: Jeans' time, or 1 without
    /// attraction.
    #[must_use]
    pub fn time_scale(&self) -> f64 {
        self.jeans_time().unwrap_or(1.0)
    }

    /// When the run ends, R0²/D.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.time.until * self.time_scale()
    }

    /// The unit of time R0²/D in seconds; None unless the system was given in SI.
    #[must_use]
    pub fn seconds_per_time_unit(&self) -> Option<f64> {
        self.physical.map(|physical| physical.seconds_per_time_unit())
    }
}
