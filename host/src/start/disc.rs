//! Discs at random in a circular patch (Fig. 14).

use super::StartError;
use super::sequential::add_sequentially;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::torus::{Position, Torus};

/// 2³¹: half the units of position along a side, and the range of a signed 32-bit number either way.
const HALF: i64 = 1 << 31;

/// `count` discs placed one after the other at random, centres within `radius` (R0) of the centre of
/// the box, no two closer than 2 R0.
///
/// Places are uniform over the area: two signed 32-bit numbers are a point of a square, and the points
/// outside its inscribed circle are passed over.
///
/// # Errors
/// [`StartError::PatchRadius`] unless 0 < `radius` ≤ L/2; [`StartError::BoxTooSmall`] for a side below
/// 2 R0; [`StartError::TooDense`] as for [`random`](super::random), the area being that of a circle of
/// `radius` + R0.
///
/// ```
/// use meniscus_core::torus::Torus;
///
/// let torus = Torus::new(800.0).unwrap();
/// let positions = meniscus::start::disc(&torus, 451, 183.0, 1).unwrap();
/// let from_centre = |position: &meniscus_core::torus::Position| {
///     libm::hypot(torus.coordinate(position.x) - 400.0, torus.coordinate(position.y) - 400.0)
/// };
/// assert!(positions.iter().all(|position| from_centre(position) <= 183.0));
/// ```
pub fn disc(torus: &Torus, count: usize, radius: f64, seed: u64) -> Result<Vec<Position>, StartError> {
    let largest = torus.side() / 2.0;
    if !(radius > 0.0 && radius <= largest) {
        return Err(StartError::PatchRadius { radius, largest });
    }
    let radius_units = libm::floor(radius / largest * HALF as f64) as i64;
    let key = StepKey::new(seed, Purpose::Start, 0);
    let candidates = (0..).filter_map(|draw| in_circle(key.bits(draw), radius_units));
    let area = core::f64::consts::PI * (radius + 1.0) * (radius + 1.0);
    add_sequentially(torus, count, area, candidates)
}

/// The point that `bits` stand for, if it is in a circle of `radius_units` (L·2⁻³²) about the centre.
fn in_circle(bits: u64, radius_units: i64) -> Option<Position> {
    let along_x = i64::from((bits >> 32) as i32);
    let along_y = i64::from(bits as i32);
    // At most 2⁶³, which only unsigned numbers hold.
    let square = (along_x * along_x) as u64 + (along_y * along_y) as u64;
    if square > 1 << 62 {
        return None;
    }
    // Division rounds towards the centre and so never leaves the circle.
    let coordinate = |along: i64| (HALF + along * radius_units / HALF) as u32;
    Some(Position::from_bits(coordinate(along_x), coordinate(along_y)))
}
