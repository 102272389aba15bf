//! One run at a time in a directory.

use super::RunError;
use crate::files::FileError;
use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::Path;

/// Name of the file that is locked. It is empty, and stays. Should somebody remove it nevertheless, the lock of the
/// directory itself holds, where the system has such locks.
pub(super) const FILE: &str = "lock";

/// ENOLCK, which network file systems without a lock service give and the standard library has no kind for.
const NO_LOCKS: Option<i32> = if cfg!(any(target_os = "linux", target_os = "android")) {
    Some(37)
} else if cfg!(unix) {
    Some(77)
} else {
    None
};

/// A run directory is ours until this is dropped or the process ends, however it ends.
#[derive(Debug)]
pub(super) struct Lock {
    _file: File,
    _directory: Option<File>,
}

impl Lock {
    /// Takes the lock of `directory`.
    pub(super) fn take(directory: &Path) -> Result<Self, RunError> {
        let path = directory.join(FILE);
        let failed = |problem| FileError::Write { path: path.clone(), problem };
        let file = File::options().create(true).append(true).open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(RunError::Locked(directory.to_owned())),
            // A file system without locks must not keep anybody from computing.
            Err(TryLockError::Error(error)) if is_without_locks(&error) => {}
            Err(TryLockError::Error(error)) => return Err(failed(error).into()),
        }
        match lock_directory(directory) {
            Err(TryLockError::WouldBlock) => Err(RunError::Locked(directory.to_owned())),
            // There is the file's lock.
            Err(TryLockError::Error(_)) => Ok(Self { _file: file, _directory: None }),
            Ok(directory) => Ok(Self { _file: file, _directory: Some(directory) }),
        }
    }
}

/// Locks a directory, which nobody can put another in the place of without its files.
fn lock_directory(path: &Path) -> Result<File, TryLockError> {
    let directory = File::open(path).map_err(TryLockError::Error)?;
    directory.try_lock()?;
    Ok(directory)
}

/// Whether `error` says that the file system has no locks.
fn is_without_locks(error: &Error) -> bool {
    error.kind() == ErrorKind::Unsupported || (NO_LOCKS.is_some() && error.raw_os_error() == NO_LOCKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_system_without_locks_is_known_by_its_errors() {
        // EOPNOTSUPP and ENOLCK; not EIO.
        let errors = [95, 37, 5].map(Error::from_raw_os_error);
        assert_eq!(errors.map(|error| is_without_locks(&error)), [true, true, false]);
    }
}
