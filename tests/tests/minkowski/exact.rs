//! Cases with results that can be counted.

use super::{assert_same, field, functionals};
use meniscus::observables::density::Density;
use meniscus::observables::minkowski::{Minkowski, by_contours, by_pixels};
use std::f64::consts::{PI, SQRT_2};

/// A picture, 1 where there is a `#`, of nodes 1 R0 apart. A column of the picture is a row of nodes; nothing here minds.
fn picture(rows: &[&str]) -> Density {
    let values: Vec<f64> =
        rows.iter().flat_map(|row| row.chars().map(|dot| f64::from(u8::from(dot == '#')))).collect();
    field(rows.len() as f64, values)
}

#[test]
fn nothing_and_everything() {
    let flat = field(6.0, vec![1.0; 16]);
    for measure in [by_pixels, by_contours] {
        assert_eq!(measure(&flat, 2.0), Minkowski::default());
        // Not greater than itself.
        assert_eq!(measure(&flat, 1.0), Minkowski::default());
        assert_eq!(measure(&flat, f64::NAN), Minkowski::default());
        assert_eq!(measure(&flat, f64::INFINITY), Minkowski::default());
        assert_eq!(measure(&flat, 0.5), functionals(36.0, 0.0, 0));
        assert_eq!(measure(&flat, f64::NEG_INFINITY), functionals(36.0, 0.0, 0));
    }
}

#[test]
fn one_pixel() {
    let dot = picture(&["....", ".#..", "....", "...."]);
    assert_eq!(by_pixels(&dot, 0.5), functionals(1.0, 4.0, 1));
    // A square on its corner, whose half diagonal is 1 − threshold.
    assert_same(by_contours(&dot, 0.5), functionals(0.5, 2.0 * SQRT_2, 1));
    assert_same(by_contours(&dot, 0.25), functionals(2.0 * 0.75 * 0.75, 3.0 * SQRT_2, 1));
    assert_eq!(by_pixels(&dot, 0.5).shape(), Some(4.0 / PI));
}

#[test]
fn one_pixel_missing() {
    let hole = picture(&["####", "#.##", "####", "####"]);
    assert_eq!(by_pixels(&hole, 0.5), functionals(15.0, 4.0, -1));
    assert_same(by_contours(&hole, 0.5), functionals(15.5, 2.0 * SQRT_2, -1));
    assert!(by_pixels(&hole, 0.5).shape().unwrap() < 0.0);
}

#[test]
fn an_annulus_has_neither_clusters_nor_holes_to_spare() {
    let annulus = picture(&[".....", ".###.", ".#.#.", ".###.", "....."]);
    assert_eq!(by_pixels(&annulus, 0.5), functionals(8.0, 16.0, 0));
    // Outside 4 straight sides of 2 and 4 corners of √½, which cut 1/8 off each; inside a diamond of half diagonal 1/2.
    assert_same(by_contours(&annulus, 0.5), functionals(9.0 - 4.0 / 8.0 - 0.5, 8.0 + 4.0 * SQRT_2, 0));
    assert_eq!(by_pixels(&annulus, 0.5).shape(), None);
}

#[test]
fn stripes_around_the_box() {
    for stripe in [picture(&["....", "####", "....", "...."]), picture(&[".#..", ".#..", ".#..", ".#.."])] {
        assert_eq!(by_pixels(&stripe, 0.5), functionals(4.0, 8.0, 0));
        assert_same(by_contours(&stripe, 0.5), functionals(4.0, 8.0, 0));
        assert_eq!(by_contours(&stripe, 0.5).shape(), None);
    }
    // Around both ways: what is left is one cluster, so the opposite of 1.
    let cross = picture(&[".#..", "####", ".#..", ".#.."]);
    assert_eq!(by_pixels(&cross, 0.5), functionals(7.0, 12.0, -1));
    assert_eq!(by_contours(&cross, 0.5).euler, -1);
    // A chain around the box, closed by corners only: an annulus too.
    let diagonal = picture(&["#...", ".#..", "..#.", "...#"]);
    assert_eq!(by_pixels(&diagonal, 0.5), functionals(4.0, 16.0, 0));
}

#[test]
fn two_pixels_that_touch_at_a_corner() {
    let pair = picture(&[".....", ".#...", "..#..", ".....", "....."]);
    assert_eq!(by_pixels(&pair, 0.5), functionals(2.0, 8.0, 1));
    let complement = field(5.0, pair.values().iter().map(|value| -value).collect());
    // The corner belongs to the domain, so that these are two holes.
    assert_eq!(by_pixels(&complement, -0.5).euler, -2);
    // The mean of the saddle is 0.5: connected below, cut at and above.
    for (threshold, clusters) in [(0.49, 1), (0.5, 2), (0.51, 2)] {
        assert_eq!(by_contours(&pair, threshold).euler, clusters);
    }
}

#[test]
fn a_saddle_cut_or_connected_in_length_area_and_number_at_once() {
    let pair = picture(&[".....", ".#...", "..#..", ".....", "....."]);
    // Two diamonds of half diagonal 0.4.
    assert_same(by_contours(&pair, 0.6), functionals(2.0 * 2.0 * 0.16, 2.0 * 4.0 * 0.4 * SQRT_2, 2));
    // Of half diagonal 0.6, whose two facing sides give way to two that cut the other corners at 0.4; what is then in the
    // square between is all but these two corners instead of two corners of 0.6.
    let (facing, across) = (0.6 * SQRT_2, 0.4 * SQRT_2);
    let area = 2.0 * 2.0 * 0.36 - 2.0 * 0.5 * 0.36 + 1.0 - 2.0 * 0.5 * 0.16;
    assert_same(by_contours(&pair, 0.4), functionals(area, 6.0 * facing + 2.0 * across, 1));
}

#[test]
fn equal_discs_have_the_shape_factor_of_one() {
    let one = Minkowski { area: PI * 9.0, length: 2.0 * PI * 3.0, euler: 1 };
    let four = Minkowski { area: 4.0 * one.area, length: 4.0 * one.length, euler: 4 };
    for discs in [one, four] {
        assert!((discs.shape().unwrap() - 1.0).abs() < 1e-15);
    }
}
