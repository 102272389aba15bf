//! Mesh forces held over several steps: what is held, when it is computed anew, and that it is part of the state.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::engine::{Engine, EngineError, Kind, Machinery};
use meniscus::files::state::State;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::{Clock, Disc, Dynamics, ForceError, InitError, StepError};
use meniscus_core::engine::Engine as CoreEngine;
use meniscus_core::near_part::LARGEST_TABLE;
use meniscus_core::parameters::{MESH_REFRESH_RANGE, Noise, ParameterError, Parameters};
use meniscus_core::refresh::{HeldForce, Refresh, largest_mesh_force};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::{Position, minimum_image};
use meniscus_core::transform::AnySize;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::states::{lattice, scattered, separated, shuffled, with_ids};

const SIDE: f64 = 64.0;
const COUNT: usize = 100;

/// The split force, held until a disc has moved `distance`.
fn split(distance: f64) -> Parameters {
    let parameters = Parameters { side: SIDE, grid: 32, ..Parameters::DEFAULT }.with_p3m();
    Parameters { mesh_refresh: distance, ..parameters }
}

fn discs() -> Vec<Position> {
    separated(3, COUNT, SIDE, 2.2)
}

fn started(parameters: &Parameters, discs: &[Position]) -> Engine {
    Engine::new(parameters, Clock::START, discs).unwrap()
}

fn digest(engine: &Engine) -> Digest {
    engine.state().digest()
}

/// What a state file of this engine would hold.
fn saved(engine: &Engine) -> State {
    let Clock { step, time } = engine.clock();
    let (positions, strengths) = (engine.positions(), Some(engine.strengths()));
    State { step, time, positions, strengths, held: engine.held() }
}

/// An engine that goes on from the bytes of a state file.
fn resumed(parameters: &Parameters, bytes: &[u8]) -> Engine {
    let State { step, time, positions, held, .. } = State::from_bytes(bytes).unwrap();
    let mut engine = Engine::new(parameters, Clock { step, time }, &positions).unwrap();
    if let Some(held) = held {
        engine.hold(&held).unwrap();
    }
    engine
}

/// All forces on discs at these positions, nothing held, in the order of ids, kBT/R0.
fn total_forces(parameters: &Parameters, positions: &[Position]) -> Vec<[f64; 2]> {
    started(parameters, positions).forces().unwrap()
}

#[test]
fn forces_are_computed_anew_when_a_disc_has_come_so_far_and_not_before() {
    for parameters in [split(0.3), Parameters { noise: Noise::None, ..split(0.005) }] {
        let distance = parameters.mesh_refresh;
        let mut engine = started(&parameters, &discs());
        let (mut reference, mut refreshed) = (None, 0);
        for _ in 0..60 {
            let before = engine.positions();
            let farthest = |reference: &Vec<Position>| {
                let along = |to, from| f64::from(minimum_image(to, from)) * (SIDE / 4_294_967_296.0);
                let moved = before
                    .iter()
                    .zip(reference)
                    .map(|(to, from)| libm::hypot(along(to.x, from.x), along(to.y, from.y)));
                moved.fold(0.0, f64::max)
            };
            // The threshold is rounded up by less than a unit, 1.5e-8 R0.
            let farthest = reference.as_ref().map(farthest);
            let is_due = farthest.is_none_or(|farthest| farthest >= distance);
            assert!(farthest.is_none_or(|farthest| (farthest - distance).abs() > 1e-7), "too near to tell");
            let step = engine.step().unwrap();
            assert_eq!(step.refreshed, is_due);
            if step.refreshed {
                reference = Some(before);
                refreshed += 1;
            }
            let held: Vec<Position> = engine.held().unwrap().iter().map(|held| held.reference).collect();
            assert_eq!(Some(&held), reference.as_ref());
        }
        assert!(refreshed > 3 && refreshed < 40, "{refreshed}");
        let reuse = engine.mesh_reuse().unwrap();
        assert_eq!((reuse.steps, reuse.transforms), (60, refreshed));
    }
}

#[test]
fn what_is_held_is_the_force_of_the_mesh_where_it_was_computed_and_pairs_are_fresh() {
    let parameters = split(0.3);
    let mut engine = started(&parameters, &discs());
    assert_eq!(engine.held(), None);
    engine.step().unwrap();
    while engine.step().unwrap().refreshed {}
    let (held, positions) = (engine.held().unwrap(), engine.positions());
    let references: Vec<Position> = held.iter().map(|held| held.reference).collect();
    assert_ne!(references, positions);
    let of = |positions: &[Position]| {
        let mut engine = started(&parameters, positions);
        engine.step().unwrap();
        engine.held().unwrap()
    };
    assert_eq!(of(&references), held);
    // The forces differ from those of a run that holds none by the age of the mesh's share, to the unit.
    let (fresh, present) = (of(&positions), total_forces(&split(0.0), &positions));
    let units = |force: f64| (force * 16_777_216.0) as i64;
    let mut largest = 0;
    for (id, force) in engine.forces().unwrap().into_iter().enumerate() {
        let aged = [held[id].force.0 - fresh[id].force.0, held[id].force.1 - fresh[id].force.1];
        for axis in 0..2 {
            assert_eq!(units(force[axis]) - units(present[id][axis]), aged[axis], "disc {id}");
            largest = largest.max(aged[axis].abs());
        }
    }
    assert!(largest > 1000, "nothing was old: {largest} units");
}

#[test]
fn looking_changes_no_bit() {
    for parameters in [split(0.3), split(0.02), Parameters { noise: Noise::None, ..split(0.005) }] {
        let (mut plain, mut watched) = (started(&parameters, &discs()), started(&parameters, &discs()));
        for step in 0..60 {
            for look in 0..step % 4 {
                let before = digest(&watched);
                let next = watched.next_step().unwrap();
                let forces = watched.forces().unwrap();
                assert_eq!(watched.next_step().unwrap(), next, "look {look}");
                assert_eq!(watched.forces().unwrap(), forces);
                assert_eq!(digest(&watched), before);
            }
            let next = plain.next_step().unwrap();
            let done = plain.step().unwrap();
            assert_eq!((done.length, done.largest_force), next);
            assert_eq!(watched.step().unwrap(), done);
            assert_eq!(digest(&watched), digest(&plain));
        }
    }
}

#[test]
fn a_restart_after_any_step_goes_on_bit_for_bit() {
    let parameters = split(0.3);
    let mut straight = started(&parameters, &discs());
    let mut chained = started(&parameters, &discs());
    let mut refreshed = Vec::new();
    for step in 0..60 {
        let bytes = saved(&chained).to_bytes();
        assert_eq!(digest(&chained).length, bytes.len() as u64);
        chained = resumed(&parameters, &bytes);
        assert_eq!(saved(&chained).to_bytes(), bytes, "step {step}");
        let done = straight.step().unwrap();
        assert_eq!(chained.step().unwrap(), done, "step {step}");
        assert_eq!(digest(&chained), digest(&straight), "step {step}");
        refreshed.push(done.refreshed);
    }
    assert!(refreshed.iter().any(|&fresh| fresh) && refreshed.iter().any(|&fresh| !fresh));
    // What is held matters: without it the run is another.
    while straight.step().unwrap().refreshed {}
    let without = State { held: None, ..saved(&straight) };
    let mut without = resumed(&parameters, &without.to_bytes());
    assert!(without.step().unwrap().refreshed);
    straight.step().unwrap();
    assert_ne!(straight.positions(), without.positions());
}

#[test]
fn the_core_s_engine_goes_on_bit_for_bit_too() {
    type Core = CoreEngine<32, 120, LARGEST_TABLE, 110>;
    let parameters = split(0.3);
    let mut host = started(&parameters, &discs());
    let mut core = Box::new(Core::new());
    core.init(&parameters, with_ids(&discs())).unwrap();
    assert_eq!(core.held(0), None);
    for _ in 0..60 {
        assert_eq!(core.step(), host.step().map_err(|_| StepError::Memory));
        assert_eq!(core.state().digest(), digest(&host));
        let ids = || 0..core.count() as u32;
        let held: Vec<HeldForce> = ids().filter_map(|id| core.held(id)).collect();
        assert_eq!(held, host.held().unwrap());
        let mut again = Box::new(Core::new());
        let discs: Vec<_> = ids().filter_map(|id| Some((id, core.position(id)?))).collect();
        again.init_at(&parameters, core.clock(), shuffled(8, &discs)).unwrap();
        again.hold(held).unwrap();
        assert_eq!(again.state().digest(), core.state().digest());
        core = again;
    }
}

#[test]
fn storage_order_and_machinery_change_no_bit() {
    let strengths = |(id, position)| Disc { strength: (1 << 19) << (id % 3), ..Disc::from((id, position)) };
    let discs: Vec<Disc> = with_ids(&discs()).into_iter().map(strengths).collect();
    let mut engines = Vec::new();
    for (seed, kind, threads) in
        [(0, Kind::Core, 1), (1, Kind::Core, 1), (2, Kind::Host, 1), (3, Kind::Host, 3)]
    {
        let machinery = Machinery { kind, threads };
        let order = if seed == 0 { discs.clone() } else { shuffled(seed, &discs) };
        engines.push(Engine::with_machinery(machinery, &split(0.3), Clock::START, order).unwrap());
    }
    for _ in 0..40 {
        let mut seen = engines.iter_mut().map(|engine| {
            let step = engine.step().unwrap();
            (step, digest(engine), engine.held(), engine.forces().unwrap())
        });
        let first = seen.next().unwrap();
        seen.for_each(|other| assert_eq!(other, first));
    }
}

#[test]
fn a_tiny_distance_gives_the_positions_of_none() {
    let (mut off, mut tiny) =
        (started(&split(0.0), &discs()), started(&split(MESH_REFRESH_RANGE.0), &discs()));
    for _ in 0..60 {
        assert_eq!(off.step().unwrap(), tiny.step().unwrap());
        assert_eq!(off.positions(), tiny.positions());
    }
    assert_eq!((off.mesh_reuse(), off.held()), (None, None));
    assert_eq!(tiny.mesh_reuse().unwrap().saved(), 0.0);
    // The rms of what changes in one step.
    assert!(tiny.mesh_reuse().unwrap().error().unwrap() > 0.0);
}

#[test]
fn the_measured_error_grows_with_the_distance_and_is_a_few_per_cent_at_0_3() {
    let mut errors = Vec::new();
    for distance in [0.1, 0.3, 1.0] {
        let mut engine = started(&split(distance), &discs());
        for _ in 0..200 {
            engine.step().unwrap();
        }
        let reuse = engine.mesh_reuse().unwrap();
        println!("{distance} R0: error {:?}, saved {:.2}", reuse.error(), reuse.saved());
        errors.push((reuse.error().unwrap(), reuse.saved()));
    }
    assert!(errors.is_sorted_by(|a, b| 1.5 * a.0 < b.0 && a.1 < b.1), "{errors:?}");
    let (at_0_3, saved) = errors[1];
    assert!((0.002..0.1).contains(&at_0_3) && saved > 0.5, "{errors:?}");
}

#[test]
fn the_measured_error_is_that_of_the_held_forces() {
    let parameters = Parameters { noise: Noise::None, ..split(0.01) };
    let mut engine = started(&parameters, &discs());
    let (mut difference, mut force) = (0.0, 0.0);
    for _ in 0..60 {
        let old = engine.held();
        if engine.step().unwrap().refreshed
            && let Some(old) = old
        {
            for (old, new) in old.iter().zip(engine.held().unwrap()) {
                let components = [(old.force.0, new.force.0), (old.force.1, new.force.1)];
                for (old, new) in components.map(|(old, new)| (old as f64, new as f64)) {
                    difference += (new - old) * (new - old);
                    force += new * new;
                }
            }
        }
    }
    let error = engine.mesh_reuse().unwrap().error().unwrap();
    assert!((error / (difference / force).sqrt() - 1.0).abs() < 1e-9, "{error}");
}

#[test]
fn a_step_that_fails_keeps_nothing() {
    // A step of time that overflows after the forces were found to be due.
    let parameters = split(0.3);
    let time = u64::MAX - (1 << 20);
    let mut engine = Engine::new(&parameters, Clock { step: 7, time }, &discs()).unwrap();
    let before = digest(&engine);
    assert!(matches!(engine.step(), Err(EngineError::Step(StepError::TimeOverflow, _))));
    assert_eq!((digest(&engine), engine.held()), (before, None));
    // With forces held that are due.
    let mut going = started(&parameters, &discs());
    loop {
        let state = saved(&going);
        if going.step().unwrap().refreshed && state.held.is_some() {
            let late = State { time, ..state };
            let mut engine = resumed(&parameters, &late.to_bytes());
            assert!(matches!(engine.step(), Err(EngineError::Step(StepError::TimeOverflow, _))));
            assert_eq!(saved(&engine), State { strengths: saved(&engine).strengths, ..late });
            assert_eq!(engine.mesh_reuse().unwrap().steps, 0);
            break;
        }
    }
}

#[test]
fn nothing_is_held_where_nothing_attracts() {
    let parameters = Parameters { capillary_strength: 0.0, ..split(0.3) };
    let mut engine = started(&parameters, &discs());
    let mut off = started(&Parameters { mesh_refresh: 0.0, ..parameters }, &discs());
    for _ in 0..10 {
        engine.step().unwrap();
        off.step().unwrap();
        assert_eq!(digest(&engine), digest(&off));
    }
    assert_eq!((engine.held(), engine.mesh_reuse()), (None, None));
}

#[test]
fn held_forces_are_ignored_by_a_run_that_holds_none() {
    let mut engine = started(&split(0.3), &discs());
    engine.step().unwrap();
    let bytes = saved(&engine).to_bytes();
    let mut off = resumed(&split(0.0), &bytes);
    assert_eq!(off.held(), None);
    assert_eq!(digest(&off).length, 32 + 8 * COUNT as u64);
    assert_eq!(digest(&engine).length, 32 + 8 * COUNT as u64 + 12 + 24 * COUNT as u64);
    off.step().unwrap();
}

#[test]
fn a_run_without_room_to_hold_is_refused() {
    let mut none = Box::new(CoreEngine::<32, 120>::new());
    assert_eq!(none.init(&split(0.3), with_ids(&discs())), Err(InitError::NoRoomToHold));
    assert_eq!(none.count(), 0);
    assert_eq!(none.init(&split(0.0), with_ids(&discs())), Ok(()));
    let mut little = Box::new(CoreEngine::<32, 120, LARGEST_TABLE, { COUNT - 1 }>::new());
    assert_eq!(little.init(&split(0.3), with_ids(&discs())), Err(InitError::NoRoomToHold));
    let mut right = Box::new(CoreEngine::<32, 120, LARGEST_TABLE, COUNT>::new());
    assert_eq!(right.init(&split(0.3), with_ids(&discs())), Ok(()));
    assert!(right.step().is_ok());
}

#[test]
fn memory_that_became_too_short_to_hold_is_refused() {
    let changes: [fn(&mut Arrays); 6] = [
        |arrays| arrays.held_x.truncate(COUNT - 1),
        |arrays| arrays.held_y.truncate(COUNT - 1),
        |arrays| arrays.fresh_x.truncate(COUNT - 1),
        |arrays| arrays.fresh_y.truncate(COUNT - 1),
        |arrays| arrays.reference_x.truncate(COUNT - 1),
        |arrays| arrays.reference_y.truncate(COUNT - 1),
    ];
    let stages = &mut Scalar(AnySize);
    for change in changes {
        let mut arrays = Arrays::new(32, 1, COUNT);
        let start = with_ids(&discs());
        let mut dynamics = Dynamics::new(&split(0.3), Clock::START, start, &mut arrays.memory()).unwrap();
        let whole = arrays.clone();
        change(&mut arrays);
        assert_eq!(dynamics.forces(stages, &mut arrays.memory()), Err(ForceError::Memory));
        assert_eq!(dynamics.step(stages, &mut arrays.memory()), Err(StepError::Memory));
        let held = vec![HeldForce::default(); COUNT];
        assert_eq!(dynamics.hold(held, &mut arrays.memory()), Err(InitError::NoRoomToHold));
        arrays = whole;
        assert!(dynamics.step(stages, &mut arrays.memory()).is_ok());
    }
}

#[test]
fn held_forces_that_cannot_be_are_refused() {
    let mut engine = started(&split(0.3), &discs());
    let fresh = digest(&engine);
    let most = largest_mesh_force(COUNT) as i64;
    let held = |changes: &[(usize, (i64, i64))], count: usize| {
        let mut held = vec![HeldForce::default(); count];
        changes.iter().for_each(|&(id, force)| held[id].force = force);
        held
    };
    assert_eq!(engine.hold(&held(&[(5, (most, -most))], COUNT)), Ok(()));
    for (changes, count, id) in [
        (vec![(5, (most + 1, 0))], COUNT, 5),
        (vec![(7, (0, -most - 1)), (9, (i64::MIN, 0))], COUNT, 7),
        (vec![(COUNT - 1, (0, i64::MAX))], COUNT, COUNT - 1),
        (vec![], COUNT - 1, COUNT - 1),
        (vec![], 0, 0),
        (vec![], COUNT + 1, COUNT),
    ] {
        let refused = engine.hold(&held(&changes, count));
        assert_eq!(refused, Err(EngineError::Init(InitError::HeldForce { id: id as u32 })));
        assert!(refused.unwrap_err().to_string().contains(&format!("disc {id} ")));
        // Nothing is held then.
        assert_eq!((engine.held(), digest(&engine)), (None, fresh));
    }
    assert!(engine.step().unwrap().refreshed);
    // Of a real run none is refused, and the bound is far away.
    let largest = engine.held().unwrap().iter().map(|held| held.force.0.abs()).max().unwrap();
    assert!(largest > 0 && largest < most / 100, "{largest} of {most}");
}

#[test]
fn distances_out_of_range_are_refused() {
    let of = |distance: f64, side: f64| Parameters { mesh_refresh: distance, side, ..split(0.0) }.validate();
    let (least, most) = MESH_REFRESH_RANGE;
    for distance in [0.0, -0.0, least, 0.3, 15.9, most] {
        assert_eq!(of(distance, 65.0), Ok(()), "{distance}");
    }
    for distance in [least.next_down(), -0.3, f64::MIN_POSITIVE, most.next_up(), f64::NAN, f64::INFINITY] {
        assert_eq!(of(distance, 65.0), Err(ParameterError::MeshRefresh), "{distance}");
    }
    for distance in [10.0, 12.0, most] {
        assert_eq!(of(distance, 40.0), Err(ParameterError::MeshRefreshTooLarge), "{distance}");
    }
    assert_eq!(of(10.0_f64.next_down(), 40.0), Ok(()));
}

#[test]
fn the_distance_is_compared_exactly_and_across_the_border() {
    // 2⁻²⁰ R0 in the largest box is less than a unit of position, and held as one.
    assert!(Refresh::new(MESH_REFRESH_RANGE.0, 65536.0).holds());
    assert!(!Refresh::new(0.0, 65536.0).holds());
    // 5 units in a box of 2³² · 0.1 R0.
    let refresh = Refresh::new(0.5, 0.1 * 4_294_967_296.0);
    let moved = |(x, y): (u32, u32), (from_x, from_y): (u32, u32)| {
        let (to, from) = (Position::from_bits(x, y), Position::from_bits(from_x, from_y));
        refresh.is_due((&[from.x], &[from.y]), (&[to.x], &[to.y]))
    };
    for base in [0, 2, u32::MAX - 1, 1 << 31] {
        let at = |x: i32, y: i32| (base.wrapping_add_signed(x), base.wrapping_add_signed(y));
        for (x, y) in [(3, 4), (-3, 4), (5, 0), (0, -5), (4, -3), (6, 6), (i32::MIN, i32::MIN)] {
            assert!(moved(at(x, y), at(0, 0)) && moved(at(0, 0), at(x, y)), "({x}, {y})");
        }
        for (x, y) in [(0, 0), (3, 3), (-4, 2), (4, -2), (0, 4)] {
            assert!(!moved(at(x, y), at(0, 0)) && !moved(at(0, 0), at(x, y)), "({x}, {y})");
        }
    }
}

#[test]
fn the_section_of_the_bytes_is_as_documented() {
    let positions = lattice(2);
    let forces = [(1, -1), (i64::from(u32::MAX) + 1, 0x0102_0304_0506), (0, -2), (-3, 4)];
    let held: Vec<HeldForce> = scattered(6, 4)
        .into_iter()
        .zip(forces)
        .map(|(reference, force)| HeldForce { reference, force })
        .collect();
    let state = State { held: Some(held.clone()), ..State::at_start(positions) };
    let bytes = state.to_bytes();
    let section = &bytes[32 + 8 * 4..];
    assert_eq!(section[..12], *b"HELD\x60\0\0\0\0\0\0\0");
    let mut expected = Vec::new();
    for held in &held {
        expected.extend(held.reference.x.to_bits().to_le_bytes());
        expected.extend(held.reference.y.to_bits().to_le_bytes());
        expected.extend(held.force.0.to_le_bytes());
        expected.extend(held.force.1.to_le_bytes());
    }
    assert_eq!(section[12..], expected);
    assert_eq!(State::from_bytes(&bytes), Ok(state.clone()));
    for held in held {
        assert_eq!(HeldForce::from_bytes(&held.to_bytes()), held);
    }
    // After strengths.
    let both = State { strengths: Some(vec![1, 2, 3, 4]), ..state };
    let bytes = both.to_bytes();
    assert_eq!(bytes[64..68], *b"STRE");
    assert_eq!(bytes[64 + 12 + 16..][..4], *b"HELD");
    assert_eq!(State::from_bytes(&bytes), Ok(both));
}

#[test]
fn damaged_sections_are_refused_with_what_is_wrong() {
    let held = vec![HeldForce { force: (5, 6), ..HeldForce::default() }; 2];
    let state = State { held: Some(held), ..State::at_start(vec![Position::from_bits(3, 4); 2]) };
    let bytes = state.to_bytes();
    let message = |bytes: &[u8]| State::from_bytes(bytes).unwrap_err().to_string();
    assert_eq!(bytes.len(), 48 + 12 + 48);
    for cut in 49..bytes.len() {
        let expected = format!("the state is cut off: {cut} bytes of {}", bytes.len());
        assert_eq!(message(&bytes[..cut]), expected);
    }
    assert!(State::from_bytes(&bytes[..48]).is_ok_and(|state| state.held.is_none()));
    let longer = [&bytes[..], &[0]].concat();
    assert_eq!(message(&longer), "the state is followed by other bytes: it ends after 108");
    let changed = |at: usize, to: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = to;
        message(&bytes)
    };
    assert_eq!(changed(48, b'h'), "the state is followed by other bytes: it ends after 48");
    let remedy = "the file was altered; start from another state of the run";
    assert_eq!(changed(52, 49), format!("the state has 49 bytes of held forces, expected 48: {remedy}"));
    // The sign of disc 1's force along x.
    let expected = "the held force of disc 1 is larger than the mesh force of so many discs can be";
    assert_eq!(changed(48 + 12 + 24 + 15, 0x80), format!("{expected}: {remedy}"));
    // Strengths come first, and each section once.
    let swapped = [&bytes[..], b"STRE", &8_u64.to_le_bytes(), &[1; 8]].concat();
    assert_eq!(message(&swapped), "the state is followed by other bytes: it ends after 108");
    let twice = [&bytes[..], &bytes[48..]].concat();
    assert_eq!(message(&twice), "the state is followed by other bytes: it ends after 108");
    // Of no disc nothing is held.
    let mut empty = State::default().to_bytes();
    empty.extend(b"HELD\0\0\0\0\0\0\0\0");
    assert_eq!(message(&empty), "the state is followed by other bytes: it ends after 32");
}
