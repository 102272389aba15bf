//! The mesh force against Ewald sums in binary64, and the repulsion against its closed form.
//!
//! Discs are placed at random without overlap, as runs begin. Without that condition the comparison would say
//! little: the mean square of a force 1/d over independent positions diverges at d = 0, and a few pairs far inside
//! each other, where a mesh of any kind is wrong and repulsion is all that counts, decide it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::TAU;

use meniscus::engine::Engine;
use meniscus::start::random;
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Parameters};
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::field::MeshField;
use meniscus_tests::figures::assert_within;
use meniscus_tests::long_tests;
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::{RandomNumbers, minimum_image, rms, rms_difference, wca};
use meniscus_tests::states::scattered;
use meniscus_tests::tolerances::{
    CONTACT_ERROR, FAR_ERROR, FORCE_QUANTUM, MESH_ERROR, PAIR_FORCE, SCREENED_MESH_ERROR, SECOND_ORDER,
    UNSCREENED_MESH_ERROR,
};

/// V0 of Table I, kBT.
const STRENGTH: f64 = 0.89;
/// λ of Table I, R0.
const LENGTH: f64 = 270.0;
/// Discs of Table I.
const DISCS: usize = 2500;

/// One way to compute the force on a mesh.
type Scheme = (Assignment, Influence, Gradient);

const ASSIGNMENTS: [Assignment; 2] = [Assignment::CloudInCell, Assignment::TriangularShapedCloud];
const INFLUENCES: [Influence; 2] = [Influence::Paper, Influence::Continuum];
const DIFFERENCES: [Gradient; 2] = [Gradient::Difference2, Gradient::Difference4];

const PAPER_TSC: Scheme = (Assignment::TriangularShapedCloud, Influence::Paper, Gradient::Spectral);
const SMOOTHEST: Scheme = (Assignment::TriangularShapedCloud, Influence::Continuum, Gradient::Difference4);

/// Attraction alone, by `grid` nodes along a box of `side`.
fn attraction((assignment, influence, gradient): Scheme, side: f64, grid: usize, length: f64) -> Parameters {
    Parameters {
        side,
        capillary_strength: STRENGTH,
        capillary_length: length,
        repulsion: false,
        grid,
        assignment,
        influence,
        gradient,
        ..Parameters::PAPER
    }
}

fn engine_forces(parameters: &Parameters, discs: &[Position]) -> Vec<[f64; 2]> {
    Engine::new(parameters, Clock::START, discs).unwrap().forces().unwrap()
}

fn in_radii(discs: &[Position], side: f64) -> Vec<[f64; 2]> {
    let torus = Torus::new(side).unwrap();
    discs.iter().map(|disc| [torus.coordinate(disc.x), torus.coordinate(disc.y)]).collect()
}

/// Random discs without overlap and the exact forces on them.
struct Sample {
    discs: Vec<Position>,
    forces: Vec<[f64; 2]>,
}

fn sample(seed: u64, side: f64, length: f64) -> Sample {
    let discs = random(&Torus::new(side).unwrap(), DISCS, seed).unwrap();
    let forces = Ewald::new(side, STRENGTH, length).forces(&in_radii(&discs, side));
    Sample { discs, forces }
}

/// rms error over rms force of the mesh, all samples together.
fn relative_error(parameters: &Parameters, samples: &[Sample]) -> f64 {
    let found = samples.iter().flat_map(|sample| engine_forces(parameters, &sample.discs));
    let exact: Vec<[f64; 2]> = samples.iter().flat_map(|sample| sample.forces.clone()).collect();
    rms_difference(&found.collect::<Vec<_>>(), &exact) / rms(&exact)
}

#[test]
fn mesh_forces_of_random_discs_have_the_errors_of_the_table() {
    let seeds = if long_tests() { 8 } else { 2 };
    for side in [512.0, 500.0] {
        let samples: Vec<Sample> = (1..=seeds).map(|seed| sample(seed, side, LENGTH)).collect();
        for (scheme, accepted) in MESH_ERROR {
            let error = relative_error(&attraction(scheme, side, 512, LENGTH), &samples);
            assert_within(error, accepted, &format!("{scheme:?}, L = {side}"));
        }
    }
}

#[test]
fn short_capillary_lengths_agree_with_ewald() {
    let samples = [sample(1, 512.0, 0.02 * 512.0)];
    for (scheme, accepted) in [PAPER_TSC, SMOOTHEST].into_iter().zip(SCREENED_MESH_ERROR) {
        let error = relative_error(&attraction(scheme, 512.0, 512, 0.02 * 512.0), &samples);
        assert_within(error, accepted, &format!("{scheme:?}"));
    }
}

#[test]
fn an_infinite_capillary_length_agrees_with_ewald() {
    let samples = [sample(1, 512.0, f64::INFINITY)];
    for (scheme, accepted) in [PAPER_TSC, SMOOTHEST].into_iter().zip(UNSCREENED_MESH_ERROR) {
        let error = relative_error(&attraction(scheme, 512.0, 512, f64::INFINITY), &samples);
        assert_within(error, accepted, &format!("{scheme:?}"));
    }
}

/// rms over random pairs, `least` to `most` apart, of the error of the mesh force over the exact force.
fn pair_error(parameters: &Parameters, (least, most): (f64, f64), (sources, probes): (usize, usize)) -> f64 {
    let side = parameters.side;
    let torus = Torus::new(side).unwrap();
    let ewald = Ewald::new(side, STRENGTH, parameters.capillary_length);
    let mut random = RandomNumbers::new(1);
    let mut errors = Vec::new();
    for source in scattered(2, sources) {
        let [x, y] = [torus.coordinate(source.x), torus.coordinate(source.y)];
        let mut beside = || {
            let distance = least + (most - least) * random.uniform();
            let (sine, cosine) = libm::sincos(TAU * random.uniform());
            Position {
                x: torus.wrapped_fraction(x + distance * cosine),
                y: torus.wrapped_fraction(y + distance * sine),
            }
        };
        let probes: Vec<Position> = (0..probes).map(|_| beside()).collect();
        let found = MeshField::new(parameters, &[source]).unwrap().at(&probes);
        for (probe, found) in in_radii(&probes, side).iter().zip(found) {
            let exact =
                ewald.pair_force(minimum_image(x - probe[0], side), minimum_image(y - probe[1], side));
            errors.push([0, 1].map(|axis| (found[axis] - exact[axis]) / rms(&[exact])));
        }
    }
    rms(&errors)
}

#[test]
fn pairs_at_contact_have_the_errors_of_the_table() {
    for (scheme, accepted) in CONTACT_ERROR {
        let error = pair_error(&attraction(scheme, 64.0, 64, LENGTH), (2.0, 2.0), (200, 20));
        assert_within(error, accepted, &format!("{scheme:?}"));
    }
}

#[test]
fn differences_make_distant_pairs_accurate() {
    for assignment in ASSIGNMENTS {
        for influence in INFLUENCES {
            for gradient in DIFFERENCES {
                let scheme = (assignment, influence, gradient);
                // 20 h to L/4.
                let error = pair_error(&attraction(scheme, 256.0, 256, LENGTH), (20.0, 64.0), (4, 50));
                assert_within(error, FAR_ERROR, &format!("{scheme:?}"));
            }
        }
    }
}

#[test]
fn halving_the_spacing_quarters_the_error_of_distant_pairs() {
    for assignment in ASSIGNMENTS {
        // Laplacian and two-point difference are of second order, each for itself.
        for (influence, gradient) in [
            (Influence::Paper, Gradient::Difference4),
            (Influence::Continuum, Gradient::Difference2),
            (Influence::Paper, Gradient::Difference2),
        ] {
            let scheme = (assignment, influence, gradient);
            let error = |grid| pair_error(&attraction(scheme, 256.0, grid, LENGTH), (58.0, 62.0), (4, 100));
            let errors = [64, 128, 256].map(error);
            for pair in errors.windows(2) {
                assert_within(pair[0] / pair[1], SECOND_ORDER, &format!("{scheme:?}"));
            }
        }
    }
}

/// The sum over a disc's neighbours of the moduli of both terms of the repulsion, and their number.
fn repulsion_scale(discs: &[[f64; 2]], disc: usize, side: f64) -> (f64, f64) {
    let (mut moduli, mut neighbours) = (0.0, 0.0);
    for (other, position) in discs.iter().enumerate() {
        let [dx, dy] = [0, 1].map(|axis| minimum_image(position[axis] - discs[disc][axis], side));
        let distance = libm::hypot(dx, dy);
        if other != disc && distance <= wca::cutoff() {
            let held = distance.max(wca::SMALLEST_SEPARATION);
            let square = 4.0 / (held * held);
            let sixth = square * square * square;
            moduli += 24.0 / held * (2.0 * sixth * sixth + sixth);
            neighbours += 1.0;
        }
    }
    (moduli, neighbours)
}

#[test]
fn repulsion_of_a_dense_layer_is_the_closed_form() {
    let side = 50.0;
    let parameters = Parameters { side, capillary_strength: 0.0, grid: 64, ..Parameters::PAPER };
    // Independent positions: pairs at all distances down to deep overlap.
    let discs = scattered(5, 1000);
    let positions = in_radii(&discs, side);
    let found = engine_forces(&parameters, &discs);
    let exact = wca::forces(&positions, side);
    for (disc, (found, exact)) in found.iter().zip(&exact).enumerate() {
        let (moduli, neighbours) = repulsion_scale(&positions, disc, side);
        let allowed = PAIR_FORCE * moduli + FORCE_QUANTUM * neighbours;
        for axis in 0..2 {
            let error = (found[axis] - exact[axis]).abs();
            assert!(error <= allowed, "disc {disc}: off by {error}, accepted {allowed}");
        }
    }
}
