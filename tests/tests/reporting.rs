//! What the program tells at which level, to people and to scripts, and to pipes that nobody reads.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_tests::program::{Program, errors};
use serde_json::Value;
use std::process::{Output, Stdio};

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The one JSON object on standard output.
fn object(output: &Output) -> Value {
    let text = said(output);
    assert_eq!(text.lines().count(), 1, "{text}");
    let value: Value = serde_json::from_str(&text).unwrap();
    assert!(value.is_object(), "{value}");
    value
}

#[test]
fn a_run_tells_little_more_or_nothing_but_the_result() {
    let program = program();
    let run = |out: &str, level: &[&str]| {
        let output = program.start(&[&["run", "small.toml", "--until", "0.1", "--out", out], level].concat());
        assert!(output.status.success(), "{}", errors(&output));
        assert!(said(&output).starts_with("step ") && said(&output).lines().count() == 1);
        errors(&output)
    };
    assert_eq!(run("usual", &[]), "results in usual\n");
    assert_eq!(run("quiet", &["--quiet"]), "");
    let told = run("verbose", &["-v"]);
    for part in ["60 discs in a box of 48 R0", "force: pm: grid 32", "results in verbose", "steps/s"] {
        assert!(told.contains(part), "{part} is not in {told}");
    }
    assert!(told.is_ascii(), "{told}");
}

/// What is not on every keyboard is not on every terminal.
#[test]
fn help_is_plain_text() {
    let program = program();
    let commands = program.succeed(&["--help"]);
    let (_, commands) = commands.split_once("Commands:\n").unwrap();
    let commands: Vec<&str> =
        commands.lines().map_while(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    assert!(commands.len() > 9 && commands.contains(&"ensemble"), "{commands:?}");
    for command in commands {
        let help = program.succeed(&["help", command]);
        assert!(help.is_ascii() && help.lines().count() > 3, "{help}");
    }
    for list in [&["presets"][..], &["presets", "fig-12"]] {
        let text = program.succeed(list);
        assert!(text.is_ascii(), "{text}");
    }
}

#[test]
fn levels_stand_before_or_after_the_command_and_exclude_each_other() {
    let program = program();
    for arguments in [["-q", "presets"], ["presets", "-q"]] {
        assert!(program.start(&arguments).status.success());
    }
    let output = program.start(&["presets", "-q", "-v"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("cannot be used with"));
}

#[test]
fn json_is_one_object_and_nothing_else() {
    let program = program();
    let json = |arguments: &[&str], code| {
        let output = program.start(&[arguments, &["--json"]].concat());
        assert_eq!(output.status.code(), Some(code), "{}", errors(&output));
        object(&output)
    };
    let run = json(
        &["run", "small.toml", "--until", "0.1", "--out", "a run", "--golden", "pinned", "--every", "20"],
        0,
    );
    assert_eq!((&run["directory"], &run["ended"]), (&"a run".into(), &"finished".into()));
    let digest = json(&["digest", "a run"], 0);
    for key in ["step", "time", "length", "digest"] {
        assert_eq!(run[key], digest[key], "{key}");
    }
    let manifest: Value = serde_json::from_slice(&program.read("a run/run.json")).unwrap();
    for key in ["ended", "step", "time", "length", "digest"] {
        assert_eq!(run[key], manifest[key], "{key}");
    }
    let verified = json(&["verify", "pinned"], 0);
    assert_eq!(verified["equal"], true);
    let text = program.text("pinned");
    let digest_of_x =
        text.lines().find(|line| line.starts_with("  [20,")).unwrap().split('"').nth(3).unwrap();
    program.write("spoilt", text.replace(digest_of_x, &"0".repeat(64)));
    let spoilt = json(&["verify", "spoilt"], 1);
    assert_eq!((&spoilt["equal"], &spoilt["step"]), (&false.into(), &20.into()));
    assert_eq!(spoilt["equal_to_step"], 0);
    program.write("two.csv", "x,y\n20,20\n22,20\n");
    let forces = json(&["forces", "small.toml", "--positions", "two.csv"], 0);
    assert_eq!(forces["fx"][0].as_f64().unwrap(), -forces["fx"][1].as_f64().unwrap());
    assert_eq!(json(&["presets"], 0)["presets"][0]["name"], "table-1");
    assert!(json(&["presets", "fig-12"], 0)["configuration"].as_str().unwrap().contains("version = 1"));
    // Nothing where there is no result.
    program.refuse(&["run", "--json", "nowhere.toml"], &["nowhere.toml"]);
}

#[test]
fn what_nobody_reads_loses_no_run_and_no_verdict() {
    let program = program();
    let until = "--until 0.1 --set output.snapshots=0";
    let first = program.shell(&format!("meniscus run small.toml {until} --out read --every 20 | head -c 5"));
    assert!(first.status.success(), "{}", errors(&first));
    let deaf = format!("{{ meniscus run -v small.toml {until} --out deaf --every 20 2>&1; }} | true");
    let all = format!("meniscus run -v small.toml {until} --out closed --every 20 >&- 2>&-");
    for line in [deaf, all] {
        let output = program.shell(&line);
        assert!(output.status.success(), "{line}: {}", errors(&output));
        assert!(output.stderr.is_empty(), "{line}: {}", errors(&output));
    }
    for name in ["final.state", "final.csv", "golden.toml", "observables.csv", "config.toml"] {
        for out in ["deaf", "closed"] {
            assert_eq!(
                program.read(&format!("read/{name}")),
                program.read(&format!("{out}/{name}")),
                "{name}"
            );
        }
    }
    let text = program.text("read/golden.toml");
    program.write("spoilt.toml", text.replace("[20, ", "[21, "));
    // The exit code is that of the program, not of `true`.
    for (line, code) in [
        ("meniscus verify -v read/golden.toml | true", 0),
        ("meniscus verify -v spoilt.toml 2>&1 | true", 1),
        ("meniscus verify --json spoilt.toml | true", 1),
        ("meniscus verify nowhere.toml 2>&1 | true", 2),
        ("meniscus presets fig-12 | true", 0),
        ("meniscus presets | head -1", 0),
        ("meniscus --help | true", 0),
        ("meniscus digest read | true", 0),
    ] {
        let output = program.shell(line);
        assert_eq!(output.status.code(), Some(code), "{line}: {}", errors(&output));
        assert!(!errors(&output).contains("panic"), "{line}: {}", errors(&output));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_result_that_cannot_be_written_is_an_error_and_the_run_is_there() {
    let program = program();
    let mut command = program.command(&["run", "small.toml", "--until", "0.1", "--out", "run"]);
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command.stdout(full).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("error: standard output cannot be written: "), "{}", errors(&output));
    program.succeed(&["digest", "run"]);
}

#[test]
#[cfg(target_os = "linux")]
fn an_ensemble_runs_as_many_at_a_time_as_memory_suffices_for() {
    let program = program();
    // 98 MB each, of which none is taken here.
    let sweep = "version = 1\nconfiguration = \"small.toml\"\nseeds = 8\n\
                 set = [\"system.box=1024\", \"mesh.grid=64\", \"output.minkowski=0.1\", \"output.minkowski_spacing=0.5\"]\n";
    program.write("sweep.toml", sweep);
    let run = |limit: &str| {
        let line = "meniscus ensemble sweep.toml --workers 8 --max-wall 0";
        let output = program.shell(&format!("{limit}{line}"));
        assert!(output.status.success(), "{}", errors(&output));
        errors(&output)
    };
    let said = run("ulimit -v 450000; ");
    let told = said.lines().find(|line| line.starts_with("memory: ")).unwrap_or_default();
    assert!(
        told.contains(
            "the limit of the address space, ulimit -v), too little for 8 of these runs at a time: "
        ),
        "{said}"
    );
    let at_a_time: usize = told.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((2..=4).contains(&at_a_time), "{said}");
    assert!(!run("").contains("memory: "), "there is more than 800 MB here");
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_that_memory_would_not_suffice_for_is_refused_before_it_asks() {
    let program = program();
    let large = "run table-1 --out never --set force.method=pm --set system.particles=4194304 \
                 --set system.box=32768 --set mesh.grid=4096 --set output.observables=0";
    let output = program.shell(&format!("ulimit -v 500000; meniscus {large}"));
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    let bytes = "4194304 discs and a mesh of 4096 x 4096 nodes need at least 721";
    assert!(said.starts_with(&format!("error: {bytes}")), "{said}");
    assert!(said.contains("ulimit -v") && said.lines().count() == 1, "{said}");
    assert!(!program.folder().join("never").exists());
    let fine = "run small.toml --out never --set system.box=4096 --set mesh.grid=256 --set output.minkowski=0.1 \
                --set output.minkowski_spacing=0.5";
    let output = program.shell(&format!("ulimit -v 500000; meniscus {fine}"));
    let part = "1610612736 of them for the rows of minkowski, and ";
    assert!(errors(&output).contains(part), "{}", errors(&output));
    assert!(errors(&output).contains("or take a larger output.minkowski_spacing"), "{}", errors(&output));
    let pictures = "run small.toml --out never --set output.snapshots=1";
    let output = program.shell(&format!("ulimit -v 60000; meniscus {pictures}"));
    let (part, remedy) =
        ("55566336 of them for a snapshot, and ", "or leave the snapshots out by output.snapshots = 0");
    assert!(errors(&output).contains(part) && errors(&output).contains(remedy), "{}", errors(&output));
    // What fits is not refused: the same limit, a smaller mesh.
    let small =
        program.shell("ulimit -v 500000; meniscus run small.toml --until 0.01 --out small --threads 1");
    assert!(small.status.success(), "{}", errors(&small));
}
