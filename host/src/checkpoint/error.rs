//! What can be wrong with a checkpoint.

use super::{FORMAT_VERSION, HEADER_LENGTH, Section};
use crate::files::state::StateError;

/// Why bytes are no checkpoint. Each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The system could not open or read the file.
    #[error("cannot be read: {0}")]
    Input(#[from] std::io::Error),
    /// It does not begin as a checkpoint does.
    #[error("not a checkpoint: it does not begin with MENISCHK")]
    Magic,
    /// The header is not as it was written.
    #[error(
        "the header (bytes 0 to {}) is damaged: found checksum {found:08x}, expected {expected:08x}",
        HEADER_LENGTH - 1
    )]
    Header {
        /// The checksum in the header.
        found: u32,
        /// The checksum of what is there.
        expected: u32,
    },
    /// Another version of the format.
    #[error(
        "the checkpoint has format version {found}, this program reads {FORMAT_VERSION}: resume with the program that \
         wrote it"
    )]
    Version {
        /// The version in the header.
        found: u32,
    },
    /// Bytes are missing at the end.
    #[error("the checkpoint is cut off: found {found} bytes, expected {expected}")]
    Truncated {
        /// Bytes there are.
        found: u64,
        /// Bytes there should be, or at least.
        expected: u64,
    },
    /// Bytes follow the end.
    #[error("the checkpoint is followed by other bytes: found {found}, expected {expected}")]
    Trailing {
        /// Bytes there are.
        found: u64,
        /// Bytes there should be.
        expected: u64,
    },
    /// A section in the place of another, or one that is not known.
    #[error(
        "byte {begin}: found a section `{}`, expected {}, as format version {FORMAT_VERSION} has it: the file is \
         damaged, or resume with the program that wrote it",
        found.escape_ascii(),
        expected.name()
    )]
    Section {
        /// Where the section begins, bytes.
        begin: u64,
        /// Its tag.
        found: [u8; 4],
        /// The section that belongs there.
        expected: Section,
    },
    /// A section longer than it can be.
    #[error("the {} from byte {begin}: found a length of {found} bytes, at most {most} are possible", section.name())]
    Length {
        /// The section.
        section: Section,
        /// Where it begins, bytes.
        begin: u64,
        /// Length of its contents as said, bytes.
        found: u64,
        /// Length that there is room for, or that such contents may have, bytes.
        most: u64,
    },
    /// A section is not as it was written.
    #[error(
        "the {} (bytes {begin} to {end}) is damaged: found checksum {found:08x}, expected {expected:08x}",
        section.name()
    )]
    Damaged {
        /// The section.
        section: Section,
        /// Its first byte.
        begin: u64,
        /// Its last byte.
        end: u64,
        /// The checksum in the file.
        found: u32,
        /// The checksum of what is there.
        expected: u32,
    },
    /// Text is not UTF-8.
    #[error("the {}: found bytes that are no UTF-8, expected text", section.name())]
    Text {
        /// The section.
        section: Section,
    },
    /// The state is none.
    #[error("the {}: {problem}", Section::State.name())]
    State {
        /// What is wrong with it.
        #[source]
        problem: StateError,
    },
    /// Crossings of another number of discs than the state has.
    #[error("the {}: found {found} bytes, expected {expected}, 8 for each disc", Section::Crossings.name())]
    Crossings {
        /// Length of the crossings, bytes.
        found: u64,
        /// Length of the crossings of all discs, bytes.
        expected: u64,
    },
}
