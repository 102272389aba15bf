//! The command-line program as its users start it: a process with arguments, files, output and an exit code.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use meniscus_tests::long_tests;
use meniscus_tests::program::Program;

/// 60 discs that collapse within a few hundred steps on a small mesh.
const SMALL: &str = "version = 1\nseed = 7\n\
    [system]\nparticles = 60\nbox = 48\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 32\n\
    [time]\nuntil = 0.5\n\
    [output]\nobservables = 0.05\ntrajectory = 0.1\nsnapshots = 0.5\n";

fn program() -> Program {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("small.toml", SMALL);
    program
}

fn digest(program: &Program, path: &str) -> String {
    program.succeed(&["digest", path])
}

#[test]
fn a_run_leaves_everything_a_person_can_look_at() {
    let program = program();
    let said = program.succeed(&["run", "small.toml", "--out", "run"]);
    let run = program.folder().join("run");
    for name in ["config.toml", "final.csv", "final.state", "golden.toml", "run.json", "trajectory.gsd"] {
        assert!(run.join(name).metadata().unwrap().len() > 0, "{name}");
    }
    let table = fs::read_to_string(run.join("observables.csv")).unwrap();
    assert!(table.starts_with("step,time,time_over_jeans,dt,max_force,"), "{table}");
    assert!(table.lines().next().unwrap().ends_with(",capillary_energy,repulsive_energy"), "{table}");
    assert_eq!(table.lines().count(), 1 + 11, "rows at 0, 0.05, … 0.5 T: {table}");
    let snapshots = ["snapshot-000.png", "snapshot-001.png"].map(|name| fs::read(run.join(name)).unwrap());
    assert!(snapshots.iter().all(|bytes| bytes.starts_with(b"\x89PNG")));
    let digest = digest(&program, "run");
    assert!(said.contains(digest.split_whitespace().nth(1).unwrap()), "{said} {digest}");
    assert_eq!(digest, self::digest(&program, "run/final.state"));
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(run.join("run.json")).unwrap()).unwrap();
    assert_eq!(summary["ended"], "finished");
    assert_eq!(summary["length"], 32 + 8 * 60);
}

#[test]
fn the_written_configuration_repeats_the_run() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "first", "--set", "mesh.assignment=cic", "--seed", "3"]);
    program.succeed(&["run", "first/config.toml", "--out", "second"]);
    for name in
        ["config.toml", "observables.csv", "trajectory.gsd", "final.csv", "final.state", "golden.toml"]
    {
        let [first, second] =
            ["first", "second"].map(|run| fs::read(program.folder().join(run).join(name)).unwrap());
        assert_eq!(first, second, "{name}");
    }
}

#[test]
fn the_order_of_discs_in_a_file_changes_nothing() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "begin", "--until", "0.1"]);
    let table = fs::read_to_string(program.folder().join("begin/final.csv")).unwrap();
    let (header, rows) = table.split_once('\n').unwrap();
    let reversed: Vec<&str> = rows.lines().rev().collect();
    fs::write(program.folder().join("reversed.csv"), format!("{header}\n{}\n", reversed.join("\n"))).unwrap();
    let from = |file: &str, out: &str| {
        let path = format!("start.path={file}");
        program.succeed(&["run", "small.toml", "--set", "start.kind=file", "--set", &path, "--out", out]);
        digest(&program, out)
    };
    assert_eq!(from("begin/final.csv", "given"), from("reversed.csv", "turned"));
}

#[test]
fn a_stopped_run_goes_on_from_its_state_bit_for_bit() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "whole"]);
    program.succeed(&["run", "small.toml", "--out", "part", "--until", "0.2"]);
    let go_on = ["--set", "start.kind=file", "--set", "start.path=part/final.state"];
    let arguments = [&["run", "small.toml", "--out", "rest"], &go_on[..]].concat();
    program.succeed(&arguments);
    assert_eq!(digest(&program, "whole"), digest(&program, "rest"));
}

#[test]
fn a_run_that_holds_mesh_forces_says_so_and_goes_on_bit_for_bit() {
    let program = program();
    let held = ["--set", "force.mesh_refresh=0.3"];
    let output = program.start(&[&["run", "small.toml", "--out", "whole"], &held[..]].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let warning = "force.mesh_refresh 0.3: the force of the mesh is held until a disc has moved 0.3 R0, and the force \
                   is less accurate than its scheme; the error of what is held is measured and told at the end";
    assert!(said.contains(warning), "{said}");
    assert!(said.contains("% saved; rms error of a force as old as it got "), "{said}");
    let read = |name: &str| fs::read_to_string(program.folder().join(name)).unwrap();
    assert!(read("whole/config.toml").contains("\nmesh_refresh = 0.3\n"));
    let summary =
        |run: &str| -> serde_json::Value { serde_json::from_str(&read(&format!("{run}/run.json"))).unwrap() };
    let reuse = summary("whole")["force"]["mesh_refresh"].clone();
    let number = |name: &str| reuse[name].as_f64().unwrap();
    assert_eq!((number("distance"), reuse["steps"].clone()), (0.3, summary("whole")["step"].clone()));
    assert!(number("transforms") > 1.0 && number("transforms") < number("steps"), "{reuse}");
    assert!((number("saved") - (1.0 - number("transforms") / number("steps"))).abs() < 1e-12, "{reuse}");
    assert!((0.001..0.2).contains(&number("measured_error")), "{reuse}");
    // Where a disc is stored, and with it the engine, is not to be seen in the sums.
    let core = ["--engine", "core", "--max-wall", "0"];
    program.succeed(&[&["run", "small.toml", "--out", "core"], &held[..], &core[..]].concat());
    program.succeed(&["resume", "core", "--engine", "core", "--until", "0.3"]);
    program.succeed(&["resume", "core", "--until", "0.5"]);
    assert_eq!(summary("core")["force"]["mesh_refresh"], reuse);
    // Stopped and gone on, from a state in which forces are held.
    program.succeed(&[&["run", "small.toml", "--out", "part", "--until", "0.2"], &held[..]].concat());
    assert!(
        fs::read(program.folder().join("part/final.state")).unwrap().windows(4).any(|four| four == b"HELD")
    );
    assert_eq!(digest(&program, "part"), digest(&program, "part/final.state"));
    let from = ["--set", "start.kind=file", "--set", "start.path=part/final.state"];
    program.succeed(&[&["run", "part/config.toml", "--out", "rest", "--until", "0.5"], &from[..]].concat());
    assert_eq!(digest(&program, "whole"), digest(&program, "rest"));
    // Without it the same state is a start like any other.
    let off = ["--set", "force.mesh_refresh=0", "--until", "0.21"];
    program.succeed(&[&["run", "small.toml", "--out", "off"], &from[..], &off[..]].concat());
    assert_eq!(summary("off")["force"]["mesh_refresh"], serde_json::Value::Null);
    assert_eq!(summary("off")["length"], 32 + 8 * 60);
    program.succeed(&["verify", "whole/golden.toml"]);
    program.refuse(
        &["run", "small.toml", "--set", "force.mesh_refresh=12"],
        &["force.mesh_refresh", "12", "below a quarter of the box, 12 R0"],
    );
}

#[test]
fn looking_more_often_changes_nothing() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "seldom"]);
    let often = ["observables", "trajectory"].map(|what| format!("output.{what}=0.001"));
    program.succeed(&[
        "run",
        "small.toml",
        "--out",
        "often",
        "--set",
        &often[0],
        "--set",
        &often[1],
        "--every",
        "1",
    ]);
    assert_eq!(digest(&program, "seldom"), digest(&program, "often"));
}

#[test]
fn ctrl_c_and_the_wall_time_leave_a_state() {
    let program = program();
    let arguments = ["run", "small.toml", "--until", "1000", "--set", "output.snapshots=0", "--out", "long"];
    let mut child = program.command(&arguments).stdout(Stdio::piped()).spawn().unwrap();
    let table = program.folder().join("long/observables.csv");
    let begun = Instant::now();
    while fs::read_to_string(&table).map_or(0, |text| text.lines().count()) < 3 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not begin");
        std::thread::sleep(Duration::from_millis(20));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    assert!(child.wait().unwrap().success());
    let summary = |run: &str| fs::read_to_string(program.folder().join(run).join("run.json")).unwrap();
    assert!(summary("long").contains("\"interrupted\""));
    digest(&program, "long");
    program.succeed(&["run", "small.toml", "--until", "1000", "--max-wall", "0.2", "--out", "short"]);
    assert!(summary("short").contains("\"wall time\""));
}

#[test]
fn verify_says_equal_or_names_what_differs() {
    let program = program();
    let arguments = ["run", "small.toml", "--out", "run", "--golden", "golden.toml", "--every", "20"];
    program.succeed(&arguments);
    assert!(program.succeed(&["verify", "golden.toml"]).starts_with("equal: "));
    let path = program.folder().join("golden.toml");
    let text = fs::read_to_string(&path).unwrap();
    let row = text.lines().find(|line| line.starts_with("  [40,")).unwrap();
    let digest_of_x = row.split('"').nth(3).unwrap();
    fs::write(&path, text.replace(digest_of_x, &"0".repeat(64))).unwrap();
    let output = program.start(&["verify", "golden.toml", "--bisect"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    for part in ["step 40: x differs", "equal up to the record of step 20", "steps 21 to 40"] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
}

#[test]
fn tables_are_drawn_where_one_says() {
    let program = program();
    let folder = program.folder();
    fs::create_dir(folder.join("tables")).unwrap();
    let table = "step,time,time_over_jeans,distance,g\n0,0,0,2.5,1.25\n0,0,0,3.5,0.75\n";
    program.write("tables/radial_distribution.csv", table);
    let object = program.succeed(&["plot", "tables", "--out", "drawn/here", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&object).unwrap();
    let names = ["svg", "png"].map(|ending| format!("drawn/here/radial_distribution.{ending}"));
    assert_eq!(object["figures"], serde_json::json!(names));
    assert!(program.text(&names[0]).ends_with("</svg>\n"));
    assert!(program.read(&names[1]).starts_with(b"\x89PNG"));
    assert!(!folder.join("tables/figures").exists());
    program.write("tables/radial_distribution.csv", table.replace(",g\n", ",h\n"));
    let expected = ["tables/radial_distribution.csv: ", "no column g"];
    program.refuse(&["plot", "tables"], &expected);
    program.refuse(&["plot", "nowhere"], &["nowhere: found no table with rows"]);
    assert!(!folder.join("tables/figures").exists() && !folder.join("nowhere").exists());
}

#[test]
fn forces_are_printed_for_every_disc_of_a_file() {
    let program = program();
    fs::write(program.folder().join("two.csv"), "id,x,y\n1,22,20\n0,20,20\n").unwrap();
    let table = program.succeed(&["forces", "small.toml", "--positions", "two.csv"]);
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(table.starts_with("id,x,y,fx,fy\n"));
    // Positions are multiples of 48 R0 · 2⁻³².
    assert!((rows[0][1] - 20.0).abs() < 1e-8 && (rows[1][1] - 22.0).abs() < 1e-8, "{table}");
    // At contact the repulsion of 12 kBT/R0 exceeds the attraction of about 5.
    assert!(rows[0][3] < -4.0 && rows[0][3] > -12.0, "{table}");
    assert!((rows[0][3] + rows[1][3]).abs() < 1e-4 && rows[0][4].abs() < 1e-4, "{table}");
    program.succeed(&["forces", "small.toml", "--positions", "two.csv", "--out", "forces.csv"]);
    assert_eq!(fs::read_to_string(program.folder().join("forces.csv")).unwrap(), table);
    let overwrite = ["forces", "small.toml", "--positions", "two.csv", "--out", "two.csv"];
    program.refuse(&overwrite, &["two.csv: this file exists: name another file, or remove it"]);
}

#[test]
fn p3m_says_what_it_chose_and_what_is_written_repeats_it() {
    let program = program();
    let without_pictures = ["--set", "output.snapshots=0", "--until", "0.01"];
    let p3m =
        [&["--set", "force.method=p3m", "--set", "mesh.assignment=order-5"], &without_pictures[..]].concat();
    let output =
        program.start(&[&["run", "-v", "small.toml", "--out", "first", "--every", "2"], &p3m[..]].concat());
    let told = String::from_utf8(output.stderr).unwrap();
    let line = told.lines().find(|line| line.starts_with("force: ")).unwrap();
    assert!(
        line.starts_with("force: p3m, accuracy 1e-3 (estimated ") && line.contains("grid 32, order-5"),
        "{line}"
    );
    let read = |name: &str| fs::read_to_string(program.folder().join(name)).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&read("first/run.json")).unwrap();
    let force = &summary["force"];
    assert_eq!(
        (&force["method"], &force["grid"], &force["assignment"]),
        (&"p3m".into(), &32.into(), &"order-5".into())
    );
    let error = force["estimated_error"].as_f64().unwrap();
    assert!(error > 0.0 && error <= 1e-3, "{error}");
    for key in ["splitting", "cutoff"] {
        assert!(read("first/config.toml").contains(&format!("\n{key} = {}\n", force[key])), "{key}");
    }
    program.succeed(&["run", "first/config.toml", "--out", "second", "--every", "2"]);
    for name in ["config.toml", "golden.toml", "final.state"] {
        assert_eq!(
            read_bytes(program.folder(), "first", name),
            read_bytes(program.folder(), "second", name),
            "{name}"
        );
    }
    assert!(program.succeed(&["verify", "first/golden.toml"]).starts_with("equal: "));
    let pm = ["run", "-v", "first/config.toml", "--set", "force.method=pm", "--out", "third"];
    let told = String::from_utf8(program.start(&pm).stderr).unwrap();
    assert!(
        told.contains("force: pm: grid 32 (spacing 1.5 R0), order-5, influence paper, gradient spectral\n"),
        "{told}"
    );
    assert_ne!(digest(&program, "third"), digest(&program, "first"));
}

fn read_bytes(folder: &Path, run: &str, name: &str) -> Vec<u8> {
    fs::read(folder.join(run).join(name)).unwrap()
}

#[test]
fn strengths_travel_with_the_discs() {
    let program = program();
    let run = |out: &str, more: &[&str]| {
        program.succeed(
            &[
                &["run", "small.toml", "--out", out, "--every", "4", "--set", "output.snapshots=0"][..],
                &["--set", "output.trajectory_format=xyz"],
                more,
            ]
            .concat(),
        );
        digest(&program, out)
    };
    let mixed = ["--set", "system.strengths=[1, -1, 0.5]"];
    let whole = run("whole", &[&mixed[..], &["--until", "0.2"]].concat());
    assert_ne!(whole, run("equal", &["--until", "0.2"]), "strengths are felt");
    // 32 + 8·60, and the section of strengths, 12 + 4·60.
    assert!(whole.starts_with("764 "), "{whole}");
    assert!(program.succeed(&["verify", "whole/golden.toml"]).starts_with("equal: "));
    let text = |name: &str| String::from_utf8(read_bytes(program.folder(), "whole", name)).unwrap();
    assert!(text("final.csv").starts_with("id,x,y,strength\n0,"));
    assert!(text("trajectory.xyz").contains("pos:R:3:id:I:1:strength:R:1:clustered:I:1"));
    assert!(text("config.toml").contains("\nstrengths = [1.0, -1.0, 0.5]\n"));
    assert!(!read_bytes(program.folder(), "equal", "final.csv").starts_with(b"id,x,y,strength"));

    // Where it goes on, the file says the strengths, whether the configuration does or not.
    run("part", &[&mixed[..], &["--until", "0.1"]].concat());
    let from = |file| ["--set", "start.kind=file", "--set", file, "--until", "0.2"];
    let state = from("start.path=part/final.state");
    assert_eq!(run("said-twice", &[&mixed[..], &state[..]].concat()), whole);
    assert_eq!(run("said-once", &state), whole);
    let jeans_time = |run| {
        let summary: serde_json::Value =
            serde_json::from_slice(&read_bytes(program.folder(), run, "run.json")).unwrap();
        summary["jeans_time"].as_f64().unwrap()
    };
    assert_eq!(jeans_time("said-once"), jeans_time("whole"));
    // <f^2> = (1 + 1 + 1/4)/3.
    assert!((jeans_time("equal") / jeans_time("whole") - 0.75).abs() < 1e-15);
    program.succeed(&["run", "said-once/config.toml", "--out", "again"]);
    assert_eq!(digest(&program, "again"), whole);
    let table = run("from-table", &from("start.path=part/final.csv"));
    assert_eq!(table.split(' ').next(), whole.split(' ').next());
    let other = ["run", "small.toml", "--out", "never", "--set", "system.strengths=[1, -1]"];
    program.refuse(
        &[&other[..], &state[..]].concat(),
        &["part/final.state", "disc 2 has the strength 0.5", "configuration 1:", "leave out"],
    );
}

#[test]
fn forces_honour_a_column_of_strengths_and_the_fields() {
    let program = program();
    let forces = |strengths: [f64; 2], more: &[&str]| -> Vec<[f64; 2]> {
        let table = format!("x,y,strength\n20,20,{}\n26,20,{}\n", strengths[0], strengths[1]);
        fs::write(program.folder().join("two.csv"), table).unwrap();
        let arguments = [&["forces", "small.toml", "--positions", "two.csv"], more].concat();
        let table = program.succeed(&arguments);
        let cell = |row: &str, column| row.split(',').nth(column).unwrap().parse().unwrap();
        table.lines().skip(1).map(|row| [cell(row, 3), cell(row, 4)]).collect()
    };
    let one = forces([1.0, 1.0], &[])[0][0];
    assert!(one > 0.5, "{one}");
    for (strengths, product) in
        [([2.0, 3.0], 6.0), ([-1.0, 0.5], -0.5), ([-2.0, -0.5], 1.0), ([0.0, 5.0], 0.0)]
    {
        let [first, second] = [0, 1].map(|disc| forces(strengths, &[])[disc][0]);
        // Weights are rounded to 2^-20 of a disc: relative to forces within a mesh spacing, about 100 kBT/R0.
        assert!((first - product * one).abs() < 1e-3, "{strengths:?}: {first}, {one}");
        assert!((first + second).abs() < 1e-3, "{strengths:?}: {first}, {second}");
    }
    let free = ["--set", "system.capillary_strength=0", "--set", "field.uniform_force=[1, -2]"];
    assert_eq!(forces([1.0, 1.0], &free), [[1.0, -2.0]; 2]);
    let trap = ["--set", "system.capillary_strength=0", "--set", "field.trap_stiffness=0.5"];
    for (force, x) in forces([1.0, 0.0], &trap).iter().zip([20.0, 26.0]) {
        // The middle of the box is at 24 R0; positions are multiples of 48 R0 · 2^-32.
        let [expected_x, expected_y] = [0.5 * (24.0 - x), 0.5 * (24.0 - 20.0)];
        assert!((force[0] - expected_x).abs() < 1e-6 && (force[1] - expected_y).abs() < 1e-6, "{force:?}");
    }
}

#[test]
fn a_mistake_is_answered_by_one_line_and_exit_code_2() {
    let program = program();
    let set = |key_and_value| ["run", "small.toml", "--out", "never", "--set", key_and_value];
    let mistakes: [(&str, &[&str]); 18] = [
        ("system.partcles=5", &["system.partcles", "system.particles"]),
        ("system.particles=many", &["system.particles", "many"]),
        ("system.particles=0", &["system.particles", "0"]),
        ("system.box=-3", &["system.box", "-3"]),
        ("system.box=nan", &["system.box", "nan"]),
        ("system.box=100000", &["system.box", "100000", "65536"]),
        ("system.capillary_length=0", &["system.capillary_length"]),
        ("mesh.grid=100", &["mesh.grid", "100", "power of two"]),
        ("mesh.assignment=cloud", &["mesh.assignment", "cloud", "cic", "tsc"]),
        ("motion.max_step=2", &["motion.max_step", "2"]),
        ("seed=-1", &["seed", "-1"]),
        ("force.accuracy=1e-3", &["force.accuracy", "pm", "p3m"]),
        ("mesh.influence=optimal", &["mesh.influence", "pm", "p3m"]),
        ("system.strengths=[2000]", &["system.strengths", "2000", "1000"]),
        ("field.uniform_force=1", &["field.uniform_force", "[x, y]"]),
        ("start.kind=file", &["start.path"]),
        ("version=2", &["version", "2"]),
        ("physical.radius=1e-5", &["physical", "system"]),
    ];
    for (mistake, parts) in mistakes {
        program.refuse(&set(mistake), parts);
    }
    program.refuse(&["run", "tabel-1"], &["tabel-1", "table-1"]);
    program.refuse(&["run", "no.toml"], &["no.toml"]);
    program.refuse(&["digest", "."], &["final.state"]);
    program.refuse(&["digest", "small.toml"], &["small.toml"]);
    program.refuse(&["verify", "small.toml"], &["small.toml", "format"]);
    fs::write(program.folder().join("outside.csv"), "x,y\n1,1\n2,48\n").unwrap();
    program.refuse(&["forces", "small.toml", "--positions", "outside.csv"], &["outside.csv", "3", "48"]);
    assert!(!program.folder().join("never").exists(), "a refused run leaves nothing");
}

#[test]
fn a_second_run_in_a_directory_is_refused_and_loses_nothing() {
    let program = program();
    program.succeed(&["run", "small.toml", "--out", "run", "--until", "0.1"]);
    let before = fs::read(program.folder().join("run/final.state")).unwrap();
    program.refuse(&["run", "small.toml", "--out", "run"], &["run", "not empty", "--out"]);
    assert_eq!(fs::read(program.folder().join("run/final.state")).unwrap(), before);
}

#[test]
fn a_golden_file_is_not_overwritten_and_has_to_be_writable() {
    let program = program();
    fs::write(program.folder().join("pinned.toml"), "precious").unwrap();
    let run = |golden| ["run", "small.toml", "--out", "run", "--until", "0.1", "--golden", golden];
    program.refuse(&run("pinned.toml"), &["pinned.toml", "verify"]);
    assert_eq!(fs::read(program.folder().join("pinned.toml")).unwrap(), b"precious");
    program.refuse(&run("nowhere/golden.toml"), &["nowhere"]);
}

#[test]
fn a_refused_step_leaves_the_state_and_the_force_that_refused_it() {
    let program = program();
    fs::write(program.folder().join("two.csv"), "x,y\n20,20\n20,20\n").unwrap();
    let arguments = [
        "run",
        "small.toml",
        "--out",
        "run",
        "--set",
        "system.particles=2",
        "--set",
        "start.kind=file",
        "--set",
        "start.path=two.csv",
        "--set",
        "motion.max_displacement=1e-12",
    ];
    program.refuse(&arguments, &["step 0", "2^-40", "max_displacement"]);
    let table = fs::read_to_string(program.folder().join("run/observables.csv")).unwrap();
    let row: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
    assert_eq!(row[3], "0", "no step is possible: {table}");
    assert!(row[4].parse::<f64>().unwrap() > 7e5, "{table}");
    digest(&program, "run");
}

#[test]
fn presets_are_listed_and_printed_whole() {
    let program = program();
    let list = program.succeed(&["presets"]);
    assert_eq!(list.lines().count(), 2 + 13, "table-1 in two units and fig-2 to fig-14: {list}");
    let names = list.lines().filter_map(|line| line.split_whitespace().next());
    // What is chosen takes seconds without optimisation.
    for name in names.filter(|name| long_tests() || *name == "fig-12") {
        let text = program.succeed(&["presets", name]);
        fs::write(program.folder().join(format!("{name}.toml")), &text).unwrap();
        for part in
            ["version = 1", "method = \"p3m\"", "# Estimated with", "splitting = ", "cutoff = ", "grid = "]
        {
            assert!(text.contains(part), "{part} is not in {text}");
        }
    }
    program.refuse(&["presets", "fig-22"], &["fig-22", "fig-2"]);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let program = program();
    let mut child = program
        .command(&["presets", "table-1"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}
