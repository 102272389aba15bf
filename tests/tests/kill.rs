//! Runs that are killed again and again at random moments, also while they write, and resumed: all files are those of a
//! run that was left alone.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
#![allow(clippy::print_stderr, reason = "the table is what the test is to show")]

use meniscus::checkpoint::store;
use meniscus_tests::directories::{difference, fast_folder};
use meniscus_tests::long_tests;
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// 60 discs whose mesh forces are held for a few steps, with a checkpoint at every second step, a row at nearly every one,
/// and a frame and rows of every other series now and then.
const CONFIGURATION: &str = "version = 1\nseed = 11\n\
    [system]\nparticles = 60\nbox = 48\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\nmesh_refresh = 0.2\n[mesh]\ngrid = 32\n\
    [time]\nuntil = 0.1\n\
    [start]\nkind = \"disc\"\nradius = 20\n\
    [output]\nminkowski = 0.003\nmodes = 0.01\nmodes_shells = 2\nradial_distribution = 0.02\nstructure_factor = 0.05\n\
    radii = 0.004\nobservables = 0.002\ntrajectory = 0.005\nsnapshots = 0\ncheckpoint_steps = 2\n";

/// What became of the runs.
#[derive(Debug, Default)]
struct Table {
    runs: usize,
    kills: usize,
    resumes: usize,
    /// Killed before there was a checkpoint, and begun anew.
    anew: usize,
    /// Killed while a checkpoint was being written.
    in_checkpoint: usize,
    /// Killed while another file was being written whole.
    in_file: usize,
    /// Killed with rows or frames that the checkpoint does not know.
    ahead: usize,
    /// Of these, with a row that was cut.
    torn: usize,
    mismatches: usize,
}

impl Table {
    /// Notes what a kill has left in `directory`.
    fn look(&mut self, directory: &Path) {
        self.in_checkpoint += usize::from(directory.join(store::PARTIAL).exists());
        let names = fs::read_dir(directory).into_iter().flatten().flatten().map(|entry| entry.file_name());
        self.in_file +=
            usize::from(names.into_iter().any(|name| name.to_string_lossy().starts_with(".meniscus-")));
        let Ok(latest) = store::latest(directory) else { return };
        let progress: serde_json::Value = serde_json::from_str(&latest.checkpoint.progress).unwrap();
        let table = fs::read(directory.join("observables.csv")).unwrap();
        let trajectory = fs::read_dir(directory)
            .unwrap()
            .flatten()
            .find(|entry| entry.file_name().to_string_lossy().starts_with("trajectory."));
        let frames = trajectory.unwrap().metadata().unwrap().len();
        let [known_rows, known_frames] = [&progress["tables"]["observables"], &progress["trajectory"]]
            .map(|file| file["bytes"].as_u64().unwrap());
        assert!(table.len() as u64 >= known_rows && frames >= known_frames, "a checkpoint knows too much");
        self.ahead += usize::from(table.len() as u64 > known_rows || frames > known_frames);
        self.torn += usize::from(!table.ends_with(b"\n"));
    }
}

/// A number that nobody chose.
fn random() -> u64 {
    RandomState::new().hash_one(0_u8)
}

/// Starts the program, which is killed after up to `patience`. Tells whether it ended by itself.
fn start_and_kill(folder: &Path, arguments: &[&str], patience: Duration) -> bool {
    let mut child = Command::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(patience.mul_f64((random() >> 11) as f64 / (1_u64 << 53) as f64));
    if child.try_wait().unwrap().is_none() {
        child.kill().unwrap();
    }
    let output = child.wait_with_output().unwrap();
    // A kill may come too late.
    assert!(
        matches!(output.status.code(), None | Some(0)),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    output.status.success()
}

/// Kills runs in `folder` until `kills` are reached.
fn campaign(folder: &Path, more: &[&str], kills: usize, patience: Duration) -> Table {
    fs::write(folder.join("small.toml"), CONFIGURATION).unwrap();
    fn begin<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        [&["run", "small.toml", "--every", "3", "--out", out], more].concat()
    }
    assert!(start_and_kill_never(folder, &begin("whole", more)));
    let told = fs::read(folder.join("whole/run.json")).unwrap();
    let told: serde_json::Value = serde_json::from_slice(&told).unwrap();
    let saved = told["force"]["mesh_refresh"]["saved"].as_f64();
    assert!(saved.unwrap() > 0.4, "no forces are held");
    let machineries: [&[&str]; 3] = [&["--engine", "core"], &["--threads", "1"], &["--threads", "2"]];
    let mut table = Table::default();
    while table.kills < kills {
        let name = format!("run-{}", table.runs);
        let directory = folder.join(&name);
        let mut ended = start_and_kill(folder, &begin(&name, more), patience);
        while !ended {
            table.kills += 1;
            table.look(&directory);
            if store::latest(&directory).is_err() {
                table.anew += 1;
                let _ = fs::remove_dir_all(&directory);
                ended = start_and_kill(folder, &begin(&name, more), patience);
                continue;
            }
            table.resumes += 1;
            let machinery = machineries[table.resumes % machineries.len()];
            ended = start_and_kill(folder, &[&["resume", &name], machinery].concat(), patience);
        }
        table.runs += 1;
        if let Some(difference) = difference(&folder.join("whole"), &directory) {
            eprintln!("{name}: {difference}");
            table.mismatches += 1;
        } else {
            fs::remove_dir_all(directory).unwrap();
        }
    }
    table
}

fn start_and_kill_never(folder: &Path, arguments: &[&str]) -> bool {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    command.current_dir(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().unwrap().success()
}

/// Kills runs with trajectories of `format`: a few, or with `MENISCUS_LONG_TESTS=1` more, on the disk.
fn kill(format: &str, few: usize, many: usize) {
    let setting = format!("output.trajectory_format={format}");
    let pictures = ["--until", "0.3", "--set", "output.snapshots=0.05"];
    let (folder, patience, pictures, kills) = if long_tests() {
        (tempfile::tempdir().unwrap(), 400, &pictures[..], many)
    } else {
        (fast_folder(), 150, &[][..], few)
    };
    let more = [pictures, &["--set", &setting]].concat();
    let table = campaign(folder.path(), &more, kills, Duration::from_millis(patience));
    eprintln!("{format}: {table:?}");
    assert_eq!(table.mismatches, 0);
    assert!(table.kills >= kills && table.resumes > 0);
    // So many kills hit checkpoints and appends that are under way.
    assert!(kills < 200 || (table.in_checkpoint > 0 && table.ahead > 0), "{table:?}");
}

#[test]
fn a_run_that_is_killed_and_resumed_leaves_what_a_run_leaves() {
    kill("gsd", 8, 200);
}

#[test]
fn so_does_one_with_a_numpy_archive() {
    kill("npz", 4, 50);
}

#[test]
fn so_do_those_with_text() {
    for format in ["xyz", "lammps"] {
        kill(format, 3, 50);
    }
}
