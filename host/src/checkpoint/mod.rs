//! Checkpoints: all that a run needs to go on bit for bit, in one file whose every damage is found.
//!
//! A checkpoint holds the configuration as run, the exact state, how often each disc has crossed the box, and how far
//! the run's other files had come. [`store`] keeps two generations of them in a run's directory.
//!
//! # Format, version 1
//!
//! Everything is little-endian; numbers are unsigned unless said otherwise. First a header, whose shape is the same in
//! every version:
//!
//! | Bytes | What |
//! |---|---|
//! | 8 | `MENISCHK` |
//! | 4 | version of the format, 1 |
//! | 8 | length of the whole file, bytes |
//! | 4 | checksum: CRC-32 of the 20 bytes before |
//!
//! then five sections in this order, each of the shape
//!
//! | Bytes | What |
//! |---|---|
//! | 4 | tag |
//! | 8 | length of the contents, bytes |
//! | as said | contents |
//! | 4 | checksum: CRC-32 of the checksum before (the header's or the previous section's, 4 bytes), the tag, the length and the contents |
//!
//! | Tag | Contents |
//! |---|---|
//! | `CONF` | the configuration, TOML, in UTF-8 |
//! | `STAT` | the canonical bytes of the state, see [`files::state`](crate::files::state) |
//! | `CROS` | 8 for each disc 0, 1, … n − 1 of the state: how often it has crossed the box along x and along y, 4 each, signed |
//! | `PROG` | how far the run's other files had come, UTF-8 text whose meaning is [`run`](crate::run)'s |
//! | `END.` | none: the mark of the end, where the file must end |
//!
//! The CRC-32 is that of zip and PNG (polynomial 04C11DB7 reflected, all ones at first and inverted at last). It finds
//! every change of up to 32 bits next to each other, and of others all but one in 2³². A section's checksum covers the
//! one before, so sections left out, doubled, exchanged or taken from another checkpoint do not fit. Contents have one
//! encoding: what decodes, encodes to the same bytes.
//!
//! ```
//! use meniscus::checkpoint::{Checkpoint, store};
//! use meniscus::files::state::State;
//! use meniscus_core::torus::Position;
//!
//! let state = State { step: 7, positions: vec![Position::from_bits(1, 2)], ..State::default() };
//! let checkpoint = Checkpoint {
//!     configuration: "version = 1\n".to_owned(),
//!     state: state.to_bytes(),
//!     crossings: vec![[0, -1]],
//!     progress: String::new(),
//! };
//! let mut bytes = checkpoint.encode();
//! assert_eq!(Checkpoint::decode(&bytes).unwrap(), checkpoint);
//! bytes[30] ^= 1;
//! assert!(Checkpoint::decode(&bytes).is_err());
//!
//! let folder = tempfile::tempdir().unwrap();
//! store::store(folder.path(), &checkpoint).unwrap();
//! assert_eq!(store::latest(folder.path()).unwrap().checkpoint, checkpoint);
//! ```

mod checksum;
mod decode;
mod encode;
mod error;
pub mod store;

pub use error::CheckpointError;

/// Magic bytes that begin a checkpoint.
pub const MAGIC: [u8; 8] = *b"MENISCHK";

/// Version of the format that is written and read.
pub const FORMAT_VERSION: u32 = 1;

/// Length of the header, bytes.
pub const HEADER_LENGTH: usize = 24;

/// Length of what a section has besides its contents, bytes.
pub const FRAME_LENGTH: usize = 16;

/// Longest text accepted, bytes.
pub const LONGEST_TEXT: u64 = 1 << 30;

/// A section of a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// The configuration.
    Configuration,
    /// The state.
    State,
    /// Crossings of the box.
    Crossings,
    /// How far the run's other files had come.
    Progress,
    /// The mark of the end.
    End,
}

impl Section {
    /// All sections in the order of the file.
    pub const ORDER: [Self; 5] =
        [Self::Configuration, Self::State, Self::Crossings, Self::Progress, Self::End];

    /// The tag in the file.
    #[must_use]
    pub const fn tag(self) -> [u8; 4] {
        match self {
            Self::Configuration => *b"CONF",
            Self::State => *b"STAT",
            Self::Crossings => *b"CROS",
            Self::Progress => *b"PROG",
            Self::End => *b"END.",
        }
    }

    /// Its name in messages.
    const fn name(self) -> &'static str {
        match self {
            Self::Configuration => "configuration (CONF)",
            Self::State => "state (STAT)",
            Self::Crossings => "crossings (CROS)",
            Self::Progress => "progress (PROG)",
            Self::End => "end mark (END.)",
        }
    }
}

/// All that a run needs to go on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Checkpoint {
    /// The configuration as run, TOML.
    pub configuration: String,
    /// The canonical bytes of the state, with its strengths and held forces.
    pub state: Vec<u8>,
    /// How often each disc of the state, in id order, has crossed the box along x and y, boxes.
    pub crossings: Vec<[i32; 2]>,
    /// How far the run's other files had come.
    pub progress: String,
}

impl Checkpoint {
    /// The number of steps made that the state's header tells; 0 if there is no header.
    #[must_use]
    pub fn step(&self) -> u64 {
        // After magic, version and number of discs.
        self.state.get(16..).and_then(<[u8]>::first_chunk).map_or(0, |bytes| u64::from_le_bytes(*bytes))
    }
}
