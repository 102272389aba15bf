//! A run that is stopped and resumed leaves what a run leaves that was never stopped, to the last byte.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use meniscus::checkpoint::store;
use meniscus::configuration::Configuration;
use meniscus::engine::{Kind, Machinery};
use meniscus::golden::Golden;
use meniscus::run::{GoldenRequest, Outcome, Resumed, Run, Stop};
use meniscus::simulation::Simulation;
use meniscus_tests::directories::{assert_same_files, fast_folder, sha256};
use meniscus_tests::long_tests;
use std::path::Path;

/// 40 discs in a box so small that they cross its borders, with rows and frames at other steps than checkpoints.
const SMALL: &str = "version = 1\nseed = 3\n\
    [system]\nparticles = 40\nbox = 24\ncapillary_strength = 10\ncapillary_length = 20\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 16\n\
    [output]\nobservables = 0.01\ntrajectory = 0.023\nsnapshots = 0\ncheckpoint_minutes = 0\n";

/// Every series, of a patch, each at an interval of its own.
const ALL_SERIES: [&str; 8] = [
    "start.kind=disc",
    "start.radius=11",
    "output.minkowski=0.003",
    "output.minkowski_thresholds=[0.1, 0.2]",
    "output.modes=0.007",
    "output.radial_distribution=0.02",
    "output.structure_factor=0.03",
    "output.radii=0.004",
];

const HOST: Machinery = Machinery { kind: Kind::Host, threads: 1 };
const THREADS: Machinery = Machinery { kind: Kind::Host, threads: 3 };
const CORE: Machinery = Machinery { kind: Kind::Core, threads: 1 };

fn configuration(overrides: &[&str]) -> Configuration {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    Configuration::from_text("small.toml", SMALL, &overrides).unwrap()
}

/// A run of that configuration in `directory`, with a golden record every `every` steps.
fn begin(directory: &Path, overrides: &[&str], every: u64, machinery: Machinery) -> Run {
    let simulation = Simulation::with_machinery(configuration(overrides), machinery).unwrap();
    let golden = GoldenRequest { every, ..GoldenRequest::in_directory(directory) };
    Run::create(simulation, directory, golden).unwrap()
}

fn go_on(directory: &Path, machinery: Machinery) -> Run {
    match Run::resume(directory, machinery, None).unwrap() {
        Resumed::Ready { run, warnings } => {
            assert_eq!(warnings, [""; 0]);
            *run
        }
        Resumed::Finished(outcome) => panic!("it has finished: {outcome:?}"),
    }
}

fn until_step(run: Run, last: u64) -> Outcome {
    run.to_end(|simulation| (simulation.engine.clock().step >= last).then_some(Stop::Interrupted)).unwrap()
}

fn to_end(run: Run) -> Outcome {
    let outcome = run.to_end(|_| None).unwrap();
    assert_eq!(outcome.stop, None);
    outcome
}

/// What `run.json` of a run tells.
fn manifest(directory: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(directory.join("run.json")).unwrap()).unwrap()
}

/// The first golden record of two runs that differs, field by field.
#[track_caller]
fn assert_same_records(expected: &Path, found: &Path) {
    let [expected, found] = [expected, found].map(|run| Golden::read(&run.join("golden.toml")).unwrap());
    for (expected, found) in expected.records.iter().zip(&found.records) {
        assert_eq!(expected.difference(found), None);
    }
    assert_eq!(expected.records.len(), found.records.len());
}

#[track_caller]
fn assert_same(expected: &Path, found: &Path) {
    assert_same_records(expected, found);
    assert_same_files(expected, found);
    // What holding mesh forces has saved, over all legs, and how far they were off: a sum that is rounded.
    let [mut expected, mut found] = [expected, found].map(|run| manifest(run)["force"].take());
    let errors = [&mut expected, &mut found]
        .map(|force| force.get_mut("mesh_refresh").and_then(|held| held["measured_error"].take().as_f64()));
    assert_eq!(expected, found);
    let [expected, found] = errors.map(Option::unwrap_or_default);
    assert!((found - expected).abs() <= 1e-12 * expected, "{found} is not {expected}");
}

/// Stops at every step of a short run and resumes, by turns in every machinery; and in one run stops at every step.
fn restart_at_every_step(overrides: &[&str]) {
    let folder = fast_folder();
    let path = |name: &str| folder.path().join(name);
    let overrides = [overrides, &["time.until=0.1"]].concat();
    let last = to_end(begin(&path("whole"), &overrides, 1, HOST)).clock.step;
    assert!((15..80).contains(&last), "{last} steps");

    let machineries = [CORE, HOST, THREADS];
    let machinery = |number: u64| machineries[number as usize % machineries.len()];
    for step in 1..last {
        let stopped = path(&format!("stopped-{step}"));
        let outcome = until_step(begin(&stopped, &overrides, 1, machinery(step)), step);
        assert_eq!((outcome.stop, outcome.clock.step), (Some(Stop::Interrupted), step));
        to_end(go_on(&stopped, machinery(step / 3)));
        assert_same(&path("whole"), &stopped);
    }
    let by_steps = path("by-steps");
    until_step(begin(&by_steps, &overrides, 1, HOST), 1);
    for step in 2..last {
        until_step(go_on(&by_steps, machinery(step)), step);
    }
    to_end(go_on(&by_steps, HOST));
    assert_same(&path("whole"), &by_steps);
}

#[test]
fn a_restart_at_any_step_leaves_the_same_files() {
    restart_at_every_step(&[]);
}

#[test]
fn held_mesh_forces_survive_a_restart_at_any_step() {
    restart_at_every_step(&["force.mesh_refresh=0.1"]);
}

#[test]
fn strengths_survive_a_restart_at_any_step() {
    restart_at_every_step(&["system.strengths=[1, -1, 0.5]"]);
}

#[test]
fn every_series_survives_a_restart_at_any_step() {
    restart_at_every_step(&ALL_SERIES);
}

#[test]
fn borders_crossed_survive_a_restart() {
    let folder = fast_folder();
    let overrides = ["time.until=0.3", "field.uniform_force=[400, -300]", "motion.max_step=0.01"];
    let crossings = |name: &str, stop: Option<u64>| {
        let path = folder.path().join(name);
        let mut run = begin(&path, &overrides, 1000, HOST);
        if let Some(stop) = stop {
            until_step(run, stop);
            run = go_on(&path, CORE);
        }
        let mut crossings = Vec::new();
        run.to_end(|simulation| {
            crossings = simulation.engine.crossings();
            None
        })
        .unwrap();
        crossings
    };
    let whole = crossings("whole", None);
    let most = whole.iter().map(|[x, _]| x).max().unwrap();
    let least = whole.iter().map(|[_, y]| y).min().unwrap();
    assert!(*most >= 1 && *least <= -1, "{whole:?}");
    assert_eq!(crossings("stopped", Some(40)), whole);
}

/// Stops a longer run at steps that look random, several times, in both engines and with threads.
#[test]
fn restarts_at_random_steps_leave_the_same_files() {
    let until = if long_tests() { "time.until=3" } else { "time.until=0.3" };
    let more: [&[&str]; 3] = [
        &["output.checkpoint_steps=7"],
        &["force.mesh_refresh=0.2", "output.checkpoint_steps=11"],
        &["force.method=p3m", "mesh.grid=16", "mesh.assignment=order-5", "system.strengths=[1, 2]"],
    ];
    for (seed, more) in (1_u64..).zip(more) {
        let folder = fast_folder();
        let [whole, stopped] = ["whole", "stopped"].map(|name| folder.path().join(name));
        let overrides = [&[until], more].concat();
        let last = to_end(begin(&whole, &overrides, 10, THREADS)).clock.step;
        let mut step = 0;
        let mut random = seed;
        let mut run = begin(&stopped, &overrides, 10, HOST);
        loop {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            step += 1 + (random >> 33) % (last / 4);
            if step >= last {
                break;
            }
            until_step(run, step);
            run = go_on(&stopped, [CORE, THREADS, HOST][step as usize % 3]);
        }
        to_end(run);
        assert_same(&whole, &stopped);
    }
}

/// A run that went on after its newest checkpoint, as if it had been killed then.
#[test]
fn what_came_after_the_checkpoint_is_dropped() {
    let folder = fast_folder();
    for format in ["gsd", "xyz", "lammps", "npz"] {
        let [whole, killed] = ["whole", "killed"].map(|name| folder.path().join(format!("{format}-{name}")));
        let format = format!("output.trajectory_format={format}");
        let overrides = ["time.until=0.1", "output.trajectory=0.01", "force.mesh_refresh=0.1", &format];
        to_end(begin(&whole, &overrides, 2, HOST));
        until_step(begin(&killed, &overrides, 2, HOST), 9);
        let checkpoint = std::fs::read(killed.join(store::CURRENT)).unwrap();
        until_step(go_on(&killed, THREADS), 23);
        std::fs::write(killed.join(store::CURRENT), checkpoint).unwrap();
        let _ = std::fs::remove_file(killed.join(store::PREVIOUS));
        to_end(go_on(&killed, CORE));
        assert_same(&whole, &killed);
    }
}

#[test]
fn pictures_are_counted_over_a_restart() {
    let folder = fast_folder();
    let path = folder.path().join("run");
    // Only that of the start is drawn, for pictures take seconds without optimisation.
    let overrides = ["time.until=0.1", "output.snapshots=1"];
    until_step(begin(&path, &overrides, 1000, HOST), 2);
    std::fs::write(path.join("snapshot-001.png"), "of a leg that was killed").unwrap();
    until_step(go_on(&path, HOST), 4);
    assert!(path.join("snapshot-000.png").exists() && !path.join("snapshot-001.png").exists());
    let progress = store::latest(&path).unwrap().checkpoint.progress;
    let progress: serde_json::Value = serde_json::from_str(&progress).unwrap();
    assert_eq!(progress["snapshots"]["next"], 1);
}

/// A checkpoint is there at the start and at the end, and by the wall time between two of them.
#[test]
fn checkpoints_are_written_by_the_wall_time() {
    let folder = fast_folder();
    let written = |name: &str, minutes: &str| {
        let path = folder.path().join(name);
        let setting = format!("output.checkpoint_minutes={minutes}");
        let steps = to_end(begin(&path, &["time.until=0.05", &setting], 1000, HOST)).clock.step;
        (manifest(&path)["checkpoints"].as_u64().unwrap(), steps)
    };
    assert_eq!(written("none", "0").0, 2);
    assert_eq!(written("rare", "1000").0, 2);
    let (checkpoints, steps) = written("always", "1e-12");
    assert!(steps > 3, "{steps} steps");
    assert_eq!(checkpoints, 1 + steps);
}

#[test]
fn a_later_end_gives_the_files_of_a_run_that_had_it_from_the_start() {
    let folder = fast_folder();
    let [whole, further] = ["whole", "further"].map(|name| folder.path().join(name));
    // Pictures take seconds without optimisation.
    let snapshots = if long_tests() { "output.snapshots=0.05" } else { "output.snapshots=0" };
    to_end(begin(&whole, &["time.until=0.2", snapshots], 10, HOST));
    to_end(begin(&further, &["time.until=0.1", snapshots], 10, HOST));
    let Resumed::Ready { run, .. } = Run::resume(&further, HOST, Some(0.2)).unwrap() else {
        panic!("there is more to do");
    };
    to_end(*run);
    assert_same(&whole, &further);
}

#[test]
fn a_finished_run_is_left_as_it_is() {
    let folder = fast_folder();
    let path = folder.path().join("run");
    let outcome = to_end(begin(&path, &["time.until=0.02"], 10, HOST));
    let manifest = std::fs::read(path.join("run.json")).unwrap();
    match Run::resume(&path, CORE, None).unwrap() {
        Resumed::Finished(again) => assert_eq!((again.digest, again.clock), (outcome.digest, outcome.clock)),
        Resumed::Ready { .. } => panic!("there is nothing to do"),
    }
    assert_eq!(std::fs::read(path.join("run.json")).unwrap(), manifest);
}

#[test]
fn the_manifest_tells_of_every_leg() {
    let folder = fast_folder();
    let path = folder.path().join("run");
    until_step(begin(&path, &["time.until=0.1", "output.checkpoint_steps=4"], 10, HOST), 9);
    drop(go_on(&path, HOST));
    let outcome = to_end(go_on(&path, CORE));
    let told = manifest(&path);
    let legs: Vec<[String; 4]> = told["legs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|leg| ["engine", "first_step", "last_step", "ended"].map(|key| leg[key].to_string()))
        .collect();
    let last = outcome.clock.step.to_string();
    let leg = |words: [&str; 4]| words.map(str::to_owned);
    assert_eq!(legs[0], leg(["\"host\"", "0", "9", "\"interrupted\""]));
    assert_eq!(legs[1], leg(["\"host\"", "9", "null", "\"killed\""]));
    assert_eq!(legs[2], leg(["\"core\"", "9", &last, "\"finished\""]));
    assert_eq!(told["digest"], outcome.digest.to_string());
    // At the start, at steps 4, 8, 9, 12, … and at the end.
    let by_steps = (outcome.clock.step - 1) / 4;
    assert_eq!(told["checkpoints"], 1 + by_steps + 2);
    assert_eq!(told["seed"], 3);
    let configuration = std::fs::read(path.join("config.toml")).unwrap();
    assert_eq!(told["configuration_sha256"], sha256(&configuration));
}
