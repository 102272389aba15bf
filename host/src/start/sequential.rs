//! Random sequential addition: candidates are tried one after the other, and one that overlaps no disc
//! placed before stays for good.

use super::StartError;
use crate::observables::neighbours::Neighbours;
use meniscus_core::torus::{Position, Torus};

/// Places tried per disc, on average over all discs, before a start is given up.
pub const ATTEMPTS_PER_DISC: u64 = 1000;

/// The fraction of a large area that random sequential addition of discs covers in the end.
pub const SATURATION: f64 = 0.547;

/// The fraction of an area that the densest packing of equal discs covers, π/√12.
pub const CLOSE_PACKING: f64 = 0.906_899_682_117_109;

/// The distance of the centres of two discs that touch, R0.
const CONTACT: f64 = 2.0;

/// The first `count` of the `candidates` that do not overlap those before, no two closer than 2 R0.
///
/// `area` (R0²) is that of the region in which the discs lie whole.
///
/// # Errors
/// [`StartError::BoxTooSmall`], or [`StartError::TooDense`] at once when no packing is that dense, and
/// else after [`ATTEMPTS_PER_DISC`] times `count` attempts.
pub(super) fn add_sequentially(
    torus: &Torus,
    count: usize,
    area: f64,
    mut candidates: impl Iterator<Item = Position>,
) -> Result<Vec<Position>, StartError> {
    if torus.side() < CONTACT {
        return Err(StartError::BoxTooSmall { side: torus.side() });
    }
    let coverage = count as f64 * core::f64::consts::PI / area;
    let too_dense = |placed, attempts| StartError::TooDense { wanted: count, placed, attempts, coverage };
    if coverage > CLOSE_PACKING {
        return Err(too_dense(0, 0));
    }
    let most = ATTEMPTS_PER_DISC.saturating_mul(count as u64);
    let mut discs = Neighbours::with_capacity(torus, count, CONTACT);
    let mut placed = 0;
    let mut attempts = 0;
    while placed < count {
        let Some(candidate) = candidates.next().filter(|_| attempts < most) else {
            return Err(too_dense(placed, attempts));
        };
        attempts += 1;
        if discs.near(candidate).next().is_none() {
            discs.insert(candidate);
            placed += 1;
        }
    }
    Ok(discs.into_positions())
}
