//! Callers in C: the header is that of the crate, and a C program gets the same bits.
//!
//! After a change of the C interface, write the header anew:
//!
//! `MENISCUS_WRITE_HEADER=1 cargo test --package meniscus-tests --test c_callers`

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
#![expect(clippy::panic, reason = "a helper of a test fails the test by panicking")]

use meniscus::engine::Engine;
use meniscus_core::assignment::DISC;
use meniscus_core::dynamics::{Clock, Disc};
use meniscus_core::fields::Fields;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise, Parameters};
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::force_from_units;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

const WRITE_HEADER: &str = "MENISCUS_WRITE_HEADER";

fn ffi_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/ffi")
}

fn header_file() -> PathBuf {
    ffi_folder().join("include/meniscus.h")
}

/// The header as cbindgen makes it of the sources.
fn generated_header() -> String {
    let folder = ffi_folder();
    let configuration = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let builder = cbindgen::Builder::new().with_config(configuration);
    let bindings = builder.with_src(folder.join("src/lib.rs")).generate().unwrap();
    let mut text = Vec::new();
    bindings.write(&mut text);
    String::from_utf8(text).unwrap()
}

fn run(command: &mut Command) -> Output {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{complaint}", output.status);
    output
}

/// The library for C, built once, in a folder of its own.
fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c-callers");
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--package", "meniscus-ffi", "--locked", "--target-dir"]).arg(&target);
        cargo.current_dir(env!("CARGO_MANIFEST_DIR")).env_remove("CARGO_BUILD_TARGET");
        let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
        if profile == "release" {
            cargo.arg("--release");
        }
        run(&mut cargo);
        target.join(profile).join("libmeniscus_ffi.a")
    })
}

/// The C compiler: `CC`, else cc, which Rust's linker needs too.
fn c_compiler() -> String {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let found = Command::new(&compiler).arg("--version").output();
    assert!(
        found.is_ok_and(|output| output.status.success()),
        "no C compiler {compiler:?}: install gcc (for example `apt-get install gcc libc6-dev`), or name one in CC"
    );
    compiler
}

/// A C program of the folder `c`, compiled for one test: tests run side by side.
fn c_program(name: &str, test: &str) -> PathBuf {
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{test}"));
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("c").join(name).with_extension("c");
    let mut compiler = Command::new(c_compiler());
    compiler.args(["-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"]);
    compiler.arg(header_file().parent().unwrap()).arg(source).arg(library()).arg("-o").arg(&program);
    // What Rust's standard library asks of the system.
    compiler.args(["-lpthread", "-ldl", "-lm"]);
    run(&mut compiler);
    program
}

/// What `collapse.c` does, on the host's engine: its lines.
fn collapse_on_the_host() -> Vec<String> {
    let parameters = Parameters {
        side: 32.0,
        grid: 32,
        capillary_strength: 20.0,
        capillary_length: 16.0,
        noise: Noise::Gaussian,
        seed: 7,
        ..Parameters::default()
    };
    let torus = Torus::new(parameters.side).unwrap();
    let at = |place: u32| torus.wrapped_fraction(24.75 + 2.5 * f64::from(place));
    let discs: Vec<Position> = (0..36).map(|id| Position { x: at(id % 6), y: at(id / 6) }).collect();
    let mut engine = Engine::new(&parameters, Clock::START, &discs).unwrap();
    let steps: Vec<_> = (0..300).map(|_| engine.step().unwrap()).collect();
    let (last, clock, digest) = (steps.last().unwrap(), engine.clock(), engine.state().digest());
    let mut lines = vec![
        format!("{} {digest}", digest.length),
        format!("{} {} {} {}", clock.step, clock.time, last.length, last.largest_force),
    ];
    let forces = engine.forces().unwrap();
    for ((at, boxes), force) in engine.positions().iter().zip(engine.crossings()).zip(forces) {
        let [force_x, force_y] = force.map(|force| force / force_from_units(1));
        let (x, y) = (at.x.to_bits(), at.y.to_bits());
        lines.push(format!("{x} {y} {} {} {force_x} {force_y}", boxes[0], boxes[1]));
    }
    lines
}

/// What `mixture.c` does, on the host's engine: its lines.
fn mixture_on_the_host() -> Vec<String> {
    let parameters = Parameters {
        side: 40.0,
        grid: 32,
        capillary_strength: 20.0,
        capillary_length: f64::INFINITY,
        method: Method::P3m,
        splitting: 0.4,
        cutoff: 7.5,
        mesh_refresh: 0.25,
        assignment: Assignment::Order5,
        influence: Influence::Optimal,
        gradient: Gradient::Spectral,
        fields: Fields { uniform_force: [-3.0, 0.5], trap_stiffness: 0.25, trap_center: [0.0, 30.0] },
        noise: Noise::Gaussian,
        seed: 11,
        ..Parameters::default()
    };
    let torus = Torus::new(parameters.side).unwrap();
    let at = |place: u32| torus.fraction(3.0 * f64::from(place)).unwrap();
    let discs = (0..25).map(|id| Disc {
        id,
        position: Position { x: at(id % 5), y: at(id / 5) },
        strength: if id % 3 == 0 { -(DISC as i32) } else { DISC as i32 / 2 },
    });
    let mut engine = Engine::with_ids(&parameters, Clock::START, discs).unwrap();
    let steps: Vec<_> = (0..200).map(|_| engine.step().unwrap()).collect();
    let (last, refreshed) = (steps.last().unwrap(), steps.iter().filter(|step| step.refreshed).count());
    assert!(refreshed > 3 && refreshed < 100, "computed {refreshed} times");
    let digest = engine.state().digest();
    vec![
        format!("{} {digest}", digest.length),
        format!("{} {} {} {}", last.clock.step, last.clock.time, last.length, last.largest_force),
        refreshed.to_string(),
    ]
}

#[test]
fn the_committed_header_is_that_of_the_sources() {
    let generated = generated_header();
    if std::env::var_os(WRITE_HEADER).is_some_and(|value| value == "1") {
        std::fs::create_dir_all(header_file().parent().unwrap()).unwrap();
        std::fs::write(header_file(), &generated).unwrap();
    }
    let committed = std::fs::read_to_string(header_file()).unwrap_or_default();
    assert!(
        generated == committed,
        "{} is not what cbindgen makes of the sources; write it anew with {WRITE_HEADER}=1",
        header_file().display()
    );
}

#[test]
fn a_c_program_gets_the_same_bits() {
    let output = run(&mut Command::new(c_program("collapse", "bits")));
    let found = String::from_utf8(output.stdout).unwrap();
    let expected = collapse_on_the_host();
    let crossed = |line: &String| line.split(' ').skip(2).take(2).any(|boxes| boxes != "0");
    assert!(expected.iter().skip(2).any(crossed), "no disc crosses a border: the case shows too little");
    assert_eq!(found.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn a_c_program_gets_the_same_bits_of_the_split_force_held_with_unequal_strengths_in_a_trap() {
    let output = run(&mut Command::new(c_program("mixture", "bits")));
    let found = String::from_utf8(output.stdout).unwrap();
    assert_eq!(found.lines().collect::<Vec<_>>(), mixture_on_the_host());
}

#[test]
fn what_a_caller_does_wrong_is_answered_with_a_status() {
    run(&mut Command::new(c_program("checks", "errors")));
}

#[test]
fn every_status_has_a_message_of_its_own() {
    let header = std::fs::read_to_string(header_file()).unwrap();
    let status = |line: &str| {
        let (name, number) = line.trim().split_once(" = ")?;
        name.starts_with("MENISCUS_STATUS_").then(|| number.trim_end_matches(',').to_owned())
    };
    let numbers: Vec<String> = header.lines().filter_map(status).collect();
    assert!(numbers.len() > 40);
    let program = c_program("checks", "messages");
    let output = run(Command::new(program).args(&numbers).arg("-1"));
    let mut messages: Vec<&str> = std::str::from_utf8(&output.stdout).unwrap().lines().collect();
    assert_eq!(messages.len(), numbers.len() + 1);
    assert_eq!(messages.last(), Some(&"no status of Meniscus"));
    messages.sort_unstable();
    messages.dedup();
    assert_eq!(messages.len(), numbers.len() + 1);
}
