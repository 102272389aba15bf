//! One run at a time in a directory.

use super::RunError;
use std::fs::{File, TryLockError};
use std::io::{Error, ErrorKind};
use std::path::Path;

/// Name of the file that is locked. It is empty, and stays.
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
            Err(TryLockError::Error(error)) if is_without_locks(&error) => Ok(Self { _file: file }),
            Err(TryLockError::Error(error)) => Err(failed(error)),
        }
    }
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
