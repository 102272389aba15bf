//! A short cold run against the same run in binary64: Ewald sums, the repulsion in closed form, Euler's step.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use meniscus::engine::Engine;
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise, Parameters};
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::time_from_units;
use meniscus_tests::figures::assert_within;
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::{minimum_image, rms, wca};
use meniscus_tests::states::separated;
use meniscus_tests::tolerances::{
    ATTRACTED_DEVIATION, REFERENCE_TIME, REPELLED_DEVIATION, SPLIT_DEVIATION, SPLIT_REFERENCE_TIME, Within,
};

const SIDE: f64 = 24.0;
const DISCS: usize = 50;
const STEPS: usize = 20;

/// A run in binary64.
struct Reference {
    parameters: Parameters,
    ewald: Ewald,
    positions: Vec<[f64; 2]>,
    time: f64,
}

impl Reference {
    fn new(parameters: Parameters, positions: Vec<[f64; 2]>) -> Self {
        let Parameters { side, capillary_strength, capillary_length, .. } = parameters;
        let ewald = Ewald::new(side, capillary_strength, capillary_length);
        Self { parameters, ewald, positions, time: 0.0 }
    }

    /// F·Δt, with the longest Δt that the rule of Sec. III and its ceiling allow.
    fn step(&mut self) {
        let attraction = self.ewald.forces(&self.positions);
        let repulsion = wca::forces(&self.positions, self.parameters.side);
        let forces: Vec<[f64; 2]> =
            attraction.iter().zip(&repulsion).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
        let largest = forces.iter().map(|force| libm::hypot(force[0], force[1])).fold(0.0, f64::max);
        let length = self.parameters.max_step.min(self.parameters.max_displacement / largest);
        for (position, force) in self.positions.iter_mut().zip(forces) {
            position[0] += force[0] * length;
            position[1] += force[1] * length;
        }
        self.time += length;
    }
}

fn in_radii(discs: &[Position]) -> Vec<[f64; 2]> {
    let torus = Torus::new(SIDE).unwrap();
    discs.iter().map(|disc| [torus.coordinate(disc.x), torus.coordinate(disc.y)]).collect()
}

/// Separations of the nearest images of two states, disc by disc.
fn moved(from: &[[f64; 2]], to: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let image = |a: &[f64; 2], b: &[f64; 2]| [0, 1].map(|axis| minimum_image(b[axis] - a[axis], SIDE));
    from.iter().zip(to).map(|(a, b)| image(a, b)).collect()
}

/// All on a mesh, in its most accurate scheme.
const MESH: Parameters = Parameters {
    side: SIDE,
    grid: 64,
    influence: Influence::Continuum,
    gradient: Gradient::Difference4,
    noise: Noise::None,
    max_step: 0.02,
    ..Parameters::PAPER
};

/// The split force on a mesh twice as coarse, αh = 0.37 and αr_c = 4.4.
const SPLIT: Parameters = Parameters {
    method: Method::P3m,
    splitting: 0.5,
    cutoff: 8.8,
    grid: 32,
    assignment: Assignment::Order7,
    influence: Influence::Optimal,
    gradient: Gradient::Spectral,
    ..MESH
};

/// After 20 steps: the rms difference of the positions over the rms distance covered, and the relative difference
/// of the times.
fn deviation(parameters: Parameters) -> (f64, f64) {
    // Some pairs overlap, so that contacts and the step rule have their part.
    let discs = separated(1, DISCS, SIDE, 1.8);
    assert_eq!(discs.len(), DISCS);
    let start = in_radii(&discs);
    let mut engine = Engine::new(&parameters, Clock::START, &discs).unwrap();
    let mut reference = Reference::new(parameters, start.clone());
    for _ in 0..STEPS {
        engine.step().unwrap();
        reference.step();
    }
    let found = in_radii(&engine.positions());
    let covered = rms(&moved(&start, &reference.positions));
    let time = time_from_units(engine.clock().time);
    (rms(&moved(&reference.positions, &found)) / covered, time / reference.time - 1.0)
}

#[test]
fn repelling_discs_move_as_in_binary64() {
    for method in [MESH, SPLIT] {
        let (positions, time) = deviation(Parameters { capillary_strength: 0.0, ..method });
        assert_within(positions, REPELLED_DEVIATION, "positions after 20 steps");
        assert_within(time.abs(), Within(0.0, REFERENCE_TIME), "their time");
    }
}

#[test]
fn attracting_discs_move_as_in_binary64_but_for_the_mesh() {
    let (positions, time) = deviation(MESH);
    assert_within(positions, ATTRACTED_DEVIATION, "positions after 20 steps");
    assert_within(time.abs(), Within(0.0, REFERENCE_TIME), "their time");
}

#[test]
fn discs_that_attract_each_other_by_the_split_force_move_as_in_binary64() {
    let (positions, time) = deviation(SPLIT);
    assert_within(positions, SPLIT_DEVIATION, "positions after 20 steps");
    assert_within(time.abs(), Within(0.0, SPLIT_REFERENCE_TIME), "their time");
}
