//! What can be wrong with a file.

use super::state::StateError;
use std::path::PathBuf;

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It could not be read.
    #[error("{}: {problem}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and where.
        problem: FormatError,
    },
    /// It could not be written.
    #[error("{}: cannot be written: {problem}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        problem: std::io::Error,
    },
    /// It has less in it than a checkpoint says that was on the disk.
    #[error("{}: found {found}, the checkpoint says that {expected} were written: the file was cut or replaced", path.display())]
    Extent {
        /// The file.
        path: PathBuf,
        /// How much is there.
        found: String,
        /// How much should be.
        expected: String,
    },
    /// Its name does not tell a format of positions.
    #[error("{}: no known ending for positions: use .csv, .state, .gsd, .xyz, .extxyz, .lammpstrj or .npz", path.display())]
    Ending {
        /// The file.
        path: PathBuf,
    },
    /// The box that its positions are in is not known.
    #[error("{}: the file does not say how large the box is: give its side, --box L", path.display())]
    Box {
        /// The file.
        path: PathBuf,
    },
}

/// Why the contents of a file were refused.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The system could not open or read it.
    #[error("cannot be read: {0}")]
    Input(std::io::Error),
    /// A value is not what its column holds.
    #[error("line {line}, column {column}: found {found}, expected {expected}")]
    Value {
        /// Number of the line, from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// The value, shortened.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// A line is not what stands at its place.
    #[error("line {line}: found {found}, expected {expected}")]
    Line {
        /// Number of the line, from 1.
        line: u64,
        /// What stands there, shortened.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// The file as a whole is not what it should be.
    #[error("found {found}, expected {expected}")]
    Whole {
        /// What was found.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// A state file is not one.
    #[error(transparent)]
    State(#[from] StateError),
}

/// Most characters of a file that a message repeats.
const MOST_QUOTED: usize = 40;

/// Text of a file as a message shows it: quoted, escaped, shortened.
pub(super) fn quoted(text: &str) -> String {
    let shown: String = text.chars().take(MOST_QUOTED).collect();
    let more = if shown.len() < text.len() { "..." } else { "" };
    format!("`{}{more}`", shown.escape_debug())
}
