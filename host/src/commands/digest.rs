//! `meniscus digest DIR|FILE`

use super::{CommandError, Verdict};
use crate::files::state::State;
use sha2::{Digest as _, Sha256};
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A run's directory, or a state file.
    #[arg(value_name = "DIR|FILE")]
    path: PathBuf,
}

pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<Verdict, CommandError> {
    let mut path = arguments.path.clone();
    if path.is_dir() {
        path.push("final.state");
        if !path.exists() {
            return Err(CommandError::NoState(arguments.path.clone()));
        }
    }
    let bytes = State::read(&path)?.to_bytes();
    let hash = Sha256::digest(&bytes);
    write!(output, "{} ", bytes.len())?;
    hash.iter().try_for_each(|byte| write!(output, "{byte:02x}"))?;
    writeln!(output)?;
    Ok(Verdict::Ok)
}
