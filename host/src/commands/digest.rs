//! `meniscus digest DIR|FILE`

use super::{CommandError, Reporter, Verdict};
use crate::files::trajectory::{Format, TrajectoryReader};
use crate::files::{FileError, FormatError, state::State};
use meniscus_core::units::time_from_units;
use sha2::{Digest as _, Sha256};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's directory, a state file, or a trajectory (.gsd, .npz, .xyz), of which the last frame counts.
    #[arg(value_name = "DIR|FILE")]
    path: PathBuf,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let mut path = arguments.path.clone();
    if path.is_dir() {
        path.push("final.state");
        if !path.exists() {
            return Err(CommandError::NoState(arguments.path.clone()));
        }
    }
    let state = state(&path)?;
    let bytes = state.to_bytes();
    let hash: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    reporter.text(&format!("{} {hash}\n", bytes.len()))?;
    reporter.json(|| {
        serde_json::json!({
            "file": path.display().to_string(),
            "step": state.step,
            "time": time_from_units(state.time),
            "length": bytes.len(),
            "digest": hash,
        })
    })?;
    Ok(Verdict::Ok)
}

/// The state in the file at `path`.
fn state(path: &Path) -> Result<State, FileError> {
    let whole = |found: &str, expected: &str| FileError::Read {
        path: path.to_owned(),
        problem: FormatError::Whole { found: found.to_owned(), expected: expected.to_owned() },
    };
    match Format::of_path(path) {
        None => State::read(path),
        Some(Format::LammpsDump) => {
            Err(whole("a LAMMPS dump, which has no time", "a state, or a .gsd, .npz or .xyz trajectory"))
        }
        Some(_) => {
            let last = TrajectoryReader::open(path, None)?.read_last()?;
            last.map(|frame| frame.state).ok_or_else(|| whole("no frame", "at least 1"))
        }
    }
}
