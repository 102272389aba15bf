//! Radii in mean-field theory beside those of runs.

use super::Group;
use crate::configuration::{Configuration, Start};
use crate::figures::chart::{Colour, Dash, Series as Drawn};
use crate::reproduce::statistics::{Curve, interpolated};
use crate::simulation::torus;
use crate::start;
use crate::theory::Pressure;
use crate::theory::patch::Patch;
use crate::theory::shells::{Shell, Shells};
use meniscus_core::torus::Position;

/// Discs in a shell of a random patch.
const DISCS_PER_SHELL: f64 = 3.5;

/// Rows of a curve in a T.
const ROWS: f64 = 100.0;

/// The times of a curve, t/T: as far as a run goes.
fn times(configuration: &Configuration) -> impl Iterator<Item = f64> {
    let rows = libm::ceil(ROWS * configuration.time.until) as u32;
    (0..=rows).map(|row| f64::from(row) / ROWS)
}

/// The shells of a configuration's rings.
fn shells(configuration: &Configuration, surroundings: Surroundings) -> Option<Shells> {
    let Start::Rings { rings, spacing, per_ring } = configuration.start else { return None };
    let ring = |number: u32| Shell {
        radius: spacing * f64::from(number),
        discs: f64::from((number * per_ring).max(1)),
    };
    let all: Vec<Shell> = (0..=rings).map(ring).collect();
    let system = &configuration.system;
    let shells = Shells::new(&all, system.capillary_strength, system.capillary_length).ok()?;
    let shells = match surroundings {
        Surroundings::Images => shells.periodic(system.side).ok()?,
        Surroundings::Nothing => shells,
    };
    Some(shells.of_discs())
}

/// What is around a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Surroundings {
    /// Its periodic images, and what neutralises them if λ → ∞.
    Images,
    /// The open plane.
    Nothing,
}

/// R(t) of a cold ring, up to when it has shrunk to nothing.
pub(super) fn of_ring(
    configuration: &Configuration,
    group: Group,
    surroundings: Surroundings,
) -> Option<Curve> {
    let jeans = configuration.jeans_time()?;
    let units: Vec<f64> = times(configuration).map(|time| time * jeans).collect();
    let radii = shells(configuration, surroundings)?.radii_at(&units).ok()?;
    let ring = group.number as usize;
    let mut curve = Curve::new();
    for (time, radii) in times(configuration).zip(radii) {
        let radius = *radii.get(ring)?;
        curve.push((time, radius));
        if radius <= 0.0 {
            break;
        }
    }
    Some(curve)
}

/// R(t) of discs that begin in shells about the radii of `groups`, a curve for each, of an even patch; as far as it can be
/// followed: without pressure until shells meet.
pub(super) fn of_even_patch(
    configuration: &Configuration,
    groups: &[Group],
    pressure: Pressure,
) -> Option<Vec<Curve>> {
    let Start::Disc { radius } = configuration.start else { return None };
    let discs = configuration.system.particles as f64;
    // Discs at random are attracted by N − 1 others each, wherever they are.
    let strength = configuration.system.capillary_strength * (1.0 - 1.0 / discs);
    let shells = shells_of(discs);
    let length = configuration.system.capillary_length;
    let patch = Patch::top_hat(discs, radius, shells, strength, length, pressure).ok()?;
    followed(patch, configuration, groups)
}

/// The same of a patch that is round, but has as many discs within any radius as a run has at its start, with the pressure of
/// hard discs.
pub(super) fn of_start(configuration: &Configuration, groups: &[Group]) -> Option<Vec<Curve>> {
    let Start::Disc { radius } = configuration.start else { return None };
    let torus = torus(configuration).ok()?;
    let positions = start::disc(&torus, configuration.system.particles, radius, configuration.seed).ok()?;
    let along = |coordinate| torus.coordinate(coordinate) - 0.5 * torus.side();
    let from_middle = |position: &Position| libm::hypot(along(position.x), along(position.y));
    let mut distances: Vec<f64> = positions.iter().map(from_middle).collect();
    distances.sort_by(f64::total_cmp);
    let discs = configuration.system.particles as f64;
    let shells = shells_of(discs);
    let share = discs / shells as f64;
    // Disc n stands for those from n to n + 1, as many as its half within it.
    let halves: Curve = distances.iter().zip(0_u32..).map(|(at, n)| (f64::from(n) + 0.5, at * at)).collect();
    let middle = |shell: usize| interpolated(&halves, share * (shell as f64 + 0.5)).map(f64::sqrt);
    let radii: Vec<f64> = (0..shells).filter_map(middle).collect();
    let (strength, length) = (configuration.system.capillary_strength, configuration.system.capillary_length);
    let patch = Patch::of_shells(&radii, share, strength, length, Pressure::discs()).ok()?;
    followed(patch.of_discs(), configuration, groups)
}

/// Shells that a patch of so many discs is cut into.
fn shells_of(discs: f64) -> usize {
    (discs / DISCS_PER_SHELL).max(4.0) as usize
}

/// The mean radii of `groups` of a patch in a run's box.
fn followed(patch: Patch, configuration: &Configuration, groups: &[Group]) -> Option<Vec<Curve>> {
    let jeans = configuration.jeans_time()?;
    let half = 0.5 * configuration.output.radii_width;
    let borders = groups.iter().map(|group| ((group.initial - half).max(0.0), group.initial + half));
    let borders: Vec<(f64, f64)> = borders.collect();
    let mut patch = patch.periodic(configuration.system.side).ok()?.following(&borders);
    let mut curves = vec![Curve::new(); groups.len()];
    for time in times(configuration) {
        if patch.advance_to(time * jeans).is_err() {
            break;
        }
        curves.iter_mut().zip(patch.mean_radii()).for_each(|(curve, radius)| curve.push((time, radius)));
    }
    Some(curves)
}

/// Curves as lines, the first labelled.
pub(super) fn lines(curves: &[Curve], label: &str, colour: Colour, dash: Dash) -> Vec<Drawn> {
    let labels = core::iter::once(label).chain(core::iter::repeat(""));
    let line = |(curve, label): (&Curve, &str)| Drawn::line(label, colour, dash, curve.iter().copied());
    curves.iter().zip(labels).map(line).collect()
}
