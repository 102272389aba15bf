//! A text file that grows line by line and can go on after a stop, and whether a file is still the one it was.

use super::RunError;
use crate::files::{FileError, growing};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that grows.
#[derive(Debug)]
pub(super) struct Growing {
    file: BufWriter<File>,
    place: Place,
}

impl Growing {
    /// Makes the file, which must not exist.
    pub(super) fn create(path: &Path) -> Result<Self, RunError> {
        let file = growing::create(path).map_err(|problem| written(path, problem))?;
        Ok(Self { file: BufWriter::new(file), place: Place::of(path)? })
    }

    /// Opens the file to go on after its first `length` bytes, which it must have; what follows them is for
    /// [`Growing::cut`] to drop.
    pub(super) fn open(path: &Path, length: u64) -> Result<Self, RunError> {
        let open = || -> std::io::Result<(File, u64)> {
            let file = growing::open(path)?;
            let found = file.metadata()?.len();
            Ok((file, found))
        };
        let (file, found) = open().map_err(|problem| written(path, problem))?;
        if found < length {
            let (found, expected) = (format!("{found} bytes"), format!("{length} bytes"));
            return Err(RunError::Lost(FileError::Extent { path: path.to_owned(), found, expected }));
        }
        Ok(Self { file: BufWriter::new(file), place: Place { length, ..Place::of(path)? } })
    }

    /// Drops what the file has beyond the length that it was opened with.
    pub(super) fn cut(&mut self) -> Result<(), RunError> {
        growing::cut(&self.place.path, self.place.length)
            .map_err(|problem| written(&self.place.path, problem))?;
        Ok(())
    }

    /// Appends `lines`, each with its end, and hands them to the system, so that they outlive this program.
    pub(super) fn append(&mut self, lines: &str) -> Result<(), RunError> {
        self.place.check()?;
        self.file
            .write_all(lines.as_bytes())
            .and_then(|()| self.file.flush())
            .map_err(|problem| written(&self.place.path, problem))?;
        self.place.length += lines.len() as u64;
        Ok(())
    }

    /// Waits until the file is on the disk, and tells its length.
    pub(super) fn sync(&mut self) -> Result<u64, RunError> {
        self.place.check()?;
        self.file.get_ref().sync_all().map_err(|problem| written(&self.place.path, problem))?;
        Ok(self.place.length)
    }
}

/// A file under its name, to notice when it is removed, when another takes its place, and when others cut it or write
/// to it.
#[derive(Debug)]
pub(super) struct Place {
    path: PathBuf,
    identity: Identity,
    /// How long it is to be, bytes.
    length: u64,
}

/// What tells a file from any other; nothing where the system has no such thing.
type Identity = Option<(u64, u64)>;

impl Place {
    /// The file that is at `path`.
    pub(super) fn of(path: &Path) -> Result<Self, RunError> {
        let metadata = fs::metadata(path).map_err(|problem| written(path, problem))?;
        Ok(Self { path: path.to_owned(), identity: identity(&metadata), length: metadata.len() })
    }

    /// Takes the file that is there now for the one it was. It may have grown.
    pub(super) fn renew(&mut self) -> Result<(), RunError> {
        let Ok(now) = Self::of(&self.path) else { return Err(RunError::Removed(self.path.clone())) };
        if now.length < self.length {
            return Err(self.changed(now.length));
        }
        *self = now;
        Ok(())
    }

    fn changed(&self, found: u64) -> RunError {
        RunError::Changed { path: self.path.clone(), found, expected: self.length }
    }

    /// Whether it still is, as long as it was.
    pub(super) fn check(&self) -> Result<(), RunError> {
        match fs::metadata(&self.path) {
            Ok(metadata) if identity(&metadata) == self.identity => match metadata.len() {
                found if found == self.length => Ok(()),
                found => Err(self.changed(found)),
            },
            _ => Err(RunError::Removed(self.path.clone())),
        }
    }
}

#[cfg(unix)]
fn identity(metadata: &fs::Metadata) -> Identity {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn identity(_: &fs::Metadata) -> Identity {
    None
}

fn written(path: &Path, problem: std::io::Error) -> FileError {
    FileError::Write { path: path.to_owned(), problem }
}
