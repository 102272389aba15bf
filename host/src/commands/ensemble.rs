//! `meniscus ensemble SWEEP …` and `meniscus ensemble gather DIR`

use super::machinery::{MOST_THREADS, processors};
use super::members::Members;
use super::run::{WallTime, quoted};
use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::ensemble::{
    Fate, Gathered, MemberError, Report, Request, Selection, Sweep, gather_sweep, run as run_members,
};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    instead: Option<Instead>,
    /// A sweep's file: a preset or configuration, seeds, and values of keys.
    #[arg(value_name = "SWEEP", required = true)]
    sweep: Option<PathBuf>,
    /// Directory for the results; where there are some already, finished members are kept and others go on. By default
    /// one below `ensembles` with the name of the sweep.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads, at most; as many as there are processors by default. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    workers: Option<u16>,
    /// Run only the member of this number, from 1.
    #[arg(long, value_name = "K")]
    index: Option<usize>,
    /// Run only the K-th of N shares of the members, K from 1 to N.
    #[arg(long, value_name = "K/N", conflicts_with = "index", value_parser = str::parse::<Selection>)]
    shard: Option<Selection>,
    #[command(flatten)]
    wall_time: WallTime,
}

#[derive(Debug, clap::Subcommand)]
enum Instead {
    /// Gather the tables of the members that have finished; run nothing.
    Gather {
        /// The directory of an ensemble.
        #[arg(value_name = "DIR")]
        directory: PathBuf,
    },
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let deadline = arguments.wall_time.deadline();
    let path = match (&arguments.instead, &arguments.sweep) {
        (Some(Instead::Gather { directory }), _) => {
            let gathered = gather_sweep(&Sweep::of(directory)?, directory, StopSignal::catch()?.flag())?;
            return conclude(directory, gathered, &Report::default(), reporter);
        }
        (None, sweep) => sweep.clone().unwrap_or_default(),
    };
    let sweep = Sweep::read(&path)?;
    let directory = arguments.out.clone().unwrap_or_else(|| default_directory(&path));
    let selection = match (arguments.index, arguments.shard) {
        (Some(index), _) => Selection::Index(index),
        (None, shard) => shard.unwrap_or_default(),
    };
    let count = sweep.members().iter().filter(|member| selection.holds(member.index)).count();
    let workers = arguments.workers.map_or_else(processors, usize::from);
    reporter.note(&format!(
        "{count} of {} members in {workers} thread{}, results in {}",
        sweep.members().len(),
        if workers == 1 { "" } else { "s" },
        directory.display()
    ));
    let stop = StopSignal::catch()?;
    let members = Members::new(count, reporter);
    let request = Request { selection, workers, deadline, stop: stop.flag() };
    let report = run_members(&sweep, &directory, &request, &members);
    members.finish();
    let report = report?;
    // From here on Ctrl-C leaves the tables as they are.
    if stop.take() {
        reporter
            .note("stopped: gathering the tables of what has finished; Ctrl-C again leaves them as they are");
    }
    let gathered = gather_sweep(&sweep, &directory, stop.flag())?;
    let unfinished = report.count(|fate| matches!(fate, Fate::Stopped(_) | Fate::Waiting));
    if unfinished > 0 {
        let share = match selection {
            Selection::All => String::new(),
            Selection::Index(index) => format!(" --index {index}"),
            Selection::Shard { number, of } => format!(" --shard {number}/{of}"),
        };
        let [path, directory] = [&path, &directory].map(|path| quoted(&path.display().to_string()));
        reporter.note(&format!(
            "members left: {unfinished}; to go on: meniscus ensemble {path} --out {directory}{share}"
        ));
    }
    let elsewhere = report.count(|fate| matches!(fate, Fate::Elsewhere));
    if elsewhere > 0 {
        reporter.note(&format!("{elsewhere} members are at work in another program"));
    }
    conclude(&directory, gathered, &report, reporter)
}

/// Tells what there is now; fails if a member did.
fn conclude(
    directory: &Path,
    gathered: Gathered,
    report: &Report,
    reporter: &mut Reporter<'_>,
) -> Result<Verdict, CommandError> {
    let Gathered { members, finished, damaged, tables } = gathered;
    let failures = || report.failures().chain(damaged.iter().map(|(index, error)| (*index, error)));
    let failed: std::collections::BTreeSet<usize> = failures().map(|(index, _)| index).collect();
    if let Some((index, error)) = failures().min_by_key(|(index, _)| *index) {
        let reason = reason(error);
        return Err(CommandError::Members { failed: failed.len(), members, index, reason });
    }
    let missing = match members - finished {
        0 => String::new(),
        missing => format!(", {missing} are missing in the tables"),
    };
    let mut text = format!("{finished} of {members} members finished{missing}\n");
    for table in &tables {
        text.push_str(&format!("{}\n", table.display()));
    }
    reporter.text(&text)?;
    reporter.json(|| {
        let count = |is_of_kind: fn(&Fate) -> bool| report.count(is_of_kind);
        serde_json::json!({
            "directory": directory.display().to_string(),
            "members": members,
            "finished": finished,
            "kept": count(|fate| matches!(fate, Fate::Kept)),
            "stopped": count(|fate| matches!(fate, Fate::Stopped(_) | Fate::Waiting)),
            "elsewhere": count(|fate| matches!(fate, Fate::Elsewhere)),
            "tables": tables.iter().map(|table| table.display().to_string()).collect::<Vec<_>>(),
        })
    })?;
    Ok(Verdict::Ok)
}

/// Why a member failed, on one line.
fn reason(error: &MemberError) -> String {
    error.to_string().replace('\n', " ")
}

/// `ensembles/NAME`: always the same, so that the same command goes on.
fn default_directory(sweep: &Path) -> PathBuf {
    Path::new("ensembles").join(sweep.file_stem().unwrap_or("sweep".as_ref()))
}
