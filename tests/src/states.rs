//! Deterministic states: where discs are at the start of a test.
//!
//! Everything follows from a seed by [`RandomNumbers`]. Positions are fixed-point fractions of the box, as the core
//! holds them; lengths are in R0.

use crate::reference::RandomNumbers;
use meniscus_core::torus::{Position, Torus, TorusError, minimum_image};

/// `count` positions, every bit of both coordinates random.
pub fn scattered(seed: u64, count: usize) -> Vec<Position> {
    let mut random = RandomNumbers::new(seed);
    let mut position = || {
        let bits = random.bits();
        Position::from_bits((bits >> 32) as u32, bits as u32)
    };
    (0..count).map(|_| position()).collect()
}

/// `count` positions scattered over a square patch of `width` (fraction of the box) at the origin, which lies across
/// the borders: a crowd with many overlaps.
pub fn crowded(seed: u64, count: usize, width: f64) -> Vec<Position> {
    let shrink = |bits: u32| (f64::from(bits as i32) * width) as i32 as u32;
    let shrunk = |p: &Position| Position::from_bits(shrink(p.x.to_bits()), shrink(p.y.to_bits()));
    scattered(seed, count).iter().map(shrunk).collect()
}

/// Up to `count` random positions in a box of `side`, no two nearer than `distance`; fewer if they do not fit.
pub fn separated(seed: u64, count: usize, side: f64, distance: f64) -> Vec<Position> {
    let mut taken: Vec<Position> = Vec::with_capacity(count);
    for candidate in scattered(seed, 200 * count) {
        if taken.len() == count {
            break;
        }
        if taken.iter().all(|&other| separation(candidate, other, side) >= distance) {
            taken.push(candidate);
        }
    }
    taken
}

/// A square lattice of `rows` × `rows` positions, the first at the origin.
pub fn lattice(rows: u32) -> Vec<Position> {
    let at = |index: u32| ((u64::from(index) << 32) / u64::from(rows)) as u32;
    (0..rows).flat_map(|row| (0..rows).map(move |column| Position::from_bits(at(column), at(row)))).collect()
}

/// The position nearest to (`x`, `y`) in R0.
///
/// # Errors
/// A [`TorusError`] if the side is none or the coordinates are outside the box.
pub fn at(side: f64, x: f64, y: f64) -> Result<Position, TorusError> {
    let torus = Torus::new(side)?;
    Ok(Position { x: torus.fraction(x)?, y: torus.fraction(y)? })
}

/// Distance of the nearest images of two positions in a box of `side`.
pub fn separation(first: Position, second: Position, side: f64) -> f64 {
    let unit = side / 4_294_967_296.0;
    let x = f64::from(minimum_image(first.x, second.x)) * unit;
    let y = f64::from(minimum_image(first.y, second.y)) * unit;
    (x * x + y * y).sqrt()
}

/// The positions with the ids 0, 1, 2 …
pub fn with_ids(positions: &[Position]) -> Vec<(u32, Position)> {
    (0..).zip(positions.iter().copied()).collect()
}

/// The same items in a random order (Fisher and Yates 1938).
pub fn shuffled<T: Clone>(seed: u64, items: &[T]) -> Vec<T> {
    let mut random = RandomNumbers::new(seed);
    let mut items = items.to_vec();
    for last in (1..items.len()).rev() {
        items.swap(last, (random.uniform() * (last + 1) as f64) as usize);
    }
    items
}

/// Both coordinates of every position, as the stages take them.
pub fn coordinates(
    positions: &[Position],
) -> (Vec<meniscus_core::torus::Fraction>, Vec<meniscus_core::torus::Fraction>) {
    positions.iter().map(|position| (position.x, position.y)).unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separated_discs_keep_their_distance() {
        let discs = separated(1, 50, 40.0, 2.5);
        assert_eq!(discs.len(), 50);
        for (index, &disc) in discs.iter().enumerate() {
            assert!(discs[..index].iter().all(|&other| separation(disc, other, 40.0) >= 2.5));
        }
    }

    #[test]
    fn shuffling_loses_nothing() {
        let items: Vec<u32> = (0..100).collect();
        let mut mixed = shuffled(5, &items);
        assert_ne!(mixed, items);
        mixed.sort_unstable();
        assert_eq!(mixed, items);
    }

    #[test]
    fn a_crowd_stays_within_its_patch() {
        let reach = (0.01 * 2_147_483_648.0) as u32;
        for disc in crowded(1, 100, 0.01) {
            let bits = [disc.x.to_bits() as i32, disc.y.to_bits() as i32];
            assert!(bits.iter().all(|bits| bits.unsigned_abs() <= reach));
        }
    }

    #[test]
    fn a_lattice_has_equal_gaps() {
        let discs = lattice(4);
        assert_eq!(discs.len(), 16);
        assert_eq!(discs[6], Position::from_bits(2 << 30, 1 << 30));
    }
}
