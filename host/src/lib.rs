//! The std host of Meniscus.

pub mod configuration;
pub mod engine;
pub mod files;
pub mod golden;
pub mod observables;
pub mod run;
pub mod simulation;
pub mod snapshot;
pub mod start;
pub mod theory;
