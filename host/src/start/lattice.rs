//! Discs on a lattice.

use super::StartError;
use meniscus_core::torus::Position;

/// The first `count` sites of the smallest square lattice of m × m sites that has as many, m = ⌈√count⌉.
///
/// Sites are numbered row by row from the lower left, along +x. The first is half a spacing L/m from
/// either border. The lattice is exactly regular when m is a power of two, and else to half a unit of
/// position. The box does not matter: positions are fractions of it. Discs may overlap.
///
/// # Errors
/// [`StartError::TooMany`] beyond 2³² − 1 discs.
///
/// ```
/// let positions = meniscus::start::square_lattice(4).unwrap();
/// let quarters: Vec<f64> = positions.iter().map(|position| position.x.to_num()).collect();
/// assert_eq!(quarters, [0.25, 0.75, 0.25, 0.75]);
/// ```
pub fn square_lattice(count: usize) -> Result<Vec<Position>, StartError> {
    let count = identified(count)?;
    let floor = count.isqrt();
    let sites = if floor * floor < count { floor + 1 } else { floor };
    let along = |site: u64| nearest_unit(2 * site + 1, 2 * sites);
    Ok((0..count).map(|id| Position::from_bits(along(id % sites), along(id / sites))).collect())
}

/// The first `count` sites of a periodic hexagonal lattice: m_y rows of m_x sites, odd rows shifted by
/// half a spacing.
///
/// m_x = ⌈√(count·√3/2)⌉, and m_y is the smallest even number with m_x·m_y ≥ count: rows must be even
/// in number to meet themselves across the border, and m_y/m_x comes near 2/√3, at which all six
/// neighbours are equally far. Sites are numbered row by row from the lower left, along +x. The lattice
/// is regular to half a unit of position. The box does not matter. Discs may overlap.
///
/// # Errors
/// [`StartError::TooMany`] beyond 2³² − 1 discs.
///
/// ```
/// use meniscus::observables::neighbours::closest_pair;
/// use meniscus_core::torus::Torus;
///
/// let torus = Torus::new(500.0).unwrap();
/// let hexagonal = meniscus::start::hexagonal_lattice(2500).unwrap();
/// let square = meniscus::start::square_lattice(2500).unwrap();
/// assert!(closest_pair(&torus, &hexagonal) > closest_pair(&torus, &square));
/// ```
pub fn hexagonal_lattice(count: usize) -> Result<Vec<Position>, StartError> {
    let count = identified(count)?;
    let columns = libm::ceil(libm::sqrt(count as f64 * (libm::sqrt(3.0) / 2.0))).max(1.0) as u64;
    let rows = 2 * count.div_ceil(2 * columns);
    Ok((0..count)
        .map(|id| {
            let (column, row) = (id % columns, id / columns);
            // A quarter of a spacing from the border in even rows, three quarters in odd ones.
            let x = nearest_unit(4 * column + 1 + 2 * (row % 2), 4 * columns);
            Position::from_bits(x, nearest_unit(2 * row + 1, 2 * rows))
        })
        .collect())
}

/// The number of discs, if all of them can have ids.
fn identified(count: usize) -> Result<u64, StartError> {
    let wanted = count as u64;
    if wanted > u64::from(u32::MAX) {
        return Err(StartError::TooMany { wanted: u128::from(wanted) });
    }
    Ok(wanted)
}

/// The unit of position L·2⁻³² nearest to the fraction `numerator`/`denominator` < 1 of the side.
fn nearest_unit(numerator: u64, denominator: u64) -> u32 {
    (((numerator << 32) + denominator / 2) / denominator) as u32
}
