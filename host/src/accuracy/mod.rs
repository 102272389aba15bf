//! How exact the split capillary force is, what it costs, and which mesh, splitting and cut-off to take.
//!
//! In: a [`System`] (box, discs, strength and length of the attraction). Out: the [`reference_force`] that errors are
//! compared with, the [`estimate`] of a [`Scheme`]'s root mean square force error, its [`cost`] in nanoseconds per
//! step of a nominal machine, and the cheapest scheme for an accuracy ([`choose`]). Lengths are in R0,
//! forces in kBT/R0. Everything is a pure function of its arguments, made of + − × ÷ √ and `libm`: no clock, no random
//! numbers, so every machine chooses the same.
//!
//! The estimate is that of uncorrelated discs, the state a run starts from, relative to their root mean square force
//! ([`reference_force`], a closed form of which the terms stand there). Of random starts the measured error is 0.64 to
//! 1.13 times the estimate, see `tests/accuracy-of-the-split-force.md`. In clusters the error grows as the root of the
//! local density, but the force faster: relative to the root mean square force of the clusters themselves it is 3 to 30
//! times smaller, so that the estimate is an upper bound; relative to that of the random start it is up to 6 times
//! larger.
//!
//! Discs of unequal strengths f enter with ⟨f²⟩: both the reference force and the error are proportional to it, as the
//! mean over i of f_i² times the sum over j of f_j², so the relative estimate moves only where quanta matter.
//!
//! ```
//! use meniscus::accuracy::{Given, System, choose, estimate, reference_force};
//!
//! let table_1 = System {
//!     side: 500.0,
//!     particles: 2500,
//!     capillary_strength: 0.89,
//!     capillary_length: 270.0,
//!     mean_square_strength: 1.0,
//! };
//! assert!((reference_force(&table_1) - 0.45).abs() < 0.005);
//! let choice = choose(&table_1, 1e-3, &Given::default()).expect("an easy accuracy");
//! assert!(estimate(&table_1, &choice.scheme).relative() <= 1e-3);
//! let coarse = Given { grid: Some(32), cutoff: Some(20.0), ..Given::default() };
//! assert!(choose(&table_1, 1e-3, &coarse).is_err());
//! ```

mod choice;
mod cost;
mod mesh_error;
mod near_error;
mod reference;
mod refusal;
mod search;

pub(crate) use search::rounded_down;

pub use choice::{ACCURACY_RANGE, Choice, Given, SAFETY, choose};
pub use cost::{Cost, cost};
pub use reference::reference_force;
pub use refusal::{Refusal, Remedy};

use core::f64::consts::PI;
use meniscus_core::parameters::Assignment;
use meniscus_core::units::FORCE_UNITS;
use mesh_error::MeshError;
use near_error::NearError;

/// What attracts, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System {
    /// Side L of the periodic box, R0.
    pub side: f64,
    /// Number N of discs.
    pub particles: usize,
    /// Strength V0 of the attraction, kBT.
    pub capillary_strength: f64,
    /// Capillary length λ, R0; infinity allowed.
    pub capillary_length: f64,
    /// Mean square ⟨f²⟩ of the discs' strengths f, 1 for equal discs.
    pub mean_square_strength: f64,
}

impl System {
    /// κ = 1/λ, 1/R0.
    fn screening(&self) -> f64 {
        1.0 / self.capillary_length
    }

    /// ρ = N/L², R0⁻².
    fn density(&self) -> f64 {
        self.particles as f64 / (self.side * self.side)
    }

    /// √ρ⟨f²⟩V0, kBT/R0: what a pair's force per V0, squared and integrated over separations, is multiplied with to
    /// give the root mean square over discs.
    fn force_scale(&self) -> f64 {
        self.density().sqrt() * self.mean_square_strength * self.capillary_strength
    }
}

/// How the force is split and the far part put on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Nodes M along a side of the mesh.
    pub grid: usize,
    /// Mass assignment.
    pub assignment: Assignment,
    /// Splitting α, 1/R0.
    pub splitting: f64,
    /// Cut-off r_c of the near part, R0.
    pub cutoff: f64,
}

/// Root mean square force errors per disc, kBT/R0, of independent sources.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Of the far part on the mesh.
    pub mesh: f64,
    /// Of the near part's cut-off.
    pub near: f64,
    /// Of quanta and of binary32.
    pub rounding: f64,
    /// The force they are compared with, see [`reference_force`].
    pub reference: f64,
}

impl Estimate {
    /// All sources together, kBT/R0: the root of the sum of their squares.
    #[must_use]
    pub fn total(&self) -> f64 {
        (self.mesh * self.mesh + self.near * self.near + self.rounding * self.rounding).sqrt()
    }

    /// [`Self::total`] over the reference force; 0 if there is no force.
    #[must_use]
    pub fn relative(&self) -> f64 {
        let total = self.total();
        if total == 0.0 { 0.0 } else { total / self.reference }
    }
}

/// The error that remains when mesh and cut-off are exact, relative to the reference force. Measured with weights in
/// quanta of 2⁻²⁰ discs and binary32 transforms, in which the nearly 2·10⁻⁷ of a binary32 sum is contained.
const ROUNDING_FLOOR: f64 = 2e-6;

/// The root mean square force error of a scheme, by source.
///
/// - Mesh: Hockney and Eastwood's optimal influence function for a B-spline window and a spectral gradient leaves
///   χ², summed over the wave numbers of the mesh.
/// - Near part: the integral over what lies beyond the cut-off.
/// - Rounding: each pair in reach, πρr_c² of them in the mean, and the mesh force are rounded once to quanta q of
///   2⁻²⁴ kBT/R0, with a variance of q²/12 per component; and a measured floor of 2·10⁻⁶ of the reference force for
///   weights in quanta of 2⁻²⁰ discs and binary32.
///
/// Within a factor of 1.5 of what is measured against exact sums in a random state. All 0 without attraction.
#[must_use]
pub fn estimate(system: &System, scheme: &Scheme) -> Estimate {
    let reference = reference_force(system);
    let spacing = system.side / scheme.grid as f64;
    Estimate {
        mesh: MeshError::new(scheme.grid, scheme.assignment).evaluate(system, spacing, scheme.splitting),
        near: NearError::new(system).evaluate(scheme.splitting, scheme.cutoff),
        rounding: rounding_error(system, reference, scheme.cutoff),
        reference,
    }
}

/// The part of the error that quanta and binary32 make, kBT/R0.
fn rounding_error(system: &System, reference: f64, cutoff: f64) -> f64 {
    if system.force_scale() == 0.0 {
        return 0.0;
    }
    let quantum = 1.0 / f64::from(FORCE_UNITS);
    let roundings = PI * system.density() * cutoff * cutoff + 1.0;
    let floor = ROUNDING_FLOOR * reference;
    (roundings * quantum * quantum / 6.0 + floor * floor).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE_1: System = System {
        side: 500.0,
        particles: 2500,
        capillary_strength: 0.89,
        capillary_length: 270.0,
        mean_square_strength: 1.0,
    };

    /// M, order, αh, r_c and the measured relative root mean square error, against exact Ewald sums in random states
    /// of [`TABLE_1`].
    const MEASURED: [(usize, usize, f64, f64, f64); 8] = [
        (256, 3, 0.49, 12.0, 1.4e-3),
        (256, 4, 0.49, 12.0, 3.8e-4),
        (256, 5, 0.49, 13.0, 1.2e-4),
        (256, 5, 0.43, 15.0, 5e-5),
        (256, 5, 0.33, 22.0, 1.1e-5),
        (256, 7, 0.39, 20.0, 2.8e-6),
        (128, 3, 0.49, 24.0, 1.6e-3),
        (128, 5, 0.49, 26.0, 1.3e-4),
    ];

    #[test]
    fn estimates_are_what_was_measured() {
        for (grid, order, splitting_of_spacing, cutoff, measured) in MEASURED {
            let scheme = Scheme {
                grid,
                assignment: Assignment::ALL[order - 2],
                splitting: splitting_of_spacing * grid as f64 / TABLE_1.side,
                cutoff,
            };
            let found = estimate(&TABLE_1, &scheme);
            println!("{scheme:?}: {measured:.1e} {:.1e} {found:?}", found.relative());
            let ratio = found.relative() / measured;
            assert!(ratio < 1.5 && ratio > 1.0 / 1.5, "{scheme:?}: {:e}, not {measured:e}", found.relative());
        }
    }

    #[test]
    fn without_attraction_nothing_errs() {
        let scheme = Scheme { grid: 64, assignment: Assignment::Order5, splitting: 0.1, cutoff: 5.0 };
        for system in [
            System { capillary_strength: 0.0, ..TABLE_1 },
            System { mean_square_strength: 0.0, ..TABLE_1 },
            System { particles: 0, ..TABLE_1 },
        ] {
            assert_eq!(estimate(&system, &scheme).relative(), 0.0);
        }
    }

    #[test]
    fn quanta_show_where_the_force_is_weak() {
        let weak = System { capillary_strength: 1e-4, ..TABLE_1 };
        let scheme = Scheme { grid: 256, assignment: Assignment::Order7, splitting: 0.2, cutoff: 20.0 };
        let found = estimate(&weak, &scheme);
        // πρr_c² + 1 = 13.6 roundings of 6·10⁻⁸, variance 1/12 in each of two components.
        assert!((found.rounding / 9.0e-8 - 1.0).abs() < 0.02, "{found:?}");
        assert!(found.relative() > 1e-3);
    }
}
