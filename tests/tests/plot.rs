//! `meniscus plot` as its users start it: on runs, on ensembles, and on what is neither.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_tests::program::Program;
use std::collections::BTreeSet;
use std::fs;

const TABLE: &str = "step,time,time_over_jeans,distance,g\n0,0,0,2.5,1.25\n0,0,0,3.5,0.75\n";

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

/// The names of the files in a directory.
fn names(program: &Program, directory: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(program.folder().join(directory)).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// The lines of the program are the files that are there, an SVG and a PNG of each figure.
fn assert_drawn(program: &Program, directory: &str, expected: &[&str]) {
    let said = program.succeed(&["plot", directory]);
    let figures = format!("{directory}/figures");
    let told: BTreeSet<String> =
        said.lines().map(|line| line.strip_prefix(&format!("{figures}/")).unwrap().to_owned()).collect();
    assert_eq!(told, names(program, &figures));
    let both = expected.iter().flat_map(|name| [format!("{name}.svg"), format!("{name}.png")]);
    assert_eq!(told, both.collect());
    for name in expected {
        assert!(program.text(&format!("{figures}/{name}.svg")).ends_with("</svg>\n"), "{name}");
        assert!(program.read(&format!("{figures}/{name}.png")).starts_with(b"\x89PNG"), "{name}");
    }
}

#[test]
fn a_run_and_an_ensemble_are_drawn() {
    let program = program();
    // A figure takes its time without optimisation: one of each.
    let series = ["--set", "output.observables=0", "--set", "output.modes=0.1"];
    program.succeed(&[&["run", "small.toml", "--out", "run", "--until", "0.1"], &series[..]].concat());
    assert_drawn(&program, "run", &["modes"]);
    program.write(
        "sweep.toml",
        "version = 1\nconfiguration = \"small.toml\"\nseeds = 2\n\
         set = [\"time.until=0.1\", \"output.observables=0\", \"output.modes=0.1\"]\n",
    );
    program.succeed(&["ensemble", "sweep.toml", "--out", "ensemble"]);
    assert_drawn(&program, "ensemble", &["modes"]);
    let [run, ensemble] = ["run", "ensemble"].map(|of| program.text(&format!("{of}/figures/modes.svg")));
    assert_ne!(run, ensemble);
}

#[test]
fn what_lies_one_level_deeper_is_named() {
    let program = program();
    for directory in ["paper/clustering", "paper/rings", "paper/figures", "many"] {
        fs::create_dir_all(program.folder().join(directory)).unwrap();
    }
    for directory in ["clustering", "rings"] {
        program.write(&format!("paper/{directory}/radial_distribution.csv"), TABLE);
    }
    let expected = "error: paper: this directory holds no tables itself; name one in it that does: paper/clustering, paper/rings";
    assert_eq!(program.refuse(&["plot", "paper"], &[]), expected);
    for number in 1..=8 {
        fs::create_dir(program.folder().join(format!("many/{number}"))).unwrap();
        program.write(&format!("many/{number}/observables.csv"), "");
    }
    program.refuse(&["plot", "many"], &["many/5, many/6 and 2 others"]);
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let program = program();
    fs::create_dir(program.folder().join("tables")).unwrap();
    let table = "tables/radial_distribution.csv";
    program.write(table, TABLE);
    program.refuse(&["plot", table], &[table, "this is a file: name the directory that it is in"]);
    program.refuse(&["plot", "gone"], &["gone: found no table with rows", "name the directory of a run"]);
    program.write("taken", "");
    program.refuse(&["plot", "tables", "--out", "taken"], &["taken: cannot be written: "]);
    for (text, part) in [
        ("step,time\n", "tables: found no table with rows"),
        ("", "radial_distribution.csv: found no line, expected the names of the columns"),
        (
            &TABLE.replace("1.25", "one"),
            "radial_distribution.csv: line 2: found `one`, expected a number in column g",
        ),
        (&TABLE.replace("0.75", "0.75,1"), "radial_distribution.csv: line 3: found 6 cells, expected 5"),
    ] {
        program.write(table, text);
        program.refuse(&["plot", "tables"], &[part]);
    }
    // A table that cannot be drawn keeps the figures of the others from being half of the old and half of the new.
    program.write("tables/observables.csv", "step,time,time_over_jeans,clusters\n0,0,0,1\n");
    program.write(table, TABLE);
    program.refuse(&["plot", "tables"], &["observables.csv: found no column"]);
    assert!(!program.folder().join("tables/figures").exists());
}
