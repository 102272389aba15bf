//! The references in double precision: what an invariant accepts beside its tolerance is enough.

use super::{SIDE, SPLIT, cases, torus};
use meniscus_core::property::pairs::Capillary;
use meniscus_core::property::{Discs, Tolerance, forces, kernels, pairs, strategies};
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::images::ImageSum;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn images_of_bessel_functions_have_both_limits(
        separation in strategies::separation(1.0..32.0),
        length in 0.5..30.0,
    ) {
        let images = ImageSum::new(SIDE, 0.89, length);
        let kernel = |[x, y]: [f64; 2]| images.pair_force(x, y);
        let capillary = Capillary { strength: 0.89, length, side: SIDE };
        let rounding = Tolerance::relative(1e-12);
        pairs::attraction(kernel, separation, rounding)?;
        pairs::far_field(kernel, capillary, separation, rounding)?;
        pairs::screening(kernel, capillary, separation, rounding)?;
    }

    #[test]
    fn without_screening_the_force_has_its_limit(separation in strategies::separation(1.0..32.0)) {
        let ewald = unscreened();
        let capillary = Capillary { strength: 0.89, length: f64::INFINITY, side: SIDE };
        let kernel = |[x, y]: [f64; 2]| ewald.pair_force(x, y);
        pairs::far_field(kernel, capillary, separation, Tolerance::relative(1e-9))?;
    }
}

fn unscreened() -> &'static Ewald {
    static EWALD: std::sync::OnceLock<Ewald> = std::sync::OnceLock::new();
    EWALD.get_or_init(|| Ewald::new(SIDE, 0.89, f64::INFINITY))
}

#[test]
fn forces_of_ewald_and_of_the_split_are_the_slope_of_the_same_energy() {
    let ewald = Ewald::new(SIDE, SPLIT.capillary_strength, SPLIT.capillary_length);
    let energy = |discs: &Discs| ewald.energy(&discs.coordinates());
    let exact = |discs: &Discs| ewald.forces(&discs.coordinates());
    let core = std::cell::RefCell::new(kernels::forces(&SPLIT).unwrap());
    let mut runner = TestRunner::new(cases(4));
    let result = runner.run(&strategies::separated(torus(SIDE), 6, 2.0), |discs| {
        // The difference quotient is off by V0·step²/d³ or so.
        forces::energy_consistency(exact, energy, &discs, 1e-3, Tolerance::relative(1e-6))?;
        forces::energy_consistency(&mut *core.borrow_mut(), energy, &discs, 1e-3, Tolerance::absolute(1e-3))?;
        Ok(())
    });
    assert_eq!(result, Ok(()));
}
