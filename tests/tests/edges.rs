//! The edges of the ranges: each is driven to, and what is refused leaves the state as it was.

use meniscus_core::assignment::DISC;
use meniscus_core::crowding::{LARGEST_CELL, LARGEST_HEAP};
use meniscus_core::dynamics::{Clock, Disc, Dynamics, ForceError, InitError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::fields::LARGEST_FIELD_FORCE;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::near_part::table_length;
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::parameters::{
    Assignment, Influence, LARGEST_CAPILLARY_STRENGTH, LARGEST_PARTICLE_COUNT, LARGEST_SPLITTING_OF_SPACING,
    Method, Noise, ParameterError, Parameters, SPACING_RANGE,
};
use meniscus_core::repulsion::{CUTOFF, LARGEST_FORCE, SMALLEST_DISTANCE};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::{LARGEST_SIDE, Position};
use meniscus_core::transform::AnySize;
use meniscus_core::units::{FORCE_UNITS, TIME_UNITS, force_from_units, time_from_units};
use meniscus_tests::arrays::Arrays;
use meniscus_tests::long_tests;
use meniscus_tests::reference::RandomNumbers;
use meniscus_tests::states::{REPULSION as BOX, at, scattered, separated, separation, with_ids};

/// The split force of discs that do not repel each other, without screening.
const SPLIT: Parameters = Parameters {
    capillary_strength: 3.0,
    capillary_length: f64::INFINITY,
    repulsion: false,
    method: Method::P3m,
    influence: Influence::Optimal,
    assignment: Assignment::Order7,
    splitting: 0.1,
    cutoff: 6.0,
    ..BOX
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
        dynamics.step(&mut Scalar(AnySize), &mut arrays.memory()).unwrap();
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
    let count = if long_tests() { 4000 } else { 1000 };
    let (capillary_strength, splitting) = (1000.0, LARGEST_SPLITTING_OF_SPACING);
    let split = Parameters { capillary_strength, splitting, repulsion: true, ..SPLIT };
    for parameters in [Parameters { capillary_strength, ..BOX }, split] {
        let mut engine: Box<Roomy> = started(&parameters, &vec![Position::from_bits(3, 3); count]);
        let step = engine.step().unwrap();
        assert!(step.length > 0);
        // The lowest id is pushed to the right by all others, the highest to the left; the near part draws each pair
        // together with at most V0/0.9 R0, 0.0015 of it.
        let pair = engine.force(0).unwrap().0 / (count as i64 - 1);
        assert!(force_from_units(pair) > 0.998 * LARGEST_FORCE);
        for id in 0..count as i64 {
            let expected = (count as i64 - 1 - 2 * id) * pair;
            // The mesh adds no more than rounding to discs at one place.
            let off = engine.force(id as u32).unwrap().0 - expected;
            assert!(force_from_units(off.abs()) < LARGEST_FORCE, "{off}");
        }
    }
}

#[test]
fn the_total_force_stays_below_two_to_the_63() {
    // Every number here is an integer or rounded up.
    let in_units = |force: f64| (force * f64::from(FORCE_UNITS)).ceil() as u128;
    // 6 V0/h for each disc: see the modes below, and the mesh's own test of them.
    let mesh = in_units(6.0 * LARGEST_CAPILLARY_STRENGTH / SPACING_RANGE.0);
    let near = in_units(1.000_001 * LARGEST_CAPILLARY_STRENGTH / SMALLEST_DISTANCE);
    let repelling = 9 * u128::from(LARGEST_CELL);
    for (count, repelling) in [(LARGEST_HEAP, LARGEST_HEAP as u128), (LARGEST_PARTICLE_COUNT, repelling)] {
        let pairs = repelling * in_units(LARGEST_FORCE) + count as u128 * near;
        let component = pairs + count as u128 * mesh + in_units(LARGEST_FIELD_FORCE);
        assert!(component < 1 << 63, "{component:e} of {count} discs");
        assert!(2 * component * component < 1 << 127);
    }
}

/// Σ |influence · gradient| over all modes, in V0/h, which bounds the field of one disc's mass wherever it lies.
fn sum_of_moduli(parameters: &Parameters) -> f64 {
    let grid = parameters.grid;
    let (mut influence, mut gradient) = (vec![0.0; influence_length(grid)], vec![0.0; grid]);
    fill_influence(parameters, &mut influence);
    fill_gradient(parameters, &mut gradient);
    let mut sum = 0.0;
    for x in 0..grid {
        for y in 0..grid {
            let fold = |index: usize| index.min(grid - index);
            let entry = influence[fold(x) * (grid / 2 + 1) + fold(y)];
            sum += f64::from(entry.abs()) * libm::hypot(f64::from(gradient[x]), f64::from(gradient[y]));
        }
    }
    // The table holds half of what a mode is multiplied with, per 2⁻²⁰.
    2.0 * f64::from(DISC) * sum * (parameters.side / grid as f64) / parameters.capillary_strength
}

#[test]
fn the_modes_of_every_optimal_influence_function_add_up_to_less_than_six_v0_over_h() {
    let grids: &[usize] = if long_tests() { &[16, 32, 64, 128, 256, 512, 1024] } else { &[16, 64] };
    let mut largest: f64 = 0.0;
    for assignment in Assignment::ALL {
        for &grid in grids {
            for of_spacing in [0.1, 0.4, LARGEST_SPLITTING_OF_SPACING] {
                for spacing in [0.3, 16.0] {
                    let (side, splitting) = (spacing * grid as f64, of_spacing / spacing * (1.0 - 1e-15));
                    let parameters = Parameters { side, grid, splitting, assignment, cutoff: 1.5, ..SPLIT };
                    assert_eq!(parameters.validate(), Ok(()));
                    let sum = sum_of_moduli(&parameters);
                    assert!(sum < 6.0, "{sum} V0/h: {parameters:?}");
                    largest = largest.max(sum);
                }
            }
        }
    }
    println!("largest sum of moduli: {largest:.3} V0/h");
    assert!(largest > 2.0, "{largest} V0/h: not the sum that is meant");
}

/// Forces by id, kBT/R0.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn forces(parameters: &Parameters, discs: &[Position]) -> Vec<[f64; 2]> {
    let mut engine = started::<64>(parameters, discs);
    engine.compute_forces().unwrap();
    let force = |id: u32| engine.force(id).unwrap();
    (0..discs.len() as u32).map(|id| [force(id).0, force(id).1].map(force_from_units)).collect()
}

#[test]
fn a_cut_off_just_below_half_the_box_works_and_half_the_box_is_refused() {
    // One unit of position below.
    let below = 8.0 * (1.0 - 1.0 / 2_147_483_648.0);
    let wide = Parameters { cutoff: below, ..SPLIT };
    let narrow = Parameters { cutoff: 1.0, ..SPLIT };
    let discs = separated(2, 30, 16.0, 1.5);
    assert_eq!(discs.len(), 30);
    // What lies between the two cut-offs: V0·exp(−α²d²)/d of every pair.
    let unit = 16.0 / 4_294_967_296.0;
    let (wide_forces, narrow_forces) = (forces(&wide, &discs), forces(&narrow, &discs));
    for (first, (wide, narrow)) in discs.iter().zip(wide_forces.iter().zip(&narrow_forces)) {
        let mut expected = [0.0; 2];
        for second in discs.iter().filter(|&second| second != first) {
            let along = |to: u32, from: u32| f64::from(to.wrapping_sub(from) as i32) * unit;
            let x = along(second.x.to_bits(), first.x.to_bits());
            let y = along(second.y.to_bits(), first.y.to_bits());
            let squared = x * x + y * y;
            if squared < 64.0 {
                let pull = 3.0 * libm::exp(-0.01 * squared) / squared;
                expected = [expected[0] + pull * x, expected[1] + pull * y];
            }
        }
        for axis in 0..2 {
            // 29 pairs of at most 3 kBT / 1.5 R0, each good to 10⁻⁶.
            let off = (wide[axis] - narrow[axis] - expected[axis]).abs();
            assert!(off < 29.0 * 2.0e-6, "{off}");
        }
    }
    let mut engine = started::<64>(&Parameters { repulsion: true, noise: Noise::Uniform, ..wide }, &discs);
    for _ in 0..20 {
        engine.step().unwrap();
    }
    for cutoff in [below.next_up(), 8.0_f64.next_down(), 8.0] {
        let refused = engine.init(&Parameters { cutoff, ..SPLIT }, with_ids(&discs));
        assert_eq!(refused, Err(InitError::Parameters(ParameterError::CutoffTooLarge)));
    }
}

#[test]
fn discs_half_a_box_apart_have_no_near_part_whatever_the_box() {
    let mut random = RandomNumbers::new(1);
    let half = 1 << 31;
    for _ in 0..200 {
        let side = 16.0 + 200.0 * random.uniform();
        let splitting = 0.5 / side;
        let parameters = Parameters { side, splitting, cutoff: 0.5 * side * (1.0 - 1e-9), ..SPLIT };
        for place in [(half, 0), (0, half), (half, 5), (half, half)] {
            let discs = [Position::from_bits(0, 0), Position::from_bits(place.0, place.1)];
            // As far as both discs are alike there is no telling which way; the mesh adds rounding. Beyond half a box
            // the near part would be V0·0.9/d, a hundred times that.
            for force in forces(&parameters, &discs) {
                let bound = 0.01 * 3.0 / (0.5 * side);
                assert!(force.iter().all(|component| component.abs() < bound), "{force:?}, side {side}");
            }
        }
    }
}

#[test]
fn an_engine_with_too_short_a_table_refuses_the_cut_off() {
    const SEGMENTS: usize = table_length(6.0);
    let discs = with_ids(&scattered(1, 4));
    let mut engine = Box::new(Engine::<16, 4, SEGMENTS>::new());
    assert_eq!(engine.init(&SPLIT, discs.iter().copied()), Ok(()));
    assert!(engine.step().is_ok());
    let mut long = Box::new(Engine::<16, 4>::new());
    long.init(&SPLIT, discs.iter().copied()).unwrap();
    assert!(long.step().is_ok());
    assert_eq!(engine.state().digest(), long.state().digest());
    let further = Parameters { cutoff: 7.9, ..SPLIT };
    assert_eq!(engine.init(&further, discs.iter().copied()), Err(InitError::Memory));
    assert_eq!(engine.count(), 0);
    let mut shorter = Box::new(Engine::<16, 4, { SEGMENTS - 1 }>::new());
    assert_eq!(shorter.init(&SPLIT, discs.iter().copied()), Err(InitError::Memory));
    let mut none = Box::new(Engine::<16, 4, 0>::new());
    assert_eq!(none.init(&SPLIT, discs.iter().copied()), Err(InitError::Memory));
    // Without a near part, none is needed.
    assert_eq!(none.init(&Parameters { capillary_strength: 0.0, ..SPLIT }, discs.iter().copied()), Ok(()));
    assert!(none.step().is_ok());
    assert_eq!(none.init(&Parameters { capillary_strength: 1.0, ..BOX }, discs.iter().copied()), Ok(()));
    assert!(none.step().is_ok());
}

#[test]
fn memory_that_became_too_short_is_refused_and_the_state_stays() {
    let changes: [fn(&mut Arrays); 6] = [
        |arrays| arrays.near.truncate(table_length(6.0) - 1),
        |arrays| arrays.strengths.truncate(3),
        |arrays| arrays.influence.truncate(80),
        |arrays| arrays.nodes.truncate(255),
        |arrays| arrays.field.truncate(255),
        |arrays| arrays.lines.truncate(31),
    ];
    for change in changes {
        let mut arrays = Arrays::new(16, 1, 4);
        let discs = with_ids(&scattered(1, 4));
        let mut dynamics = Dynamics::new(&SPLIT, Clock::START, discs, &mut arrays.memory()).unwrap();
        let whole = arrays.clone();
        change(&mut arrays);
        assert_eq!(dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory()), Err(ForceError::Memory));
        assert_eq!(dynamics.step(&mut Scalar(AnySize), &mut arrays.memory()), Err(StepError::Memory));
        assert_eq!((dynamics.clock(), &arrays.x, &arrays.y), (Clock::START, &whole.x, &whole.y));
        arrays = whole;
        assert!(dynamics.step(&mut Scalar(AnySize), &mut arrays.memory()).is_ok());
    }
}

/// Discs of the strengths at one place each, on mesh nodes a quarter of the box apart.
fn with_strengths(strengths: &[i32]) -> impl Iterator<Item = Disc> {
    let place = |id: u32| Position::from_bits(id << 30, (id >> 2) << 30);
    (0..).zip(strengths).map(move |(id, &strength)| Disc { id, position: place(id), strength })
}

#[test]
fn the_largest_strengths_work_and_larger_ones_are_refused() {
    let one = DISC as i32;
    let mut engine = Box::new(Engine::<16, 4>::new());
    let cases = [
        (1.0e-3, 1000 * one, true),
        (1.0e-3, -1000 * one, true),
        (1.0e-3, 1000 * one + 1, false),
        (0.0, 1000 * one, true),
        (0.0, -1000 * one - 1, false),
        (0.0, i32::MIN, false),
        (0.0, i32::MAX, false),
        (1.1e-3, 1000 * one, false),
        (1000.0, -one, true),
        (1000.0, one + 1, false),
        (250.0, 2 * one, true),
    ];
    for (capillary_strength, strength, accepted) in cases {
        for parameters in [SPLIT, BOX] {
            let parameters = Parameters { capillary_strength, ..parameters };
            let result = engine.init(&parameters, with_strengths(&[0, strength, -one / 2]));
            let expected = if accepted { Ok(()) } else { Err(InitError::Strength { id: 1 }) };
            assert_eq!(result, expected, "V0 = {capillary_strength}, strength {strength}");
            assert_eq!(engine.step().is_ok(), accepted);
        }
    }
}

#[test]
fn a_node_with_strengths_of_more_than_2047_is_refused_whatever_their_signs() {
    let parameters = Parameters { capillary_strength: 1e-3, repulsion: false, ..BOX };
    let one = DISC as i32;
    let on_a_node = |id: u32, strength| Disc { id, position: Position::from_bits(1 << 28, 0), strength };
    for sign in [1, -1] {
        let mut engine = Box::new(Engine::<16, 4>::new());
        let full = [on_a_node(0, 1000 * one), on_a_node(1, sign * 1000 * one), on_a_node(2, sign * 47 * one)];
        engine.init(&parameters, full).unwrap();
        assert!(engine.step().is_ok());
        let crowded =
            [on_a_node(0, 1000 * one), on_a_node(1, sign * 1000 * one), on_a_node(2, sign * 48 * one)];
        engine.init(&parameters, crowded).unwrap();
        assert_eq!(engine.compute_forces(), Err(ForceError::Crowded));
        assert_refused(&mut engine, StepError::Crowded);
    }
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
