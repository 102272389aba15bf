//! `meniscus plot DIR`

use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::figures::tables::{self, TablesError};
use crate::files::FileError;
use crate::files::atomic::write_atomically;
use crate::observables::series::Series;
use std::path::{Path, PathBuf};

/// How many directories a message names.
const MOST_NAMED: usize = 6;

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
    let stop = StopSignal::catch()?;
    let directory = &arguments.directory;
    if directory.is_file() {
        return Err(CommandError::OneTable(directory.clone()));
    }
    let figures = tables::figures(directory).map_err(|error| refusal(error, directory))?;
    let out = arguments.out.clone().unwrap_or_else(|| directory.join("figures"));
    // All are drawn before the first is written: there are those of these tables, or those that were there.
    let mut files = Vec::with_capacity(2 * figures.len());
    for (name, figure) in &figures {
        if stop.is_raised() {
            return Err(CommandError::Interrupted { path: out });
        }
        let svg = figure.svg()?;
        let png = crate::figures::png(&svg)?;
        files.extend(
            [("svg", svg.into_bytes()), ("png", png)]
                .map(|(ending, bytes)| (out.join(format!("{name}.{ending}")), bytes)),
        );
    }
    std::fs::create_dir_all(&out).map_err(|problem| FileError::Write { path: out.clone(), problem })?;
    for (path, bytes) in &files {
        write_atomically(path, bytes)?;
    }
    let names: Vec<String> = files.iter().map(|(path, _)| path.display().to_string()).collect();
    for name in &names {
        reporter.text(&format!("{name}\n"))?;
    }
    reporter.json(|| serde_json::json!({ "figures": names }))?;
    Ok(Verdict::Ok)
}

/// Why there is nothing to draw; if what is there lies one level deeper, as in a reproduction, where.
fn refusal(error: TablesError, directory: &Path) -> CommandError {
    let TablesError::NoTables(_) = error else { return error.into() };
    let mut inside = inside(directory);
    if inside.is_empty() {
        return error.into();
    }
    let more = inside.len().saturating_sub(MOST_NAMED);
    inside.truncate(MOST_NAMED);
    let mut names = inside.join(", ");
    if more > 0 {
        names.push_str(&format!(" and {more} others"));
    }
    CommandError::TablesInside { directory: directory.to_owned(), names }
}

/// The directories in `directory` that hold tables.
fn inside(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let has_tables =
        |path: &PathBuf| Series::ALL.iter().any(|series| path.join(series.file_name()).is_file());
    let paths = entries.map(|entry| entry.path()).filter(has_tables);
    let mut names: Vec<String> = paths.map(|path| path.display().to_string()).collect();
    names.sort();
    names
}
