//! Rows of the tables of runs, and of several runs the curves that they make together.

use super::FinishedRun;
use crate::ensemble::Bins;
use crate::files::FormatError;
use crate::files::table::Table;
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::statistics::{Curves, Row, Run};
use std::collections::BTreeSet;

/// Number, time (t/T) and value of the rows in which the column `key.0` is `key.1`.
pub(super) fn selected(
    table: &Table,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Vec<(usize, f64, Option<f64>)>, FormatError> {
    let times = table.numbers("time_over_jeans")?;
    let values = table.numbers(column)?;
    let keys = match key {
        Some((name, _)) => table.numbers(name)?,
        None => Vec::new(),
    };
    let holds = |row: usize| {
        key.is_none_or(|(_, wanted)| {
            let found = keys.get(row).copied().flatten();
            found.is_some_and(|found| (found - wanted).abs() <= 1e-9 * wanted.abs())
        })
    };
    let rows = times.into_iter().zip(values).enumerate().filter(|(row, _)| holds(*row));
    Ok(rows.filter_map(|(row, (time, value))| Some((row, time?, value))).collect())
}

/// The same rows with their bins, which `time` (R0²/D) tells, not the number of a row: where one is missing, none else is.
pub(super) fn binned(
    table: &Table,
    bins: Bins,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Vec<Row>, FormatError> {
    let moments = table.numbers("time")?;
    let mut found = BTreeSet::new();
    let mut rows = Vec::new();
    for (row, time, value) in selected(table, column, key)? {
        let Some(moment) = moments.get(row).copied().flatten() else { continue };
        let bin = bins.last_due(moment);
        if !found.insert(bin) {
            return Err(FormatError::Line {
                line: table.line(row),
                found: format!("a second row of bin {bin}"),
                expected: "one".to_owned(),
            });
        }
        rows.push(Row { bin, time, value });
    }
    Ok(rows)
}

/// A column of several runs: rows belong together that were due at the same multiple of their interval.
///
/// # Errors
/// [`ReproduceError::Table`].
pub fn curves(
    runs: &[&FinishedRun],
    series: Series,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Curves, ReproduceError> {
    curves_of(runs, |run| run.rows(series, column, key))
}

/// What `rows` makes of the tables of several runs.
///
/// # Errors
/// Those of `rows`.
pub fn curves_of(
    runs: &[&FinishedRun],
    rows: impl Fn(&FinishedRun) -> Result<Vec<Row>, ReproduceError>,
) -> Result<Curves, ReproduceError> {
    let run = |run: &&FinishedRun| Ok(Run { seed: run.configuration.seed, rows: rows(run)? });
    let runs: Vec<Run> = runs.iter().map(run).collect::<Result<_, ReproduceError>>()?;
    Ok(Curves::new(&runs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::Configuration;
    use crate::reproduce::campaign::Campaign;
    use std::path::Path;

    const INTERVAL: f64 = 0.05;

    /// A run in `folder` with rows of these bins, each at the first step after it was due, of ten times the bin.
    fn run(folder: &Path, seed: u64, bins: &[u64]) -> FinishedRun {
        let overrides = ["force.method=pm", "mesh.grid=64"].map(str::to_owned);
        let mut configuration = Configuration::from_preset("fig-7", &overrides).unwrap();
        (configuration.seed, configuration.output.observables) = (seed, INTERVAL);
        let time_unit = configuration.jeans_time().unwrap();
        let late = 1e-3 * seed as f64;
        let mut text = "step,time,time_over_jeans,clusters\n".to_owned();
        for bin in bins {
            let time = INTERVAL * *bin as f64 + late;
            text.push_str(&format!("1,{},{time},{}\n", time * time_unit, 10 * bin));
        }
        let directory = folder.join(seed.to_string());
        std::fs::create_dir_all(&directory).unwrap();
        std::fs::write(directory.join("observables.csv"), text).unwrap();
        let (hash, digest) = Default::default();
        FinishedRun {
            campaign: Campaign::Clustering,
            configuration,
            hash,
            directory,
            time_unit,
            steps: 1,
            digest,
        }
    }

    #[test]
    fn a_run_without_a_row_shifts_no_other() {
        let folder = tempfile::tempdir().unwrap();
        let runs = [run(folder.path(), 1, &[0, 1, 2, 3, 4]), run(folder.path(), 2, &[0, 2, 3, 4])];
        let runs: Vec<&FinishedRun> = runs.iter().collect();
        let means = curves(&runs, Series::Observables, "clusters", None).unwrap().means();
        let (times, values): (Vec<f64>, Vec<f64>) =
            means.iter().map(|(time, mean)| (*time, mean.value)).unzip();
        assert_eq!(values, [0.0, 10.0, 20.0, 30.0, 40.0]);
        // Where both have a row, 1.5e-3 late on average; the second lacks one.
        for (time, expected) in times.iter().zip([0.0015, 0.051, 0.1015, 0.1515, 0.2015]) {
            assert!((time - expected).abs() < 1e-12, "{time}, not {expected}");
        }
        assert!(means[1].1.error.is_nan() && means[2].1.error == 0.0);
    }

    #[test]
    fn two_rows_of_a_bin_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let damaged = run(folder.path(), 1, &[0, 1, 1]);
        let error = curves(&[&damaged], Series::Observables, "clusters", None).unwrap_err().to_string();
        assert!(error.contains("observables.csv") && error.contains("a second row of bin 1"), "{error}");
        assert!(error.contains('4') && !error.contains('\n'), "{error}");
    }
}
