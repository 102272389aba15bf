//! What is measured on a state. Nothing here can change the state.
//!
//! - [`neighbours`]: which discs are near a place; the closest pair
//! - [`clusters`]: the clusters of Figs. 3 to 6
//! - [`energy`]: the potential energy

pub mod clusters;
pub mod energy;
pub mod neighbours;
