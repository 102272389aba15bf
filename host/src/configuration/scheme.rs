//! How the capillary force is summed: keys that belong to a method, and what p3m leaves to be chosen.
//!
//! With `p3m` whatever is not given of grid, assignment, splitting and cut-off is chosen so that the estimated
//! error is at most the accuracy, with a margin; what is given is kept. For a configuration that gives all four
//! nothing is chosen, and it need only keep to the accuracy: what was written is read even if estimates change a bit.

use meniscus_core::parameters::{
    GRID_RANGE, Influence, Method, SMALLEST_CUTOFF, SPACING_RANGE, SPLITTING_RANGE,
};

use super::entries::Entries;
use super::error::ConfigurationError;
use super::keys::{Kind, plain};
use super::names::{ASSIGNMENTS, GRADIENTS, INFLUENCES, METHODS, MethodWord, meaning, word};
use super::{Configuration, DEFAULT_ACCURACY, Force, Mesh, default_grid};
use crate::accuracy::{self, Given, Scheme};

/// The method, once keys and words of the other one are refused; those of a file are dropped if the method
/// itself is overridden.
pub(super) fn settle_method(entries: &mut Entries) -> Result<Method, ConfigurationError> {
    let given = entries.text("force.method");
    let [default, ..] = &METHODS;
    let chosen = METHODS.iter().find(|method| Some(method.word) == given).unwrap_or(default);
    let displaced =
        |entries: &Entries, name| entries.is_override("force.method") && !entries.is_override(name);
    for other in METHODS.iter().filter(|other| other.method != chosen.method) {
        for name in other.own.iter().filter(|name| !chosen.own.contains(name)) {
            if displaced(entries, name) {
                entries.forget(name);
            } else if entries.has(name) {
                return Err(ConfigurationError::Conflict {
                    place: entries.place(name),
                    key: (*name).to_owned(),
                    reason: format!(
                        "with force.method = \"{}\": it belongs to force.method = \"{}\"",
                        chosen.word, other.word
                    ),
                });
            }
        }
    }
    for (name, accepted) in [("mesh.influence", chosen.influences), ("mesh.gradient", chosen.gradients)] {
        match entries.text(name) {
            Some(word) if !accepted.contains(&word) => {
                if !displaced(entries, name) {
                    return Err(foreign_word(entries, chosen, name, word, accepted));
                }
                entries.forget(name);
            }
            _ => {}
        }
    }
    Ok(chosen.method)
}

/// The refusal of a word that belongs to another method.
fn foreign_word(
    entries: &Entries,
    chosen: &MethodWord,
    name: &str,
    word: &str,
    accepted: &'static [&'static str],
) -> ConfigurationError {
    let accepts =
        |method: &&MethodWord| method.influences.contains(&word) || method.gradients.contains(&word);
    let owner = METHODS.iter().filter(|method| method.method != chosen.method).find(accepts);
    let owner = owner.map_or("", |owner| owner.word);
    ConfigurationError::Value {
        place: entries.place(name),
        key: name.to_owned(),
        found: format!("\"{word}\""),
        expected: format!(
            "{} with force.method = \"{}\"; \"{word}\" belongs to force.method = \"{owner}\"",
            Kind::Choice(accepted),
            chosen.word
        ),
    }
}

/// Force and mesh as far as they are known before anything is chosen, good enough to check all that is given.
pub(super) fn given_scheme(entries: &Entries, method: Method, side: f64) -> (Force, Mesh) {
    let Given { grid, assignment, splitting, cutoff } = given(entries);
    let assignment = assignment.unwrap_or_default();
    let (force, unless_given) = match method {
        Method::ParticleMesh => (Force::ParticleMesh, default_grid(side)),
        Method::P3m => {
            let force = Force::P3m {
                accuracy: entries.real("force.accuracy").unwrap_or(DEFAULT_ACCURACY),
                splitting: splitting.unwrap_or(SPLITTING_RANGE.0),
                cutoff: cutoff.unwrap_or(SMALLEST_CUTOFF),
            };
            (force, finest_grid(side))
        }
    };
    let influence = match method {
        Method::ParticleMesh => Influence::default(),
        Method::P3m => Influence::Optimal,
    };
    let word = |name| entries.text(name);
    let influence = word("mesh.influence").and_then(|word| meaning(&INFLUENCES, word)).unwrap_or(influence);
    let gradient = word("mesh.gradient").and_then(|word| meaning(&GRADIENTS, word)).unwrap_or_default();
    (force, Mesh { grid: grid.unwrap_or(unless_given), assignment, influence, gradient })
}

/// Chooses what p3m needs and is not given.
///
/// `configuration` holds what [`given_scheme`] made of `entries`, and has been checked.
pub(super) fn choose(
    configuration: &Configuration,
    entries: &Entries,
) -> Result<(Force, Mesh), ConfigurationError> {
    let (Force::P3m { accuracy, .. }, mesh) = (configuration.force, configuration.mesh) else {
        return Ok((configuration.force, configuration.mesh));
    };
    let (given, system) = (given(entries), configuration.force_system());
    let whole = whole(&given).filter(|scheme| accuracy::estimate(&system, scheme).relative() <= accuracy);
    let scheme = match whole {
        Some(scheme) => scheme,
        None => {
            let choice = accuracy::choose(&system, accuracy, &given);
            choice.map_err(|refusal| refused(entries, refusal.to_string()))?.scheme
        }
    };
    let Scheme { grid, assignment, splitting, cutoff } = scheme;
    Ok((Force::P3m { accuracy, splitting, cutoff }, Mesh { grid, assignment, ..mesh }))
}

/// The scheme in one line.
pub(super) fn line(configuration: &Configuration) -> String {
    let Mesh { grid, assignment, influence, gradient } = configuration.mesh;
    let assignment = word(&ASSIGNMENTS, &assignment);
    let Force::P3m { accuracy, splitting, cutoff } = configuration.force else {
        let (influence, gradient) = (word(&INFLUENCES, &influence), word(&GRADIENTS, &gradient));
        let spacing = rounded(configuration.system.side / grid as f64);
        return format!(
            "force: pm: grid {grid} (spacing {spacing} R0), {assignment}, influence {influence}, \
             gradient {gradient}"
        );
    };
    let error = configuration.estimated_error().unwrap_or_default();
    format!(
        "force: p3m, accuracy {accuracy:e} (estimated {error:.1e}): grid {grid}, {assignment}, \
         splitting {}, cutoff {}",
        rounded(splitting),
        rounded(cutoff)
    )
}

/// What a run that holds mesh forces should be told; none if it holds none.
pub(super) fn mesh_refresh_line(configuration: &Configuration) -> Option<String> {
    let distance = configuration.mesh_refresh;
    let consequence = match configuration.force {
        Force::P3m { .. } => "force.accuracy no longer holds",
        Force::ParticleMesh => "the force is less accurate than its scheme",
    };
    (distance > 0.0).then(|| {
        format!(
            "force.mesh_refresh {0}: the force of the mesh is held until a disc has moved {0} R0, and {consequence}; \
             the error of what is held is measured and told at the end",
            plain(distance)
        )
    })
}

/// A number to three digits.
fn rounded(value: f64) -> String {
    format!("{value:.2e}").parse().map_or_else(|_| plain(value), plain)
}

/// What is given of a scheme of p3m.
fn given(entries: &Entries) -> Given {
    Given {
        grid: entries.integer("mesh.grid").and_then(|grid| usize::try_from(grid).ok()),
        assignment: entries.text("mesh.assignment").and_then(|word| meaning(&ASSIGNMENTS, word)),
        splitting: entries.real("force.splitting"),
        cutoff: entries.real("force.cutoff"),
    }
}

/// The scheme, if all of it is given.
fn whole(given: &Given) -> Option<Scheme> {
    let Given { grid, assignment, splitting, cutoff } = *given;
    Some(Scheme { grid: grid?, assignment: assignment?, splitting: splitting?, cutoff: cutoff? })
}

/// The finest grid whose spacing in a box of `side` R0 is allowed; any if there is none.
fn finest_grid(side: f64) -> usize {
    let (least, most) = GRID_RANGE;
    let mut grid = least;
    while grid < most && side / (2 * grid) as f64 >= SPACING_RANGE.0 {
        grid *= 2;
    }
    grid
}

/// The refusal of an accuracy that cannot be had with what is given.
fn refused(entries: &Entries, reason: String) -> ConfigurationError {
    ConfigurationError::Accuracy { place: entries.place("force.accuracy"), reason }
}
