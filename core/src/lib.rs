//! The core of Meniscus: Brownian dynamics of discs at a fluid interface, with the same bits everywhere.
//!
//! Discs at a fluid interface attract each other over long range (capillary attraction, a screened gravity in two
//! dimensions) and repel at contact. This crate moves them: `no_std`, no allocation, no unsafe code, no input or
//! output, no clock, no threads.
//!
//! Same version, same parameters, same seed: the same state bytes after every step, on every machine with IEEE 754
//! binary32 arithmetic that rounds to nearest and keeps subnormals, at any optimisation level, and for any order in
//! which discs are stored or given. Positions are fixed-point fractions of the box, every sum over discs is a sum of
//! integers, and what remains is + − × ÷ √ in one fixed order (see each module).
//!
//! A datum's way: position → [`assignment::deposit`] → [`mesh::solve`] → [`assignment::gather`] ⊕
//! [`pair_force`] over [`cells`] ⊕ [`fields`] → force → [`ermak::largest_force`] → Δt → [`noise`] → position.
//! [`dynamics`] composes the [`stages`] over borrowed slices, [`engine::Engine`] owns the arrays.
//!
//! Units are R0 (disc radius), kBT and R0²/D throughout; equation numbers are those of Bleibel, Dietrich, Domínguez
//! and Oettel, *Collective dynamics of colloids at fluid interfaces* (2011).
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "proptest")]
extern crate std;

pub mod assignment;
pub mod cells;
pub mod crowding;
pub mod digest;
pub mod dynamics;
pub mod engine;
pub mod environment;
pub mod ermak;
pub mod fields;
pub mod forces;
pub mod grid;
pub mod influence;
pub mod memory;
pub mod mesh;
pub mod near_part;
pub mod noise;
pub mod optimal;
pub mod pair_force;
pub mod parameters;
#[cfg(feature = "proptest")]
pub mod property;
pub mod refresh;
pub mod repulsion;
pub mod stages;
pub mod stencil;
pub mod torus;
pub mod transform;
pub mod units;
