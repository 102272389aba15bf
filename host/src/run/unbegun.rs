//! What a run leaves that was killed before its first checkpoint.

use super::RunError;
use super::lock::{self, Lock};
use super::manifest;
use crate::checkpoint::store;
use crate::files::FileError;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Removes the files that a run made in `directory` before it was killed, if that was before its first checkpoint: then
/// nothing can go on from them, and [`Run::create`](super::Run::create) would refuse them. A directory with a checkpoint, a
/// `run.json` or a folder in it is left as it is. Only for directories that nobody but runs keeps files in.
///
/// # Errors
/// [`RunError::Locked`] if a run is at work there, [`RunError::NotEmpty`] if the directory is left as it is, and
/// [`RunError::File`].
pub fn clear_unbegun(directory: &Path) -> Result<(), RunError> {
    let failed = |problem| FileError::Write { path: directory.to_owned(), problem };
    let lock = match directory.try_exists() {
        Ok(false) => return Ok(()),
        Ok(true) => Lock::take(directory)?,
        Err(problem) => return Err(failed(problem).into()),
    };
    let entries = fs::read_dir(directory).and_then(Iterator::collect::<std::io::Result<Vec<_>>>);
    let entries = entries.map_err(failed)?;
    let is_kept = |entry: &fs::DirEntry| {
        let kept =
            [store::CURRENT, store::PREVIOUS, manifest::FILE].iter().any(|name| entry.file_name() == *name);
        kept || !entry.file_type().is_ok_and(|kind| kind.is_file())
    };
    if entries.iter().any(is_kept) {
        return Err(RunError::NotEmpty(directory.to_owned()));
    }
    for entry in entries.iter().filter(|entry| entry.file_name() != lock::FILE) {
        match fs::remove_file(entry.path()) {
            Err(problem) if problem.kind() != ErrorKind::NotFound => {
                return Err(FileError::Write { path: entry.path(), problem }.into());
            }
            _ => {}
        }
    }
    drop(lock);
    Ok(())
}
