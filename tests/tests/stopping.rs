//! Ctrl-C once and twice: what is told, what the exit code is, and that nothing is left half written.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_tests::directories::assert_same_files;
use meniscus_tests::program::{Program, errors};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Longer than anything here takes, and far shorter than what is stopped.
const PATIENCE: Duration = Duration::from_secs(120);

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

fn interrupt(child: &Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

/// Waits until something is so.
#[track_caller]
fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < PATIENCE, "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// A program under way whose lines on standard error are read as they come.
struct Listened {
    child: Child,
    lines: BufReader<std::process::ChildStderr>,
}

impl Listened {
    fn start(program: &Program, arguments: &[&str]) -> Self {
        let mut command = program.command(arguments);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap());
        Self { child, lines }
    }

    /// Reads until a line holds `part`, which it gives.
    fn line_with(&mut self, part: &str) -> String {
        let mut said = String::new();
        loop {
            let start = said.len();
            let read = self.lines.read_line(&mut said).unwrap();
            assert!(read > 0, "{part} is not in {said}");
            if said[start..].contains(part) {
                return said[start..].to_owned();
            }
        }
    }

    /// What else it says until it ends.
    fn end(mut self) -> (ExitStatus, String) {
        let mut said = String::new();
        self.lines.read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap(), said)
    }
}

/// All files below a directory that a program was still writing.
fn unfinished(directory: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).unwrap().map(|entry| entry.unwrap()) {
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            found.extend(unfinished(&entry.path()));
        } else if name.starts_with(".meniscus-") || name.ends_with(".partial") {
            found.push(name);
        }
    }
    found
}

#[test]
fn a_run_that_is_stopped_twice_has_its_checkpoint() {
    let program = program();
    let more = ["--set", "output.checkpoint_minutes=0", "--set", "output.observables=0.01"];
    let long = ["run", "small.toml", "--out", "run", "--until", "2000"];
    let mut command = program.command(&[&long[..], &more].concat());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let rows = program.folder().join("run/observables.csv");
    wait_until("the run does not begin", || {
        fs::read_to_string(&rows).is_ok_and(|text| text.lines().count() > 2)
    });
    interrupt(&child);
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(errors(&output).ends_with("interrupted; to go on: meniscus resume run\n"), "{}", errors(&output));
    let stopped: serde_json::Value = serde_json::from_slice(&program.read("run/run.json")).unwrap();
    let until = (stopped["time_over_jeans"].as_f64().unwrap() + 0.02).to_string();
    program.succeed(&["resume", "run", "--until", &until]);
    program.succeed(&[&["run", "small.toml", "--out", "whole", "--until", &until], &more[..]].concat());
    assert_same_files(&program.folder().join("whole"), &program.folder().join("run"));
}

#[test]
fn an_ensemble_that_is_stopped_gathers_and_says_how_to_go_on() {
    let program = program();
    let sweep = "version = 1\nconfiguration = \"small.toml\"\nset = [\"time.until=2000\"]\nseeds = 2\n";
    program.write("sweep.toml", sweep);
    let listened = Listened::start(&program, &["ensemble", "sweep.toml", "--workers", "2"]);
    let runs = program.folder().join("ensembles/sweep/runs");
    wait_until("the members do not begin", || {
        let entries = fs::read_dir(&runs).map(Iterator::count);
        entries.is_ok_and(|count| count == 2)
    });
    interrupt(&listened.child);
    let (status, said) = listened.end();
    assert_eq!(status.code(), Some(0), "{said}");
    let told = "stopped: gathering the tables of what has finished; Ctrl-C again leaves them as they are\n\
                members left: 2; to go on: meniscus ensemble sweep.toml --out ensembles/sweep\n";
    assert!(said.ends_with(told), "{said}");
    let members = program.text("ensembles/sweep/members.csv");
    assert_eq!(members.matches(",unfinished,").count(), 2, "{members}");
    assert_eq!(unfinished(program.folder()), [""; 0]);
}

/// The errors of forces take a minute to compute, and nothing else of the report is begun without them.
#[test]
fn a_report_is_left_out_at_the_second_ctrl_c() {
    let program = program();
    fs::create_dir_all(program.folder().join("paper/figures")).unwrap();
    for name in ["report.md", "report.html", "figures/fig-14.svg"] {
        program.write(&format!("paper/{name}"), "of before");
    }
    let reproduce = ["reproduce", "fig-14", "forces", "--quick", "--out", "paper", "--workers", "1"];
    let mut listened = Listened::start(&program, &reproduce);
    let runs = program.folder().join("paper/disc/runs");
    wait_until("no run begins", || {
        let entries = fs::read_dir(&runs).into_iter().flatten().flatten();
        entries.into_iter().any(|entry| entry.path().join("checkpoint").exists())
    });
    interrupt(&listened.child);
    let line = listened.line_with("stopped: ");
    let expected =
        "stopped: 0 of 4 runs finished; drawing the report of what there is; Ctrl-C again leaves it out\n";
    assert_eq!(line, expected);
    let begun = Instant::now();
    interrupt(&listened.child);
    let (status, said) = listened.end();
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
    assert_eq!(status.code(), Some(2), "{said}");
    let expected = "error: interrupted: the report and the figures in paper are as they were; the same command goes on, \
                    with --out paper\n";
    assert_eq!(said, expected);
    for name in ["report.md", "report.html", "figures/fig-14.svg"] {
        assert_eq!(program.text(&format!("paper/{name}")), "of before", "{name}");
    }
    assert!(!program.folder().join("paper/figures/forces.svg").exists());
    assert_eq!(unfinished(program.folder()), [""; 0]);
}

/// Where nothing is run, the first Ctrl-C is that of the report.
#[test]
fn a_report_alone_is_left_out_at_the_first() {
    let program = program();
    let mut listened = Listened::start(&program, &["reproduce", "forces", "--draw-only", "--out", "paper"]);
    let line = listened.line_with("drawing the report");
    assert_eq!(line, "0 of 0 runs finished; drawing the report; Ctrl-C leaves it out\n");
    interrupt(&listened.child);
    let (status, said) = listened.end();
    assert_eq!(status.code(), Some(2), "{said}");
    assert!(
        said.starts_with("error: interrupted: the report and the figures in paper are as they were"),
        "{said}"
    );
    assert!(!program.folder().join("paper/report.md").exists());
}

#[test]
fn a_conversion_that_is_stopped_leaves_nothing() {
    let program = program();
    let frame: String =
        (0..10_000).map(|disc| format!("D {} {} 0\n", 4 * (disc % 100), 4 * (disc / 100))).collect();
    let comment = "Lattice=\"400 0 0 0 400 0 0 0 1\" Properties=species:S:1:pos:R:3";
    program.write("a.xyz", format!("10000\n{comment}\n{frame}").repeat(40));
    let mut command = program.command(&["convert", "a.xyz", "b.gsd"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let made = program.folder().join("b.gsd");
    wait_until("nothing is converted", || made.exists());
    assert!(child.try_wait().unwrap().is_none(), "it has ended too early");
    interrupt(&child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", errors(&output));
    assert_eq!(errors(&output), "error: interrupted: nothing was written to b.gsd\n");
    assert!(!made.exists());
}
