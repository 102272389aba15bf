//! Trajectories: files to which a run appends a frame now and then.
//!
//! What a file holds of a frame is said in the module of its format: [`gsd`](super::gsd),
//! [`extended_xyz`], [`lammps_dump`], [`npz`](super::npz).
//!
//! A run that goes on after a stop first drops what the file got after its checkpoint, so that the file ends
//! with the bytes that an uninterrupted run would have written.
//!
//! ```
//! use meniscus::files::trajectory::{Format, Frame, Trajectory};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("trajectory.gsd");
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
mod reader;
mod text;

pub use frame::{Format, Frame, Recorded};
pub use reader::TrajectoryReader;

use super::gsd::GsdTrajectory;
use super::npz::NpzTrajectory;
use super::{FileError, extended_xyz, lammps_dump};
use meniscus_core::torus::Torus;
use std::path::Path;
use text::{TextTrajectory, WriteFrame};

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
pub struct Trajectory(Open);

#[derive(Debug)]
enum Open {
    Gsd(Box<GsdTrajectory>),
    Text(TextTrajectory),
    Npz(NpzTrajectory),
}

/// How to write a frame, if the format is of text.
fn writer(format: Format) -> Option<WriteFrame> {
    match format {
        Format::ExtendedXyz => Some(extended_xyz::write_frame),
        Format::LammpsDump => Some(lammps_dump::write_frame),
        Format::Gsd | Format::Npz => None,
    }
}

impl Trajectory {
    /// Makes the file at `path`.
    ///
    /// # Errors
    /// [`FileError::Write`], also if there is a file of this name.
    pub fn create(path: &Path, format: Format, torus: &Torus) -> Result<Self, FileError> {
        Ok(Self(match (format, writer(format)) {
            (_, Some(writer)) => Open::Text(TextTrajectory::create(path, torus, writer)?),
            (Format::Npz, None) => Open::Npz(NpzTrajectory::create(path, torus)?),
            (_, None) => Open::Gsd(Box::new(GsdTrajectory::create(path, torus)?)),
        }))
    }

    /// Opens the file at `path` to go on after its first `extent.frames` frames. What follows them is dropped, whatever
    /// it is.
    ///
    /// # Errors
    /// [`FileError::Extent`] if the file has less than `extent`, [`FileError::Read`] if what it should have is damaged,
    /// [`FileError::Write`] if it cannot be written.
    pub fn resume(path: &Path, format: Format, torus: &Torus, extent: Extent) -> Result<Self, FileError> {
        Ok(Self(match (format, writer(format)) {
            (_, Some(writer)) => Open::Text(TextTrajectory::resume(path, torus, writer, extent)?),
            (Format::Npz, None) => Open::Npz(NpzTrajectory::resume(path, torus, extent)?),
            (_, None) => Open::Gsd(Box::new(GsdTrajectory::resume(path, torus, extent)?)),
        }))
    }

    /// Appends `frame`. It outlives this program when the call returns, for the system has it.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn append(&mut self, frame: &Frame<'_>) -> Result<(), FileError> {
        match &mut self.0 {
            Open::Gsd(trajectory) => trajectory.append(frame),
            Open::Text(trajectory) => trajectory.append(frame),
            Open::Npz(trajectory) => trajectory.append(std::slice::from_ref(frame)),
        }
    }

    /// Appends `frames`, for an archive at the cost of one.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn append_all(&mut self, frames: &[Frame<'_>]) -> Result<(), FileError> {
        match &mut self.0 {
            Open::Npz(trajectory) => trajectory.append(frames),
            _ => frames.iter().try_for_each(|frame| self.append(frame)),
        }
    }

    /// Has all that was appended written to the disk, and tells how much it is.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn sync(&mut self) -> Result<Extent, FileError> {
        match &mut self.0 {
            Open::Gsd(trajectory) => trajectory.sync(),
            Open::Text(trajectory) => trajectory.sync(),
            Open::Npz(trajectory) => trajectory.sync(),
        }
    }
}
