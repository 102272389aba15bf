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
use crate::observables::series::Series;
use groups::Group;
use std::path::{Path, PathBuf};

/// Why the tables of a directory could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum TablesError {
    /// There is nothing to draw.
    #[error("{}: found no table with rows, expected at least one of {}: name the directory of a run or of an ensemble", .0.display(), Series::ALL.map(Series::file_name).join(", "))]
    NoTables(PathBuf),
    /// A table is not what it should be.
    #[error(transparent)]
    File(#[from] FileError),
    /// A configuration beside the tables cannot be read.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
}

/// A figure and its name, which is that of a file without its ending.
pub type Named = (String, Figure);

/// What makes figures of the groups of a table.
type Builder = fn(&[Group]) -> Result<Vec<Named>, FormatError>;

/// What makes the figures of a series' table.
const fn builder(series: Series) -> Builder {
    match series {
        Series::Observables => observables::figures,
        Series::Minkowski => minkowski::figures,
        Series::Modes => modes::figures,
        Series::RadialDistribution => profiles::radial_distribution,
        Series::StructureFactor => profiles::structure_factor,
        Series::Radii => radii::figures,
    }
}

/// All figures of the tables in `directory`.
///
/// # Errors
/// [`TablesError`] if there is no table with rows, or if one cannot be read.
pub fn figures(directory: &Path) -> Result<Vec<Named>, TablesError> {
    let mut figures = Vec::new();
    for series in Series::ALL {
        let path = directory.join(series.file_name());
        if !path.exists() {
            continue;
        }
        let table = Table::read(&path)?;
        if table.is_empty() {
            continue;
        }
        let groups = groups::groups(directory, table, &path)?;
        figures.extend(builder(series)(&groups).map_err(|problem| FileError::Read { path, problem })?);
    }
    if figures.is_empty() {
        return Err(TablesError::NoTables(directory.to_owned()));
    }
    Ok(figures)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Panel;
    use crate::figures::chart::{Chart, Style};

    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    fn charts(figure: &Figure) -> Vec<&Chart> {
        let charts = figure.panels.iter().map(|panel| match panel {
            Panel::Chart(chart) => chart,
            Panel::Discs(_) => panic!("discs"),
        });
        charts.collect()
    }

    #[test]
    fn an_ensembles_values_are_curves_with_errors() {
        let text = "system.capillary_length,bin,time,time_over_jeans,threshold,runs,pixel_area,pixel_area_error,\
                    pixel_length,pixel_euler,pixel_shape,area,area_error,length,euler,shape\n\
                    5,0,0,0,0.14,2,1,0.5,1,1,,1,0.25,1,1,\n\
                    5,1,1,0.5,0.14,2,3,0.5,1,1,1.5,2,0.125,1,1,1.25\n\
                    50,0,0,0,0.14,2,1,,1,1,1,1,,1,1,1\n";
        let folder = folder(&[("minkowski.csv", text)]);
        let figures = figures(folder.path()).unwrap();
        assert_eq!(
            figures.iter().map(|figure| figure.0.as_str()).collect::<Vec<_>>(),
            ["minkowski", "minkowski_pixels"]
        );
        let charts = charts(&figures[0].1);
        let labels: Vec<&str> = charts[0].series.iter().map(|series| series.label.as_str()).collect();
        assert_eq!(labels, ["capillary length = 5", "capillary length = 50"]);
        let second = charts[0].series[0].points[1];
        assert_eq!((second.x, second.y, second.error), (0.5, 2.0, Some(0.125)));
        assert!(charts[3].series[0].points[0].y.is_nan());
    }

    #[test]
    fn a_runs_configuration_gives_measures_and_theory() {
        let configuration = crate::configuration::Configuration::from_preset("table-1", &[]).unwrap();
        let modes = "step,time,time_over_jeans,shell,wavenumber,amplitude,power,log_growth\n\
                     0,0,0,1,0.0126,1,1,0\n9,9,0.5,1,0.0126,2,4,0.7\n";
        let folder = folder(&[("config.toml", &configuration.to_toml()), ("modes.csv", modes)]);
        let figures = figures(folder.path()).unwrap();
        let chart = charts(&figures[0].1)[0];
        let line = chart.series.iter().rfind(|series| matches!(series.style, Style::Line(_))).unwrap();
        let end = line.points.last().unwrap();
        let instability = configuration.instability().unwrap();
        let rate = instability.growth_rate(0.0126) * instability.jeans_time;
        assert!((end.y / end.x - rate).abs() < 1e-12 * rate && rate > 0.5, "{end:?} {rate}");
    }

    #[test]
    fn what_is_missing_is_named() {
        let said = |files: &[(&str, &str)]| figures(folder(files).path()).unwrap_err().to_string();
        let expected = "found no table with rows, expected at least one of observables.csv, minkowski.csv";
        assert!(said(&[]).contains(expected));
        assert!(said(&[("radii.csv", "step,time\n")]).contains(expected));
        let wrong = said(&[("radial_distribution.csv", "step,time,distance\n0,0,1\n")]);
        assert!(wrong.ends_with("found no column g, expected one of step, time, distance"), "{wrong}");
        let wrong = said(&[("radial_distribution.csv", "step,time,distance,g\n0,0,1,x\n")]);
        assert!(wrong.ends_with("line 2: found `x`, expected a number in column g"), "{wrong}");
    }
}
