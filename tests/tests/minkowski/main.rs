//! Minkowski functionals: exact cases, identities, and Euler characteristics against labels of clusters and holes.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod convergence;
mod exact;
mod labels;
mod properties;

use meniscus::observables::density::Density;
use meniscus::observables::minkowski::Minkowski;
use meniscus_core::torus::Torus;
use meniscus_tests::tolerances;

/// A field on n × n nodes in a box of `side`.
fn field(side: f64, values: Vec<f64>) -> Density {
    Density::from_values(&Torus::new(side).unwrap(), values).unwrap()
}

fn functionals(area: f64, length: f64, euler: i64) -> Minkowski {
    Minkowski { area, length, euler }
}

/// Area, length and Euler characteristic agree, the former two but for rounding.
#[track_caller]
fn assert_same(found: Minkowski, wanted: Minkowski) {
    let near = |found: f64, wanted: f64| {
        (found - wanted).abs() <= tolerances::POLYGON_ROUNDING * (1.0 + wanted.abs())
    };
    let same =
        near(found.area, wanted.area) && near(found.length, wanted.length) && found.euler == wanted.euler;
    assert!(same, "{found:?} for {wanted:?}");
}
