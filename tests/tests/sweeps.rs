//! What a sweep's file may say, and what is said of one that is wrong.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use meniscus::configuration::Configuration;
use meniscus::ensemble::{Member, Setting, Sweep};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The sweeps of a directory beside this test's package, in the order of their names.
fn sweeps(directory: &str) -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("ensembles").join(directory);
    let paths = fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> =
        paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    paths.sort();
    paths
}

/// Reads a file under its bare name.
fn read(path: &Path) -> Result<Sweep, String> {
    let name = path.file_name().unwrap().to_str().unwrap();
    let text = fs::read_to_string(path).unwrap();
    Sweep::from_text(name, &text, path.parent().unwrap()).map_err(|error| error.to_string())
}

#[test]
fn good_sweeps_are_accepted_and_read_back_equal() {
    let counts: BTreeMap<String, usize> = sweeps("good")
        .iter()
        .map(|path| {
            let sweep = read(path).unwrap_or_else(|error| panic!("{error}"));
            let folder = tempfile::tempdir().unwrap();
            if let Some(text) = sweep.configuration() {
                fs::write(folder.path().join("configuration.toml"), text).unwrap();
            }
            let again = Sweep::from_text("again", &sweep.to_toml(), folder.path()).unwrap();
            assert_eq!(again.members(), sweep.members());
            assert_eq!(again.to_toml(), sweep.to_toml());
            (path.file_stem().unwrap().to_str().unwrap().to_owned(), sweep.members().len())
        })
        .collect();
    let expected = [("configuration", 4), ("every-key", 72), ("preset", 3)];
    assert_eq!(counts, expected.map(|(name, count)| (name.to_owned(), count)).into());
}

/// Run with `MENISCUS_WRITE_EXPECTED=1` to write the messages down; then read them.
#[test]
fn bad_sweeps_are_refused_with_exactly_their_message() {
    let paths = sweeps("bad");
    assert!(paths.len() >= 30);
    for path in paths {
        let message = read(&path).expect_err(&path.display().to_string());
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!message.ends_with('.'), "{message}");
        let expected = path.with_extension("expected");
        if std::env::var_os("MENISCUS_WRITE_EXPECTED").is_some() {
            fs::write(&expected, format!("{message}\n")).unwrap();
        }
        let expected = fs::read_to_string(&expected).unwrap_or_default();
        assert_eq!(message, expected.trim_end(), "{}", path.display());
    }
}

#[test]
fn members_are_every_combination_with_every_seed_in_order() {
    let sweep =
        read(&sweeps("good").into_iter().find(|path| path.ends_with("every-key.toml")).unwrap()).unwrap();
    let mut expected = Vec::new();
    for length in ["5", "10.5", "inf"] {
        for assignment in ["cic", "tsc"] {
            for repulsion in ["true", "false"] {
                for strengths in ["[1]", "[1, -1]"] {
                    for seed in [7, 1, 9_223_372_036_854_775_807_u64] {
                        expected.push((seed, [length, assignment, repulsion, strengths]));
                    }
                }
            }
        }
    }
    let found = |member: &Member| (member.seed, member.settings.clone());
    let found: Vec<_> = sweep.members().iter().map(found).collect();
    let values =
        |settings: &[Setting]| settings.iter().map(|setting| setting.value.clone()).collect::<Vec<_>>();
    assert_eq!(found.len(), expected.len());
    for ((seed, settings), (expected_seed, expected_values)) in found.iter().zip(expected) {
        assert_eq!((*seed, values(settings)), (expected_seed, expected_values.map(str::to_owned).to_vec()));
    }
    // What a member is, a configuration read with its values as overrides is.
    let member = &sweep.members()[40];
    let overrides = member.settings.iter().map(|setting| format!("{}={}", setting.key, setting.value));
    let overrides: Vec<String> = ["force.method=pm".to_owned(), "time.until=3".to_owned()]
        .into_iter()
        .chain(overrides)
        .chain([format!("seed={}", member.seed)])
        .collect();
    assert_eq!(Configuration::from_preset("fig-5", &overrides).unwrap(), member.configuration);
}
