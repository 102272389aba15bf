//! Clusters: cases made by hand, and the definition word by word against the fast way.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use meniscus::observables::clusters::{Clusters, NEIGHBOUR_DISTANCE};
use meniscus::observables::neighbours::{Neighbours, squared_distance};
use meniscus::start;
use meniscus_core::torus::{Fraction, Position, Torus};
use proptest::prelude::*;

fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

/// Discs at places in R0, wrapped into the box.
fn discs(torus: &Torus, places: &[(f64, f64)]) -> Vec<Position> {
    let wrapped =
        |(x, y): &(f64, f64)| Position { x: torus.wrapped_fraction(*x), y: torus.wrapped_fraction(*y) };
    places.iter().map(wrapped).collect()
}

/// A core at `(x, y)` with three neighbours 3 R0 away, to the left, to the right and above.
fn cross(x: f64, y: f64) -> [(f64, f64); 4] {
    [(x, y), (x - 3.0, y), (x + 3.0, y), (x, y + 3.0)]
}

/// For each disc the lowest id it is connected with through pairs of which one is a core: all pairs
/// tried until nothing changes.
fn lowest_connected(torus: &Torus, positions: &[Position]) -> Vec<usize> {
    let units = NEIGHBOUR_DISTANCE / torus.side() * 4294967296.0;
    let near = |first: usize, second: usize| {
        first != second && (squared_distance(positions[first], positions[second]) as f64) < units * units
    };
    let ids = 0..positions.len();
    let core: Vec<bool> =
        ids.clone().map(|id| ids.clone().filter(|other| near(id, *other)).count() >= 3).collect();
    let mut lowest: Vec<usize> = ids.clone().collect();
    loop {
        let before = lowest.clone();
        for first in ids.clone() {
            for second in ids.clone() {
                if near(first, second) && (core[first] || core[second]) {
                    lowest[first] = lowest[first].min(lowest[second]);
                }
            }
        }
        if lowest == before {
            return lowest;
        }
    }
}

fn any_discs() -> impl Strategy<Value = (Torus, Vec<Position>)> {
    let places = prop::collection::vec(any::<(u32, u32)>(), 0..150);
    (2.0..60.0_f64, places).prop_map(|(side, places)| {
        (torus(side), places.into_iter().map(|(x, y)| Position::from_bits(x, y)).collect())
    })
}

proptest! {
    #[test]
    fn clusters_are_those_of_the_definition((torus, positions) in any_discs()) {
        let clusters = Clusters::find(&torus, &positions);
        let lowest = lowest_connected(&torus, &positions);
        for first in 0..positions.len() {
            let alone = lowest.iter().filter(|id| **id == lowest[first]).count() == 1;
            prop_assert_eq!(clusters.clustered(first), !alone);
            for second in 0..first {
                let together = !alone && lowest[first] == lowest[second];
                prop_assert_eq!(clusters.clustered(first) && clusters.label(first) == clusters.label(second), together);
            }
        }
    }

    #[test]
    fn sizes_count_the_labels((torus, positions) in any_discs()) {
        let clusters = Clusters::find(&torus, &positions);
        for (label, size) in (0_u32..).zip(clusters.sizes()) {
            let members = (0..positions.len()).filter(|id| clusters.label(*id) == Some(label)).count();
            prop_assert_eq!(members as u32, *size);
            prop_assert!(*size >= 4);
        }
        let first_members: Vec<usize> = (0..clusters.count() as u32)
            .filter_map(|label| (0..positions.len()).find(|id| clusters.label(*id) == Some(label)))
            .collect();
        prop_assert_eq!(first_members.len(), clusters.count());
        prop_assert!(first_members.is_sorted(), "labels in the order of the lowest ids");
    }

    #[test]
    fn order_and_place_do_not_matter(
        (torus, positions) in any_discs(), turn in any::<prop::sample::Index>(), shift in any::<(u32, u32)>(),
    ) {
        prop_assume!(!positions.is_empty());
        let count = positions.len();
        let turn = turn.index(count);
        let mut moved: Vec<Position> = positions
            .iter()
            .map(|p| Position::from_bits(p.x.to_bits().wrapping_add(shift.0), p.y.to_bits().wrapping_add(shift.1)))
            .collect();
        moved.rotate_left(turn);
        moved.reverse();
        let (before, after) = (Clusters::find(&torus, &positions), Clusters::find(&torus, &moved));
        // Where the disc of an id went.
        let place = |id: usize| count - 1 - (id + count - turn) % count;
        for id in 0..count {
            let size = |clusters: &Clusters, id| clusters.label(id).map(|label| clusters.sizes()[label as usize]);
            prop_assert_eq!(size(&before, id), size(&after, place(id)));
        }
        let sorted = |clusters: &Clusters| {
            let mut sizes = clusters.sizes().to_vec();
            sizes.sort_unstable();
            sizes
        };
        prop_assert_eq!(sorted(&before), sorted(&after));
    }

    #[test]
    fn neighbours_are_those_of_all_pairs(
        (torus, positions) in any_discs(), distance in 0.1..40.0_f64, place in any::<(u32, u32)>(),
    ) {
        let units = distance / torus.side() * 4294967296.0;
        let place = Position::from_bits(place.0, place.1);
        let mut near: Vec<u32> =
            Neighbours::new(&torus, &positions, distance).near(place).map(|neighbour| neighbour.id).collect();
        near.sort_unstable();
        let expected: Vec<u32> = (0..positions.len() as u32)
            .filter(|id| (squared_distance(positions[*id as usize], place) as f64) < units * units)
            .collect();
        prop_assert_eq!(near, expected);
    }
}

#[test]
fn three_discs_are_no_cluster_and_four_are() {
    let torus = torus(100.0);
    let all = cross(50.0, 50.0);
    assert_eq!(Clusters::find(&torus, &discs(&torus, &all[..3])).count(), 0);
    let clusters = Clusters::find(&torus, &discs(&torus, &all));
    assert_eq!(clusters.sizes(), &[4]);
    assert!((0..4).all(|id| clusters.clustered(id)));
}

#[test]
fn a_chain_without_a_core_is_no_cluster() {
    let torus = torus(100.0);
    let chain: Vec<(f64, f64)> = (0..20).map(|number| (10.0 + 3.0 * f64::from(number), 50.0)).collect();
    assert_eq!(Clusters::find(&torus, &discs(&torus, &chain)).count(), 0);
}

#[test]
fn neighbours_are_closer_than_the_distance_and_not_at_it() {
    // Multiples of 1/4 are exact in a box of 128 R0.
    let torus = torus(128.0);
    let at =
        |distance: f64| discs(&torus, &[(64.0, 64.0), (61.0, 64.0), (67.0, 64.0), (64.0, 64.0 + distance)]);
    assert_eq!(Clusters::find(&torus, &at(3.25)).count(), 0);
    let mut closer = at(3.25);
    closer[3].y -= Fraction::from_bits(1);
    assert_eq!(Clusters::find(&torus, &closer).count(), 1);
}

#[test]
fn clusters_reach_across_the_border() {
    let torus = torus(100.0);
    for centre in [(0.5, 50.0), (50.0, 99.0), (0.0, 0.0), (99.9, 99.9)] {
        let clusters = Clusters::find(&torus, &discs(&torus, &cross(centre.0, centre.1)));
        assert_eq!(clusters.sizes(), &[4], "about {centre:?}");
    }
}

#[test]
fn a_border_disc_joins_two_clusters() {
    let torus = torus(100.0);
    // The right arm of one cross is the left arm of the other: one disc with two neighbours.
    let mut places = cross(40.0, 50.0).to_vec();
    places.extend(cross(46.0, 50.0).into_iter().filter(|place| *place != (43.0, 50.0)));
    let clusters = Clusters::find(&torus, &discs(&torus, &places));
    assert_eq!(clusters.sizes(), &[7]);
}

#[test]
fn border_discs_that_touch_do_not_join_clusters() {
    let torus = torus(100.0);
    // The arms are 3 R0 apart, and neither is a core.
    let places = [cross(40.0, 50.0), cross(49.0, 50.0)].concat();
    let clusters = Clusters::find(&torus, &discs(&torus, &places));
    assert_eq!(clusters.sizes(), &[4, 4]);
    assert_eq!((clusters.label(2), clusters.label(5)), (Some(0), Some(1)));
}

#[test]
fn averages_are_those_of_the_sizes() {
    let torus = torus(100.0);
    // A cross, and one with a fifth disc.
    let mut places = [cross(20.0, 20.0), cross(60.0, 60.0)].concat();
    places.extend([(60.0, 57.0), (90.0, 20.0)]);
    let clusters = Clusters::find(&torus, &discs(&torus, &places));
    assert_eq!(clusters.sizes(), &[4, 5]);
    assert_eq!((clusters.count(), clusters.largest(), clusters.clustered_discs()), (2, 5, 9));
    assert_eq!(clusters.number_average(), 4.5);
    assert_eq!(clusters.mass_average(), (16.0 + 25.0) / 9.0);
}

#[test]
fn without_clusters_all_is_zero() {
    let clusters = Clusters::find(&torus(100.0), &[]);
    assert_eq!((clusters.count(), clusters.largest(), clusters.clustered(0)), (0, 0, false));
    assert_eq!((clusters.number_average(), clusters.mass_average()), (0.0, 0.0));
}

#[test]
fn close_packed_discs_are_one_cluster() {
    // 2500 discs 2.1 R0 apart.
    let torus = torus(2.1 * 50.0);
    let clusters = Clusters::find(&torus, &start::square_lattice(2500).unwrap());
    assert_eq!(clusters.sizes(), &[2500]);
}
