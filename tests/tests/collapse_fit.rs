//! Radii of groups where they are known, and the fit of Eq. 30 against made-up collapses and a second way to the minimum.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use meniscus::observables::collapse_fit::{CollapseFitError, Conditions, fit};
use meniscus::observables::radii::Groups;
use meniscus::start;
use meniscus::statistics::Estimate;
use meniscus::theory::collapse_fit;
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::fits::{delay_of_collapse, minimum};
use meniscus_tests::reference::RandomNumbers;
use meniscus_tests::statistics::mean_and_error;

fn torus() -> Torus {
    Torus::new(800.0).unwrap()
}

/// Places relative to the middle of the box, R0.
fn about_the_middle(places: &[(f64, f64)]) -> Vec<Position> {
    let torus = torus();
    let along = |coordinate: f64| torus.wrapped_fraction(400.0 + coordinate);
    places.iter().map(|&(x, y)| Position { x: along(x), y: along(y) }).collect()
}

/// A collapse of Fig. 12 with noise of standard deviation `noise` (R0): A0 = 1.16, R_i = 96, R_f = 13.
fn noisy_collapse(seed: u64, noise: f64) -> Vec<(f64, f64)> {
    let mut random = RandomNumbers::new(seed);
    let mut deviate = move || noise * 12.0_f64.sqrt() * (random.uniform() - 0.5);
    (1..90)
        .map(|step| 0.01 * f64::from(step))
        .map(|time| (time, collapse_fit(96.0, 13.0, 1.16, time) + deviate()))
        .collect()
}

const ALL_FREE: Conditions = Conditions { initial_radius: None, final_radius: None, until: 0.9 };
const FINAL_HELD: Conditions = Conditions { final_radius: Some(13.0), ..ALL_FREE };
const INITIAL_HELD: Conditions = Conditions { initial_radius: Some(96.0), ..ALL_FREE };
const BOTH_HELD: Conditions = Conditions { initial_radius: Some(96.0), ..FINAL_HELD };

#[test]
fn rings_are_found_again() {
    let positions = start::rings(&torus(), 4, 7, 20.0).unwrap();
    let radii = Groups::rings(4, 7, 20.0).radii(&torus(), &positions);
    for (ring, number) in radii.iter().zip(0_u32..) {
        assert_eq!((ring.group, ring.initial_radius), (number, 20.0 * f64::from(number)));
        assert!((ring.radius - ring.initial_radius).abs() < 1e-6 && ring.spread < 1e-6, "{ring:?}");
    }
    assert_eq!(radii.len(), 5);
}

#[test]
fn a_ring_that_is_deformed_has_a_spread() {
    // Ring 1 of two discs, ring 2 of four: at distances 3 and 5, and 1, 1, 2 and 0.
    let positions = about_the_middle(&[
        (0.5, 0.0),
        (3.0, 0.0),
        (-4.0, 3.0),
        (1.0, 0.0),
        (0.0, -1.0),
        (0.0, 2.0),
        (0.0, 0.0),
    ]);
    let radii = Groups::rings(2, 2, 10.0).radii(&torus(), &positions);
    let expected = [(0.5, 0.0), (4.0, 1.0), (1.0, 0.5_f64.sqrt())];
    for (found, (radius, spread)) in radii.iter().zip(expected) {
        assert!((found.radius - radius).abs() < 1e-6, "{found:?}");
        assert!((found.spread - spread).abs() < 1e-6, "{found:?}");
    }
}

#[test]
fn shells_hold_the_discs_that_began_in_them() {
    let initial = about_the_middle(&[(0.0, 16.0), (1.0, 0.0), (-15.1, 0.0), (7.4, 0.0), (0.0, -22.4)]);
    let groups = Groups::shells(&torus(), &initial, 7.5).unwrap();
    // Where they are later does not matter to which shell they belong.
    let later = about_the_middle(&[(0.0, 6.0), (1.0, 0.0), (-8.0, 0.0), (3.0, 0.0), (0.0, -10.0)]);
    let radii = groups.radii(&torus(), &later);
    let found: Vec<(u32, f64)> = radii.iter().map(|shell| (shell.group, shell.initial_radius)).collect();
    assert_eq!(found, [(0, 3.75), (2, 18.75)], "there is nobody in the shell from 7.5 to 15 R0");
    assert!((radii[0].radius - 2.0).abs() < 1e-6 && (radii[0].spread - 1.0).abs() < 1e-6);
    assert!((radii[1].radius - 8.0).abs() < 1e-6);
    assert!((radii[1].spread - (8.0_f64 / 3.0).sqrt()).abs() < 1e-6);
}

#[test]
fn shells_without_a_width_are_refused() {
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-9] {
        let refusal = Groups::shells(&torus(), &[], width).unwrap_err().to_string();
        assert_eq!(refusal, format!("shells {width} R0 wide were asked for: take a width from 1e-3 R0 on"));
    }
}

#[test]
fn what_a_collapse_was_made_of_is_found() {
    for conditions in [ALL_FREE, FINAL_HELD, INITIAL_HELD, BOTH_HELD] {
        for (initial, last, delay) in
            [(96.0, 13.0, 1.16), (135.0, 0.5, 1.02), (40.0, 0.0, 4.0), (58.0, 8.0, 0.95)]
        {
            let samples: Vec<(f64, f64)> = (0..90)
                .map(|step| 0.01 * f64::from(step))
                .map(|time| (time, collapse_fit(initial, last, delay, time)))
                .collect();
            let conditions = Conditions {
                initial_radius: conditions.initial_radius.map(|_| initial),
                final_radius: conditions.final_radius.map(|_| last),
                ..conditions
            };
            let found = fit(&samples, &conditions).unwrap();
            let near =
                |found: Estimate, expected: f64| (found.value - expected).abs() < 1e-5 * expected.max(1.0);
            assert!(near(found.delay, delay), "{found:?}, not {delay}");
            assert!(near(found.initial_radius, initial), "{found:?}, not {initial}");
            assert!(near(found.final_radius, last), "{found:?}, not {last}");
            assert!(found.residual < 1e-6 && found.samples == 89);
            assert!((found.radius(0.5) - collapse_fit(initial, last, delay, 0.5)).abs() < 1e-5);
        }
    }
}

#[test]
fn the_minimum_is_that_of_another_search() {
    let samples = noisy_collapse(1, 0.5);
    let held = fit(&samples, &BOTH_HELD).unwrap();
    assert!((held.delay.value - delay_of_collapse(&samples, 96.0, 13.0)).abs() < 1e-6);
    // With R_f free: the lowest of the lowest.
    let deviation = |last: f64, delay: f64| {
        let squared = |&(time, radius): &(f64, f64)| {
            let difference = radius - collapse_fit(96.0, last, delay, time);
            difference * difference
        };
        samples.iter().map(squared).sum::<f64>()
    };
    let last = minimum(|last| deviation(last, delay_of_collapse(&samples, 96.0, last)), 0.0, 40.0);
    let free = fit(&samples, &INITIAL_HELD).unwrap();
    assert!((free.final_radius.value - last).abs() < 1e-3, "{free:?}, not {last}");
    assert!((free.delay.value - delay_of_collapse(&samples, 96.0, last)).abs() < 1e-4);
    assert!(free.residual <= held.residual);
}

/// Of a made-up collapse with noise.
const REPETITIONS: u64 = 100;

#[test]
fn errors_are_the_scatter_over_repetitions() {
    for conditions in [FINAL_HELD, INITIAL_HELD] {
        let fits: Vec<_> =
            (0..REPETITIONS).map(|seed| fit(&noisy_collapse(seed, 0.3), &conditions).unwrap()).collect();
        for (what, expected, estimate) in [
            (
                "A0",
                1.16,
                (|fit| fit.delay) as fn(&meniscus::observables::collapse_fit::CollapseFit) -> Estimate,
            ),
            ("R_i", 96.0, |fit| fit.initial_radius),
            ("R_f", 13.0, |fit| fit.final_radius),
        ] {
            let estimates: Vec<Estimate> = fits.iter().map(estimate).collect();
            let values: Vec<f64> = estimates.iter().map(|estimate| estimate.value).collect();
            let errors: Vec<f64> = estimates.iter().map(|estimate| estimate.error).collect();
            let (mean, mean_error) = mean_and_error(&values);
            let error = errors.iter().sum::<f64>() / (REPETITIONS as f64);
            if error == 0.0 {
                assert!(values.iter().all(|value| *value == expected), "{what} was held");
                continue;
            }
            assert!(
                (mean - expected).abs() < 4.0 * mean_error + 0.1 * error,
                "{what}: {mean} ± {mean_error}"
            );
            // 100 repetitions tell a standard deviation to 7 %.
            let scatter = mean_error * (REPETITIONS as f64).sqrt();
            assert!((error / scatter - 1.0).abs() < 0.25, "{what}: error {error}, scatter {scatter}");
        }
    }
}

#[test]
fn only_the_range_is_fitted() {
    let mut samples = noisy_collapse(1, 0.0);
    samples.extend([(0.0, 500.0), (-0.1, 3.0), (0.9, 1000.0), (2.0, 13.0)]);
    let found = fit(&samples, &FINAL_HELD).unwrap();
    assert!(found.samples == 89 && (found.delay.value - 1.16).abs() < 1e-6);
}

#[test]
fn a_collapse_that_ends_within_the_range_is_fitted() {
    let samples: Vec<(f64, f64)> = (1..150)
        .map(|step| 0.01 * f64::from(step))
        .map(|time| (time, collapse_fit(96.0, 13.0, 1.1037, time)))
        .collect();
    let found = fit(&samples, &Conditions { until: 1.5, ..FINAL_HELD }).unwrap();
    assert!((found.delay.value - 1.1037).abs() < 1e-4, "{found:?}");
}

#[test]
fn what_cannot_be_fitted_is_refused_with_the_reason() {
    let samples = noisy_collapse(1, 0.1);
    assert_eq!(
        fit(&samples[..2], &FINAL_HELD).unwrap_err().to_string(),
        "2 samples with 0 < t/T < 0.9 do not determine 2 parameters and their errors: give at least 3, or hold a radius"
    );
    assert!(fit(&samples[..3], &FINAL_HELD).is_ok());
    assert_eq!(
        fit(&[(0.1, f64::NAN)], &FINAL_HELD).unwrap_err().to_string(),
        "the sample t/T = 0.1, R = NaN R0 is not made of finite numbers: leave it out"
    );
    let negative = Conditions { final_radius: Some(-1.0), ..FINAL_HELD };
    assert_eq!(
        fit(&samples, &negative).unwrap_err().to_string(),
        "a radius of -1 R0 was to be held: hold one of 0 or more"
    );
    let still: Vec<(f64, f64)> = samples.iter().map(|(time, _)| (*time, 96.0)).collect();
    for conditions in [ALL_FREE, FINAL_HELD, INITIAL_HELD, BOTH_HELD] {
        assert_eq!(fit(&still, &conditions), Err(CollapseFitError::Undetermined), "{conditions:?}");
    }
    let growing: Vec<(f64, f64)> = samples.iter().map(|(time, _)| (*time, 96.0 + 10.0 * time)).collect();
    assert_eq!(fit(&growing, &BOTH_HELD), Err(CollapseFitError::Undetermined));
}
