//! Evidence: the finished runs of campaigns, and their tables as curves ([`curves`]).
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

mod rows;

pub use rows::{curves, curves_of};

use super::ReproduceError;
use super::campaign::{Campaign, Reach, Size};
use super::statistics::Row;
use crate::configuration::Configuration;
use crate::ensemble::{Bins, Member, Standing, Sweep};
use crate::files::table::Table;
use crate::files::trajectory::{Recorded, TrajectoryReader};
use crate::files::{FileError, FormatError};
use crate::observables::series::Series;
use rows::{binned, selected};
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
    /// What intervals of its tables count in, R0²/D: Jeans' time.
    pub time_unit: f64,
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
    /// [`ReproduceError::Table`] if it is gone or damaged.
    pub fn table(&self, series: Series) -> Result<Table, ReproduceError> {
        Table::read(&self.path(series)).map_err(damaged)
    }

    fn path(&self, series: Series) -> PathBuf {
        self.directory.join(series.file_name())
    }

    /// Times (t/T) and values of a column of a table, in the rows in which the column `key.0` is `key.1`.
    ///
    /// # Errors
    /// [`ReproduceError::Table`].
    pub fn column(
        &self,
        series: Series,
        column: &str,
        key: Option<(&str, f64)>,
    ) -> Result<Vec<(f64, Option<f64>)>, ReproduceError> {
        let table = self.table(series)?;
        let rows = selected(&table, column, key).map_err(|problem| self.refused(series, problem))?;
        Ok(rows.into_iter().map(|(_, time, value)| (time, value)).collect())
    }

    /// The same with the bins that rows belong to: those of the multiple of the table's interval at which they were due,
    /// as in gathered tables.
    ///
    /// # Errors
    /// [`ReproduceError::Table`], also for a second row of a bin.
    pub fn rows(
        &self,
        series: Series,
        column: &str,
        key: Option<(&str, f64)>,
    ) -> Result<Vec<Row>, ReproduceError> {
        let table = self.table(series)?;
        let Some(bins) = Bins::of(series, &self.configuration.output, self.time_unit) else {
            return Ok(Vec::new());
        };
        binned(&table, bins, column, key).map_err(|problem| self.refused(series, problem))
    }

    fn refused(&self, series: Series, problem: FormatError) -> ReproduceError {
        ReproduceError::Table { path: self.path(series), problem }
    }

    /// The first frame of its trajectory at or after a time (t/T), give or take a step; None if there is none.
    ///
    /// # Errors
    /// [`ReproduceError::Table`] if the trajectory is gone or damaged.
    pub fn frame(&self, time_over_jeans: f64) -> Result<Option<Recorded>, ReproduceError> {
        let name = self.configuration.output.trajectory_format.file_name();
        let mut reader = TrajectoryReader::open(&self.directory.join(name), None).map_err(damaged)?;
        while let Some(frame) = reader.read_frame().map_err(damaged)? {
            if frame.time_over_jeans.is_some_and(|time| time >= time_over_jeans - 1e-9) {
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }
}

/// What is wrong with a file of a finished run: it is made by running anew.
fn damaged(error: FileError) -> ReproduceError {
    match error {
        FileError::Read { path, problem } => ReproduceError::Table { path, problem },
        other => other.into(),
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
        time_unit: finished.time_unit,
        steps: finished.step,
        digest: finished.digest,
    })
}
