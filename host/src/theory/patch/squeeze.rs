//! One implicit step of shells that are pulled by their attraction and held apart by their pressure.

use super::tridiagonal::{Row, solved};
use crate::theory::Pressure;
use core::f64::consts::PI;

/// Steps of Newton's method before a step is given up.
const MOST_ITERATIONS: usize = 60;

/// Change of a squared radius, of itself, below which it is found.
const CONVERGED: f64 = 1e-12;

/// The share of the room that is left to a shell which one step of Newton's method may take.
const CLOSER: f64 = 0.9;

/// Squared radii q (R0²) after an Euler step of `step` (R0²/D), q' + 4πτ·q·Δp(q')/m = q + τ·rate, with m = `discs` in each
/// shell and the `rates` of attraction (D). None if shells meet.
pub(super) fn squeezed(
    pressure: Pressure,
    squares: &[f64],
    rates: &[f64],
    discs: f64,
    step: f64,
) -> Option<Vec<f64>> {
    let pulled: Vec<f64> = squares.iter().zip(rates).map(|(square, rate)| square + step * rate).collect();
    if pressure == Pressure::None {
        return apart(pressure, &pulled, discs).then_some(pulled);
    }
    let weight = 4.0 * PI * step / discs;
    let least = least_gap(pressure, discs);
    let mut next = squares.to_vec();
    for _ in 0..MOST_ITERATIONS {
        let change = newton(pressure, squares, &pulled, &next, discs, weight);
        let gaps =
            |values: &[f64], shell: usize| values[shell] - if shell == 0 { 0.0 } else { values[shell - 1] };
        // The longest part of the change that leaves a part of each gap.
        let part = (0..next.len())
            .filter(|&shell| gaps(&change, shell) < 0.0)
            .map(|shell| CLOSER * (gaps(&next, shell) - least_of(least, shell)) / -gaps(&change, shell))
            .fold(1.0, f64::min);
        let mut largest = 0.0_f64;
        for (square, change) in next.iter_mut().zip(&change) {
            *square += part * change;
            largest = largest.max((change / *square).abs());
        }
        if !largest.is_finite() {
            return None;
        }
        if part == 1.0 && largest < CONVERGED {
            return apart(pressure, &next, discs).then_some(next);
        }
    }
    None
}

/// Whether all shells follow each other, at densities that the equation of state reaches.
pub(super) fn apart(pressure: Pressure, squares: &[f64], discs: f64) -> bool {
    let least = least_gap(pressure, discs);
    let mut before = 0.0;
    squares.iter().enumerate().all(|(shell, &square)| {
        let gap = square - before;
        before = square;
        gap > least_of(least, shell)
    })
}

/// The least difference of squared radii of neighbouring shells, R0².
fn least_gap(pressure: Pressure, discs: f64) -> f64 {
    discs / (PI * pressure.densest())
}

/// That between a shell and the one within; within the first there is but half of it.
fn least_of(least: f64, shell: usize) -> f64 {
    if shell == 0 { 0.5 * least } else { least }
}

/// What one step of Newton's method adds to `next`.
fn newton(
    pressure: Pressure,
    squares: &[f64],
    pulled: &[f64],
    next: &[f64],
    discs: f64,
    weight: f64,
) -> Vec<f64> {
    // p and −dp/dq' within a shell; nothing presses from beyond the last.
    let within = |shell: usize| {
        let Some(&square) = next.get(shell) else { return (0.0, 0.0) };
        let (gap, discs) = match shell.checked_sub(1) {
            None => (square, 0.5 * discs),
            Some(inner) => (square - next[inner], discs),
        };
        let density = discs / (PI * gap);
        (pressure.pressure(density), pressure.stiffness(density) * density / gap)
    };
    let mut inner = within(0);
    let row = |shell: usize| {
        let outer = within(shell + 1);
        let factor = weight * squares[shell];
        let row = Row {
            before: -factor * inner.1,
            own: 1.0 + factor * (inner.1 + outer.1),
            after: -factor * outer.1,
            right: pulled[shell] - next[shell] - factor * (outer.0 - inner.0),
        };
        inner = outer;
        row
    };
    solved((0..next.len()).map(row).collect())
}
