//! The force of a pair, repulsion and near part of the attraction as one: its symmetries bit for bit, its closed form.

use core::f64::consts::TAU;

use meniscus_core::cells::Separation;
use meniscus_core::near_part::{Segment, fill_table, table_length};
use meniscus_core::pair_force::{PairForce, near_cutoff, product_of_strengths};
use meniscus_core::parameters::Parameters;
use meniscus_core::repulsion::{CUTOFF, SMALLEST_DISTANCE};
use meniscus_core::units::force_from_units;
use meniscus_tests::reference::wca;
use meniscus_tests::schemes::{PAPER, SPLIT};
use meniscus_tests::tolerances::{FORCE_QUANTUM, NEAR_FORCE, PAIR_FORCE};
use proptest::prelude::*;

/// Without screening, where the near part is a closed form and soon tabulated.
fn parameters(side: f64) -> Parameters {
    Parameters { side, grid: 16, capillary_length: f64::INFINITY, ..Parameters::PAPER }
}

/// A force and the table it needs.
struct Pairs {
    parameters: Parameters,
    force: PairForce,
    table: Vec<Segment>,
}

impl Pairs {
    fn new(parameters: Parameters) -> Self {
        let mut table = vec![[0.0; 4]; table_length(near_cutoff(&parameters))];
        fill_table(parameters.splitting, parameters.capillary_length, &mut table);
        Self { parameters, force: PairForce::new(&parameters), table }
    }

    fn of(&self, separation: Separation, first_is_lower: bool, strengths: f32) -> Option<(i64, i64)> {
        self.force.of(separation, first_is_lower, strengths, &self.table)
    }
}

/// Separations of any size and sign, but for half a box, which is no neighbour.
fn components() -> impl Strategy<Value = i32> {
    prop_oneof![
        -i32::MAX..=i32::MAX,
        (0_u32..31, any::<i32>()).prop_map(|(shift, bits)| (bits >> 1) >> shift)
    ]
}

/// Boxes with 16 nodes a side: α is 0.5 to 0.03 /R0, r_c 7 to 112 R0.
fn sides() -> impl Strategy<Value = f64> {
    prop_oneof![Just(16.0), Just(256.0), 16.0..256.0_f64]
}

/// Products of strengths, as a run has them.
fn strengths() -> impl Strategy<Value = f32> {
    let strength = || prop_oneof![Just(1 << 20), -(3 << 20)..3 << 20];
    (strength(), strength()).prop_map(|(first, second)| product_of_strengths(first, second))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_pair_force_is_antisymmetric_bit_for_bit(
        side in sides(),
        repulsion in any::<bool>(),
        (x, y) in (components(), components()),
        strengths in strengths(),
        first_is_lower in any::<bool>(),
    ) {
        let pairs = Pairs::new(SPLIT.of(Parameters { repulsion, ..parameters(side) }));
        let there = pairs.of(Separation { x, y }, first_is_lower, strengths);
        let back = pairs.of(Separation { x: -x, y: -y }, !first_is_lower, strengths);
        prop_assert_eq!(there, back.map(|(x, y)| (-x, -y)));
    }

    #[test]
    fn a_pair_force_turns_and_mirrors_bit_for_bit(
        side in sides(),
        repulsion in any::<bool>(),
        (x, y) in (components(), components()),
        strengths in strengths(),
    ) {
        prop_assume!((x, y) != (0, 0));
        let pairs = Pairs::new(SPLIT.of(Parameters { repulsion, ..parameters(side) }));
        let force = pairs.of(Separation { x, y }, true, strengths);
        prop_assert_eq!(pairs.of(Separation { x: -y, y: x }, true, strengths), force.map(|(x, y)| (-y, x)));
        prop_assert_eq!(pairs.of(Separation { x: -x, y }, true, strengths), force.map(|(x, y)| (-x, y)));
        prop_assert_eq!(pairs.of(Separation { x: y, y: x }, true, strengths), force.map(|(x, y)| (y, x)));
    }

    #[test]
    fn without_a_near_part_it_is_the_repulsion_bit_for_bit(
        side in sides(),
        (x, y) in (components(), components()),
        first_is_lower in any::<bool>(),
    ) {
        let separation = Separation { x, y };
        let expected = PairForce::repulsion(side).of(separation, first_is_lower, PairForce::EQUAL, &[]);
        let all_on_the_mesh = Pairs::new(PAPER.of(parameters(side)));
        let no_attraction = Pairs::new(SPLIT.of(Parameters { capillary_strength: 0.0, ..parameters(side) }));
        for pairs in [all_on_the_mesh, no_attraction] {
            prop_assert_eq!(pairs.of(separation, first_is_lower, PairForce::EQUAL), expected);
        }
    }

    #[test]
    fn a_pair_force_is_the_closed_form(
        side in sides(),
        repulsion in any::<bool>(),
        distance in prop_oneof![0.001..2.4_f64, 0.88..0.92_f64, 2.2..2.25_f64, 0.5..120.0_f64],
        angle in 0.0..TAU,
        strengths in strengths(),
    ) {
        let pairs = Pairs::new(SPLIT.of(Parameters { repulsion, ..parameters(side) }));
        let Parameters { cutoff, splitting, capillary_strength, .. } = pairs.parameters;
        let unit = side / 4_294_967_296.0;
        prop_assume!(distance < 0.5 * side);
        let component = |length: f64| libm::rint(length / unit) as i32;
        let separation =
            Separation { x: component(distance * libm::cos(angle)), y: component(distance * libm::sin(angle)) };
        let (dx, dy) = (f64::from(separation.x) * unit, f64::from(separation.y) * unit);
        let distance = libm::hypot(dx, dy);
        // On the border rounding decides.
        prop_assume!((distance / cutoff - 1.0).abs() > 1e-6);
        let held = distance.max(SMALLEST_DISTANCE);
        let near = f64::from(strengths) * capillary_strength / held;
        let attraction =
            if distance < cutoff { near * libm::exp(-splitting * splitting * held * held) } else { 0.0 };
        // The reference gives the force on a disc at the origin due to one at (x, y).
        let [repulsion_x, repulsion_y] = if repulsion { wca::pair_force(-dx, -dy) } else { [0.0; 2] };
        let (x, y) = pairs.of(separation, true, strengths).unwrap_or((0, 0));
        let off = libm::hypot(
            force_from_units(x) - repulsion_x + attraction * dx / distance,
            force_from_units(y) - repulsion_y + attraction * dy / distance,
        );
        let sixth = libm::pow(2.0 / held, 6.0);
        let terms = if repulsion && distance < CUTOFF + 1e-3 {
            24.0 / held * sixth * (2.0 * sixth + 1.0)
        } else {
            0.0
        };
        let allowed = PAIR_FORCE * terms + NEAR_FORCE * near.abs() + FORCE_QUANTUM;
        prop_assert!(off <= allowed, "off by {off:e} of {allowed:e} at {distance}");
    }
}

#[test]
fn coinciding_discs_are_parted_or_drawn_along_x() {
    let coinciding = Separation { x: 0, y: 0 };
    for (repulsion, sign) in [(true, 1), (false, -1)] {
        let pairs = Pairs::new(SPLIT.of(Parameters { repulsion, ..parameters(16.0) }));
        let (x, y) = pairs.of(coinciding, true, PairForce::EQUAL).unwrap();
        assert_eq!((x.signum(), y), (sign, 0));
        assert_eq!(pairs.of(coinciding, false, PairForce::EQUAL), Some((-x, 0)));
    }
}

#[test]
fn a_pair_at_the_cutoff_has_no_force_and_one_within_it_has() {
    let pairs = Pairs::new(SPLIT.of(Parameters { repulsion: false, ..parameters(16.0) }));
    // 7 R0 in a box of 16 R0.
    let cutoff = 7 << 28;
    assert!(pairs.force.reach() >= cutoff as u32);
    assert_eq!(pairs.of(Separation { x: cutoff, y: 0 }, true, PairForce::EQUAL), None);
    let within = pairs.of(Separation { x: cutoff - (1 << 10), y: 0 }, true, PairForce::EQUAL);
    assert!(within.is_some_and(|(x, _)| x < 0), "{within:?}");
}
