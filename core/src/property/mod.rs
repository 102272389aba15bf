//! A kit for testing force kernels, your own or the core's: strategies for proptest that give valid parameters and
//! states, and invariants as functions that take any kernel. Feature `proptest`; it links std.
//!
//! | kernel | takes | gives | invariants |
//! |---|---|---|---|
//! | [`forces::ForceKernel`] | [`Discs`] | force on each, kBT/R0 | [`forces`] |
//! | [`forces::EnergyKernel`] | [`Discs`] | energy, kBT | [`forces::energy_consistency`] |
//! | [`forces::CoordinateKernel`] | coordinates and side, R0 | force on each, kBT/R0 | [`forces::wrap`] |
//! | [`pairs::PairKernel`] | separation of the other disc, R0 | force on the first one, kBT/R0 | [`pairs`] |
//! | [`masses::MassKernel`] | [`Discs`] | mass of each node, 2⁻²⁰ discs | [`masses`] |
//!
//! A kernel is a closure or function of that signature; it may keep its arrays between calls, and `&mut kernel` is a
//! kernel again. An invariant gives `Ok(())` or the [`Violation`]: which one, how far off, how far off it might have
//! been, and the discs at fault. A `Violation` is an error, so in a `proptest!` body, where it becomes a failed case, a
//! `?` is enough; a fuzz target unwraps it.
//!
//! # A kernel under test
//! ```
//! use meniscus_core::property::{Discs, Tolerance, forces, strategies};
//! use meniscus_core::torus::Torus;
//! use proptest::prelude::*;
//!
//! /// Springs between all discs, by minimum image.
//! fn springs(discs: &Discs) -> Vec<[f64; 2]> {
//!     let side = discs.side();
//!     let nearest = |distance: f64| distance - side * (distance / side).round();
//!     let coordinates = discs.coordinates();
//!     let pull = |[x, y]: [f64; 2]| {
//!         coordinates.iter().fold([0.0, 0.0], |sum, &[other_x, other_y]| {
//!             [sum[0] + nearest(other_x - x), sum[1] + nearest(other_y - y)]
//!         })
//!     };
//!     coordinates.iter().map(|&at| pull(at)).collect()
//! }
//!
//! proptest! {
//!     # #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
//!     // In your tests: #[test]
//!     fn springs_are_sound(discs in strategies::clustered(Torus::new(64.0).unwrap(), 0..20)) {
//!         let tolerance = Tolerance { relative: 1e-12, absolute: 1e-10 };
//!         forces::momentum(springs, &discs, tolerance)?;
//!         forces::reflections(springs, &discs, tolerance)?;
//!         forces::translation(springs, &discs, (1 << 31, 12345), tolerance)?;
//!         forces::permutation(springs, &discs, tolerance)?;
//!     }
//! }
//! springs_are_sound();
//! ```
//!
//! # Three planted bugs
//! A minimum image that forgets to wrap attracts across the whole box. Only a pair that lies across the border shows
//! it; moving the box around the discs does too:
//! ```
//! use meniscus_core::property::{Discs, Invariant, Tolerance, forces};
//! use meniscus_core::torus::Torus;
//!
//! let unwrapped = |discs: &Discs| {
//!     let at = discs.coordinates();
//!     let force = |from: [f64; 2], to: [f64; 2]| {
//!         let (x, y) = (to[0] - from[0], to[1] - from[1]); // no wrap
//!         [x / (x * x + y * y), y / (x * x + y * y)]
//!     };
//!     vec![force(at[0], at[1]), force(at[1], at[0])]
//! };
//! let discs = Discs::from_coordinates(Torus::new(64.0).unwrap(), &[[10.0, 10.0], [13.0, 14.0]]);
//! let tolerance = Tolerance::relative(1e-9);
//! // Newton's third law holds and does not see it. Moved by 53 R0 the discs are at x = 63 and 2 R0.
//! forces::momentum(unwrapped, &discs, tolerance).unwrap();
//! let violation = forces::translation(unwrapped, &discs, (53 << 26, 0), tolerance).unwrap_err();
//! assert_eq!(violation.invariant, Invariant::Translation);
//! assert_eq!(violation.at, [0, 1]);
//! ```
//!
//! A force that is rounded for each disc of a pair by itself, not once for both: where it rounds down both ways, as
//! `floor` does, momentum leaks by a quantum at almost every pair, too little to be seen in a trajectory for long:
//! ```
//! use meniscus_core::property::{Discs, Invariant, Tolerance, forces, kernels, pairs};
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(64.0).unwrap();
//! let mut pair = |[x, y]: [f64; 2]| [0.89 * x / (x * x + y * y), 0.89 * y / (x * x + y * y)];
//! let quantum = 1.0 / 16_777_216.0;
//! let mut leaking = |discs: &Discs| {
//!     let [[x, y], [other_x, other_y]] = discs.coordinates()[..] else { return vec![] };
//!     let down = |force: [f64; 2]| force.map(|component: f64| (component / quantum).floor() * quantum);
//!     vec![down(pair([other_x - x, other_y - y])), down(pair([x - other_x, y - other_y]))]
//! };
//! let discs = Discs::from_coordinates(torus, &[[10.0, 10.0], [13.0, 14.0]]);
//! let violation = forces::momentum(&mut leaking, &discs, Tolerance::EXACT).unwrap_err();
//! assert_eq!(violation.invariant, Invariant::Momentum);
//! assert!(violation.found >= quantum && violation.found < 2.0 * quantum);
//! // The same as a pair kernel: the two sides of the pair differ.
//! let mut one_side = pairs::of_forces(leaking, torus, discs.positions()[0]);
//! assert!(pairs::pair_symmetry(&mut one_side, [3.0, 4.0], Tolerance::EXACT).is_err());
//! ```
//!
//! A kernel of the wrong dimension, V0/d² instead of V0/d, and one that forgot the capillary length:
//! ```
//! use meniscus_core::property::pairs::{self, Capillary};
//! use meniscus_core::property::{Invariant, Tolerance, strategies};
//! use proptest::prelude::*;
//!
//! let capillary = Capillary { strength: 0.89, length: 30.0, side: f64::INFINITY };
//! let along = |[x, y]: [f64; 2], force: fn(f64) -> f64| {
//!     let distance = x.hypot(y);
//!     [force(distance) * x / distance, force(distance) * y / distance]
//! };
//! let in_space = |separation| along(separation, |d| 0.89 / (d * d));
//! let unscreened = |separation| along(separation, |d| 0.89 / d);
//! # let persistence = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
//! proptest!(persistence, |(near in strategies::separation(2.0..6.0), far in strategies::separation(60.0..300.0))| {
//!     let tolerance = Tolerance::relative(1e-6);
//!     // Both are central and obey Newton's third law; the limits tell them apart.
//!     let violation = pairs::far_field(in_space, capillary, near, tolerance).unwrap_err();
//!     prop_assert_eq!(violation.invariant, Invariant::FarField);
//!     pairs::far_field(unscreened, capillary, near, tolerance)?;
//!     let violation = pairs::screening(unscreened, capillary, far, tolerance).unwrap_err();
//!     prop_assert_eq!(violation.invariant, Invariant::Screening);
//! });
//! ```

mod discs;
pub mod forces;
pub mod kernels;
pub mod masses;
pub mod pairs;
pub mod strategies;
mod violation;

pub use discs::Discs;
pub use proptest;
pub use violation::{Invariant, Tolerance, Violation};
