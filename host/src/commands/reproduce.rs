//! `meniscus reproduce [FIGURE]…`

use super::drawing::{Drawing, Reason};
use super::machinery::{MOST_THREADS, processors};
use super::members::Members;
use super::run::{WallTime, quoted};
use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::ensemble::{Fate, MemberError};
use crate::reproduce::campaign::Size;
use crate::reproduce::catalogue::{CATALOGUE, Entry, entry};
use crate::reproduce::evidence::sweep;
use crate::reproduce::finding::Verdict as Found;
use crate::reproduce::report::Report;
use crate::reproduce::{HTML, MARKDOWN, Machinery, advance, rounds};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often the report is written while runs are made, at most.
const REPORT_INTERVAL: Duration = Duration::from_secs(60);

/// Share of the time that goes into reports while runs are made, inverted: nothing is run meanwhile.
const RUNS_PER_REPORT: u32 = 20;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Which figures of the paper: fig-2 to fig-14, or all; text, forces, energy and meshes are ours.
    #[arg(value_name = "FIGURE", default_value = "all", value_parser = figure)]
    figures: Vec<&'static str>,
    /// A small version of the same: minutes instead of hours.
    #[arg(long)]
    quick: bool,
    /// Directory for runs, figures and report; where there are some already, finished runs are kept and others go on. By
    /// default `reproduction`, or `reproduction-quick`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads, at most; as many as there are processors by default. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    workers: Option<u16>,
    /// Runs that differ in nothing but the seed, instead of the paper's numbers; those that are there are kept.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    seeds: Option<u32>,
    /// Run nothing; make figures and report of what has finished.
    #[arg(long)]
    draw_only: bool,
    #[command(flatten)]
    wall_time: WallTime,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let deadline = arguments.wall_time.deadline();
    let size = if arguments.quick { Size::Quick } else { Size::Full };
    let entries: Vec<&'static Entry> = if arguments.figures.contains(&ALL) {
        CATALOGUE.iter().collect()
    } else {
        CATALOGUE.iter().filter(|entry| arguments.figures.contains(&entry.name)).collect()
    };
    let directory = arguments.out.clone().unwrap_or_else(|| default_directory(size));
    let workers = arguments.workers.map_or_else(processors, usize::from);
    let stop = StopSignal::catch()?;
    let machinery = Machinery { workers, deadline, stop: stop.flag() };
    let rounds = if arguments.draw_only { Vec::new() } else { rounds(&entries, size, arguments.seeds) };
    let mut failures: Vec<(String, usize, String)> = Vec::new();
    let mut reason = Reason::End;
    let drawing = Drawing { entries, directory: directory.clone(), size, seeds: arguments.seeds };
    let mut last = None;
    // By campaigns: a later turn of one sees the runs of the earlier again.
    let mut elsewhere = BTreeMap::new();
    let (mut written, mut took) = (Instant::now(), Duration::ZERO);
    for (number, round) in rounds.iter().enumerate() {
        let count = sweep(round.campaign, size, Some(round.seeds))?.members().len();
        let name = round.campaign.name();
        reporter.note(&format!(
            "{} of {}: {name}, {count} runs, {workers} threads",
            number + 1,
            rounds.len()
        ));
        let members = Members::new(count, reporter);
        let outcome = advance(*round, &directory, size, machinery, &members);
        members.finish();
        let outcome = outcome?;
        let said = |error: &MemberError| error.to_string().replace('\n', " ");
        failures.extend(outcome.failures().map(|(index, error)| (name.to_owned(), index, said(error))));
        let unfinished = outcome.count(|fate| matches!(fate, Fate::Stopped(_) | Fate::Waiting));
        elsewhere.insert(name, outcome.count(|fate| matches!(fate, Fate::Elsewhere)));
        if stop.take() {
            reason = Reason::Stopped;
            break;
        }
        if unfinished > 0 {
            reason = Reason::WallTime;
            break;
        }
        if number + 1 < rounds.len() && written.elapsed() >= REPORT_INTERVAL.max(RUNS_PER_REPORT * took) {
            let begun = Instant::now();
            let (report, told) = drawing.draw(Reason::Time, &stop, reporter)?;
            (written, took) = (Instant::now(), begun.elapsed());
            if told == Reason::Stopped {
                (reason, last) = (told, Some(report));
                break;
            }
        }
    }
    let report = match last {
        Some(report) => report,
        None => drawing.draw(reason, &stop, reporter)?.0,
    };
    if matches!(reason, Reason::Stopped | Reason::WallTime) {
        let directory = quoted(&directory.display().to_string());
        reporter.note(&format!("stopped; the same command goes on, with --out {directory}"));
    }
    let elsewhere: usize = elsewhere.into_values().sum();
    if elsewhere > 0 {
        reporter.note(&format!("{elsewhere} runs are at work in another program"));
    }
    conclude(&report, &directory, reporter)?;
    match failures.into_iter().next() {
        Some((campaign, index, reason)) => Err(CommandError::Reproduction { campaign, index, reason }),
        None => Ok(Verdict::Ok),
    }
}

/// Tells what there is now.
fn conclude(report: &Report, directory: &Path, reporter: &mut Reporter<'_>) -> std::io::Result<()> {
    let counts = Found::ALL.map(|verdict| (verdict.word(), report.count(verdict)));
    let finished: usize = report.campaigns.iter().map(|campaign| campaign.runs.len()).sum();
    let planned: usize = report.campaigns.iter().map(|campaign| campaign.planned).sum();
    let found = counts.map(|(word, count)| format!("{count} {word}")).join(", ");
    let [markdown, html] = [MARKDOWN, HTML].map(|name| directory.join(name).display().to_string());
    reporter.text(&format!("{finished} of {planned} runs; {found}\n{markdown}\n{html}\n"))?;
    reporter.json(|| {
        let verdicts = counts.map(|(word, count)| (word.to_owned(), serde_json::json!(count)));
        serde_json::json!({
            "directory": directory.display().to_string(),
            "runs": planned,
            "finished": finished,
            "findings": serde_json::Value::Object(verdicts.into_iter().collect()),
            "report": [markdown.clone(), html.clone()],
        })
    })
}

/// The word for all figures.
const ALL: &str = "all";

fn figure(text: &str) -> Result<&'static str, String> {
    let name = if text == ALL { Some(ALL) } else { entry(text).map(|entry| entry.name) };
    name.ok_or_else(|| {
        let names: Vec<&str> = CATALOGUE.iter().map(|entry| entry.name).collect();
        format!("expected all, or some of {}", names.join(", "))
    })
}

/// Always the same, so that the same command goes on.
fn default_directory(size: Size) -> PathBuf {
    PathBuf::from(if size == Size::Full { "reproduction" } else { "reproduction-quick" })
}
