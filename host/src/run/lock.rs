//! One run at a time in a directory.

use super::RunError;
use std::fs::{File, TryLockError};
use std::io::ErrorKind;
use std::path::Path;

/// Name of the file that is locked. It is empty, and stays.
pub(super) const FILE: &str = "lock";

/// A run directory is ours until this is dropped or the process ends, however it ends.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock of `directory`.
    pub(super) fn take(directory: &Path) -> Result<Self, RunError> {
        let path = directory.join(FILE);
        let failed = |source| RunError::Write { path: path.clone(), source };
        let file = File::options().create(true).append(true).open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => Ok(Self { _file: file }),
            Err(TryLockError::WouldBlock) => Err(RunError::Locked(directory.to_owned())),
            // A file system without locks must not keep anybody from computing.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {
                Ok(Self { _file: file })
            }
            Err(TryLockError::Error(error)) => Err(failed(error)),
        }
    }
}
