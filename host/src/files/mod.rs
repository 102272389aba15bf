//! Files that hold positions, and how files are written.
//!
//! - [`csv`]: a table with columns `x`, `y` and perhaps `id`
//! - [`extended_xyz`]: trajectories for OVITO and ASE
//! - [`state`]: the canonical bytes of a state
//! - [`atomic`]: a file is there whole or not at all
//!
//! ```
//! use meniscus::files::{csv, read_positions};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("final.csv");
//! let torus = Torus::new(500.0).unwrap();
//! let positions = [Position::from_bits(1, 2), Position::from_bits(u32::MAX, 0)];
//! csv::write(&path, &torus, &positions).unwrap();
//! assert_eq!(read_positions(&path, &torus).unwrap().positions, positions);
//! ```

pub mod atomic;
pub mod csv;
mod error;
pub mod extended_xyz;
mod identities;
mod lines;
pub mod state;

pub use error::{FileError, FormatError};

use extended_xyz::FrameChoice;
use meniscus_core::torus::{Position, Torus};
use state::State;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Where the discs of a file are, and when.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InitialState {
    /// Positions in id order.
    pub positions: Vec<Position>,
    /// Steps made; 0 where the file does not say.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D; 0 where the file does not say.
    pub time: u64,
}

/// Reads the positions in the file at `path`, in the box `torus`.
///
/// The ending of its name tells the format: `.csv`, `.xyz` or `.extxyz` (of which the last frame is read),
/// `.state`.
///
/// # Errors
/// [`FileError::Ending`] for any other ending, [`FileError::Read`] when the file cannot be read or is not
/// what its ending says.
pub fn read_positions(path: &Path, torus: &Torus) -> Result<InitialState, FileError> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    match ending {
        "csv" => csv::read(path, torus).map(|positions| InitialState { positions, step: 0, time: 0 }),
        "xyz" | "extxyz" => extended_xyz::read(path, torus, FrameChoice::Last),
        "state" => {
            State::read(path).map(|State { step, time, positions }| InitialState { positions, step, time })
        }
        _ => Err(FileError::Ending { path: path.to_owned() }),
    }
}

/// Opens the file at `path` and hands it to `parse`, whose complaint then carries the path.
fn read_with<T>(
    path: &Path,
    parse: impl FnOnce(BufReader<File>) -> Result<T, FormatError>,
) -> Result<T, FileError> {
    File::open(path)
        .map_err(FormatError::Input)
        .and_then(|file| parse(BufReader::new(file)))
        .map_err(|problem| FileError::Read { path: path.to_owned(), problem })
}
