//! Writing a file whole or not at all.
//!
//! Whoever opens the file sees what was there before or all that is there after, even when the program or
//! the machine stops half-way.
//!
//! ```
//! use meniscus::files::atomic::write_atomically;
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("run.json");
//! write_atomically(&path, b"{}").unwrap();
//! write_atomically(&path, b"{\"step\":1}").unwrap();
//! assert_eq!(std::fs::read(&path).unwrap(), b"{\"step\":1}");
//! ```

use super::FileError;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// What the names of files that are being written begin with.
const UNFINISHED: &str = ".meniscus-";

/// Whether a file of that name is one that a program was writing when it was killed.
#[must_use]
pub fn is_unfinished(name: &str) -> bool {
    name.starts_with(UNFINISHED)
}

/// Makes `bytes` the contents of the file at `path`.
///
/// They go to a file of another name in the same folder, which takes the place of `path` when it is
/// on the disk.
///
/// # Errors
/// [`FileError::Write`]; what was at `path` is then still there.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    replace(path, bytes).map_err(|problem| written(path, problem))
}

/// A file that grows under another name in the folder of its own, which it gets when it is whole; dropped before that,
/// it leaves nothing.
///
/// ```
/// use meniscus::files::atomic::AtomicFile;
///
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("table.csv");
/// let mut file = AtomicFile::create(&path).unwrap();
/// file.append("x,y\n").unwrap();
/// assert!(!path.exists());
/// file.finish().unwrap();
/// assert_eq!(std::fs::read(&path).unwrap(), b"x,y\n");
/// ```
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl AtomicFile {
    /// An empty file that is to be at `path`.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let file = temporary_beside(path).map_err(|problem| written(path, problem))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file) })
    }

    /// Appends `text`.
    ///
    /// # Errors
    /// [`FileError::Write`].
    pub fn append(&mut self, text: &str) -> Result<(), FileError> {
        self.file.write_all(text.as_bytes()).map_err(|problem| written(&self.path, problem))
    }

    /// Gives the file its name, in the place of what had it, when it is on the disk.
    ///
    /// # Errors
    /// [`FileError::Write`]; what was at its path is then still there.
    pub fn finish(self) -> Result<(), FileError> {
        let Self { path, file } = self;
        let file = file.into_inner().map_err(|error| written(&path, error.into_error()))?;
        file.as_file().sync_all().map_err(|problem| written(&path, problem))?;
        take_place(file, &path).map_err(|problem| written(&path, problem))
    }
}

fn written(path: &Path, problem: std::io::Error) -> FileError {
    FileError::Write { path: path.to_owned(), problem }
}

fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = temporary_beside(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    take_place(file, path)
}

/// Whether [`write_atomically`] may make files in the folder of `path`; leaves none.
///
/// # Errors
/// [`FileError::Write`] with what the system says.
pub(crate) fn check_folder(path: &Path) -> Result<(), FileError> {
    let file = temporary_beside(path).and_then(NamedTempFile::close);
    file.map_err(|problem| FileError::Write { path: path.to_owned(), problem })
}

/// An empty file of another name in the folder of `path`.
pub(super) fn temporary_beside(path: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    // The user's mask decides who may read the file, as for any other.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.prefix(UNFINISHED).tempfile_in(folder_of(path))
}

/// Gives `file`, which has to be on the disk, the name `path`.
pub(super) fn take_place(file: NamedTempFile, path: &Path) -> std::io::Result<()> {
    file.persist(path).map_err(|error| error.error)?;
    // The new name is an entry of the folder, which has to reach the disk as well.
    #[cfg(unix)]
    std::fs::File::open(folder_of(path))?.sync_all()?;
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
