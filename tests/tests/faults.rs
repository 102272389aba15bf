//! What can go wrong around a run: each gets one clear message, and nothing is lost that was written.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
#![allow(clippy::print_stderr, reason = "a test says what it could not try")]

use meniscus::checkpoint::store;
use meniscus_tests::directories::{assert_same_files, fast_folder};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// 60 discs on a small mesh, a checkpoint at every fourth step.
const SMALL: &str = "version = 1\nseed = 7\n\
    [system]\nparticles = 60\nbox = 48\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 32\n\
    [time]\nuntil = 0.1\n\
    [output]\nobservables = 0.01\ntrajectory = 0.02\nsnapshots = 0\ncheckpoint_steps = 4\n";

/// So long that it does not end by itself while a test looks at it.
const LONG: [&str; 2] = ["--until", "1000"];

fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments).output().unwrap()
}

/// The program has to succeed; gives what it said on standard error.
#[track_caller]
fn succeed(folder: &Path, arguments: &[&str]) -> String {
    told(&output(folder, arguments), Some(0), &[])
}

/// The program has to fail with one line that holds every part.
#[track_caller]
fn refuse(folder: &Path, arguments: &[&str], parts: &[&str]) {
    told(&output(folder, arguments), Some(2), parts);
}

#[track_caller]
fn told(output: &Output, code: Option<i32>, parts: &[&str]) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), code, "{said}");
    assert!(!said.contains("panicked"), "{said}");
    let errors: Vec<&str> = said.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), usize::from(code == Some(2)), "{said}");
    for part in parts {
        assert!(errors.iter().any(|error| error.contains(part)), "{part} is not in {said}");
    }
    said
}

fn folder() -> tempfile::TempDir {
    let folder = fast_folder();
    fs::write(folder.path().join("small.toml"), SMALL).unwrap();
    folder
}

fn run<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", "small.toml", "--every", "5", "--out", out], more].concat()
}

/// A run that has written a few checkpoints and goes on.
fn under_way(folder: &Path, out: &str) -> Child {
    under_way_with(folder, out, &[]).0
}

/// The same with more arguments, and its directory.
fn under_way_with(folder: &Path, out: &str, more: &[&str]) -> (Child, PathBuf) {
    let child = program(folder, &run(out, &[&LONG[..], more].concat())).spawn().unwrap();
    let directory = folder.join(out);
    wait_for_step(&directory, 12);
    (child, directory)
}

fn wait_for_step(directory: &Path, step: u64) {
    let begun = Instant::now();
    while store::latest(directory).map_or(0, |latest| latest.checkpoint.step()) < step {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not get on");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn signal(child: &Child, signal: &str) {
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

/// A run that was stopped half-way by the wall time, and one that was not.
fn stopped_and_whole(folder: &Path) {
    succeed(folder, &run("whole", &[]));
    succeed(folder, &run("run", &["--max-wall", "0"]));
}

#[track_caller]
fn assert_goes_on(folder: &Path) {
    succeed(folder, &["resume", "run"]);
    assert_same_files(&folder.join("whole"), &folder.join("run"));
}

#[test]
fn a_second_run_in_a_directory_is_refused_while_the_first_is_at_work() {
    let folder = folder();
    let mut first = under_way(folder.path(), "run");
    let busy = ["run: another run is at work in this directory", "wait"];
    refuse(folder.path(), &["resume", "run"], &busy);
    refuse(folder.path(), &run("run", &[]), &busy);
    // Nor does it help to remove what is locked.
    if cfg!(target_os = "linux") {
        fs::remove_file(folder.path().join("run/lock")).unwrap();
        refuse(folder.path(), &["resume", "run"], &busy);
        refuse(folder.path(), &run("run", &[]), &busy);
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // What a kill leaves behind is in nobody's way.
    refuse(folder.path(), &run("run", &[]), &["run: the directory is not empty"]);
    succeed(folder.path(), &["resume", "run", "--max-wall", "0"]);
}

#[test]
fn a_request_to_terminate_leaves_a_checkpoint_and_says_how_to_go_on() {
    let folder = folder();
    succeed(folder.path(), &run("whole", &["--until", "0.3"]));
    for name in ["-TERM", "-INT"] {
        let child = under_way(folder.path(), "run");
        signal(&child, name);
        let said = told(&child.wait_with_output().unwrap(), Some(0), &[]);
        assert!(said.contains("interrupted; to go on: meniscus resume run\n"), "{said}");
        let manifest = fs::read_to_string(folder.path().join("run/run.json")).unwrap();
        assert!(manifest.contains("\"ended\": \"interrupted\""), "{manifest}");
        let step = store::latest(&folder.path().join("run")).unwrap().checkpoint.step();
        assert!(manifest.contains(&format!("\"step\": {step},")), "{manifest}");
        fs::remove_dir_all(folder.path().join("run")).unwrap();
    }
}

#[test]
fn a_damaged_checkpoint_is_said_and_the_one_before_is_used() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let path = folder.path().join("run/checkpoint");
    let whole = fs::read(&path).unwrap();
    for damaged in [&whole[..whole.len() - 9], b"", &[&whole[..200], b"!", &whole[201..]].concat()] {
        fs::write(&path, damaged).unwrap();
        let said = succeed(folder.path(), &["resume", "run", "--max-wall", "0"]);
        assert!(said.contains("run/checkpoint: ") && said.contains("is used instead"), "{said}");
    }
    // Also where nothing but results is asked for.
    fs::write(&path, b"").unwrap();
    let said = succeed(folder.path(), &["resume", "run", "--max-wall", "0", "--quiet"]);
    assert!(said.ends_with("is used instead\n") && said.lines().count() == 1, "{said}");
    assert_goes_on(folder.path());
    for name in [store::CURRENT, store::PREVIOUS] {
        fs::write(folder.path().join("run").join(name), b"MENISCHK and so on").unwrap();
    }
    refuse(folder.path(), &["resume", "run"], &["run/checkpoint:", "run/checkpoint.previous:", "anew"]);
}

#[test]
fn a_checkpoint_of_a_later_format_is_left_alone() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let path = folder.path().join("run/checkpoint");
    let mut bytes = fs::read(&path).unwrap();
    bytes[8] += 1;
    let header = crc32fast::hash(&bytes[..20]);
    bytes[20..24].copy_from_slice(&header.to_le_bytes());
    fs::write(&path, &bytes).unwrap();
    refuse(folder.path(), &["resume", "run"], &["run/checkpoint: ", "format version 2", "reads 1"]);
    assert_eq!(fs::read(&path).unwrap(), bytes);
}

#[test]
fn a_checkpoint_of_another_version_is_refused() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let directory = folder.path().join("run");
    let mut checkpoint = store::latest(&directory).unwrap().checkpoint;
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(checkpoint.progress.contains(&version));
    checkpoint.progress = checkpoint.progress.replace(&version, "\"version\":\"9.9.9\",\"more\":0");
    store::store(&directory, &checkpoint).unwrap();
    refuse(folder.path(), &["resume", "run"], &["run/checkpoint: written by meniscus 9.9.9", "this is"]);
    checkpoint.progress = "{}".to_owned();
    store::store(&directory, &checkpoint).unwrap();
    refuse(folder.path(), &["resume", "run"], &["run/checkpoint: the section PROG cannot be read"]);
}

#[test]
fn a_configuration_that_does_not_match_is_refused_by_its_key() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let path = folder.path().join("run/config.toml");
    let text = fs::read_to_string(&path).unwrap();
    for (line, other, key) in [
        ("seed = 7", "seed = 8", "seed: found 8, the checkpoint was written with 7"),
        ("max_step = 0.001", "max_step = 0.002", "motion.max_step: found 0.002"),
        ("observables = 0.01", "observables = 0.02", "output.observables: found 0.02"),
        ("noise = \"uniform\"", "noise = \"no\"", "motion.noise"),
    ] {
        assert!(text.contains(line), "{text}");
        fs::write(&path, text.replace(line, other)).unwrap();
        refuse(folder.path(), &["resume", "run"], &["run/config.toml:", key]);
    }
    // Comments and the times of checkpoints are nobody's business, and one that is missing is in the checkpoint.
    fs::write(&path, format!("# Mine.\n{}", text.replace("checkpoint_steps = 4", "checkpoint_steps = 9")))
        .unwrap();
    succeed(folder.path(), &["resume", "run", "--max-wall", "0"]);
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        text.replace("checkpoint_steps = 4", "checkpoint_steps = 9")
    );
    fs::write(&path, &text).unwrap();
    succeed(folder.path(), &["resume", "run", "--max-wall", "0"]);
    fs::remove_file(&path).unwrap();
    assert_goes_on(folder.path());
}

#[test]
fn an_end_before_the_present_is_refused_and_a_finished_run_says_so() {
    let folder = folder();
    succeed(folder.path(), &run("run", &[]));
    let before = fs::read(folder.path().join("run/run.json")).unwrap();
    let said = succeed(folder.path(), &["resume", "run"]);
    assert!(said.contains("this run has finished; to go further: --until T"), "{said}");
    assert_eq!(fs::read(folder.path().join("run/run.json")).unwrap(), before);
    refuse(folder.path(), &["resume", "run", "--until", "0.05"], &["run: time.until = 0.05", "already"]);
    refuse(folder.path(), &["resume", "run", "--until", "-1"], &["time.until"]);
    refuse(folder.path(), &["resume", "nowhere"], &["nowhere: found no checkpoint"]);
    refuse(folder.path(), &["resume", "small.toml"], &["small.toml: found no checkpoint"]);
    assert!(!folder.path().join("nowhere").exists());
    refuse(folder.path(), &["resume", "."], &[".: found no checkpoint"]);
    assert!(!folder.path().join("lock").exists());
}

/// Adds a row to the table of observables, as a run does after its last checkpoint; gives what is in the file then.
fn add_row(run: &Path) -> Vec<u8> {
    let path = run.join("observables.csv");
    let bytes = [fs::read(&path).unwrap().as_slice(), b"1"].concat();
    fs::write(&path, &bytes).unwrap();
    bytes
}

#[test]
fn files_that_are_cut_or_gone_are_named() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let run = folder.path().join("run");
    let trajectory = fs::read_dir(&run)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .find(|name| name.starts_with("trajectory."))
        .unwrap();
    for name in ["observables.csv", "golden.toml", &trajectory] {
        let path = run.join(name);
        let whole = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        let message = format!("run/{name}: the file is gone; put it back");
        refuse(folder.path(), &["resume", "run"], &[&message]);
        if name != "golden.toml" {
            fs::write(&path, &whole[..whole.len() - 1]).unwrap();
            // What the table got after the checkpoint is still there when another file is refused.
            let before = if name == trajectory { add_row(&run) } else { fs::read(&path).unwrap() };
            refuse(folder.path(), &["resume", "run"], &[name, "found", "put the whole file back"]);
            assert_eq!(fs::read(run.join("observables.csv")).unwrap(), before);
        }
        fs::write(&path, &whole).unwrap();
    }
    let path = run.join("golden.toml");
    let whole = fs::read_to_string(&path).unwrap();
    let row = whole.lines().find(|line| line.starts_with("  [0,")).unwrap();
    fs::write(&path, whole.replace(&format!("{row}\n"), "")).unwrap();
    let row = whole.lines().find(|line| line.starts_with("  [1,"));
    if let Some(row) = row {
        fs::write(&path, fs::read_to_string(&path).unwrap().replace(&format!("{row}\n"), "")).unwrap();
    }
    refuse(folder.path(), &["resume", "run"], &["golden.toml: found 0 records", "1 records"]);
    fs::write(&path, whole).unwrap();
    assert_goes_on(folder.path());
}

#[test]
fn what_a_killed_run_leaves_behind_is_cleared_away() {
    let folder = folder();
    stopped_and_whole(folder.path());
    for name in [".meniscus-abcdef", "checkpoint.partial", "snapshot-000.png", "snapshot-007.png"] {
        fs::write(folder.path().join("run").join(name), "half").unwrap();
    }
    fs::write(folder.path().join("run/snapshot-mine.png"), "precious").unwrap();
    succeed(folder.path(), &["resume", "run"]);
    assert!(folder.path().join("run/snapshot-mine.png").exists());
    fs::remove_file(folder.path().join("run/snapshot-mine.png")).unwrap();
    assert_same_files(&folder.path().join("whole"), &folder.path().join("run"));
}

/// What a run says that does not come to its end by itself, while `harm` is done to it again and again. Once need not be
/// enough: a file that is about to be replaced as a whole may be removed or cut, and nothing is lost. A run that does not
/// mind is killed, and has no exit code.
fn output_of_harmed(mut child: Child, mut harm: impl FnMut()) -> Output {
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() >= Duration::from_secs(60) {
            child.kill().unwrap();
        }
        harm();
        std::thread::sleep(Duration::from_millis(20));
    }
    child.wait_with_output().unwrap()
}

/// The file in `folder` whose name contains `name`.
fn file_of(folder: &Path, name: &str) -> PathBuf {
    let mut entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.find(|path| path.to_str().unwrap().contains(name)).unwrap()
}

const FORMATS: [&str; 4] = [
    "output.trajectory_format=gsd",
    "output.trajectory_format=xyz",
    "output.trajectory_format=lammps",
    "output.trajectory_format=npz",
];

/// The formats of the trajectory to try, and the file to harm.
fn files_to_harm() -> impl Iterator<Item = (&'static str, &'static str)> {
    FORMATS.into_iter().map(|format| (format, "trajectory.")).chain([(FORMATS[0], "observables.csv")])
}

#[test]
fn a_file_that_is_removed_under_way_is_noticed() {
    let folder = folder();
    for (format, name) in files_to_harm() {
        let (child, run) = under_way_with(folder.path(), "run", &["--set", format]);
        let path = file_of(&run, name);
        let output = output_of_harmed(child, || {
            let _ = fs::remove_file(&path);
        });
        told(&output, Some(2), &[name, "the file was removed or replaced while the run was writing it"]);
        assert!(run.join("final.state").exists());
        fs::remove_dir_all(run).unwrap();
    }
}

#[test]
fn a_file_that_is_cut_under_way_is_noticed() {
    let folder = folder();
    for (format, name) in files_to_harm() {
        let (child, run) = under_way_with(folder.path(), "run", &["--set", format]);
        let path = file_of(&run, name);
        let output = output_of_harmed(child, || {
            fs::File::options().write(true).open(&path).unwrap().set_len(0).unwrap();
        });
        told(
            &output,
            Some(2),
            // Not always 0: the cut may fall between a look at the file and a frame.
            &[name, "bytes, the run has written", "the file was changed while the run was writing it"],
        );
        assert!(run.join("final.state").exists());
        fs::remove_dir_all(run).unwrap();
    }
}

/// A limit on the size of files takes the place of a disk that is full: what is written is cut in the same way.
#[test]
fn a_full_disk_loses_nothing_that_was_written() {
    for format in ["output.trajectory_format=gsd", "output.trajectory_format=npz"] {
        let folder = folder();
        let arguments = |out| run(out, &["--until", "3", "--set", format]);
        succeed(folder.path(), &arguments("whole"));
        let program = env!("CARGO_BIN_EXE_meniscus-under-test");
        // 16 KiB; the signal that comes with it ends programs that do not mind it.
        let script = format!("ulimit -f 16; exec {program} \"$@\"");
        let mut command = Command::new("bash");
        command.current_dir(folder.path()).args(["-c", &script, "bash"]).args(arguments("run"));
        let output = command.output().unwrap();
        told(
            &output,
            Some(2),
            &[
                "run/",
                "cannot be written: File too large",
                "`meniscus resume run` goes on from the checkpoint at step ",
            ],
        );
        assert!(store::latest(&folder.path().join("run")).is_ok());
        assert_goes_on(folder.path());
    }
}

/// Runs `script`, in which `$meniscus` is the program, where it may mount what `mounts` does, and nobody else sees it. None
/// where the system does not let it.
#[cfg(target_os = "linux")]
fn with_mounts(folder: &Path, mounts: &str, script: &str) -> Option<Output> {
    const REFUSED: i32 = 77;
    let script = format!("{mounts} || exit {REFUSED}\n{script}");
    let mut command = Command::new("unshare");
    command.current_dir(folder).args(["--map-root-user", "--mount", "bash", "-c", &script]);
    let output = command.env("meniscus", env!("CARGO_BIN_EXE_meniscus-under-test")).output().ok()?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(REFUSED) || said.starts_with("unshare: ") {
        eprintln!("nothing can be mounted here: {said}");
        return None;
    }
    Some(output)
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_file_system_loses_nothing_that_was_written() {
    let folder = folder();
    let until = ["--until", "0.4"];
    succeed(folder.path(), &run("whole", &until));
    fs::create_dir(folder.path().join("run")).unwrap();
    let script = format!(
        "$meniscus {} 2>said; echo $? >code
         mount -o remount,size=16m run && $meniscus resume run && cp -r run copy",
        run("run", &until).join(" ")
    );
    let Some(output) = with_mounts(folder.path(), "mount -t tmpfs -o size=64k none run", &script) else {
        return;
    };
    told(&output, Some(0), &[]);
    let [said, code] = ["said", "code"].map(|name| fs::read_to_string(folder.path().join(name)).unwrap());
    assert_eq!(code, "2\n", "{said}");
    let last = said.lines().last().unwrap();
    for part in ["error: run/", "cannot be written: No space left on device", "`meniscus resume run` goes on"]
    {
        assert!(last.contains(part), "{part} is not in {said}");
    }
    assert_same_files(&folder.path().join("whole"), &folder.path().join("copy"));
}

#[test]
#[cfg(target_os = "linux")]
fn a_directory_that_cannot_be_written_to_is_said_and_left_as_it_is() {
    let folder = folder();
    stopped_and_whole(folder.path());
    let mounts = "mount --bind run run && mount -o remount,bind,ro run";
    for command in ["resume run", "run small.toml --out run/inside"] {
        let Some(output) = with_mounts(folder.path(), mounts, &format!("$meniscus {command}")) else {
            return;
        };
        told(&output, Some(2), &["run/", "cannot be written: Read-only file system"]);
    }
    assert_goes_on(folder.path());
}

#[test]
fn places_where_nothing_can_be_made_are_said_before_the_run() {
    let folder = folder();
    refuse(folder.path(), &run("run", &["--golden", "/dev/full"]), &["/dev/full", "exists"]);
    refuse(folder.path(), &run("/proc/run", &[]), &["/proc/run: cannot be written"]);
}

/// In the folder of processes nobody may make files.
#[test]
#[cfg(target_os = "linux")]
fn a_folder_of_golden_files_that_cannot_be_written_to_is_said_before_anything_is_made() {
    let folder = folder();
    refuse(folder.path(), &run("run", &["--golden", "/proc/golden.toml"]), &["/proc/golden.toml: cannot be"]);
    assert!(!folder.path().join("run").exists());
    fs::create_dir(folder.path().join("golden")).unwrap();
    succeed(folder.path(), &run("run", &["--golden", "golden/run.toml", "--max-wall", "0"]));
    let names = fs::read_dir(folder.path().join("golden")).unwrap().map(|entry| entry.unwrap().file_name());
    assert_eq!(names.collect::<Vec<_>>(), ["run.toml"]);
}

#[test]
fn a_golden_file_is_kept_off_what_the_run_writes() {
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let names = ["final.csv", "checkpoint", "run.json", "config.toml", "trajectory.gsd", "lock", "mine.toml"];
    let paths = names.map(|name| format!("run/{name}"));
    let paths = paths.iter().map(String::as_str);
    for path in paths.chain(["./run/final.csv", "run", "run/"]) {
        let parts = ["the golden file cannot be here", "own files"];
        refuse(folder.path(), &run("run", &["--golden", path]), &parts);
        assert!(!folder.path().join("run").exists(), "{path}");
    }
    refuse(folder.path(), &run("nowhere/run", &["--golden", "nowhere"]), &["nowhere: ", "own files"]);
    refuse(folder.path(), &run("run", &["--golden", "nowhere/g"]), &["nowhere/g: ", "folder does not exist"]);
    let output = program(folder.path(), &run("run", &["--golden"]))
        .arg(std::ffi::OsStr::from_bytes(b"g\xff.toml"))
        .output()
        .unwrap();
    told(&output, Some(2), &["not UTF-8"]);
    assert!(!folder.path().join("run").exists() && !folder.path().join("nowhere").exists());
    // The directory may be there, empty, and be called otherwise.
    fs::create_dir(folder.path().join("run")).unwrap();
    std::os::unix::fs::symlink("run", folder.path().join("other")).unwrap();
    refuse(folder.path(), &run("run", &["--golden", "other/final.csv"]), &["own files"]);
    succeed(folder.path(), &run("run", &["--golden", "./run/golden.toml", "--max-wall", "0"]));
    succeed(folder.path(), &run("whole", &[]));
    assert_goes_on(folder.path());
}

#[test]
fn a_last_state_that_cannot_be_written_is_said_beside_the_refused_step() {
    use meniscus::configuration::Configuration;
    use meniscus::run::{GoldenRequest, Run};
    let folder = folder();
    let start = folder.path().join("two.csv");
    fs::write(&start, "x,y\n20,20\n20,20\n").unwrap();
    let start = format!("start.path={:?}", start.to_str().unwrap());
    let keys = ["system.particles=2", "start.kind=file", &start, "motion.max_displacement=1e-12"];
    let configuration = Configuration::read(&folder.path().join("small.toml"), &keys.map(str::to_owned));
    let simulation = meniscus::simulation::Simulation::new(configuration.unwrap()).unwrap();
    let directory = folder.path().join("run");
    let run = Run::create(simulation, &directory, GoldenRequest::in_directory(&directory)).unwrap();
    fs::create_dir(directory.join("final.state")).unwrap();
    let error = run.to_end(|_| None).unwrap_err().to_string();
    assert!(
        error.contains("is refused: the largest force") && error.contains("final.state: cannot"),
        "{error}"
    );
}

#[test]
fn numbers_of_threads_out_of_range_are_refused() {
    let folder = folder();
    stopped_and_whole(folder.path());
    for threads in ["0", "-1", "1025", "99999999999999999999", "many"] {
        refuse(folder.path(), &["resume", "run", &format!("--threads={threads}")], &["--threads"]);
    }
    refuse(folder.path(), &["resume", "run", "--threads", "2", "--engine", "core"], &["--threads 2", "core"]);
    assert_goes_on(folder.path());
}

#[test]
fn nobody_listening_is_no_reason_to_stop() {
    let folder = folder();
    succeed(folder.path(), &run("whole", &[]));
    let mut child = program(folder.path(), &run("run", &["--max-wall", "0"])).spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let mut child = program(folder.path(), &["resume", "run"]).spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_same_files(&folder.path().join("whole"), &folder.path().join("run"));
}
