//! Series: looking at a run changes nothing of it, and what is seen on the way is what is seen in its trajectory.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use meniscus::golden::Golden;
use meniscus::observables::series::Series;
use meniscus_tests::directories::{assert_same_files, files};
use meniscus_tests::program::{Program, SMALL, errors};
use std::collections::BTreeMap;

/// A patch that collapses, its rows at the frames of its trajectory.
fn patch(start: &str) -> String {
    let [head, tail] = ["particles = 60", "particles = 61"];
    let text = SMALL.replace(head, tail).replace("observables = 0.05", "observables = 0.1");
    let series = "minkowski = 0.1\nminkowski_spacing = 4\nminkowski_thresholds = [0.1, 0.3]\nmodes = 0.1\n\
                  modes_shells = 3\nradial_distribution = 0.1\nstructure_factor = 0.1\nradii = 0.1\nradii_width = 3\n";
    format!("{text}{series}[start]\n{start}\n")
}

const DISC: &str = "kind = \"disc\"\nradius = 20";
const RINGS: &str = "kind = \"rings\"\nrings = 4\nspacing = 4.5\nper_ring = 6";

fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("disc.toml", patch(DISC));
    program.write("rings.toml", patch(RINGS));
    program
}

/// Names and contents of the tables in a folder of the program.
fn tables(program: &Program, folder: &str) -> BTreeMap<String, String> {
    let files = files(&program.folder().join(folder)).into_iter();
    let tables = files.filter(|(name, _)| name.ends_with(".csv") && name != "final.csv");
    tables.map(|(name, bytes)| (name, String::from_utf8(bytes).unwrap())).collect()
}

fn run(program: &Program, arguments: &[&str]) {
    program.succeed(&[&["run", "--quiet"], arguments].concat());
}

fn analyze(program: &Program, arguments: &[&str]) -> String {
    program.succeed(&[&["analyze", "--quiet"], arguments].concat())
}

#[test]
fn every_series_has_the_columns_that_it_names() {
    let program = program();
    run(&program, &["disc.toml", "--out", "run"]);
    let tables = tables(&program, "run");
    assert_eq!(tables.len(), Series::ALL.len());
    for series in Series::ALL {
        let table = &tables[&series.file_name()];
        let mut lines = table.lines();
        assert_eq!(lines.next().unwrap(), series.header());
        let columns = series.header().split(',').count();
        let mut keys = BTreeMap::<&str, Vec<String>>::new();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), columns, "{line}");
            let key = cells[3..3 + series.key_columns().len()].join(",");
            keys.entry(cells[0]).or_default().push(key);
        }
        assert_eq!(keys.len(), 6, "at 0, 0.1, ... 0.5 T: {keys:?}");
        let first = keys.values().next().unwrap();
        assert!(
            keys.values().all(|keys| keys == first),
            "{}: the keys of all states are the same",
            series.name()
        );
        let unique: std::collections::BTreeSet<_> = first.iter().collect();
        assert_eq!(unique.len(), first.len(), "{first:?}");
    }
    assert_eq!(tables["minkowski.csv"].lines().count(), 1 + 6 * 2);
    assert_eq!(tables["modes.csv"].lines().count(), 1 + 6 * 3);
}

/// Rows are those of the same frames, to the last byte, from every format that has all of a state.
#[test]
fn rows_on_the_way_are_rows_of_the_trajectory() {
    let program = program();
    for (configuration, format) in [("disc.toml", "gsd"), ("rings.toml", "npz"), ("rings.toml", "xyz")] {
        let out = format!("{configuration}-{format}");
        let format = format!("output.trajectory_format={format}");
        run(&program, &[configuration, "--out", &out, "--set", &format]);
        let analysis = format!("{out}-analysis");
        analyze(&program, &[&out, "--out", &analysis]);
        let (mut expected, found) = (tables(&program, &out), tables(&program, &analysis));
        if format.ends_with("xyz") {
            // It has no largest force.
            let table = expected.get_mut("observables.csv").unwrap();
            *table = without_column(table, 4);
        }
        assert_eq!(expected.len(), Series::ALL.len());
        for (name, table) in expected {
            assert_eq!(table, found[&name], "{name} of {out}");
        }
    }
}

/// The table with all cells of a column empty but for its name.
fn without_column(table: &str, column: usize) -> String {
    let mut lines = table.lines();
    let mut text = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let mut cells: Vec<&str> = line.split(',').collect();
        cells[column] = "";
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

#[test]
fn nothing_of_a_run_depends_on_its_series() {
    let program = program();
    let none = ["observables", "minkowski", "modes", "radial_distribution", "structure_factor", "radii"]
        .map(|name| format!("output.{name}=0"));
    let none: Vec<&str> = none.iter().flat_map(|text| ["--set", text]).collect();
    run(&program, &[&["disc.toml", "--out", "without", "--every", "1"], &none[..]].concat());
    let often =
        ["--set", "output.modes=0.003", "--set", "output.minkowski=1e-9", "--set", "output.radii=0.02"];
    run(&program, &[&["disc.toml", "--out", "with", "--every", "1"], &often[..]].concat());
    let [without, with] = ["without", "with"].map(|out| files(&program.folder().join(out)));
    for name in ["trajectory.gsd", "final.state", "final.csv"] {
        assert!(without[name] == with[name], "{name}");
    }
    let [expected, found] = ["without", "with"]
        .map(|out| Golden::read(&program.folder().join(out).join("golden.toml")).unwrap().records);
    assert!(expected.len() > 20 && expected.len() == found.len());
    assert!(expected.iter().zip(&found).all(|(expected, found)| expected.difference(found).is_none()));
    assert_eq!(without["observables.csv"].iter().filter(|byte| **byte == b'\n').count(), 1);
    assert!(!without.contains_key("modes.csv") && !without.contains_key("start.state"));
    let told = program.succeed(&["verify", "with/golden.toml"]);
    assert!(told.starts_with("equal: "), "{told}");
}

#[test]
fn the_rows_of_a_state_are_the_same_at_any_interval() {
    let program = program();
    run(&program, &["disc.toml", "--out", "coarse"]);
    let fine = Series::ALL.map(|series| format!("output.{}=0.05", series.name()));
    let fine: Vec<&str> = fine.iter().flat_map(|text| ["--set", text]).collect();
    run(&program, &[&["disc.toml", "--out", "fine"], &fine[..]].concat());
    let (coarse, fine) = (tables(&program, "coarse"), tables(&program, "fine"));
    for (name, table) in coarse {
        let all: Vec<&str> = fine[&name].lines().collect();
        assert!(all.len() > table.lines().count(), "{name}");
        for line in table.lines() {
            assert!(all.contains(&line), "{name}: {line}");
        }
    }
}

#[test]
fn the_order_of_series_does_not_matter() {
    let program = program();
    run(&program, &["disc.toml", "--out", "run"]);
    for (names, out) in [("radii,modes,observables", "one"), ("observables,radii,modes,radii", "other")] {
        let told = analyze(&program, &["run/trajectory.gsd", "--series", names, "--out", out]);
        assert_eq!(told.lines().count(), 3, "{told}");
    }
    assert_eq!(tables(&program, "one"), tables(&program, "other"));
    assert_eq!(tables(&program, "one").len(), 3);
    let settings = ["--spacing", "6", "--thresholds", "0.2,0.25,0.5", "--shells", "5", "--width", "10"];
    analyze(&program, &[&["run", "--out", "settings"], &settings[..]].concat());
    let tables = tables(&program, "settings");
    assert_eq!(tables["minkowski.csv"].lines().count(), 1 + 6 * 3);
    assert_eq!(tables["modes.csv"].lines().count(), 1 + 6 * 5);
    assert_eq!(tables["radii.csv"].lines().count(), 1 + 6 * 2);
}

/// A run with series that was stopped goes on only with the files that it had.
#[test]
fn a_run_misses_its_tables_and_what_they_compare_with() {
    let program = program();
    let path = |name: &str| program.folder().join("run").join(name);
    run(&program, &["disc.toml", "--out", "run", "--until", "0.3"]);
    let resume = ["resume", "run", "--until", "0.4"];
    for name in ["start.state", "radii.csv", "modes.csv"] {
        let whole = std::fs::read(path(name)).unwrap();
        std::fs::remove_file(path(name)).unwrap();
        program.refuse(&resume, &[name, "is gone", "put it back"]);
        std::fs::write(path(name), &whole[..whole.len() - 1]).unwrap();
        program.refuse(&resume, &[name]);
        std::fs::write(path(name), whole).unwrap();
    }
    let start = std::fs::read(path("start.state")).unwrap();
    std::fs::write(path("start.state"), std::fs::read(path("final.state")).unwrap()).unwrap();
    program.refuse(&resume, &["start.state", "not the state that the run began with"]);
    std::fs::write(path("start.state"), start).unwrap();
    program.succeed(&resume);
    run(&program, &["disc.toml", "--out", "whole", "--until", "0.4"]);
    assert_same_files(&program.folder().join("whole"), &program.folder().join("run"));
}

/// Ctrl-C leaves neither tables nor the folder made for them.
#[cfg(unix)]
#[test]
fn an_analysis_that_is_interrupted_leaves_nothing() {
    let program = program();
    run(&program, &["disc.toml", "--out", "run", "--set", "output.trajectory=0.002"]);
    let mut command = program.command(&["analyze", "run"]);
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
    let folder = program.folder().join("run/trajectory-analysis");
    while !folder.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it has ended too early");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let told = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(told.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("interrupted: nothing was written"), "{}", errors(&output));
    assert!(!folder.exists());
}

#[test]
fn a_file_without_its_run_says_what_it_needs() {
    let program = program();
    run(&program, &["disc.toml", "--out", "run"]);
    for name in ["trajectory.gsd", "final.csv", "final.state"] {
        let bytes = std::fs::read(program.folder().join("run").join(name)).unwrap();
        std::fs::write(program.folder().join(format!("alone-{name}")), bytes).unwrap();
    }
    let whole = program.command(&["analyze", "alone-trajectory.gsd", "--out", "alone"]).output().unwrap();
    assert!(whole.status.success());
    let notes = String::from_utf8(whole.stderr).unwrap();
    assert!(notes.contains("energies stay empty") && notes.contains("--configuration"), "{notes}");
    let mut alone = tables(&program, "alone");
    assert_eq!(alone.len(), Series::ALL.len() - 1, "all but radii");
    assert!(alone.remove("observables.csv").unwrap().lines().skip(1).all(|line| line.ends_with(",,")));
    let expected = tables(&program, "run");
    assert_eq!(alone["structure_factor.csv"], expected["structure_factor.csv"]);

    program
        .refuse(&["analyze", "alone-trajectory.gsd", "--series", "radii"], &["--width", "--configuration"]);
    program.refuse(&["analyze", "."], &[".: there is no config.toml in this directory"]);
    program.refuse(&["analyze", "alone-final.csv"], &["alone-final.csv", "--box"]);
    program.refuse(&["analyze", "alone-final.state"], &["alone-final.state", "--box"]);
    program.refuse(&["analyze", "alone-trajectory.gsd", "--box", "47"], &["48", "47"]);
    let other = ["analyze", "alone-trajectory.gsd", "--configuration", "fig-12"];
    program.refuse(&[&other[..], &["--box", "48"]].concat(), &["box is 48", "800", "--configuration"]);
    program.refuse(&["analyze", "run/trajectory.gsd", "--spacing", "-1"], &["minkowski", "-1"]);
    for thresholds in ["1,0.5", "0.5,0.5"] {
        let arguments = ["analyze", "run/trajectory.gsd", "--thresholds", thresholds];
        program.refuse(&arguments, &["--thresholds: found 0.5 after ", ", expected increasing numbers"]);
    }
    program.refuse(
        &["analyze", "run", "--out", "run"],
        &["run/observables.csv: this file exists: name another directory by --out, or remove it"],
    );
    assert!(!program.folder().join("run/trajectory-analysis").exists(), "a refusal leaves nothing");

    run(&program, &["disc.toml", "--out", "unfilmed", "--set", "output.trajectory=0"]);
    program.refuse(&["analyze", "unfilmed"], &["unfilmed/trajectory", "found no frame, expected at least 1"]);

    analyze(&program, &["alone-final.csv", "--box", "48", "--series", "minkowski", "--out", "one"]);
    let last =
        |table: &str| table.lines().last().unwrap().split(',').skip(3).map(str::to_owned).collect::<Vec<_>>();
    let thresholds = ["--spacing", "4", "--thresholds", "0.1,0.3"];
    analyze(&program, &[&["alone-final.state", "--box", "48", "--out", "state"], &thresholds[..]].concat());
    let after = ["--out", "after", "--set", "output.minkowski=0.5", "--set", "time.until=0.5"];
    run(&program, &[&["disc.toml"], &after[..]].concat());
    assert_eq!(
        last(&tables(&program, "state")["minkowski.csv"]),
        last(&tables(&program, "after")["minkowski.csv"])
    );
}
