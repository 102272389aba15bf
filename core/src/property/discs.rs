//! Discs in a box, as force kernels are given them.
//!
//! ```
//! use meniscus_core::property::Discs;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(64.0).unwrap();
//! let discs = Discs::from_coordinates(torus, &[[1.0, 2.0], [-1.0, 65.0]]);
//! assert_eq!(discs.coordinates(), [[1.0, 2.0], [63.0, 1.0]]);
//! assert_eq!(discs.with_strengths(&[1 << 20, -(1 << 19)]).strength(1), -0.5);
//! ```

use crate::assignment::DISC;
use crate::torus::{Position, Torus};
use std::vec::Vec;

/// Discs in a square periodic box: where they are and how strongly each one attracts. A disc's index is its id.
#[derive(Clone, Debug, PartialEq)]
pub struct Discs {
    torus: Torus,
    positions: Vec<Position>,
    /// One for each position.
    strengths: Vec<i32>,
}

impl Discs {
    /// Discs of strength 1 at `positions`.
    #[must_use]
    pub fn new(torus: Torus, positions: Vec<Position>) -> Self {
        let strengths = std::vec![DISC as i32; positions.len()];
        Self { torus, positions, strengths }
    }

    /// Discs of strength 1 at the positions nearest to `coordinates` (R0, any finite numbers, wrapped into the box).
    #[must_use]
    pub fn from_coordinates(torus: Torus, coordinates: &[[f64; 2]]) -> Self {
        let position =
            |&[x, y]: &[f64; 2]| Position { x: torus.wrapped_fraction(x), y: torus.wrapped_fraction(y) };
        Self::new(torus, coordinates.iter().map(position).collect())
    }

    /// The same discs with `strengths` (unit 2⁻²⁰), which are given out again and again if there are fewer of them
    /// than discs; none changes nothing.
    #[must_use]
    pub fn with_strengths(mut self, strengths: &[i32]) -> Self {
        for (own, &strength) in self.strengths.iter_mut().zip(strengths.iter().cycle()) {
            *own = strength;
        }
        self
    }

    /// The box.
    #[must_use]
    pub fn torus(&self) -> Torus {
        self.torus
    }

    /// Side L of the box, R0.
    #[must_use]
    pub fn side(&self) -> f64 {
        self.torus.side()
    }

    /// Number of discs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no disc.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The positions, by id.
    #[must_use]
    pub fn positions(&self) -> &[Position] {
        &self.positions
    }

    /// The positions in R0, in [0, L), by id.
    #[must_use]
    pub fn coordinates(&self) -> Vec<[f64; 2]> {
        let coordinate = |p: &Position| [self.torus.coordinate(p.x), self.torus.coordinate(p.y)];
        self.positions.iter().map(coordinate).collect()
    }

    /// The capillary strengths f, unit 2⁻²⁰, by id: a pair attracts with V0·f·f′, and 1 is the strength of a disc where
    /// all are alike.
    #[must_use]
    pub fn strengths(&self) -> &[i32] {
        &self.strengths
    }

    /// The capillary strength of a disc; 0 if there is none of this id.
    #[must_use]
    pub fn strength(&self, id: usize) -> f64 {
        self.strengths.get(id).map_or(0.0, |&strength| f64::from(strength) / f64::from(DISC))
    }

    /// The same strengths at other positions.
    pub(super) fn moved(&self, position: impl FnMut(&Position) -> Position) -> Self {
        Self { positions: self.positions.iter().map(position).collect(), ..self.clone() }
    }

    /// The discs of the ids in `order`, with new ids in that order.
    pub(super) fn selected(&self, order: &[usize]) -> Self {
        let of = |&id: &usize| Some((*self.positions.get(id)?, *self.strengths.get(id)?));
        let (positions, strengths) = order.iter().filter_map(of).unzip();
        Self { torus: self.torus, positions, strengths }
    }

    /// With the disc `id` moved by (`x`, `y`), unit L·2⁻³².
    pub(super) fn with_displaced(&self, id: usize, (x, y): (i32, i32)) -> Self {
        let mut displaced = self.clone();
        if let Some(position) = displaced.positions.get_mut(id) {
            *position = shifted(position, (x as u32, y as u32));
        }
        displaced
    }

    /// With the strength of the disc `id` negated.
    pub(super) fn with_opposite(&self, id: usize) -> Self {
        let mut opposite = self.clone();
        if let Some(strength) = opposite.strengths.get_mut(id) {
            *strength = strength.saturating_neg();
        }
        opposite
    }
}

/// The position moved by (`x`, `y`), unit L·2⁻³², around the torus.
pub(super) fn shifted(position: &Position, (x, y): (u32, u32)) -> Position {
    Position::from_bits(position.x.to_bits().wrapping_add(x), position.y.to_bits().wrapping_add(y))
}
