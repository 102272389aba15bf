//! The core of Meniscus.
#![no_std]
#![forbid(unsafe_code)]

pub mod noise;
pub mod parameters;
pub mod repulsion;
pub mod torus;
pub mod units;
