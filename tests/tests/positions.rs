//! Files of positions: those that must be read, those that must be refused with one exact line, and more junk than
//! there ought to be memory for.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::start;
use meniscus::strengths::ONE;
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::long_tests;
use meniscus_tests::program::{Program, errors};
use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Side of the box and number of discs that the files are for.
const SIDE: f64 = 48.0;
const DISCS: usize = 2;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("positions").join(name)
}

/// The files of a folder in the order of their names, but for the messages.
fn files(name: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder(name)).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_none_or(|ending| ending != "expected")).collect();
    files.sort();
    files
}

fn torus() -> Torus {
    Torus::new(SIDE).unwrap()
}

fn expected_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap().to_owned();
    name.push(".expected");
    path.with_file_name(name)
}

#[test]
fn good_files_are_read() {
    let at = |x: f64, y: f64| Position { x: torus().fraction(x).unwrap(), y: torus().fraction(y).unwrap() };
    let usual = [at(1.0, 2.0), at(4.0, 5.0)];
    for path in files("good") {
        let state = start::file(&torus(), &path, DISCS).unwrap_or_else(|error| panic!("{error}"));
        let expected = match path.file_name().unwrap().to_str().unwrap() {
            "same-place.csv" => [at(1.0, 2.0); 2],
            "edge-of-the-box.csv" => [at(0.0, 0.0), at(47.999_999_99, 0.0)],
            "last-of-two-frames.extxyz" => [at(4.0, 6.0), at(1.0, 3.0)],
            "two.state" | "two-with-strengths.state" => {
                [Position::from_bits(0, 7), Position::from_bits(1_000_000_000, 7)]
            }
            _ => usual,
        };
        assert_eq!(state.positions, expected, "{}", path.display());
        let strengths = match path.file_name().unwrap().to_str().unwrap() {
            "strengths.csv" => Some(vec![-ONE, ONE / 2]),
            "two-with-strengths.state" => Some(vec![ONE, -ONE / 2]),
            _ => None,
        };
        assert_eq!(state.strengths, strengths, "{}", path.display());
    }
}

/// Run with `MENISCUS_WRITE_EXPECTED=1` to write the messages down; then read them.
#[test]
fn bad_files_are_refused_with_exactly_their_message() {
    let folder = format!("{}/", folder("bad").display());
    let files = files("bad");
    assert!(files.len() >= 60, "{}", files.len());
    for path in files {
        let refused = start::file(&torus(), &path, DISCS);
        let message = refused.map(|_| ()).expect_err(&path.display().to_string()).to_string();
        let message = message.replace(&folder, "");
        assert_eq!(message.lines().count(), 1, "{message:?}");
        assert!(message.is_ascii() && !message.contains(char::is_control), "{message:?}");
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(message.starts_with(name), "{name}: {message}");
        let expected = expected_of(&path);
        if std::env::var_os("MENISCUS_WRITE_EXPECTED").is_some() {
            fs::write(&expected, format!("{message}\n")).unwrap();
        }
        let expected = fs::read_to_string(&expected).unwrap_or_default();
        assert_eq!(message, expected.trim_end(), "{}", path.display());
    }
}

#[test]
fn the_program_names_the_file_and_leaves_nothing() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    fs::create_dir(program.folder().join("folder.csv")).unwrap();
    for name in ["nan.csv", "cut.state", "count-absurd.xyz"] {
        program.write(name, fs::read(folder("bad").join(name)).unwrap());
    }
    for (name, part) in [
        ("folder.csv", "cannot be read: "),
        ("nowhere.csv", "cannot be read: "),
        ("nan.csv", "line 3, column x: found `nan`"),
        ("cut.state", "the state is cut off: 47 bytes of 48"),
        ("count-absurd.xyz", "of 4000000000 discs"),
    ] {
        let path = format!("start.path={name}");
        let run = ["run", "small.toml", "--out", "never", "--set", "system.particles=2"];
        program.refuse(&[&run[..], &["--set", "start.kind=file", "--set", &path]].concat(), &[name, part]);
        program.refuse(&["forces", "small.toml", "--positions", name], &[name, part]);
        assert!(!program.folder().join("never").exists(), "{name}");
    }
}

#[test]
fn discs_at_one_place_are_named_and_come_apart() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    program.write("heap.csv", "id,x,y\n0,10,10\n3,0.1,20\n1,20,20\n2,47.9,20\n4,20,20\n");
    let run = |more: &[&str]| {
        let from =
            ["--set", "start.kind=file", "--set", "start.path=heap.csv", "--set", "system.particles=5"];
        let run = ["run", "small.toml", "--until", "0.01"];
        program.start(&[&run[..], &from, more].concat())
    };
    let output = run(&["--out", "run"]);
    let said = errors(&output);
    assert!(output.status.success(), "{said}");
    let warning = "heap.csv: discs 2 and 3 are 0.2 R0 apart, closer than 0.9 R0";
    assert_eq!(said.matches(warning).count(), 1, "{said}");
    let rows: Vec<Vec<f64>> = program
        .text("run/final.csv")
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let distance = |first: usize, second: usize| {
        let along = |axis: usize| {
            let apart = (rows[first][axis] - rows[second][axis]).abs();
            apart.min(SIDE - apart)
        };
        libm::hypot(along(1), along(2))
    };
    for (first, second) in [(1, 4), (2, 3)] {
        assert!(distance(first, second) > 1.8, "{rows:?}");
    }
    let without = run(&["--out", "soft", "--set", "system.repulsion=false"]);
    assert!(!errors(&without).contains("apart"));
    let refused = run(&["--out", "stuck", "--set", "motion.max_displacement=1e-12"]);
    let said = errors(&refused);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains(warning) && said.contains("max_displacement"), "{said}");
}

/// Address space that the program gets to refuse junk in, KB.
const LITTLE_MEMORY: u64 = 256 << 10;

/// The same for a state that says it has as many discs as there may be, with 36 bytes each.
#[cfg(target_os = "linux")]
const MEMORY_OF_A_STATE: u64 = 512 << 10;

/// Bytes of junk that has to be read to its end: 1 GB if the long tests are asked for.
fn junk_size() -> usize {
    if long_tests() { 1 << 30 } else { 20 << 20 }
}

/// Writes `piece` again and again after `head`.
fn write_junk(program: &Program, name: &str, head: &[u8], piece: &[u8], size: usize) {
    let mut file = BufWriter::new(fs::File::create(program.folder().join(name)).unwrap());
    file.write_all(head).unwrap();
    let block = piece.repeat((1 << 20) / piece.len());
    for _ in 0..size / block.len() {
        file.write_all(&block).unwrap();
    }
    file.flush().unwrap();
}

#[cfg(target_os = "linux")]
fn refused_with_little_memory(program: &Program, name: &str, part: &str) {
    refused_with(LITTLE_MEMORY, program, name, part);
}

#[cfg(target_os = "linux")]
fn refused_with(memory: u64, program: &Program, name: &str, part: &str) {
    let command = format!("ulimit -v {memory}; meniscus forces small.toml --positions {name}");
    let output = program.shell(&command);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{name}: {said}");
    assert!(said.starts_with(&format!("error: {name}: ")) && said.contains(part), "{said}");
    assert!(said.len() < 300 && said.lines().count() == 1, "{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_gigabyte_of_nothing_is_refused_with_little_memory() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    for (name, part) in
        [("zeros.csv", "a longer line"), ("zeros.xyz", "a longer line"), ("zeros.state", "not a state file")]
    {
        // Takes no room on the disc.
        fs::File::create(program.folder().join(name)).unwrap().set_len(1 << 30).unwrap();
        refused_with_little_memory(&program, name, part);
    }
    let mut state = fs::read(folder("bad").join("count-too-large.state")).unwrap();
    state.truncate(32);
    program.write("counted.state", &state);
    let counted = fs::OpenOptions::new().write(true).open(program.folder().join("counted.state")).unwrap();
    counted.set_len(1 << 30).unwrap();
    refused_with(MEMORY_OF_A_STATE, &program, "counted.state", "followed by other bytes");
}

/// The header of a GSD file whose index and whose list of names are as long as they may be, with what follows it for
/// both.
fn gsd_header(size: usize) -> Vec<u8> {
    let mut header = Vec::new();
    for number in [0x65df_65df_65df_65df, 256, (size as u64 - 256) / 32, 256, 65536] {
        header.extend(u64::to_ne_bytes(number));
    }
    header.extend([0, 2 << 16].map(u32::to_ne_bytes).concat());
    header.resize(112, 0);
    header.extend(b"hoomd");
    header.resize(256, 0);
    header
}

#[test]
#[cfg(target_os = "linux")]
fn junk_that_has_to_be_read_to_its_end_takes_little_memory() {
    let program = Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"));
    let size = junk_size();
    let junk: Vec<u8> = (0_u32..1 << 16).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    for (name, head, piece, part) in [
        ("junk.csv", &b""[..], &junk[..], "no text"),
        ("junk.xyz", b"", &junk, "no text"),
        ("junk.lammpstrj", b"", &junk, "no text"),
        ("junk.npz", b"", &junk, "Zip"),
        ("junk.gsd", b"", &junk, "bytes of another kind"),
        ("index.gsd", &gsd_header(size), &junk, "a chunk that is not in the file"),
        (
            "comments.csv",
            b"",
            b"# and nothing else, again and again, until there is no end to it\n",
            "no line with the names",
        ),
        (
            "frames.xyz",
            b"",
            b"0\na frame of no disc, again and again, until there is no end to it\n",
            "no disc",
        ),
        (
            "no-end.xyz",
            b"4000000000\n\n",
            b"X 1 2 0 and more of it, again and again, until there is no end to it\n",
            "of 4000000000 discs",
        ),
    ] {
        write_junk(&program, name, head, piece, size);
        refused_with_little_memory(&program, name, part);
        fs::remove_file(program.folder().join(name)).unwrap();
    }
}
