//! Mass assignment and gather.

use super::bytes::Bytes;
use crate::states::coordinates;
use meniscus_core::assignment::{DISC, LARGEST_NODE_MASS, deposit, gather};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::Complex32;
use meniscus_core::units::FORCE_UNITS;

/// Most different places.
const PLACES: usize = 64;

/// Bound of the relative error of a gather's sum of up to nine products in binary32.
const GATHER: f64 = 10.0 / 16_777_216.0;

/// Node masses, unit 2⁻²⁰ discs; none if a node is crowded.
fn node_masses(scheme: Assignment, grid: Grid, discs: &[Position]) -> Option<Vec<u32>> {
    let (x, y) = coordinates(discs);
    let mut nodes = vec![u32::MAX; grid.nodes() * grid.nodes()];
    deposit(scheme, grid, &x, &y, &mut nodes).ok().map(|()| nodes)
}

/// Some places, each with the same number of discs; then: mass is exact and free of order, a crowd is refused exactly
/// when a node holds more than 4095 discs, the gather of a constant field is the constant, and the gather of a field
/// over all discs is the field over all masses.
pub fn assignment(data: &[u8]) {
    let mut bytes = Bytes(data);
    let scheme = bytes.choice([Assignment::CloudInCell, Assignment::TriangularShapedCloud]);
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
