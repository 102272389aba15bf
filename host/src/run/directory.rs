//! A run's directory: which files there are and what is in them.

use super::{Outcome, Row, RunError, Stop};
use crate::configuration::{Configuration, Force};
use crate::files::trajectory::{Format, Frame, Trajectory};
use crate::files::{atomic::write_atomically, csv, state::State};
use crate::observables::clusters::Clusters;
use crate::simulation::Simulation;
use crate::snapshot;
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::time_from_units;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// A file that grows, with its name for messages.
#[derive(Debug)]
struct Growing {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Growing {
    fn create(path: PathBuf) -> Result<Self, RunError> {
        match File::create_new(&path) {
            Ok(file) => Ok(Self { path, file: BufWriter::new(file) }),
            Err(source) => Err(RunError::Write { path, source }),
        }
    }

    /// Appends what `write` writes and hands it to the system, so that it outlives this program.
    fn append(
        &mut self,
        write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
    ) -> Result<(), RunError> {
        write(&mut self.file)
            .and_then(|()| self.file.flush())
            .map_err(|source| RunError::Write { path: self.path.clone(), source })
    }
}

/// An open run directory.
#[derive(Debug)]
pub(super) struct Directory {
    path: PathBuf,
    torus: Torus,
    observables: Growing,
    trajectory: Trajectory,
    begun: Instant,
    begun_at: u64,
}

impl Directory {
    /// Refuses a directory that has something in it.
    pub(super) fn refuse_used(path: &Path) -> Result<(), RunError> {
        let used = fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some());
        if used { Err(RunError::NotEmpty(path.to_owned())) } else { Ok(()) }
    }

    /// Makes the directory if it is not there and the files a run begins with.
    pub(super) fn create(path: &Path, simulation: &Simulation) -> Result<Self, RunError> {
        fs::create_dir_all(path).map_err(|source| RunError::Write { path: path.to_owned(), source })?;
        write_atomically(&path.join("config.toml"), simulation.configuration.to_toml().as_bytes())?;
        let mut observables = Growing::create(path.join("observables.csv"))?;
        observables.append(|file| writeln!(file, "{}", Row::HEADER))?;
        let begun_at = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        Ok(Self {
            trajectory: Trajectory::create(
                &path.join(Format::ExtendedXyz.file_name()),
                Format::ExtendedXyz,
                &simulation.torus,
            )?,
            path: path.to_owned(),
            torus: simulation.torus,
            observables,
            begun: Instant::now(),
            begun_at,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn write_row(&mut self, row: &Row, clusters: &Clusters) -> Result<(), RunError> {
        self.observables.append(|file| writeln!(file, "{}", row.format(clusters)))
    }

    pub(super) fn write_frame(&mut self, frame: &Frame<'_>) -> Result<(), RunError> {
        Ok(self.trajectory.append(frame)?)
    }

    /// Draws the `index`-th snapshot, clustered discs in red.
    pub(super) fn draw_snapshot(
        &self,
        index: u64,
        simulation: &Simulation,
        positions: &[Position],
        clusters: &Clusters,
    ) -> Result<(), RunError> {
        let path = self.path.join(format!("snapshot-{index:03}.png"));
        let clustered = |id| clusters.clustered(id);
        snapshot::draw(&path, &self.torus, positions, &clustered, &caption(simulation))?;
        Ok(())
    }

    /// Writes the last state as `final.csv` and `final.state`, and the summary `run.json`.
    pub(super) fn finish(
        &self,
        simulation: &Simulation,
        outcome: &Outcome,
        failed: bool,
    ) -> Result<(), RunError> {
        let positions = simulation.engine.positions();
        let strengths = simulation.engine.strengths();
        csv::write(&self.path.join("final.csv"), &self.torus, &positions, &strengths)?;
        let (step, time) = (outcome.clock.step, outcome.clock.time);
        let state =
            State { step, time, positions, strengths: Some(strengths), held: simulation.engine.held() };
        state.write(&self.path.join("final.state"))?;
        let summary = serde_json::json!({
            "program": concat!("meniscus ", env!("CARGO_PKG_VERSION")),
            "machine": format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            "engine": simulation.engine.kind().word(),
            "threads": simulation.engine.threads(),
            "ended": match (failed, outcome.stop) {
                (true, _) => "error",
                (false, None) => "finished",
                (false, Some(Stop::Interrupted)) => "interrupted",
                (false, Some(Stop::WallTime)) => "wall time",
            },
            "began_at_unix_seconds": self.begun_at,
            "wall_seconds": self.begun.elapsed().as_secs_f64(),
            "step": outcome.clock.step,
            "time": time_from_units(outcome.clock.time),
            "time_over_jeans": simulation.time_over_jeans(),
            "jeans_time": simulation.configuration.jeans_time(),
            "time_unit_seconds": simulation.configuration.seconds_per_time_unit(),
            "force": force(simulation),
            "length": outcome.digest.length,
            "digest": outcome.digest.to_string(),
        });
        let text = format!("{summary:#}\n");
        Ok(write_atomically(&self.path.join("run.json"), text.as_bytes())?)
    }
}

/// How the capillary force is summed.
fn force(simulation: &Simulation) -> serde_json::Value {
    let mut force = scheme(&simulation.configuration);
    if let (Some(reuse), Some(force)) = (simulation.engine.mesh_reuse(), force.as_object_mut()) {
        let reuse = serde_json::json!({
            "distance": simulation.configuration.mesh_refresh,
            "steps": reuse.steps,
            "transforms": reuse.transforms,
            "saved": reuse.saved(),
            "measured_error": reuse.error(),
        });
        force.insert("mesh_refresh".to_owned(), reuse);
    }
    force
}

/// Method and scheme.
fn scheme(configuration: &Configuration) -> serde_json::Value {
    // The words are those of the configuration.
    let Configuration { force, mesh, .. } = configuration;
    let (assignment, method) = (mesh.assignment_word(), force.method_word());
    match *force {
        Force::ParticleMesh => {
            serde_json::json!({ "method": method, "grid": mesh.grid, "assignment": assignment })
        }
        Force::P3m { accuracy, splitting, cutoff } => serde_json::json!({
            "method": method,
            "accuracy": accuracy,
            "estimated_error": configuration.estimated_error(),
            "grid": mesh.grid,
            "assignment": assignment,
            "splitting": splitting,
            "cutoff": cutoff,
        }),
    }
}

/// What stands above a snapshot.
fn caption(simulation: &Simulation) -> String {
    let Configuration { system, .. } = &simulation.configuration;
    let time = match simulation.time_over_jeans() {
        Some(time) => format!("t = {time:.2} T"),
        None => format!("t = {:.2} R0²/D", time_from_units(simulation.engine.clock().time)),
    };
    let range = system.capillary_length / system.side;
    format!("{time}    N = {}    λ/L = {range:.2}", system.particles)
}
