//! The paper, reproduced: every figure from its runs, with error bars, beside theory, and a verdict on each claim.
//!
//! In: which figures ([`catalogue`]), how large, and a directory. Out, in the directory: the runs of each
//! [`campaign`] as an ensemble of its own with gathered tables, the `figures` as SVG and PNG, and `report.md` and
//! `report.html` ([`report`]). Runs that have finished are kept and unfinished ones go on, so the same call again
//! continues; the report can be made at any time of what has finished.
//!
//! ```
//! use meniscus::reproduce::campaign::Size;
//! use meniscus::reproduce::catalogue::entry;
//! use meniscus::reproduce::{report_on, rounds};
//!
//! let chosen = [entry("fig-12").unwrap(), entry("fig-13").unwrap()];
//! let rounds = rounds(&chosen, Size::Tiny, None);
//! assert_eq!(rounds.len(), 1, "the two figures show the same runs");
//! let folder = tempfile::tempdir()?;
//! let report = report_on(&chosen, folder.path(), Size::Tiny, None)?;
//! assert_eq!((report.sections[0].finished, report.sections[0].planned), (0, 4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod campaign;
pub mod catalogue;
mod error;
pub mod evidence;
pub mod figures;
pub mod finding;
pub mod numbers;
pub mod report;
pub mod statistics;

pub use error::ReproduceError;
pub use report::Picture;

use crate::ensemble::{self, Observer, Selection, gather_sweep};
use crate::files::atomic::write_atomically;
use campaign::{Campaign, Size};
use catalogue::Entry;
use evidence::{Evidence, sweep};
use report::{CampaignRecord, Report, RunRecord, Section};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Numbers of seeds after which all campaigns have their turn, so that there is something of everything early.
const TURNS: [u32; 4] = [2, 5, 10, 20];

/// Name of the report as Markdown.
pub const MARKDOWN: &str = "report.md";

/// Name of the report as HTML.
pub const HTML: &str = "report.html";

/// Name of the folder of figures.
pub const FIGURES: &str = "figures";

/// A campaign up to a number of seeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Round {
    /// Which campaign.
    pub campaign: Campaign,
    /// How many seeds.
    pub seeds: u32,
}

/// The campaigns that figures take, each once, those done soonest first.
#[must_use]
pub fn campaigns(entries: &[&Entry]) -> Vec<Campaign> {
    let is_taken = |campaign: &Campaign| entries.iter().any(|entry| entry.campaigns.contains(campaign));
    Campaign::ALL.into_iter().filter(is_taken).collect()
}

/// What is to be run one after the other; with `seeds` instead of the campaigns' own numbers.
#[must_use]
pub fn rounds(entries: &[&Entry], size: Size, seeds: Option<u32>) -> Vec<Round> {
    let campaigns = campaigns(entries);
    let all = |campaign: Campaign| match campaign.seeds(size) {
        1 => 1,
        own => seeds.unwrap_or(own),
    };
    let mut rounds: Vec<Round> = Vec::new();
    for turn in TURNS.into_iter().chain([u32::MAX]) {
        for &campaign in &campaigns {
            let round = Round { campaign, seeds: all(campaign).min(turn) };
            if !rounds.contains(&round) {
                rounds.push(round);
            }
        }
    }
    rounds
}

/// What running needs besides a round. None of it shows in the results.
#[derive(Clone, Copy, Debug)]
pub struct Machinery<'a> {
    /// Threads, at least 1.
    pub workers: usize,
    /// When the wall time allowed is over.
    pub deadline: Option<Instant>,
    /// Raised by whoever wants all runs to stop, a checkpoint written.
    pub stop: &'a AtomicBool,
}

/// Runs a round below `directory`, as far as nobody stops it, and gathers its tables, which nobody stops.
///
/// # Errors
/// [`ReproduceError::Ensemble`]; what became of the runs is in the report.
pub fn advance(
    round: Round,
    directory: &Path,
    size: Size,
    machinery: Machinery<'_>,
    observer: &dyn Observer,
) -> Result<ensemble::Report, ReproduceError> {
    let Machinery { workers, deadline, stop } = machinery;
    let sweep = sweep(round.campaign, size, Some(round.seeds))?;
    let ensemble = directory.join(round.campaign.name());
    let request = ensemble::Request { selection: Selection::All, workers, deadline, stop };
    let report = ensemble::run(&sweep, &ensemble, &request, observer)?;
    gather_sweep(&sweep, &ensemble, &AtomicBool::new(false))?;
    Ok(report)
}

/// The report on `entries` of what has finished below `directory`.
///
/// # Errors
/// [`ReproduceError`].
pub fn report_on(
    entries: &[&Entry],
    directory: &Path,
    size: Size,
    seeds: Option<u32>,
) -> Result<Report, ReproduceError> {
    report_of(entries, &evidence(entries, directory, size, seeds)?, seeds)
}

/// What has finished below `directory` of the runs that `entries` take.
///
/// # Errors
/// [`ReproduceError`].
pub fn evidence(
    entries: &[&Entry],
    directory: &Path,
    size: Size,
    seeds: Option<u32>,
) -> Result<Evidence, ReproduceError> {
    fs::create_dir_all(directory)
        .map_err(|source| ReproduceError::Directory { path: directory.to_owned(), source })?;
    Evidence::collect(directory, size, seeds, &campaigns(entries))
}

/// The report on `entries` by what is there, which was looked for with the same `seeds`.
///
/// # Errors
/// [`ReproduceError`].
pub fn report_of(
    entries: &[&Entry],
    evidence: &Evidence,
    seeds: Option<u32>,
) -> Result<Report, ReproduceError> {
    let section = |entry: &&Entry| -> Result<Section, ReproduceError> {
        let built = (entry.build)(evidence)?;
        let count =
            |of: &dyn Fn(Campaign) -> usize| entry.campaigns.iter().map(|&campaign| of(campaign)).sum();
        Ok(Section {
            name: entry.name.to_owned(),
            title: entry.title.to_owned(),
            paper: entry.paper.to_owned(),
            pictures: built.pictures,
            findings: built.findings,
            notes: built.notes,
            finished: count(&|campaign| evidence.of(campaign).len()),
            planned: count(&|campaign| evidence.planned(campaign)),
        })
    };
    let sections = entries.iter().map(section).collect::<Result<_, _>>()?;
    let record = |&campaign: &Campaign| record(campaign, evidence, seeds);
    let campaigns = campaigns(entries).iter().map(record).collect();
    Ok(Report { size: evidence.size, sections, campaigns })
}

/// The runs of a campaign and how they are repeated.
fn record(campaign: Campaign, evidence: &Evidence, seeds: Option<u32>) -> CampaignRecord {
    let size = evidence.size;
    let overrides: String =
        campaign.overrides(size).iter().map(|text| format!(" \\\n    --set '{text}'")).collect();
    let length = if campaign.lengths(size).is_empty() { "" } else { " --set system.capillary_length=LENGTH" };
    let runs = evidence.of(campaign).into_iter().map(|run| RunRecord {
        hash: run.hash.clone(),
        seed: run.configuration.seed,
        capillary_length: run.length(),
        steps: run.steps,
        digest: run.digest.clone(),
    });
    CampaignRecord {
        name: campaign.name().to_owned(),
        sweep: campaign.sweep(size, seeds),
        command: format!("meniscus run {} --seed SEED{length}{overrides} --out again", campaign.preset()),
        planned: evidence.planned(campaign),
        runs: runs.collect(),
    }
}

/// A file of a report: its path below the directory, and what is in it.
pub type ReportFile = (PathBuf, Vec<u8>);

/// The files of a report, figures first. Nothing is written.
///
/// # Errors
/// [`ReproduceError::Figure`].
pub fn files(report: &Report) -> Result<Vec<ReportFile>, ReproduceError> {
    let mut files = Vec::new();
    for picture in report.sections.iter().flat_map(|section| &section.pictures) {
        let path = |ending: &str| Path::new(FIGURES).join(format!("{}.{ending}", picture.stem));
        files.push((path("png"), crate::figures::png(&picture.svg)?));
        files.push((path("svg"), picture.svg.clone().into_bytes()));
    }
    files.push((MARKDOWN.into(), report.markdown().into_bytes()));
    files.push((HTML.into(), report.html().into_bytes()));
    Ok(files)
}

/// Writes the files of a report to `directory`.
///
/// # Errors
/// [`ReproduceError::Directory`], [`ReproduceError::File`].
pub fn write(files: &[ReportFile], directory: &Path) -> Result<(), ReproduceError> {
    let figures = directory.join(FIGURES);
    fs::create_dir_all(&figures)
        .map_err(|source| ReproduceError::Directory { path: figures.clone(), source })?;
    Ok(files.iter().try_for_each(|(path, bytes)| write_atomically(&directory.join(path), bytes))?)
}

#[cfg(test)]
mod tests;
