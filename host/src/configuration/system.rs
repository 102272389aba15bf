//! The discs, their box and their attraction: in reduced units, or in SI.
//!
//! ```
//! use meniscus::configuration::{Attraction, Physical};
//!
//! let table_1 = Physical {
//!     particles: 2500,
//!     radius: 10e-6,
//!     side: 5e-3,
//!     capillary_length: 2.7e-3,
//!     attraction: Attraction::Strength(0.89),
//!     temperature: 300.0,
//!     mobility: 10.6e6,
//!     repulsion: true,
//! };
//! assert_eq!(table_1.reduced().particles, 2500);
//! assert!((table_1.reduced().side - 500.0).abs() < 1e-9);
//! assert!((table_1.seconds_per_time_unit() - 2278.0).abs() < 1.0);
//! ```

/// Boltzmann's constant k_B, J/K (exact since the SI of 2019).
pub const BOLTZMANN_CONSTANT: f64 = 1.380649e-23;

/// The system in units of the disc radius R0 and the thermal energy kBT (table `system`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System {
    /// Number N of discs, 1 to [`LARGEST_PARTICLE_COUNT`](meniscus_core::parameters::LARGEST_PARTICLE_COUNT).
    pub particles: usize,
    /// Side L of the square periodic box, R0 (key `box`).
    pub side: f64,
    /// Strength V0 of the capillary attraction, kBT; 0 for none.
    pub capillary_strength: f64,
    /// Capillary length λ, R0; infinity allowed.
    pub capillary_length: f64,
    /// Whether discs repel each other at contact (Eq. 15).
    pub repulsion: bool,
}

/// How the strength of the attraction is given in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attraction {
    /// V0 in units of kBT (key `capillary_strength`).
    Strength(f64),
    /// By the force on a disc and the interface: V0 = f²/(2πγ) (Eq. 1).
    Force {
        /// Vertical force f on each disc, N.
        force: f64,
        /// Surface tension γ of the interface, N/m.
        surface_tension: f64,
    },
}

/// The system in SI units (table `physical`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physical {
    /// Number N of discs.
    pub particles: usize,
    /// Disc radius R0, m.
    pub radius: f64,
    /// Side L of the square periodic box, m (key `box`).
    pub side: f64,
    /// Capillary length λ, m; infinity allowed.
    pub capillary_length: f64,
    /// Strength of the capillary attraction.
    pub attraction: Attraction,
    /// Temperature, K.
    pub temperature: f64,
    /// Mobility Γ of a disc, s/kg.
    pub mobility: f64,
    /// Whether discs repel each other at contact (Eq. 15).
    pub repulsion: bool,
}

impl Physical {
    /// Thermal energy kBT, J.
    #[must_use]
    pub fn thermal_energy(&self) -> f64 {
        BOLTZMANN_CONSTANT * self.temperature
    }

    /// Diffusion constant D = kBT·Γ, m²/s (Eq. 17).
    #[must_use]
    pub fn diffusion_constant(&self) -> f64 {
        self.thermal_energy() * self.mobility
    }

    /// The unit of time R0²/D, s.
    #[must_use]
    pub fn seconds_per_time_unit(&self) -> f64 {
        self.radius / self.diffusion_constant() * self.radius
    }

    /// Strength V0 of the capillary attraction, kBT.
    #[must_use]
    pub fn capillary_strength(&self) -> f64 {
        match self.attraction {
            Attraction::Strength(strength) => strength,
            Attraction::Force { force, surface_tension } => {
                let tension = 2.0 * core::f64::consts::PI * surface_tension;
                (force / tension) * (force / self.thermal_energy())
            }
        }
    }

    /// The same system in reduced units.
    #[must_use]
    pub fn reduced(&self) -> System {
        System {
            particles: self.particles,
            side: self.side / self.radius,
            capillary_strength: self.capillary_strength(),
            capillary_length: self.capillary_length / self.radius,
            repulsion: self.repulsion,
        }
    }
}
