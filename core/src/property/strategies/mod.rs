//! Strategies for valid parameters and states, the seams of the ranges more often than chance would have them.
//!
//! Everything shrinks to what is simple: fewer discs, coordinates and numbers towards the lower ends of their ranges,
//! choices towards the first one.
//!
//! ```
//! use meniscus_core::property::{Tolerance, forces, kernels, strategies};
//! use proptest::prelude::*;
//!
//! proptest! {
//!     # #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]
//!     // In your tests: #[test]
//!     fn masses_and_momentum((parameters, discs) in strategies::system(16, 1..20)) {
//!         let mut kernel = kernels::forces(&parameters).unwrap();
//!         prop_assert_eq!(kernel(&discs).len(), discs.len());
//!     }
//! }
//! masses_and_momentum();
//! ```

mod parameters;
mod states;

pub use parameters::parameters;
pub use states::{
    clustered, coinciding, coordinate, lattice, position, scattered, separated, separation, states, strength,
    with_strengths,
};

use super::discs::Discs;
use crate::parameters::Parameters;
use crate::torus::Torus;
use proptest::collection::SizeRange;
use proptest::prelude::*;

/// Valid [`parameters`] on a mesh of at most `largest_grid` nodes a side, with [`states`] in their box.
pub fn system(
    largest_grid: usize,
    count: impl Into<SizeRange>,
) -> impl Strategy<Value = (Parameters, Discs)> {
    let count = count.into();
    // Valid parameters have a valid side: nothing is filtered out.
    let in_box = |parameters: Parameters| Some((parameters, Torus::new(parameters.side).ok()?));
    parameters(largest_grid)
        .prop_filter_map("a side", in_box)
        .prop_flat_map(move |(parameters, torus)| (Just(parameters), states(torus, count.clone())))
}
