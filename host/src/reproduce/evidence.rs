//! Evidence: the finished runs of campaigns, and their tables as curves.
//!
//! A campaign's runs are an ensemble in the directory of that name. What has not finished is not there; everything here
//! makes do with what is.
//!
//! ```
//! use meniscus::reproduce::campaign::{Campaign, Size};
//! use meniscus::reproduce::evidence::Evidence;
//!
//! let folder = tempfile::tempdir()?;
//! let evidence = Evidence::collect(folder.path(), Size::Tiny, None, &[Campaign::Disc])?;
//! assert_eq!((evidence.of(Campaign::Disc).len(), evidence.planned(Campaign::Disc)), (0, 2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::ReproduceError;
use super::campaign::{Campaign, Reach, Size};
use super::statistics::Curves;
use crate::configuration::Configuration;
use crate::ensemble::{Member, Standing, Sweep};
use crate::files::table::Table;
use crate::files::trajectory::{Recorded, TrajectoryReader};
use crate::observables::series::Series;
use std::path::{Path, PathBuf};

/// A finished run.
#[derive(Clone, Debug)]
pub struct FinishedRun {
    /// Which campaign it belongs to.
    pub campaign: Campaign,
    /// What was run.
    pub configuration: Configuration,
    /// Name of its directory, from its configuration.
    pub hash: String,
    /// Its directory.
    pub directory: PathBuf,
    /// Steps made.
    pub steps: u64,
    /// SHA-256 of its last state.
    pub digest: String,
}

impl FinishedRun {
    /// λ, R0.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.configuration.system.capillary_length
    }

    /// A table of the run.
    ///
    /// # Errors
    /// [`ReproduceError::File`].
    pub fn table(&self, series: Series) -> Result<Table, ReproduceError> {
        Ok(Table::read(&self.path(series))?)
    }

    fn path(&self, series: Series) -> PathBuf {
        self.directory.join(series.file_name())
    }

    /// Times (t/T) and values of a column of a table, in the rows in which the column `key.0` is `key.1`.
    ///
    /// # Errors
    /// [`ReproduceError::File`], [`ReproduceError::Table`].
    pub fn column(
        &self,
        series: Series,
        column: &str,
        key: Option<(&str, f64)>,
    ) -> Result<Vec<(f64, Option<f64>)>, ReproduceError> {
        let refused = |problem| ReproduceError::Table { path: self.path(series), problem };
        let table = self.table(series)?;
        let times = table.numbers("time_over_jeans").map_err(refused)?;
        let values = table.numbers(column).map_err(refused)?;
        let keys = match key {
            Some((name, _)) => table.numbers(name).map_err(refused)?,
            None => Vec::new(),
        };
        let holds = |row: usize| {
            key.is_none_or(|(_, wanted)| {
                let found = keys.get(row).copied().flatten();
                found.is_some_and(|found| (found - wanted).abs() <= 1e-9 * wanted.abs())
            })
        };
        let rows = times.into_iter().zip(values).enumerate().filter(|(row, _)| holds(*row));
        Ok(rows.filter_map(|(_, (time, value))| Some((time?, value))).collect())
    }

    /// The first frame of its trajectory at or after a time (t/T), give or take a step; None if there is none.
    ///
    /// # Errors
    /// [`ReproduceError::File`].
    pub fn frame(&self, time_over_jeans: f64) -> Result<Option<Recorded>, ReproduceError> {
        let name = self.configuration.output.trajectory_format.file_name();
        let mut reader = TrajectoryReader::open(&self.directory.join(name), None)?;
        while let Some(frame) = reader.read_frame()? {
            if frame.time_over_jeans.is_some_and(|time| time >= time_over_jeans - 1e-9) {
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }
}

/// What has finished of some campaigns.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// How large the runs are.
    pub size: Size,
    /// The directory in which the campaigns are.
    pub directory: PathBuf,
    finished: Vec<FinishedRun>,
    planned: Vec<(Campaign, usize)>,
}

impl Evidence {
    /// Looks what has finished of `campaigns` below `directory`; with `seeds` instead of their own numbers of runs.
    ///
    /// # Errors
    /// [`ReproduceError::Ensemble`] for a sweep that is refused. A run that is damaged counts as not finished.
    pub fn collect(
        directory: &Path,
        size: Size,
        seeds: Option<u32>,
        campaigns: &[Campaign],
    ) -> Result<Self, ReproduceError> {
        let mut evidence =
            Self { size, directory: directory.to_owned(), finished: Vec::new(), planned: Vec::new() };
        for &campaign in campaigns {
            let ensemble = directory.join(campaign.name());
            let sweep = sweep(campaign, size, seeds)?;
            evidence.planned.push((campaign, sweep.members().len()));
            evidence
                .finished
                .extend(sweep.members().iter().filter_map(|member| finished(campaign, member, &ensemble)));
        }
        Ok(evidence)
    }

    /// The finished runs of a campaign, in the order of its sweep.
    #[must_use]
    pub fn of(&self, campaign: Campaign) -> Vec<&FinishedRun> {
        self.finished.iter().filter(|run| run.campaign == campaign).collect()
    }

    /// Those with a capillary length, R0.
    #[must_use]
    pub fn with_length(&self, campaign: Campaign, length: f64) -> Vec<&FinishedRun> {
        self.of(campaign).into_iter().filter(|run| run.length() == length).collect()
    }

    /// The finished runs of Figs. 3 to 11 with a capillary length.
    #[must_use]
    pub fn reach(&self, reach: &Reach) -> Vec<&FinishedRun> {
        self.with_length(Campaign::Clustering, reach.length(self.size))
    }

    /// How many runs a campaign is to have.
    #[must_use]
    pub fn planned(&self, campaign: Campaign) -> usize {
        self.planned.iter().filter(|(other, _)| *other == campaign).map(|(_, count)| count).sum()
    }
}

/// The sweep of a campaign, every configuration checked.
///
/// # Errors
/// [`ReproduceError::Ensemble`].
pub fn sweep(campaign: Campaign, size: Size, seeds: Option<u32>) -> Result<Sweep, ReproduceError> {
    let name = format!("sweep {}", campaign.name());
    Ok(Sweep::from_text(&name, &campaign.sweep(size, seeds), Path::new(""))?)
}

fn finished(campaign: Campaign, member: &Member, ensemble: &Path) -> Option<FinishedRun> {
    let Ok(Standing::Finished(finished)) = Standing::of(member, ensemble) else { return None };
    Some(FinishedRun {
        campaign,
        configuration: member.configuration.clone(),
        hash: member.hash.clone(),
        directory: member.directory(ensemble),
        steps: finished.step,
        digest: finished.digest,
    })
}

/// A column of several runs, row by row: rows of the same number belong to the same interval of the output.
///
/// # Errors
/// [`ReproduceError::File`], [`ReproduceError::Table`].
pub fn curves(
    runs: &[&FinishedRun],
    series: Series,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Curves, ReproduceError> {
    let columns: Vec<Vec<(f64, Option<f64>)>> =
        runs.iter().map(|run| run.column(series, column, key)).collect::<Result<_, _>>()?;
    let rows = columns.iter().map(Vec::len).min().unwrap_or(0);
    let time = |row: usize| {
        let times = columns.iter().filter_map(|column| column.get(row)).map(|(time, _)| time);
        times.sum::<f64>() / columns.len() as f64
    };
    let times = (0..rows).map(time).collect();
    let values = columns.iter().map(|column| column.iter().map(|(_, value)| *value).collect());
    Ok(Curves::new(times, values.collect()))
}
