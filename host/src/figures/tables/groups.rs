//! The parts of a table that are one run, or one combination of an ensemble's swept values.

use super::TablesError;
use crate::configuration::Configuration;
use crate::figures::chart::Colour;
use crate::files::table::Table;
use crate::files::{FileError, FormatError};
use std::path::Path;

/// The rows of one run, or of one combination of swept values.
pub(super) struct Group {
    /// What tells it from the others; empty for a run.
    pub(super) label: String,
    /// Its colour among the others.
    pub(super) colour: Colour,
    /// Its number, from 0.
    pub(super) number: usize,
    /// Its rows.
    pub(super) table: Table,
    /// What was run, if that is known; of an ensemble the configuration of one of the seeds.
    pub(super) configuration: Option<Configuration>,
}

/// The column of a gathered table that numbers its times; swept keys are before it.
const BIN: &str = "bin";
/// The key that curves are told by as the paper does.
const CAPILLARY_LENGTH: &str = "system.capillary_length";

/// The groups of the table at `path`, in the order of their first rows.
pub(super) fn groups(directory: &Path, table: Table, path: &Path) -> Result<Vec<Group>, TablesError> {
    let refused = |problem: FormatError| FileError::Read { path: path.to_owned(), problem };
    let keys: Vec<String> = match table.column(BIN) {
        Some(_) => table.columns().take_while(|name| *name != BIN).map(str::to_owned).collect(),
        None => Vec::new(),
    };
    let mut parts = vec![(Vec::new(), table)];
    for key in &keys {
        let mut finer = Vec::new();
        for (values, table) in parts {
            for value in table.distinct(key).map_err(refused)? {
                let values: Vec<String> = values.iter().cloned().chain([value.to_owned()]).collect();
                finer.push((values, table.with(key, value).map_err(refused)?));
            }
        }
        parts = finer;
    }
    let count = parts.len();
    let ordered =
        parts.iter().all(|(values, _)| matches!(&values[..], [value] if value.parse::<f64>().is_ok()));
    let mut groups = Vec::with_capacity(count);
    for (number, (values, table)) in parts.into_iter().enumerate() {
        let configuration = configuration(directory, &keys, &values)?;
        groups.push(Group {
            label: label(&keys, &values, configuration.as_ref()),
            colour: if ordered { Colour::ordered(number, count) } else { Colour::Category(number) },
            number,
            table,
            configuration,
        });
    }
    Ok(groups)
}

/// What the values of the swept keys are called.
fn label(keys: &[String], values: &[String], configuration: Option<&Configuration>) -> String {
    let one = |(key, value): (&String, &String)| match configuration {
        Some(configuration) if key == CAPILLARY_LENGTH => {
            let ratio = configuration.system.capillary_length / configuration.system.side;
            format!("λ/L = {}", rounded(ratio))
        }
        _ => {
            let name = key.rsplit('.').next().unwrap_or(key);
            format!("{} = {}", plain(name), plain(value))
        }
    };
    keys.iter().zip(values).map(one).collect::<Vec<_>>().join(", ")
}

/// A number with at most three digits that count.
pub(super) fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2.0 - libm::floor(libm::log10(value.abs()))).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A text none of whose signs sets letters lower or higher.
fn plain(text: &str) -> String {
    text.replace('_', " ").replace('^', "\\^")
}

/// The configuration of a run in `directory`, or of a member of the ensemble there with these values.
fn configuration(
    directory: &Path,
    keys: &[String],
    values: &[String],
) -> Result<Option<Configuration>, TablesError> {
    let own = directory.join("config.toml");
    if own.exists() {
        return Ok(Some(Configuration::read(&own, &[])?));
    }
    let members = directory.join("members.csv");
    if !members.exists() {
        return Ok(None);
    }
    let refused = |problem: FormatError| FileError::Read { path: members.clone(), problem };
    let mut table = Table::read(&members)?;
    for (key, value) in keys.iter().zip(values) {
        table = table.with(key, value).map_err(refused)?;
    }
    for hash in table.text("hash").map_err(refused)? {
        let path = directory.join("runs").join(hash).join("config.toml");
        if path.exists() {
            return Ok(Some(Configuration::read(&path, &[])?));
        }
    }
    Ok(None)
}
