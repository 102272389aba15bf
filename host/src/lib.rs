//! The std host of Meniscus.

pub mod configuration;
pub mod files;
pub mod observables;
pub mod snapshot;
pub mod start;
pub mod theory;
