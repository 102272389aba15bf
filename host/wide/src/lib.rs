//! The core's stages in wide lanes and threads, with the same bits.
//!
//! The core ([`meniscus_core`]) says what every stage computes. Here each is done again for many discs, lines or pairs at
//! a time: the same operations of binary32 in the same order for each of them, and sums of integers, so that neither the
//! width of the lanes nor the number of threads can show.
//!
//! All unsafe code is in [`lanes`].

#![deny(unsafe_code)]

pub mod assignment;
pub mod division;
pub mod lanes;
pub mod mesh;
pub mod motion;
pub mod neighbours;
pub mod order;
pub mod pairs;
mod pieces;
pub mod stages;
pub mod transform;
