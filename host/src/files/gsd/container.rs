//! The container of a GSD file: a header, a list of names, and an index of chunks, each an array of numbers.
//!
//! Whatever the bytes are, reading them ends with a container whose every chunk lies inside the file, or with an
//! error, and takes no more memory than the file's length allows. (The library that writes the files asserts what is
//! checked here, and maps the file into memory, where a file cut by another program ends the process.)
//!
//! Numbers are in the byte order of the machine, as the format has it.

use super::super::FormatError;
use super::super::error::quoted;
use std::io::{Read, Seek, SeekFrom};

/// What a file begins with.
const MAGIC: u64 = 0x65df_65df_65df_65df;
/// Length of the header, bytes.
pub(super) const HEADER_LENGTH: u64 = 256;
/// Length of an entry of the index, bytes.
pub(super) const ENTRY_LENGTH: u64 = 32;
/// Unit of length of the list of names, bytes.
const NAME_LENGTH: u64 = 64;
/// Longest list of names accepted, bytes: that of as many names as there are numbers for.
const LONGEST_NAMES: u64 = NAME_LENGTH * 65536;
/// Major version of the format.
const VERSION: u32 = 2;

/// What stands in the header.
struct Header {
    index: u64,
    index_entries: u64,
    names: u64,
    names_length: u64,
    schema: String,
}

/// An entry of the index: where a chunk is, and what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    pub(super) frame: u64,
    pub(super) rows: u64,
    pub(super) location: u64,
    pub(super) columns: u32,
    pub(super) name: u16,
    pub(super) kind: u8,
}

/// Kinds of numbers that chunks hold.
pub(super) mod kind {
    pub(in super::super) const U8: u8 = 1;
    pub(in super::super) const U32: u8 = 3;
    pub(in super::super) const U64: u8 = 4;
    pub(in super::super) const I32: u8 = 7;
    pub(in super::super) const F32: u8 = 9;
    pub(in super::super) const F64: u8 = 10;

    /// Length of a number, bytes.
    pub(super) fn length(kind: u8) -> Option<u64> {
        match kind {
            1 | 5 | 11 => Some(1),
            2 | 6 => Some(2),
            3 | 7 | 9 => Some(4),
            4 | 8 | 10 => Some(8),
            _ => None,
        }
    }
}

/// A file and what is where in it.
pub(super) struct Container<R> {
    input: R,
    names: Vec<String>,
    /// In the order of frames, in a frame in that of names.
    chunks: Vec<Chunk>,
}

impl<R: Read + Seek> Container<R> {
    /// The container in `input`, all of it.
    pub(super) fn open(mut input: R) -> Result<Self, FormatError> {
        let length = input.seek(SeekFrom::End(0)).map_err(FormatError::Input)?;
        let header = Header::read(&mut input, length)?;
        if header.schema != "hoomd" {
            return Err(whole(format!("the schema {}", quoted(&header.schema)), "the schema `hoomd`"));
        }
        if header.index_entries == 0 || !fits(header.index, header.index_entries, ENTRY_LENGTH, length) {
            return Err(cut("an index"));
        }
        let names = read_names(&mut input, &header, length)?;
        let mut chunks: Vec<Chunk> = Vec::new();
        read_index(&mut input, header.index, header.index_entries, |chunk| {
            let Some(chunk) = chunk else { return Ok(false) };
            check(&chunk, names.len(), length)?;
            if chunks.last().is_some_and(|last| (last.frame, last.name) >= (chunk.frame, chunk.name)) {
                return Err(whole("an index out of order".to_owned(), "a GSD file"));
            }
            chunks.push(chunk);
            Ok(true)
        })?;
        Ok(Self { input, names, chunks })
    }

    /// What of the container in `input` belongs to the first `frames` frames, which with all that describes them are
    /// in the first `bytes` bytes. Nothing is asked of what follows. `first` is the entry of the first chunk, with
    /// which every index begins.
    pub(super) fn beginning(
        mut input: R,
        frames: u64,
        bytes: u64,
        first: [u8; ENTRY_LENGTH as usize],
    ) -> Result<Self, FormatError> {
        let header = Header::read(&mut input, bytes)?;
        let names = read_names(&mut input, &header, bytes)?;
        // An index that is full is copied to the end of the file. The header may tell of a later copy.
        let index = last_occurrence(&mut input, &first, bytes)?.ok_or_else(|| cut("an index"))?;
        let mut chunks = Vec::new();
        read_index(&mut input, index, (bytes - index) / ENTRY_LENGTH, |chunk| {
            let Some(chunk) = chunk.filter(|chunk| chunk.frame < frames) else { return Ok(false) };
            check(&chunk, names.len(), bytes)?;
            chunks.push(chunk);
            Ok(true)
        })?;
        Ok(Self { input, names, chunks })
    }

    /// The number of frames.
    pub(super) fn frames(&self) -> u64 {
        self.chunks.last().map_or(0, |chunk| chunk.frame + 1)
    }

    /// The chunks of a frame in the order in which they are in the file, each with its name.
    pub(super) fn written(&self, frame: u64) -> Vec<(&str, Chunk)> {
        let begin = self.chunks.partition_point(|chunk| chunk.frame < frame);
        let end = self.chunks.partition_point(|chunk| chunk.frame <= frame);
        let mut chunks = self.chunks.get(begin..end).unwrap_or_default().to_vec();
        chunks.sort_unstable_by_key(|chunk| chunk.location);
        let name = |chunk: &Chunk| self.names.get(usize::from(chunk.name)).map_or("", String::as_str);
        chunks.into_iter().map(|chunk| (name(&chunk), chunk)).collect()
    }

    /// The chunk of that name in a frame.
    pub(super) fn find(&self, frame: u64, name: &str) -> Option<Chunk> {
        let name = self.names.iter().position(|known| known == name)?;
        let place = self
            .chunks
            .binary_search_by_key(&(frame, name), |chunk| (chunk.frame, usize::from(chunk.name)))
            .ok()?;
        self.chunks.get(place).cloned()
    }

    /// The bytes of a chunk of this container.
    pub(super) fn bytes(&mut self, chunk: &Chunk) -> Result<Vec<u8>, FormatError> {
        self.input.seek(SeekFrom::Start(chunk.location)).map_err(FormatError::Input)?;
        let length = chunk.length().unwrap_or_default();
        let mut bytes = Vec::new();
        self.input.by_ref().take(length).read_to_end(&mut bytes).map_err(FormatError::Input)?;
        if bytes.len() as u64 == length { Ok(bytes) } else { Err(cut("a chunk")) }
    }
}

impl Header {
    fn read(input: &mut (impl Read + Seek), length: u64) -> Result<Self, FormatError> {
        let mut bytes = [0; HEADER_LENGTH as usize];
        input.seek(SeekFrom::Start(0)).map_err(FormatError::Input)?;
        let no_file = || whole("bytes of another kind".to_owned(), "a GSD file");
        if length < HEADER_LENGTH {
            return Err(no_file());
        }
        input.read_exact(&mut bytes).map_err(FormatError::Input)?;
        let u64_at = |place: usize| u64::from_ne_bytes(array(&bytes[place..]));
        let u32_at = |place: usize| u32::from_ne_bytes(array(&bytes[place..]));
        if u64_at(0) != MAGIC {
            return Err(no_file());
        }
        let version = u32_at(44);
        if version >> 16 != VERSION {
            let found = format!("version {}.{} of the GSD format", version >> 16, version & 0xFFFF);
            return Err(whole(found, "version 2: write the file anew with `gsd.fl` or this program"));
        }
        let schema = bytes[112..176].split(|&byte| byte == 0).next().unwrap_or_default();
        Ok(Self {
            index: u64_at(8),
            index_entries: u64_at(16),
            names: u64_at(24),
            names_length: u64_at(32).saturating_mul(NAME_LENGTH),
            schema: String::from_utf8_lossy(schema).into_owned(),
        })
    }
}

impl Chunk {
    /// What the bytes of an entry say; None if they are the end of the index.
    fn from_bytes(bytes: &[u8; ENTRY_LENGTH as usize]) -> Option<Self> {
        let u64_at = |place: usize| u64::from_ne_bytes(array(&bytes[place..]));
        let chunk = Self {
            frame: u64_at(0),
            rows: u64_at(8),
            location: u64_at(16),
            columns: u32::from_ne_bytes(array(&bytes[24..])),
            name: u16::from_ne_bytes(array(&bytes[28..])),
            kind: bytes[30],
        };
        (chunk.location != 0).then_some(chunk)
    }

    /// Length, bytes; None if it is more than can be.
    fn length(&self) -> Option<u64> {
        self.rows.checked_mul(u64::from(self.columns))?.checked_mul(kind::length(self.kind)?)
    }
}

/// Whether `count` things of `length` bytes each from `begin` on are within the first `end` bytes.
fn fits(begin: u64, count: u64, length: u64, end: u64) -> bool {
    count.checked_mul(length).and_then(|bytes| bytes.checked_add(begin)).is_some_and(|last| last <= end)
}

/// Refuses a chunk that is not within the first `end` bytes or has none of the `names` names.
fn check(chunk: &Chunk, names: usize, end: u64) -> Result<(), FormatError> {
    let inside = chunk.location >= HEADER_LENGTH
        && chunk.length().is_some_and(|length| fits(chunk.location, 1, length, end));
    if inside && usize::from(chunk.name) < names && chunk.frame < u64::MAX {
        Ok(())
    } else {
        Err(cut("a chunk"))
    }
}

/// The names in the order of their numbers.
fn read_names(
    input: &mut (impl Read + Seek),
    header: &Header,
    length: u64,
) -> Result<Vec<String>, FormatError> {
    if !fits(header.names, 1, header.names_length, length) || header.names_length > LONGEST_NAMES {
        return Err(cut("a list of names"));
    }
    input.seek(SeekFrom::Start(header.names)).map_err(FormatError::Input)?;
    let mut bytes = Vec::new();
    input.by_ref().take(header.names_length).read_to_end(&mut bytes).map_err(FormatError::Input)?;
    let names = bytes.split(|&byte| byte == 0).take_while(|name| !name.is_empty());
    Ok(names.take(1 << 16).map(|name| String::from_utf8_lossy(name).into_owned()).collect())
}

/// Hands at most `entries` entries of the index at `begin` to `take`, until it has enough. None is its end.
fn read_index(
    input: &mut (impl Read + Seek),
    begin: u64,
    entries: u64,
    mut take: impl FnMut(Option<Chunk>) -> Result<bool, FormatError>,
) -> Result<(), FormatError> {
    input.seek(SeekFrom::Start(begin)).map_err(FormatError::Input)?;
    let mut bytes = [0; ENTRY_LENGTH as usize];
    for _ in 0..entries {
        input.read_exact(&mut bytes).map_err(FormatError::Input)?;
        if !take(Chunk::from_bytes(&bytes))? {
            break;
        }
    }
    Ok(())
}

/// Where `sought` begins for the last time in the first `end` bytes.
fn last_occurrence(
    input: &mut (impl Read + Seek),
    sought: &[u8],
    end: u64,
) -> Result<Option<u64>, FormatError> {
    /// Bytes looked at at a time.
    const WINDOW: usize = 1 << 20;
    input.seek(SeekFrom::Start(0)).map_err(FormatError::Input)?;
    let mut input = input.take(end);
    let (mut window, mut begin, mut found) = (Vec::new(), 0_u64, None);
    loop {
        let read = input.by_ref().take(WINDOW as u64).read_to_end(&mut window).map_err(FormatError::Input)?;
        if let Some(place) = window.windows(sought.len()).rposition(|bytes| bytes == sought) {
            found = Some(begin + place as u64);
        }
        if read == 0 {
            return Ok(found);
        }
        // What begins here may end in the next window.
        let done = window.len().saturating_sub(sought.len() - 1);
        window.drain(..done);
        begin += done as u64;
    }
}

/// The first bytes of a slice, 0 where there are none.
fn array<const LENGTH: usize>(bytes: &[u8]) -> [u8; LENGTH] {
    bytes.first_chunk().copied().unwrap_or([0; LENGTH])
}

fn whole(found: String, expected: &str) -> FormatError {
    FormatError::Whole { found, expected: expected.to_owned() }
}

/// The error of a file of which a part is not where the file says.
fn cut(part: &str) -> FormatError {
    whole(format!("{part} that is not in the file"), "a whole GSD file: this one is cut off or damaged")
}
