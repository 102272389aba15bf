//! The tables of a configuration besides the system: force, mesh, motion, start, time, output.
//!
//! Lengths are in R0, times as each field says.
//!
//! ```
//! use meniscus::configuration::{Motion, Noise, Output};
//!
//! assert_eq!(Motion::default(), Motion { noise: Noise::Uniform, max_step: 0.001, max_displacement: 0.25 });
//! assert_eq!(Output::default().trajectory, 0.1);
//! ```

use std::path::PathBuf;

use meniscus_core::parameters::{Assignment, Gradient, Influence, Noise};

/// How the capillary force is summed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The particle-mesh method of the paper (`pm`).
    #[default]
    ParticleMesh,
}

/// Table `force`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Force {
    /// How the capillary force is summed.
    pub method: Method,
}

/// Table `mesh`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh {
    /// Nodes M along a side: a power of two, 16 to 4096. Left out of a file it is
    /// [`default_grid`] of the box.
    pub grid: usize,
    /// Mass assignment.
    pub assignment: Assignment,
    /// Influence function.
    pub influence: Influence,
    /// Gradient.
    pub gradient: Gradient,
}

/// The number of mesh nodes along a box of `side` R0 unless a configuration says otherwise: the
/// smallest power of two, 16 to 4096, whose spacing is at most 1 R0, the paper's.
#[must_use]
pub fn default_grid(side: f64) -> usize {
    let (least, most) = meniscus_core::parameters::GRID_RANGE;
    let mut grid = least;
    while grid < most && side > grid as f64 {
        grid *= 2;
    }
    grid
}

/// Table `motion`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Thermal motion.
    pub noise: Noise,
    /// Ceiling Δt_max of the time step, R0²/D.
    pub max_step: f64,
    /// Largest displacement by force in a step, R0.
    pub max_displacement: f64,
}

impl Default for Motion {
    fn default() -> Self {
        Self { noise: Noise::Uniform, max_step: 0.001, max_displacement: 0.25 }
    }
}

/// The lattice that [`Start::Lattice`] fills.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lattice {
    /// A square lattice of ⌈√N⌉ sites a side; the last sites stay empty if N is no square.
    #[default]
    Square,
    /// A triangular lattice, every disc with six neighbours.
    Hexagonal,
}

/// Where the discs are at time zero (table `start`). Lengths are in R0, with `physical` too.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Start {
    /// At random in the box without overlap.
    #[default]
    Random,
    /// At random without overlap in a disc in the middle of the box.
    Disc {
        /// Radius of the disc in which the centres lie, R0.
        radius: f64,
    },
    /// One disc in the middle of the box and concentric rings around it: ring n has `per_ring`·n discs
    /// at radius `spacing`·n.
    Rings {
        /// Number of rings.
        rings: u32,
        /// Distance between rings, R0.
        spacing: f64,
        /// Discs in the innermost ring.
        per_ring: u32,
    },
    /// On a lattice that fills the box.
    Lattice {
        /// Which lattice.
        lattice: Lattice,
    },
    /// As a file says.
    File {
        /// Path of the file, as given: relative to the working directory of the program.
        path: PathBuf,
        /// Mean density ρ_h in Jeans' time, R0⁻²; None for that of the box, N/L².
        density: Option<f64>,
    },
}

/// Table `time`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// When the run ends: in Jeans' times T if there is attraction (default 5), in R0²/D if V0 = 0,
    /// when there is no T (default 10).
    pub until: f64,
}

/// Default of `time.until` with attraction, Jeans' times T.
pub const DEFAULT_JEANS_TIMES: f64 = 5.0;
/// Default of `time.until` without attraction, R0²/D.
pub const DEFAULT_DIFFUSION_TIMES: f64 = 10.0;

/// Table `output`: intervals in the unit of `time.until`, 0 for none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// Interval of the rows of `observables.csv`.
    pub observables: f64,
    /// Interval of the frames of the trajectory.
    pub trajectory: f64,
    /// Interval of the snapshots (pictures).
    pub snapshots: f64,
}

impl Default for Output {
    fn default() -> Self {
        Self { observables: 0.01, trajectory: 0.1, snapshots: 1.0 }
    }
}
