//! The property kit: the core's kernels and the references keep every invariant, and every invariant catches a fault
//! planted for it.

mod core_kernels;
mod planted_faults;
mod references;
mod valid_states;

use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Parameters};
use meniscus_core::property::Tolerance;
use meniscus_core::torus::Torus;
use meniscus_tests::long_tests;
use meniscus_tests::tolerances::{FORCE_QUANTUM, MESH_NET_FORCE, SELF_FORCE};
use proptest::prelude::*;
use std::collections::HashSet;
use std::hash::Hash;

const SIDE: f64 = 64.0;

/// Attraction by the mesh alone, its most accurate scheme; h = 1 R0.
const ATTRACTION: Parameters = Parameters {
    side: SIDE,
    grid: 64,
    capillary_length: 20.0,
    repulsion: false,
    influence: Influence::Continuum,
    gradient: Gradient::Difference4,
    ..Parameters::DEFAULT
};

/// The same split, α·h = 0.45.
const SPLIT: Parameters = Parameters {
    method: Method::P3m,
    influence: Influence::Optimal,
    gradient: Gradient::Spectral,
    assignment: Assignment::Order5,
    splitting: 0.45,
    cutoff: 10.0,
    ..ATTRACTION
};

/// Repulsion alone.
const REPULSION: Parameters =
    Parameters { side: SIDE, grid: 16, capillary_strength: 0.0, ..Parameters::DEFAULT };

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

fn cases(cases: u32) -> ProptestConfig {
    let cases = if long_tests() { 50 * cases } else { cases };
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// Rounding of the mesh forces in binary32, which follow the largest field, about V0/h for each disc.
fn mesh_rounding(parameters: &Parameters, discs: usize) -> Tolerance {
    let scale = parameters.capillary_strength * parameters.grid as f64 / parameters.side;
    let absolute = SELF_FORCE * scale * discs as f64 + 2.0 * FORCE_QUANTUM;
    Tolerance { relative: MESH_NET_FORCE, absolute }
}

/// How many different things `of` says of them.
fn choices<V, T: Hash + Eq>(values: &[V], of: impl Fn(&V) -> T) -> usize {
    values.iter().map(of).collect::<HashSet<T>>().len()
}
