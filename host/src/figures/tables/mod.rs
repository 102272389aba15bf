//! The figures of a run's or an ensemble's tables, one a subject.
//!
//! In: a directory with tables of observables, and configurations beside them: `config.toml` of a run, `members.csv` and
//! `runs` of an ensemble. Out: named figures. Tables that do not exist, or have no rows yet, have no figures. Where a
//! configuration is known, curves are told by λ/L, numbers are per area or disc, and theory is drawn.
//!
//! ```
//! use meniscus::figures::tables;
//!
//! let folder = tempfile::tempdir().unwrap();
//! let text = "step,time,time_over_jeans,distance,g\n0,0,0,2.5,1.25\n0,0,0,3.5,0.75\n";
//! std::fs::write(folder.path().join("radial_distribution.csv"), text).unwrap();
//! let figures = tables::figures(folder.path()).unwrap();
//! assert_eq!(figures[0].0, "radial_distribution");
//! assert!(figures[0].1.svg().unwrap().contains("</svg>"));
//! ```

mod curves;
mod groups;
mod minkowski;
mod modes;
mod observables;
mod profiles;
mod radii;

use super::Figure;
use crate::configuration::ConfigurationError;
use crate::files::table::Table;
use crate::files::{FileError, FormatError};
use groups::Group;
use std::path::{Path, PathBuf};

/// Why the tables of a directory could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum TablesError {
    /// There is nothing to draw.
    #[error("{}: found no table with rows, expected at least one of {}: name the directory of a run or of an ensemble", .0.display(), NAMES.join(", "))]
    NoTables(PathBuf),
    /// A table is not what it should be.
    #[error(transparent)]
    File(#[from] FileError),
    /// A configuration beside the tables cannot be read.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
}

/// The tables that are drawn.
const NAMES: [&str; 6] = [
    "observables.csv",
    "minkowski.csv",
    "modes.csv",
    "radial_distribution.csv",
    "structure_factor.csv",
    "radii.csv",
];

/// A figure and its name, which is that of a file without its ending.
pub type Named = (String, Figure);

/// What makes figures of the groups of a table.
type Builder = fn(&[Group]) -> Result<Vec<Named>, FormatError>;

/// What makes the figures of each of [`NAMES`].
const BUILDERS: [Builder; 6] = [
    observables::figures,
    minkowski::figures,
    modes::figures,
    profiles::radial_distribution,
    profiles::structure_factor,
    radii::figures,
];

/// All figures of the tables in `directory`.
///
/// # Errors
/// [`TablesError`] if there is no table with rows, or if one cannot be read.
pub fn figures(directory: &Path) -> Result<Vec<Named>, TablesError> {
    let mut figures = Vec::new();
    for (name, build) in NAMES.into_iter().zip(BUILDERS) {
        let path = directory.join(name);
        if !path.exists() {
            continue;
        }
        let table = Table::read(&path)?;
        if table.is_empty() {
            continue;
        }
        let groups = groups::groups(directory, table, &path)?;
        figures.extend(build(&groups).map_err(|problem| FileError::Read { path, problem })?);
    }
    if figures.is_empty() {
        return Err(TablesError::NoTables(directory.to_owned()));
    }
    Ok(figures)
}
