//! Trajectories of lines of text, where a frame is what it is wherever it stands: such a file is cut to go on.

use super::{Extent, Frame};
use crate::files::{FileError, growing};
use meniscus_core::torus::Torus;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// How a frame is written.
pub(super) type WriteFrame = fn(&mut BufWriter<File>, &Torus, &Frame<'_>) -> std::io::Result<()>;

/// An open trajectory of text.
#[derive(Debug)]
pub(super) struct TextTrajectory {
    path: PathBuf,
    torus: Torus,
    writer: WriteFrame,
    file: BufWriter<File>,
    extent: Extent,
}

impl TextTrajectory {
    pub(super) fn create(path: &Path, torus: &Torus, writer: WriteFrame) -> Result<Self, FileError> {
        let file = growing::create(path).map_err(|error| written(path, error))?;
        Ok(Self::new(path, torus, writer, file, Extent::default()))
    }

    pub(super) fn resume(
        path: &Path,
        torus: &Torus,
        writer: WriteFrame,
        extent: Extent,
    ) -> Result<Self, FileError> {
        let open = || -> std::io::Result<Result<File, u64>> {
            let file = growing::open(path)?;
            let found = file.metadata()?.len();
            if found < extent.bytes {
                return Ok(Err(found));
            }
            growing::cut(path, extent.bytes)?;
            Ok(Ok(file))
        };
        match open().map_err(|error| written(path, error))? {
            Ok(file) => Ok(Self::new(path, torus, writer, file, extent)),
            Err(found) => Err(FileError::Extent {
                path: path.to_owned(),
                found: format!("{found} bytes"),
                expected: format!("{} bytes", extent.bytes),
            }),
        }
    }

    fn new(path: &Path, torus: &Torus, writer: WriteFrame, file: File, extent: Extent) -> Self {
        Self { path: path.to_owned(), torus: *torus, writer, file: BufWriter::new(file), extent }
    }

    pub(super) fn append(&mut self, frame: &Frame<'_>) -> Result<(), FileError> {
        (self.writer)(&mut self.file, &self.torus, frame)
            .and_then(|()| self.file.flush())
            .map_err(|error| written(&self.path, error))?;
        self.extent.frames += 1;
        Ok(())
    }

    /// The length is that of what has the name, so that a file removed or cut in the meantime is noticed.
    pub(super) fn sync(&mut self) -> Result<Extent, FileError> {
        let sync = || {
            self.file.get_ref().sync_all()?;
            Ok(std::fs::metadata(&self.path)?.len())
        };
        self.extent.bytes = sync().map_err(|error| written(&self.path, error))?;
        Ok(self.extent)
    }
}

/// The error of a file that cannot be written.
fn written(path: &Path, problem: std::io::Error) -> FileError {
    FileError::Write { path: path.to_owned(), problem }
}
