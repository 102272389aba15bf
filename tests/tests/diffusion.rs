//! Free diffusion, and what border crossings are for.
//!
//! Without attraction the method of summing it changes no bit (tests/invariance.rs), so that one of them is enough.

use meniscus_core::engine::Engine;
use meniscus_core::parameters::{Assignment, Gradient, Noise, Parameters};
use meniscus_core::torus::{Position, minimum_image};
use meniscus_core::units::time_from_units;
use meniscus_tests::figures::assert_within;
use meniscus_tests::long_tests;
use meniscus_tests::schemes::{BOTH, SPLIT};
use meniscus_tests::states::{at, scattered, with_ids};
use meniscus_tests::statistics::mean_and_error;
use meniscus_tests::tolerances::{CENTRE_DRIFT, DIFFUSION_RESOLUTION, SIGMAS_OF_FEW, Within};

/// So small a box that discs cross its borders often.
const SIDE: f64 = 6.0;
/// Discs that do not feel each other.
const DISCS: usize = 4096;

type Gas = Engine<16, DISCS>;

const FREE: Parameters = Parameters {
    side: SIDE,
    capillary_strength: 0.0,
    repulsion: false,
    grid: 16,
    assignment: Assignment::CloudInCell,
    max_step: 0.05,
    ..Parameters::PAPER
};

/// Where a disc is when its box crossings are counted, unit L·2⁻³².
fn unwrapped<const M: usize, const N: usize>(engine: &Engine<M, N>, id: u32) -> Option<[i64; 2]> {
    let (position, crossings) = (engine.position(id)?, engine.crossings(id)?);
    let along = |bits: u32, boxes: i32| i64::from(bits) + (i64::from(boxes) << 32);
    Some([along(position.x.to_bits(), crossings.0), along(position.y.to_bits(), crossings.1)])
}

/// ⟨r²⟩/(4t) after `steps` steps, one estimate a disc.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn diffusion_coefficients(parameters: &Parameters, steps: u64) -> Vec<f64> {
    let mut engine = Box::new(Gas::new());
    let start = scattered(parameters.seed, DISCS);
    engine.init(parameters, with_ids(&start)).unwrap();
    for _ in 0..steps {
        engine.step().unwrap();
    }
    let time = time_from_units(engine.clock().time);
    let unit = SIDE / 4_294_967_296.0;
    let squared = |(id, from): (u32, Position)| {
        let [x, y] = unwrapped(&engine, id).unwrap();
        let moved = |to: i64, from: u32| (to - i64::from(from)) as f64 * unit;
        let (dx, dy) = (moved(x, from.x.to_bits()), moved(y, from.y.to_bits()));
        (dx * dx + dy * dy) / (4.0 * time)
    };
    with_ids(&start).into_iter().map(squared).collect()
}

#[test]
fn free_discs_diffuse_with_the_coefficient_one() {
    let seeds = if long_tests() { 1..=40 } else { 1..=4 };
    for noise in [Noise::Uniform, Noise::Gaussian] {
        for max_step in [0.05, 0.01] {
            let steps = if max_step < 0.02 { 60 } else { 100 };
            let estimates: Vec<f64> = seeds
                .clone()
                .flat_map(|seed| diffusion_coefficients(&Parameters { noise, max_step, seed, ..FREE }, steps))
                .collect();
            let (coefficient, error) = mean_and_error(&estimates);
            println!("{noise:?}, steps of {max_step}: D = {coefficient:.4} ± {error:.4}");
            assert!(error <= DIFFUSION_RESOLUTION);
            assert!((coefficient - 1.0).abs() <= SIGMAS_OF_FEW * error, "{coefficient} ± {error}");
        }
    }
}

#[test]
fn without_noise_free_discs_stay() {
    let coefficients = diffusion_coefficients(&Parameters { noise: Noise::None, ..FREE }, 10);
    assert!(coefficients.iter().all(|&coefficient| coefficient == 0.0));
}

#[test]
fn crossings_count_every_passage_of_a_border() {
    let mut engine = Box::new(Engine::<16, 200>::new());
    engine.init(&FREE, with_ids(&scattered(2, 200))).unwrap();
    let mut paths: Vec<[i64; 2]> = (0..200).map(|id| unwrapped(&engine, id).unwrap()).collect();
    let mut crossed = 0;
    for _ in 0..200 {
        let positions: Vec<Position> = (0..200).map(|id| engine.position(id).unwrap()).collect();
        engine.step().unwrap();
        for ((id, path), from) in (0..).zip(&mut paths).zip(positions) {
            // No step is as long as half a box, so that the nearest image is the way it took.
            let to = engine.position(id).unwrap();
            path[0] += i64::from(minimum_image(to.x, from.x));
            path[1] += i64::from(minimum_image(to.y, from.y));
            assert_eq!(unwrapped(&engine, id), Some(*path));
            crossed += i32::from(to.x.to_bits().abs_diff(from.x.to_bits()) > 1 << 31);
        }
    }
    assert!(crossed > 1000, "only {crossed} crossings");
    engine.init(&FREE, with_ids(&scattered(2, 200))).unwrap();
    assert!((0..200).all(|id| engine.crossings(id) == Some((0, 0))), "a new run counts from zero");
}

#[test]
fn a_disc_that_is_pulled_across_the_border_is_counted_beyond_it() {
    let parameters = Parameters {
        side: 32.0,
        grid: 32,
        capillary_strength: 50.0,
        repulsion: true,
        noise: Noise::None,
        max_step: 0.01,
        ..FREE
    };
    // By a difference, as the paper's gradient rings along the axes of the mesh.
    assert_pulled_across(&Parameters {
        assignment: Assignment::TriangularShapedCloud,
        gradient: Gradient::Difference2,
        ..parameters
    });
    assert_pulled_across(&SPLIT.of(parameters));
}

/// A cold pair, 4 R0 apart across the border and nearer to it on one side: they meet beyond it.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn assert_pulled_across(parameters: &Parameters) {
    let mut engine = Box::new(Engine::<32, 2>::new());
    let discs = [at(32.0, 0.5, 8.0), at(32.0, 28.5, 8.0)].map(Result::unwrap);
    engine.init(parameters, with_ids(&discs)).unwrap();
    for _ in 0..300 {
        engine.step().unwrap();
    }
    assert_eq!((engine.crossings(0), engine.crossings(1)), (Some((-1, 0)), Some((0, 0))));
    let along_x = |id: u32| unwrapped(&engine, id).unwrap()[0] as f64 / 4_294_967_296.0 * 32.0;
    let (pulled, other) = (along_x(0), along_x(1));
    assert!((pulled - (other - 32.0) - 2.0).abs() < 0.5, "{pulled} {other}");
    // Both went as far.
    assert!((0.5 - pulled - (other - 28.5)).abs() < 1e-3, "{pulled} {other}");
}

/// The mean of the unwrapped places of 200 discs in a box of `side`, R0 from the origin of the box.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn centre(engine: &Engine<32, 200>, side: f64) -> [f64; 2] {
    let sum =
        (0..200).map(|id| unwrapped(engine, id).unwrap()).fold([0, 0], |[x, y], at| [x + at[0], y + at[1]]);
    sum.map(|units| units as f64 * side / 4_294_967_296.0 / 200.0)
}

#[test]
fn without_noise_the_centre_of_attracting_discs_stays() {
    let parameters = Parameters {
        side: 40.0,
        grid: 32,
        capillary_strength: 5.0,
        repulsion: true,
        noise: Noise::None,
        max_step: 0.001,
        ..FREE
    };
    for scheme in BOTH {
        let mut engine = Box::new(Engine::<32, 200>::new());
        engine.init(&scheme.of(parameters), with_ids(&scattered(3, 200))).unwrap();
        let start = centre(&engine, parameters.side);
        for _ in 0..100 {
            engine.step().unwrap();
        }
        let end = centre(&engine, parameters.side);
        let drift = libm::hypot(end[0] - start[0], end[1] - start[1]);
        assert_within(drift, Within(1e-11, CENTRE_DRIFT), &format!("{}, drift of the centre", scheme.name));
    }
}
