//! `run.json`: what was run, where and when, and how it ended.
//!
//! A run that was stopped and resumed has several legs. The file is written when a leg begins and when it ends; so a leg
//! that was killed is still called running, until the next one begins.

use super::{Outcome, Stop};
use crate::configuration::{Configuration, Force};
use crate::simulation::Simulation;
use meniscus_core::units::time_from_units;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::path::Path;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Name of the file.
pub(super) const FILE: &str = "run.json";

/// How a leg stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    Running,
    Finished,
    Stopped(Stop),
    Failed,
}

impl Ending {
    fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Finished => "finished",
            Self::Stopped(stop) => stop.word(),
            Self::Failed => "error",
        }
    }
}

/// What the manifest needs besides the state of the run.
#[derive(Debug)]
pub(super) struct Manifest {
    earlier: Vec<Value>,
    begun: Instant,
    begun_at: u64,
    first_step: u64,
}

impl Manifest {
    /// Of a leg that begins at step `first_step`, after those of which `directory` tells.
    pub(super) fn begin(directory: &Path, first_step: u64) -> Self {
        let mut earlier = match read(directory).as_ref().and_then(|found| found.get("legs")) {
            Some(Value::Array(legs)) => legs.clone(),
            _ => Vec::new(),
        };
        for leg in &mut earlier {
            if leg["ended"] == Ending::Running.word() {
                leg["ended"] = "killed".into();
            }
        }
        Self { earlier, begun: Instant::now(), begun_at: now(), first_step }
    }

    /// The file's text.
    pub(super) fn to_text(&self, simulation: &Simulation, ending: Ending, checkpoints: u64) -> String {
        let configuration = &simulation.configuration;
        let (engine, clock) = (&simulation.engine, simulation.engine.clock());
        let ended = ending != Ending::Running;
        let leg = json!({
            "host": gethostname::gethostname().to_string_lossy(),
            "machine": format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            "engine": engine.kind().word(),
            "threads": engine.threads(),
            "began_at_unix_seconds": self.begun_at,
            "ended_at_unix_seconds": ended.then(now),
            "wall_seconds": ended.then(|| self.begun.elapsed().as_secs_f64()),
            "first_step": self.first_step,
            "last_step": ended.then_some(clock.step),
            "ended": ending.word(),
        });
        let legs: Vec<&Value> = self.earlier.iter().chain([&leg]).collect();
        let digest = ended.then(|| engine.state().digest());
        let summary = json!({
            "program": "meniscus",
            "version": env!("CARGO_PKG_VERSION"),
            "configuration_sha256": sha256(configuration.to_toml().as_bytes()),
            "seed": configuration.seed,
            "ended": ending.word(),
            "legs": legs,
            "checkpoints": checkpoints,
            "step": clock.step,
            "time": time_from_units(clock.time),
            "time_over_jeans": simulation.time_over_jeans(),
            "jeans_time": configuration.jeans_time(),
            "time_unit_seconds": configuration.seconds_per_time_unit(),
            "force": force(simulation),
            "length": digest.map(|digest| digest.length),
            "digest": digest.map(|digest| digest.to_string()),
        });
        format!("{summary:#}\n")
    }
}

/// Whether `directory` tells that the run has finished as `outcome` says.
pub(super) fn tells_finished(directory: &Path, outcome: &Outcome) -> bool {
    let told = |found: &Value| {
        found["ended"] == Ending::Finished.word()
            && found["step"] == outcome.clock.step
            && found["digest"] == outcome.digest.to_string()
    };
    read(directory).as_ref().is_some_and(told)
}

/// What is there, if it can be read; nothing hangs on it.
fn read(directory: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(directory.join(FILE)).ok()?).ok()
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
}

pub(super) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
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
