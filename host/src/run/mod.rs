//! A run from its start to its end, with everything it writes, and over any number of stops.
//!
//! A run's checkpoints ([`crate::checkpoint`]) say how far its other files had come; [`Run::resume`] goes on from the
//! newest, drops what the files got later, and so leaves the same files as a run that was never stopped, byte for byte.
//! Of `run.json` and the checkpoints themselves that does not hold.
//!
//! ```
//! use meniscus::configuration::Configuration;
//! use meniscus::engine::Machinery;
//! use meniscus::run::{GoldenRequest, Resumed, Run, Stop};
//! use meniscus::simulation::Simulation;
//!
//! let overrides = ["particles=20", "box=40"].map(|text| format!("system.{text}"));
//! let overrides = [&overrides[..], &["force.method=pm".to_owned(), "time.until=0.001".to_owned()]].concat();
//! let folder = tempfile::tempdir()?;
//! let directory = folder.path().join("run");
//! let simulation = Simulation::new(Configuration::from_preset("table-1", &overrides)?)?;
//! let run = Run::create(simulation, &directory, GoldenRequest::in_directory(&directory))?;
//! let stopped = run.to_end(|simulation| (simulation.engine.clock().step == 3).then_some(Stop::Interrupted))?;
//! assert_eq!((stopped.stop, stopped.clock.step), (Some(Stop::Interrupted), 3));
//!
//! let Resumed::Ready { run, .. } = Run::resume(&directory, Machinery::default(), None)? else { panic!() };
//! let outcome = run.to_end(|_| None)?;
//! assert_eq!(outcome.stop, None);
//! println!("{} after {} steps", outcome.digest, outcome.clock.step);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod directory;
mod error;
mod growing;
mod lock;
mod manifest;
mod progress;
mod resume;
mod schedule;
mod start;
mod tables;
mod unbegun;

pub use error::RunError;
pub use resume::Resumed;
pub use schedule::Schedule;
pub use unbegun::clear_unbegun;

use crate::checkpoint::Checkpoint;
use crate::configuration::Output;
use crate::engine::MeshReuse;
use crate::files::FileError;
use crate::files::atomic::check_folder;
use crate::files::trajectory::Frame;
use crate::golden::Golden;
use crate::observables::clusters::Clusters;
use crate::observables::series::Moment;
use crate::simulation::Simulation;
use directory::Directory;
use manifest::Ending;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::Clock;
use meniscus_core::units::{force_from_units, time_from_units};
use progress::{Pictures, Progress, Records};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Steps between records of a run's own golden file.
pub const GOLDEN_INTERVAL: u64 = 1000;

/// Why a run ends before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Somebody interrupted it.
    Interrupted,
    /// The wall time allowed is over.
    WallTime,
}

impl Stop {
    /// How `run.json` calls it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Interrupted => "interrupted",
            Self::WallTime => "wall time",
        }
    }
}

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Why it ended early, if it did.
    pub stop: Option<Stop>,
    /// Where it ended.
    pub clock: Clock,
    /// Digest of the last state.
    pub digest: Digest,
    /// What holding mesh forces has saved; None if none were to be held.
    pub mesh_reuse: Option<MeshReuse>,
    /// The directory with everything in it.
    pub directory: PathBuf,
}

/// Where a golden file goes, and how often a record is taken.
#[derive(Clone, Debug)]
pub struct GoldenRequest {
    /// The file.
    pub path: PathBuf,
    /// Steps between records, at least 1.
    pub every: u64,
}

impl GoldenRequest {
    /// `golden.toml` in a run's directory, a record every [`GOLDEN_INTERVAL`] steps.
    #[must_use]
    pub fn in_directory(directory: &Path) -> Self {
        Self { path: directory.join("golden.toml"), every: GOLDEN_INTERVAL }
    }

    /// Refuses a file that would get in the run's way, that a checkpoint could not name, or whose folder is not there or
    /// cannot be written to.
    fn check(&self, directory: &Path) -> Result<(), RunError> {
        let refused = |reason| Err(RunError::GoldenPlace { path: self.path.clone(), reason });
        if self.path.exists() {
            return Err(RunError::GoldenExists(self.path.clone()));
        }
        let absolute = |path: &Path| {
            std::path::absolute(path).map_err(|problem| FileError::Write { path: path.to_owned(), problem })
        };
        let (own, path, run) =
            (Self::in_directory(directory).path, absolute(&self.path)?, absolute(directory)?);
        let folder = path.parent().unwrap_or(&path);
        // The run's directory may be there already, under other names.
        let is_same = |run: &Path| {
            folder.canonicalize().is_ok_and(|path| run.canonicalize().is_ok_and(|run| run == path))
        };
        let in_run = folder == run || is_same(&run);
        if run.starts_with(&path) || (in_run && path.file_name() != own.file_name()) {
            return refused("the run keeps its own files there; name golden.toml or one elsewhere");
        }
        if self.path != own && path.to_str().is_none() {
            return refused(
                "the path is not UTF-8 and could not be found again by `meniscus resume`; name another",
            );
        }
        if !in_run && !folder.is_dir() {
            return refused("the folder does not exist; make it, or name another");
        }
        if in_run { Ok(()) } else { Ok(check_folder(&self.path)?) }
    }

    /// What a checkpoint in `directory` has to remember of it.
    fn progress(&self, directory: &Path, records: usize) -> Records {
        let is_own = self.path == Self::in_directory(directory).path;
        // The program that goes on may do so from another place.
        let absolute = std::path::absolute(&self.path).unwrap_or_else(|_| self.path.clone());
        let path = (!is_own).then(|| absolute.to_string_lossy().into_owned());
        Records { path, every: self.every, records }
    }

    /// What `progress` remembers.
    fn resumed(directory: &Path, progress: &Records) -> Self {
        let path = progress.path.as_ref().map_or_else(|| Self::in_directory(directory).path, PathBuf::from);
        Self { path, every: progress.every }
    }
}

/// A run under way.
#[derive(Debug)]
pub struct Run {
    simulation: Simulation,
    directory: Directory,
    golden: Golden,
    golden_request: GoldenRequest,
    /// Records in the golden file as it is on the disk; None if it is to be written anyway.
    golden_written: Option<usize>,
    trajectory: Schedule,
    snapshots: Schedule,
    checkpoints: Checkpoints,
    /// When the wall time allowed is over.
    deadline: Option<Instant>,
}

/// The checkpoints a run has written.
#[derive(Clone, Copy, Debug)]
struct Checkpoints {
    written: u64,
    /// Step of the newest.
    step: u64,
    /// When it was written.
    at: Instant,
    /// How long that took.
    took: Duration,
}

impl Run {
    /// Makes the directory and the files of a run that has not begun, a first checkpoint among them.
    ///
    /// # Errors
    /// A [`RunError`]; a directory that has something in it, or in which another run is at work, and a golden file that
    /// exists, has no folder that can be written to, or would have the name of one of the run's own files are refused.
    pub fn create(
        simulation: Simulation,
        directory: &Path,
        golden_request: GoldenRequest,
    ) -> Result<Self, RunError> {
        Directory::refuse_used(directory)?;
        golden_request.check(directory)?;
        let configuration = &simulation.configuration;
        let Output { trajectory, snapshots, .. } = configuration.output;
        let (scale, clock) = (configuration.time_scale(), simulation.engine.clock());
        let schedule = |interval: f64| Schedule::new(interval * scale, clock.time);
        let mut run = Self {
            directory: Directory::create(directory, &simulation)?,
            golden: Golden::new(configuration.to_toml(), "a run"),
            golden_request,
            golden_written: None,
            trajectory: schedule(trajectory),
            snapshots: schedule(snapshots),
            checkpoints: Checkpoints {
                written: 0,
                step: clock.step,
                at: Instant::now(),
                took: Duration::ZERO,
            },
            deadline: None,
            simulation,
        };
        // That something cannot be written is better known before the run than after it.
        run.write_checkpoint()?;
        run.write_manifest(Ending::Running)?;
        Ok(run)
    }

    /// What is run.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Stops in time for a checkpoint to be on the disk at `deadline`, as far as one can tell from the steps and the
    /// checkpoints before.
    #[must_use]
    pub fn until(self, deadline: Option<Instant>) -> Self {
        Self { deadline, ..self }
    }

    /// Runs to the end. `watch` is called after every step and may stop the run; however it ends, a checkpoint, the last
    /// state and the golden file are written, unless writing is what failed.
    ///
    /// # Errors
    /// A [`RunError`].
    pub fn to_end(mut self, watch: impl FnMut(&Simulation) -> Option<Stop>) -> Result<Outcome, RunError> {
        let ended = self.step_to_end(watch).and_then(|stop| {
            self.finish(stop.map_or(Ending::Finished, Ending::Stopped))?;
            Ok(stop)
        });
        match ended {
            Ok(stop) => Ok(self.outcome(stop)),
            Err(error) => Err(self.fail(error)),
        }
    }

    fn step_to_end(
        &mut self,
        mut watch: impl FnMut(&Simulation) -> Option<Stop>,
    ) -> Result<Option<Stop>, RunError> {
        let end = self.simulation.end();
        let mut longest_step = Duration::ZERO;
        self.look()?;
        while self.simulation.engine.clock().time < end {
            let begun = Instant::now();
            self.simulation.engine.step()?;
            self.look()?;
            longest_step = longest_step.max(begun.elapsed());
            if let Some(stop) = watch(&self.simulation) {
                return Ok(Some(stop));
            }
            if self.checkpoint_is_due() {
                self.write_checkpoint()?;
            }
            // Twice what the last one took, and the step before that.
            let needed = longest_step + 2 * self.checkpoints.took;
            if self.deadline.is_some_and(|deadline| Instant::now() + needed >= deadline) {
                return Ok(Some(Stop::WallTime));
            }
        }
        Ok(None)
    }

    /// Writes what is due at the present state.
    fn look(&mut self) -> Result<(), RunError> {
        let clock = self.simulation.engine.clock();
        let [observables, rows] = self.directory.note_due(clock.time);
        let trajectory = self.trajectory.is_due(clock.time);
        let snapshot = self.snapshots.is_due(clock.time);
        if clock.step.is_multiple_of(self.golden_request.every) {
            self.golden.record(self.simulation.engine.state().digest_by_field());
        }
        if !(rows || trajectory || snapshot) {
            return Ok(());
        }
        let positions = self.simulation.engine.positions();
        let clusters = (observables || trajectory || snapshot)
            .then(|| Clusters::find(&self.simulation.torus, &positions));
        // If there are no forces, the step will say so.
        let next_step =
            if observables || trajectory { self.simulation.engine.next_step().ok() } else { None };
        let moment = Moment::new(clock.step, clock.time, self.simulation.configuration.jeans_time());
        let frame = Frame {
            step: clock.step,
            time: clock.time,
            time_over_jeans: moment.time_over_jeans,
            time_step: next_step.map_or(0.0, |(length, _)| time_from_units(length)),
            largest_force: next_step.map(|(_, force)| largest_force(force)),
            positions: &positions,
            crossings: &self.simulation.engine.crossings(),
            strengths: &self.simulation.engine.strengths(),
            clustered: clusters.as_ref(),
        };
        self.directory.write_rows(&moment, &frame)?;
        if trajectory {
            self.directory.write_frame(&frame)?;
        }
        if let (true, Some(clusters)) = (snapshot, &clusters) {
            let index = self.snapshots.last_due();
            self.directory.draw_snapshot(index, &self.simulation, &positions, clusters)?;
        }
        Ok(())
    }

    fn checkpoint_is_due(&self) -> bool {
        let Output { checkpoint_steps, checkpoint_minutes, .. } = self.simulation.configuration.output;
        let step = self.simulation.engine.clock().step;
        let by_steps = checkpoint_steps > 0 && step.is_multiple_of(checkpoint_steps);
        let by_time = || self.checkpoints.at.elapsed().as_secs_f64() >= 60.0 * checkpoint_minutes;
        by_steps || (checkpoint_minutes > 0.0 && by_time())
    }

    /// Writes a checkpoint. What it says of other files is on the disk before.
    fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let begun = Instant::now();
        let (tables, trajectory) = self.directory.sync(self.trajectory.next_due())?;
        if self.golden_written != Some(self.golden.records.len()) {
            self.golden.write(&self.golden_request.path)?;
            self.golden_written = Some(self.golden.records.len());
        }
        let (engine, written) = (&self.simulation.engine, self.checkpoints.written + 1);
        let progress = Progress {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            tables,
            start: self.directory.start_digest(),
            trajectory,
            snapshots: Pictures { next: self.snapshots.next_due() },
            golden: self.golden_request.progress(self.directory.path(), self.golden.records.len()),
            mesh_reuse: engine.mesh_reuse().unwrap_or_default(),
            checkpoints: written,
        };
        let mut state = Vec::new();
        engine.state().write(|part| state.extend_from_slice(part));
        self.directory.store(&Checkpoint {
            configuration: self.simulation.configuration.to_toml(),
            state,
            crossings: engine.crossings(),
            progress: progress.to_text()?,
        })?;
        let step = engine.clock().step;
        self.checkpoints = Checkpoints { written, step, at: Instant::now(), took: begun.elapsed() };
        Ok(())
    }

    fn write_manifest(&self, ending: Ending) -> Result<(), RunError> {
        self.directory.write_manifest(&self.simulation, ending, self.checkpoints.written)
    }

    /// Writes a checkpoint, the last state, the golden file with a record of it, and the summary.
    fn finish(&mut self, ending: Ending) -> Result<(), RunError> {
        if self.checkpoints.step != self.simulation.engine.clock().step || self.golden_written.is_none() {
            self.write_checkpoint()?;
        }
        self.write_last(ending)
    }

    /// Writes the last state, the golden file with a record of it, and the summary.
    fn write_last(&mut self, ending: Ending) -> Result<(), RunError> {
        self.directory.write_state(&self.simulation)?;
        self.golden.record(self.simulation.engine.state().digest_by_field());
        self.golden.write(&self.golden_request.path)?;
        self.write_manifest(ending)
    }

    /// Writes what can still be written, and says how to go on.
    fn fail(mut self, error: RunError) -> RunError {
        let written = match error {
            RunError::Engine(_) => self.finish(Ending::Failed),
            _ => self.write_last(Ending::Failed),
        };
        if let RunError::Engine(_) | RunError::Removed(_) | RunError::Changed { .. } = error {
            return match written {
                Ok(()) => error,
                Err(second) => RunError::Both(Box::new([error, second])),
            };
        }
        // That writing failed is what this error says, and the checkpoint is there to go on from.
        let (directory, step) = (self.directory.path().to_owned(), self.checkpoints.step);
        RunError::Unwritten { source: Box::new(error), directory, step }
    }

    fn outcome(&self, stop: Option<Stop>) -> Outcome {
        let engine = &self.simulation.engine;
        Outcome {
            stop,
            clock: engine.clock(),
            digest: engine.state().digest(),
            mesh_reuse: engine.mesh_reuse(),
            directory: self.directory.path().to_owned(),
        }
    }
}

/// A largest force of unit 2⁻²⁴ kBT/R0 in kBT/R0.
fn largest_force(units: u64) -> f64 {
    force_from_units(i64::try_from(units).unwrap_or(i64::MAX))
}
