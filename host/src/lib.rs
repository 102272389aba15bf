//! The std host of Meniscus: configurations, initial states, files, runs, observables, and the command line.
//!
//! The engine proper is [`meniscus_core`]; everything here feeds it or looks at it, and nothing that looks can
//! change a run. A run's way through this crate: [`configuration`] → [`start`] → [`simulation`] →
//! [`run`], which drives the [`engine`] and writes [`files`], [`observables`], [`snapshot`]s and [`golden`] records;
//! [`verification`] repeats a golden run. [`ensemble`] makes many runs, [`figures`] draws their tables, and [`theory`] says
//! what to expect.

pub mod accuracy;
mod bessel;
pub mod checkpoint;
pub mod commands;
pub mod configuration;
pub mod engine;
pub mod ensemble;
pub mod figures;
pub mod files;
pub mod golden;
pub mod memory;
pub mod observables;
pub mod reproduce;
pub mod run;
pub mod simulation;
pub mod snapshot;
pub mod start;
pub mod statistics;
pub mod strengths;
pub mod theory;
pub mod verification;
