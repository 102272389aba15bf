//! From bytes to a checkpoint, or to what is wrong with them.
//!
//! No more memory is asked for than the file is long, whatever it says.

use super::{Checkpoint, CheckpointError, FORMAT_VERSION, FRAME_LENGTH, HEADER_LENGTH, LONGEST_TEXT, MAGIC};
use super::{Section, checksum};
use crate::files::state::{self, State};
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::refresh::HeldForce;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Length of the crossings of one disc, bytes.
const CROSSINGS_LENGTH: u64 = 8;

/// Length of the crossings of as many discs as there may be, bytes.
const LONGEST_CROSSINGS: u64 = CROSSINGS_LENGTH * LARGEST_PARTICLE_COUNT as u64;

/// Length of the longest state: coordinates, strengths and held forces of as many discs as there may be, bytes.
const LONGEST_STATE: u64 =
    (state::HEADER_LENGTH + 2 * 12 + (state::DISC_LENGTH + 4 + HeldForce::LENGTH) * LARGEST_PARTICLE_COUNT)
        as u64;

impl Checkpoint {
    /// The checkpoint whose bytes these are.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn decode(bytes: &[u8]) -> Result<Self, CheckpointError> {
        Self::read_from(bytes, bytes.len() as u64)
    }

    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`CheckpointError`], without the path.
    pub fn read(path: &Path) -> Result<Self, CheckpointError> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Self::read_from(BufReader::new(file), length)
    }

    /// Reads a checkpoint of `length` bytes from `input`, and nothing after it.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn read_from(input: impl Read, length: u64) -> Result<Self, CheckpointError> {
        let mut reader = Reader { input, length, position: 0, check: 0 };
        reader.header()?;
        let configuration = reader.text(Section::Configuration)?;
        let state = reader.section(Section::State, LONGEST_STATE)?;
        let count =
            State::from_bytes(&state).map_err(|problem| CheckpointError::State { problem })?.positions.len();
        let crossings = reader.crossings(count)?;
        let progress = reader.text(Section::Progress)?;
        reader.section(Section::End, 0)?;
        if reader.position != length {
            return Err(CheckpointError::Trailing { found: length, expected: reader.position });
        }
        Ok(Self { configuration, state, crossings, progress })
    }
}

/// A checkpoint being read.
struct Reader<R> {
    input: R,
    /// Bytes there are in all.
    length: u64,
    /// Bytes read.
    position: u64,
    /// The checksum read last.
    check: u32,
}

impl<R: Read> Reader<R> {
    /// The next `length` bytes, which are not more than there are.
    fn bytes(&mut self, length: u64) -> Result<Vec<u8>, CheckpointError> {
        let mut bytes = Vec::with_capacity(length as usize);
        let found = self.input.by_ref().take(length).read_to_end(&mut bytes)? as u64;
        self.position += found;
        if found < length {
            // Somebody shortens the file that is being read.
            return Err(CheckpointError::Truncated { found: self.position, expected: self.length });
        }
        Ok(bytes)
    }

    /// The next `LENGTH` bytes.
    fn array<const LENGTH: usize>(&mut self) -> Result<[u8; LENGTH], CheckpointError> {
        let mut array = [0; LENGTH];
        let bytes = self.bytes(LENGTH as u64)?;
        array.copy_from_slice(&bytes);
        Ok(array)
    }

    /// Reads the header, whose shape every version keeps.
    fn header(&mut self) -> Result<(), CheckpointError> {
        let header = self.bytes(self.length.min(HEADER_LENGTH as u64))?;
        let begin = MAGIC.len().min(header.len());
        if header[..begin] != MAGIC[..begin] {
            return Err(CheckpointError::Magic);
        }
        let truncated = CheckpointError::Truncated { found: self.length, expected: HEADER_LENGTH as u64 };
        let Some((before, check)) = header.split_last_chunk().filter(|_| header.len() == HEADER_LENGTH)
        else {
            return Err(truncated);
        };
        let (found, expected) = (u32::from_le_bytes(*check), checksum::of_header(before));
        if found != expected {
            return Err(CheckpointError::Header { found, expected });
        }
        let (version, length) = before[MAGIC.len()..].split_first_chunk().ok_or(truncated)?;
        let version = u32::from_le_bytes(*version);
        if version != FORMAT_VERSION {
            return Err(CheckpointError::Version { found: version });
        }
        let length = length.first_chunk().map_or(0, |length| u64::from_le_bytes(*length));
        self.check = found;
        match self.length {
            found if found < length => Err(CheckpointError::Truncated { found, expected: length }),
            found if found > length => Err(CheckpointError::Trailing { found, expected: length }),
            _ => Ok(()),
        }
    }

    /// The contents of the next section, which must be `section` and at most `most` bytes long.
    fn section(&mut self, section: Section, most: u64) -> Result<Vec<u8>, CheckpointError> {
        let begin = self.position;
        let Some(room) = (self.length - begin).checked_sub(FRAME_LENGTH as u64) else {
            return Err(CheckpointError::Truncated {
                found: self.length,
                expected: begin + FRAME_LENGTH as u64,
            });
        };
        let (found, expected) = (self.array()?, section.tag());
        if found != expected {
            return Err(CheckpointError::Section { begin, found, expected: section });
        }
        let (found, most) = (u64::from_le_bytes(self.array()?), most.min(room));
        if found > most {
            return Err(CheckpointError::Length { section, begin, found, most });
        }
        let mut hasher = checksum::of_section(self.check, expected, found);
        let contents = self.bytes(found)?;
        hasher.update(&contents);
        let (found, expected) = (u32::from_le_bytes(self.array()?), hasher.finalize());
        if found != expected {
            let end = self.position - 1;
            return Err(CheckpointError::Damaged { section, begin, end, found, expected });
        }
        self.check = found;
        Ok(contents)
    }

    fn text(&mut self, section: Section) -> Result<String, CheckpointError> {
        let contents = self.section(section, LONGEST_TEXT)?;
        String::from_utf8(contents).map_err(|_| CheckpointError::Text { section })
    }

    /// The crossings of `count` discs.
    fn crossings(&mut self, count: usize) -> Result<Vec<[i32; 2]>, CheckpointError> {
        let expected = CROSSINGS_LENGTH * count as u64;
        let contents = self.section(Section::Crossings, LONGEST_CROSSINGS)?;
        if contents.len() as u64 != expected {
            return Err(CheckpointError::Crossings { found: contents.len() as u64, expected });
        }
        let (numbers, _) = contents.as_chunks::<4>();
        let (pairs, _) = numbers.as_chunks::<2>();
        Ok(pairs.iter().map(|pair| pair.map(i32::from_le_bytes)).collect())
    }
}
