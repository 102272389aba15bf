//! The canonical bytes of a state and their digest.
//!
//! All little-endian: magic `MENISCUS` (8 bytes), format version (u32), number of discs n (u32), step (u64), time
//! (u64, unit 2⁻⁴⁰ R0²/D), then the x of disc 0 … n−1 (u32 each, unit L·2⁻³²), then the y likewise. Optional parts follow
//! as tagged sections: a tag (4 bytes), the number of bytes in the section (u64), the section. There are two, in this
//! order. [`STRENGTHS_TAG`]: the capillary strengths of disc 0 … n−1 (i32 each, unit 2⁻²⁰), written unless all of them
//! are 1. [`HELD_TAG`]: the mesh forces held over several steps ([`crate::refresh`]), of disc 0 … n−1 in turn its reference
//! x and y (u32 each, unit L·2⁻³²) and the force along x and y (i64 each, unit 2⁻²⁴ kBT/R0), written if a run holds any.
//! Storage order, capacity and box crossings are not in it.
//!
//! The digest is SHA-256 over these bytes: `sha256sum` of a state file prints the same.
//!
//! ```
//! use meniscus_core::digest::State;
//! use meniscus_core::torus::Fraction;
//!
//! let (x, y) = ([Fraction::from_bits(1)], [Fraction::from_bits(2)]);
//! let state = State { slots: &[0], x: &x, y: &y, ..State::default() };
//! let digest = state.digest();
//! assert_eq!(digest.length, 40);
//! assert_eq!(format!("{digest}").len(), 64);
//! ```

use crate::refresh::{HeldForce, HeldForces};
use crate::torus::Fraction;
use core::fmt;
use sha2::{Digest as _, Sha256};

/// The first bytes of a state.
pub const MAGIC: [u8; 8] = *b"MENISCUS";

/// Version of the layout of the bytes.
pub const FORMAT_VERSION: u32 = 1;

/// The tag of the section that holds capillary strengths.
pub const STRENGTHS_TAG: [u8; 4] = *b"STRE";

/// The tag of the section that holds held mesh forces.
pub const HELD_TAG: [u8; 4] = *b"HELD";

/// What a state's bytes are made of.
#[derive(Clone, Copy, Debug, Default)]
pub struct State<'a> {
    /// Steps done.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
    /// Where the disc of each id is stored: a permutation of 0 … n−1.
    pub slots: &'a [u32],
    /// x of each slot.
    pub x: &'a [Fraction],
    /// y of each slot.
    pub y: &'a [Fraction],
    /// Capillary strength of each slot, unit 2⁻²⁰; empty if all of them are 1.
    pub strengths: &'a [i32],
    /// Mesh forces that are held.
    pub held: HeldForces<'a>,
}

/// Length and SHA-256 of a byte string. Displays as 64 hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest {
    /// Number of bytes.
    pub length: u64,
    /// SHA-256 of the bytes.
    pub sha256: [u8; 32],
}

/// The digest of a state as a whole and of its parts, so that a difference names the culprit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateDigest {
    /// Step.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
    /// Of the canonical bytes.
    pub state: Digest,
    /// Of the section that holds x.
    pub x: Digest,
    /// Of the section that holds y.
    pub y: Digest,
}

impl fmt::Display for Digest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.sha256.iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
    }
}

impl State<'_> {
    /// Hands the canonical bytes to `sink`, piece by piece.
    pub fn write(&self, mut sink: impl FnMut(&[u8])) {
        sink(&MAGIC);
        sink(&FORMAT_VERSION.to_le_bytes());
        sink(&(self.slots.len() as u32).to_le_bytes());
        sink(&self.step.to_le_bytes());
        sink(&self.time.to_le_bytes());
        self.write_section(self.x, &mut sink);
        self.write_section(self.y, &mut sink);
        self.write_strengths(&mut sink);
        self.write_held(&mut sink);
    }

    /// Hands the section of the strengths to `sink`, if there is one.
    fn write_strengths(&self, mut sink: impl FnMut(&[u8])) {
        if self.strengths.is_empty() {
            return;
        }
        sink(&STRENGTHS_TAG);
        sink(&(4 * self.slots.len() as u64).to_le_bytes());
        for strength in self.slots.iter().filter_map(|&slot| self.strengths.get(slot as usize)) {
            sink(&strength.to_le_bytes());
        }
    }

    /// Hands the section of the held forces to `sink`, if there is one.
    fn write_held(&self, mut sink: impl FnMut(&[u8])) {
        if self.held.is_empty() {
            return;
        }
        sink(&HELD_TAG);
        sink(&(HeldForce::LENGTH as u64 * self.slots.len() as u64).to_le_bytes());
        for held in self.slots.iter().filter_map(|&slot| self.held.at(slot as usize)) {
            sink(&held.to_bytes());
        }
    }

    /// Hands one coordinate of the discs in the order of their ids to `sink`.
    fn write_section(&self, coordinates: &[Fraction], mut sink: impl FnMut(&[u8])) {
        for coordinate in self.slots.iter().filter_map(|&slot| coordinates.get(slot as usize)) {
            sink(&coordinate.to_bits().to_le_bytes());
        }
    }

    /// Length and SHA-256 of the canonical bytes.
    #[must_use]
    pub fn digest(&self) -> Digest {
        digest_of(|sink| self.write(sink))
    }

    /// The digest of the whole and of each part.
    #[must_use]
    pub fn digest_by_field(&self) -> StateDigest {
        StateDigest {
            step: self.step,
            time: self.time,
            state: self.digest(),
            x: digest_of(|sink| self.write_section(self.x, sink)),
            y: digest_of(|sink| self.write_section(self.y, sink)),
        }
    }
}

/// Length and SHA-256 of what `write` hands to its sink.
fn digest_of(write: impl FnOnce(&mut dyn FnMut(&[u8]))) -> Digest {
    let (mut hash, mut length) = (Sha256::new(), 0);
    write(&mut |bytes| {
        hash.update(bytes);
        length += bytes.len() as u64;
    });
    Digest { length, sha256: hash.finalize().into() }
}
