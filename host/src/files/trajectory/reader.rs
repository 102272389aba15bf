//! Reading trajectories, and files of one state as if they were some.

use super::{Format, Recorded};
use crate::files::gsd::GsdReader;
use crate::files::lines::Lines;
use crate::files::npz::NpzReader;
use crate::files::{FileError, FormatError, csv, extended_xyz, lammps_dump, state::State};
use meniscus_core::torus::Torus;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The frames of a file, one after the other.
///
/// ```
/// use meniscus::files::trajectory::TrajectoryReader;
///
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("one.xyz");
/// std::fs::write(&path, "1\nLattice=\"8 0 0 0 8 0 0 0 1\" Properties=pos:R:3 step=3\n4 2 0\n").unwrap();
/// let mut reader = TrajectoryReader::open(&path, None).unwrap();
/// let frame = reader.read_frame().unwrap().unwrap();
/// assert_eq!((frame.state.step, reader.torus().unwrap().side()), (3, 8.0));
/// assert!(reader.read_frame().unwrap().is_none());
/// ```
pub struct TrajectoryReader {
    path: PathBuf,
    torus: Option<Torus>,
    source: Source,
}

enum Source {
    /// With the number of the next frame.
    Gsd(GsdReader<BufReader<File>>, u64),
    ExtendedXyz(Lines<BufReader<File>>),
    LammpsDump(Lines<BufReader<File>>),
    /// With the number of the next frame.
    Npz(NpzReader<BufReader<File>>, u64),
    One(Option<State>),
}

impl TrajectoryReader {
    /// Opens the file at `path`, a trajectory or a file of positions. Its frames have to be in the box `torus`; if there
    /// is none, in that of the first frame.
    ///
    /// # Errors
    /// [`FileError::Ending`] for an unknown ending, [`FileError::Box`] if the box is in neither file nor `torus`,
    /// [`FileError::Read`] for a file that is none of what its ending says.
    pub fn open(path: &Path, torus: Option<&Torus>) -> Result<Self, FileError> {
        let input = || File::open(path).map(BufReader::new).map_err(FormatError::Input);
        let refused = |problem| FileError::Read { path: path.to_owned(), problem };
        let boxed = || torus.ok_or_else(|| FileError::Box { path: path.to_owned() });
        let mut torus_of_file = torus.copied();
        let source = match (Format::of_path(path), path.extension().and_then(|ending| ending.to_str())) {
            (Some(Format::Gsd), _) => {
                let reader = input().and_then(|input| GsdReader::open(input, torus)).map_err(refused)?;
                torus_of_file = Some(reader.torus());
                Source::Gsd(reader, 0)
            }
            (Some(Format::Npz), _) => {
                let reader = input().and_then(|input| NpzReader::open(input, torus)).map_err(refused)?;
                torus_of_file = Some(reader.torus());
                Source::Npz(reader, 0)
            }
            (Some(Format::ExtendedXyz), _) => Source::ExtendedXyz(Lines::new(input().map_err(refused)?)),
            (Some(Format::LammpsDump), _) => Source::LammpsDump(Lines::new(input().map_err(refused)?)),
            (None, Some("csv")) => Source::One(Some(csv::read(path, boxed()?)?)),
            (None, Some("state")) => Source::One(Some(State::read(path)?)),
            (None, _) => return Err(FileError::Ending { path: path.to_owned() }),
        };
        Ok(Self { path: path.to_owned(), torus: torus_of_file, source })
    }

    /// The box, once it is known: at the latest after the first frame, unless the file has no box.
    #[must_use]
    pub fn torus(&self) -> Option<Torus> {
        self.torus
    }

    /// The number of frames, where the file tells it without being read as a whole.
    #[must_use]
    pub fn frames(&self) -> Option<u64> {
        match &self.source {
            Source::Gsd(reader, _) => Some(reader.frames()),
            Source::Npz(reader, _) => Some(reader.frames()),
            Source::ExtendedXyz(_) | Source::LammpsDump(_) => None,
            Source::One(_) => Some(1),
        }
    }

    /// The next frame; none at the end.
    ///
    /// # Errors
    /// [`FileError::Read`].
    pub fn read_frame(&mut self) -> Result<Option<Recorded>, FileError> {
        let frame = match &mut self.source {
            Source::Gsd(reader, next) => {
                if *next < reader.frames() {
                    *next += 1;
                    reader.frame(*next - 1).map(Some)
                } else {
                    Ok(None)
                }
            }
            Source::Npz(reader, next) => {
                if *next < reader.frames() {
                    *next += 1;
                    reader.frame(*next - 1).map(Some)
                } else {
                    Ok(None)
                }
            }
            Source::ExtendedXyz(lines) => extended_xyz::next_frame(lines, &mut self.torus),
            Source::LammpsDump(lines) => lammps_dump::next_frame(lines, &mut self.torus),
            Source::One(state) => Ok(state.take().map(Recorded::from_state)),
        };
        frame.map_err(|problem| FileError::Read { path: self.path.clone(), problem })
    }

    /// The last frame; none if there is no frame.
    ///
    /// # Errors
    /// [`FileError::Read`].
    pub fn read_last(&mut self) -> Result<Option<Recorded>, FileError> {
        let last = match &mut self.source {
            Source::Gsd(reader, _) if reader.frames() > 0 => reader.frame(reader.frames() - 1).map(Some),
            Source::Npz(reader, _) if reader.frames() > 0 => reader.frame(reader.frames() - 1).map(Some),
            _ => {
                let mut last = None;
                while let Some(frame) = self.read_frame()? {
                    last = Some(frame);
                }
                Ok(last)
            }
        };
        last.map_err(|problem| FileError::Read { path: self.path.clone(), problem })
    }
}
