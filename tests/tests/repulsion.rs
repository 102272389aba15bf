//! Repulsion at contact: its closed form, its symmetries, its sum.

use meniscus_core::cells::Separation;
use meniscus_core::engine::Engine;
use meniscus_core::pair_force::PairForce;
use meniscus_core::parameters::Parameters;
use meniscus_core::repulsion::{CUTOFF, LARGEST_FORCE, SMALLEST_DISTANCE};
use meniscus_core::torus::Position;
use meniscus_core::units::{FORCE_UNITS, force_from_units};
use meniscus_tests::reference::wca;
use meniscus_tests::states::{REPULSION, crowded, scattered, shuffled, with_ids};
use meniscus_tests::tolerances::{FORCE_QUANTUM, PAIR_FORCE};
use proptest::prelude::*;

/// Forces by id, unit 2⁻²⁴ kBT/R0, of discs in a box of `side`.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn forces(side: f64, discs: &[(u32, Position)]) -> Vec<(i64, i64)> {
    let mut engine = Box::new(Engine::<16, 256>::new());
    engine.init(&Parameters { side, ..REPULSION }, discs.iter().copied()).unwrap();
    engine.compute_forces().unwrap();
    (0..discs.len() as u32).map(|id| engine.force(id).unwrap()).collect()
}

/// Boxes from the smallest to 256 R0.
fn sides() -> impl Strategy<Value = f64> {
    prop_oneof![Just((2.0 * CUTOFF).next_up()), Just(256.0), 4.5..256.0_f64]
}

/// Scattered discs, crowds, and groups at the very same place.
fn states() -> impl Strategy<Value = Vec<Position>> {
    let coinciding = (any::<u64>(), 1_usize..40, 1_usize..5).prop_map(|(seed, places, each)| {
        scattered(seed, places).into_iter().flat_map(|place| vec![place; each]).collect()
    });
    prop_oneof![
        (any::<u64>(), 1_usize..150).prop_map(|(seed, count)| scattered(seed, count)),
        (any::<u64>(), 1_usize..150, 0.0..0.3_f64)
            .prop_map(|(seed, count, width)| crowded(seed, count, width)),
        coinciding,
    ]
}

/// Separations at which two discs of a box of any side touch, overlap or coincide, and others.
fn components() -> impl Strategy<Value = i32> {
    prop_oneof![
        -i32::MAX..=i32::MAX,
        (0_u32..31, any::<i32>()).prop_map(|(shift, bits)| (bits >> 1) >> shift)
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_pair_force_is_antisymmetric_bit_for_bit(
        side in prop_oneof![sides(), 4.5..65536.0_f64],
        x in components(),
        y in components(),
        first_is_lower in any::<bool>(),
    ) {
        let repulsion = PairForce::repulsion(side);
        let there = repulsion.of(Separation { x, y }, first_is_lower, PairForce::EQUAL, &[]);
        let back = repulsion.of(Separation { x: -x, y: -y }, !first_is_lower, PairForce::EQUAL, &[]);
        prop_assert_eq!(there, back.map(|(x, y)| (-x, -y)));
    }

    #[test]
    fn a_pair_force_turns_and_mirrors_bit_for_bit(side in sides(), x in components(), y in components()) {
        prop_assume!((x, y) != (0, 0));
        let repulsion = PairForce::repulsion(side);
        let force = repulsion.of(Separation { x, y }, true, PairForce::EQUAL, &[]);
        let turned = repulsion.of(Separation { x: -y, y: x }, true, PairForce::EQUAL, &[]);
        let mirrored = repulsion.of(Separation { x: -x, y }, true, PairForce::EQUAL, &[]);
        prop_assert_eq!(turned, force.map(|(x, y)| (-y, x)));
        prop_assert_eq!(mirrored, force.map(|(x, y)| (-x, y)));
    }

    #[test]
    fn a_pair_force_is_the_closed_form(
        side in sides(),
        distance in prop_oneof![0.001..2.4_f64, 0.88..0.92_f64, 2.2..2.25_f64],
        angle in 0.0..core::f64::consts::TAU,
    ) {
        let unit = side / 4_294_967_296.0;
        prop_assume!(distance < 0.5 * side);
        let component = |length: f64| libm::rint(length / unit) as i32;
        let separation =
            Separation { x: component(distance * libm::cos(angle)), y: component(distance * libm::sin(angle)) };
        let (dx, dy) = (f64::from(separation.x) * unit, f64::from(separation.y) * unit);
        let distance = libm::hypot(dx, dy);
        // The reference gives the force on a disc at the origin due to one at (x, y).
        let [x, y] = wca::pair_force(-dx, -dy);
        let (force_x, force_y) = PairForce::repulsion(side).of(separation, true, PairForce::EQUAL, &[]).unwrap_or((0, 0));
        let off = libm::hypot(force_from_units(force_x) - x, force_from_units(force_y) - y);
        let held = distance.max(SMALLEST_DISTANCE);
        let sixth = libm::pow(2.0 / held, 6.0);
        let terms = if distance < CUTOFF + 1e-3 { 24.0 / held * sixth * (2.0 * sixth + 1.0) } else { 0.0 };
        prop_assert!(off <= PAIR_FORCE * terms + FORCE_QUANTUM, "off by {} of {terms} at {distance}", off / terms);
    }

    #[test]
    fn no_pair_force_exceeds_its_bound(side in sides(), x in components(), y in components()) {
        if let Some((x, y)) = PairForce::repulsion(side).of(Separation { x, y }, true, PairForce::EQUAL, &[]) {
            let bound = (LARGEST_FORCE * f64::from(FORCE_UNITS)) as u128;
            let square = |x: i64| u128::from(x.unsigned_abs()) * u128::from(x.unsigned_abs());
            prop_assert!(square(x) + square(y) <= bound * bound);
        }
    }

    #[test]
    fn repulsion_sums_to_zero_bit_for_bit(side in sides(), discs in states()) {
        let forces = forces(side, &with_ids(&discs));
        let sum = forces.iter().fold((0, 0), |sum, force| (sum.0 + force.0, sum.1 + force.1));
        prop_assert_eq!(sum, (0, 0));
    }

    #[test]
    fn repulsion_does_not_depend_on_storage_order(side in sides(), discs in states(), seed in any::<u64>()) {
        let discs = with_ids(&discs);
        prop_assert_eq!(forces(side, &shuffled(seed, &discs)), forces(side, &discs));
    }

    #[test]
    fn repulsion_does_not_see_a_shift(side in sides(), discs in states(), x in any::<u32>(), y in any::<u32>()) {
        let shift = |p: &Position| Position::from_bits(p.x.to_bits().wrapping_add(x), p.y.to_bits().wrapping_add(y));
        let shifted: Vec<Position> = discs.iter().map(shift).collect();
        prop_assert_eq!(forces(side, &with_ids(&shifted)), forces(side, &with_ids(&discs)));
    }

    #[test]
    fn repulsion_turns_bit_for_bit(side in sides(), seed in any::<u64>(), width in 0.01..0.5_f64) {
        // Distinct places: a coinciding pair is pushed along x however the box is turned.
        let discs = crowded(seed, 60, width);
        let turned: Vec<Position> = discs
            .iter()
            .map(|disc| Position::from_bits(disc.y.to_bits().wrapping_neg(), disc.x.to_bits()))
            .collect();
        let expected: Vec<_> = forces(side, &with_ids(&discs)).into_iter().map(|(x, y)| (-y, x)).collect();
        prop_assert_eq!(forces(side, &with_ids(&turned)), expected);
    }
}

#[test]
fn coinciding_discs_are_pushed_along_x_the_lower_id_to_the_right() {
    let place = Position::from_bits(77, 88);
    for discs in [[(0, place), (1, place)], [(1, place), (0, place)]] {
        let forces = forces(16.0, &discs);
        let force = force_from_units(forces[0].0);
        assert!(force > 0.0 && force <= LARGEST_FORCE && force > 0.999 * LARGEST_FORCE, "{force}");
        assert_eq!(forces[0].1, 0);
        assert_eq!(forces[1], (-forces[0].0, 0));
    }
}

#[test]
fn exactly_half_a_box_apart_is_no_neighbour_in_the_smallest_box() {
    let half = 1 << 31;
    let mut side = (2.0 * CUTOFF).next_up();
    for _ in 0..1000 {
        for place in
            [Position::from_bits(half, 0), Position::from_bits(0, half), Position::from_bits(half, half)]
        {
            let forces = forces(side, &[(0, Position::from_bits(0, 0)), (1, place)]);
            assert_eq!(forces, [(0, 0), (0, 0)], "side {side}");
        }
        side = side.next_up();
    }
}

#[test]
fn a_disc_one_unit_off_half_a_box_is_a_neighbour_at_most_by_rounding() {
    let side = (2.0 * CUTOFF).next_up();
    for bits in [(1_u32 << 31) - 1, (1 << 31) + 1, (1 << 31) - 65_536, (1 << 31) + 65_536] {
        let forces = forces(side, &[(0, Position::from_bits(0, 0)), (1, Position::from_bits(bits, 0))]);
        assert_eq!(forces[0].0, -forces[1].0);
        // At d_c − ε the force is (72/d_c²)·2^(1/3)… ε, below 15 kBT/R0² · ε.
        let gap = (f64::from(bits as i32).abs() / 4_294_967_296.0 * side - CUTOFF).abs();
        let bound = 15.0 * gap + PAIR_FORCE * 64.0 + FORCE_QUANTUM;
        assert!(force_from_units(forces[0].0).abs() <= bound);
    }
}
