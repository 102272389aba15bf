//! Shells against closed forms and against sums over directions.

use super::*;
use crate::bessel::scaled_k0_k1;
use crate::theory::cold_collapse_radius;
use core::f64::consts::{PI, TAU};

const NEWTONIAN: f64 = f64::INFINITY;

/// Nine rings of 10n discs, 20 R0 apart, as a filled patch.
fn patch() -> Vec<Shell> {
    (1..=9).map(|n| Shell { radius: 20.0 * f64::from(n), discs: 10.0 * f64::from(n) }).collect()
}

/// Jeans' time at V0 = 1: 5 discs per 400π R0².
const JEANS_TIME: f64 = 40.0;

#[test]
fn without_screening_a_filled_patch_keeps_to_equation_13() {
    let shells = Shells::new(&patch(), 1.0, NEWTONIAN).unwrap();
    let times = [0.0, 0.1, 0.5, 0.9, 0.99, 1.01, 3.0];
    let radii = shells.radii_at(&times.map(|time| time * JEANS_TIME)).unwrap();
    for (time, radii) in times.into_iter().zip(radii) {
        for (shell, radius) in patch().iter().zip(radii) {
            let expected = cold_collapse_radius(shell.radius, time);
            // All squares fall at rates in proportion, so errors are those of rounding.
            assert!((radius - expected).abs() < 1e-5, "at {time} T: {radius}, not {expected}");
        }
    }
}

/// d(R²)/dt = −2V0(N − πρ̄R²), as the tests of the engine have it.
#[test]
fn without_screening_a_patch_in_a_box_feels_the_background() {
    let side = 800.0;
    let shells = Shells::new(&patch(), 1.0, NEWTONIAN).unwrap().periodic(side).unwrap();
    let background = 450.0 / (side * side);
    let time = 0.6 * JEANS_TIME;
    let radii = &shells.radii_at(&[time]).unwrap()[0];
    for (shell, radius) in patch().iter().zip(radii) {
        let square = shell.radius * shell.radius;
        let balance = square / 80.0 / (PI * background);
        let expected = balance - (balance - square) * libm::exp(TAU * background * time);
        assert!((radius * radius / expected - 1.0).abs() < 1e-8, "{radius}, not {}", expected.sqrt());
    }
}

#[test]
fn shells_that_meet_go_on_together() {
    // R² falls at 2 and at 10 until both are 94.75, and then at 8.
    let shells = [Shell { radius: 11.0, discs: 6.0 }, Shell { radius: 10.0, discs: 2.0 }];
    let collapse = Shells::new(&shells, 1.0, NEWTONIAN).unwrap();
    let radii = collapse.radii_at(&[2.0, 10.0, 14.4, 14.6]).unwrap();
    let squares: Vec<[f64; 2]> =
        radii.iter().map(|radii| [radii[0] * radii[0], radii[1] * radii[1]]).collect();
    let expected = [[101.0, 96.0], [35.75, 35.75], [0.55, 0.55], [0.0, 0.0]];
    for (found, expected) in squares.into_iter().flatten().zip(expected.into_iter().flatten()) {
        assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
    }
}

/// Screened and periodic, where what is joined at the wrong place would show: coarse and fine sampling agree, and
/// so does the order in which the shells are given.
#[test]
fn neither_sampling_nor_order_matters() {
    let shells: Vec<Shell> = [(5.0, 1.0), (90.0, 30.0), (60.0, 4.0), (61.0, 40.0), (30.0, 12.0)]
        .map(|(radius, discs)| Shell { radius, discs })
        .to_vec();
    let collapse = |shells: &[Shell]| Shells::new(shells, 1.0, 50.0).unwrap().periodic(200.0).unwrap();
    let end = 25.0;
    let last = collapse(&shells).radii_at(&[end]).unwrap().remove(0);
    let times: Vec<f64> = (1..=100).map(|k| end * f64::from(k) / 100.0).collect();
    let sampled = collapse(&shells).radii_at(&times).unwrap();
    let reversed: Vec<Shell> = shells.iter().rev().copied().collect();
    let reversed = collapse(&reversed).radii_at(&[end]).unwrap().remove(0);
    assert!(last[2] == last[3], "shells 2 and 3 must meet for this to say anything: {last:?}");
    for (index, radius) in last.iter().enumerate() {
        assert!((radius - sampled[99][index]).abs() < 1e-4, "{last:?}, {:?}", sampled[99]);
        assert!((radius - reversed[4 - index]).abs() < 1e-4, "{last:?}, {reversed:?}");
    }
    assert!(last.iter().zip(&shells).all(|(radius, shell)| *radius < shell.radius));
}

/// The force of a shell about `centre` on a point at (r, 0), outwards, averaged over `directions` by the trapezoidal rule.
fn averaged_force(directions: i32, length: f64, point: f64, shell: Shell, centre: [f64; 2]) -> f64 {
    let force = |direction: i32| {
        let (sine, cosine) = libm::sincos(TAU * (f64::from(direction) + 0.5) / f64::from(directions));
        let x = centre[0] + shell.radius * cosine - point;
        let y = centre[1] + shell.radius * sine;
        let distance = libm::hypot(x, y);
        libm::exp(-distance / length) * scaled_k0_k1(distance / length).1 / length * x / distance
    };
    shell.discs * (0..directions).map(force).sum::<f64>() / f64::from(directions)
}

#[test]
fn forces_are_averages_over_directions() {
    let (inner, outer) = (Shell { radius: 30.0, discs: 20.0 }, Shell { radius: 50.0, discs: 35.0 });
    for length in [8.0, 40.0, 270.0] {
        let alone = |shell: Shell| Shells::new(&[shell], 1.0, length).unwrap().forces()[0];
        let forces = Shells::new(&[inner, outer], 1.0, length).unwrap().forces();
        let on_inner = averaged_force(100, length, inner.radius, outer, [0.0; 2]);
        let on_outer = averaged_force(100, length, outer.radius, inner, [0.0; 2]);
        assert!((forces[0] - alone(inner) - on_inner).abs() < 1e-10, "{length}: {forces:?}, {on_inner}");
        assert!((forces[1] - alone(outer) - on_outer).abs() < 1e-10, "{length}: {forces:?}, {on_outer}");
        // On itself: the mean of just within and just beyond, extrapolated to no distance.
        let near = |factor: f64| averaged_force(1000, length, factor * inner.radius, inner, [0.0; 2]);
        let mean = |by: f64| 0.5 * (near(1.0 - by) + near(1.0 + by));
        let expected = 2.0 * mean(0.01) - mean(0.02);
        assert!((alone(inner) - expected).abs() < 5e-4, "{length}: {}, not {expected}", alone(inner));
    }
}

#[test]
fn images_act_as_their_average_over_directions() {
    let shell = Shell { radius: 30.0, discs: 20.0 };
    let (length, side) = (25.0, 100.0);
    let open = Shells::new(&[shell], 1.0, length).unwrap();
    let images = open.clone().periodic(side).unwrap().forces()[0] - open.forces()[0];
    // Images at D, met from all directions: each as a shell of radius |D| of shells.
    let mut expected = 0.0;
    for l in -5_i32..=5 {
        for m in (-5..=5).filter(|&m| (l, m) != (0, 0)) {
            let distance = side * libm::sqrt(f64::from(l * l + m * m));
            let turned = (0..16).map(|turn| {
                let (sine, cosine) = libm::sincos(TAU * f64::from(turn) / 16.0);
                averaged_force(32, length, shell.radius, shell, [distance * cosine, distance * sine])
            });
            expected += turned.sum::<f64>() / 16.0;
        }
    }
    assert!((images / expected - 1.0).abs() < 1e-4, "{images}, not {expected}");
}

/// Each of m discs evenly on a circle feels (m − 1)/2r of the others.
#[test]
fn discs_do_not_act_upon_themselves() {
    let ring = [Shell { radius: 10.0, discs: 8.0 }];
    let force = Shells::new(&ring, 1.0, NEWTONIAN).unwrap().of_discs().forces()[0];
    assert!((force + 7.0 / 20.0).abs() < 1e-15);
    let lone = [Shell { radius: 0.0, discs: 1.0 }];
    let stays = Shells::new(&lone, 1.0, 10.0).unwrap().of_discs();
    assert_eq!(stays.forces(), [0.0]);
    assert_eq!(stays.radii_at(&[5.0]).unwrap(), [[0.0]]);
}

#[test]
fn no_attraction_moves_nothing() {
    let shells = Shells::new(&patch(), 0.0, 270.0).unwrap();
    let radii = shells.radii_at(&[1e6]).unwrap().remove(0);
    assert!(radii.iter().zip(patch()).all(|(radius, shell)| (radius - shell.radius).abs() < 1e-12));
}

#[test]
fn what_cannot_be_is_refused() {
    let ring = Shell { radius: 10.0, discs: 8.0 };
    let refused = |shell, strength, length| Shells::new(&[ring, shell], strength, length).unwrap_err();
    assert_eq!(
        refused(Shell { radius: -1.0, ..ring }, 1.0, 1.0),
        ShellsError::Radius { index: 1, radius: -1.0 }
    );
    assert_eq!(refused(Shell { discs: 0.0, ..ring }, 1.0, 1.0), ShellsError::Discs { index: 1, discs: 0.0 });
    assert_eq!(refused(ring, -1.0, 1.0), AttractionError::Strength { strength: -1.0 }.into());
    assert_eq!(refused(ring, 1.0, 0.0), AttractionError::Length { length: 0.0 }.into());
    let shells = Shells::new(&[ring], 1.0, 5.0).unwrap();
    assert_eq!(shells.radii_at(&[2.0, 1.0]), Err(EvolutionError::Time { asked: 1.0, time: 2.0 }));
    assert!(matches!(shells.periodic(20.0), Err(AttractionError::Side { .. })));
    assert_eq!(Shells::new(&[], 1.0, 5.0).unwrap().radii_at(&[1.0]), Ok(vec![vec![]]));
}
