//! Run directories: where tests put them, and compared with each other.

use std::collections::BTreeMap;
use std::path::Path;

use sha2::{Digest as _, Sha256};

/// A folder for runs that stop again and again: in memory where the system has such a place, since nothing in it has to
/// survive, and waiting for a disk is most of what such runs do.
///
/// # Panics
/// If none can be made.
#[expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
#[must_use]
pub fn fast_folder() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

/// What a run's directory holds, apart from what tells of the machine and the stops: `run.json` and checkpoints.
///
/// # Panics
/// If a file cannot be read.
#[must_use]
pub fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    #[expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let entry = entry.unwrap();
        (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap())
    };
    #[expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
    let entries = std::fs::read_dir(directory).unwrap();
    let compared = |name: &str| name != "run.json" && !name.starts_with("checkpoint");
    entries.map(file).filter(|(name, _)| compared(name)).collect()
}

/// The first difference between the files of two runs, if any: a file that one of them has not, or the first byte.
#[must_use]
pub fn difference(expected: &Path, found: &Path) -> Option<String> {
    let [expected, found] = [expected, found].map(files);
    let [expected_names, found_names] =
        [&expected, &found].map(|files| files.keys().cloned().collect::<Vec<_>>());
    if expected_names != found_names {
        return Some(format!("expected files {expected_names:?}, found {found_names:?}"));
    }
    expected.iter().zip(&found).find_map(|((name, expected), (_, found))| {
        let same = expected.iter().zip(found).take_while(|(expected, found)| expected == found).count();
        (expected != found).then(|| {
            let lengths = (expected.len(), found.len());
            let around = |bytes: &[u8]| {
                let end = (same + 40).min(bytes.len());
                String::from_utf8_lossy(&bytes[same.saturating_sub(40)..end]).into_owned()
            };
            format!(
                "{name}: byte {same} differs (lengths {lengths:?}): expected {:?}, found {:?}",
                around(expected),
                around(found)
            )
        })
    })
}

/// Fails unless two runs left the same.
///
/// # Panics
/// If they did not; says what differs.
#[track_caller]
pub fn assert_same_files(expected: &Path, found: &Path) {
    assert_eq!(difference(expected, found), None, "{} is not {}", found.display(), expected.display());
}

/// SHA-256 in hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
