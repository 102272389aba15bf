//! Every key of the table of keys with every kind of mistake, each refused with one exact line:
//! `tests/configs/every-key.txt`. A key that is added to the table is asked for here of itself.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::configuration::Configuration;
use meniscus::configuration::keys::{KEYS, Key, Kind};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Keys and values that make a configuration in which `key` has a place.
fn neighbours(key: &Key) -> Vec<(&'static str, &'static str)> {
    let mut all = vec![("version", "1"), ("seed", "7")];
    if key.table() == "physical" {
        all.extend([
            ("physical.particles", "60"),
            ("physical.radius", "1e-5"),
            ("physical.box", "4.8e-4"),
            ("physical.capillary_length", "3e-4"),
            ("physical.temperature", "293"),
            ("physical.mobility", "1e7"),
        ]);
        if matches!(key.leaf(), "force" | "surface_tension") {
            all.extend([("physical.force", "1e-10"), ("physical.surface_tension", "0.07")]);
        } else {
            all.push(("physical.capillary_strength", "10"));
        }
    } else {
        all.extend([
            ("system.particles", "61"),
            ("system.box", "48"),
            ("system.capillary_strength", "10"),
            ("system.capillary_length", "30"),
        ]);
    }
    if matches!(key.name, "force.accuracy" | "force.splitting" | "force.cutoff") {
        all.push(("force.method", "\"p3m\""));
    } else {
        all.push(("force.method", "\"pm\""));
    }
    if key.name == "field.trap_center" {
        all.push(("field.trap_stiffness", "0.1"));
    }
    if key.name == "output.radii" {
        all.extend([("start.kind", "\"disc\""), ("start.radius", "20")]);
    }
    all.extend(match key.leaf() {
        _ if key.table() != "start" => vec![],
        "radius" => vec![("start.kind", "\"disc\""), ("start.radius", "20")],
        "rings" | "spacing" | "per_ring" => vec![
            ("start.kind", "\"rings\""),
            ("start.rings", "4"),
            ("start.spacing", "3"),
            ("start.per_ring", "6"),
        ],
        "lattice" => vec![("start.kind", "\"lattice\"")],
        "path" | "density" => vec![("start.kind", "\"file\""), ("start.path", "\"discs.csv\"")],
        _ => vec![],
    });
    all
}

/// The text with `lines` in the place of the key.
fn text(key: &Key, lines: &[String]) -> String {
    let mut text = String::new();
    for (name, value) in neighbours(key).into_iter().filter(|(name, _)| *name != key.name) {
        writeln!(text, "{name} = {value}").unwrap();
    }
    lines.iter().for_each(|line| writeln!(text, "{line}").unwrap());
    text
}

/// A value that the key accepts.
fn good(key: &Key) -> String {
    let usual = neighbours(key).into_iter().find(|(name, _)| *name == key.name);
    if let Some((_, value)) = usual {
        return value.to_owned();
    }
    match key.kind {
        Kind::Whole { least, .. } => least.max(1).to_string(),
        Kind::PowerOfTwo { .. } => "64".to_owned(),
        Kind::Real { least, most, .. } => {
            let value = if most.is_finite() { most / 2.0 } else { least.max(1.0) };
            format!("{value:?}")
        }
        Kind::Pair { .. } => "[1.0, 2.0]".to_owned(),
        Kind::Numbers { .. } => "[1.0]".to_owned(),
        Kind::Boolean => "true".to_owned(),
        Kind::Choice(words) => format!("\"{}\"", words[0]),
        Kind::Path => "\"discs.csv\"".to_owned(),
    }
}

/// Values that no key of this kind accepts: of another type, out of its range, no numbers, absurdly large.
fn bad(kind: Kind) -> Vec<String> {
    let mut values: Vec<String> = ["{}", "[[]]", "2026-11-22", "[\"a\", \"b\"]"].map(str::to_owned).to_vec();
    let below = |least: f64| {
        if least.is_finite() { Some(format!("{:?}", least - least.abs().max(1.0))) } else { None }
    };
    match kind {
        Kind::Whole { least, most } => {
            values.extend(["\"many\"", "true", "1.5", "nan", "inf", "-1", "1e3"].map(str::to_owned));
            values.extend(least.checked_sub(1).map(|value| value.to_string()));
            values.extend(most.checked_add(1).map(|value| value.to_string()));
            // Beyond the whole numbers of TOML.
            values.push((1_u64 << 63).to_string());
        }
        Kind::PowerOfTwo { least, most } => {
            values.extend(["\"many\"", "true", "1.5", "nan", "inf", "-1", "0", "100"].map(str::to_owned));
            values.extend([least / 2, most * 2, 1 << 62].map(|value| value.to_string()));
        }
        Kind::Real { least, closed, most, infinite } => {
            values.extend(["\"much\"", "true", "nan", "-inf", "[1.0]"].map(str::to_owned));
            values.extend(below(least));
            values.extend((!closed && least.is_finite()).then(|| format!("{least:?}")));
            if most.is_finite() {
                values.push(format!("{:?}", 2.0 * most));
                values.push("1e300".to_owned());
            }
            values.extend((!infinite).then(|| "inf".to_owned()));
        }
        Kind::Pair { least, most } | Kind::Numbers { least, most } => {
            values.extend(["\"both\"", "1.0", "[]", "[1.0, nan]", "[inf, 1.0]"].map(str::to_owned));
            values.extend(below(least).map(|value| format!("[1.0, {value}]")));
            values.push(format!("[1.0, {:?}]", 2.0 * most));
            if matches!(kind, Kind::Pair { .. }) {
                values.extend(["[1.0]", "[1.0, 1.0, 1.0]"].map(str::to_owned));
            }
        }
        Kind::Boolean => values.extend(["1", "\"true\"", "nan"].map(str::to_owned)),
        Kind::Choice(_) => values.extend(["1", "true", "\"\"", "\"nonsense\"", "nan"].map(str::to_owned)),
        Kind::Path => values.extend(["1", "true", "\"\"", "nan"].map(str::to_owned)),
    }
    values.dedup();
    values
}

/// Every mistake with the key: the lines that make it.
fn mistakes(key: &Key) -> Vec<Vec<String>> {
    let (name, good) = (key.name, good(key));
    let mut all: Vec<Vec<String>> =
        bad(key.kind).into_iter().map(|value| vec![format!("{name} = {value}")]).collect();
    let line = format!("{name} = {good}");
    all.push(vec![line.clone(), line]);
    all.push(vec![format!("{name}{} = {good}", &name[name.len() - 1..])]);
    all.push(vec![format!("{name}.more = {good}")]);
    all
}

fn refusal(key: &Key, lines: &[String]) -> String {
    let read = Configuration::from_text("file", &text(key, lines), &[]);
    assert!(read.is_err(), "{lines:?} is accepted");
    let message = read.err().unwrap().to_string();
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(!message.contains(char::is_control), "{message}");
    // A key that is required is missed when it is misspelt or only a table.
    let leaf = key.leaf();
    assert!(message.contains(leaf) || message.contains("not valid TOML"), "{lines:?}: {message}");
    message
}

#[test]
fn what_the_mistakes_are_made_of_is_accepted() {
    // What is chosen for p3m takes seconds without optimisation.
    for key in KEYS.iter().filter(|key| !matches!(key.name, "force.splitting" | "force.cutoff")) {
        let text = text(key, &[format!("{} = {}", key.name, good(key))]);
        if let Err(error) = Configuration::from_text("file", &text, &[]) {
            panic!("{}: {error}\n{text}", key.name);
        }
    }
}

/// Run with `MENISCUS_WRITE_EXPECTED=1` to write the table down; then read it.
#[test]
fn every_mistake_with_every_key_is_refused_with_exactly_its_line() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/every-key.txt");
    let mut table = String::new();
    for key in KEYS {
        for lines in mistakes(key) {
            writeln!(table, "{}\n    {}", lines.join("; "), refusal(key, &lines)).unwrap();
        }
    }
    if std::env::var_os("MENISCUS_WRITE_EXPECTED").is_some() {
        fs::write(&path, &table).unwrap();
    }
    let expected = fs::read_to_string(&path).unwrap_or_default();
    for (found, expected) in table.lines().zip(expected.lines()) {
        assert_eq!(found, expected);
    }
    assert_eq!(table.lines().count(), expected.lines().count());
}
