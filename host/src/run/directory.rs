//! A run's directory: which files there are and what is in them.

use super::growing::Place;
use super::lock::{self, Lock};
use super::manifest::{self, Ending, Manifest};
use super::progress::{Frames, Progress, Table};
use super::start::StartingState;
use super::tables::{Tables, compare_with_start};
use super::{Outcome, RunError};
use crate::checkpoint::{Checkpoint, store};
use crate::configuration::Configuration;
use crate::files::trajectory::{Extent, Format, Frame, Trajectory};
use crate::files::{FileError, atomic, atomic::write_atomically, csv};
use crate::observables::clusters::Clusters;
use crate::observables::series::Moment;
use crate::simulation::Simulation;
use crate::snapshot;
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::time_from_units;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Name of the configuration as run.
pub(super) const CONFIGURATION: &str = "config.toml";

/// An open run directory.
#[derive(Debug)]
pub(super) struct Directory {
    path: PathBuf,
    torus: Torus,
    tables: Tables,
    /// Where the discs were at the start, if a table compares with it.
    start: Option<StartingState>,
    trajectory: Trajectory,
    trajectory_place: Place,
    manifest: Manifest,
    _lock: Lock,
}

/// Whether a directory has more in it than a lock.
fn is_used(path: &Path) -> Result<bool, FileError> {
    let look = || -> std::io::Result<bool> {
        let entries = match fs::read_dir(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            entries => entries?,
        };
        for entry in entries {
            if entry?.file_name() != lock::FILE {
                return Ok(true);
            }
        }
        Ok(false)
    };
    look().map_err(|problem| FileError::Write { path: path.to_owned(), problem })
}

impl Directory {
    /// Refuses a directory that has something in it.
    pub(super) fn refuse_used(path: &Path) -> Result<(), RunError> {
        if is_used(path)? {
            // Whoever is at work there is the better reason.
            if path.join(lock::FILE).exists() {
                Lock::take(path)?;
            }
            return Err(RunError::NotEmpty(path.to_owned()));
        }
        Ok(())
    }

    /// Makes the directory if it is not there and the files a run begins with.
    pub(super) fn create(path: &Path, simulation: &Simulation) -> Result<Self, RunError> {
        fs::create_dir_all(path).map_err(|problem| FileError::Write { path: path.to_owned(), problem })?;
        let lock = Lock::take(path)?;
        if is_used(path)? {
            return Err(RunError::NotEmpty(path.to_owned()));
        }
        let configuration = &simulation.configuration;
        write_atomically(&path.join(CONFIGURATION), configuration.to_toml().as_bytes())?;
        let start =
            compare_with_start(simulation).then(|| StartingState::write(path, simulation)).transpose()?;
        let (format, trajectory_path) = trajectory(path, configuration);
        Ok(Self {
            trajectory: Trajectory::create(&trajectory_path, format, &simulation.torus)?,
            trajectory_place: Place::of(&trajectory_path)?,
            path: path.to_owned(),
            torus: simulation.torus,
            tables: Tables::create(path, simulation, initial(&start))?,
            start,
            manifest: Manifest::begin(path, simulation.engine.clock().step),
            _lock: lock,
        })
    }

    /// Opens the directory of a run to go on where `progress` says that its files had come; what they got later is
    /// dropped.
    pub(super) fn resume(
        path: &Path,
        lock: Lock,
        simulation: &Simulation,
        progress: &Progress,
    ) -> Result<Self, RunError> {
        let configuration = &simulation.configuration;
        let (format, trajectory_path) = trajectory(path, configuration);
        // Nothing is dropped before everything has been looked at; a trajectory looks before it drops.
        let start = progress.start.as_ref().map(|digest| StartingState::read(path, digest)).transpose()?;
        let mut tables = Tables::open(path, simulation, initial(&start), &progress.tables)?;
        if !trajectory_path.exists() {
            return Err(RunError::Gone(trajectory_path));
        }
        let extent = progress.trajectory.extent();
        let trajectory = Trajectory::resume(&trajectory_path, format, &simulation.torus, extent);
        let trajectory = trajectory.map_err(|error| match error {
            FileError::Extent { .. } => RunError::Lost(error),
            other => other.into(),
        })?;
        tables.cut()?;
        remove_leftovers(path, progress.snapshots.next)?;
        let text = configuration.to_toml();
        let written = fs::read(path.join(CONFIGURATION)).is_ok_and(|found| found == text.as_bytes());
        if !written {
            write_atomically(&path.join(CONFIGURATION), text.as_bytes())?;
        }
        Ok(Self {
            trajectory,
            trajectory_place: Place::of(&trajectory_path)?,
            path: path.to_owned(),
            torus: simulation.torus,
            tables,
            start,
            manifest: Manifest::begin(path, simulation.engine.clock().step),
            _lock: lock,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Notes which tables are due at time `now` (unit 2⁻⁴⁰ R0²/D): whether `observables.csv` is, and whether any is.
    pub(super) fn note_due(&mut self, now: u64) -> [bool; 2] {
        self.tables.note_due(now)
    }

    /// Writes the rows of the tables that are due.
    pub(super) fn write_rows(&mut self, moment: &Moment, frame: &Frame<'_>) -> Result<(), RunError> {
        self.tables.write(moment, frame)
    }

    /// SHA-256 of the state at the start, if a table compares with it.
    pub(super) fn start_digest(&self) -> Option<String> {
        self.start.as_ref().map(|start| start.digest.clone())
    }

    pub(super) fn write_frame(&mut self, frame: &Frame<'_>) -> Result<(), RunError> {
        self.trajectory_place.check()?;
        let written = self.trajectory.append(frame);
        // Some formats put a file of their own in the place of the one before. That the file was cut in the meantime is a
        // better reason than what came of it.
        self.trajectory_place.renew()?;
        Ok(written?)
    }

    /// Draws the `index`-th snapshot, clustered discs in red.
    pub(super) fn draw_snapshot(
        &self,
        index: u64,
        simulation: &Simulation,
        positions: &[Position],
        clusters: &Clusters,
    ) -> Result<(), RunError> {
        let path = self.path.join(snapshot_name(index));
        let clustered = |id| clusters.clustered(id);
        snapshot::draw(&path, &self.torus, positions, &clustered, &caption(simulation))?;
        Ok(())
    }

    /// Waits until the files that grow are on the disk; tells how far they have come, the `next`-th frame being due.
    pub(super) fn sync(&mut self, next: u64) -> Result<(BTreeMap<String, Table>, Frames), RunError> {
        self.trajectory_place.check()?;
        let extent = self.trajectory.sync();
        self.trajectory_place.renew()?;
        let Extent { frames, bytes } = extent?;
        Ok((self.tables.sync()?, Frames { next, frames, bytes }))
    }

    /// Makes `checkpoint` the newest.
    pub(super) fn store(&self, checkpoint: &Checkpoint) -> Result<(), RunError> {
        Ok(store::store(&self.path, checkpoint)?)
    }

    /// Writes the last state as `final.csv` and `final.state`.
    pub(super) fn write_state(&self, simulation: &Simulation) -> Result<(), RunError> {
        let positions = simulation.engine.positions();
        let strengths = simulation.engine.strengths();
        csv::write(&self.path.join("final.csv"), &self.torus, &positions, &strengths)?;
        Ok(simulation.state().write(&self.path.join("final.state"))?)
    }

    /// Writes `run.json`.
    pub(super) fn write_manifest(
        &self,
        simulation: &Simulation,
        ending: Ending,
        checkpoints: u64,
    ) -> Result<(), RunError> {
        let text = self.manifest.to_text(simulation, ending, checkpoints);
        Ok(write_atomically(&self.path.join(manifest::FILE), text.as_bytes())?)
    }
}

/// Where the discs were at the start; nothing where no table asks.
fn initial(start: &Option<StartingState>) -> &[Position] {
    start.as_ref().map(|start| &start.positions[..]).unwrap_or_default()
}

/// Whether the directory at `path` tells that its run has finished as `outcome` says.
pub(super) fn is_finished(path: &Path, outcome: &Outcome) -> bool {
    manifest::tells_finished(path, outcome)
}

/// Format and path of the trajectory.
fn trajectory(directory: &Path, configuration: &Configuration) -> (Format, PathBuf) {
    let format = configuration.output.trajectory_format;
    (format, directory.join(format.file_name()))
}

fn snapshot_name(index: u64) -> String {
    format!("snapshot-{index:03}.png")
}

/// Removes what a run that was killed left behind: files being written, and snapshots from the `next_snapshot`-th on,
/// which it will draw again.
fn remove_leftovers(directory: &Path, next_snapshot: u64) -> Result<(), RunError> {
    store::remove_partial(directory)?;
    let entries = fs::read_dir(directory)
        .map_err(|problem| FileError::Write { path: directory.to_owned(), problem })?;
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        let index = name.strip_prefix("snapshot-").and_then(|name| name.strip_suffix(".png"));
        let index = index.and_then(|index| index.parse::<u64>().ok());
        let is_later = index.is_some_and(|index| index >= next_snapshot && snapshot_name(index) == name);
        if is_later || atomic::is_unfinished(name) {
            let path = entry.path();
            fs::remove_file(&path).map_err(|problem| FileError::Write { path, problem })?;
        }
    }
    Ok(())
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
