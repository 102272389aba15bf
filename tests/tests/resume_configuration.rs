//! A run goes on only with the configuration of its checkpoint: one value changed in either, and it is refused by its
//! key, apart from the keys that change no step.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use meniscus::checkpoint::store;
use meniscus::configuration::Configuration;
use meniscus::configuration::keys::{KEYS, Key, Kind};
use meniscus::engine::Machinery;
use meniscus::run::{GoldenRequest, Resumed, Run, RunError, Stop};
use meniscus::simulation::Simulation;
use meniscus_tests::directories::fast_folder;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

const SMALL: &str = "version = 1\nseed = 3\n\
    [system]\nparticles = 12\nbox = 24\ncapillary_strength = 10\ncapillary_length = 20\n\
    [force]\nmethod = \"pm\"\nmesh_refresh = 0.1\n[mesh]\ngrid = 16\n[time]\nuntil = 0.5\n\
    [output]\nobservables = 0.01\ntrajectory = 0.023\nsnapshots = 0\ncheckpoint_minutes = 0\n";

/// The keys that change no step.
const FREE: [&str; 3] = ["time.until", "output.checkpoint_steps", "output.checkpoint_minutes"];

type Files = BTreeMap<String, Vec<u8>>;

/// Everything in a directory.
fn files(directory: &Path) -> Files {
    let file =
        |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap());
    fs::read_dir(directory).unwrap().map(|entry| file(entry.unwrap())).collect()
}

/// What a run of [`SMALL`] leaves that is stopped after a few steps.
static STOPPED: LazyLock<Files> = LazyLock::new(|| {
    let folder = fast_folder();
    let directory = folder.path().join("run");
    let configuration = Configuration::from_text("small.toml", SMALL, &[]).unwrap();
    let golden = GoldenRequest::in_directory(&directory);
    let run = Run::create(Simulation::new(configuration).unwrap(), &directory, golden).unwrap();
    run.to_end(|simulation| (simulation.engine.clock().step == 4).then_some(Stop::Interrupted)).unwrap();
    files(&directory)
});

/// The text of the value of `key`, if it is there; and the text with `value` in its place.
fn replaced(text: &str, key: &Key, value: &dyn Fn(Option<&str>) -> String) -> (Option<String>, String) {
    let (mut table, mut old, mut lines) = (String::new(), None, Vec::new());
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            table = name.to_owned();
        }
        match line.split_once(" = ") {
            Some((leaf, found)) if table == key.table() && leaf == key.leaf() => {
                lines.push(format!("{leaf} = {}", value(Some(found))));
                old = Some(found.to_owned());
            }
            _ => lines.push(line.to_owned()),
        }
    }
    if old.is_none() {
        lines.insert(0, format!("{} = {}", key.name, value(None)));
    }
    (old, lines.join("\n") + "\n")
}

/// Values of that kind, most of which are in range.
fn values(kind: Kind) -> BoxedStrategy<String> {
    let number = || prop_oneof![(-6.0..4.0).prop_map(|power| libm::pow(10.0, power)), -20.0..20.0];
    match kind {
        Kind::Whole { least, most } => prop_oneof![least..=most.min(least.saturating_add(99)), least..=most]
            .prop_map(|value| value.to_string())
            .boxed(),
        Kind::PowerOfTwo { least, most } => {
            (least.ilog2()..=most.ilog2()).prop_map(|power| (1_u64 << power).to_string()).boxed()
        }
        Kind::Real { least, most, .. } => prop_oneof![4 => number(), 1 => Just(least), 1 => Just(most)]
            .prop_map(|value| format!("{value:?}"))
            .boxed(),
        Kind::Pair { .. } | Kind::Numbers { .. } => {
            prop::collection::vec(number(), 1..4).prop_map(|values| format!("{values:?}")).boxed()
        }
        Kind::Boolean => any::<bool>().prop_map(|value| value.to_string()).boxed(),
        Kind::Choice(words) => prop::sample::select(words).prop_map(|word| format!("{word:?}")).boxed(),
        Kind::Path => Just("\"discs.csv\"".to_owned()).boxed(),
    }
}

/// Another value of a key; None for the number next to the one that is there.
fn changes() -> impl Strategy<Value = (&'static Key, Option<String>)> {
    // To choose what P3M needs takes seconds without optimisation.
    let keys: Vec<&Key> = KEYS.iter().filter(|key| key.name != "force.method").collect();
    prop::sample::select(keys).prop_flat_map(|key| {
        let value = prop_oneof![3 => values(key.kind).prop_map(Some), 1 => Just(None)];
        (Just(key), value)
    })
}

/// The first number of a value and the next one, if it begins with a number.
fn nudged(value: &str) -> Option<String> {
    let (open, number) = value.strip_prefix('[').map_or(("", value), |rest| ("[", rest));
    let end = number.find([',', ']']).unwrap_or(number.len());
    let (number, rest) = number.split_at(end);
    match number.parse::<u64>() {
        Ok(whole) => Some(format!("{open}{}{rest}", whole + 1)),
        Err(_) => number.parse::<f64>().ok().map(|real| format!("{open}{:?}{rest}", real.next_up())),
    }
}

/// Whether two texts are of the same value of `key`: apart from numbers, each has one text.
fn is_same(key: &Key, one: &str, other: &str) -> bool {
    // Strengths are multiples of this.
    let unit = if key.name == "system.strengths" { 1.0 / 1_048_576.0 } else { 0.0 };
    let settled = |number: f64| if unit > 0.0 { (number / unit).round_ties_even() } else { number };
    let numbers = |text: &str| -> Option<Vec<f64>> {
        let parts = text.trim_matches(['[', ']']).split(", ");
        parts.map(|number| number.parse().ok().map(settled)).collect()
    };
    one == other || numbers(one).is_some_and(|one| numbers(other) == Some(one))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn another_value_is_refused_by_its_key((key, value) in changes(), in_checkpoint: bool) {
        let folder = fast_folder();
        let directory = folder.path();
        STOPPED.iter().for_each(|(name, bytes)| fs::write(directory.join(name), bytes).unwrap());
        let mut checkpoint = store::latest(directory).unwrap().checkpoint;
        let (step, text) = (checkpoint.step(), checkpoint.configuration.clone());
        prop_assert_eq!(text.as_bytes(), STOPPED["config.toml"].as_slice());
        let put = |old: Option<&str>| {
            let nudged = || old.and_then(nudged).unwrap_or_else(|| "1".to_owned());
            value.clone().unwrap_or_else(nudged)
        };
        let (old, text) = replaced(&text, key, &put);
        let new = put(old.as_deref());
        if in_checkpoint {
            checkpoint.configuration = text.clone();
            store::store(directory, &checkpoint).unwrap();
        } else {
            fs::write(directory.join("config.toml"), &text).unwrap();
        }
        let before = files(directory);

        let is_free = FREE.contains(&key.name);
        let is_same = old.as_deref().is_some_and(|old| is_same(key, old, &new));
        let reads = Configuration::from_text("changed", &text, &[]).is_ok();
        let told = format!("{} = {new}, before {old:?}, in the checkpoint: {in_checkpoint}", key.name);
        match Run::resume(directory, Machinery::default(), None) {
            Ok(Resumed::Ready { run, warnings }) => {
                prop_assert!(reads && (is_free || is_same), "{} is accepted", told);
                prop_assert_eq!(run.simulation().engine.clock().step, step);
                prop_assert!(warnings.is_empty(), "{:?}", warnings);
            }
            Ok(Resumed::Finished(_)) => panic!("it has not finished"),
            Err(error) => {
                prop_assert!(!is_same, "{} is refused: {}", told, error);
                match &error {
                    RunError::Configuration(_) => prop_assert!(!reads, "{}: {}", told, error),
                    RunError::Mismatch { key: named, .. } => {
                        prop_assert!(!is_free && *named == key.name, "{}: {}", told, error);
                    }
                    RunError::Past { .. } => prop_assert_eq!(key.name, "time.until"),
                    _ => prop_assert!(false, "{}: {}", told, error),
                }
                prop_assert_eq!(error.to_string().lines().count(), 1);
                prop_assert!(files(directory) == before, "{}: something was changed", told);
            }
        }
    }
}
