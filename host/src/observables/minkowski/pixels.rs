//! Minkowski functionals by counting pixels, as in the paper.
//!
//! The domain is the union of the closed cells whose nodes exceed the threshold. So cells that touch at a corner are
//! connected (8 neighbours), and cells of the complement are connected through sides only (4 neighbours); the Euler
//! characteristic is the number of corners − sides + cells of the domain.
//!
//! In: a [`Density`] and a threshold of its unit. Out: areas in R0², lengths in R0.
//!
//! ```
//! use meniscus::observables::density::Density;
//! use meniscus::observables::minkowski::by_pixels;
//! use meniscus_core::torus::Torus;
//!
//! // Two cells that touch at a corner are one cluster.
//! let torus = Torus::new(5.0).unwrap();
//! let values = (0..25).map(|node| if node == 6 || node == 12 { 1.0 } else { 0.0 }).collect();
//! let pair = by_pixels(&Density::from_values(&torus, values).unwrap(), 0.5);
//! assert_eq!((pair.area, pair.length, pair.euler), (2.0, 8.0, 1));
//! ```

use super::{Density, Minkowski};

/// The functionals of the domain of cells whose value is greater than `threshold`.
#[must_use]
pub fn by_pixels(density: &Density, threshold: f64) -> Minkowski {
    let (mut cells, mut sides, mut corners, mut boundary) = (0_i64, 0_i64, 0_i64, 0_i64);
    // Each square between nodes is the corner of four cells; counted with it are its first cell and the two sides by
    // which that cell meets the next ones.
    for values in density.squares() {
        let [here, right, across, above] = values.map(|value| value > threshold);
        cells += i64::from(here);
        sides += i64::from(here || right) + i64::from(here || above);
        corners += i64::from(here || right || across || above);
        boundary += i64::from(here != right) + i64::from(here != above);
    }
    let spacing = density.spacing();
    Minkowski {
        area: cells as f64 * spacing * spacing,
        length: boundary as f64 * spacing,
        euler: corners - sides + cells,
    }
}
