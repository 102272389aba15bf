//! What holds for any field.

use super::labels::{labelled, mean_exceeds};
use super::{assert_same, field, functionals};
use meniscus::observables::density::Density;
use meniscus::observables::minkowski::{by_contours, by_pixels};
use proptest::prelude::*;

/// Values from −1 to 1 of some roughness; small whole numbers of steps, so that ties of values occur, and sums are exact.
fn any_field() -> impl Strategy<Value = Density> {
    (3_usize..12).prop_flat_map(|grid| {
        prop::collection::vec(-8_i8..=8, grid * grid).prop_map(move |values| {
            field(grid as f64, values.into_iter().map(|value| f64::from(value) / 8.0).collect())
        })
    })
}

/// The same with a rim of the lowest value, so that no domain reaches around the box.
fn any_island() -> impl Strategy<Value = Density> {
    any_field().prop_map(|density| {
        let grid = density.grid();
        let rim =
            |node: usize| [node / grid, node % grid].iter().any(|place| *place == 0 || *place == grid - 1);
        let values =
            density.values().iter().enumerate().map(|(node, value)| if rim(node) { -2.0 } else { *value });
        field(grid as f64, values.collect())
    })
}

/// Thresholds between the steps of the values and on them.
fn any_threshold() -> impl Strategy<Value = f64> {
    (-17_i8..=17).prop_map(|half_steps| f64::from(half_steps) / 16.0)
}

fn negative(density: &Density) -> Density {
    field(density.grid() as f64, density.values().iter().map(|value| -value).collect())
}

/// Convex minus concave corners of the boundary over 4 (Gauss and Bonnet), where pixels that touch at a corner are connected.
fn curvature(density: &Density, threshold: f64) -> i64 {
    let quarters: i64 = density
        .squares()
        .map(|values| {
            let [first, second, third, fourth] = values.map(|value| value > threshold);
            match i64::from(first) + i64::from(second) + i64::from(third) + i64::from(fourth) {
                1 => 1,
                2 if first == third => -2,
                3 => -1,
                _ => 0,
            }
        })
        .sum();
    assert_eq!(quarters % 4, 0);
    quarters / 4
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn euler_of_pixels_is_clusters_minus_holes(density in any_island(), threshold in any_threshold()) {
        let domain: Vec<bool> = density.values().iter().map(|value| *value > threshold).collect();
        let wanted = labelled(density.grid(), &domain, |_, _| true, |_, _| false);
        prop_assert_eq!(by_pixels(&density, threshold).euler, wanted);
    }

    #[test]
    fn euler_of_contours_is_clusters_minus_holes(density in any_island(), threshold in any_threshold()) {
        let domain: Vec<bool> = density.values().iter().map(|value| *value > threshold).collect();
        let exceeds = |first, second| mean_exceeds(&density, threshold, first, second);
        let wanted = labelled(density.grid(), &domain, exceeds, |first, second| !exceeds(first, second));
        prop_assert_eq!(by_contours(&density, threshold).euler, wanted);
    }

    #[test]
    fn euler_of_pixels_is_the_curvature_of_the_boundary(density in any_field(), threshold in any_threshold()) {
        prop_assert_eq!(by_pixels(&density, threshold).euler, curvature(&density, threshold));
    }

    #[test]
    fn area_and_length_of_pixels_are_counts(density in any_field(), threshold in any_threshold()) {
        let grid = density.grid();
        let inside = |x: usize, y: usize| density.values()[x % grid * grid + y % grid] > threshold;
        let nodes = || (0..grid).flat_map(|x| (0..grid).map(move |y| (x, y)));
        let area = nodes().filter(|(x, y)| inside(*x, *y)).count();
        let open_sides = |(x, y): (usize, usize)| {
            let around = [(x + 1, y), (x + grid - 1, y), (x, y + 1), (x, y + grid - 1)];
            around.iter().filter(|(x, y)| !inside(*x, *y)).count()
        };
        let length: usize = nodes().filter(|(x, y)| inside(*x, *y)).map(open_sides).sum();
        let found = by_pixels(&density, threshold);
        prop_assert_eq!((found.area, found.length), (area as f64, length as f64));
    }

    #[test]
    fn pixels_are_additive(first in any_field(), second in any_field(), threshold in any_threshold()) {
        let grid = first.grid().min(second.grid());
        let cut = |density: &Density| -> Vec<f64> {
            (0..grid * grid).map(|node| density.values()[node / grid * density.grid() + node % grid]).collect()
        };
        let (first, second) = (cut(&first), cut(&second));
        let combined = |pick: fn(f64, f64) -> f64| {
            by_pixels(&field(grid as f64, first.iter().zip(&second).map(|(a, b)| pick(*a, *b)).collect()), threshold)
        };
        let [union, intersection] = [combined(f64::max), combined(f64::min)];
        let [a, b] = [combined(|a, _| a), combined(|_, b| b)];
        prop_assert_eq!(union.area + intersection.area, a.area + b.area);
        // Where the two touch without a common pixel, closed sets have common sides and corners that no pixel shows; a side
        // counts twice for the length, once from either side.
        let (sides, corners) = touching(grid, |node| first[node] > threshold, |node| second[node] > threshold);
        prop_assert_eq!(union.length + intersection.length + 2.0 * sides as f64, a.length + b.length);
        prop_assert_eq!(union.euler + intersection.euler + corners - sides, a.euler + b.euler);
    }

    #[test]
    fn a_shifted_turned_or_mirrored_field_has_the_same_functionals(
        density in any_field(), threshold in any_threshold(), by in any::<(usize, usize)>(),
    ) {
        let grid = density.grid();
        let moved = |place: &dyn Fn(usize, usize) -> (usize, usize)| {
            let value = |node: usize| {
                let (x, y) = place(node / grid, node % grid);
                density.values()[x % grid * grid + y % grid]
            };
            field(grid as f64, (0..grid * grid).map(value).collect())
        };
        let (along_x, along_y) = (by.0 % grid, by.1 % grid);
        let others = [
            moved(&|x, y| (x + along_x, y + along_y)),
            moved(&|x, y| (y, grid - 1 - x)),
            moved(&|x, y| (grid - 1 - x, grid - 1 - y)),
            moved(&|x, y| (y, x)),
        ];
        for other in others {
            prop_assert_eq!(by_pixels(&other, threshold), by_pixels(&density, threshold));
            assert_same(by_contours(&other, threshold), by_contours(&density, threshold));
        }
    }

    #[test]
    fn a_domain_and_its_complement_share_the_boundary(density in any_field(), threshold in any_threshold()) {
        // Off the steps of the values and of their means, so that nothing is neither above nor below.
        let threshold = threshold + 1.0 / 1024.0;
        let box_area = (density.grid() * density.grid()) as f64;
        let complement = negative(&density);
        let (domain, rest) = (by_contours(&density, threshold), by_contours(&complement, -threshold));
        assert_same(rest, functionals(box_area - domain.area, domain.length, -domain.euler));
        // As pixels the complement is 8-connected too; where diagonal pixels meet, that is one more each.
        let (domain, rest) = (by_pixels(&density, threshold), by_pixels(&complement, -threshold));
        let saddles = density.squares().filter(|values| {
            let [first, second, third, fourth] = values.map(|value| value > threshold);
            first == third && second == fourth && first != second
        });
        let wanted = functionals(box_area - domain.area, domain.length, -domain.euler - saddles.count() as i64);
        prop_assert_eq!(rest, wanted);
    }
}

/// Sides and corners of pixels that belong to pixels of both domains, but to no pixel that is in both.
fn touching(grid: usize, first: impl Fn(usize) -> bool, second: impl Fn(usize) -> bool) -> (i64, i64) {
    let touch = |pixels: &[usize]| {
        let any = |domain: &dyn Fn(usize) -> bool| pixels.iter().any(|node| domain(*node));
        i64::from(any(&first) && any(&second) && !any(&|node| first(node) && second(node)))
    };
    (0..grid * grid).fold((0, 0), |(sides, corners), node| {
        let (x, y) = (node / grid, node % grid);
        let right = (x + 1) % grid * grid + y;
        let [above, across] = [node, right].map(|node| node / grid * grid + (y + 1) % grid);
        (
            sides + touch(&[node, right]) + touch(&[node, above]),
            corners + touch(&[node, right, above, across]),
        )
    })
}
