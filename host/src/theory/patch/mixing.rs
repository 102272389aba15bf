//! How discs that are followed mix with the others.

use super::tridiagonal::{Row, solved};
use crate::theory::Pressure;
use core::f64::consts::PI;

/// The `shares` of shells of `discs` discs with the squared radii `squares` (R0²) after `step` (R0²/D), implicitly:
/// m ∂c/∂t = Δ[(2πR)²ρ·ρD_s Δc/m]. With discs as coordinate, what flows over a circle of radius R is 2πR·ρD_s ∂c/∂R =
/// (2πR)²ρ·ρD_s ∂c/∂(discs), and ρD_s = ρ²/p.
pub(super) fn mix(pressure: Pressure, squares: &[f64], discs: f64, step: f64, shares: &mut Vec<f64>) {
    if pressure == Pressure::None {
        return;
    }
    // Between a shell and the next.
    let exchange = |shell: usize| {
        let (Some(inner), Some(outer)) = (squares.get(shell), squares.get(shell + 1)) else { return 0.0 };
        let density = discs / (PI * (outer - inner));
        let mobile = density * density / pressure.pressure(density);
        2.0 * PI * PI * (inner + outer) * density * mobile * step / (discs * discs)
    };
    let mut inner = 0.0;
    let row = |shell: usize| {
        let outer = exchange(shell);
        let row = Row { before: -inner, own: 1.0 + inner + outer, after: -outer, right: shares[shell] };
        inner = outer;
        row
    };
    *shares = solved((0..shares.len()).map(row).collect());
}
