//! Replays what fuzzing kept: every file of `fuzz/corpus/NAME` through the target of that name.

use meniscus_tests::fuzzing::{self, TARGETS, Target};
use std::collections::BTreeSet;
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

/// A folder of the fuzzing workspace.
fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz").join(name)
}

/// The paths in a folder in the order of their names; none if there is no such folder.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn paths(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Runs a target over its corpus and names every file that breaks it.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn replay(name: &str, target: Target) {
    let files = paths(&folder("corpus").join(name));
    assert!(!files.is_empty(), "the corpus of {name} is missing or empty");
    let broken = files.iter().filter(|file| {
        let data = fs::read(file).unwrap();
        catch_unwind(|| target(&data)).is_err()
    });
    let broken: Vec<_> = broken.map(|file| file.display().to_string()).collect();
    assert!(broken.is_empty(), "{name} is broken by {broken:?}");
}

/// What README of the workspace says does not belong in a corpus.
#[test]
fn every_corpus_is_small() {
    for target in paths(&folder("corpus")) {
        let files = paths(&target);
        assert!(files.len() <= 60, "{}: {} files", target.display(), files.len());
        for file in files {
            let length = fs::metadata(&file).unwrap().len();
            assert!(length <= 4096, "{}: {length} bytes", file.display());
        }
    }
}

macro_rules! replay_each {
    ($($name:ident),*) => {
        $(
            #[test]
            fn $name() {
                replay(stringify!($name), fuzzing::$name);
            }
        )*

        const REPLAYED: &[&str] = &[$(stringify!($name)),*];
    };
}

replay_each!(
    assignment,
    checkpoint,
    configuration,
    golden,
    gsd,
    mesh_solve,
    near_force,
    pair_force,
    parameters,
    positions,
    step
);

#[test]
fn every_target_is_fuzzed_and_replayed() {
    let stems = |folder: &Path| -> BTreeSet<String> {
        paths(folder).iter().map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
    };
    let names: BTreeSet<String> = TARGETS.iter().map(|target| target.0.to_owned()).collect();
    assert_eq!(REPLAYED.iter().map(|&name| name.to_owned()).collect::<BTreeSet<_>>(), names);
    assert_eq!(stems(&folder("fuzz_targets")), names);
    assert_eq!(stems(&folder("corpus")), names);
}
