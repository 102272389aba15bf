//! Minkowski functionals of the domain where a density exceeds a threshold (Eqs. 25 to 29, Figs. 7 to 11).
//!
//! In: a [`Density`] and a threshold of the same unit (R0⁻² for discs; the paper's is 0.14 ρ_m, see
//! [`CLOSE_PACKING`](super::density::CLOSE_PACKING)). Out: the domain's area M0 in R0², the length M1 of its boundary in
//! R0, and its Euler characteristic M2.
//!
//! - [`pixels`]: the domain is made of the grid's cells, as in the paper. A disc's boundary comes out 4/π too long.
//! - [`contours`]: its boundary is interpolated between the nodes (marching squares).
//!
//! The Euler characteristic is the number of clusters minus the number of holes where the domain does not reach around the
//! box. On the torus it is defined for every domain as vertices − edges + faces of any division of the domain into
//! polygons; so a stripe around the box has 0, as an annulus has, and so has the whole box. A domain and its complement
//! have the same boundary and Euler characteristics of opposite sign (as pixels if the complement's cells do not connect at
//! corners where the domain's do).
//!
//! ```
//! use meniscus::observables::density::Density;
//! use meniscus::observables::minkowski::{by_contours, by_pixels};
//! use meniscus_core::torus::Torus;
//!
//! // One node of 8 × 8 exceeds the threshold, in a box where nodes are 2 R0 apart.
//! let torus = Torus::new(16.0).unwrap();
//! let mut values = vec![0.0; 64];
//! values[27] = 1.0;
//! let density = Density::from_values(&torus, values).unwrap();
//!
//! let square = by_pixels(&density, 0.5);
//! assert_eq!((square.area, square.length, square.euler), (4.0, 8.0, 1));
//! let diamond = by_contours(&density, 0.5);
//! assert_eq!((diamond.area, diamond.euler), (2.0, 1));
//! ```

pub mod contours;
pub mod pixels;

pub use contours::by_contours;
pub use pixels::by_pixels;

use super::density::Density;
use core::f64::consts::PI;

/// The Minkowski functionals of a domain of the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Minkowski {
    /// Area M0, R0² (Eq. 25).
    pub area: f64,
    /// Length M1 of the boundary, R0 (Eq. 26).
    pub length: f64,
    /// Euler characteristic M2 (Eqs. 27 and 28).
    pub euler: i64,
}

impl Minkowski {
    /// The shape factor φ = M1²/(4π M0 M2): 1 for equal discs, more for equal clusters of any other shape, less for discs
    /// of unequal radii.
    ///
    /// Negative where holes outnumber clusters. None if the area or the Euler characteristic is 0.
    #[must_use]
    pub fn shape(&self) -> Option<f64> {
        let discs = 4.0 * PI * self.area * self.euler as f64;
        (discs != 0.0).then(|| self.length * self.length / discs)
    }
}
