//! `meniscus presets [NAME]`

use super::{CommandError, Verdict};
use crate::configuration::{PRESETS, preset};
use std::io::Write;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Print this preset as a complete configuration.
    name: Option<String>,
}

pub(super) fn run(arguments: &Arguments, output: &mut impl Write) -> Result<Verdict, CommandError> {
    match &arguments.name {
        Some(name) => write!(output, "{}", preset(name)?.complete()?)?,
        None => {
            for preset in PRESETS {
                writeln!(output, "{:<12}{}", preset.name, preset.summary)?;
            }
        }
    }
    Ok(Verdict::Ok)
}
