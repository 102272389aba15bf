//! Cold collapse of a patch of rings: Fig. 12, and the limit of infinite λ in closed form.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::PI;

use meniscus::configuration::Configuration;
use meniscus::engine::Engine;
use meniscus::observables::collapse_fit::{Conditions, fit};
use meniscus::observables::radii::{GroupRadius, Groups};
use meniscus::simulation::Simulation;
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::Parameters;
use meniscus_tests::figures::assert_within;
use meniscus_tests::long_tests;
use meniscus_tests::schemes::{BOTH, PAPER, SPLIT, Scheme};
use meniscus_tests::tolerances::{COARSE_DELAY, DELAY, NEWTONIAN_RADIUS, SPLIT_NEWTONIAN_RADIUS, Within};

/// Rings of the patch.
const RINGS: usize = 9;
/// Discs of a ring over its number.
const PER_RING: u32 = 10;
/// Distance between rings, R0.
const SPACING: f64 = 19.29;

/// Rings of Fig. 12 with the paper's A0 and R_f (R0).
const FIGURE_12: [(usize, f64, f64); 3] = [(7, 1.15, 18.0), (5, 1.16, 13.0), (3, 1.16, 8.0)];

/// A mesh of the box and a ceiling of the step.
#[derive(Clone, Copy)]
struct Resolution {
    /// Nodes a side.
    grid: usize,
    /// R0²/D
    max_step: f64,
}

/// A spacing of 6.25 R0 and a step fifty times longer than the preset's. The forces of a cold patch are smooth until its
/// discs touch; that the fit hardly depends on either is tested below.
const COARSE: Resolution = Resolution { grid: 128, max_step: 0.05 };

/// A mesh that resolves discs. The preset's step of 0.001 R0²/D is for thermal kicks, and there are none.
const FINE: Resolution = Resolution { grid: 1024, max_step: 0.01 };

/// A mesh twice as fine as the coarse one, which is as exact: the split force does not need the mesh to resolve discs.
const FINE_SPLIT: Resolution = Resolution { grid: 256, ..FINE };

/// The preset's way to sum the force gives way to a [`Scheme`], so that there is nothing to be chosen for an accuracy.
const SOON_SET_UP: &str = "force.method=pm";

/// The radii of all rings at one time.
struct Sample {
    /// t/T
    time: f64,
    /// Of the disc in the middle and the rings.
    radii: Vec<GroupRadius>,
}

/// The collapse of Fig. 12 with `overrides` up to `until` (t/T), a sample every 0.01 T.
fn collapse(scheme: Scheme, resolution: Resolution, overrides: &[&str], until: f64) -> Vec<Sample> {
    let overrides: Vec<String> =
        overrides.iter().chain(&[SOON_SET_UP]).map(|&text| text.to_owned()).collect();
    let configuration = Configuration::from_preset("fig-12", &overrides).unwrap();
    let mut simulation = Simulation::new(configuration).unwrap();
    let Resolution { grid, max_step } = resolution;
    let parameters = Parameters { grid, max_step, ..simulation.configuration.parameters() };
    let start = simulation.engine.positions();
    simulation.engine = Engine::new(&scheme.of(parameters), Clock::START, &start).unwrap();
    let groups = Groups::rings(RINGS as u32, PER_RING, SPACING);
    let mut samples = Vec::new();
    let mut next = 0.0;
    loop {
        let time = simulation.time_over_jeans().unwrap();
        if time >= until {
            return samples;
        }
        if time >= next {
            samples.push(Sample {
                time,
                radii: groups.radii(&simulation.torus, &simulation.engine.positions()),
            });
            next += 0.01;
        }
        simulation.engine.step().unwrap();
    }
}

/// A0 of the rings of Fig. 12, fitted over 0 < t < 0.9 T.
fn delays(scheme: Scheme, resolution: Resolution) -> [f64; 3] {
    let samples = collapse(scheme, resolution, &[], 0.9);
    FIGURE_12.map(|(ring, _, final_radius)| {
        let radii: Vec<(f64, f64)> =
            samples.iter().map(|sample| (sample.time, sample.radii[ring].radius)).collect();
        let conditions = Conditions {
            initial_radius: Some(SPACING * ring as f64),
            final_radius: Some(final_radius),
            ..Conditions::default()
        };
        fit(&radii, &conditions).unwrap().delay.value
    })
}

fn assert_delays_of_the_paper(delays: [f64; 3], scheme: Scheme) {
    for ((ring, expected, _), found) in FIGURE_12.into_iter().zip(delays) {
        let accepted = Within(expected - DELAY, expected + DELAY);
        assert_within(found, accepted, &format!("{}, A0 of ring {ring}", scheme.name));
    }
}

#[test]
fn rings_collapse_as_the_paper_has_fitted() {
    for scheme in BOTH {
        assert_delays_of_the_paper(delays(scheme, COARSE), scheme);
    }
}

#[test]
fn the_fit_does_not_depend_on_mesh_and_step() {
    if !long_tests() {
        return;
    }
    for (scheme, fine) in [(PAPER, FINE), (SPLIT, FINE_SPLIT)] {
        let (coarse, fine) = (delays(scheme, COARSE), delays(scheme, fine));
        assert_delays_of_the_paper(fine, scheme);
        for ((ring, ..), (coarse, fine)) in FIGURE_12.into_iter().zip(coarse.into_iter().zip(fine)) {
            let accepted = Within(-COARSE_DELAY, COARSE_DELAY);
            assert_within(
                coarse - fine,
                accepted,
                &format!("{}, A0 of ring {ring}, coarse minus fine", scheme.name),
            );
        }
    }
}

/// Without screening, a circle of radius R about the middle of the periodic box feels what is within it: N discs
/// and the background of density −ρ̄ that makes the box neutral, d(R²)/dt = −2V0(N − πρ̄R²). What is outside has no
/// part in the mean over the circle. Ring n has 1 + 5n(n−1) discs within it and half of its own 10n − 1 others.
///
/// For ρ̄ → 0 this is Eq. 13.
#[test]
fn without_screening_the_collapse_is_that_of_the_closed_form() {
    assert_collapse_of_the_closed_form(PAPER, NEWTONIAN_RADIUS);
    assert_collapse_of_the_closed_form(SPLIT, SPLIT_NEWTONIAN_RADIUS);
}

fn assert_collapse_of_the_closed_form(scheme: Scheme, accepted: Within) {
    let samples = collapse(scheme, COARSE, &["system.capillary_length=inf"], 0.6);
    let configuration = Configuration::from_preset("fig-12", &[]).unwrap();
    let jeans_time = configuration.jeans_time().unwrap();
    let system = configuration.system;
    let background = system.particles as f64 / (system.side * system.side);
    let rate = 2.0 * PI * system.capillary_strength * background;
    for ring in 3..=RINGS {
        let within = 5.0 * (ring * ring) as f64 + 0.5;
        let balance = within / (PI * background);
        let initial = SPACING * ring as f64;
        let radius = |time: f64| {
            (balance - (balance - initial * initial) * libm::exp(rate * time * jeans_time)).sqrt()
        };
        let error = |sample: &Sample| (sample.radii[ring].radius / radius(sample.time) - 1.0).abs();
        let largest = samples.iter().map(error).fold(0.0, f64::max);
        assert_within(
            largest,
            accepted,
            &format!("{}, ring {ring}, largest relative error of the radius", scheme.name),
        );
    }
}
