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

use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise};

use super::names::{ASSIGNMENTS, method_word, word};
use crate::files::trajectory::Format;
use crate::observables::series::Series;

/// Table `force`: how the capillary force is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Force {
    /// All of it on the mesh, as in the paper (`pm`).
    ParticleMesh,
    /// The far part on the mesh, the near part pair by pair (`p3m`).
    P3m {
        /// Largest estimated error accepted, rms, relative to the rms force of discs at random.
        accuracy: f64,
        /// Splitting α between far and near part, 1/R0.
        splitting: f64,
        /// Cut-off r_c of the near part, R0.
        cutoff: f64,
    },
}

impl Force {
    /// The method alone.
    #[must_use]
    pub const fn method(&self) -> Method {
        match self {
            Self::ParticleMesh => Method::ParticleMesh,
            Self::P3m { .. } => Method::P3m,
        }
    }
}

impl Force {
    /// The word of the method, as in `force.method`.
    #[must_use]
    pub fn method_word(&self) -> &'static str {
        method_word(self.method())
    }
}

impl Mesh {
    /// The word of the assignment, as in `mesh.assignment`.
    #[must_use]
    pub fn assignment_word(&self) -> &'static str {
        word(&ASSIGNMENTS, &self.assignment)
    }
}

/// Default of `force.accuracy`.
pub const DEFAULT_ACCURACY: f64 = 1e-3;

/// Table `mesh`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh {
    /// Nodes M along a side: a power of two, 16 to 4096. Left out of a file it is chosen for the accuracy
    /// with `p3m`, and [`default_grid`] of the box with `pm`.
    pub grid: usize,
    /// Mass assignment.
    pub assignment: Assignment,
    /// Influence function.
    pub influence: Influence,
    /// Gradient.
    pub gradient: Gradient,
}

/// The number of mesh nodes along a box of `side` R0 with `pm` unless a configuration says otherwise:
/// the smallest power of two, 16 to 4096, whose spacing is at most 1 R0, the paper's.
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
    /// When the run ends: in Jeans' times T if there is attraction (default 5), in R0²/D if V0 or all
    /// strengths are 0, when there is no T (default 10).
    pub until: f64,
}

/// Default of `time.until` with attraction, Jeans' times T.
pub const DEFAULT_JEANS_TIMES: f64 = 5.0;
/// Default of `time.until` without attraction, R0²/D.
pub const DEFAULT_DIFFUSION_TIMES: f64 = 10.0;

/// Shells of modes unless a configuration says otherwise: at least so many.
pub const FEWEST_SHELLS: u32 = 8;
/// Shells of modes unless a configuration says otherwise: at most so many, of some 6500 waves.
pub const MOST_SHELLS: u32 = 64;

impl Output {
    /// Interval of a series, in the unit of `time.until`; 0 for none.
    #[must_use]
    pub const fn interval(&self, series: Series) -> f64 {
        match series {
            Series::Observables => self.observables,
            Series::Minkowski => self.minkowski,
            Series::Modes => self.modes,
            Series::RadialDistribution => self.radial_distribution,
            Series::StructureFactor => self.structure_factor,
            Series::Radii => self.radii,
        }
    }

    /// The same without any series or snapshots: of a run that writes none.
    #[must_use]
    pub fn without_series_and_snapshots(self) -> Self {
        Self {
            observables: 0.0,
            minkowski: 0.0,
            modes: 0.0,
            radial_distribution: 0.0,
            structure_factor: 0.0,
            radii: 0.0,
            snapshots: 0.0,
            ..self
        }
    }
}

/// Table `output`: intervals in the unit of `time.until` but for those of checkpoints; 0 for none. What the series
/// are is said in [`observables::series`](crate::observables::series).
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Interval of the rows of `observables.csv`.
    pub observables: f64,
    /// Interval of the frames of the trajectory.
    pub trajectory: f64,
    /// Format of the trajectory.
    pub trajectory_format: Format,
    /// Interval of the snapshots (pictures).
    pub snapshots: f64,
    /// Interval of Minkowski functionals in `minkowski.csv`.
    pub minkowski: f64,
    /// Spacing of the grid of the density that they are those of, R0; rounded so that it divides the box.
    pub minkowski_spacing: f64,
    /// Densities from which on a region is dense, in units of the density ρ_m = 1/(2√3) R0⁻² of closest packing;
    /// increasing.
    pub minkowski_thresholds: Vec<f64>,
    /// Interval of the density modes in `modes.csv`.
    pub modes: f64,
    /// Number of shells of wavenumbers, of width 2π/L around 2π/L, 4π/L, …. Left out of a file, those below the
    /// critical wavenumber, [`FEWEST_SHELLS`] to [`MOST_SHELLS`] of them.
    pub modes_shells: u32,
    /// Interval of g(r) in `radial_distribution.csv`.
    pub radial_distribution: f64,
    /// Interval of S(k) in `structure_factor.csv`.
    pub structure_factor: f64,
    /// Interval of the radii of rings or shells in `radii.csv`.
    pub radii: f64,
    /// Width of the shells by initial radius, R0; a start in rings has its rings instead.
    pub radii_width: f64,
    /// Steps between checkpoints.
    pub checkpoint_steps: u64,
    /// Minutes of wall time between checkpoints.
    pub checkpoint_minutes: f64,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            observables: 0.01,
            trajectory: 0.1,
            trajectory_format: Format::Gsd,
            snapshots: 1.0,
            minkowski: 0.0,
            minkowski_spacing: 5.3,
            minkowski_thresholds: vec![0.14],
            modes: 0.0,
            modes_shells: FEWEST_SHELLS,
            radial_distribution: 0.0,
            structure_factor: 0.0,
            radii: 0.0,
            radii_width: 7.5,
            checkpoint_steps: 0,
            checkpoint_minutes: 10.0,
        }
    }
}
