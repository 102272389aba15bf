//! Writing an archive, whole, anew for each frame.

use super::read::NpzReader;
use super::{ARRAYS, Shape, skip_header};
use crate::files::atomic::{take_place, temporary_beside};
use crate::files::trajectory::{Extent, Frame};
use crate::files::{FileError, FormatError};
use meniscus_core::torus::Torus;
use std::fs::File;
use std::io::{BufReader, BufWriter, Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// A growing archive.
#[derive(Debug)]
pub(in crate::files) struct NpzTrajectory {
    path: PathBuf,
    torus: Torus,
    frames: u64,
    /// Number of discs; of no meaning without frames.
    count: u64,
}

impl NpzTrajectory {
    pub(in crate::files) fn create(path: &Path, torus: &Torus) -> Result<Self, FileError> {
        let trajectory = Self { path: path.to_owned(), torus: *torus, frames: 0, count: 0 };
        File::create_new(path)
            .and_then(|_| trajectory.store(&[]))
            .map_err(|error| trajectory.failed(error))?;
        Ok(trajectory)
    }

    /// The file is always whole, but may have more frames.
    pub(in crate::files) fn resume(path: &Path, torus: &Torus, extent: Extent) -> Result<Self, FileError> {
        let mut trajectory = Self { path: path.to_owned(), torus: *torus, frames: 0, count: 0 };
        if extent.frames > 0 {
            let refused = |problem| FileError::Read { path: path.to_owned(), problem };
            let input = File::open(path).map_err(|error| refused(FormatError::Input(error)))?;
            let reader = NpzReader::open(BufReader::new(input), Some(torus)).map_err(refused)?;
            if reader.frames() < extent.frames {
                return Err(FileError::Extent {
                    path: path.to_owned(),
                    found: format!("{} frames", reader.frames()),
                    expected: format!("{} frames", extent.frames),
                });
            }
            trajectory.frames = extent.frames;
            trajectory.count = reader.count();
        }
        trajectory.store(&[]).map_err(|error| trajectory.failed(error))?;
        Ok(trajectory)
    }

    pub(in crate::files) fn append(&mut self, frames: &[Frame<'_>]) -> Result<(), FileError> {
        let mut counts = frames.iter().map(|frame| frame.positions.len() as u64);
        let all = if self.frames > 0 { Some(self.count) } else { counts.clone().next() };
        if let Some(other) = counts.find(|count| Some(*count) != all) {
            let problem = format!("a frame of {other} discs after others: .npz holds one number of discs");
            return Err(self.failed(Error::other(problem)));
        }
        self.count = all.unwrap_or(0);
        self.store(frames).map_err(|error| self.failed(error))?;
        self.frames += frames.len() as u64;
        Ok(())
    }

    pub(in crate::files) fn sync(&mut self) -> Result<Extent, FileError> {
        // Every frame is on the disk.
        let length = std::fs::metadata(&self.path).map(|metadata| metadata.len());
        Ok(Extent { frames: self.frames, bytes: length.map_err(|error| self.failed(error))? })
    }

    /// Writes the first frames of the file and these.
    fn store(&self, new: &[Frame<'_>]) -> std::io::Result<()> {
        let frames = self.frames + new.len() as u64;
        let mut old = match self.frames {
            0 => None,
            _ => Some(ZipArchive::new(BufReader::new(File::open(&self.path)?)).map_err(Error::other)?),
        };
        let temporary = temporary_beside(&self.path)?;
        let mut zip = ZipWriter::new(BufWriter::new(Deferred { file: temporary.as_file(), error: None }));
        for array in ARRAYS {
            let header = array.header(frames, self.count);
            let kept =
                if array.shape == Shape::One { 0 } else { self.frames * array.bytes_of_frame(self.count) };
            let whole = header.len() as u64 + frames.max(1) * array.bytes_of_frame(self.count);
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .last_modified_time(DateTime::DEFAULT)
                .large_file(whole >= u64::from(u32::MAX));
            zip.start_file(array.file_name(), options).map_err(Error::other)?;
            zip.write_all(&header)?;
            if let Some(old) = &mut old {
                let mut old = old.by_name(&array.file_name()).map_err(Error::other)?;
                skip_header(&mut old)?;
                if std::io::copy(&mut old.take(kept), &mut zip)? != kept {
                    return Err(Error::other(format!("the array {} is cut off", array.name)));
                }
            }
            if array.shape == Shape::One {
                zip.write_all(&array.data(&self.torus, &Frame::default()))?;
            } else {
                new.iter().try_for_each(|frame| zip.write_all(&array.data(&self.torus, frame)))?;
            }
        }
        let output = zip.finish().map_err(Error::other)?.into_inner().map_err(|error| error.into_error())?;
        output.error.map_or(Ok(()), Err)?;
        temporary.as_file().sync_all()?;
        take_place(temporary, &self.path)
    }

    fn failed(&self, problem: Error) -> FileError {
        FileError::Write { path: self.path.clone(), problem }
    }
}

/// A file that keeps the first error for the end, and takes what comes after it for written: the library prints an error
/// that is left to it when it drops an archive half written.
struct Deferred<'a> {
    file: &'a File,
    error: Option<Error>,
}

impl Deferred<'_> {
    /// What `result` holds, or `instead` if nothing can be written any more.
    fn deferred<T>(&mut self, result: std::io::Result<T>, instead: T) -> std::io::Result<T> {
        match result {
            Err(error) if error.kind() != ErrorKind::Interrupted => {
                self.error.get_or_insert(error);
                Ok(instead)
            }
            other => other,
        }
    }
}

impl Write for Deferred<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.error.is_some() {
            return Ok(bytes.len());
        }
        let written = self.file.write(bytes);
        self.deferred(written, bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Deferred<'_> {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        let found = self.file.seek(place);
        self.deferred(found, 0)
    }
}
