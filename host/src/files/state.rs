//! The canonical bytes of a state, and files that hold them (`*.state`).
//!
//! Everything is little-endian and unsigned:
//!
//! | Bytes | What |
//! |---|---|
//! | 8 | `MENISCUS` |
//! | 4 | version of the format, 1 |
//! | 4 | number of discs n |
//! | 8 | steps made |
//! | 8 | time, unit 2⁻⁴⁰ R0²/D |
//! | 4 n | x of disc 0, 1, … n − 1, unit L·2⁻³² |
//! | 4 n | y of the same |
//!
//! then, unless all capillary strengths are 1, a section of them:
//!
//! | Bytes | What |
//! |---|---|
//! | 4 | `STRE` |
//! | 8 | number of bytes that follow, 4 n |
//! | 4 n | strength of disc 0, 1, … n − 1, signed, unit 2⁻²⁰ |
//!
//! The SHA-256 of a file is the digest of its state.
//!
//! ```
//! use meniscus::files::state::State;
//! use meniscus_core::torus::Position;
//!
//! let positions = vec![Position::from_bits(1, 2)];
//! let state = State { step: 7, time: 1 << 40, positions, strengths: None };
//! let bytes = state.to_bytes();
//! assert_eq!(bytes.len(), 32 + 8);
//! assert_eq!(State::from_bytes(&bytes).unwrap(), state);
//! ```

use super::atomic::write_atomically;
use super::{FileError, FormatError, read_with};
use crate::strengths;
use meniscus_core::digest::{self, FORMAT_VERSION, MAGIC, STRENGTHS_TAG};
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, LARGEST_STRENGTH};
use meniscus_core::torus::{Fraction, Position};
use std::io::Read;
use std::path::Path;

/// Length of all that stands before the coordinates, bytes.
pub const HEADER_LENGTH: usize = 32;

/// Length of the coordinates of one disc, bytes.
pub const DISC_LENGTH: usize = 8;

/// Length of what stands before the strengths, bytes.
const TAG_LENGTH: u64 = 12;

/// Length of the strength of one disc, bytes.
const STRENGTH_LENGTH: u64 = 4;

/// A state: positions, and when.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Steps made.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
    /// Positions in id order, at most 2³² − 1.
    pub positions: Vec<Position>,
    /// Capillary strengths in id order, unit 2⁻²⁰, as many as positions; None if nothing is said of them.
    pub strengths: Option<Vec<i32>>,
}

/// Why bytes are no state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// They do not begin with `MENISCUS`.
    #[error("not a state file: it does not begin with MENISCUS")]
    Magic,
    /// A version of the format that is not known.
    #[error(
        "the state has format version {found}, this program reads {FORMAT_VERSION}: use the program that wrote it"
    )]
    Version {
        /// The version found.
        found: u32,
    },
    /// Fewer bytes than the number of discs asks for.
    #[error("the state is cut off: {found} bytes of {expected}")]
    Truncated {
        /// Bytes there are.
        found: u64,
        /// Bytes there should be.
        expected: u64,
    },
    /// More discs than a run can have.
    #[error("the state has {found} discs, at most {LARGEST_PARTICLE_COUNT} are accepted")]
    Count {
        /// Number of discs in the header.
        found: u32,
    },
    /// A section of strengths of another length than the number of discs asks for.
    #[error("the state has {found} bytes of strengths, expected {expected}")]
    Strengths {
        /// Length in the section's head.
        found: u64,
        /// Length of the strengths of all discs.
        expected: u64,
    },
    /// A strength that no disc can have.
    #[error("the strength of disc {id} is {}, its modulus may be at most {LARGEST_STRENGTH}", strengths::to_number(*.strength))]
    Strength {
        /// The disc.
        id: u32,
        /// Its strength, unit 2⁻²⁰.
        strength: i32,
    },
    /// A section of strengths that are all 1: a state is then without it.
    #[error("the state has a section of strengths that are all 1: leave it out")]
    Ones,
    /// More bytes than the number of discs asks for.
    #[error("the state is followed by other bytes: it ends after {expected}")]
    Trailing {
        /// Bytes there should be.
        expected: u64,
    },
}

impl State {
    /// These positions at step 0 and time 0.
    #[must_use]
    pub fn at_start(positions: Vec<Position>) -> Self {
        Self { positions, ..Self::default() }
    }

    /// The canonical bytes, as the core writes them.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let slots: Vec<u32> = (0..).take(self.positions.len()).collect();
        let x: Vec<Fraction> = self.positions.iter().map(|position| position.x).collect();
        let y: Vec<Fraction> = self.positions.iter().map(|position| position.y).collect();
        let strengths = self.strengths.as_deref().filter(|strengths| !strengths::all_one(strengths));
        let strengths = strengths.unwrap_or_default();
        let state =
            digest::State { step: self.step, time: self.time, slots: &slots, x: &x, y: &y, strengths };
        let mut bytes = Vec::with_capacity(HEADER_LENGTH + DISC_LENGTH * self.positions.len());
        state.write(|part| bytes.extend_from_slice(part));
        bytes
    }

    /// The state whose canonical bytes these are.
    ///
    /// # Errors
    /// [`StateError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, StateError> {
        let (header, rest) = Header::split(bytes)?;
        let expected = header.length();
        let Some((coordinates, section)) = rest.split_at_checked(expected as usize - HEADER_LENGTH) else {
            return Err(StateError::Truncated { found: bytes.len() as u64, expected });
        };
        let strengths = read_strengths(&header, section)?;
        let (numbers, _) = coordinates.as_chunks::<4>();
        let (along_x, along_y) = numbers.split_at(numbers.len() / 2);
        let position = |(x, y): (&[u8; 4], &[u8; 4])| {
            Position::from_bits(u32::from_le_bytes(*x), u32::from_le_bytes(*y))
        };
        let positions = along_x.iter().zip(along_y).map(position).collect();
        Ok(Self { step: header.step, time: header.time, positions, strengths })
    }

    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`FileError::Read`].
    pub fn read(path: &Path) -> Result<Self, FileError> {
        read_with(path, |mut input| {
            let mut bytes = Vec::new();
            input.by_ref().take(HEADER_LENGTH as u64).read_to_end(&mut bytes).map_err(FormatError::Input)?;
            let (header, _) = Header::split(&bytes)?;
            // One byte more than there can be is enough to know that there are too many.
            let rest = header.length_with_strengths() - HEADER_LENGTH as u64 + 1;
            input.take(rest).read_to_end(&mut bytes).map_err(FormatError::Input)?;
            Ok(Self::from_bytes(&bytes)?)
        })
    }

    /// Writes the canonical bytes to the file at `path`, whole or not at all.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        write_atomically(path, &self.to_bytes())
    }
}

/// The strengths in what follows the coordinates; None if nothing does.
fn read_strengths(header: &Header, section: &[u8]) -> Result<Option<Vec<i32>>, StateError> {
    if section.is_empty() {
        return Ok(None);
    }
    let found = header.length() + section.len() as u64;
    let expected = header.length_with_strengths();
    let tag = STRENGTHS_TAG.len().min(section.len());
    if section[..tag] != STRENGTHS_TAG[..tag] {
        return Err(StateError::Trailing { expected: header.length() });
    }
    let truncated = StateError::Truncated { found, expected };
    let (_, rest) = section.split_first_chunk::<4>().ok_or(truncated)?;
    let (length, rest) = rest.split_first_chunk().ok_or(truncated)?;
    let (length, right) = (u64::from_le_bytes(*length), STRENGTH_LENGTH * u64::from(header.count));
    if length != right {
        return Err(StateError::Strengths { found: length, expected: right });
    }
    if found < expected {
        return Err(truncated);
    }
    if found > expected {
        return Err(StateError::Trailing { expected });
    }
    let strengths: Vec<i32> = rest.as_chunks().0.iter().map(|bytes| i32::from_le_bytes(*bytes)).collect();
    if let Some((id, &strength)) =
        (0..).zip(&strengths).find(|(_, strength)| strengths::to_number(**strength).abs() > LARGEST_STRENGTH)
    {
        return Err(StateError::Strength { id, strength });
    }
    if strengths::all_one(&strengths) {
        return Err(StateError::Ones);
    }
    Ok(Some(strengths))
}

/// What stands before the coordinates.
struct Header {
    count: u32,
    step: u64,
    time: u64,
}

impl Header {
    /// The header, and the bytes after it.
    fn split(bytes: &[u8]) -> Result<(Self, &[u8]), StateError> {
        let found = bytes.len() as u64;
        let start = MAGIC.len().min(bytes.len());
        if bytes[..start] != MAGIC[..start] || bytes.is_empty() {
            return Err(StateError::Magic);
        }
        let truncated = StateError::Truncated { found, expected: HEADER_LENGTH as u64 };
        let (_, rest) = bytes.split_first_chunk::<8>().ok_or(truncated)?;
        let (version, rest) = rest.split_first_chunk().ok_or(truncated)?;
        let version = u32::from_le_bytes(*version);
        if version != FORMAT_VERSION {
            return Err(StateError::Version { found: version });
        }
        let (count, rest) = rest.split_first_chunk().ok_or(truncated)?;
        let (step, rest) = rest.split_first_chunk().ok_or(truncated)?;
        let (time, rest) = rest.split_first_chunk().ok_or(truncated)?;
        let count = u32::from_le_bytes(*count);
        if count as usize > LARGEST_PARTICLE_COUNT {
            return Err(StateError::Count { found: count });
        }
        Ok((Self { count, step: u64::from_le_bytes(*step), time: u64::from_le_bytes(*time) }, rest))
    }

    /// Length of the whole state without strengths, bytes.
    fn length(&self) -> u64 {
        HEADER_LENGTH as u64 + DISC_LENGTH as u64 * u64::from(self.count)
    }

    /// Length of the whole state with strengths, bytes.
    fn length_with_strengths(&self) -> u64 {
        self.length() + TAG_LENGTH + STRENGTH_LENGTH * u64::from(self.count)
    }
}
