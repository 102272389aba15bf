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
//! then, if the run holds mesh forces over several steps (`force.mesh_refresh`), a section of them:
//!
//! | Bytes | What |
//! |---|---|
//! | 4 | `HELD` |
//! | 8 | number of bytes that follow, 24 n |
//! | 24 n | of disc 0, 1, … n − 1 in turn: x and y where the force was computed, 4 each; force along x and y, 8 each, signed, unit 2⁻²⁴ kBT/R0 |
//!
//! The SHA-256 of a file is the digest of its state.
//!
//! ```
//! use meniscus::files::state::State;
//! use meniscus_core::torus::Position;
//!
//! let positions = vec![Position::from_bits(1, 2)];
//! let state = State { step: 7, time: 1 << 40, positions, ..State::default() };
//! let bytes = state.to_bytes();
//! assert_eq!(bytes.len(), 32 + 8);
//! assert_eq!(State::from_bytes(&bytes).unwrap(), state);
//! ```

use super::atomic::write_atomically;
use super::{FileError, FormatError, read_with};
use crate::strengths;
use meniscus_core::digest::{self, FORMAT_VERSION, HELD_TAG, MAGIC, STRENGTHS_TAG};
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, LARGEST_STRENGTH};
use meniscus_core::refresh::{HeldForce, HeldForces};
use meniscus_core::torus::{Fraction, Position};
use std::io::Read;
use std::path::Path;

/// Length of all that stands before the coordinates, bytes.
pub const HEADER_LENGTH: usize = 32;

/// Length of the coordinates of one disc, bytes.
pub const DISC_LENGTH: usize = 8;

/// Length of what stands before a section, bytes.
const TAG_LENGTH: u64 = 12;

/// Length of the strength of one disc, bytes.
const STRENGTH_LENGTH: u64 = 4;

/// Length of what is held of one disc, bytes.
const HELD_LENGTH: u64 = HeldForce::LENGTH as u64;

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
    /// Held mesh forces in id order, as many as positions; None if none are held.
    pub held: Option<Vec<HeldForce>>,
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
    /// A section of held forces of another length than the number of discs asks for.
    #[error(
        "the state has {found} bytes of held forces, expected {expected}: the file was altered; start from another state of \
         the run"
    )]
    Held {
        /// Length in the section's head.
        found: u64,
        /// Length of the held forces of all discs.
        expected: u64,
    },
    /// A held force that no mesh can exert.
    #[error(
        "the held force of disc {id} is larger than the mesh force of so many discs can be: the file was altered; start from \
         another state of the run"
    )]
    HeldForce {
        /// The disc.
        id: u32,
    },
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
        let held = Columns::of(self.held.as_deref().unwrap_or_default());
        let (step, time, held) = (self.step, self.time, held.forces());
        let state = digest::State { step, time, slots: &slots, x: &x, y: &y, strengths, held };
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
        let (strengths, held) = read_sections(&header, section)?;
        let (numbers, _) = coordinates.as_chunks::<4>();
        let (along_x, along_y) = numbers.split_at(numbers.len() / 2);
        let position = |(x, y): (&[u8; 4], &[u8; 4])| {
            Position::from_bits(u32::from_le_bytes(*x), u32::from_le_bytes(*y))
        };
        let positions = along_x.iter().zip(along_y).map(position).collect();
        Ok(Self { step: header.step, time: header.time, positions, strengths, held })
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
            let rest = header.longest() - HEADER_LENGTH as u64 + 1;
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

/// Held forces, an array for each component.
#[derive(Default)]
struct Columns {
    reference_x: Vec<Fraction>,
    reference_y: Vec<Fraction>,
    force_x: Vec<i64>,
    force_y: Vec<i64>,
}

impl Columns {
    fn of(held: &[HeldForce]) -> Self {
        let mut columns = Self::default();
        for &HeldForce { reference, force } in held {
            columns.reference_x.push(reference.x);
            columns.reference_y.push(reference.y);
            columns.force_x.push(force.0);
            columns.force_y.push(force.1);
        }
        columns
    }

    fn forces(&self) -> HeldForces<'_> {
        let Self { reference_x, reference_y, force_x, force_y } = self;
        HeldForces { reference_x, reference_y, force_x, force_y }
    }
}

/// What sections may hold.
type Sections = (Option<Vec<i32>>, Option<Vec<HeldForce>>);

/// The sections that follow the coordinates.
fn read_sections(header: &Header, bytes: &[u8]) -> Result<Sections, StateError> {
    let mut rest = Rest { bytes, begin: header.length() };
    let count = u64::from(header.count);
    let strengths = rest.section(STRENGTHS_TAG, STRENGTH_LENGTH * count, |found, expected| {
        StateError::Strengths { found, expected }
    })?;
    let strengths = strengths.map(read_strengths).transpose()?;
    // Of no disc nothing is held.
    let held = if count == 0 {
        None
    } else {
        rest.section(HELD_TAG, HELD_LENGTH * count, |found, expected| StateError::Held { found, expected })?
    };
    let held = held.map(read_held).transpose()?;
    if rest.bytes.is_empty() {
        Ok((strengths, held))
    } else {
        Err(StateError::Trailing { expected: rest.begin })
    }
}

/// Bytes not yet read, and how many were before them.
struct Rest<'a> {
    bytes: &'a [u8],
    begin: u64,
}

impl<'a> Rest<'a> {
    /// Takes the section of this tag and length; none if none or another begins here. `wrong` is the error of another
    /// length found and the one expected.
    fn section(
        &mut self,
        tag: [u8; 4],
        length: u64,
        wrong: impl Fn(u64, u64) -> StateError,
    ) -> Result<Option<&'a [u8]>, StateError> {
        let common = tag.len().min(self.bytes.len());
        if common == 0 || self.bytes[..common] != tag[..common] {
            return Ok(None);
        }
        let (found, expected) = (self.begin + self.bytes.len() as u64, self.begin + TAG_LENGTH + length);
        let truncated = StateError::Truncated { found, expected };
        let (_, rest) = self.bytes.split_first_chunk::<4>().ok_or(truncated)?;
        let (said, rest) = rest.split_first_chunk().ok_or(truncated)?;
        let said = u64::from_le_bytes(*said);
        if said != length {
            return Err(wrong(said, length));
        }
        let (section, rest) = rest.split_at_checked(length as usize).ok_or(truncated)?;
        *self = Self { bytes: rest, begin: expected };
        Ok(Some(section))
    }
}

fn read_strengths(section: &[u8]) -> Result<Vec<i32>, StateError> {
    let strengths: Vec<i32> = section.as_chunks().0.iter().map(|bytes| i32::from_le_bytes(*bytes)).collect();
    if let Some((id, &strength)) =
        (0..).zip(&strengths).find(|(_, strength)| strengths::to_number(**strength).abs() > LARGEST_STRENGTH)
    {
        return Err(StateError::Strength { id, strength });
    }
    if strengths::all_one(&strengths) {
        return Err(StateError::Ones);
    }
    Ok(strengths)
}

fn read_held(section: &[u8]) -> Result<Vec<HeldForce>, StateError> {
    let held: Vec<HeldForce> = section.as_chunks().0.iter().map(HeldForce::from_bytes).collect();
    match (0..).zip(&held).find(|(_, force)| !force.is_possible(held.len())) {
        Some((id, _)) => Err(StateError::HeldForce { id }),
        None => Ok(held),
    }
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

    /// Length of the whole state with all its sections, bytes.
    fn longest(&self) -> u64 {
        self.length() + 2 * TAG_LENGTH + (STRENGTH_LENGTH + HELD_LENGTH) * u64::from(self.count)
    }
}
