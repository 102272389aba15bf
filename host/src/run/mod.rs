//! A run from its start to its end, with everything it writes.
//!
//! ```no_run
//! use meniscus::configuration::Configuration;
//! use meniscus::run::{GoldenRequest, Run, Stop};
//! use meniscus::simulation::Simulation;
//! use std::path::Path;
//!
//! let simulation = Simulation::new(Configuration::from_preset("fig-12", &[])?)?;
//! let directory = Path::new("rings");
//! let outcome = Run::create(simulation, directory, GoldenRequest::in_directory(directory))?.to_end(|_| None::<Stop>)?;
//! println!("{} after {} steps", outcome.digest, outcome.clock.step);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod directory;
mod schedule;

pub use schedule::Schedule;

use crate::configuration::Output;
use crate::engine::{EngineError, MeshReuse};
use crate::files::FileError;
use crate::files::trajectory::Frame;
use crate::golden::Golden;
use crate::observables::clusters::Clusters;
use crate::observables::energy::{Energies, PotentialEnergy};
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
    /// The golden file is there already.
    #[error("{}: this golden file exists; `meniscus verify` compares with it, or name another with --golden", .0.display())]
    GoldenExists(PathBuf),
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
}

/// A run under way.
#[derive(Debug)]
pub struct Run {
    simulation: Simulation,
    directory: Directory,
    golden: Golden,
    golden_request: GoldenRequest,
    observables: Schedule,
    /// None if there are no rows.
    energy: Option<PotentialEnergy>,
    trajectory: Schedule,
    snapshots: Schedule,
}

impl Run {
    /// Makes the directory and the files of a run that has not begun.
    ///
    /// # Errors
    /// A [`RunError`]; a directory that has something in it and a golden file that exists are refused.
    pub fn create(
        simulation: Simulation,
        directory: &Path,
        golden_request: GoldenRequest,
    ) -> Result<Self, RunError> {
        Directory::refuse_used(directory)?;
        if golden_request.path.exists() {
            return Err(RunError::GoldenExists(golden_request.path));
        }
        let configuration = &simulation.configuration;
        let Output { observables, trajectory, snapshots, .. } = configuration.output;
        let (scale, now) = (configuration.time_scale(), simulation.engine.clock().time);
        let schedule = |interval: f64| Schedule::new(interval * scale, now);
        let run = Self {
            directory: Directory::create(directory, &simulation)?,
            golden: Golden::new(configuration.to_toml(), "a run"),
            golden_request,
            observables: schedule(observables),
            energy: (observables > 0.0).then(|| PotentialEnergy::new(&configuration.system)),
            trajectory: schedule(trajectory),
            snapshots: schedule(snapshots),
            simulation,
        };
        // That it cannot be written is better known before the run than after it.
        run.golden.write(&run.golden_request.path)?;
        Ok(run)
    }

    /// Runs to the end. `watch` is called after every step and may stop the run; however it ends, the last state
    /// and the golden file are written.
    ///
    /// # Errors
    /// A [`RunError`].
    pub fn to_end(mut self, watch: impl FnMut(&Simulation) -> Option<Stop>) -> Result<Outcome, RunError> {
        let result = self.step_to_end(watch);
        let outcome = self.finish(result.as_ref().ok().copied().flatten(), result.is_err())?;
        result.map(|_| outcome)
    }

    fn step_to_end(
        &mut self,
        mut watch: impl FnMut(&Simulation) -> Option<Stop>,
    ) -> Result<Option<Stop>, RunError> {
        let end = self.simulation.end();
        self.look()?;
        while self.simulation.engine.clock().time < end {
            self.simulation.engine.step()?;
            self.look()?;
            if let Some(stop) = watch(&self.simulation) {
                return Ok(Some(stop));
            }
        }
        Ok(None)
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
        let strengths = self.simulation.engine.strengths();
        let clusters = Clusters::find(&self.simulation.torus, &positions);
        let time_over_jeans = self.simulation.time_over_jeans();
        // If there are no forces, the step will say so.
        let next_step = self.simulation.engine.next_step().ok();
        let length = next_step.map_or(0, |(length, _)| length);
        if observables {
            let energies = self
                .energy
                .as_ref()
                .map(|energy| energy.of(&positions, Some(&strengths)))
                .unwrap_or_default();
            self.directory.write_row(&Row { clock, time_over_jeans, next_step, energies }, &clusters)?;
        }
        if trajectory {
            self.directory.write_frame(&Frame {
                step: clock.step,
                time: clock.time,
                time_over_jeans,
                time_step: time_from_units(length),
                largest_force: next_step
                    .map(|(_, force)| force_from_units(i64::try_from(force).unwrap_or(i64::MAX))),
                positions: &positions,
                crossings: &[],
                strengths: &strengths,
                clustered: Some(&clusters),
            })?;
        }
        if snapshot {
            let index = self.snapshots.last_due();
            self.directory.draw_snapshot(index, &self.simulation, &positions, &clusters)?;
        }
        Ok(())
    }

    /// Writes the last state, the summary and the golden file.
    fn finish(mut self, stop: Option<Stop>, failed: bool) -> Result<Outcome, RunError> {
        let engine = &self.simulation.engine;
        let outcome = Outcome {
            stop,
            clock: engine.clock(),
            digest: engine.state().digest(),
            mesh_reuse: engine.mesh_reuse(),
            directory: self.directory.path().to_owned(),
        };
        self.directory.finish(&self.simulation, &outcome, failed)?;
        self.golden.record(self.simulation.engine.state().digest_by_field());
        self.golden.write(&self.golden_request.path)?;
        Ok(outcome)
    }
}

/// A row of `observables.csv`, apart from the clusters.
struct Row {
    clock: Clock,
    time_over_jeans: Option<f64>,
    /// Length of the next step (unit 2⁻⁴⁰ R0²/D) and the largest force in this state (unit 2⁻²⁴ kBT/R0).
    next_step: Option<(u64, u64)>,
    energies: Energies,
}

impl Row {
    /// Names of the columns, those of the clusters included.
    const HEADER: &str = "step,time,time_over_jeans,dt,max_force,clusters,mean_cluster_size,\
                          mass_weighted_cluster_size,largest_cluster,capillary_energy,repulsive_energy";

    fn format(&self, clusters: &Clusters) -> String {
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        format!(
            "{},{},{},{},{},{},{},{},{},{},{}",
            self.clock.step,
            time_from_units(self.clock.time),
            cell(self.time_over_jeans),
            cell(self.next_step.map(|(length, _)| time_from_units(length))),
            cell(self.next_step.map(|(_, force)| force_from_units(i64::try_from(force).unwrap_or(i64::MAX)))),
            clusters.count(),
            clusters.number_average(),
            clusters.mass_average(),
            clusters.largest(),
            self.energies.capillary,
            self.energies.repulsive,
        )
    }
}
