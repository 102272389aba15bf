//! From checked values to a configuration: required keys, defaults and keys that exclude each other.

use core::f64::consts::TAU;
use std::path::PathBuf;

use super::checks::{check, check_parameters};
use super::entries::Entries;
use super::error::ConfigurationError;
use super::keys::key;
use super::names::{LATTICES, NOISES, STARTS, StartWord, meaning};
use super::scheme::{choose, given_scheme, settle_method};
use super::{
    Attraction, Configuration, DEFAULT_DIFFUSION_TIMES, DEFAULT_JEANS_TIMES, FEWEST_SHELLS, Fields,
    MOST_SHELLS, Motion, Output, Physical, Start, System, Time, VERSION,
};
use crate::files::trajectory::Format;
use crate::strengths::{Strengths, from_number};

/// A configuration from checked values.
pub(super) fn assemble(mut entries: Entries) -> Result<Configuration, ConfigurationError> {
    refuse_both_units(&entries)?;
    settle_attraction(&mut entries)?;
    let method = settle_method(&mut entries)?;
    let start_word = settle_start(&mut entries)?;
    refuse_missing(&entries, start_word)?;
    let physical = entries.table("physical").is_some().then(|| physical(&entries));
    let system = physical.map_or_else(|| system(&entries), |physical| physical.reduced());
    let (force, mesh) = given_scheme(&entries, method, system.side);
    let mut configuration = Configuration {
        version: VERSION,
        seed: entries.integer("seed").unwrap_or(1),
        physical,
        system,
        strengths: strengths(&entries),
        force,
        mesh_refresh: entries.real("force.mesh_refresh").unwrap_or_default(),
        mesh,
        fields: fields(&entries, system.side),
        motion: motion(&entries),
        start: start(&entries, start_word.word),
        time: Time { until: 0.0 },
        output: output(&entries),
    };
    configuration.output.modes_shells = modes_shells(&entries, &configuration);
    configuration.time = time(&entries, configuration.attraction() > 0.0);
    check(&configuration, &entries)?;
    (configuration.force, configuration.mesh) = choose(&configuration, &entries)?;
    check_parameters(&configuration, &entries)?;
    Ok(configuration)
}

/// Refuses a system given twice.
fn refuse_both_units(entries: &Entries) -> Result<(), ConfigurationError> {
    let (Some(_), Some(place)) = (entries.table("system"), entries.table("physical")) else {
        return Ok(());
    };
    Err(ConfigurationError::Conflict {
        place: place.clone(),
        key: "physical".to_owned(),
        reason: "together with `system`: give the system in R0 and kBT as `system`, or in SI as `physical`"
            .to_owned(),
    })
}

const STRENGTH: &str = "physical.capillary_strength";
const BY_FORCE: [&str; 2] = ["physical.force", "physical.surface_tension"];

/// Leaves one way of giving the attraction in SI: an override displaces what a file says another way.
fn settle_attraction(entries: &mut Entries) -> Result<(), ConfigurationError> {
    for name in BY_FORCE {
        if entries.is_override(STRENGTH) && !entries.is_override(name) {
            entries.forget(name);
        }
    }
    if !entries.is_override(STRENGTH) && BY_FORCE.iter().any(|name| entries.is_override(name)) {
        entries.forget(STRENGTH);
    }
    match BY_FORCE.iter().find(|name| entries.has(name)) {
        Some(name) if entries.has(STRENGTH) => Err(ConfigurationError::Conflict {
            place: entries.place(name),
            key: (*name).to_owned(),
            reason: "together with `physical.capillary_strength`: V0 follows from force and surface_tension"
                .to_owned(),
        }),
        _ => Ok(()),
    }
}

/// The kind of start, once keys of other kinds are refused; those of a file are dropped if the kind
/// itself is overridden.
fn settle_start(entries: &mut Entries) -> Result<&'static StartWord, ConfigurationError> {
    let given = entries.text("start.kind");
    let [random, ..] = &STARTS;
    let chosen = STARTS.iter().find(|start| Some(start.word) == given).unwrap_or(random);
    let owns = |start: &StartWord, name| start.required.contains(&name) || start.optional.contains(&name);
    for owner in &STARTS {
        for name in owner.required.iter().chain(owner.optional) {
            if owns(chosen, name) || !entries.has(name) {
                continue;
            }
            if entries.is_override("start.kind") && !entries.is_override(name) {
                entries.forget(name);
                continue;
            }
            return Err(ConfigurationError::Conflict {
                place: entries.place(name),
                key: (*name).to_owned(),
                reason: format!(
                    "with start.kind = \"{}\": it belongs to start.kind = \"{}\"",
                    chosen.word, owner.word
                ),
            });
        }
    }
    Ok(chosen)
}

/// Refuses a configuration that lacks a required key, naming all it lacks.
fn refuse_missing(entries: &Entries, start: &StartWord) -> Result<(), ConfigurationError> {
    let mut required = vec!["version"];
    if entries.table("physical").is_some() {
        required.extend(["physical.particles", "physical.radius", "physical.box"]);
        if BY_FORCE.iter().any(|name| entries.has(name)) {
            required.extend(BY_FORCE);
        } else {
            required.push(STRENGTH);
        }
        if entries.real(STRENGTH) != Some(0.0) {
            required.push("physical.capillary_length");
        }
        required.extend(["physical.temperature", "physical.mobility"]);
    } else {
        required.extend(["system.particles", "system.box", "system.capillary_strength"]);
        if entries.real("system.capillary_strength") != Some(0.0) {
            required.push("system.capillary_length");
        }
    }
    required.extend(start.required);
    required.retain(|name| !entries.has(name));
    if required.is_empty() {
        return Ok(());
    }
    let described = |name: &&str| {
        key(name).map_or_else(String::new, |key| format!("`{}` ({}: {})", key.name, key.help, key.accepted()))
    };
    let mut keys = required.iter().map(described).collect::<Vec<_>>().join(", ");
    if entries.table("system").is_none() && entries.table("physical").is_none() {
        keys.push_str("; or the system in SI, as `physical`");
    }
    Err(ConfigurationError::Missing { place: entries.whole(), keys })
}

// Below, required keys are there: their defaults are never used.

fn system(entries: &Entries) -> System {
    System {
        particles: count(entries, "system.particles"),
        side: entries.real("system.box").unwrap_or_default(),
        capillary_strength: entries.real("system.capillary_strength").unwrap_or_default(),
        capillary_length: entries.real("system.capillary_length").unwrap_or(f64::INFINITY),
        repulsion: entries.boolean("system.repulsion").unwrap_or(true),
    }
}

fn physical(entries: &Entries) -> Physical {
    let [force, surface_tension] = BY_FORCE.map(|name| entries.real(name));
    let attraction = match (force, surface_tension) {
        (Some(force), Some(surface_tension)) => Attraction::Force { force, surface_tension },
        _ => Attraction::Strength(entries.real(STRENGTH).unwrap_or_default()),
    };
    Physical {
        particles: count(entries, "physical.particles"),
        radius: entries.real("physical.radius").unwrap_or_default(),
        side: entries.real("physical.box").unwrap_or_default(),
        capillary_length: entries.real("physical.capillary_length").unwrap_or(f64::INFINITY),
        attraction,
        temperature: entries.real("physical.temperature").unwrap_or_default(),
        mobility: entries.real("physical.mobility").unwrap_or_default(),
        repulsion: entries.boolean("physical.repulsion").unwrap_or(true),
    }
}

fn strengths(entries: &Entries) -> Strengths {
    let given = entries.numbers("system.strengths").or_else(|| entries.numbers("physical.strengths"));
    let pattern = given.map(|numbers| numbers.iter().copied().filter_map(from_number).collect());
    pattern.map_or_else(Strengths::default, Strengths::Pattern)
}

fn fields(entries: &Entries, side: f64) -> Fields {
    Fields {
        uniform_force: entries.pair("field.uniform_force").unwrap_or_default(),
        trap_stiffness: entries.real("field.trap_stiffness").unwrap_or_default(),
        trap_center: entries.pair("field.trap_center").unwrap_or([side / 2.0; 2]),
    }
}

fn motion(entries: &Entries) -> Motion {
    let Motion { noise, max_step, max_displacement } = Motion::default();
    Motion {
        noise: choice(entries, "motion.noise", &NOISES).unwrap_or(noise),
        max_step: entries.real("motion.max_step").unwrap_or(max_step),
        max_displacement: entries.real("motion.max_displacement").unwrap_or(max_displacement),
    }
}

fn start(entries: &Entries, word: &str) -> Start {
    let small = |name| entries.integer(name).and_then(|value| u32::try_from(value).ok()).unwrap_or_default();
    let length = |name| entries.real(name).unwrap_or_default();
    match word {
        "disc" => Start::Disc { radius: length("start.radius") },
        "rings" => Start::Rings {
            rings: small("start.rings"),
            spacing: length("start.spacing"),
            per_ring: small("start.per_ring"),
        },
        "lattice" => {
            Start::Lattice { lattice: choice(entries, "start.lattice", &LATTICES).unwrap_or_default() }
        }
        "file" => Start::File {
            path: PathBuf::from(entries.text("start.path").unwrap_or_default()),
            density: entries.real("start.density"),
        },
        _ => Start::Random,
    }
}

fn time(entries: &Entries, attracted: bool) -> Time {
    let default = if attracted { DEFAULT_JEANS_TIMES } else { DEFAULT_DIFFUSION_TIMES };
    Time { until: entries.real("time.until").unwrap_or(default) }
}

fn output(entries: &Entries) -> Output {
    let default = Output::default();
    let real = |name, default| entries.real(name).unwrap_or(default);
    Output {
        observables: real("output.observables", default.observables),
        trajectory: real("output.trajectory", default.trajectory),
        trajectory_format: choice(entries, "output.trajectory_format", &Format::WORDS)
            .unwrap_or(default.trajectory_format),
        snapshots: real("output.snapshots", default.snapshots),
        minkowski: real("output.minkowski", default.minkowski),
        minkowski_spacing: real("output.minkowski_spacing", default.minkowski_spacing),
        minkowski_thresholds: entries
            .numbers("output.minkowski_thresholds")
            .map_or(default.minkowski_thresholds, <[f64]>::to_vec),
        modes: real("output.modes", default.modes),
        modes_shells: default.modes_shells,
        radial_distribution: real("output.radial_distribution", default.radial_distribution),
        structure_factor: real("output.structure_factor", default.structure_factor),
        radii: real("output.radii", default.radii),
        radii_width: real("output.radii_width", default.radii_width),
        checkpoint_steps: entries.integer("output.checkpoint_steps").unwrap_or(default.checkpoint_steps),
        checkpoint_minutes: real("output.checkpoint_minutes", default.checkpoint_minutes),
    }
}

/// The shells of modes: as many as given, or those that grow.
fn modes_shells(entries: &Entries, configuration: &Configuration) -> u32 {
    if let Some(given) = entries.integer("output.modes_shells").and_then(|shells| u32::try_from(shells).ok())
    {
        return given;
    }
    let critical = configuration.instability().and_then(|instability| instability.critical_wavenumber());
    let below = critical.map_or(0.0, |critical| critical * configuration.system.side / TAU);
    (below as u32).clamp(FEWEST_SHELLS, MOST_SHELLS)
}

fn count(entries: &Entries, name: &str) -> usize {
    entries.integer(name).and_then(|value| usize::try_from(value).ok()).unwrap_or_default()
}

fn choice<T: Copy>(entries: &Entries, name: &str, words: &[(&'static str, T)]) -> Option<T> {
    entries.text(name).and_then(|word| meaning(words, word))
}
