//! Two generations of checkpoints in a run's directory.
//!
//! A new checkpoint is written to `checkpoint.partial` and brought to the disk; then `checkpoint` becomes
//! `checkpoint.previous`, and the new one `checkpoint`. Wherever that breaks off, one of the two names has a whole
//! checkpoint. One that is damaged never takes the place of a whole one.
//!
//! Only one program may store in a directory at a time; to see to that is for [`run`](crate::run).
//!
//! ```
//! use meniscus::checkpoint::{Checkpoint, store};
//! use meniscus::files::state::State;
//!
//! let folder = tempfile::tempdir().unwrap();
//! for step in [100, 200] {
//!     let state = State { step, ..State::default() }.to_bytes();
//!     store::store(folder.path(), &Checkpoint { state, ..Checkpoint::default() }).unwrap();
//! }
//! std::fs::write(folder.path().join(store::CURRENT), "no checkpoint").unwrap();
//!
//! let latest = store::latest(folder.path()).unwrap();
//! assert_eq!(latest.checkpoint.step(), 100);
//! let warning = latest.warnings().next().unwrap();
//! assert!(warning.ends_with("checkpoint.previous (step 100) is used instead"), "{warning}");
//! ```

use super::{Checkpoint, CheckpointError};
use crate::files::FileError;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind};
use std::path::{Path, PathBuf};

/// Name of the newest checkpoint.
pub const CURRENT: &str = "checkpoint";

/// Name of the one before.
pub const PREVIOUS: &str = "checkpoint.previous";

/// Name of one that is being written.
pub const PARTIAL: &str = "checkpoint.partial";

/// The newest whole checkpoint of a directory.
#[derive(Debug)]
pub struct Latest {
    /// The checkpoint.
    pub checkpoint: Checkpoint,
    /// Its file.
    pub path: PathBuf,
    /// Newer ones that were refused, newest first.
    pub refused: Vec<Refused>,
}

impl Latest {
    /// A line for each checkpoint that was refused: its file, what is wrong with it, and which one is used instead.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let (used, step) = (self.path.display(), self.checkpoint.step());
        self.refused.iter().map(move |refused| format!("{refused}; {used} (step {step}) is used instead"))
    }
}

/// A checkpoint that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct Refused {
    /// Its file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: CheckpointError,
}

/// Why a directory has no checkpoint to go on from.
#[derive(Debug, thiserror::Error)]
pub enum LatestError {
    /// There is none.
    #[error(
        "{}: found no {CURRENT} and no {PREVIOUS}, expected the directory of a run that wrote one: begin the run anew",
        directory.display()
    )]
    Missing {
        /// The directory.
        directory: PathBuf,
    },
    /// None is whole.
    #[error("{}: no checkpoint is left: begin the run anew in another directory", list(refused))]
    Refused {
        /// Those there are.
        refused: Vec<Refused>,
    },
    /// Another program has gone on with the run; to fall back would undo its work.
    #[error(transparent)]
    Version(Refused),
}

/// All of them on a line.
fn list(refused: &[Refused]) -> String {
    let lines: Vec<String> = refused.iter().map(ToString::to_string).collect();
    lines.join("; ")
}

/// What storing does, in this order. After each, the directory has a whole checkpoint if it had one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Action {
    /// Removes what a store that broke off left.
    Clear,
    /// Writes the new checkpoint under a name of its own, and waits until it is on the disk.
    Write,
    /// Makes the newest checkpoint the one before, if it is whole.
    SetAside,
    /// Makes the new checkpoint the newest.
    Install,
    /// Waits until the names are on the disk.
    Settle,
}

impl Action {
    const ORDER: [Self; 5] = [Self::Clear, Self::Write, Self::SetAside, Self::Install, Self::Settle];

    fn perform(self, directory: &Path, checkpoint: &Checkpoint) -> io::Result<()> {
        let [current, previous, partial] = [CURRENT, PREVIOUS, PARTIAL].map(|name| directory.join(name));
        match self {
            Self::Clear => remove(&partial),
            Self::Write => {
                let mut output = BufWriter::new(File::create_new(&partial)?);
                checkpoint.write_to(&mut output)?;
                output.get_ref().sync_all()
            }
            Self::SetAside if Checkpoint::read(&current).is_ok() => fs::rename(current, previous),
            Self::SetAside => Ok(()),
            Self::Install => fs::rename(partial, current),
            Self::Settle => settle(directory),
        }
    }
}

/// Makes `checkpoint` the newest of `directory`, and the newest the one before.
///
/// # Errors
/// [`FileError::Write`]; the newest whole checkpoint that was there still is.
pub fn store(directory: &Path, checkpoint: &Checkpoint) -> Result<(), FileError> {
    let perform = |action: Action| action.perform(directory, checkpoint);
    Action::ORDER.into_iter().try_for_each(perform).map_err(|problem| {
        // A disk that is full should not keep what is of no use.
        let _ = remove(&directory.join(PARTIAL));
        FileError::Write { path: directory.join(CURRENT), problem }
    })
}

/// Removes what a store that broke off left in `directory`.
///
/// # Errors
/// [`FileError::Write`].
pub fn remove_partial(directory: &Path) -> Result<(), FileError> {
    let path = directory.join(PARTIAL);
    remove(&path).map_err(|problem| FileError::Write { path, problem })
}

/// The newest whole checkpoint of `directory`, and what is wrong with newer ones. Changes nothing.
///
/// # Errors
/// [`LatestError`] if there is none.
pub fn latest(directory: &Path) -> Result<Latest, LatestError> {
    let mut refused = Vec::new();
    for path in [CURRENT, PREVIOUS].map(|name| directory.join(name)) {
        match Checkpoint::read(&path) {
            Ok(checkpoint) => return Ok(Latest { checkpoint, path, refused }),
            Err(CheckpointError::Input(problem))
                if matches!(problem.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {}
            Err(problem @ CheckpointError::Version { .. }) => {
                return Err(LatestError::Version(Refused { path, problem }));
            }
            Err(problem) => refused.push(Refused { path, problem }),
        }
    }
    if refused.is_empty() {
        Err(LatestError::Missing { directory: directory.to_owned() })
    } else {
        Err(LatestError::Refused { refused })
    }
}

/// Removes a file, if there is one.
fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(problem) if problem.kind() == ErrorKind::NotFound => Ok(()),
        outcome => outcome,
    }
}

/// Waits until the names in a directory are on the disk.
fn settle(directory: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(directory)?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::state::State;
    use meniscus_core::torus::Position;

    fn checkpoint(step: u64) -> Checkpoint {
        let state = State { step, positions: vec![Position::from_bits(1, 2)], ..State::default() };
        Checkpoint {
            configuration: "seed = 1\n".to_owned(),
            state: state.to_bytes(),
            crossings: vec![[1, -1]],
            progress: format!("rows {step}"),
        }
    }

    /// Writes a checkpoint, or `damaged`, under each name.
    fn directory(current: &[u8], previous: &[u8]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, bytes) in [(CURRENT, current), (PREVIOUS, previous)] {
            if !bytes.is_empty() {
                fs::write(folder.path().join(name), bytes).unwrap();
            }
        }
        folder
    }

    /// The step of the newest whole checkpoint.
    fn step(folder: &Path) -> Option<u64> {
        latest(folder).ok().map(|latest| latest.checkpoint.step())
    }

    /// Every state of a directory that a run can meet, with the step of its newest whole checkpoint.
    fn beginnings() -> Vec<(tempfile::TempDir, Option<u64>)> {
        let [first, second] = [1, 2].map(|step| checkpoint(step).encode());
        let half = &second[..second.len() / 2];
        vec![
            (directory(&[], &[]), None),
            (directory(&first, &[]), Some(1)),
            (directory(&[], &first), Some(1)),
            (directory(&second, &first), Some(2)),
            (directory(half, &first), Some(1)),
            (directory(&second, half), Some(2)),
            (directory(half, half), None),
        ]
    }

    #[test]
    fn a_store_that_breaks_off_leaves_a_whole_checkpoint() {
        for done in 0..=Action::ORDER.len() {
            for (folder, before) in beginnings() {
                for &action in &Action::ORDER[..done] {
                    action.perform(folder.path(), &checkpoint(3)).unwrap();
                }
                let after = if done < 4 { before } else { Some(3) };
                assert_eq!(step(folder.path()), after, "{done} actions done");

                store(folder.path(), &checkpoint(4)).unwrap();
                assert_eq!(step(folder.path()), Some(4), "stored after {done} actions");
                assert!(!folder.path().join(PARTIAL).exists());
                fs::remove_file(folder.path().join(CURRENT)).unwrap();
                assert_eq!(step(folder.path()), after, "the one before, after {done} actions");
            }
        }
    }

    #[test]
    fn a_write_that_breaks_off_leaves_a_whole_checkpoint() {
        let bytes = checkpoint(3).encode();
        for length in 0..=bytes.len() {
            for (folder, before) in beginnings() {
                fs::write(folder.path().join(PARTIAL), &bytes[..length]).unwrap();
                assert_eq!(step(folder.path()), before, "{length} bytes written");
            }
        }
        for (folder, _) in beginnings() {
            fs::write(folder.path().join(PARTIAL), &bytes[..9]).unwrap();
            store(folder.path(), &checkpoint(4)).unwrap();
            assert_eq!(step(folder.path()), Some(4));
            assert!(!folder.path().join(PARTIAL).exists());
        }
    }
}
