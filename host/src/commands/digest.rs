//! `meniscus digest DIR|FILE`

use super::{CommandError, Reporter, Verdict};
use crate::files::state::State;
use meniscus_core::units::time_from_units;
use sha2::{Digest as _, Sha256};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's directory, or a state file.
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
    let state = State::read(&path)?;
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
