//! The core's values as C sees them.

use crate::status::MeniscusStatus;
use core::ffi::c_char;
use meniscus_core::assignment::DISC;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::{Clock, Step};
use meniscus_core::fields::Fields;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise, Parameters};

/// The capillary strength 1 of a disc, in the unit of meniscus_set.
pub const MENISCUS_STRENGTH_ONE: i32 = 1048576;

const _: () = assert!(MENISCUS_STRENGTH_ONE as u32 == DISC);

/// How the capillary force is summed.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusMethod {
    /// All of it on the mesh.
    ParticleMesh = 1,
    /// What is smooth on the mesh, with the optimal influence function and the spectral gradient, the rest pair by
    /// pair up to a cut-off.
    P3m = 2,
}

/// How a disc's mass is spread over mesh nodes, and the field gathered from them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusAssignment {
    /// Order 2: linear, 4 nodes.
    CloudInCell = 2,
    /// Order 3: quadratic, 9 nodes.
    TriangularShapedCloud = 3,
    /// Order 4: piecewise cubic, 16 nodes.
    Order4 = 4,
    /// Order 5, 25 nodes.
    Order5 = 5,
    /// Order 6, 36 nodes.
    Order6 = 6,
    /// Order 7, 49 nodes.
    Order7 = 7,
}

/// Green's function of the interface on the mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusInfluence {
    /// That of the five-point Laplacian.
    Paper = 1,
    /// The continuum's, 1/(k^2 + kappa^2).
    Continuum = 2,
    /// The one that makes the error of the far part least, for MeniscusMethod P3m only.
    Optimal = 3,
}

/// How the gradient of the interface is taken.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusGradient {
    /// i k, with the Nyquist frequency zero.
    Spectral = 1,
    /// Two-point central difference.
    Difference2 = 2,
    /// Four-point central difference.
    Difference4 = 4,
}

/// Distribution of the thermal displacement; variance 2 dt per component unless none.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeniscusNoise {
    /// Uniform.
    Uniform = 1,
    /// Gaussian.
    Gaussian = 2,
    /// No thermal motion: temperature zero.
    None = 3,
}

/// A run's physical and numerical parameters, in units of R0, kBT and R0^2/D. Begin with
/// meniscus_default_parameters: a choice left 0 is refused.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeniscusParameters {
    /// Side of the square periodic box, R0; at most 65536.
    pub side: f64,
    /// Strength V0 of the capillary attraction, kBT; 0 to 1000, 0 for none.
    pub capillary_strength: f64,
    /// Capillary length, R0; at least 0.01, INFINITY allowed.
    pub capillary_length: f64,
    /// Splitting of P3m, 1/R0; 1e-5 to 8, and at most 0.7 over the mesh spacing. Not looked at otherwise.
    pub splitting: f64,
    /// Cut-off of the near part of P3m, R0; at least 1, below half the side. Not looked at otherwise.
    pub cutoff: f64,
    /// How far a disc moves before the force of the mesh is computed anew for all, R0; 0 for every step, else 2^-20 to 16 and
    /// below a quarter of the side, for an engine in memory of meniscus_size_to_hold.
    pub mesh_refresh: f64,
    /// Uniform external force along x, kBT/R0. No external field exerts more than 1e8 along an axis anywhere.
    pub uniform_force_x: f64,
    /// Uniform external force along y, kBT/R0.
    pub uniform_force_y: f64,
    /// Stiffness of a harmonic trap that draws every disc, kBT/R0^2; 0 for none.
    pub trap_stiffness: f64,
    /// x of the trap's centre, R0; 0 to side.
    pub trap_center_x: f64,
    /// y of the trap's centre, R0; 0 to side.
    pub trap_center_y: f64,
    /// Ceiling of the time step, R0^2/D; 2^-40 to 1.
    pub max_step: f64,
    /// Largest displacement by force in a step, R0; 2^-40 to 0.5.
    pub max_displacement: f64,
    /// Seed of the noise, 0 to 2^63 - 1.
    pub seed: u64,
    /// Nodes along a side of the mesh: a power of two, 16 to 4096.
    pub grid: u32,
    /// How the capillary force is summed: a MeniscusMethod.
    pub method: u32,
    /// Mass assignment: a MeniscusAssignment.
    pub assignment: u32,
    /// Influence function: a MeniscusInfluence.
    pub influence: u32,
    /// Gradient: a MeniscusGradient.
    pub gradient: u32,
    /// Thermal motion: a MeniscusNoise.
    pub noise: u32,
    /// Whether discs repel each other at contact: 0 or 1.
    pub repulsion: u32,
}

impl From<&Parameters> for MeniscusParameters {
    fn from(parameters: &Parameters) -> Self {
        Self {
            side: parameters.side,
            capillary_strength: parameters.capillary_strength,
            capillary_length: parameters.capillary_length,
            splitting: parameters.splitting,
            cutoff: parameters.cutoff,
            mesh_refresh: parameters.mesh_refresh,
            uniform_force_x: parameters.fields.uniform_force[0],
            uniform_force_y: parameters.fields.uniform_force[1],
            trap_stiffness: parameters.fields.trap_stiffness,
            trap_center_x: parameters.fields.trap_center[0],
            trap_center_y: parameters.fields.trap_center[1],
            max_step: parameters.max_step,
            max_displacement: parameters.max_displacement,
            seed: parameters.seed,
            grid: parameters.grid as u32,
            method: match parameters.method {
                Method::ParticleMesh => MeniscusMethod::ParticleMesh as u32,
                Method::P3m => MeniscusMethod::P3m as u32,
            },
            assignment: match parameters.assignment {
                Assignment::CloudInCell => MeniscusAssignment::CloudInCell as u32,
                Assignment::TriangularShapedCloud => MeniscusAssignment::TriangularShapedCloud as u32,
                Assignment::Order4 => MeniscusAssignment::Order4 as u32,
                Assignment::Order5 => MeniscusAssignment::Order5 as u32,
                Assignment::Order6 => MeniscusAssignment::Order6 as u32,
                Assignment::Order7 => MeniscusAssignment::Order7 as u32,
            },
            influence: match parameters.influence {
                Influence::Paper => MeniscusInfluence::Paper as u32,
                Influence::Continuum => MeniscusInfluence::Continuum as u32,
                Influence::Optimal => MeniscusInfluence::Optimal as u32,
            },
            gradient: match parameters.gradient {
                Gradient::Spectral => MeniscusGradient::Spectral as u32,
                Gradient::Difference2 => MeniscusGradient::Difference2 as u32,
                Gradient::Difference4 => MeniscusGradient::Difference4 as u32,
            },
            noise: match parameters.noise {
                Noise::Uniform => MeniscusNoise::Uniform as u32,
                Noise::Gaussian => MeniscusNoise::Gaussian as u32,
                Noise::None => MeniscusNoise::None as u32,
            },
            repulsion: u32::from(parameters.repulsion),
        }
    }
}

impl TryFrom<&MeniscusParameters> for Parameters {
    type Error = MeniscusStatus;

    /// Refuses a choice that does not exist; the numbers are left to [`Parameters::validate`].
    fn try_from(parameters: &MeniscusParameters) -> Result<Self, MeniscusStatus> {
        Ok(Self {
            side: parameters.side,
            capillary_strength: parameters.capillary_strength,
            capillary_length: parameters.capillary_length,
            repulsion: match parameters.repulsion {
                0 => false,
                1 => true,
                _ => return Err(MeniscusStatus::Repulsion),
            },
            method: match parameters.method {
                1 => Method::ParticleMesh,
                2 => Method::P3m,
                _ => return Err(MeniscusStatus::Method),
            },
            splitting: parameters.splitting,
            cutoff: parameters.cutoff,
            mesh_refresh: parameters.mesh_refresh,
            grid: usize::try_from(parameters.grid).map_err(|_| MeniscusStatus::Grid)?,
            assignment: match parameters.assignment {
                2 => Assignment::CloudInCell,
                3 => Assignment::TriangularShapedCloud,
                4 => Assignment::Order4,
                5 => Assignment::Order5,
                6 => Assignment::Order6,
                7 => Assignment::Order7,
                _ => return Err(MeniscusStatus::Assignment),
            },
            influence: match parameters.influence {
                1 => Influence::Paper,
                2 => Influence::Continuum,
                3 => Influence::Optimal,
                _ => return Err(MeniscusStatus::Influence),
            },
            gradient: match parameters.gradient {
                1 => Gradient::Spectral,
                2 => Gradient::Difference2,
                4 => Gradient::Difference4,
                _ => return Err(MeniscusStatus::Gradient),
            },
            fields: Fields {
                uniform_force: [parameters.uniform_force_x, parameters.uniform_force_y],
                trap_stiffness: parameters.trap_stiffness,
                trap_center: [parameters.trap_center_x, parameters.trap_center_y],
            },
            noise: match parameters.noise {
                1 => Noise::Uniform,
                2 => Noise::Gaussian,
                3 => Noise::None,
                _ => return Err(MeniscusStatus::Noise),
            },
            max_step: parameters.max_step,
            max_displacement: parameters.max_displacement,
            seed: parameters.seed,
        })
    }
}

/// Discs of the paper's Table I in a box of 64 R0, with the paper's force on a mesh of 64 nodes a side.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_default_parameters() -> MeniscusParameters {
    MeniscusParameters::from(&Parameters::DEFAULT)
}

/// The same parameters with the capillary force split on their mesh: order 5, splitting 0.5/h, cut-off 7 h, which errs
/// by about 1e-4 of the root mean square force of discs at random. As given if a choice in them does not exist.
#[unsafe(no_mangle)]
pub extern "C" fn meniscus_with_p3m(parameters: MeniscusParameters) -> MeniscusParameters {
    Parameters::try_from(&parameters)
        .map_or(parameters, |parameters| MeniscusParameters::from(&parameters.with_p3m()))
}

/// Where a run stands.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeniscusClock {
    /// Steps done.
    pub step: u64,
    /// Time, unit 2^-40 R0^2/D.
    pub time: u64,
}

impl From<Clock> for MeniscusClock {
    fn from(clock: Clock) -> Self {
        Self { step: clock.step, time: clock.time }
    }
}

impl From<MeniscusClock> for Clock {
    fn from(clock: MeniscusClock) -> Self {
        Self { step: clock.step, time: clock.time }
    }
}

/// What a step did.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeniscusStep {
    /// Its length, unit 2^-40 R0^2/D.
    pub length: u64,
    /// The largest modulus of the forces before the step, rounded up, unit 2^-24 kBT/R0.
    pub largest_force: u64,
    /// Steps done and time reached after it.
    pub clock: MeniscusClock,
    /// Whether the force of the mesh was computed anew, 0 or 1; always 1 if none is held.
    pub refreshed: u32,
}

impl From<Step> for MeniscusStep {
    fn from(step: Step) -> Self {
        Self {
            length: step.length,
            largest_force: step.largest_force,
            clock: step.clock.into(),
            refreshed: u32::from(step.refreshed),
        }
    }
}

/// Length and SHA-256 of the canonical bytes of a state.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeniscusDigest {
    /// Number of bytes.
    pub length: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
}

impl From<Digest> for MeniscusDigest {
    fn from(digest: Digest) -> Self {
        Self { length: digest.length, sha256: digest.sha256 }
    }
}

impl MeniscusDigest {
    /// The SHA-256 as 64 hexadecimal digits and a zero.
    pub(crate) fn text(&self) -> [c_char; 65] {
        let digit = |value: u8| (if value < 10 { b'0' + value } else { b'a' + value - 10 }) as c_char;
        let mut text = [0; 65];
        for (digits, &byte) in text.chunks_exact_mut(2).zip(&self.sha256) {
            digits.copy_from_slice(&[digit(byte >> 4), digit(byte & 15)]);
        }
        text
    }
}
