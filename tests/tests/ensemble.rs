//! Ensembles: threads, shares, order, stops and kills leave no trace in what is gathered.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use meniscus::engine::Machinery;
use meniscus::ensemble::{
    Fate, Member, MemberError, Nobody, Observer, Report, Request, Selection, Standing, Sweep, gather,
    gather_sweep, run,
};
use meniscus::files::table::Table;
use meniscus::observables::series::Series;
use meniscus::run::{GoldenRequest, Resumed, Run, Stop};
use meniscus::simulation::Simulation;
use meniscus_tests::directories::{assert_same_files, fast_folder};
use meniscus_tests::program::Program;
use meniscus_tests::tolerances::ENSEMBLE_STATISTICS;
use std::collections::BTreeMap;
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// 20 discs on the smallest mesh, and nothing that takes long to write.
const BASE: &str = "version = 1\n\
    [system]\nparticles = 20\nbox = 40\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 16\n\
    [motion]\nmax_step = 0.0002\n[time]\nuntil = 0.02\n\
    [output]\nobservables = 0.002\nmodes = 0.005\nminkowski = 0.01\ntrajectory = 0\nsnapshots = 0\n";

/// Two values, three seeds.
const SWEEP: &str = "version = 1\nconfiguration = \"base.toml\"\nset = [\"mesh.assignment=cic\"]\nseeds = [3, 1, 2]\n\
    [sweep]\n\"system.capillary_length\" = [10, 20.5]\n";

/// A folder with the sweep.
fn folder() -> tempfile::TempDir {
    let folder = fast_folder();
    fs::write(folder.path().join("base.toml"), BASE).unwrap();
    fs::write(folder.path().join("sweep.toml"), SWEEP).unwrap();
    folder
}

fn sweep(folder: &Path) -> Sweep {
    Sweep::read(&folder.join("sweep.toml")).unwrap()
}

/// Runs what is left of the sweep, nobody stopping it.
fn run_all(sweep: &Sweep, directory: &Path, selection: Selection, workers: usize) -> Report {
    let stop = AtomicBool::new(false);
    run(sweep, directory, &Request { selection, workers, deadline: None, stop: &stop }, &Nobody).unwrap()
}

/// The ensemble as it is to be.
fn whole(folder: &Path) -> PathBuf {
    let directory = folder.join("whole");
    assert!(run_all(&sweep(folder), &directory, Selection::All, 1).is_complete());
    assert_eq!(gather(&directory).unwrap().finished, 6);
    directory
}

/// Fails unless tables and runs are the same to the last byte.
#[track_caller]
fn assert_same_ensembles(expected: &Path, found: &Path) {
    let top = |directory: &Path| -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap());
        let files = entries.filter(|entry| entry.file_type().unwrap().is_file());
        files.map(|file| (file.file_name().into_string().unwrap(), fs::read(file.path()).unwrap())).collect()
    };
    let names = [
        "configuration.toml",
        "lock",
        "members.csv",
        "minkowski.csv",
        "modes.csv",
        "observables.csv",
        "sweep.toml",
    ];
    assert_eq!(top(expected).keys().collect::<Vec<_>>(), names);
    assert_eq!(top(expected), top(found));
    let runs = |directory: &Path| {
        let entries = fs::read_dir(directory.join("runs")).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(runs(expected), runs(found));
    for name in runs(expected) {
        assert_same_files(&expected.join("runs").join(&name), &found.join("runs").join(&name));
    }
}

#[test]
fn workers_shares_and_order_leave_no_trace() {
    let folder = folder();
    let folder = folder.path();
    let (expected, sweep) = (whole(folder), sweep(folder));
    for workers in [2, 3, 7] {
        let directory = folder.join(format!("workers-{workers}"));
        assert!(run_all(&sweep, &directory, Selection::All, workers).is_complete());
        gather(&directory).unwrap();
        assert_same_ensembles(&expected, &directory);
    }
    for of in [2, 4] {
        let directory = folder.join(format!("shares-{of}"));
        let shares =
            (1..=of).rev().map(|number| run_all(&sweep, &directory, Selection::Shard { number, of }, 2));
        assert_eq!(shares.map(|report| report.fates.len()).sum::<usize>(), 6);
        gather(&directory).unwrap();
        assert_same_ensembles(&expected, &directory);
    }
    let directory = folder.join("one-by-one");
    for index in [4, 1, 6, 2, 5, 3] {
        let report = run_all(&sweep, &directory, Selection::Index(index), 2);
        assert!(matches!(report.fates[..], [(found, Fate::Finished)] if found == index));
        gather(&directory).unwrap();
    }
    assert_same_ensembles(&expected, &directory);
    let report = run_all(&sweep, &directory, Selection::All, 2);
    assert!(report.fates.iter().all(|(_, fate)| matches!(fate, Fate::Kept)));
}

/// Stops everything at a step of whoever makes it.
struct StopsAfter<'a> {
    steps: AtomicU64,
    stop: &'a AtomicBool,
}

impl Observer for StopsAfter<'_> {
    fn stepped(&self, _: &Member, _: &Simulation) {
        if self.steps.fetch_sub(1, Ordering::Relaxed) <= 1 {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

/// A number that nobody chose, below `end`.
fn random(end: u64) -> u64 {
    RandomState::new().hash_one(0_u8) % end
}

#[test]
fn stops_leave_no_trace() {
    let folder = folder();
    let folder = folder.path();
    let (expected, sweep, directory) = (whole(folder), sweep(folder), folder.join("stopped"));
    let mut stops = 0;
    loop {
        let stop = AtomicBool::new(false);
        let observer = StopsAfter { steps: AtomicU64::new(1 + random(200)), stop: &stop };
        let request = Request { selection: Selection::All, workers: 2, deadline: None, stop: &stop };
        let report = run(&sweep, &directory, &request, &observer).unwrap();
        gather(&directory).unwrap();
        assert_eq!(report.failures().count(), 0);
        if report.is_complete() {
            break;
        }
        stops += 1;
    }
    assert!(stops > 2, "{stops} stops");
    assert_same_ensembles(&expected, &directory);
}

#[test]
fn kills_leave_no_trace() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("base.toml", BASE);
    program.write("sweep.toml", SWEEP);
    let expected = whole(program.folder());
    let arguments = ["ensemble", "sweep.toml", "--out", "killed", "--workers", "2", "--quiet"];
    // The first is killed as soon as a member has something to go on from.
    let has_begun = || {
        let runs = fs::read_dir(program.folder().join("killed/runs")).into_iter().flatten();
        runs.flatten().any(|run| run.path().join("checkpoint").exists())
    };
    let mut kills = 0;
    loop {
        let mut child = program.command(&arguments).stdout(std::process::Stdio::null()).spawn().unwrap();
        while kills == 0 && !has_begun() && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if kills > 0 {
            std::thread::sleep(Duration::from_millis(20 + random(150)));
        }
        if child.try_wait().unwrap().is_none() {
            child.kill().unwrap();
        }
        match child.wait().unwrap().code() {
            Some(code) => {
                assert_eq!(code, 0);
                break;
            }
            None => kills += 1,
        }
        if kills == 6 {
            program.succeed(&arguments);
            break;
        }
    }
    assert!(kills > 0, "nobody was killed");
    assert_same_ensembles(&expected, &program.folder().join("killed"));
}

/// What a killed process leaves before its first checkpoint is known to be of no use.
#[test]
fn a_run_killed_at_its_very_beginning_begins_anew() {
    let folder = folder();
    let folder = folder.path();
    let (expected, sweep, directory) = (whole(folder), sweep(folder), folder.join("begun"));
    let run = sweep.members()[2].directory(&directory);
    fs::create_dir_all(&run).unwrap();
    fs::write(run.join("lock"), "").unwrap();
    for name in ["config.toml", "observables.csv", "checkpoint.partial", ".meniscus-x"] {
        fs::write(run.join(name), "half").unwrap();
    }
    assert!(run_all(&sweep, &directory, Selection::All, 2).is_complete());
    gather(&directory).unwrap();
    assert_same_ensembles(&expected, &directory);
}

/// Mean and standard error by differences of pairs.
fn mean_and_error(values: &[f64]) -> [Option<f64>; 2] {
    let squares = |pairs: &[f64]| pairs.iter().map(|difference| difference * difference).sum::<f64>();
    match *values {
        [] => [None, None],
        [one] => [Some(one), None],
        [one, two] => [Some(0.5 * (one + two)), Some(0.5 * (one - two).abs())],
        [one, two, three] => {
            let error = (squares(&[one - two, two - three, three - one]) / 18.0).sqrt();
            [Some((three + one + two) / 3.0), Some(error)]
        }
        _ => unreachable!("three seeds"),
    }
}

#[test]
fn means_and_errors_are_those_of_the_runs() {
    let folder = folder();
    let directory = whole(folder.path());
    let sweep = sweep(folder.path());
    let mut with_gaps = 0;
    for (series, bins) in [(Series::Observables, 11), (Series::Modes, 5), (Series::Minkowski, 3)] {
        let gathered = Table::read(&directory.join(series.file_name())).unwrap();
        let keys = series.key_columns().iter().copied();
        let mut expected = vec!["system.capillary_length", "bin", "time", "time_over_jeans"];
        expected.extend(keys.chain(["runs"]));
        assert_eq!(gathered.columns().take(expected.len()).collect::<Vec<_>>(), expected);
        let mut first_row = 0;
        for combination in sweep.combinations() {
            let read = |member: &Member| {
                Table::read(&member.directory(&directory).join(series.file_name())).unwrap()
            };
            let tables: Vec<Table> = combination.iter().map(read).collect();
            // The step is short against the interval: every run has all rows in every bin, in the same order.
            let rows = tables[0].len();
            assert!(rows.is_multiple_of(bins) && tables.iter().all(|table| table.len() == rows));
            for row in 0..rows {
                let found = |name: &str| {
                    let column = gathered.column(name).unwrap();
                    gathered.number(first_row + row, column).unwrap()
                };
                let text = |table: &Table, row, name| table.cell(row, table.column(name).unwrap()).to_owned();
                let length = combination[0].value("system.capillary_length").unwrap();
                assert_eq!(text(&gathered, first_row + row, "system.capillary_length"), length);
                let bin = row / (rows / bins);
                assert_eq!((found("bin"), found("runs")), (Some(bin as f64), Some(3.0)));
                for name in series.key_columns() {
                    assert_eq!(text(&gathered, first_row + row, name), text(&tables[0], row, name));
                }
                for &name in ["time", "time_over_jeans"].iter().chain(series.value_columns()) {
                    let value = |table: &Table| table.number(row, table.column(name).unwrap()).unwrap();
                    let values: Vec<f64> = tables.iter().filter_map(value).collect();
                    with_gaps += usize::from(values.len() < 3);
                    let [mean, error] = mean_and_error(&values);
                    let scale = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                    let near = |found: Option<f64>, expected: Option<f64>| match (found, expected) {
                        (Some(found), Some(expected)) => {
                            (found - expected).abs() <= ENSEMBLE_STATISTICS * scale
                        }
                        (found, expected) => found == expected,
                    };
                    assert!(near(found(name), mean), "{name} in {row}: {:?}, not {mean:?}", found(name));
                    if !name.starts_with("time") {
                        let found = found(&format!("{name}_error"));
                        assert!(near(found, error), "{name}_error in {row}: {found:?}, not {error:?}");
                    }
                }
            }
            first_row += rows;
        }
        assert_eq!(first_row, gathered.len());
    }
    eprintln!("{with_gaps} values that some run has not");
}

#[test]
fn what_is_missing_is_told() {
    let folder = folder();
    let folder = folder.path();
    let (sweep, directory) = (sweep(folder), folder.join("part"));
    for index in [1, 3, 5] {
        run_all(&sweep, &directory, Selection::Index(index), 1);
    }
    let gathered = gather(&directory).unwrap();
    assert_eq!((gathered.members, gathered.finished), (6, 3));
    let table = Table::read(&directory.join("observables.csv")).unwrap();
    assert_eq!(table.distinct("runs").unwrap(), ["2", "1"]);
    let single = table.with("runs", "1").unwrap();
    assert!(single.numbers("max_force").unwrap().iter().all(Option::is_some));
    assert!(single.numbers("max_force_error").unwrap().iter().all(Option::is_none));
    let members = Table::read(&directory.join("members.csv")).unwrap();
    let status = ["finished", "missing", "finished", "missing", "finished", "missing"];
    assert_eq!(members.text("status").unwrap(), status);
    assert_eq!(members.text("seed").unwrap(), ["3", "1", "2", "3", "1", "2"]);
    assert_eq!(members.text("system.capillary_length").unwrap(), ["10", "10", "10", "20.5", "20.5", "20.5"]);
}

#[test]
fn a_member_at_work_in_another_program_is_passed_over() {
    let folder = folder();
    let folder = folder.path();
    let (expected, sweep, directory) = (whole(folder), sweep(folder), folder.join("shared"));
    let member = &sweep.members()[1];
    let path = member.directory(&directory);
    let simulation = Simulation::new(member.configuration.clone()).unwrap();
    let other = Run::create(simulation, &path, GoldenRequest::in_directory(&path)).unwrap();
    let report = run_all(&sweep, &directory, Selection::All, 2);
    let elsewhere = |(index, fate): &(usize, Fate)| matches!(fate, Fate::Elsewhere).then_some(*index);
    assert_eq!(report.fates.iter().filter_map(elsewhere).collect::<Vec<_>>(), [2]);
    assert_eq!(report.count(|fate| matches!(fate, Fate::Finished)), 5);
    assert_eq!(Standing::of(member, &directory).unwrap(), Standing::Unfinished);
    other.to_end(|_| None).unwrap();
    gather(&directory).unwrap();
    assert_same_ensembles(&expected, &directory);
}

#[test]
fn a_member_that_fails_does_not_keep_others_from_running() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("base.toml", BASE.replace("particles = 20", "particles = 2"));
    program.write("there.csv", "x,y\n10,10\n20,20\n");
    program.write(
        "sweep.toml",
        "version = 1\nconfiguration = \"base.toml\"\nset = [\"start.kind=file\"]\nseeds = 2\n\
         [sweep]\n\"start.path\" = [\"there.csv\", \"gone.csv\"]\n",
    );
    let arguments = ["ensemble", "sweep.toml", "--out", "out", "--workers", "2"];
    program.refuse(&arguments, &["2 of 4 members failed; the first is member 3: gone.csv: "]);
    let status = Table::read(&program.folder().join("out/members.csv")).unwrap();
    assert_eq!(status.text("status").unwrap(), ["finished", "finished", "missing", "missing"]);
    // When that is mended, the same command goes on.
    program.write("gone.csv", "x,y,strength\n10,10,2\n20,25,1\n");
    assert!(program.succeed(&arguments).starts_with("4 of 4 members finished\n"));
    let again = program.succeed(&[&arguments[..], &["--json"]].concat());
    let again: serde_json::Value = serde_json::from_str(&again).unwrap();
    assert_eq!((again["kept"].as_u64(), again["finished"].as_u64()), (Some(4), Some(4)));
}

#[test]
fn damaged_members_are_told_and_not_gathered() {
    let folder = folder();
    let directory = whole(folder.path());
    let sweep = sweep(folder.path());
    let run_of = |number: usize| sweep.members()[number].directory(&directory);
    let gathered = |part: &str| {
        let error = gather(&directory).unwrap_err().to_string();
        assert!(error.contains(part), "{part} is not in {error}");
    };

    let table = run_of(0).join("observables.csv");
    let text = fs::read_to_string(&table).unwrap();
    let (cut, last) = text.trim_end().rsplit_once('\n').unwrap();
    fs::write(&table, format!("{cut}\n")).unwrap();
    gathered("observables.csv: found a last row of bin 9, expected one of bin 10: ");
    fs::write(&table, text.replace(",clusters,", ",clumps,")).unwrap();
    gathered("observables.csv: found columns step,time,time_over_jeans,dt,max_force,clumps,");
    fs::write(&table, text.replace("step,time,", "time,step,")).unwrap();
    gathered("observables.csv: found columns time,step,");
    fs::write(&table, format!("{text}{last}\n")).unwrap();
    gathered("observables.csv: line 13: found a second row of bin 10, expected one");
    fs::write(&table, format!("{text}torn")).unwrap();
    gathered("observables.csv: line 13: found 1 cells, expected 11");
    fs::remove_file(&table).unwrap();
    gathered("observables.csv: cannot be read: No such file or directory");
    let remedy = "this table of a finished run is gone, cut or changed; remove";
    gathered(&format!("{remedy} {} and run the ensemble again, it repeats that run", run_of(0).display()));
    fs::remove_dir_all(run_of(0)).unwrap();
    assert_eq!(
        run_all(&sweep, &directory, Selection::All, 2).count(|fate| matches!(fate, Fate::Finished)),
        1
    );
    assert_eq!(fs::read_to_string(&table).unwrap(), text);
    assert_eq!(gather(&directory).unwrap().finished, 6);

    let members = fs::read(directory.join("members.csv")).unwrap();
    let stopped = gather_sweep(&sweep, &directory, &AtomicBool::new(true)).unwrap_err().to_string();
    assert!(stopped.starts_with("interrupted: the gathered tables in "), "{stopped}");
    assert_eq!(fs::read(directory.join("members.csv")).unwrap(), members);

    fs::write(run_of(1).join("final.state"), "nothing").unwrap();
    let configuration = fs::read_to_string(run_of(2).join("config.toml")).unwrap();
    fs::write(run_of(2).join("config.toml"), configuration.replace("seed = 2", "seed = 20")).unwrap();
    let report = run_all(&sweep, &directory, Selection::All, 2);
    let failures: Vec<_> = report.failures().collect();
    assert!(matches!(
        failures[..],
        [(2, MemberError::Damaged { .. }), (3, MemberError::Foreign { key: "seed", .. })]
    ));
    let gathered = gather(&directory).unwrap();
    assert_eq!((gathered.finished, gathered.damaged.len()), (4, 2));
    let members = Table::read(&directory.join("members.csv")).unwrap();
    assert_eq!(members.text("status").unwrap()[..3], ["finished", "damaged", "damaged"]);
}

#[test]
fn a_wider_sweep_keeps_what_was_run() {
    let folder = folder();
    let folder = folder.path();
    let directory = whole(folder);
    let wider = SWEEP.replace("[3, 1, 2]", "4");
    let wider = Sweep::from_text("wider", &wider, folder).unwrap();
    let report = run_all(&wider, &directory, Selection::All, 2);
    assert_eq!(report.count(|fate| matches!(fate, Fate::Kept)), 6);
    assert_eq!(report.count(|fate| matches!(fate, Fate::Finished)), 2);
    gather(&directory).unwrap();
    let table = Table::read(&directory.join("observables.csv")).unwrap();
    assert_eq!(table.distinct("runs").unwrap(), ["4"]);
}

#[test]
fn the_wall_time_and_the_command_line_are_kept_to() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("base.toml", BASE);
    program.write("sweep.toml", SWEEP);
    let output = program.start(&["ensemble", "sweep.toml", "--max-wall", "0"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.ends_with("to go on: meniscus ensemble sweep.toml --out ensembles/sweep\n"), "{said}");
    for arguments in [&["--shard", "2/2"][..], &["--index", "1"], &["--index", "3"], &["--index", "5"]] {
        program.succeed(&[&["ensemble", "sweep.toml"], arguments].concat());
    }
    let expected = whole(program.folder());
    assert_same_ensembles(&expected, &program.folder().join("ensembles/sweep"));
    let text = program.succeed(&["ensemble", "gather", "ensembles/sweep"]);
    assert!(text.starts_with("6 of 6 members finished\nensembles/sweep/members.csv\n"), "{text}");

    program.refuse(&["ensemble", "sweep.toml", "--index", "7"], &["--index 7: the sweep has members 1 to 6"]);
    program.refuse(&["ensemble", "sweep.toml", "--index", "0"], &["--index 0: "]);
    program.refuse(&["ensemble", "gone.toml"], &["gone.toml: cannot be read: "]);
    program.refuse(&["ensemble", "gather", "gone"], &["gone: found no sweep.toml"]);
    for shard in ["0/2", "3/2", "2", "1/0", "a/b"] {
        let output = program.start(&["ensemble", "sweep.toml", "--shard", shard]);
        assert_eq!(output.status.code(), Some(2), "{shard}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("expected K/N"), "{shard}");
    }
}

#[test]
fn a_run_of_an_ensemble_is_a_run_like_any_other() {
    let folder = folder();
    let (directory, sweep) = (whole(folder.path()), sweep(folder.path()));
    let member = &sweep.members()[4];
    let alone = folder.path().join("alone");
    let simulation = Simulation::new(member.configuration.clone()).unwrap();
    let alone_run = Run::create(simulation, &alone, GoldenRequest::in_directory(&alone)).unwrap();
    let stopped =
        alone_run.to_end(|simulation| (simulation.engine.clock().step == 5).then_some(Stop::Interrupted));
    assert_eq!(stopped.unwrap().stop, Some(Stop::Interrupted));
    let Resumed::Ready { run, .. } = Run::resume(&alone, Machinery::default(), None).unwrap() else {
        panic!()
    };
    run.to_end(|_| None).unwrap();
    assert_same_files(&alone, &member.directory(&directory));
}
