//! Invariants of mass assignment: from discs to the nodes of a mesh.
//!
//! A mass kernel is anything that takes [`Discs`] and gives the mass of every node, node (x, y) of an M × M mesh being
//! element `x·M + y`, in integers of unit 2⁻²⁰ discs. A kernel in floating point rounds to that unit and needs a
//! tolerance.
//!
//! ```
//! use meniscus_core::grid::Grid;
//! use meniscus_core::parameters::Assignment;
//! use meniscus_core::property::{Discs, Tolerance, kernels, masses};
//! use meniscus_core::torus::Torus;
//!
//! let discs = Discs::from_coordinates(Torus::new(64.0).unwrap(), &[[1.0, 2.0], [63.9, 3.0]]);
//! let discs = discs.with_strengths(&[1 << 20, -12345]);
//! let kernel = kernels::masses(Assignment::Order5, Grid::SMALLEST);
//! masses::total(&kernel, &discs, Tolerance::EXACT).unwrap();
//! masses::superposition(&kernel, &discs, Tolerance::EXACT).unwrap();
//! ```

use super::discs::{Discs, shifted};
use super::forces::{cells, modulus};
use super::violation::{Invariant, Tolerance, Violation, check, check_count, check_each};
use crate::assignment::DISC;
use crate::grid::Grid;
use std::vec::Vec;

/// Masses of all nodes of a mesh, unit 2⁻²⁰ discs: implemented for every closure and function with this signature.
pub trait MassKernel: FnMut(&Discs) -> Vec<i64> {}

impl<K: FnMut(&Discs) -> Vec<i64>> MassKernel for K {}

/// Nothing is lost or made: the masses of the nodes sum to the strengths of the discs.
///
/// The scale is the sum of the moduli of the strengths.
///
/// # Errors
/// A [`Violation`].
pub fn total(mut kernel: impl MassKernel, discs: &Discs, tolerance: Tolerance) -> Result<(), Violation> {
    let nodes: i128 = kernel(discs).into_iter().map(i128::from).sum();
    let strengths: i128 = discs.strengths().iter().map(|&strength| i128::from(strength)).sum();
    let moduli: u64 = discs.strengths().iter().map(|strength| u64::from(strength.unsigned_abs())).sum();
    let allowed = tolerance.at(moduli as f64 / f64::from(DISC));
    check(Invariant::TotalMass, (nodes - strengths).unsigned_abs() as f64 / f64::from(DISC), allowed, [])
}

/// The masses of all discs together are the sums of those of each one alone, in whatever order.
///
/// The scale is the largest mass of a node.
///
/// # Errors
/// A [`Violation`] with the nodes.
pub fn superposition(
    mut kernel: impl MassKernel,
    discs: &Discs,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let together = kernel(discs);
    let mut sums = std::vec![0_i64; together.len()];
    for id in (0..discs.len()).rev() {
        let alone = kernel(&discs.selected(&[id]));
        check_count(alone.len(), together.len())?;
        sums.iter_mut().zip(alone).for_each(|(sum, mass)| *sum = sum.saturating_add(mass));
    }
    compare(Invariant::Superposition, &together, &sums, tolerance)
}

/// Moving the discs by whole cells, (columns, rows), moves the masses by as many nodes.
///
/// The scale is the largest mass of a node.
///
/// # Errors
/// A [`Violation`] with the nodes; [`Invariant::Count`] unless there are M × M.
pub fn translation_by_cells(
    mut kernel: impl MassKernel,
    discs: &Discs,
    grid: Grid,
    (columns, rows): (u32, u32),
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let nodes = grid.nodes();
    let before = kernel(discs);
    check_count(before.len(), nodes * nodes)?;
    let after = kernel(&discs.moved(|position| shifted(position, (cells(columns, grid), cells(rows, grid)))));
    check_count(after.len(), nodes * nodes)?;
    let came_from = |node: usize| {
        let column = grid.wrap((node / nodes).wrapping_sub(columns as usize));
        let row = grid.wrap((node % nodes).wrapping_sub(rows as usize));
        before.get(column * nodes + row).copied().unwrap_or(0)
    };
    let expected: Vec<i64> = (0..nodes * nodes).map(came_from).collect();
    compare(Invariant::MassTranslation, &after, &expected, tolerance)
}

/// The mass of each disc alone has its center where the disc is, if that mass lies within half a box around it: sums
/// of weights times distances vanish for B-splines of every order.
///
/// The absolute tolerance is in mesh cells; there is no scale. A disc of strength 0 must have no moment at all.
///
/// # Errors
/// A [`Violation`] with the discs, in mesh cells; [`Invariant::Count`] unless there are M × M nodes.
pub fn center_of_mass(
    mut kernel: impl MassKernel,
    discs: &Discs,
    grid: Grid,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let mut offsets = Vec::with_capacity(discs.len());
    for (id, (position, &strength)) in discs.positions().iter().zip(discs.strengths()).enumerate() {
        let masses = kernel(&discs.selected(&[id]));
        check_count(masses.len(), grid.nodes() * grid.nodes())?;
        let mut moment = [0_i128; 2];
        for (node, &mass) in masses.iter().enumerate() {
            let at = [node / grid.nodes(), node % grid.nodes()];
            let of_disc = [position.x, position.y];
            for ((moment, index), coordinate) in moment.iter_mut().zip(at).zip(of_disc) {
                let distance = cells(index as u32, grid).wrapping_sub(coordinate.to_bits()) as i32;
                *moment += i128::from(mass) * i128::from(distance);
            }
        }
        let mass = if strength == 0 { 1.0 } else { f64::from(strength) };
        let cell = f64::from(cells(1, grid));
        offsets.push(modulus(moment.map(|moment| moment as f64 / mass / cell)));
    }
    check_each(Invariant::CenterOfMass, offsets, tolerance.absolute)
}

/// Each mass against what is expected of it; the scale is the largest expected one.
fn compare(
    invariant: Invariant,
    found: &[i64],
    expected: &[i64],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let scale = expected.iter().map(|mass| mass.unsigned_abs()).max().unwrap_or(0);
    let errors = found.iter().zip(expected).map(|(&found, &expected)| {
        (i128::from(found) - i128::from(expected)).unsigned_abs() as f64 / f64::from(DISC)
    });
    check_each(invariant, errors, tolerance.at(scale as f64 / f64::from(DISC)))
}
