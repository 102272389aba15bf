//! From a configuration to TOML: complete, commented, and equal when read back.

use std::fmt::Write as _;

use toml_edit::Value;

use super::keys::{KEYS, Key, TABLES};
use super::names::{ASSIGNMENTS, GRADIENTS, INFLUENCES, LATTICES, NOISES, method_word, word};
use super::{Attraction, Configuration, Force, Physical, Start, System};
use crate::files::trajectory::Format;
use crate::strengths::{Strengths, to_number};

/// The whole configuration as TOML.
pub(super) fn to_toml(configuration: &Configuration) -> String {
    let mut text = String::from("# A complete configuration of Meniscus: every key that applies is here.\n");
    for key in KEYS.iter().filter(|key| key.table().is_empty()) {
        write_key(&mut text, configuration, key);
    }
    for table in TABLES {
        let mut inside = String::new();
        for key in KEYS.iter().filter(|key| key.table() == table.name) {
            write_key(&mut inside, configuration, key);
        }
        if !inside.is_empty() {
            // Writing to a String cannot fail.
            let _ = write!(text, "\n# {}\n[{}]\n{inside}", table.help, table.name);
        }
    }
    text
}

/// One key with its comment, if it applies.
fn write_key(text: &mut String, configuration: &Configuration, key: &Key) {
    if let Some(value) = value(configuration, key.name) {
        let _ = writeln!(text, "# {}: {}", key.help, key.accepted());
        if let ("force.accuracy", Some(error)) = (key.name, configuration.estimated_error()) {
            let _ = writeln!(
                text,
                "# Estimated with splitting, cutoff, grid and assignment as below: {error:.1e}"
            );
        }
        let _ = writeln!(text, "{} = {value}", key.leaf());
    }
}

/// The first key, apart from `but`, that one of two configurations has and not the other, or with another value: its
/// name and the values, None where the key does not apply.
pub(super) fn difference(
    one: &Configuration,
    other: &Configuration,
    but: &[&str],
) -> Option<(&'static str, [Option<String>; 2])> {
    let values = |key: &Key| (key.name, [one, other].map(|configuration| value(configuration, key.name)));
    let mut compared = KEYS.iter().filter(|key| !but.contains(&key.name)).map(values);
    compared.find(|(_, [one, other])| one != other)
}

/// The value of a key as TOML; None if the key does not apply.
fn value(configuration: &Configuration, name: &str) -> Option<String> {
    let Configuration { physical, system, force, mesh, fields, motion, start, time, output, .. } =
        configuration;
    match (name, physical, &configuration.strengths) {
        ("system.strengths", None, Strengths::Pattern(pattern))
        | ("physical.strengths", Some(_), Strengths::Pattern(pattern)) => {
            return Some(reals(pattern.iter().copied().map(to_number)));
        }
        _ => {}
    }
    if let Some(leaf) = name.strip_prefix("system.") {
        return if physical.is_none() { system_value(system, leaf) } else { None };
    }
    if let Some(leaf) = name.strip_prefix("physical.") {
        return physical.as_ref().and_then(|physical| physical_value(physical, leaf));
    }
    if let Some(leaf) = name.strip_prefix("start.") {
        return start_value(start, leaf);
    }
    if let (Some(leaf), Force::P3m { accuracy, splitting, cutoff }) = (name.strip_prefix("force."), force) {
        match leaf {
            "accuracy" => return Some(real(*accuracy)),
            "splitting" => return Some(real(*splitting)),
            "cutoff" => return Some(real(*cutoff)),
            _ => {}
        }
    }
    Some(match name {
        "version" => configuration.version.to_string(),
        "seed" => configuration.seed.to_string(),
        "force.method" => quoted(method_word(force.method())),
        "force.mesh_refresh" => real(configuration.mesh_refresh),
        "mesh.grid" => mesh.grid.to_string(),
        "mesh.assignment" => quoted(word(&ASSIGNMENTS, &mesh.assignment)),
        "mesh.influence" => quoted(word(&INFLUENCES, &mesh.influence)),
        "mesh.gradient" => quoted(word(&GRADIENTS, &mesh.gradient)),
        "field.uniform_force" => reals(fields.uniform_force),
        "field.trap_stiffness" => real(fields.trap_stiffness),
        "field.trap_center" => reals(fields.trap_center),
        "motion.noise" => quoted(word(&NOISES, &motion.noise)),
        "motion.max_step" => real(motion.max_step),
        "motion.max_displacement" => real(motion.max_displacement),
        "time.until" => real(time.until),
        "output.observables" => real(output.observables),
        "output.trajectory" => real(output.trajectory),
        "output.trajectory_format" => quoted(word(&Format::WORDS, &output.trajectory_format)),
        "output.snapshots" => real(output.snapshots),
        "output.minkowski" => real(output.minkowski),
        "output.minkowski_spacing" => real(output.minkowski_spacing),
        "output.minkowski_thresholds" => reals(output.minkowski_thresholds.iter().copied()),
        "output.modes" => real(output.modes),
        "output.modes_shells" => output.modes_shells.to_string(),
        "output.radial_distribution" => real(output.radial_distribution),
        "output.structure_factor" => real(output.structure_factor),
        "output.radii" => real(output.radii),
        "output.radii_width" => real(output.radii_width),
        "output.checkpoint_steps" => output.checkpoint_steps.to_string(),
        "output.checkpoint_minutes" => real(output.checkpoint_minutes),
        _ => return None,
    })
}

fn system_value(system: &System, leaf: &str) -> Option<String> {
    Some(match leaf {
        "particles" => system.particles.to_string(),
        "box" => real(system.side),
        "capillary_strength" => real(system.capillary_strength),
        "capillary_length" => real(system.capillary_length),
        "repulsion" => system.repulsion.to_string(),
        _ => return None,
    })
}

fn physical_value(physical: &Physical, leaf: &str) -> Option<String> {
    let (strength, by_force) = match physical.attraction {
        Attraction::Strength(strength) => (Some(strength), None),
        Attraction::Force { force, surface_tension } => (None, Some((force, surface_tension))),
    };
    match leaf {
        "particles" => Some(physical.particles.to_string()),
        "radius" => Some(real(physical.radius)),
        "box" => Some(real(physical.side)),
        "capillary_length" => Some(real(physical.capillary_length)),
        "capillary_strength" => strength.map(real),
        "force" => by_force.map(|(force, _)| real(force)),
        "surface_tension" => by_force.map(|(_, surface_tension)| real(surface_tension)),
        "temperature" => Some(real(physical.temperature)),
        "mobility" => Some(real(physical.mobility)),
        "repulsion" => Some(physical.repulsion.to_string()),
        _ => None,
    }
}

fn start_value(start: &Start, leaf: &str) -> Option<String> {
    match (leaf, start) {
        ("kind", start) => Some(quoted(match start {
            Start::Random => "random",
            Start::Disc { .. } => "disc",
            Start::Rings { .. } => "rings",
            Start::Lattice { .. } => "lattice",
            Start::File { .. } => "file",
        })),
        ("radius", Start::Disc { radius }) => Some(real(*radius)),
        ("rings", Start::Rings { rings, .. }) => Some(rings.to_string()),
        ("spacing", Start::Rings { spacing, .. }) => Some(real(*spacing)),
        ("per_ring", Start::Rings { per_ring, .. }) => Some(per_ring.to_string()),
        ("lattice", Start::Lattice { lattice }) => Some(quoted(word(&LATTICES, lattice))),
        ("path", Start::File { path, .. }) => Some(quoted(&path.to_string_lossy())),
        ("density", Start::File { density, .. }) => density.map(real),
        _ => None,
    }
}

/// The fewest digits that read back to the same number, always a TOML float.
fn real(value: f64) -> String {
    format!("{value:?}")
}

fn reals(values: impl IntoIterator<Item = f64>) -> String {
    let numbers: Vec<String> = values.into_iter().map(real).collect();
    format!("[{}]", numbers.join(", "))
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}
