//! Members run side by side: small ones one in a thread, large ones one after the other in all threads.

use super::error::{EnsembleError, MemberError};
use super::member::{Member, RUNS};
use super::observer::{Limited, Observer};
use super::standing::{Standing, refuse_other};
use super::sweep::Sweep;
use super::{Selection, keep_sweep};
use crate::checkpoint::store::LatestError;
use crate::engine::Machinery;
use crate::files::FileError;
use crate::memory;
use crate::run::{GoldenRequest, Resumed, Run, RunError, Stop, clear_unbegun};
use crate::simulation::{Simulation, SimulationError};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Discs from which on a run takes all threads for itself.
pub const LARGE_PARTICLES: usize = 200_000;

/// Mesh nodes a side from which on a run takes all threads for itself.
pub const LARGE_GRID: usize = 2048;

/// How often a run is tried to be begun in a directory at which others may be at work.
const ATTEMPTS: usize = 3;

/// What is to be run, and with what. None of it shows in the results.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// Which members.
    pub selection: Selection,
    /// Threads, at least 1.
    pub workers: usize,
    /// When the wall time allowed is over.
    pub deadline: Option<Instant>,
    /// Raised by whoever wants all runs to stop, a checkpoint written.
    pub stop: &'a AtomicBool,
}

/// What became of a member.
#[derive(Debug)]
pub enum Fate {
    /// It had finished before.
    Kept,
    /// It has finished.
    Finished,
    /// It was stopped, and goes on when the ensemble is run again.
    Stopped(Stop),
    /// Its turn had not come when all were stopped.
    Waiting,
    /// Another program is at work on it.
    Elsewhere,
    /// It failed.
    Failed(MemberError),
}

/// What became of the members that were to be run, by their numbers.
#[derive(Debug, Default)]
pub struct Report {
    /// Number and fate, in the order of numbers.
    pub fates: Vec<(usize, Fate)>,
}

impl Report {
    /// How many fates are of a kind.
    pub fn count(&self, is_of_kind: impl Fn(&Fate) -> bool) -> usize {
        self.fates.iter().filter(|(_, fate)| is_of_kind(fate)).count()
    }

    /// Numbers and errors of the members that failed.
    pub fn failures(&self) -> impl Iterator<Item = (usize, &MemberError)> {
        self.fates.iter().filter_map(|(index, fate)| match fate {
            Fate::Failed(error) => Some((*index, error)),
            _ => None,
        })
    }

    /// Whether every member has finished.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.fates.iter().all(|(_, fate)| matches!(fate, Fate::Kept | Fate::Finished))
    }
}

/// Whether a run takes all threads for itself: by its size alone.
fn is_large(member: &Member) -> bool {
    let configuration = &member.configuration;
    configuration.system.particles >= LARGE_PARTICLES || configuration.mesh.grid >= LARGE_GRID
}

/// Runs the members of `sweep` that are asked for and have not finished, in `directory`. One that fails does not keep the
/// others from running. What they leave does not depend on how many threads there are, on the order, or on stops.
///
/// # Errors
/// [`EnsembleError`] if the directory cannot be written, or if there is no member of the number asked for; what becomes of
/// members is in the [`Report`].
pub fn run(
    sweep: &Sweep,
    directory: &Path,
    request: &Request<'_>,
    observer: &dyn Observer,
) -> Result<Report, EnsembleError> {
    let members = sweep.members();
    if let Selection::Index(index) = request.selection
        && !(1..=members.len()).contains(&index)
    {
        return Err(EnsembleError::Index { index, count: members.len() });
    }
    let runs = directory.join(RUNS);
    fs::create_dir_all(&runs).map_err(|problem| FileError::Write { path: runs, problem })?;
    keep_sweep(sweep, directory)?;
    let chosen = members.iter().filter(|member| request.selection.holds(member.index));
    let (large, small): (Vec<&Member>, Vec<&Member>) = chosen.partition(|member| is_large(member));
    let workers = request.workers.max(1);
    let available = memory::available();
    let left: Vec<&Member> = small
        .iter()
        .copied()
        .filter(|member| !matches!(Standing::of(member, directory), Ok(Standing::Finished(_))))
        .collect();
    let side_by_side = side_by_side(&left, workers, available.map(|(bytes, _)| bytes));
    if side_by_side < workers.min(left.len()) {
        observer.limited(&Limited { side_by_side, workers, available });
    }
    // Those that had no memory beside others have it after them.
    let postponed: Mutex<Vec<usize>> = Mutex::default();
    let work = |members: &[&Member], next: &AtomicUsize, threads: usize, alone: bool| {
        let mut fates = Vec::new();
        while let Some(&member) = members.get(next.fetch_add(1, Ordering::Relaxed)) {
            let fate = advance(member, directory, threads, request, observer);
            if !alone && lacks_memory(&fate) {
                postponed.lock().unwrap_or_else(PoisonError::into_inner).push(member.index);
                continue;
            }
            observer.ended(member, &fate);
            fates.push((member.index, fate));
        }
        fates
    };
    let next = AtomicUsize::new(0);
    // Where there are fewer runs than threads, each has several.
    let one_of_many = || work(&small, &next, workers / side_by_side, side_by_side == 1);
    let mut fates = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..side_by_side).map(|_| scope.spawn(one_of_many)).collect();
        let mut fates = Vec::new();
        for thread in threads {
            fates.extend(thread.join().map_err(|_| EnsembleError::Thread)?);
        }
        Ok::<_, EnsembleError>(fates)
    })?;
    let mut one_by_one = small.clone();
    {
        let postponed = postponed.lock().unwrap_or_else(PoisonError::into_inner);
        one_by_one.retain(|member| postponed.contains(&member.index));
    }
    for members in [one_by_one, large] {
        fates.extend(work(&members, &AtomicUsize::new(0), workers, true));
    }
    fates.sort_by_key(|(index, _)| *index);
    Ok(Report { fates })
}

/// Whether a member was refused for want of memory.
fn lacks_memory(fate: &Fate) -> bool {
    let error = match fate {
        Fate::Failed(MemberError::Simulation(error)) => error,
        Fate::Failed(MemberError::Run(RunError::Simulation { source, .. })) => source,
        _ => return false,
    };
    matches!(error, SimulationError::Memory(_))
}

/// How many of `members` may be at work at a time: as many as there are workers, and as three quarters of `available`
/// bytes of memory suffice for, whichever they are, as an estimate is of the least; one at least, which is refused if it
/// does not fit.
fn side_by_side(members: &[&Member], workers: usize, available: Option<u64>) -> usize {
    let mut needed: Vec<u64> = members.iter().map(|member| memory::estimate(&member.configuration)).collect();
    needed.sort_unstable_by(|one, other| other.cmp(one));
    let sums = needed.iter().scan(0_u64, |sum, bytes| {
        *sum = sum.saturating_add(*bytes);
        Some(*sum)
    });
    let fits = |sum: &u64| available.is_none_or(|available| *sum <= available - available / 4);
    let fitting = sums.take_while(fits).count();
    workers.min(fitting).max(1)
}

/// Brings one member to its end, if nobody stops it.
fn advance(
    member: &Member,
    directory: &Path,
    threads: usize,
    request: &Request<'_>,
    observer: &dyn Observer,
) -> Fate {
    match Standing::of(member, directory) {
        Ok(Standing::Finished(_)) => return Fate::Kept,
        Ok(_) => {}
        Err(error) => return Fate::Failed(error),
    }
    let is_stopped = || request.stop.load(Ordering::Relaxed);
    if is_stopped() || request.deadline.is_some_and(|deadline| Instant::now() >= deadline) {
        return Fate::Waiting;
    }
    let machinery = Machinery { threads, ..Machinery::default() };
    let run = match open(member, &member.directory(directory), machinery, observer) {
        Ok(Opened::Ready(run)) => run,
        Ok(Opened::Finished) => return Fate::Finished,
        Err(MemberError::Run(RunError::Locked(_))) => return Fate::Elsewhere,
        Err(error) => return Fate::Failed(error),
    };
    observer.began(member, run.simulation());
    let outcome = run.until(request.deadline).to_end(|simulation| {
        observer.stepped(member, simulation);
        is_stopped().then_some(Stop::Interrupted)
    });
    match outcome {
        Ok(outcome) => outcome.stop.map_or(Fate::Finished, Fate::Stopped),
        Err(error) => Fate::Failed(error.into()),
    }
}

/// A member's run, or the news that there is nothing left to do.
enum Opened {
    Ready(Box<Run>),
    Finished,
}

/// Goes on with a member's run, or begins it.
fn open(
    member: &Member,
    directory: &Path,
    machinery: Machinery,
    observer: &dyn Observer,
) -> Result<Opened, MemberError> {
    for attempt in 1.. {
        match Run::resume(directory, machinery, None) {
            Ok(Resumed::Ready { run, warnings }) => {
                refuse_other(member, &run.simulation().configuration, directory)?;
                warnings.iter().for_each(|warning| observer.warned(member, warning));
                return Ok(Opened::Ready(run));
            }
            // Its files were found wanting before, unless another program has finished it meanwhile.
            Ok(Resumed::Finished(_)) if has_finished(member, directory)? => break,
            Ok(Resumed::Finished(outcome)) => {
                let reason =
                    format!("the run has finished at step {}, its run.json is damaged", outcome.clock.step);
                return Err(MemberError::Damaged { path: directory.to_owned(), reason });
            }
            Err(RunError::Checkpoint(LatestError::Missing { .. })) => clear_unbegun(directory)?,
            Err(error) => return Err(error.into()),
        }
        let simulation = Simulation::with_machinery(member.configuration.clone(), machinery)?;
        match Run::create(simulation, directory, GoldenRequest::in_directory(directory)) {
            Ok(run) => return Ok(Opened::Ready(Box::new(run))),
            // Another program was faster.
            Err(RunError::NotEmpty(_)) if attempt < ATTEMPTS => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(Opened::Finished)
}

/// Whether the run in `directory` tells that it has finished.
fn has_finished(member: &Member, directory: &Path) -> Result<bool, MemberError> {
    let ensemble = directory.parent().and_then(Path::parent).unwrap_or(directory);
    Ok(matches!(Standing::of(member, ensemble)?, Standing::Finished(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_members_are_at_work_as_fit() {
        let text = "version = 1\npreset = \"fig-5\"\nset = [\"force.method=pm\", \"mesh.grid=64\", \"output.snapshots=0\"]\nseeds = 2\n\
                    [sweep]\n\"system.particles\" = [2500, 30000]\n";
        let sweep = Sweep::from_text("sizes", text, Path::new("")).unwrap();
        let members: Vec<&Member> = sweep.members().iter().collect();
        let needed = |index: usize| memory::estimate(&members[index].configuration);
        let (small, large) = (needed(0), needed(3));
        assert!(large > 2 * small);
        // Estimates are of the least that is taken.
        let with_a_third = |bytes: u64| (4 * bytes).div_ceil(3);
        for (workers, available, expected) in [
            (4, None, 4),
            (9, None, 4),
            (3, Some(u64::MAX), 3),
            (4, Some(with_a_third(2 * (small + large))), 4),
            (4, Some(with_a_third(2 * (small + large) - 1) - 1), 3),
            (4, Some(with_a_third(2 * large)), 2),
            (4, Some(with_a_third(2 * large - 1) - 1), 1),
            // It is refused by itself.
            (4, Some(0), 1),
        ] {
            assert_eq!(side_by_side(&members, workers, available), expected, "{workers} {available:?}");
        }
        assert_eq!(side_by_side(&[], 4, None), 1);
    }
}
