//! What must hold between the keys of a configuration, once each is in its own range.

use core::f64::consts::PI;

use meniscus_core::fields::LARGEST_FIELD_FORCE;
use meniscus_core::parameters::{
    LARGEST_CAPILLARY_STRENGTH, LARGEST_SPLITTING_OF_SPACING, MESH_REFRESH_RANGE, ParameterError,
    SPACING_RANGE,
};

use crate::accuracy::rounded_down;

use super::entries::Entries;
use super::error::ConfigurationError;
use super::keys::{key, plain};
use super::{Attraction, Configuration, Fields, Output, Start};
use crate::strengths::to_number;

/// Largest fraction of an area that discs placed at random without overlap may cover: random
/// sequential addition jams at 0.547, and slows down long before.
pub(super) const LARGEST_RANDOM_COVERAGE: f64 = 0.5;

/// Latest end of a run, R0²/D: time is held in 64 bits in units of 2⁻⁴⁰ R0²/D.
pub(super) const LATEST_TIME: f64 = 16_777_216.0;

/// Cells of the density's grid along the box, for Minkowski functionals: with fewer there is no region that ends.
const FEWEST_CELLS: f64 = 4.0;
/// With more they take gigabytes.
const MOST_CELLS: f64 = 8192.0;

/// Refuses a configuration whose keys do not go together; `entries` knows their places.
pub(super) fn check(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    check_parameters(configuration, entries)?;
    check_strengths(configuration, entries)?;
    check_time_unit(configuration, entries)?;
    check_start(configuration, entries)?;
    check_series(configuration, entries)?;
    check_end(configuration, entries)
}

/// A refusal of one key.
fn refusal(
    entries: &Entries,
    key: &str,
    found: impl Into<String>,
    expected: impl Into<String>,
) -> ConfigurationError {
    ConfigurationError::Value {
        place: entries.place(key),
        key: key.to_owned(),
        found: found.into(),
        expected: expected.into(),
    }
}

/// A derived number to six digits.
fn rounded(value: f64) -> String {
    format!("{value:.5e}").parse().map_or_else(|_| plain(value), plain)
}

/// Asks the core.
pub(super) fn check_parameters(
    configuration: &Configuration,
    entries: &Entries,
) -> Result<(), ConfigurationError> {
    let parameters = configuration.parameters();
    let Err(error) = parameters.validate() else { return Ok(()) };
    let system = &configuration.system;
    let of_system = |leaf: &str, value: f64, unit: &str| {
        let reduced = format!("system.{leaf}");
        let expected = key(&reduced).map_or_else(String::new, |key| key.accepted());
        let Some(physical) = &configuration.physical else {
            return refusal(entries, &reduced, plain(value), expected);
        };
        let mut name = format!("physical.{leaf}");
        if let (Attraction::Force { .. }, "capillary_strength") = (physical.attraction, leaf) {
            name = "physical.force".to_owned();
        }
        let given = entries.real(&name).map_or_else(String::new, plain);
        let given_unit = key(&name).map_or("", |key| key.unit);
        let found = format!("{given} {given_unit}, which makes {} {unit}", rounded(value));
        refusal(entries, &name, found, expected)
    };
    let of_grid = || {
        let (finest, coarsest) = SPACING_RANGE;
        let grid = configuration.mesh.grid;
        refusal(
            entries,
            "mesh.grid",
            format!("{grid} nodes over {} R0", rounded(system.side)),
            format!("a spacing of {} to {} R0", plain(finest), plain(coarsest)),
        )
    };
    let of_key = |name: &str, found: String| {
        refusal(entries, name, found, key(name).map_or_else(String::new, |key| key.accepted()))
    };
    Err(match error {
        ParameterError::Side | ParameterError::SideTooLarge | ParameterError::SideTooSmall => {
            of_system("box", system.side, "R0")
        }
        ParameterError::CapillaryStrength => {
            of_system("capillary_strength", system.capillary_strength, "kBT")
        }
        ParameterError::CapillaryLength => of_system("capillary_length", system.capillary_length, "R0"),
        ParameterError::Grid => of_key("mesh.grid", configuration.mesh.grid.to_string()),
        ParameterError::GridTooCoarse | ParameterError::GridTooFine => of_grid(),
        ParameterError::Splitting => of_key("force.splitting", plain(parameters.splitting)),
        ParameterError::SplittingTooLarge => {
            let spacing = system.side / configuration.mesh.grid as f64;
            let found =
                format!("{} with a mesh spacing of {} R0", plain(parameters.splitting), rounded(spacing));
            let most = rounded_down(LARGEST_SPLITTING_OF_SPACING / spacing, 6);
            refusal(
                entries,
                "force.splitting",
                found,
                format!("at most {most}, {} over the spacing", plain(LARGEST_SPLITTING_OF_SPACING)),
            )
        }
        ParameterError::Cutoff => of_key("force.cutoff", plain(parameters.cutoff)),
        ParameterError::CutoffTooLarge => refusal(
            entries,
            "force.cutoff",
            plain(parameters.cutoff),
            format!("a cut-off below half the box, {} R0", rounded(system.side / 2.0)),
        ),
        ParameterError::MeshRefresh => refusal(
            entries,
            "force.mesh_refresh",
            plain(parameters.mesh_refresh),
            format!(
                "0, or a number from {} to {}, in R0",
                plain(MESH_REFRESH_RANGE.0),
                plain(MESH_REFRESH_RANGE.1)
            ),
        ),
        ParameterError::MeshRefreshTooLarge => refusal(
            entries,
            "force.mesh_refresh",
            plain(parameters.mesh_refresh),
            format!("a distance below a quarter of the box, {} R0", rounded(system.side / 4.0)),
        ),
        ParameterError::Influence => of_key("mesh.influence", format!("{:?}", parameters.influence)),
        ParameterError::Gradient => of_key("mesh.gradient", format!("{:?}", parameters.gradient)),
        ParameterError::Fields => of_fields(&configuration.fields, system.side, entries),
        ParameterError::MaxStep => of_key("motion.max_step", plain(configuration.motion.max_step)),
        ParameterError::MaxDisplacement => {
            of_key("motion.max_displacement", plain(configuration.motion.max_displacement))
        }
        ParameterError::Seed => of_key("seed", configuration.seed.to_string()),
    })
}

/// External fields that go out of their range together, or with the box.
fn of_fields(fields: &Fields, side: f64, entries: &Entries) -> ConfigurationError {
    let Fields { uniform_force: [x, y], trap_stiffness, trap_center } = *fields;
    let outside = trap_center.into_iter().find(|center| !(*center >= 0.0 && *center <= side));
    if let Some(center) = outside.filter(|_| trap_stiffness > 0.0) {
        let expected = format!("a centre in the box, 0 to {} R0", rounded(side));
        return refusal(entries, "field.trap_center", plain(center), expected);
    }
    let largest = x.abs().max(y.abs()) + trap_stiffness * 0.5 * side;
    refusal(
        entries,
        "field.trap_stiffness",
        format!(
            "{}, which with the uniform force makes {} kBT/R0 half a box away",
            plain(trap_stiffness),
            rounded(largest)
        ),
        format!("at most {} kBT/R0 there", plain(LARGEST_FIELD_FORCE)),
    )
}

/// No two discs may attract each other more than the engine can sum.
fn check_strengths(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    let capillary_strength = configuration.system.capillary_strength;
    let coupling = |strength: f64| capillary_strength * strength * strength;
    let strengths = configuration.strengths.repeated().iter().map(|&strength| to_number(strength));
    let Some(strength) =
        strengths.into_iter().find(|&strength| coupling(strength) > LARGEST_CAPILLARY_STRENGTH)
    else {
        return Ok(());
    };
    let table = if configuration.physical.is_some() { "physical" } else { "system" };
    Err(refusal(
        entries,
        &format!("{table}.strengths"),
        format!("f = {}, which makes V0*f^2 = {} kBT", plain(strength), rounded(coupling(strength))),
        format!("V0*f^2 of at most {} kBT", plain(LARGEST_CAPILLARY_STRENGTH)),
    ))
}

/// The unit of time must be a number of seconds.
fn check_time_unit(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    let Some(seconds) = configuration.seconds_per_time_unit() else { return Ok(()) };
    if seconds.is_finite() && seconds > 0.0 {
        return Ok(());
    }
    Err(refusal(
        entries,
        "physical.mobility",
        format!("a unit of time R0^2/(kBT*Gamma) of {} s", rounded(seconds)),
        "radius, temperature and mobility that give a finite one",
    ))
}

/// The discs must fit where they start.
fn check_start(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    let system = &configuration.system;
    let table = if configuration.physical.is_some() { "physical" } else { "system" };
    let particles_key = format!("{table}.particles");
    let count = system.particles as f64;
    let crowded = |coverage: f64, place: &str, most: f64| {
        refusal(
            entries,
            &particles_key,
            format!("{} discs, which cover {coverage:.3} of {place}", system.particles),
            format!(
                "a coverage of at most {LARGEST_RANDOM_COVERAGE} ({} discs) to place them at random without \
                 overlap",
                most.floor()
            ),
        )
    };
    let beyond_box = |name: &str, radius: f64, relation: &str| {
        refusal(
            entries,
            name,
            format!("a patch of radius {} R0", rounded(radius)),
            format!("one {relation} half the box, {} R0", rounded(system.side / 2.0)),
        )
    };
    match configuration.start {
        Start::Random => {
            let area = system.side * system.side;
            let coverage = PI * count / area;
            if coverage > LARGEST_RANDOM_COVERAGE {
                return Err(crowded(coverage, "the box", LARGEST_RANDOM_COVERAGE * area / PI));
            }
        }
        Start::Disc { radius } => {
            if radius > system.side / 2.0 {
                return Err(beyond_box("start.radius", radius, "of at most"));
            }
            // Centres lie within the radius, so discs cover one R0 more.
            let reach_squared = (radius + 1.0) * (radius + 1.0);
            let coverage = count / reach_squared;
            if coverage > LARGEST_RANDOM_COVERAGE {
                return Err(crowded(coverage, "the disc", LARGEST_RANDOM_COVERAGE * reach_squared));
            }
        }
        Start::Rings { rings, spacing, per_ring } => {
            let right = 1 + u128::from(per_ring) * (u128::from(rings) * (u128::from(rings) + 1) / 2);
            if system.particles as u128 != right {
                let found = system.particles.to_string();
                let expected =
                    format!("{right}, the number in {rings} rings of {per_ring}*n discs and the central one");
                return Err(refusal(entries, &particles_key, found, expected));
            }
            let radius = f64::from(rings) * spacing;
            if radius >= system.side / 2.0 {
                return Err(beyond_box("start.spacing", radius, "below"));
            }
        }
        Start::Lattice { .. } | Start::File { .. } => {}
    }
    Ok(())
}

/// What the series in the output need must be there.
fn check_series(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    let Output { minkowski, minkowski_spacing, minkowski_thresholds: thresholds, radii, .. } =
        &configuration.output;
    if let Some([below, above]) = thresholds.array_windows().find(|[below, above]| below >= above) {
        let found = format!("{} after {}", plain(*above), plain(*below));
        return Err(refusal(entries, "output.minkowski_thresholds", found, "increasing numbers"));
    }
    let side = configuration.system.side;
    let [finest, coarsest] = [MOST_CELLS, FEWEST_CELLS].map(|cells| side / cells);
    if *minkowski > 0.0 && !(finest..=coarsest).contains(minkowski_spacing) {
        return Err(refusal(
            entries,
            "output.minkowski_spacing",
            plain(*minkowski_spacing),
            format!(
                "a spacing of {} to {}, {FEWEST_CELLS} to {MOST_CELLS} cells along the box",
                rounded(finest),
                rounded(coarsest)
            ),
        ));
    }
    if *radii > 0.0 && matches!(configuration.start, Start::Random | Start::Lattice { .. }) {
        return Err(refusal(
            entries,
            "output.radii",
            format!("{} with a start that fills the box", plain(*radii)),
            "0, or start.kind = \"disc\", \"rings\" or \"file\", a patch whose radii can be followed",
        ));
    }
    Ok(())
}

/// The end must be a time that can be held.
fn check_end(configuration: &Configuration, entries: &Entries) -> Result<(), ConfigurationError> {
    if configuration.end_time() <= LATEST_TIME {
        return Ok(());
    }
    let found = match configuration.jeans_time() {
        Some(jeans_time) => {
            format!("{} Jeans' times of {} R0^2/D", plain(configuration.time.until), rounded(jeans_time))
        }
        None => plain(configuration.time.until),
    };
    Err(refusal(entries, "time.until", found, format!("an end by {LATEST_TIME} R0^2/D")))
}
