//! Invariants of forces on all discs of a state.
//!
//! A force kernel is anything that takes [`Discs`] and gives the force on each, kBT/R0, by id. The symmetries suppose
//! that there is no external field, and that no disc's force depends on its id or on the axes of the box; a rule for
//! coinciding discs or for discs exactly half a box apart does either, so keep those out of the states where a kernel
//! has one ([`super::strategies::separated`]).
//!
//! The scale of a [`Tolerance`] is the largest modulus of the forces, unless stated otherwise.
//!
//! ```
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::property::{Discs, Tolerance, forces, kernels};
//! use meniscus_core::torus::Torus;
//!
//! // The core's repulsion alone is quantised once a pair: it sums to zero exactly.
//! let parameters = Parameters { capillary_strength: 0.0, grid: 16, ..Parameters::DEFAULT };
//! let discs = Discs::from_coordinates(Torus::new(64.0).unwrap(), &[[1.0, 2.0], [63.1, 2.3], [63.9, 0.4]]);
//! let mut kernel = kernels::forces(&parameters).unwrap();
//! forces::momentum(&mut kernel, &discs, Tolerance::EXACT).unwrap();
//! forces::reflections(&mut kernel, &discs, Tolerance::EXACT).unwrap();
//! ```

use super::discs::{Discs, shifted};
use super::violation::{Invariant, Tolerance, Violation, check, check_count, check_each};
use crate::grid::Grid;
use crate::torus::{Fraction, Position, UNITS};
use core::ops::RangeInclusive;
use std::vec::Vec;

/// Forces on all discs, kBT/R0, by id: implemented for every closure and function with this signature, which may keep
/// its arrays between calls.
///
/// A kernel that fails gives no value; all invariants then report [`Invariant::Count`].
pub trait ForceKernel: FnMut(&Discs) -> Vec<[f64; 2]> {}

impl<K: FnMut(&Discs) -> Vec<[f64; 2]>> ForceKernel for K {}

/// Energy of all discs, kBT: implemented for every closure and function with this signature.
pub trait EnergyKernel: FnMut(&Discs) -> f64 {}

impl<K: FnMut(&Discs) -> f64> EnergyKernel for K {}

/// Forces on all discs, kBT/R0, from coordinates that may lie outside the box (R0) and the side of the box (R0):
/// implemented for every closure and function with this signature.
pub trait CoordinateKernel: FnMut(&[[f64; 2]], f64) -> Vec<[f64; 2]> {}

impl<K: FnMut(&[[f64; 2]], f64) -> Vec<[f64; 2]>> CoordinateKernel for K {}

/// Newton's third law: the forces sum to zero.
///
/// The scale is the sum of the moduli, and the absolute tolerance is one for each disc.
///
/// # Errors
/// A [`Violation`] without ids.
pub fn momentum(mut kernel: impl ForceKernel, discs: &Discs, tolerance: Tolerance) -> Result<(), Violation> {
    let forces = asked(&mut kernel, discs)?;
    let net = forces.iter().fold([0.0; 2], |sum, force| [sum[0] + force[0], sum[1] + force[1]]);
    let moduli: f64 = forces.iter().map(|&force| modulus(force)).sum();
    let allowed = tolerance.relative * moduli + tolerance.absolute * discs.len() as f64;
    check(Invariant::Momentum, modulus(net), allowed, [])
}

/// A disc that is alone in the box feels no force.
///
/// There is no scale: only the absolute tolerance counts.
///
/// # Errors
/// A [`Violation`] with the discs that pull themselves.
pub fn self_force(
    mut kernel: impl ForceKernel,
    discs: &Discs,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let mut pulls = Vec::with_capacity(discs.len());
    for id in 0..discs.len() {
        pulls.extend(asked(&mut kernel, &discs.selected(&[id]))?.into_iter().map(modulus));
    }
    check_each(Invariant::SelfForce, pulls, tolerance.absolute)
}

/// Moving all discs by (`x`, `y`), unit L·2⁻³², changes no force.
///
/// A kernel with a mesh keeps this only within the error of its mesh, see [`translation_by_cells`].
///
/// # Errors
/// A [`Violation`] with the discs whose forces changed.
pub fn translation(
    mut kernel: impl ForceKernel,
    discs: &Discs,
    (x, y): (u32, u32),
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let expected = asked(&mut kernel, discs)?;
    let found = asked(&mut kernel, &discs.moved(|position| shifted(position, (x, y))))?;
    compare(Invariant::Translation, &found, &expected, tolerance)
}

/// Moving all discs by whole cells of a mesh, (columns, rows), changes no force.
///
/// # Errors
/// A [`Violation`] with the discs whose forces changed.
pub fn translation_by_cells(
    kernel: impl ForceKernel,
    discs: &Discs,
    grid: Grid,
    (columns, rows): (u32, u32),
    tolerance: Tolerance,
) -> Result<(), Violation> {
    translation(kernel, discs, (cells(columns, grid), cells(rows, grid)), tolerance)
}

/// The length of a number of mesh cells, wrapped, unit L·2⁻³².
pub(super) fn cells(number: u32, grid: Grid) -> u32 {
    number.wrapping_shl(32 - grid.exponent())
}

/// Turning the box by one, two and three right angles turns the forces.
///
/// # Errors
/// A [`Violation`] with the discs whose forces did not turn.
pub fn quarter_turns(kernel: impl ForceKernel, discs: &Discs, tolerance: Tolerance) -> Result<(), Violation> {
    transformed(Invariant::QuarterTurns, &QUARTER_TURNS, kernel, discs, tolerance)
}

/// Reflecting the box in both axes and both diagonals reflects the forces.
///
/// # Errors
/// A [`Violation`] with the discs whose forces were not reflected.
pub fn reflections(kernel: impl ForceKernel, discs: &Discs, tolerance: Tolerance) -> Result<(), Violation> {
    transformed(Invariant::Reflections, &REFLECTIONS, kernel, discs, tolerance)
}

/// A symmetry of the square: first x and y are exchanged, then signs changed.
struct Symmetry {
    exchange: bool,
    negate: [bool; 2],
}

const QUARTER_TURNS: [Symmetry; 3] = [
    Symmetry { exchange: true, negate: [true, false] },
    Symmetry { exchange: false, negate: [true, true] },
    Symmetry { exchange: true, negate: [false, true] },
];

const REFLECTIONS: [Symmetry; 4] = [
    Symmetry { exchange: false, negate: [true, false] },
    Symmetry { exchange: false, negate: [false, true] },
    Symmetry { exchange: true, negate: [false, false] },
    Symmetry { exchange: true, negate: [true, true] },
];

impl Symmetry {
    fn of<T: Copy>(&self, [x, y]: [T; 2], negative: impl Fn(T) -> T) -> [T; 2] {
        let [x, y] = if self.exchange { [y, x] } else { [x, y] };
        let [negate_x, negate_y] = self.negate;
        [if negate_x { negative(x) } else { x }, if negate_y { negative(y) } else { y }]
    }

    fn of_position(&self, position: &Position) -> Position {
        let negative = |fraction: Fraction| Fraction::from_bits(fraction.to_bits().wrapping_neg());
        let [x, y] = self.of([position.x, position.y], negative);
        Position { x, y }
    }
}

fn transformed(
    invariant: Invariant,
    symmetries: &[Symmetry],
    mut kernel: impl ForceKernel,
    discs: &Discs,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let forces = asked(&mut kernel, discs)?;
    symmetries.iter().try_for_each(|symmetry| {
        let expected: Vec<_> =
            forces.iter().map(|&force| symmetry.of(force, |component| -component)).collect();
        let found = asked(&mut kernel, &discs.moved(|position| symmetry.of_position(position)))?;
        compare(invariant, &found, &expected, tolerance)
    })
}

/// Giving the discs other ids gives the forces other ids and nothing more: the ids are reversed, moved on by one, and
/// sorted into even and odd ones.
///
/// # Errors
/// A [`Violation`] with the discs, by their new ids, whose forces changed.
pub fn permutation(
    mut kernel: impl ForceKernel,
    discs: &Discs,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let forces = asked(&mut kernel, discs)?;
    let ids = || 0..discs.len();
    let orders: [Vec<usize>; 3] = [
        ids().rev().collect(),
        ids().skip(1).chain(ids().take(1)).collect(),
        ids().step_by(2).chain(ids().skip(1).step_by(2)).collect(),
    ];
    orders.iter().try_for_each(|order| {
        let expected: Vec<_> = order.iter().filter_map(|&id| forces.get(id).copied()).collect();
        let found = asked(&mut kernel, &discs.selected(order))?;
        compare(Invariant::Permutation, &found, &expected, tolerance)
    })
}

/// Coordinates are those of a torus: adding whole boxes to those of any disc changes nothing.
///
/// Each disc is put into each of the nine boxes around the origin, while its neighbours by id are in other ones. Such
/// coordinates are rounded to binary64, so that even an exact kernel needs a tolerance of some 10⁻¹⁵·L times the
/// steepness of its forces.
///
/// # Errors
/// A [`Violation`] with the discs whose forces changed.
pub fn wrap(mut kernel: impl CoordinateKernel, discs: &Discs, tolerance: Tolerance) -> Result<(), Violation> {
    const BOXES: RangeInclusive<i32> = -1..=1;
    let side = discs.side();
    let coordinates = discs.coordinates();
    let boxes: Vec<_> = BOXES.flat_map(|column| BOXES.map(move |row| [column, row])).collect();
    let mut asked = |coordinates: &[[f64; 2]]| {
        let forces = kernel(coordinates, side);
        check_count(forces.len(), coordinates.len()).map(|()| forces)
    };
    let expected = asked(&coordinates)?;
    (0..boxes.len()).try_for_each(|first| {
        let elsewhere = coordinates.iter().zip(boxes.iter().cycle().skip(first));
        let elsewhere: Vec<_> = elsewhere
            .map(|(&[x, y], &[column, row])| [x + f64::from(column) * side, y + f64::from(row) * side])
            .collect();
        compare(Invariant::Wrap, &asked(&elsewhere)?, &expected, tolerance)
    })
}

/// A disc whose strength is negated feels the opposite force, while all others stay as they are.
///
/// This holds for a force that is proportional to the strength, so for the attraction without the repulsion.
///
/// # Errors
/// A [`Violation`] with the discs whose forces were not negated.
pub fn opposite_strength(
    mut kernel: impl ForceKernel,
    discs: &Discs,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let forces = asked(&mut kernel, discs)?;
    let mut found = Vec::with_capacity(forces.len());
    for id in 0..discs.len() {
        found.extend(asked(&mut kernel, &discs.with_opposite(id))?.get(id).copied());
    }
    let expected: Vec<_> = forces.iter().map(|&[x, y]| [-x, -y]).collect();
    compare(Invariant::OppositeStrength, &found, &expected, tolerance)
}

/// The force is the negative gradient of the energy, by central differences over ± `step` (R0, rounded to units of
/// position, at least one), each disc along each axis.
///
/// The difference is off by step²/6 times the third derivative of the energy, and by the rounding of the energy over
/// the step: the tolerance has to hold both.
///
/// # Errors
/// A [`Violation`] with the discs whose forces are not those of the energy.
pub fn energy_consistency(
    mut kernel: impl ForceKernel,
    mut energy: impl EnergyKernel,
    discs: &Discs,
    step: f64,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let forces = asked(&mut kernel, discs)?;
    let units = libm::rint(step / discs.side() * UNITS).clamp(1.0, f64::from(i32::MAX)) as i32;
    let length = discs.torus().length(units);
    let mut slope = |id: usize, (x, y): (i32, i32)| {
        let rise = energy(&discs.with_displaced(id, (x, y))) - energy(&discs.with_displaced(id, (-x, -y)));
        -rise / (2.0 * length)
    };
    let expected: Vec<_> =
        (0..discs.len()).map(|id| [slope(id, (units, 0)), slope(id, (0, units))]).collect();
    compare(Invariant::EnergyConsistency, &forces, &expected, tolerance)
}

/// The forces by a kernel, as many as there are discs.
fn asked(kernel: &mut impl ForceKernel, discs: &Discs) -> Result<Vec<[f64; 2]>, Violation> {
    let forces = kernel(discs);
    check_count(forces.len(), discs.len())?;
    Ok(forces)
}

/// Each force against what is expected of it; the scale is the largest expected one.
fn compare(
    invariant: Invariant,
    found: &[[f64; 2]],
    expected: &[[f64; 2]],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let scale = expected.iter().map(|&force| modulus(force)).fold(0.0, f64::max);
    let errors = found.iter().zip(expected).map(|(found, expected)| difference(*found, *expected));
    check_each(invariant, errors, tolerance.at(scale))
}

/// |force|
pub(super) fn modulus([x, y]: [f64; 2]) -> f64 {
    libm::sqrt(x * x + y * y)
}

/// |first − second|
pub(super) fn difference(first: [f64; 2], second: [f64; 2]) -> f64 {
    modulus([first[0] - second[0], first[1] - second[1]])
}
