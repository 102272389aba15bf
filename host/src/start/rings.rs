//! Discs on concentric rings (Figs. 12, 13).

use super::StartError;
use meniscus_core::torus::{Position, Torus, UNITS};

/// The middle of the box along an axis, unit L·2⁻³².
const CENTRE: u32 = 1 << 31;

/// One disc at the centre of the box and `per_ring`·n discs on each ring n = 1 … `rings`, of radius
/// `spacing`·n (R0).
///
/// A ring begins on the +x side of the centre and goes round counter-clockwise in equal angles. Ids go
/// from the centre outwards, along each ring. Discs may overlap.
///
/// # Errors
/// [`StartError::RingSpacing`] unless `spacing` > 0; [`StartError::RingsOutside`] when the outermost ring
/// does not have a radius below L/2; [`StartError::TooMany`] beyond 2³² − 1 discs.
///
/// ```
/// use meniscus_core::torus::Torus;
///
/// // The patch of Figs. 12 and 13.
/// let torus = Torus::new(800.0).unwrap();
/// let positions = meniscus::start::rings(&torus, 9, 10, 19.29).unwrap();
/// assert_eq!(positions.len(), 451);
/// ```
pub fn rings(torus: &Torus, rings: u32, per_ring: u32, spacing: f64) -> Result<Vec<Position>, StartError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(StartError::RingSpacing { spacing });
    }
    let largest = torus.side() / 2.0;
    let radius = spacing * f64::from(rings);
    if radius >= largest {
        return Err(StartError::RingsOutside { radius, largest });
    }
    let wanted = 1 + u128::from(per_ring) * u128::from(rings) * (u128::from(rings) + 1) / 2;
    if wanted > u128::from(u32::MAX) {
        return Err(StartError::TooMany { wanted });
    }
    let mut positions = Vec::with_capacity(wanted as usize);
    positions.push(Position::from_bits(CENTRE, CENTRE));
    for ring in 1..=rings {
        let radius_units = spacing * f64::from(ring) / torus.side() * UNITS;
        let discs = per_ring * ring;
        positions.extend((0..discs).map(|disc| on_circle(radius_units, f64::from(disc) / f64::from(discs))));
    }
    Ok(positions)
}

/// The point `turns` (full turns from +x) round a circle of `radius_units` (L·2⁻³²) about the centre.
fn on_circle(radius_units: f64, turns: f64) -> Position {
    let angle = core::f64::consts::TAU * turns;
    let coordinate = |offset: f64| CENTRE.wrapping_add(libm::rint(offset) as i64 as u32);
    Position::from_bits(
        coordinate(radius_units * libm::cos(angle)),
        coordinate(radius_units * libm::sin(angle)),
    )
}
