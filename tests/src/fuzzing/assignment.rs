//! Mass assignment and gather.

use super::bytes::Bytes;
use crate::states::coordinates;
use meniscus_core::assignment::{
    DISC, LARGEST_NODE_MASS, LARGEST_NODE_STRENGTH, deposit, deposit_strengths, gather, gather_strengths,
};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::Complex32;
use meniscus_core::units::FORCE_UNITS;

/// Most different places.
const PLACES: usize = 64;

/// Bound of the relative error of a gather's sum of up to 49 products in binary32.
const GATHER: f64 = 50.0 / 16_777_216.0;

/// Node masses, unit 2⁻²⁰ discs; none if a node is crowded.
fn node_masses(scheme: Assignment, grid: Grid, discs: &[Position]) -> Option<Vec<u32>> {
    let (x, y) = coordinates(discs);
    let mut nodes = vec![u32::MAX; grid.nodes() * grid.nodes()];
    deposit(scheme, grid, &x, &y, &mut nodes).ok().map(|()| nodes)
}

/// Some places, each with the same number of discs; then: mass is exact and free of order, a crowd is refused exactly
/// when a node holds more than 4095 discs, the gather of a constant field is the constant, and the gather of a field
/// over all discs is the field over all masses. Of strengths of either sign, made of the places' bits: their sum is exact
/// and free of order, refused only if a node's moduli may exceed the limit, and the gather is adjoint too.
pub fn assignment(data: &[u8]) {
    let mut bytes = Bytes(data);
    let scheme = bytes.choice(Assignment::ALL);
    let Some(grid) = Grid::new(16 << (bytes.byte() % 3)) else {
        unreachable!("16, 32 and 64 are grids");
    };
    let repeats = 1 + u32::from(bytes.byte());
    let constant = (f32::from(bytes.byte()) - 128.0) * (f32::from(bytes.byte()) + 1.0);
    let mut places = Vec::new();
    while !bytes.is_empty() && places.len() < PLACES {
        places.push(Position::from_bits(bytes.bits_32(), bytes.bits_32()));
    }
    let Some(nodes) = node_masses(scheme, grid, &places) else {
        unreachable!("{PLACES} discs do not crowd a node");
    };
    assert_eq!(total(&nodes), places.len() as u64 * u64::from(DISC));
    check_crowd(scheme, grid, &places, repeats, &nodes);
    check_gather(scheme, grid, &places, constant, &nodes);
    check_strengths(scheme, grid, &places, repeats);
}

fn total(nodes: &[u32]) -> u64 {
    nodes.iter().map(|&mass| u64::from(mass)).sum()
}

/// The discs of `places` again and again, from the last to the first.
fn check_crowd(scheme: Assignment, grid: Grid, places: &[Position], repeats: u32, nodes: &[u32]) {
    let crowd: Vec<Position> =
        places.iter().rev().copied().cycle().take(places.len() * repeats as usize).collect();
    let expected: Vec<u64> = nodes.iter().map(|&mass| u64::from(mass) * u64::from(repeats)).collect();
    let limit = u64::from(LARGEST_NODE_MASS * DISC);
    let is_crowded = expected.iter().any(|&mass| mass > limit);
    let found = node_masses(scheme, grid, &crowd);
    assert_eq!(found.is_none(), is_crowded);
    if let Some(found) = found {
        assert!(found.iter().map(|&mass| u64::from(mass)).eq(expected));
    }
}

/// The field F_x = `constant`, F_y = a ramp over the nodes.
fn check_gather(scheme: Assignment, grid: Grid, places: &[Position], constant: f32, nodes: &[u32]) {
    let ramp = |node: usize| node as f32 - constant;
    let field: Vec<Complex32> = (0..nodes.len()).map(|node| Complex32::new(constant, ramp(node))).collect();
    let (x, y): (Vec<Fraction>, Vec<Fraction>) = coordinates(places);
    let (mut force_x, mut force_y) = (vec![i64::MAX; x.len()], vec![i64::MAX; x.len()]);
    gather(scheme, grid, (&x, &y), &field, (&mut force_x, &mut force_y));

    let units = f64::from(FORCE_UNITS);
    let largest = |force: f32| f64::from(force.abs()) * units * GATHER + 0.5;
    for &force in &force_x {
        let error = force as f64 - f64::from(constant) * units;
        assert!(error.abs() <= largest(constant), "{force} units, not {constant}");
    }
    let by_nodes = nodes.iter().enumerate().map(|(node, &mass)| f64::from(mass) * f64::from(ramp(node)));
    let by_nodes = by_nodes.sum::<f64>() / f64::from(DISC) * units;
    let by_discs = force_y.iter().map(|&force| force as f64).sum::<f64>();
    let steepest = field.iter().map(|force| force.im.abs()).fold(0.0, f32::max);
    let tolerance = largest(steepest) * places.len() as f64;
    assert!((by_discs - by_nodes).abs() <= tolerance, "{by_discs} by discs, {by_nodes} by nodes");
}

/// Strengths of either sign up to 2048, or all of them small.
fn check_strengths(scheme: Assignment, grid: Grid, places: &[Position], repeats: u32) {
    let shift = repeats % 24;
    let strength = |place: &Position| (place.x.to_bits() ^ place.y.to_bits().rotate_left(16)) as i32 >> shift;
    let strengths: Vec<i32> = places.iter().map(strength).collect();
    let Some(sums) = node_strengths(scheme, grid, places, &strengths) else {
        let moduli: u64 = strengths.iter().map(|strength| u64::from(strength.unsigned_abs())).sum();
        assert!(moduli > u64::from(LARGEST_NODE_STRENGTH) * u64::from(DISC), "{strengths:?} refused");
        return;
    };
    let exact: i64 = strengths.iter().map(|&strength| i64::from(strength)).sum();
    assert_eq!(sums.iter().map(|&sum| i64::from(sum)).sum::<i64>(), exact);
    let backwards: (Vec<_>, Vec<_>) = places.iter().copied().zip(strengths.iter().copied()).rev().unzip();
    assert_eq!(node_strengths(scheme, grid, &backwards.0, &backwards.1).as_ref(), Some(&sums));

    let field: Vec<Complex32> = (0..sums.len()).map(|node| Complex32::new(node as f32, 1.0)).collect();
    let (x, y) = coordinates(places);
    let (mut force_x, mut force_y) = (vec![i64::MAX; x.len()], vec![i64::MAX; x.len()]);
    gather_strengths(scheme, grid, (&x, &y), &strengths, &field, (&mut force_x, &mut force_y));
    let units = f64::from(FORCE_UNITS) / f64::from(DISC);
    let (mut by_nodes, mut by_discs, mut tolerance) = (0.0, 0.0, 0.0);
    for (node, &sum) in sums.iter().enumerate() {
        by_nodes += f64::from(sum) * node as f64 * units;
    }
    for (&force, &strength) in force_x.iter().zip(&strengths) {
        by_discs += force as f64;
        tolerance += f64::from(strength).abs() * sums.len() as f64 * units * GATHER + 0.5;
    }
    assert!((by_discs - by_nodes).abs() <= tolerance, "{by_discs} by discs, {by_nodes} by nodes");
    for (&force, &strength) in force_y.iter().zip(&strengths) {
        let error = force as f64 - f64::from(strength) * units;
        assert!(error.abs() <= f64::from(strength).abs() * units * GATHER + 0.5, "{force} of {strength}");
    }
}

/// Node sums of strengths, unit 2⁻²⁰; none if a node is crowded.
fn node_strengths(scheme: Assignment, grid: Grid, discs: &[Position], strengths: &[i32]) -> Option<Vec<i32>> {
    let (x, y) = coordinates(discs);
    let mut nodes = vec![u32::MAX; grid.nodes() * grid.nodes()];
    deposit_strengths(scheme, grid, (&x, &y), strengths, &mut nodes).ok()?;
    Some(nodes.into_iter().map(|sum| sum as i32).collect())
}
