//! `meniscus presets [NAME]`

use super::{CommandError, Reporter, Verdict};
use crate::configuration::{PRESETS, Preset, preset};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Print this preset as a complete configuration.
    name: Option<String>,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    match &arguments.name {
        Some(name) => {
            let configuration = preset(name)?.complete()?;
            reporter.text(&configuration)?;
            reporter.json(|| serde_json::json!({ "name": name, "configuration": configuration }))?;
        }
        None => {
            let line = |preset: &Preset| format!("{:<12}{}\n", preset.name, preset.summary);
            reporter.text(&PRESETS.iter().map(line).collect::<String>())?;
            let object =
                |preset: &Preset| serde_json::json!({ "name": preset.name, "summary": preset.summary });
            reporter
                .json(|| serde_json::json!({ "presets": PRESETS.iter().map(object).collect::<Vec<_>>() }))?;
        }
    }
    Ok(Verdict::Ok)
}
