//! The edges of the ranges: each is driven to, and what is refused leaves the state as it was.

use meniscus_core::dynamics::{Clock, Dynamics, ForceError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::parameters::{
    Assignment, LARGEST_CAPILLARY_STRENGTH, LARGEST_PARTICLE_COUNT, Noise, Parameters, SPACING_RANGE,
};
use meniscus_core::repulsion::{CUTOFF, LARGEST_FORCE};
use meniscus_core::torus::{LARGEST_SIDE, Position};
use meniscus_core::transform::AnySize;
use meniscus_core::units::{FORCE_UNITS, TIME_UNITS, force_from_units, time_from_units};
use meniscus_tests::arrays::Arrays;
use meniscus_tests::long_tests;
use meniscus_tests::states::{at, scattered, separation, with_ids};

const BOX: Parameters = Parameters {
    side: 16.0,
    capillary_strength: 0.0,
    grid: 16,
    assignment: Assignment::CloudInCell,
    noise: Noise::None,
    ..Parameters::DEFAULT
};

type Roomy = Engine<16, 4200>;

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn started<const N: usize>(parameters: &Parameters, discs: &[Position]) -> Box<Engine<16, N>> {
    let mut engine = Box::new(Engine::new());
    engine.init(parameters, with_ids(discs)).unwrap();
    engine
}

/// Everything a refused step must not touch.
fn state<const N: usize>(engine: &Engine<16, N>) -> impl PartialEq + core::fmt::Debug + use<N> {
    let crossings: Vec<_> = (0..engine.count() as u32).map(|id| engine.crossings(id)).collect();
    (engine.clock(), engine.state().digest_by_field(), crossings)
}

/// Refused with `error`, twice, and the state is as before.
fn assert_refused<const N: usize>(engine: &mut Engine<16, N>, error: StepError) {
    let before = state(engine);
    assert_eq!(engine.step(), Err(error));
    assert_eq!(state(engine), before);
    assert_eq!(engine.step(), Err(error));
    assert_eq!(state(engine), before);
}

#[test]
fn coinciding_discs_part_along_x_in_short_steps() {
    let mut engine = started::<2>(&BOX, &[Position::from_bits(1 << 20, 1 << 20); 2]);
    let first = engine.step().unwrap();
    let (force, opposite) = (engine.force(0).unwrap(), engine.force(1).unwrap());
    assert!(force.0 > 0 && force.1 == 0 && opposite == (-force.0, 0));
    assert!(force_from_units(force.0) <= LARGEST_FORCE);
    // R0/4 at 770 000 kBT/R0.
    let length = time_from_units(first.length);
    assert!(length > 3e-7 && length < 3.5e-7, "{length}");
    let mut distances = Vec::new();
    for _ in 0..100 {
        engine.step().unwrap();
        distances.push(separation(engine.position(0).unwrap(), engine.position(1).unwrap(), BOX.side));
    }
    assert!(distances[9] > 1.5, "resolved within a few steps: {distances:?}");
    assert!(distances[99] > 2.0 && distances[99] < 2.25, "{distances:?}");
    // The lower id went to the right.
    let (right, left) = (engine.position(0).unwrap(), engine.position(1).unwrap());
    assert!(right.x.to_bits().wrapping_sub(left.x.to_bits()) < 1 << 31 && right.y == left.y);
}

#[test]
fn a_pile_of_discs_at_one_place_is_resolved() {
    let parameters = Parameters { noise: Noise::Uniform, ..BOX };
    let mut engine = started::<20>(&parameters, &[Position::from_bits(0, 0); 20]);
    for _ in 0..2000 {
        engine.step().unwrap();
    }
    for first in 0..20 {
        for second in 0..first {
            let (first, second) = (engine.position(first).unwrap(), engine.position(second).unwrap());
            assert!(separation(first, second, BOX.side) > 1.5);
        }
    }
}

#[test]
fn a_node_with_4096_discs_is_refused_and_one_with_4095_is_not() {
    let parameters = Parameters { capillary_strength: 0.89, repulsion: false, ..BOX };
    let on_a_node = Position::from_bits(1 << 28, 1 << 29);
    let mut full = started::<4200>(&parameters, &[on_a_node; 4095]);
    assert!(full.step().is_ok());
    let mut crowded = started::<4200>(&parameters, &[on_a_node; 4096]);
    assert_eq!(crowded.compute_forces(), Err(ForceError::Crowded));
    assert_refused(&mut crowded, StepError::Crowded);
}

#[test]
fn without_attraction_no_node_is_too_crowded() {
    let parameters = Parameters { repulsion: false, ..BOX };
    let mut engine = started::<4200>(&parameters, &[Position::from_bits(0, 0); 4200]);
    assert!(engine.step().is_ok());
}

#[test]
fn discs_half_a_box_apart_do_not_feel_each_other_even_in_the_smallest_box() {
    let side = (2.0 * CUTOFF).next_up();
    let parameters = Parameters { side, ..BOX };
    for half in [Position::from_bits(1 << 31, 0), Position::from_bits(1 << 31, 1 << 31)] {
        let discs = [Position::from_bits(0, 0), half];
        let mut engine = started::<2>(&parameters, &discs);
        assert_eq!(engine.step().map(|step| (step.largest_force, step.length)), Ok((0, TIME_UNITS / 1000)));
        assert_eq!((engine.position(0), engine.position(1)), (Some(discs[0]), Some(discs[1])));
    }
}

#[test]
fn a_force_that_allows_no_step_is_refused() {
    // 2⁻⁴⁰ R0 at 770 000 kBT/R0 is a millionth of a unit of time.
    let parameters = Parameters { max_displacement: 1.0 / TIME_UNITS as f64, ..BOX };
    let mut engine = started::<2>(&parameters, &[Position::from_bits(5, 5); 2]);
    assert_refused(&mut engine, StepError::StepTooShort);
    // As far as that displacement is allowed, the shortest ceiling is a step.
    let parameters = Parameters { max_step: 1.0 / TIME_UNITS as f64, ..BOX };
    let mut engine = started::<2>(&parameters, &[Position::from_bits(5, 5); 2]);
    assert_eq!(engine.step().map(|step| step.length), Ok(1));
}

#[test]
fn time_does_not_wrap() {
    let discs = with_ids(&scattered(1, 4));
    let mut engine = Box::new(Engine::<16, 4>::new());
    let parameters = Parameters { repulsion: false, noise: Noise::Uniform, ..BOX };
    let length = TIME_UNITS / 1000;
    for (left, steps) in [(0, 0), (length - 1, 0), (length, 1), (2 * length, 2), (3 * length - 1, 2)] {
        engine.init_at(&parameters, Clock { step: 7, time: u64::MAX - left }, discs.iter().copied()).unwrap();
        for _ in 0..steps {
            assert!(engine.step().is_ok());
        }
        assert_refused(&mut engine, StepError::TimeOverflow);
        assert_eq!(engine.clock(), Clock { step: 7 + steps, time: u64::MAX - left + steps * length });
    }
}

#[test]
fn the_number_of_steps_does_not_wrap() {
    let mut engine = Box::new(Engine::<16, 4>::new());
    let parameters = Parameters { repulsion: false, noise: Noise::Uniform, ..BOX };
    engine.init_at(&parameters, Clock { step: u64::MAX - 1, time: 0 }, with_ids(&scattered(1, 4))).unwrap();
    assert!(engine.step().is_ok());
    assert_refused(&mut engine, StepError::TimeOverflow);
}

#[test]
fn a_displacement_of_half_a_box_is_refused() {
    // The kick's half-width √6 = 2.449 exceeds half the side, 2.245; some disc of 100 draws as much.
    let side = (2.0 * CUTOFF).next_up();
    let parameters = Parameters { side, repulsion: false, noise: Noise::Uniform, max_step: 1.0, ..BOX };
    let mut engine = started::<100>(&parameters, &scattered(1, 100));
    assert_refused(&mut engine, StepError::HalfBox);
    // Of half the variance, none does.
    let mut engine = started::<100>(&Parameters { max_step: 0.5, ..parameters }, &scattered(1, 100));
    for _ in 0..100 {
        assert!(engine.step().is_ok());
    }
}

#[test]
fn a_displacement_of_exactly_half_a_box_is_refused_on_either_side() {
    let kick = ThermalKick::new(Noise::None, 1.0, StepKey::new(1, Purpose::Motion, 0));
    let unit = FORCE_UNITS as i64;
    // 1 kBT/R0 for 1 R0²/D in a box of 2 R0, and the binary32 number below.
    let displacement = Displacement { step_length: 1.0, units: 2_147_483_648.0, kick };
    for force in [(unit, 0), (-unit, 0), (0, unit), (0, -unit)] {
        assert_eq!(displacement.of(0, force), Err(HalfBox));
    }
    assert_eq!(displacement.of(0, (unit - 1, 1 - unit)), Ok((2_147_483_520, -2_147_483_520)));
}

#[test]
fn the_smallest_box_works() {
    let parameters =
        Parameters { side: (2.0 * CUTOFF).next_up(), capillary_strength: 0.89, noise: Noise::Uniform, ..BOX };
    let mut engine = started::<3>(&parameters, &scattered(3, 3));
    for _ in 0..200 {
        engine.step().unwrap();
    }
}

#[test]
fn the_largest_box_works() {
    // Its mesh of 4096² takes 256 MiB; solving it takes a while.
    let attracts = long_tests();
    let capillary_strength = if attracts { 100.0 } else { 0.0 };
    let (side, grid) = (LARGEST_SIDE, 4096);
    let parameters = Parameters { side, grid, capillary_strength, ..BOX };
    let discs = [(0.0, 0.0), (65535.0, 65535.0), (32768.0, 10.0), (32769.0, 10.0)];
    let discs = discs.map(|(x, y)| at(side, x, y).unwrap());
    let mut arrays = Arrays::new(grid, 8, discs.len());
    let mut dynamics =
        Dynamics::new(&parameters, Clock::START, with_ids(&discs), &mut arrays.memory()).unwrap();
    for _ in 0..2 {
        dynamics.step(&AnySize, &mut arrays.memory()).unwrap();
    }
    // Both overlapping pairs, one of them across the corner, moved apart, symmetrically.
    for (first, second) in [(0, 1), (2, 3)] {
        let of = |id: usize| Position { x: arrays.x[id], y: arrays.y[id] };
        let distance = separation(of(first), of(second), side);
        assert!(distance > separation(discs[first], discs[second], side) + 0.1, "{distance}");
        let pushed = |id: usize| of(id).x.to_bits().wrapping_sub(discs[id].x.to_bits()) as i32;
        if !attracts {
            assert_eq!(pushed(first), -pushed(second));
        }
    }
}

#[test]
fn a_heap_of_thousands_of_discs_does_not_overflow() {
    let count = if long_tests() { 4000 } else { 1500 };
    let parameters = Parameters { capillary_strength: 1000.0, ..BOX };
    let mut engine: Box<Roomy> = started(&parameters, &vec![Position::from_bits(3, 3); count]);
    let step = engine.step().unwrap();
    assert!(step.length > 0);
    // The lowest id is pushed to the right by all others, the highest to the left.
    let pair = engine.force(0).unwrap().0 / (count as i64 - 1);
    assert!(force_from_units(pair) > 0.999 * LARGEST_FORCE);
    for id in 0..count as i64 {
        let expected = (count as i64 - 1 - 2 * id) * pair;
        // The mesh adds no more than rounding to discs at one place.
        let off = engine.force(id as u32).unwrap().0 - expected;
        assert!(force_from_units(off.abs()) < LARGEST_FORCE, "{off}");
    }
}

#[test]
fn the_total_force_stays_below_two_to_the_63() {
    // Every number here is an integer or rounded up.
    let count = LARGEST_PARTICLE_COUNT as u128;
    let pair = (LARGEST_FORCE * f64::from(FORCE_UNITS)).ceil() as u128;
    // 4 V0/h for each disc, see the mesh's own test of the modes.
    let mesh = (4.0 * LARGEST_CAPILLARY_STRENGTH / SPACING_RANGE.0 * f64::from(FORCE_UNITS)).ceil() as u128;
    let component = (count - 1) * pair + count * mesh;
    assert!(component < 1 << 63, "{component:e}");
    assert!(2 * component * component < 1 << 127);
}

#[test]
fn without_discs_there_is_no_step() {
    let mut engine = Box::new(Engine::<16, 4>::new());
    assert_eq!(engine.count(), 0);
    assert_eq!(engine.compute_forces(), Err(ForceError::NotInitialised));
    assert_refused(&mut engine, StepError::NotInitialised);
    assert_eq!((engine.position(0), engine.force(0), engine.crossings(0)), (None, None, None));
}

#[test]
fn a_failed_start_leaves_no_discs() {
    let mut engine = started::<4>(&BOX, &scattered(1, 4));
    assert!(engine.step().is_ok());
    let nonsense = Parameters { side: -1.0, ..BOX };
    let duplicates = [(0, Position::from_bits(0, 0)), (0, Position::from_bits(1 << 31, 0))];
    for (parameters, discs) in
        [(nonsense, with_ids(&scattered(1, 4))), (BOX, duplicates.to_vec()), (BOX, vec![])]
    {
        engine.init(&BOX, with_ids(&scattered(1, 4))).unwrap();
        assert!(engine.init(&parameters, discs).is_err());
        assert_eq!((engine.count(), engine.clock()), (0, Clock::START));
        assert_eq!(engine.state().slots, [] as [u32; 0]);
        assert_refused(&mut engine, StepError::NotInitialised);
        assert_eq!((engine.position(0), engine.force(0), engine.crossings(0)), (None, None, None));
    }
    engine.init(&BOX, with_ids(&scattered(1, 4))).unwrap();
    assert!(engine.step().is_ok());
}

#[test]
fn ids_beyond_the_last_have_no_disc() {
    let engine = started::<8>(&BOX, &scattered(1, 4));
    for id in [4, 7, 8, u32::MAX] {
        assert_eq!((engine.position(id), engine.force(id), engine.crossings(id)), (None, None, None));
    }
}
