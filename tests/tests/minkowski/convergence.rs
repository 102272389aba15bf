//! Smooth domains on ever finer grids.

use super::field;
use libm::hypot;
use meniscus::observables::density::Density;
use meniscus::observables::minkowski::{Minkowski, by_contours, by_pixels};
use meniscus_tests::tolerances;
use std::f64::consts::PI;

/// `height(x, y)` sampled on n × n nodes, with x and y as distances from the middle, R0.
fn sampled(side: f64, grid: usize, height: impl Fn(f64, f64) -> f64) -> Density {
    let place = |node: usize| (node as f64 / grid as f64 - 0.5) * side;
    field(side, (0..grid * grid).map(|node| height(place(node / grid), place(node % grid))).collect())
}

fn squared(number: f64) -> f64 {
    number * number
}

/// Relative errors of area and length of a disc of radius 17 R0 off the middle of a box of 64 R0.
fn disc_errors(grid: usize, measure: fn(&Density, f64) -> Minkowski) -> [f64; 2] {
    let radius = 17.0_f64;
    let bump = sampled(64.0, grid, |x, y| squared(radius) - squared(x - 0.3) - squared(y + 0.7));
    let found = measure(&bump, 0.0);
    assert_eq!(found.euler, 1);
    [found.area / (PI * radius * radius) - 1.0, found.length / (2.0 * PI * radius) - 1.0]
}

#[test]
fn contours_of_a_disc_converge_with_the_square_of_the_spacing() {
    let tolerances::Within(least, most) = tolerances::QUARTERED;
    let errors = [32, 64, 128, 256].map(|grid| disc_errors(grid, by_contours));
    for pair in errors.windows(2) {
        let [area, length] = [0, 1].map(|quantity| pair[0][quantity] / pair[1][quantity]);
        assert!((least..=most).contains(&area) && (least..=most).contains(&length), "{errors:?}");
    }
    assert!(errors[3].iter().all(|error| error.abs() < 1e-4), "{errors:?}");
}

#[test]
fn pixels_of_a_disc_have_its_area_and_four_over_pi_of_its_length() {
    let [area, length] = disc_errors(512, by_pixels);
    assert!(area.abs() < 1e-3, "{area}");
    assert!((length + 1.0 - 4.0 / PI).abs() < 5e-3, "{length}");
}

#[test]
fn an_annulus_and_a_turned_ellipse_are_found_by_contours() {
    let annulus = sampled(64.0, 256, |x, y| -(hypot(x, y) - 15.0).abs());
    let found = by_contours(&annulus, -5.0);
    assert_eq!(found.euler, 0);
    assert!((found.area / (PI * (400.0 - 100.0)) - 1.0).abs() < 3e-4, "{found:?}");
    assert!((found.length / (2.0 * PI * 30.0) - 1.0).abs() < 3e-4, "{found:?}");
    // The same ellipse, whichever way it lies.
    let ellipse = |angle: f64| {
        let (sine, cosine) = libm::sincos(angle);
        let turned = move |x: f64, y: f64| (cosine * x + sine * y, cosine * y - sine * x);
        by_contours(
            &sampled(64.0, 256, |x, y| {
                let (along, across) = turned(x, y);
                1.0 - squared(along / 20.0) - squared(across / 10.0)
            }),
            0.0,
        )
    };
    for angle in [0.0, 0.3, 0.7, 1.0, 1.5] {
        let found = ellipse(angle);
        assert_eq!(found.euler, 1);
        assert!((found.area / (PI * 200.0) - 1.0).abs() < 3e-4, "{angle}: {found:?}");
        // Circumference of an ellipse of axes 2 to 1: 4a·E(√¾), E = 1.2110560276.
        assert!((found.length / (80.0 * 1.211_056_027_6) - 1.0).abs() < 3e-4, "{angle}: {found:?}");
    }
}
