//! The same bits for any order, capacity, memory layout and restart, with either method.

use meniscus_core::dynamics::{Clock, Dynamics};
use meniscus_core::engine::Engine;
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::Position;
use meniscus_core::transform::AnySize;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::schemes::BOTH;
use meniscus_tests::states::{crowded, scattered, shuffled, with_ids};
use proptest::prelude::*;

/// All forces and noise, in a dense box.
const EVERYTHING: Parameters =
    Parameters { side: 40.0, capillary_strength: 5.0, capillary_length: 20.0, grid: 32, ..Parameters::PAPER };

/// The same with either method.
fn methods() -> [Parameters; 2] {
    BOTH.map(|scheme| scheme.of(EVERYTHING))
}

type Small = Engine<32, 160>;

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn started<const N: usize>(parameters: &Parameters, discs: &[(u32, Position)]) -> Box<Engine<32, N>> {
    let mut engine = Box::new(Engine::new());
    engine.init(parameters, discs.iter().copied()).unwrap();
    engine
}

/// What must not depend on storage: digest of the state, forces and crossings by id.
#[derive(Debug, PartialEq)]
struct Seen {
    state: meniscus_core::digest::StateDigest,
    forces: Vec<Option<(i64, i64)>>,
    crossings: Vec<Option<(i32, i32)>>,
}

fn seen<const N: usize>(engine: &Engine<32, N>) -> Seen {
    let ids = || 0..engine.count() as u32;
    Seen {
        state: engine.state().digest_by_field(),
        forces: ids().map(|id| engine.force(id)).collect(),
        crossings: ids().map(|id| engine.crossings(id)).collect(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_storage_changes_no_bit(
        seed in any::<u64>(),
        order in any::<u64>(),
        count in 2_usize..160,
        width in 0.05..0.5_f64,
        scheme in prop::sample::select(&BOTH[..]),
        assignment in prop::sample::select(&Assignment::ALL[..]),
        noise in prop::sample::select(&[Noise::Uniform, Noise::Gaussian, Noise::None][..]),
    ) {
        let parameters = Parameters { assignment, noise, ..scheme.of(EVERYTHING) };
        // The last two coincide.
        let mut discs = crowded(seed, count, width);
        discs[count - 1] = discs[count - 2];
        let discs = with_ids(&discs);
        let mut in_order = started::<160>(&parameters, &discs);
        let mut mixed = started::<160>(&parameters, &shuffled(order, &discs));
        prop_assert_eq!(seen(&mixed).state, seen(&in_order).state);
        for _ in 0..5 {
            prop_assert_eq!(mixed.step(), in_order.step());
            prop_assert_eq!(seen(&mixed), seen(&in_order));
        }
    }
}

#[test]
fn the_order_of_storage_changes_no_bit_in_many_steps() {
    for parameters in methods() {
        let discs = with_ids(&scattered(1, 150));
        let mut in_order = started::<160>(&parameters, &discs);
        let mut mixed: Vec<Box<Small>> =
            (1..4).map(|order| started(&parameters, &shuffled(order, &discs))).collect();
        for _ in 0..60 {
            let step = in_order.step();
            assert!(step.is_ok());
            for engine in &mut mixed {
                assert_eq!(engine.step(), step);
                assert_eq!(seen(engine), seen(&in_order));
            }
        }
    }
}

#[test]
fn ids_carry_the_identity_of_a_disc() {
    for parameters in methods() {
        // The same places under other ids are another state: the noise follows the id.
        let discs = scattered(1, 150);
        let exchanged: Vec<Position> = discs.iter().rev().copied().collect();
        let mut first = started::<160>(&parameters, &with_ids(&discs));
        let mut second = started::<160>(&parameters, &with_ids(&exchanged));
        assert!(first.step().is_ok() && second.step().is_ok());
        let reversed = (0..150).all(|id| first.position(id) == second.position(149 - id));
        assert!(!reversed);
        // The forces are those of the places.
        assert!((0..150).all(|id| first.force(id) == second.force(149 - id)));
    }
}

#[test]
fn capacity_changes_no_bit() {
    for parameters in methods() {
        let discs = with_ids(&scattered(2, 100));
        let mut tight = started::<100>(&parameters, &discs);
        let mut roomy = started::<999>(&parameters, &discs);
        for _ in 0..20 {
            assert_eq!(tight.step(), roomy.step());
            assert_eq!(seen(&tight), seen(&roomy));
        }
    }
}

#[test]
fn memory_owned_elsewhere_changes_no_bit() {
    for parameters in methods() {
        let discs = with_ids(&scattered(3, 100));
        for rows in [1, 5, 8] {
            let mut engine = started::<160>(&parameters, &discs);
            let mut arrays = Arrays::new(32, rows, 123);
            let mut dynamics =
                Dynamics::new(&parameters, Clock::START, discs.iter().copied(), &mut arrays.memory())
                    .unwrap();
            for _ in 0..20 {
                assert_eq!(dynamics.step(&mut Scalar(AnySize), &mut arrays.memory()), engine.step());
                let state =
                    dynamics.state(&arrays.slots, (&arrays.x, &arrays.y), &arrays.strengths, arrays.held());
                assert_eq!(state.digest(), engine.state().digest());
            }
        }
    }
}

#[test]
fn a_restart_after_any_step_changes_no_bit() {
    for parameters in methods() {
        let discs = with_ids(&scattered(4, 100));
        let mut straight = started::<160>(&parameters, &discs);
        let mut restarted = started::<160>(&parameters, &discs);
        for step in 0..30 {
            assert_eq!(restarted.step(), straight.step());
            assert_eq!(seen(&restarted).state, seen(&straight).state);
            // Only clock and positions are carried over, in another order each time.
            let clock = restarted.clock();
            let positions: Vec<Position> = (0..100).map(|id| restarted.position(id).unwrap()).collect();
            *restarted = Small::new();
            restarted.init_at(&parameters, clock, shuffled(step, &with_ids(&positions))).unwrap();
        }
    }
}

#[test]
fn an_engine_used_before_is_as_good_as_a_fresh_one() {
    for parameters in methods() {
        let discs = with_ids(&scattered(5, 100));
        let mut used = started::<160>(&Parameters { seed: 9, ..parameters }, &with_ids(&scattered(6, 160)));
        for _ in 0..10 {
            assert!(used.step().is_ok());
        }
        used.init(&parameters, discs.iter().copied()).unwrap();
        let mut fresh = started::<160>(&parameters, &discs);
        for _ in 0..10 {
            assert_eq!(used.step(), fresh.step());
            assert_eq!(seen(&used), seen(&fresh));
        }
    }
}

#[test]
fn looking_at_a_run_changes_no_bit() {
    for parameters in methods() {
        let discs = with_ids(&scattered(7, 100));
        let mut watched = started::<160>(&parameters, &discs);
        let mut alone = started::<160>(&parameters, &discs);
        for _ in 0..20 {
            watched.compute_forces().unwrap();
            let _ = seen(&watched);
            watched.compute_forces().unwrap();
            assert_eq!(watched.step(), alone.step());
            assert_eq!(seen(&watched), seen(&alone));
        }
    }
}

#[test]
fn the_seed_changes_every_disc() {
    for parameters in methods() {
        let discs = with_ids(&scattered(8, 100));
        let mut engines: Vec<Box<Small>> = [0, 1, 2, (1 << 63) - 1]
            .into_iter()
            .map(|seed| started(&Parameters { seed, ..parameters }, &discs))
            .collect();
        for engine in &mut engines {
            engine.step().unwrap();
        }
        for (index, first) in engines.iter().enumerate() {
            for second in &engines[index + 1..] {
                assert!((0..100).all(|id| first.position(id) != second.position(id)));
            }
        }
    }
}

#[test]
fn discs_more_or_less_do_not_change_the_noise_of_the_others() {
    // No forces: a disc's path is its noise alone.
    let parameters = Parameters { capillary_strength: 0.0, repulsion: false, ..EVERYTHING };
    let discs = with_ids(&scattered(9, 160));
    let mut all = started::<160>(&parameters, &discs);
    let mut some = started::<160>(&parameters, &discs[..37]);
    for _ in 0..50 {
        assert_eq!(all.step(), some.step());
    }
    assert!(
        (0..37).all(|id| all.position(id) == some.position(id) && all.crossings(id) == some.crossings(id))
    );
}

#[test]
fn without_attraction_the_method_changes_no_bit() {
    // So what holds of free diffusion and of repelling discs with one method holds with the other.
    let discs = with_ids(&scattered(10, 160));
    for repulsion in [false, true] {
        let parameters = Parameters { capillary_strength: 0.0, repulsion, ..EVERYTHING };
        let mut engines = BOTH.map(|scheme| started::<160>(&scheme.of(parameters), &discs));
        for _ in 0..50 {
            let [mesh, split] = &mut engines;
            assert_eq!(mesh.step(), split.step());
            assert_eq!(seen(mesh), seen(split));
        }
    }
}

#[test]
fn with_attraction_the_method_is_seen() {
    let discs = with_ids(&scattered(11, 160));
    let [mesh, split] = methods().map(|parameters| {
        let mut engine = started::<160>(&parameters, &discs);
        assert!(engine.step().is_ok());
        seen(&engine)
    });
    assert!(mesh.forces.iter().zip(&split.forces).all(|(mesh, split)| mesh != split));
}
