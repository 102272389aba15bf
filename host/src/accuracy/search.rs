//! The schemes there are to choose from, and the best of those on one mesh.

use super::mesh_error::MeshError;
use super::near_error::NearError;
use super::{Scheme, System, reference_force, rounding_error};
use crate::accuracy::Given;
use meniscus_core::grid::RANGE;
use meniscus_core::parameters::{
    Assignment, LARGEST_SPLITTING_OF_SPACING, SMALLEST_CUTOFF, SPACING_RANGE, SPLITTING_RANGE,
};

/// Candidates for splitting and cut-off are this much apart, 2^(1/32), about 2 %.
const STEPS_PER_OCTAVE: f64 = 32.0;
/// More octaves than there are between any valid splittings or cut-offs.
const MOST_OCTAVES: f64 = 32.0;
/// The largest cut-off chosen, of the side: below half of it.
const LARGEST_CUTOFF_OF_SIDE: f64 = 0.499;
/// Significant decimal digits of a splitting or cut-off, so that it prints short.
const DIGITS: i32 = 4;

/// `value` rounded down to so many significant decimal digits, as the number that is written with them.
pub(crate) fn rounded_down(value: f64, digits: i32) -> f64 {
    rounded(value, digits, libm::floor)
}

/// `value` rounded up to so many significant decimal digits, as the number that is written with them.
pub(super) fn rounded_up(value: f64, digits: i32) -> f64 {
    rounded(value, digits, libm::ceil)
}

fn rounded(value: f64, digits: i32, rounding: fn(f64) -> f64) -> f64 {
    if !value.is_finite() || value <= 0.0 {
        return value;
    }
    let exponent = digits - 1 - libm::floor(libm::log10(value)) as i32;
    // Powers of ten up to 10²² are exact, so that what is multiplied and divided with is.
    let scale = libm::pow(10.0, f64::from(exponent.abs()));
    if exponent >= 0 { rounding(value * scale) / scale } else { rounding(value / scale) * scale }
}

/// Grids a choice may take, from small to large; never empty.
pub(super) fn grids(system: &System, given: &Given) -> Vec<usize> {
    if let Some(grid) = given.grid {
        return vec![grid];
    }
    let powers = || core::iter::successors(Some(RANGE.0), |grid| Some(2 * grid));
    let fits = |grid: &usize| {
        let spacing = system.side / *grid as f64;
        spacing >= SPACING_RANGE.0 && spacing <= SPACING_RANGE.1
    };
    let resolves = |grid: &usize| {
        given
            .splitting
            .is_none_or(|splitting| splitting * system.side / *grid as f64 <= LARGEST_SPLITTING_OF_SPACING)
    };
    let fitting: Vec<usize> = powers().take_while(|grid| *grid <= RANGE.1).filter(fits).collect();
    let resolving: Vec<usize> = fitting.iter().copied().filter(resolves).collect();
    if !resolving.is_empty() {
        return resolving;
    }
    // No mesh belongs to this splitting or side, which other checks refuse: the finest comes closest.
    vec![fitting.last().copied().unwrap_or(RANGE.1)]
}

/// Assignments a choice may take, by order.
pub(super) fn assignments(given: &Given) -> Vec<Assignment> {
    given.assignment.map_or_else(|| Assignment::ALL.to_vec(), |assignment| vec![assignment])
}

/// Splittings a choice may take on a mesh, from large to small; never empty.
pub(super) fn splittings(system: &System, given: &Given, grid: usize) -> Vec<f64> {
    if let Some(splitting) = given.splitting {
        return vec![splitting];
    }
    let largest = (LARGEST_SPLITTING_OF_SPACING * grid as f64 / system.side).min(SPLITTING_RANGE.1);
    let steps = steps(SPLITTING_RANGE.0, largest);
    let mut ladder: Vec<f64> = (0..=steps)
        .map(|step| rounded_down(largest * libm::exp2(-(step as f64) / STEPS_PER_OCTAVE), DIGITS))
        .take_while(|splitting| *splitting >= SPLITTING_RANGE.0)
        .collect();
    if ladder.is_empty() {
        ladder.push(SPLITTING_RANGE.0);
    }
    ladder
}

/// Cut-offs a choice may take, from small to large; never empty.
pub(super) fn cutoffs(system: &System, given: &Given) -> Vec<f64> {
    if let Some(cutoff) = given.cutoff {
        return vec![cutoff];
    }
    let largest = LARGEST_CUTOFF_OF_SIDE * system.side;
    let steps = steps(SMALLEST_CUTOFF, largest);
    let mut ladder: Vec<f64> = (0..=steps)
        .map(|step| rounded_up(SMALLEST_CUTOFF * libm::exp2(step as f64 / STEPS_PER_OCTAVE), DIGITS))
        .take_while(|cutoff| *cutoff <= largest)
        .collect();
    if ladder.is_empty() {
        ladder.push(SMALLEST_CUTOFF);
    }
    ladder
}

/// Steps of a ladder from `least` to `most`.
fn steps(least: f64, most: f64) -> usize {
    (libm::log2(most / least).clamp(0.0, MOST_OCTAVES) * STEPS_PER_OCTAVE) as usize
}

/// One mesh and assignment with its splittings, and the mesh errors found so far.
pub(super) struct Candidates<'a, 'b> {
    system: &'a System,
    near: &'b mut NearError<'a>,
    reference: f64,
    grid: usize,
    assignment: Assignment,
    mesh: MeshError,
    splittings: &'b [f64],
    mesh_errors: Vec<Option<f64>>,
}

impl<'a, 'b> Candidates<'a, 'b> {
    /// `splittings` from large to small, at least one.
    pub(super) fn new(
        system: &'a System,
        near: &'b mut NearError<'a>,
        grid: usize,
        assignment: Assignment,
        splittings: &'b [f64],
    ) -> Self {
        Self {
            system,
            near,
            reference: reference_force(system),
            grid,
            assignment,
            mesh: MeshError::new(grid, assignment),
            splittings,
            mesh_errors: vec![None; splittings.len()],
        }
    }

    /// The scheme of least cut-off, out of `cutoffs` from small to large, with an error of at most `target`
    /// of the reference force.
    ///
    /// The rounding error grows with the cut-off, so what it leaves to mesh and cut-off is found from below.
    pub(super) fn within(&mut self, target: f64, cutoffs: &[f64]) -> Option<Scheme> {
        let target = target * self.reference;
        let mut index = 0;
        loop {
            let rounding = rounding_error(self.system, self.reference, *cutoffs.get(index)?);
            let left = target * target - rounding * rounding;
            if left.is_nan() || left < 0.0 || self.split(*cutoffs.last()?).1 > left {
                return None;
            }
            let ahead = first(index, cutoffs.len(), |i| self.split(cutoffs[i]).1 <= left);
            if ahead == index {
                return Some(self.scheme(cutoffs[index]));
            }
            index = ahead;
        }
    }

    /// The scheme of least error, out of `cutoffs` from small to large, at least one, and that error, kBT/R0.
    ///
    /// With the cut-off the error first falls steeply, then rises slowly as more pairs are rounded.
    pub(super) fn least(&mut self, cutoffs: &[f64]) -> (Scheme, f64) {
        let turn = first(0, cutoffs.len() - 1, |index| {
            self.squared(cutoffs[index + 1]) >= self.squared(cutoffs[index])
        });
        (self.scheme(cutoffs[turn]), self.squared(cutoffs[turn]).sqrt())
    }

    /// The squared error of all sources, (kBT/R0)².
    fn squared(&mut self, cutoff: f64) -> f64 {
        let rounding = rounding_error(self.system, self.reference, cutoff);
        self.split(cutoff).1 + rounding * rounding
    }

    fn scheme(&mut self, cutoff: f64) -> Scheme {
        let splitting = self.splittings[self.split(cutoff).0];
        Scheme { grid: self.grid, assignment: self.assignment, splitting, cutoff }
    }

    /// The splitting that suits a cut-off best, as index, and the squared error of mesh and cut-off, (kBT/R0)².
    ///
    /// The mesh's error falls with the splitting, the cut-off's rises: the sum is least next to where they cross.
    fn split(&mut self, cutoff: f64) -> (usize, f64) {
        let splittings = self.splittings;
        let crossing = first(0, splittings.len(), |index| {
            self.mesh_error(index) <= self.near.evaluate(splittings[index], cutoff)
        });
        let below = crossing.min(splittings.len() - 1);
        let above = crossing.saturating_sub(1);
        let (after, before) = (self.with_splitting(below, cutoff), self.with_splitting(above, cutoff));
        if before < after { (above, before) } else { (below, after) }
    }

    /// The squared error of mesh and cut-off for one splitting, (kBT/R0)².
    fn with_splitting(&mut self, index: usize, cutoff: f64) -> f64 {
        let (mesh, near) = (self.mesh_error(index), self.near.evaluate(self.splittings[index], cutoff));
        mesh * mesh + near * near
    }

    fn mesh_error(&mut self, index: usize) -> f64 {
        if let Some(error) = self.mesh_errors[index] {
            return error;
        }
        let spacing = self.system.side / self.grid as f64;
        let error = self.mesh.evaluate(self.system, spacing, self.splittings[index]);
        self.mesh_errors[index] = Some(error);
        error
    }
}

/// The first index from `start` up to `end` for which `holds`, which then holds for all after it; `end` if none.
fn first(start: usize, end: usize, mut holds: impl FnMut(usize) -> bool) -> usize {
    let (mut low, mut high) = (start, end);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_numbers_print_short() {
        assert_eq!(rounded_down(0.123_456, 4), 0.1234);
        assert_eq!(rounded_up(0.123_456, 4), 0.1235);
        assert_eq!(rounded_up(16.0, 4), 16.0);
        assert_eq!(rounded_up(123_456.0, 4), 123_500.0);
        assert_eq!(rounded_up(3.21e-6, 2), 3.3e-6);
        assert_eq!(rounded_down(0.0, 4), 0.0);
        assert!(rounded_down(f64::NAN, 4).is_nan());
    }

    #[test]
    fn the_first_is_found() {
        for answer in 0..=9 {
            assert_eq!(first(0, 9, |index| index >= answer), answer);
        }
    }
}
