//! The length of a step: never above its bounds, found with integers.

use meniscus_core::engine::Engine;
use meniscus_core::ermak::{StepLimits, largest_force};
use meniscus_core::parameters::{DISPLACEMENT_RANGE, Noise, Parameters, STEP_RANGE};
use meniscus_core::torus::Position;
use meniscus_core::units::{FORCE_UNITS, TIME_UNITS, force_from_units, round_half_even, time_from_units};
use meniscus_tests::schemes::BOTH;
use meniscus_tests::states::{at, crowded, lattice, scattered, separation, with_ids};
use proptest::prelude::*;

/// A force component of any size, as far as the sum of all forces reaches.
fn component() -> impl Strategy<Value = i64> {
    (0_u32..63, any::<i64>()).prop_map(|(shift, bits)| bits >> shift)
}

/// A number between two others, evenly on a logarithmic scale.
fn between((least, most): (f64, f64)) -> impl Strategy<Value = f64> {
    let exponents = libm::log2(least)..=libm::log2(most);
    exponents.prop_map(move |exponent| libm::exp2(exponent).clamp(least, most))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_largest_force_is_the_exact_ceiling_of_the_modulus(
        forces in prop::collection::vec((component(), component()), 1..20),
    ) {
        let (x, y): (Vec<i64>, Vec<i64>) = forces.iter().copied().unzip();
        let largest = u128::from(largest_force(&x, &y));
        let square = |x: i64| u128::from(x.unsigned_abs()) * u128::from(x.unsigned_abs());
        let exact = forces.iter().map(|&(x, y)| square(x) + square(y)).max().unwrap();
        prop_assert!(largest * largest >= exact);
        prop_assert!(largest == 0 || (largest - 1) * (largest - 1) < exact);
    }

    #[test]
    fn no_step_exceeds_its_bounds_and_one_unit_more_would(
        max_step in between(STEP_RANGE),
        max_displacement in between(DISPLACEMENT_RANGE),
        largest in (0_u32..64, any::<u64>()).prop_map(|(shift, bits)| bits >> shift),
    ) {
        let ceiling = (max_step * TIME_UNITS as f64) as u64;
        // Scaling by a power of two is exact, and so is the conversion of what lies below 2⁶⁴.
        let displacement = (max_displacement * 18_446_744_073_709_551_616.0) as u128;
        match StepLimits::new(max_step, max_displacement).step_length(largest) {
            Some(length) => {
                prop_assert!(length > 0 && length <= ceiling);
                prop_assert!(time_from_units(length) <= max_step);
                prop_assert!(u128::from(length) * u128::from(largest) <= displacement);
                let one_more = u128::from(length) + 1;
                prop_assert!(length == ceiling || one_more * u128::from(largest) > displacement);
            }
            None => prop_assert!(u128::from(largest) > displacement),
        }
    }

    #[test]
    fn rounding_is_to_the_nearest_ties_to_even(value in prop_oneof![
        -1e7_f32..1e7,
        (-17_000_000_i32..17_000_000).prop_map(|halves| halves as f32 * 0.5),
        any::<f32>().prop_filter("an integer of 64 bits", |value| value.abs() < 9.2e18),
    ]) {
        prop_assert_eq!(round_half_even(value), libm::rint(f64::from(value)) as i64);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_disc_is_moved_by_force_farther_than_allowed(
        scheme in prop::sample::select(&BOTH[..]),
        seed in any::<u64>(),
        width in 0.02..0.5_f64,
        max_step in between((1e-6, 1.0)),
        max_displacement in between((1e-3, 0.5)),
    ) {
        let parameters = scheme.of(Parameters {
            side: 16.0, grid: 16, noise: Noise::None, max_step, max_displacement, ..Parameters::PAPER
        });
        let mut engine = Box::new(Engine::<16, 64>::new());
        engine.init(&parameters, with_ids(&crowded(seed, 60, width))).unwrap();
        for _ in 0..5 {
            let before: Vec<Position> = (0..60).map(|id| engine.position(id).unwrap()).collect();
            let step = engine.step().unwrap();
            prop_assert!(step.length > 0 && time_from_units(step.length) <= max_step);
            let forces = (0..60).map(|id| engine.force(id).unwrap());
            let (x, y): (Vec<i64>, Vec<i64>) = forces.unzip();
            prop_assert_eq!(step.largest_force, largest_force(&x, &y));
            let farthest = time_from_units(step.length) * force_from_units(step.largest_force as i64);
            prop_assert!(farthest <= max_displacement);
            for (id, before) in (0..60).zip(before) {
                let after = engine.position(id).unwrap();
                let moved = separation(after, before, 16.0);
                // Half a unit of position in each component, and the rounding of the product in binary32.
                prop_assert!(moved <= max_displacement * (1.0 + 1e-6) + 16.0 / 4_294_967_296.0);
            }
        }
    }
}

/// One step of discs without noise; the engine after it.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn after_a_step(parameters: &Parameters, discs: &[Position]) -> (Box<Engine<32, 256>>, u64) {
    let mut engine = Box::new(Engine::new());
    engine.init(parameters, with_ids(discs)).unwrap();
    let step = engine.step().unwrap();
    (engine, step.length)
}

const COLD: Parameters =
    Parameters { side: 32.0, capillary_strength: 0.0, grid: 32, noise: Noise::None, ..Parameters::PAPER };

/// 0.001 R0²/D, rounded down.
const CEILING: u64 = TIME_UNITS / 1000;

#[test]
fn a_lattice_at_rest_steps_at_the_ceiling() {
    let discs = lattice(8);
    for scheme in BOTH {
        for capillary_strength in [0.0, 0.89] {
            let parameters = scheme.of(Parameters { capillary_strength, ..COLD });
            let (engine, length) = after_a_step(&parameters, &discs);
            assert_eq!(length, CEILING);
            for (id, &disc) in (0..).zip(&discs) {
                assert_eq!(engine.position(id), Some(disc));
            }
        }
    }
}

#[test]
fn a_single_disc_steps_at_the_ceiling() {
    for scheme in BOTH {
        let parameters = scheme.of(Parameters { capillary_strength: 0.89, ..COLD });
        let (engine, length) = after_a_step(&parameters, &scattered(1, 1));
        assert_eq!(length, CEILING);
        assert_eq!(engine.clock().step, 1);
    }
}

#[test]
fn without_forces_and_noise_nothing_moves() {
    let discs = crowded(1, 200, 0.1);
    let mut engine = Box::new(Engine::<32, 256>::new());
    engine.init(&Parameters { repulsion: false, ..COLD }, with_ids(&discs)).unwrap();
    for _ in 0..50 {
        assert_eq!(engine.step().unwrap().length, CEILING);
    }
    for (id, &disc) in (0..).zip(&discs) {
        assert_eq!(engine.position(id), Some(disc));
        assert_eq!(engine.force(id), Some((0, 0)));
        assert_eq!(engine.crossings(id), Some((0, 0)));
    }
    assert_eq!(engine.clock().time, 50 * CEILING);
}

#[test]
fn without_attraction_steps_are_at_the_ceiling_when_no_discs_touch() {
    let discs = lattice(8);
    let (_, length) = after_a_step(&Parameters { noise: Noise::Uniform, ..COLD }, &discs);
    assert_eq!(length, CEILING);
}

#[test]
fn a_step_at_the_ceiling_of_one_is_one() {
    let (_, length) = after_a_step(&Parameters { max_step: 1.0, ..COLD }, &lattice(4));
    assert_eq!(length, TIME_UNITS);
}

#[test]
fn a_pull_is_turned_into_a_displacement() {
    // Two discs that overlap at d = 2: 12 kBT/R0 for 0.001 R0²/D.
    let side = COLD.side;
    let discs = [at(side, 10.0, 10.0), at(side, 12.0, 10.0)];
    let discs = discs.map(Result::unwrap);
    let (engine, length) = after_a_step(&COLD, &discs);
    assert_eq!(length, CEILING);
    let moved = |id: u32| {
        let units = engine.position(id).unwrap().x.to_bits().wrapping_sub(discs[id as usize].x.to_bits());
        f64::from(units as i32) * side / 4_294_967_296.0
    };
    assert!((moved(0) + 0.012).abs() < 1e-7, "{}", moved(0));
    assert_eq!(moved(0), -moved(1));
    assert_eq!(engine.force(0).unwrap().0, -engine.force(1).unwrap().0);
    assert!((engine.force(1).unwrap().0 as f64 / f64::from(FORCE_UNITS) - 12.0).abs() < 1e-4);
}
