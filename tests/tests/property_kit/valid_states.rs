//! Strategies give what is valid, reach all of it, and shrink.

use super::planted_faults::unwrapped;
use super::{SIDE, cases, choices, torus};
use meniscus_core::parameters::{LARGEST_CAPILLARY_STRENGTH, SPACING_RANGE, STEP_RANGE};
use meniscus_core::property::{Discs, Tolerance, forces, strategies};
use meniscus_tests::states::separation as distance;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{TestError, TestRunner};
use std::collections::HashSet;

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn parameters_are_valid(parameters in strategies::parameters(4096)) {
        prop_assert_eq!(parameters.validate(), Ok(()));
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn systems_are_valid((parameters, discs) in strategies::system(32, 1..10)) {
        prop_assert_eq!(parameters.validate(), Ok(()));
        prop_assert!(parameters.grid <= 32 && discs.side() == parameters.side);
        prop_assert!((1..10).contains(&discs.len()) && discs.strengths().len() == discs.len());
    }

    #[test]
    fn separated_discs_are_apart(discs in strategies::separated(torus(SIDE), 20, 5.0)) {
        for (index, &first) in discs.positions().iter().enumerate() {
            for &second in &discs.positions()[..index] {
                prop_assert!(distance(first, second, SIDE) >= 5.0);
            }
        }
    }

    #[test]
    fn separations_are_within_their_range([x, y] in strategies::separation(0.01..1e4)) {
        let distance = libm::hypot(x, y);
        prop_assert!((0.01 * (1.0 - 1e-12)..=1e4).contains(&distance));
    }
}

/// Many values of a strategy.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn sample<S: Strategy>(strategy: S) -> Vec<S::Value> {
    let mut runner = TestRunner::deterministic();
    (0..1000).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

#[test]
fn parameters_reach_every_choice_and_the_ends_of_their_ranges() {
    let all = sample(strategies::parameters(64));
    assert_eq!(choices(&all, |p| p.method), 2);
    assert_eq!(choices(&all, |p| p.assignment), 6);
    assert_eq!(choices(&all, |p| (p.influence, p.gradient)), 2 * 3 + 1);
    assert_eq!(choices(&all, |p| p.noise), 3);
    assert_eq!(choices(&all, |p| p.grid), 3);
    assert_eq!(choices(&all, |p| p.fields.uniform_force.iter().any(|&force| force.abs() > 1e6)), 2);
    assert!(all.iter().any(|p| p.capillary_strength == 0.0));
    assert!(all.iter().any(|p| p.capillary_strength == LARGEST_CAPILLARY_STRENGTH));
    assert!(all.iter().any(|p| p.capillary_length.is_infinite()));
    assert!(all.iter().any(|p| p.side / p.grid as f64 == SPACING_RANGE.1));
    assert!(all.iter().any(|p| p.max_step == STEP_RANGE.1));
}

#[test]
fn coordinates_reach_the_seams() {
    let seen: HashSet<u32> = sample(strategies::coordinate()).into_iter().collect();
    for seam in [0, 1, u32::MAX, 1 << 31, (1 << 31) - 1, (1 << 31) + 1, 1 << 30, 3 << 30] {
        assert!(seen.contains(&seam), "{seam:#x}");
    }
    assert!(seen.len() > 500);
}

#[test]
fn states_hold_coinciding_discs_and_lattices() {
    let states = sample(strategies::states(torus(SIDE), 4));
    let places = |discs: &Discs| (choices(discs.positions(), |p| *p), choices(discs.positions(), |p| p.x));
    let alike: HashSet<(usize, usize)> = states.iter().map(places).collect();
    assert!(alike.contains(&(1, 1)) && alike.contains(&(4, 2)) && alike.contains(&(4, 4)), "{alike:?}");
}

#[test]
fn a_failure_shrinks_to_the_pair_at_fault() {
    // Unwrapped springs: as few discs as possible with one across the border.
    let mut runner = TestRunner::new(cases(300));
    let states = strategies::scattered(torus(SIDE), 0..20);
    let result = runner.run(&states, |discs| {
        forces::translation(unwrapped, &discs, (1 << 31, 0), Tolerance::relative(1e-9))?;
        Ok(())
    });
    let Err(TestError::Fail(reason, discs)) = result else { panic!("{result:?}") };
    assert_eq!(discs.len(), 2, "{discs:?}");
    assert!(reason.message().starts_with("translation: off by "), "{reason}");
}
