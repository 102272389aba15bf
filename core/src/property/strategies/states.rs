//! Positions, strengths, states and separations.

use super::super::discs::{Discs, shifted};
use crate::assignment::DISC;
use crate::torus::{Position, Torus, minimum_image};
use core::f64::consts::{FRAC_PI_4, TAU};
use core::ops::Range;
use proptest::collection::{SizeRange, vec};
use proptest::prelude::*;
use std::vec::Vec;

/// A coordinate, unit L·2⁻³²: any bits, or on a seam: nodes and middles of the cells of meshes up to 4096 nodes a
/// side (so the ends and the middle of the box), and one unit beside them.
pub fn coordinate() -> impl Strategy<Value = u32> {
    let seam = (1_u32..=13, any::<u32>(), -1_i32..=1)
        .prop_map(|(exponent, node, beside)| (node << (32 - exponent)).wrapping_add_signed(beside));
    prop_oneof![3 => any::<u32>(), 1 => seam]
}

/// A position of two such coordinates.
pub fn position() -> impl Strategy<Value = Position> {
    (coordinate(), coordinate()).prop_map(|(x, y)| Position::from_bits(x, y))
}

/// Discs of strength 1 at any positions.
pub fn scattered(torus: Torus, count: impl Into<SizeRange>) -> impl Strategy<Value = Discs> {
    vec(position(), count).prop_map(move |positions| Discs::new(torus, positions))
}

/// Discs of strength 1 in a square patch anywhere: 2⁻¹ to 2⁻²⁸ of the side wide, so from a crowd of many overlaps to
/// distances of a few units of position.
pub fn clustered(torus: Torus, count: impl Into<SizeRange>) -> impl Strategy<Value = Discs> {
    (vec(any::<(u32, u32)>(), count), position(), 1_u32..=28).prop_map(move |(offsets, corner, halvings)| {
        let place = |(x, y): (u32, u32)| shifted(&corner, (x >> halvings, y >> halvings));
        Discs::new(torus, offsets.into_iter().map(place).collect())
    })
}

/// Discs of strength 1 of which several are in one place: there are at most four different places.
pub fn coinciding(torus: Torus, count: impl Into<SizeRange>) -> impl Strategy<Value = Discs> {
    (vec(0_usize..4, count), [position(), position(), position(), position()]).prop_map(
        move |(choices, places)| {
            let positions = choices.iter().filter_map(|&choice| places.get(choice).copied());
            Discs::new(torus, positions.collect())
        },
    )
}

/// Discs of strength 1 on a square lattice over the whole box, as many of its sites from the first one on as are asked
/// for, moved as a whole.
pub fn lattice(torus: Torus, count: impl Into<SizeRange>) -> impl Strategy<Value = Discs> {
    (vec(Just(()), count), position()).prop_map(move |(sites, corner)| {
        let count = sites.len();
        let rows = (1..=count).find(|rows| rows * rows >= count).unwrap_or(1);
        let at = |index: usize| (((index as u64) << 32) / rows as u64) as u32;
        let place = |site: usize| shifted(&corner, (at(site % rows), at(site / rows)));
        Discs::new(torus, (0..count).map(place).collect())
    })
}

/// Discs of strength 1 of which no two are nearer than `distance` (R0): of `count` candidates those that fit.
pub fn separated(torus: Torus, count: impl Into<SizeRange>, distance: f64) -> impl Strategy<Value = Discs> {
    vec(position(), count).prop_map(move |candidates| {
        let apart = |first: Position, second: Position| {
            let (x, y) = (minimum_image(first.x, second.x), minimum_image(first.y, second.y));
            let (x, y) = (torus.length(x), torus.length(y));
            x * x + y * y >= distance * distance
        };
        let mut taken: Vec<Position> = Vec::new();
        for candidate in candidates {
            if taken.iter().all(|&other| apart(candidate, other)) {
                taken.push(candidate);
            }
        }
        Discs::new(torus, taken)
    })
}

/// Any of the states above, with equal strengths; [`separated`] ones 2 R0 apart, in contact at most.
pub fn states(torus: Torus, count: impl Into<SizeRange>) -> impl Strategy<Value = Discs> {
    let count = count.into();
    prop_oneof![
        2 => scattered(torus, count.clone()),
        2 => separated(torus, count.clone(), 2.0),
        1 => clustered(torus, count.clone()),
        1 => coinciding(torus, count.clone()),
        1 => lattice(torus, count),
    ]
}

/// A capillary strength, unit 2⁻²⁰: 1, −1, 0, the least ones, or any of modulus up to 4.
pub fn strength() -> impl Strategy<Value = i32> {
    const ONE: i32 = DISC as i32;
    prop_oneof![
        3 => prop::sample::select(&[ONE, -ONE, 0, 1, -1][..]),
        2 => -4 * ONE..=4 * ONE,
    ]
}

/// The states of `states` with unequal strengths, see [`strength`]: the core takes them up to V0 = 62.5 kBT.
pub fn with_strengths(states: impl Strategy<Value = Discs>) -> impl Strategy<Value = Discs> {
    (states, vec(strength(), 1..=8)).prop_map(|(discs, strengths)| discs.with_strengths(&strengths))
}

/// Where a disc is as seen from another one, R0: every order of magnitude of `distances` (R0, above 0) and every
/// direction is as likely, axes and diagonals more so.
pub fn separation(distances: Range<f64>) -> impl Strategy<Value = [f64; 2]> {
    let Range { start, end } = distances;
    let direction = prop_oneof![
        1 => (0_u32..8).prop_map(|eighth| FRAC_PI_4 * f64::from(eighth)),
        3 => 0.0..TAU,
    ];
    (0.0..1.0, direction).prop_map(move |(fraction, angle)| {
        let distance = start * libm::exp(libm::log(end / start) * fraction);
        let (sine, cosine) = libm::sincos(angle);
        [distance * cosine, distance * sine]
    })
}
