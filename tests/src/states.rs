//! Deterministic states: where discs are at the start of a test.
//!
//! Everything follows from a seed by [`RandomNumbers`]. Positions are fixed-point fractions of the box, as the core
//! holds them; lengths are in R0.

use crate::reference::RandomNumbers;
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::torus::{Position, Torus, TorusError, minimum_image};

/// The repulsion alone, in a box of 16 R0.
pub const REPULSION: Parameters = Parameters {
    side: 16.0,
    capillary_strength: 0.0,
    grid: 16,
    assignment: Assignment::CloudInCell,
    noise: Noise::None,
    ..Parameters::PAPER
};

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
///
/// Random sequential addition: each of the places tried is taken unless another within `distance` was. Cells as wide
/// as that make it fast for 10⁵ discs.
pub fn separated(seed: u64, count: usize, side: f64, distance: f64) -> Vec<Position> {
    let mut random = RandomNumbers::new(seed);
    let cells = (side / distance).clamp(1.0, 2048.0) as usize;
    let mut members: Vec<Vec<Position>> = vec![Vec::new(); cells * cells];
    let cell_of = |bits: u32| ((u64::from(bits) * cells as u64) >> 32) as usize;
    let mut taken: Vec<Position> = Vec::with_capacity(count);
    for _ in 0..200 * count {
        if taken.len() == count {
            break;
        }
        let bits = random.bits();
        let candidate = Position::from_bits((bits >> 32) as u32, bits as u32);
        let (column, row) = (cell_of(candidate.x.to_bits()), cell_of(candidate.y.to_bits()));
        // The cell itself, the one before and the one after; with fewer than three cells some are looked at twice.
        let beside = |cell: usize| [cell + cells - 1, cell, cell + 1].map(|other| other % cells);
        let nearby = |x: usize| beside(row).map(|y| &members[x * cells + y]);
        let free =
            |discs: &Vec<Position>| discs.iter().all(|&disc| separation(candidate, disc, side) >= distance);
        if beside(column).into_iter().flat_map(nearby).all(free) {
            members[column * cells + row].push(candidate);
            taken.push(candidate);
        }
    }
    taken
}

/// `count` positions of a dense round cluster at the middle of a box of `side`: those of a hexagonal lattice of this
/// `spacing` nearest to its centre, each moved by up to `disorder` (R0) along either axis, the whole turned by an
/// angle of its own, so that neither the mesh nor a symmetry sees a crystal.
///
/// # Panics
/// If the cluster does not fit into the box.
pub fn hexagonal_cluster(seed: u64, count: usize, side: f64, spacing: f64, disorder: f64) -> Vec<Position> {
    let mut random = RandomNumbers::new(seed);
    // The lattice holds 2/√3 positions in a square of its spacing; two rows more for the border.
    let rows = libm::ceil((count as f64).sqrt()) as i32;
    let height = 0.75_f64.sqrt();
    let mut places: Vec<[f64; 2]> = (-rows..=rows)
        .flat_map(|m| (-rows..=rows).map(move |l| (l, m)))
        .map(|(l, m)| {
            [spacing * (f64::from(l) + 0.5 * f64::from(m.rem_euclid(2))), spacing * height * f64::from(m)]
        })
        .collect();
    places.sort_by(|a, b| libm::hypot(a[0], a[1]).total_cmp(&libm::hypot(b[0], b[1])));
    places.truncate(count);
    let (sine, cosine) = libm::sincos(core::f64::consts::TAU * random.uniform());
    let mut placed = |[x, y]: [f64; 2]| {
        let x = x + disorder * (2.0 * random.uniform() - 1.0);
        let y = y + disorder * (2.0 * random.uniform() - 1.0);
        let [x, y] = [cosine * x - sine * y, sine * x + cosine * y];
        let fraction = |coordinate: f64| {
            assert!(coordinate.abs() < 0.5 * side, "the cluster is wider than the box");
            ((coordinate / side + 0.5) * 4_294_967_296.0) as u32
        };
        Position::from_bits(fraction(x), fraction(y))
    };
    places.into_iter().map(&mut placed).collect()
}

/// The coordinates (R0) of positions in a box of `side`, exactly as the core holds them: 32 bits times L·2⁻³².
pub fn in_radii(positions: &[Position], side: f64) -> Vec<[f64; 2]> {
    let unit = side / 4_294_967_296.0;
    positions.iter().map(|p| [p.x, p.y].map(|coordinate| f64::from(coordinate.to_bits()) * unit)).collect()
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
    fn separated_discs_are_those_that_all_pairs_allow() {
        // The same sequence without cells, in boxes of one cell, a few and many.
        for (side, count) in [(3.0, 2), (7.0, 6), (60.0, 300)] {
            let mut taken: Vec<Position> = Vec::new();
            for candidate in scattered(3, 200 * count) {
                if taken.len() < count && taken.iter().all(|&other| separation(candidate, other, side) >= 2.0)
                {
                    taken.push(candidate);
                }
            }
            assert_eq!(separated(3, count, side, 2.0), taken);
        }
    }

    #[test]
    fn a_cluster_is_round_dense_and_without_overlap() {
        let (side, spacing, disorder) = (500.0, 2.1, 0.04);
        let discs = hexagonal_cluster(1, 1000, side, spacing, disorder);
        let places = in_radii(&discs, side);
        // Area of a lattice place is √3/2 spacing²; a row more or less at the border.
        let radius = spacing * (1000.0 * 0.75_f64.sqrt() / core::f64::consts::PI).sqrt();
        assert!(places.iter().all(|p| libm::hypot(p[0] - 250.0, p[1] - 250.0) < radius + spacing));
        let (mut nearest, mut touching) = (f64::INFINITY, 0);
        for (index, &disc) in discs.iter().enumerate() {
            for &other in &discs[..index] {
                let distance = separation(disc, other, side);
                nearest = nearest.min(distance);
                touching += usize::from(distance < 1.2 * spacing);
            }
        }
        // Displacements of up to √2·disorder towards each other; six neighbours each but at the border.
        assert!(nearest > spacing - 2.9 * disorder && nearest < spacing - 0.5 * disorder, "{nearest}");
        assert!(touching > 2700 && touching < 3000, "{touching}");
    }

    #[test]
    fn coordinates_in_radii_are_those_of_the_bits() {
        assert_eq!(in_radii(&[Position::from_bits(1 << 31, 3 << 30)], 10.0), [[5.0, 7.5]]);
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
