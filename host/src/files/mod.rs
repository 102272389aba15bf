//! Files that hold positions, and how files are written.
//!
//! - [`csv`]: a table with columns `x`, `y` and perhaps `id` and `strength`
//! - [`gsd`]: trajectories for gsd, freud, MDAnalysis and OVITO
//! - [`extended_xyz`]: trajectories for OVITO and ASE
//! - [`lammps_dump`]: trajectories for all that read those of LAMMPS
//! - [`npz`]: trajectories for NumPy
//! - [`state`]: the canonical bytes of a state
//! - [`trajectory`]: files to which a run appends frames, of any format
//! - [`table`]: tables with named columns, as runs and ensembles write them
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
//! csv::write(&path, &torus, &positions, &[]).unwrap();
//! assert_eq!(read_positions(&path, &torus).unwrap().positions, positions);
//! ```

pub mod atomic;
pub mod csv;
mod error;
pub mod extended_xyz;
pub(crate) mod growing;
pub mod gsd;
mod identities;
pub mod lammps_dump;
mod lines;
pub mod npz;
pub mod state;
pub mod table;
pub mod trajectory;

pub use error::{FileError, FormatError};

use extended_xyz::FrameChoice;
use meniscus_core::torus::Torus;
use state::State;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use trajectory::{Format, TrajectoryReader};

/// Reads the positions in the file at `path`, in the box `torus`.
///
/// The ending of its name tells the format: `.csv`, `.state`, or that of a trajectory, of which the last frame is read.
///
/// # Errors
/// [`FileError::Ending`] for any other ending, [`FileError::Read`] when the file cannot be read or is not
/// what its ending says, or has no disc in it.
pub fn read_positions(path: &Path, torus: &Torus) -> Result<State, FileError> {
    let state = match Format::of_path(path) {
        // A text is read twice rather than every frame of it kept.
        Some(Format::ExtendedXyz) => extended_xyz::read(path, torus, FrameChoice::Last)?,
        _ => {
            let last = TrajectoryReader::open(path, Some(torus))?.read_last()?;
            last.map(|frame| frame.state).unwrap_or_default()
        }
    };
    if state.positions.is_empty() {
        let problem = FormatError::Whole { found: "no disc".to_owned(), expected: "at least 1".to_owned() };
        return Err(FileError::Read { path: path.to_owned(), problem });
    }
    Ok(state)
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
