//! What is measured on a state. Nothing here can change the state.
//!
//! - [`neighbours`]: which discs are near a place; the closest pair
//! - [`clusters`]: the clusters of Figs. 3 to 6
//! - [`energy`]: the potential energy
//! - [`waves`]: the waves of the box and the power of the density in them
//! - [`modes`]: density modes by shells and their growth (Fig. 2)
//! - [`structure_factor`], [`radial_distribution`]: S(k) and g(r)
//! - [`radii`]: radii of rings and shells; [`collapse_fit`]: the fit of Eq. 30 to them (Figs. 12 to 14)
//! - [`series`]: tables of observables that a run writes at their own cadence
//! - [`density`]: the number density on a grid
//! - [`minkowski`]: area, boundary and Euler characteristic of where it is high (Figs. 7 to 11)

pub mod clusters;
pub mod collapse_fit;
pub mod density;
pub mod energy;
pub mod minkowski;
pub mod modes;
pub mod neighbours;
pub mod radial_distribution;
pub mod radii;
pub mod series;
pub mod structure_factor;
pub mod waves;
