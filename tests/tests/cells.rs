//! The list of cells: every near pair, each once, as by looking at all pairs.

use meniscus_core::cells::{Separation, for_each_pair};
use meniscus_core::torus::Position;
use meniscus_tests::states::{coordinates, crowded, scattered, shuffled, with_ids};
use proptest::prelude::*;

/// The pairs the list finds, each as (lower, higher, separation lower − higher), sorted.
fn listed(discs: &[Position], reach: u32, memory: usize) -> Vec<(usize, usize, (i32, i32))> {
    let (x, y) = coordinates(discs);
    // What working memory held before does not matter.
    let (mut heads, mut next) = (vec![3; memory], vec![3; discs.len()]);
    let mut pairs = Vec::new();
    for_each_pair((&x, &y), reach, &mut heads, &mut next, |first, second, Separation { x, y }| {
        pairs.push(if first < second {
            (first, second, (x, y))
        } else {
            // Half a box is its own negative.
            (second, first, (x.wrapping_neg(), y.wrapping_neg()))
        });
    });
    pairs.sort_unstable();
    pairs
}

/// The same by looking at all pairs, with arithmetic of its own.
fn all_pairs(discs: &[Position], reach: u32) -> Vec<(usize, usize, (i32, i32))> {
    let nearest = |to: u32, from: u32| {
        let plain = i64::from(to) - i64::from(from);
        let half = 1_i64 << 31;
        ((plain + half).rem_euclid(1 << 32) - half) as i32
    };
    let squared = |length: u64| u128::from(length) * u128::from(length);
    let farthest = squared(u64::from(reach) + u64::from(reach) / 65536 + 1);
    let mut pairs = Vec::new();
    for (lower, first) in discs.iter().enumerate() {
        for (higher, second) in discs.iter().enumerate().skip(lower + 1) {
            let x = nearest(first.x.to_bits(), second.x.to_bits());
            let y = nearest(first.y.to_bits(), second.y.to_bits());
            let distance = squared(x.unsigned_abs().into()) + squared(y.unsigned_abs().into());
            if x.unsigned_abs() <= reach && y.unsigned_abs() <= reach && distance <= farthest {
                pairs.push((lower, higher, (x, y)));
            }
        }
    }
    pairs
}

fn states() -> impl Strategy<Value = Vec<Position>> {
    let scattered = (any::<u64>(), 0_usize..80).prop_map(|(seed, count)| scattered(seed, count));
    let crowded = (any::<u64>(), 0_usize..60, 0.0..0.5_f64)
        .prop_map(|(seed, count, width)| crowded(seed, count, width));
    // On and beside the borders of cells, whose number divides 2³² or does not.
    let border = |cells: u64, index: u64, beside: i32| {
        ((((index % cells) << 32) / cells) as u32).wrapping_add_signed(beside)
    };
    let on_borders = prop::collection::vec((1_u64..40, any::<(u64, u64)>(), -1_i32..=1, -1_i32..=1), 0..60)
        .prop_map(move |discs| {
            let position = |(cells, (column, row), x, y)| {
                Position::from_bits(border(cells, column, x), border(cells, row, y))
            };
            discs.into_iter().map(position).collect()
        });
    prop_oneof![scattered, crowded, on_borders]
}

/// From nothing to half a box, few and many cells a side alike.
fn reaches() -> impl Strategy<Value = u32> {
    prop_oneof![
        0_u32..=0x7FFF_FFFF,
        (0_u32..31, any::<u32>()).prop_map(|(shift, bits)| (bits >> 1) >> shift),
        // Reaches that divide the box evenly, and one unit more or less.
        (1_u64..64, -1_i32..=1).prop_map(|(cells, beside)| {
            (((1_u64 << 32) / cells) as u32).wrapping_add_signed(beside).min(0x7FFF_FFFF)
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn cells_find_exactly_the_near_pairs_each_once(
        discs in states(),
        reach in reaches(),
        memory in prop_oneof![0_usize..20, 0_usize..2000],
    ) {
        prop_assert_eq!(listed(&discs, reach, memory), all_pairs(&discs, reach));
    }

    #[test]
    fn pairs_do_not_depend_on_storage_order(discs in states(), reach in reaches(), seed in any::<u64>()) {
        let mixed = shuffled(seed, &with_ids(&discs));
        let positions: Vec<Position> = mixed.iter().map(|&(_, position)| position).collect();
        let mut by_id: Vec<_> = listed(&positions, reach, 400)
            .into_iter()
            .map(|(first, second, (x, y))| {
                let (first, second) = (mixed[first].0 as usize, mixed[second].0 as usize);
                if first < second {
                    (first, second, (x, y))
                } else {
                    (second, first, (x.wrapping_neg(), y.wrapping_neg()))
                }
            })
            .collect();
        by_id.sort_unstable();
        prop_assert_eq!(by_id, listed(&discs, reach, 400));
    }
}

#[test]
fn one_to_six_cells_a_side_find_the_same_pairs() {
    let discs = scattered(1, 200);
    let reach = u32::MAX / 5;
    for cells in 0..=6_usize {
        assert_eq!(listed(&discs, reach, cells * cells), all_pairs(&discs, reach), "{cells} cells a side");
    }
}

#[test]
fn coinciding_discs_are_pairs() {
    let discs = [Position::from_bits(5, 5); 4];
    for memory in [0, 256] {
        assert_eq!(listed(&discs, 0, memory).len(), 6);
    }
}

#[test]
fn discs_exactly_half_a_box_apart_are_no_pair() {
    let discs = [Position::from_bits(0, 0), Position::from_bits(1 << 31, 0), Position::from_bits(0, 1 << 31)];
    assert_eq!(listed(&discs, 0x7FFF_FFFF, 256), []);
}

#[test]
fn a_lone_disc_and_no_disc_have_no_pairs() {
    assert_eq!(listed(&[], 1 << 20, 256), []);
    assert_eq!(listed(&[Position::from_bits(1, 2)], 1 << 20, 256), []);
}
