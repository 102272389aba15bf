//! Cold collapse of shells in theory beside rings of discs: forces by Ewald sums, radii by the engine.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use meniscus::configuration::Configuration;
use meniscus::engine::Engine;
use meniscus::simulation::Simulation;
use meniscus::theory::shells::{Shell, Shells};
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::Parameters;
use meniscus_core::torus::{Fraction, Position, Torus, minimum_image};
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::schemes::SPLIT;
use meniscus_tests::tolerances::{SHELL_RADIUS, shell_force};

/// Rings of Fig. 12, each of 10 discs times its number about one in the middle.
const RINGS: usize = 9;

/// Ids of the discs of ring `ring`; 0 is the disc in the middle.
fn ids(ring: usize) -> core::ops::Range<usize> {
    if ring == 0 { 0..1 } else { 1 + 5 * ring * (ring - 1)..1 + 5 * ring * (ring + 1) }
}

/// Separations of the discs from the middle of the box, R0.
fn from_middle(torus: &Torus, discs: &[Position]) -> Vec<[f64; 2]> {
    let centre = Fraction::from_bits(1 << 31);
    let along = |coordinate| torus.length(minimum_image(coordinate, centre));
    discs.iter().map(|disc| [along(disc.x), along(disc.y)]).collect()
}

fn radius([x, y]: [f64; 2]) -> f64 {
    libm::hypot(x, y)
}

/// The mean over the discs of `ring`.
fn mean(ring: usize, of_disc: impl Fn(usize) -> f64) -> f64 {
    let count = ids(ring).len() as f64;
    ids(ring).map(of_disc).sum::<f64>() / count
}

/// The rings of discs at `separations` from the middle, as shells in a box.
fn shells(configuration: &Configuration, separations: &[[f64; 2]]) -> Shells {
    let system = configuration.system;
    let shell =
        |ring| Shell { radius: mean(ring, |id| radius(separations[id])), discs: ids(ring).len() as f64 };
    let shells: Vec<Shell> = (0..=RINGS).map(shell).collect();
    let plane = Shells::new(&shells, system.capillary_strength, system.capillary_length).unwrap();
    plane.periodic(system.side).unwrap().of_discs()
}

fn figure_12(length: &str) -> Simulation {
    // The mesh of the preset gives way to a coarser one below.
    let overrides = [format!("system.capillary_length={length}"), "force.method=pm".to_owned()];
    Simulation::new(Configuration::from_preset("fig-12", &overrides).unwrap()).unwrap()
}

#[test]
fn rings_of_discs_feel_the_force_of_shells() {
    for length in ["40", "inf"] {
        let simulation = figure_12(length);
        let system = simulation.configuration.system;
        let separations = from_middle(&simulation.torus, &simulation.engine.positions());
        let theory = shells(&simulation.configuration, &separations).forces();
        let ewald = Ewald::new(system.side, system.capillary_strength, system.capillary_length);
        let sample: Vec<usize> = (0..separations.len()).collect();
        let forces = ewald.forces_on(&sample, &separations, &vec![1.0; separations.len()]);
        let largest = theory.iter().copied().map(f64::abs).fold(0.0, f64::max);
        for (ring, expected) in theory.iter().enumerate().skip(1) {
            let outwards = |id: usize| {
                let ([x, y], [force_x, force_y]) = (separations[id], forces[id]);
                (x * force_x + y * force_y) / radius(separations[id])
            };
            let difference = (mean(ring, outwards) - expected).abs() / largest;
            assert!(
                difference < shell_force(system.capillary_length),
                "λ = {length}, ring {ring}: off by {difference}"
            );
        }
    }
}

#[test]
fn rings_of_discs_collapse_as_shells_do() {
    let mut simulation = figure_12("270");
    let parameters = Parameters { grid: 128, max_step: 0.05, ..simulation.configuration.parameters() };
    let start = simulation.engine.positions();
    simulation.engine = Engine::new(&SPLIT.of(parameters), Clock::START, &start).unwrap();
    let jeans_time = simulation.configuration.jeans_time().unwrap();
    let initial = from_middle(&simulation.torus, &start);
    while simulation.time_over_jeans().unwrap() < 0.3 {
        simulation.engine.step().unwrap();
    }
    let time = simulation.time_over_jeans().unwrap() * jeans_time;
    let theory = shells(&simulation.configuration, &initial).radii_at(&[time]).unwrap().remove(0);
    let later = from_middle(&simulation.torus, &simulation.engine.positions());
    for (ring, expected) in theory.iter().enumerate().skip(1) {
        let found = mean(ring, |id| radius(later[id]));
        let error = (found / expected - 1.0).abs();
        assert!(error < SHELL_RADIUS, "ring {ring}: {found} R0, not {expected}: off by {error}");
    }
    // It went somewhere, though not as far as without screening.
    let ring = 7;
    assert!(theory[ring] < 0.9 * mean(ring, |id| radius(initial[id])));
}
