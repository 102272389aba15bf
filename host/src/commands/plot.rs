//! `meniscus plot DIR`

use super::{CommandError, Reporter, Verdict};
use crate::figures::tables;
use crate::files::FileError;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The directory of a run or of an ensemble.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Directory for the figures, by default `figures` in that directory.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let figures = tables::figures(&arguments.directory)?;
    let out = arguments.out.clone().unwrap_or_else(|| arguments.directory.join("figures"));
    std::fs::create_dir_all(&out).map_err(|problem| FileError::Write { path: out.clone(), problem })?;
    let mut files = Vec::with_capacity(2 * figures.len());
    for (name, figure) in &figures {
        figure.write(&out.join(name))?;
        for ending in ["svg", "png"] {
            files.push(out.join(format!("{name}.{ending}")).display().to_string());
        }
    }
    for file in &files {
        reporter.text(&format!("{file}\n"))?;
    }
    reporter.json(|| serde_json::json!({ "figures": files }))?;
    Ok(Verdict::Ok)
}
