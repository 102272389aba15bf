//! Trajectories: files to which a run appends a frame now and then.
//!
//! What a file holds of a frame is said in the module of its format: [`extended_xyz`](super::extended_xyz).
//!
//! A run that goes on after a stop first drops what the file got after its checkpoint, so that the file ends
//! with the bytes that an uninterrupted run would have written.
//!
//! ```
//! use meniscus::files::trajectory::{Format, Frame, Trajectory};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("trajectory.xyz");
//! let format = Format::of_path(&path).unwrap();
//! let torus = Torus::new(8.0).unwrap();
//! let positions = [Position::from_bits(1 << 31, 1 << 30)];
//! let frame = |step| Frame { step, positions: &positions, ..Frame::default() };
//!
//! let mut trajectory = Trajectory::create(&path, format, &torus).unwrap();
//! trajectory.append(&frame(0)).unwrap();
//! let extent = trajectory.sync().unwrap();
//! trajectory.append(&frame(7)).unwrap();
//! drop(trajectory);
//! let whole = std::fs::read(&path).unwrap();
//!
//! let mut trajectory = Trajectory::resume(&path, format, &torus, extent).unwrap();
//! trajectory.append(&frame(7)).unwrap();
//! assert_eq!(std::fs::read(&path).unwrap(), whole);
//! ```

mod frame;
mod text;

pub use frame::{Format, Frame};

use super::FileError;
use meniscus_core::torus::Torus;
use std::path::Path;
use text::TextTrajectory;

/// How far a trajectory has grown: what a checkpoint has to remember of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// Frames in the file.
    pub frames: u64,
    /// Length of the file.
    pub bytes: u64,
}

/// An open trajectory that grows.
#[derive(Debug)]
pub struct Trajectory(TextTrajectory);

impl Trajectory {
    /// Makes the file at `path`.
    ///
    /// # Errors
    /// [`FileError::Write`], also if there is a file of this name.
    pub fn create(path: &Path, format: Format, torus: &Torus) -> Result<Self, FileError> {
        let Format::ExtendedXyz = format;
        Ok(Self(TextTrajectory::create(path, torus)?))
    }

    /// Opens the file at `path` to go on after its first `extent.frames` frames. What follows them is dropped, whatever
    /// it is.
    ///
    /// # Errors
    /// [`FileError::Extent`] if the file has less than `extent`, [`FileError::Write`] if it cannot be opened.
    pub fn resume(path: &Path, format: Format, torus: &Torus, extent: Extent) -> Result<Self, FileError> {
        let Format::ExtendedXyz = format;
        Ok(Self(TextTrajectory::resume(path, torus, extent)?))
    }

    /// Appends `frame`. It outlives this program when the call returns, for the system has it.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn append(&mut self, frame: &Frame<'_>) -> Result<(), FileError> {
        self.0.append(frame)
    }

    /// Has all that was appended written to the disk, and tells how much it is.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn sync(&mut self) -> Result<Extent, FileError> {
        self.0.sync()
    }
}
