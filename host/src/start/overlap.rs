//! Discs that overlap so far where a run begins that its first steps will be short.
//!
//! Closer than [`SMALLEST_DISTANCE`] the repulsion of two discs is what it is there, some 8·10⁵ kBT/R0. The step rule
//! resolves any such pair, also discs at the same place: a step moves a disc by at most `motion.max_displacement`, and Δt is
//! as short as that takes (3·10⁻⁷ R0²/D for one pair at the default). It gives up where Δt would be below 2⁻⁴⁰ R0²/D,
//! which refuses the step; and too many discs in one place are refused before
//! ([`crowding`](meniscus_core::crowding)).
//!
//! ```
//! use meniscus::start::first_overlap;
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(100.0).unwrap();
//! let positions = [0.1, 50.0, 99.9].map(|x| Position { x: torus.fraction(x).unwrap(), ..Position::default() });
//! let overlap = first_overlap(&torus, &positions).unwrap();
//! assert_eq!(overlap.to_string(), "discs 0 and 2 are 0.2 R0 apart");
//! ```

use crate::observables::neighbours::Neighbours;
use meniscus_core::repulsion::SMALLEST_DISTANCE;
use meniscus_core::torus::{Position, Torus, UNITS};
use std::fmt;
use std::path::Path;

/// Two discs that are too close.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Their ids, the lower first.
    pub ids: [u32; 2],
    /// How far apart they are, R0.
    pub distance: f64,
}

impl fmt::Display for Overlap {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ids: [first, second], distance } = self;
        // Three digits are enough to find them.
        let distance = format!("{distance:.2e}").parse().unwrap_or(*distance);
        write!(formatter, "discs {first} and {second} are {distance} R0 apart")
    }
}

/// The first disc that is closer than [`SMALLEST_DISTANCE`] to one before it, and the nearest of those; ids are places in
/// `positions`.
#[must_use]
pub fn first_overlap(torus: &Torus, positions: &[Position]) -> Option<Overlap> {
    let mut before = Neighbours::with_capacity(torus, positions.len(), SMALLEST_DISTANCE);
    for (&position, id) in positions.iter().zip(0..) {
        // As none before it overlap, there are few near it.
        if let Some(nearest) = before.near(position).min_by_key(|other| (other.square, other.id)) {
            let distance = libm::sqrt(nearest.square as f64) * (torus.side() / UNITS);
            return Some(Overlap { ids: [nearest.id, id], distance });
        }
        before.insert(position);
    }
    None
}

/// What is said of a start with such discs in the file at `path`; None if there are none.
#[must_use]
pub fn overlap_line(path: &Path, torus: &Torus, positions: &[Position]) -> Option<String> {
    let overlap = first_overlap(torus, positions)?;
    Some(format!(
        "{}: {overlap}, closer than {SMALLEST_DISTANCE} R0, where their repulsion grows no further: the first steps will be \
         very short, or refused",
        path.display()
    ))
}
