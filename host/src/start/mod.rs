//! Initial states: where the discs are at time zero, in id order.
//!
//! - [`random`]: one disc after the other at random, none overlapping
//! - [`disc`]: the same within a circular patch
//! - [`rings`]: concentric rings
//! - [`square_lattice`], [`hexagonal_lattice`]
//! - [`file`](file()): positions from a file, perhaps with capillary strengths
//!
//! All random bits come from the seed through
//! [`StepKey`](meniscus_core::noise::StepKey), all the rest is integers, + − × ÷ √ and libm: a
//! start is the same on every machine. Random starts keep what they have when more discs are asked for:
//! the first N of N + 1 discs are those of N. Lattices and rings are not checked for overlaps:
//! [`closest_pair`](crate::observables::neighbours::closest_pair) tells.
//!
//! ```
//! use meniscus::start;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(500.0).unwrap();
//! let positions = start::random(&torus, 2500, 1).unwrap();
//! assert_eq!(positions.len(), 2500);
//! assert_eq!(positions[..100], start::random(&torus, 100, 1).unwrap());
//! ```

mod disc;
mod file;
mod lattice;
mod overlap;
mod random;
mod rings;
mod sequential;

pub use disc::disc;
pub use file::{file, settle_strengths};
pub use lattice::{hexagonal_lattice, square_lattice};
pub use overlap::{Overlap, first_overlap, overlap_line};
pub use random::random;
pub use rings::rings;
pub use sequential::{ATTEMPTS_PER_DISC, CLOSE_PACKING, SATURATION};

use crate::files::FileError;
use std::path::PathBuf;

/// Why an initial state could not be made.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// Discs of radius R0 overlap their own images in the box.
    #[error("a box of side {side} R0 does not hold one disc: make the side at least 2 R0")]
    BoxTooSmall {
        /// The side L, R0.
        side: f64,
    },
    /// More discs than fit, or than random addition finds room for.
    #[error(
        "{placed} of {wanted} discs placed after {attempts} attempts, since all would cover {coverage:.3} \
         of the area and random addition ends near {SATURATION}: take fewer discs, more area, or a lattice"
    )]
    TooDense {
        /// Number of discs asked for.
        wanted: usize,
        /// Number of discs placed.
        placed: usize,
        /// Number of places tried.
        attempts: u64,
        /// Fraction of the area that all discs would cover.
        coverage: f64,
    },
    /// A patch that is no disc inside the box.
    #[error("a patch of radius {radius} R0 was asked for: take one above 0 and at most L/2 = {largest} R0")]
    PatchRadius {
        /// The radius asked for, R0.
        radius: f64,
        /// Half the side, R0.
        largest: f64,
    },
    /// A distance between rings that is not a positive number.
    #[error("rings {spacing} R0 apart were asked for: the spacing must be a positive number")]
    RingSpacing {
        /// The spacing asked for, R0.
        spacing: f64,
    },
    /// The outermost ring reaches out of the box.
    #[error("the outermost ring has radius {radius} R0, half the box is {largest} R0: enlarge the box")]
    RingsOutside {
        /// The radius of the outermost ring, R0.
        radius: f64,
        /// Half the side, R0.
        largest: f64,
    },
    /// More discs than there are ids.
    #[error("{wanted} discs were asked for: at most 4294967295 have ids")]
    TooMany {
        /// Number of discs asked for.
        wanted: u128,
    },
    /// A file with another number of discs than the configuration.
    #[error("{} holds {found} discs, the configuration has {wanted}: make the two agree", path.display())]
    Count {
        /// The file.
        path: PathBuf,
        /// Number of discs in the file.
        found: usize,
        /// Number of discs configured.
        wanted: usize,
    },
    /// A file with other capillary strengths than the configuration.
    #[error(
        "{}: disc {id} has the strength {found}, with the strengths of the configuration {configured}: \
         leave out one of the two", path.display()
    )]
    Strength {
        /// The file.
        path: PathBuf,
        /// The first disc that differs.
        id: usize,
        /// Its strength in the file.
        found: f64,
        /// Its strength as configured.
        configured: f64,
    },
    /// The file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
}
