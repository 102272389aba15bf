//! A run from its start to its end, with everything it writes.
//!
//! ```no_run
//! use meniscus::configuration::Configuration;
//! use meniscus::run::{Run, Stop};
//! use meniscus::simulation::Simulation;
//! use std::path::Path;
//!
//! let simulation = Simulation::new(Configuration::from_preset("fig-12", &[])?)?;
//! let outcome = Run::create(simulation, Path::new("rings"), None)?.to_end(|_| None::<Stop>)?;
//! println!("{} after {} steps", outcome.digest, outcome.clock.step);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod directory;
mod schedule;

pub use schedule::Schedule;

use crate::configuration::Output;
use crate::engine::EngineError;
use crate::files::FileError;
use crate::files::extended_xyz::Frame;
use crate::golden::Golden;
use crate::observables::clusters::Clusters;
use crate::simulation::Simulation;
use crate::snapshot::SnapshotError;
use directory::Directory;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::Clock;
use meniscus_core::units::{force_from_units, time_from_units};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Steps between records of a run's own golden file.
pub const GOLDEN_INTERVAL: u64 = 1000;

/// Why a run could not be made.
#[derive(Debug, Error)]
pub enum RunError {
    /// The directory has something in it that a run would overwrite.
    #[error("{}: the directory is not empty; name another with --out, or remove it", .0.display())]
    NotEmpty(PathBuf),
    /// A file could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A picture could not be made.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// A step was refused. The state before it has been written.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Why a run ends before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Somebody interrupted it.
    Interrupted,
    /// The wall time allowed is over.
    WallTime,
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

/// A run under way.
#[derive(Debug)]
pub struct Run {
    simulation: Simulation,
    directory: Directory,
    golden: Golden,
    golden_request: GoldenRequest,
    observables: Schedule,
    trajectory: Schedule,
    snapshots: Schedule,
}

impl Run {
    /// Makes the directory and the files of a run that has not begun.
    ///
    /// The golden file is `golden.toml` in the directory, a record every [`GOLDEN_INTERVAL`] steps, unless
    /// `golden` says otherwise.
    ///
    /// # Errors
    /// A [`RunError`]; a directory that has something in it is refused.
    pub fn create(
        simulation: Simulation,
        directory: &Path,
        golden: Option<GoldenRequest>,
    ) -> Result<Self, RunError> {
        let configuration = &simulation.configuration;
        let Output { observables, trajectory, snapshots } = configuration.output;
        let (scale, now) = (configuration.time_scale(), simulation.engine.clock().time);
        let schedule = |interval: f64| Schedule::new(interval * scale, now);
        let golden_request = golden
            .unwrap_or_else(|| GoldenRequest { path: directory.join("golden.toml"), every: GOLDEN_INTERVAL });
        Ok(Self {
            directory: Directory::create(directory, &simulation)?,
            golden: Golden::new(configuration.to_toml(), "a run"),
            golden_request,
            observables: schedule(observables),
            trajectory: schedule(trajectory),
            snapshots: schedule(snapshots),
            simulation,
        })
    }

    /// Runs to the end. `watch` is called after every step and may stop the run; however it ends, the last state
    /// and the golden file are written.
    ///
    /// # Errors
    /// A [`RunError`].
    pub fn to_end(mut self, mut watch: impl FnMut(&Simulation) -> Option<Stop>) -> Result<Outcome, RunError> {
        let end = self.simulation.end();
        let mut failure = None;
        let mut stop = None;
        self.look()?;
        while self.simulation.engine.clock().time < end && stop.is_none() {
            if let Err(error) = self.simulation.engine.step() {
                failure = Some(error);
                break;
            }
            self.look()?;
            stop = watch(&self.simulation);
        }
        let outcome = self.finish(stop, failure.is_some())?;
        failure.map_or(Ok(outcome), |error| Err(error.into()))
    }

    /// Writes what is due at the present state.
    fn look(&mut self) -> Result<(), RunError> {
        let clock = self.simulation.engine.clock();
        let observables = self.observables.is_due(clock.time);
        let trajectory = self.trajectory.is_due(clock.time);
        let snapshot = self.snapshots.is_due(clock.time);
        if clock.step.is_multiple_of(self.golden_request.every) {
            self.golden.record(self.simulation.engine.state().digest_by_field());
        }
        if !(observables || trajectory || snapshot) {
            return Ok(());
        }
        let positions = self.simulation.engine.positions();
        let clusters = Clusters::find(&self.simulation.torus, &positions);
        let time_over_jeans = self.simulation.time_over_jeans();
        // The state may be one from which no step is possible: the step itself will say so.
        let (length, largest_force) = self.simulation.engine.next_step().unwrap_or_default();
        if observables {
            self.directory.write_row(&Row { clock, time_over_jeans, length, largest_force }, &clusters)?;
        }
        if trajectory {
            self.directory.write_frame(&Frame {
                step: clock.step,
                time: clock.time,
                time_over_jeans,
                time_step: time_from_units(length),
                positions: &positions,
                clustered: Some(&clusters),
            })?;
        }
        if snapshot {
            let index = self.snapshots.last_due();
            self.directory.draw_snapshot(index, &self.simulation, &positions, &clusters)?;
        }
        Ok(())
    }

    /// Writes the last state, the golden file and the summary.
    fn finish(mut self, stop: Option<Stop>, failed: bool) -> Result<Outcome, RunError> {
        let engine = &self.simulation.engine;
        self.golden.record(engine.state().digest_by_field());
        self.golden.write(&self.golden_request.path)?;
        let outcome = Outcome {
            stop,
            clock: engine.clock(),
            digest: engine.state().digest(),
            directory: self.directory.path().to_owned(),
        };
        self.directory.finish(&self.simulation, &outcome, failed)?;
        Ok(outcome)
    }
}

/// A row of `observables.csv`, apart from the clusters.
struct Row {
    clock: Clock,
    time_over_jeans: Option<f64>,
    /// Of the next step, unit 2⁻⁴⁰ R0²/D.
    length: u64,
    /// In this state, unit 2⁻²⁴ kBT/R0.
    largest_force: u64,
}

impl Row {
    /// Names of the columns, those of the clusters included.
    const HEADER: &str = "step,time,time_over_jeans,dt,max_force,clusters,mean_cluster_size,\
                          mass_weighted_cluster_size,largest_cluster";

    fn format(&self, clusters: &Clusters) -> String {
        let time_over_jeans = self.time_over_jeans.map_or(String::new(), |time| time.to_string());
        format!(
            "{},{},{},{},{},{},{},{},{}",
            self.clock.step,
            time_from_units(self.clock.time),
            time_over_jeans,
            time_from_units(self.length),
            force_from_units(self.largest_force as i64),
            clusters.count(),
            clusters.number_average(),
            clusters.mass_average(),
            clusters.largest(),
        )
    }
}
