//! What a run is made of, checked once.
//!
//! [`Parameters`] holds plain numbers as a user gives them; [`Parameters::validate`] says what is wrong
//! with them. Every constructor of the core calls it, so the inside does not check again.
//!
//! ```
//! use meniscus_core::parameters::{ParameterError, Parameters};
//!
//! let table_1 = Parameters { side: 500.0, grid: 512, ..Parameters::default() };
//! assert_eq!(table_1.validate(), Ok(()));
//! assert_eq!(table_1.with_p3m().validate(), Ok(()));
//! let nonsense = Parameters { capillary_length: f64::NAN, ..table_1 };
//! assert_eq!(nonsense.validate(), Err(ParameterError::CapillaryLength));
//! ```

use crate::fields::Fields;
use crate::grid::Grid;
use crate::torus::{LARGEST_SIDE, UNITS};

pub use crate::grid::RANGE as GRID_RANGE;

/// How the capillary force is summed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Method {
    /// All of it on the mesh, as in the paper (Eqs. 18–21).
    #[default]
    ParticleMesh,
    /// Particle–particle particle–mesh: what is smooth on the mesh, with [`Influence::Optimal`] and
    /// [`Gradient::Spectral`], the rest pair by pair up to a cut-off (Hockney and Eastwood, chapter 8).
    P3m,
}

/// How a disc's mass is spread over mesh nodes, and the field gathered from them: a B-spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Assignment {
    /// Cloud in cell, order 2: linear, 4 nodes.
    CloudInCell,
    /// Triangular shaped cloud, order 3: quadratic, 9 nodes.
    #[default]
    TriangularShapedCloud,
    /// Order 4: piecewise cubic, 16 nodes.
    Order4,
    /// Order 5, 25 nodes.
    Order5,
    /// Order 6, 36 nodes.
    Order6,
    /// Order 7, 49 nodes.
    Order7,
}

impl Assignment {
    /// All of them, from order 2 up.
    pub const ALL: [Self; 6] = [
        Self::CloudInCell,
        Self::TriangularShapedCloud,
        Self::Order4,
        Self::Order5,
        Self::Order6,
        Self::Order7,
    ];

    /// The order of the B-spline, which is the number of nodes along an axis: 2 to 7.
    #[must_use]
    pub const fn order(self) -> usize {
        self as usize + 2
    }
}

/// Green's function of the interface on the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Influence {
    /// The paper's (Eq. 19, corrected): that of the five-point Laplacian,
    /// 1/[(4/h²)(sin²(k_x h/2) + sin²(k_y h/2)) + κ²].
    #[default]
    Paper,
    /// The continuum's, 1/(k² + κ²).
    Continuum,
    /// The one of Hockney and Eastwood that makes the error of the far part least, for [`Method::P3m`] only.
    Optimal,
}

/// How the gradient of the interface is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Gradient {
    /// i·k, with the Nyquist frequency zero (Eq. 21).
    #[default]
    Spectral,
    /// Two-point central difference, i·sin(kh)/h.
    Difference2,
    /// Four-point central difference, i·[8 sin(kh) − sin(2kh)]/(6h).
    Difference4,
}

/// Distribution of the thermal displacement; variance 2Δt per component unless none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Noise {
    /// Uniform of half-width √(6Δt), as in the paper (Eq. 17, corrected).
    #[default]
    Uniform,
    /// Gaussian of standard deviation √(2Δt).
    Gaussian,
    /// No thermal motion: temperature zero ("cold").
    None,
}

/// A run's physical and numerical parameters, in units of R0, kBT and R0²/D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Side L of the square periodic box, R0; above 2·[`crate::repulsion::CUTOFF`], at most 65 536.
    pub side: f64,
    /// Strength V0 of the capillary attraction, kBT; 0 to [`LARGEST_CAPILLARY_STRENGTH`], 0 for none.
    pub capillary_strength: f64,
    /// Capillary length λ, R0; at least [`SMALLEST_CAPILLARY_LENGTH`], infinity allowed.
    pub capillary_length: f64,
    /// Whether discs repel each other at contact (Eq. 15).
    pub repulsion: bool,
    /// How the capillary force is summed.
    pub method: Method,
    /// Splitting α of [`Method::P3m`], 1/R0; in [`SPLITTING_RANGE`], and at most [`LARGEST_SPLITTING_OF_SPACING`]
    /// over the mesh spacing. Not looked at otherwise.
    pub splitting: f64,
    /// Cut-off r_c of the near part of [`Method::P3m`], R0; at least [`SMALLEST_CUTOFF`], below L/2. Not looked at
    /// otherwise.
    pub cutoff: f64,
    /// How far δ a disc moves, R0, before the force of the mesh is computed anew; held until then, see
    /// [`crate::refresh`]. 0 to compute it in every step, else in [`MESH_REFRESH_RANGE`] and below L/4.
    pub mesh_refresh: f64,
    /// Nodes M along a side of the mesh: a power of two, 16 to 4096.
    pub grid: usize,
    /// Mass assignment.
    pub assignment: Assignment,
    /// Influence function.
    pub influence: Influence,
    /// Gradient.
    pub gradient: Gradient,
    /// External fields.
    pub fields: Fields,
    /// Thermal motion.
    pub noise: Noise,
    /// Ceiling Δt_max of the time step, R0²/D; 2⁻⁴⁰ to 1.
    pub max_step: f64,
    /// Largest displacement by force in a step, R0; 2⁻⁴⁰ to 0.5. The paper's is 1/4.
    pub max_displacement: f64,
    /// Seed of the noise, 0 to 2⁶³ − 1.
    pub seed: u64,
}

impl Parameters {
    /// Table I's discs in a box of 64 R0, with the paper's force on a mesh of 64 nodes a side.
    pub const PAPER: Self = Self {
        side: 64.0,
        capillary_strength: 0.89,
        capillary_length: 270.0,
        repulsion: true,
        method: Method::ParticleMesh,
        splitting: 0.5,
        cutoff: 6.0,
        mesh_refresh: 0.0,
        grid: 64,
        assignment: Assignment::TriangularShapedCloud,
        influence: Influence::Paper,
        gradient: Gradient::Spectral,
        fields: Fields::NONE,
        noise: Noise::Uniform,
        max_step: 0.001,
        max_displacement: 0.25,
        seed: 1,
    };

    /// The same: the one scheme without a number that must suit the mesh. [`Parameters::with_p3m`] makes the force
    /// accurate.
    pub const DEFAULT: Self = Self::PAPER;

    /// The same parameters with the capillary force split: order 5, α = 0.5/h, cut-off 7 h, which errs by about 10⁻⁴ of
    /// the root mean square force of discs at random, whatever the mesh. For another accuracy the host's estimate
    /// says what it takes.
    #[must_use]
    pub fn with_p3m(self) -> Self {
        let spacing = self.side / self.grid as f64;
        Self {
            method: Method::P3m,
            assignment: Assignment::Order5,
            influence: Influence::Optimal,
            gradient: Gradient::Spectral,
            splitting: 0.5 / spacing,
            cutoff: if 7.0 * spacing > SMALLEST_CUTOFF { 7.0 * spacing } else { SMALLEST_CUTOFF },
            ..self
        }
    }
}

impl Default for Parameters {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Largest capillary strength V0, kBT. Bounds the mesh force, see [`crate::units`].
pub const LARGEST_CAPILLARY_STRENGTH: f64 = 1000.0;
/// Largest modulus of a disc's capillary strength f: a mesh node holds two such discs.
pub const LARGEST_STRENGTH: f64 = 1000.0;
/// Smallest capillary length λ, R0.
pub const SMALLEST_CAPILLARY_LENGTH: f64 = 0.01;
/// Smallest and largest mesh spacing h = L/M, R0: finer resolves the inside of a disc, coarser no disc.
pub const SPACING_RANGE: (f64, f64) = (0.125, 16.0);
/// Smallest and largest splitting α, 1/R0.
pub const SPLITTING_RANGE: (f64, f64) = (1e-5, 8.0);
/// Largest α·h, splitting times mesh spacing: the far part of a coarser mesh is worth little, and its influence function
/// exceeds the bound in [`crate::units`].
pub const LARGEST_SPLITTING_OF_SPACING: f64 = 0.7;
/// Smallest cut-off of the near part, R0.
pub const SMALLEST_CUTOFF: f64 = 1.0;
/// Smallest and largest distance that a disc may move before the force of the mesh is computed anew, R0.
pub const MESH_REFRESH_RANGE: (f64, f64) = (1.0 / 1048576.0, 16.0);
/// Largest number of discs, 2²². Bounds the total force, see [`crate::units`].
pub const LARGEST_PARTICLE_COUNT: usize = 1 << 22;
/// Largest seed, 2⁶³ − 1.
pub const LARGEST_SEED: u64 = (1 << 63) - 1;
/// Smallest and largest ceiling of the time step, R0²/D.
pub const STEP_RANGE: (f64, f64) = (1.0 / 1099511627776.0, 1.0);
/// Smallest and largest displacement by force in a step, R0.
pub const DISPLACEMENT_RANGE: (f64, f64) = (1.0 / 1099511627776.0, 0.5);

/// What is wrong with [`Parameters`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterError {
    /// The side is not a finite positive number.
    Side,
    /// The side exceeds 65 536 R0: the unit of position would be too coarse.
    SideTooLarge,
    /// Half the side does not exceed the cut-off of the repulsion.
    SideTooSmall,
    /// V0 is not in 0 … [`LARGEST_CAPILLARY_STRENGTH`].
    CapillaryStrength,
    /// λ is not a number of at least [`SMALLEST_CAPILLARY_LENGTH`].
    CapillaryLength,
    /// M is not a power of two in [`GRID_RANGE`].
    Grid,
    /// The mesh spacing L/M exceeds [`SPACING_RANGE`].
    GridTooCoarse,
    /// The mesh spacing L/M is below [`SPACING_RANGE`].
    GridTooFine,
    /// α is not in [`SPLITTING_RANGE`].
    Splitting,
    /// α·h exceeds [`LARGEST_SPLITTING_OF_SPACING`].
    SplittingTooLarge,
    /// The cut-off is not a number of at least [`SMALLEST_CUTOFF`].
    Cutoff,
    /// The cut-off is not below half the side.
    CutoffTooLarge,
    /// δ is neither 0 nor in [`MESH_REFRESH_RANGE`].
    MeshRefresh,
    /// δ is not below a quarter of the side: a disc might come back from so far in one step.
    MeshRefreshTooLarge,
    /// The influence function does not belong to the method.
    Influence,
    /// The gradient does not belong to the method.
    Gradient,
    /// An external field is out of its range, see [`Fields`].
    Fields,
    /// Δt_max is not in [`STEP_RANGE`].
    MaxStep,
    /// The largest displacement is not in [`DISPLACEMENT_RANGE`].
    MaxDisplacement,
    /// The seed exceeds [`LARGEST_SEED`].
    Seed,
}

impl Parameters {
    /// Checks every number.
    ///
    /// # Errors
    /// The first [`ParameterError`] found.
    pub fn validate(&self) -> Result<(), ParameterError> {
        let within = |value: f64, (least, most): (f64, f64)| value >= least && value <= most;
        if !(self.side.is_finite() && self.side > 0.0) {
            return Err(ParameterError::Side);
        }
        if self.side > LARGEST_SIDE {
            return Err(ParameterError::SideTooLarge);
        }
        if self.side <= 2.0 * crate::repulsion::CUTOFF {
            return Err(ParameterError::SideTooSmall);
        }
        if !within(self.capillary_strength, (0.0, LARGEST_CAPILLARY_STRENGTH)) {
            return Err(ParameterError::CapillaryStrength);
        }
        if !within(self.capillary_length, (SMALLEST_CAPILLARY_LENGTH, f64::INFINITY)) {
            return Err(ParameterError::CapillaryLength);
        }
        if Grid::new(self.grid).is_none() {
            return Err(ParameterError::Grid);
        }
        let spacing = self.side / self.grid as f64;
        if spacing > SPACING_RANGE.1 {
            return Err(ParameterError::GridTooCoarse);
        }
        if spacing < SPACING_RANGE.0 {
            return Err(ParameterError::GridTooFine);
        }
        self.validate_method(spacing)?;
        if self.mesh_refresh != 0.0 && !within(self.mesh_refresh, MESH_REFRESH_RANGE) {
            return Err(ParameterError::MeshRefresh);
        }
        if self.mesh_refresh >= 0.25 * self.side {
            return Err(ParameterError::MeshRefreshTooLarge);
        }
        if !self.fields.is_valid(self.side) {
            return Err(ParameterError::Fields);
        }
        if !within(self.max_step, STEP_RANGE) {
            return Err(ParameterError::MaxStep);
        }
        if !within(self.max_displacement, DISPLACEMENT_RANGE) {
            return Err(ParameterError::MaxDisplacement);
        }
        if self.seed > LARGEST_SEED {
            return Err(ParameterError::Seed);
        }
        Ok(())
    }

    /// Checks what belongs to the method, on a mesh of this spacing.
    fn validate_method(&self, spacing: f64) -> Result<(), ParameterError> {
        if (self.method == Method::P3m) != (self.influence == Influence::Optimal) {
            return Err(ParameterError::Influence);
        }
        if self.method == Method::ParticleMesh {
            return Ok(());
        }
        if self.gradient != Gradient::Spectral {
            return Err(ParameterError::Gradient);
        }
        if !(self.splitting >= SPLITTING_RANGE.0 && self.splitting <= SPLITTING_RANGE.1) {
            return Err(ParameterError::Splitting);
        }
        if self.splitting * spacing > LARGEST_SPLITTING_OF_SPACING {
            return Err(ParameterError::SplittingTooLarge);
        }
        if self.cutoff.is_nan() || self.cutoff < SMALLEST_CUTOFF {
            return Err(ParameterError::Cutoff);
        }
        // In units of position, rounded up, it must stay below half a box too.
        if libm::ceil(self.cutoff / self.side * UNITS) >= 0.5 * UNITS {
            return Err(ParameterError::CutoffTooLarge);
        }
        Ok(())
    }
}
