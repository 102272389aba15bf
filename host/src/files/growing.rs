//! Opening a file that only grows: whatever is written goes to where the file ends, wherever that is by then.
//!
//! A file that somebody else cuts is the shorter for it ever after. Writing where the file once ended would fill what is
//! gone with zeros, and give the file the length that it should have.

use std::fs::File;
use std::io::Result;
use std::path::Path;

/// Makes the file at `path`, which must not exist.
pub(crate) fn create(path: &Path) -> Result<File> {
    File::options().append(true).create_new(true).open(path)
}

/// Opens the file at `path`, which must exist.
pub(crate) fn open(path: &Path) -> Result<File> {
    File::options().append(true).open(path)
}

/// Cuts the file at `path` to `length` bytes. Not every system lets a file that only grows be cut through itself.
pub(crate) fn cut(path: &Path, length: u64) -> Result<()> {
    File::options().write(true).open(path)?.set_len(length)
}

#[cfg(test)]
mod tests {
    use super::{create, cut, open};
    use std::fs;
    use std::io::Write as _;

    #[test]
    fn what_is_written_after_a_cut_by_others_leaves_no_hole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows");
        let mut file = create(&path).unwrap();
        file.write_all(b"first\n").unwrap();
        fs::write(&path, "").unwrap();
        file.write_all(b"second\n").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second\n");
        let mut file = open(&path).unwrap();
        cut(&path, 3).unwrap();
        file.write_all(b"!").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"sec!");
        assert!(create(&path).is_err());
    }
}
