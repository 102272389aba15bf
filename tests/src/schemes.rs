//! The two ways to sum the capillary force, for tests that have to hold with either.
//!
//! ```
//! use meniscus_core::parameters::Parameters;
//! use meniscus_tests::schemes::BOTH;
//!
//! for scheme in BOTH {
//!     let parameters = scheme.of(Parameters { side: 32.0, grid: 32, ..Parameters::PAPER });
//!     assert_eq!(parameters.validate(), Ok(()), "{}", scheme.name);
//! }
//! ```

use meniscus_core::parameters::{Assignment, Influence, Method, Parameters};

/// A way to sum the capillary force, whatever the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Its name in messages.
    pub name: &'static str,
    method: Method,
    assignment: Assignment,
    influence: Influence,
    /// α·h
    splitting_of_spacing: f64,
    /// r_c/h
    cutoff_of_spacing: f64,
}

/// The paper's: all on the mesh, by triangular shaped clouds and the spectral gradient.
pub const PAPER: Scheme = Scheme {
    name: "particle-mesh",
    method: Method::ParticleMesh,
    assignment: Parameters::PAPER.assignment,
    influence: Parameters::PAPER.influence,
    splitting_of_spacing: 0.5,
    cutoff_of_spacing: 6.0,
};

/// The split force (P³M) at order 5 with αh = 0.5 and r_c = 7h, off by 7e-5 rms.
pub const SPLIT: Scheme = Scheme {
    name: "split",
    method: Method::P3m,
    assignment: Assignment::Order5,
    influence: Influence::Optimal,
    splitting_of_spacing: 0.5,
    cutoff_of_spacing: 7.0,
};

/// Both.
pub const BOTH: [Scheme; 2] = [PAPER, SPLIT];

impl Scheme {
    /// These parameters with the force summed this way on their mesh, whatever they say of it. For the split force the
    /// mesh has to have more than 14 nodes a side.
    #[must_use]
    pub const fn of(self, parameters: Parameters) -> Parameters {
        let spacing = parameters.side / parameters.grid as f64;
        Parameters {
            method: self.method,
            splitting: self.splitting_of_spacing / spacing,
            cutoff: self.cutoff_of_spacing * spacing,
            assignment: self.assignment,
            influence: self.influence,
            gradient: Parameters::PAPER.gradient,
            ..parameters
        }
    }
}
