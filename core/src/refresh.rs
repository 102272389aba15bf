//! Mesh forces held over several steps.
//!
//! The force of the mesh changes little while the discs hardly move. With `mesh_refresh` = δ > 0 each disc's mesh force,
//! quantised, is held until some disc is δ or farther from where it was when the force was computed; then it is computed
//! anew for all. Pairs and external fields are computed in every step. What is held – force and reference position of every
//! disc – is part of the state: the canonical bytes have it ([`crate::digest`]), so that a restart goes on bit for bit.
//!
//! Distances are those of nearest images, compared as integers.
//!
//! ```
//! use meniscus_core::refresh::Refresh;
//! use meniscus_core::torus::Fraction;
//!
//! // Half an R0 in a box of 16.
//! let refresh = Refresh::new(0.5, 16.0);
//! let at = |bits| [Fraction::from_bits(bits)];
//! let (x, y) = (at(5), at(0));
//! let moved = |by: u32| refresh.is_due((&at(5_u32.wrapping_sub(by)), &y), (&x, &y));
//! assert!(!moved((1 << 27) - 1) && moved(1 << 27));
//! ```

use crate::torus::{Fraction, Position, UNITS, minimum_image};

/// When held forces are computed anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refresh {
    /// Unit L·2⁻³², at most 2³⁰; 0 if nothing is held.
    distance: u32,
}

impl Refresh {
    /// Nothing is held.
    pub const NEVER: Self = Self { distance: 0 };

    /// Forces are held until a disc is `distance` (R0, below L/4) away, rounded up to a unit; 0 if nothing is held.
    #[must_use]
    pub fn new(distance: f64, side: f64) -> Self {
        Self { distance: libm::ceil(distance / side * UNITS) as u32 }
    }

    /// Whether forces are held at all.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.distance > 0
    }

    /// Whether one of the discs at (`x`, `y`) is so far from its reference that the forces must be computed anew.
    #[must_use]
    pub fn is_due(&self, reference: (&[Fraction], &[Fraction]), (x, y): (&[Fraction], &[Fraction])) -> bool {
        let along = |to: Fraction, from: Fraction| u64::from(minimum_image(to, from).unsigned_abs());
        let squares = reference.0.iter().zip(reference.1).zip(x.iter().zip(y)).map(|(from, to)| {
            let (x, y) = (along(*to.0, *from.0), along(*to.1, *from.1));
            x * x + y * y
        });
        // A disc that was not due is less than L/4 from its reference, and a step moves it by less than L/2 along an axis. So it
        // is less than 3L/4 away, and more than L/4 from all other images of the reference: none comes back unseen.
        squares.max().unwrap_or(0) >= u64::from(self.distance) * u64::from(self.distance)
    }
}

/// What is held of one disc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HeldForce {
    /// Where the disc was when the force was computed.
    pub reference: Position,
    /// The force of the mesh there, unit 2⁻²⁴ kBT/R0; its modulus at most [`largest_mesh_force`].
    pub force: (i64, i64),
}

impl HeldForce {
    /// Length of the canonical bytes of one.
    pub const LENGTH: usize = 24;

    /// Canonical bytes: reference x and y, force along x and y, little-endian.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let position = [self.reference.x, self.reference.y].map(|at| at.to_bits().to_le_bytes());
        let force = [self.force.0, self.force.1].map(i64::to_le_bytes);
        let all = position.as_flattened().iter().chain(force.as_flattened());
        for (byte, &value) in bytes.iter_mut().zip(all) {
            *byte = value;
        }
        bytes
    }

    /// What these canonical bytes hold.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; Self::LENGTH]) -> Self {
        let number = |begin: usize, length: usize| {
            let little_endian = bytes.iter().skip(begin).take(length).rev();
            little_endian.fold(0_u64, |number, &byte| number << 8 | u64::from(byte))
        };
        Self {
            reference: Position::from_bits(number(0, 4) as u32, number(4, 4) as u32),
            force: (number(8, 8) as i64, number(16, 8) as i64),
        }
    }

    /// Whether the mesh of a run of `count` discs can exert the force.
    #[must_use]
    pub fn is_possible(&self, count: usize) -> bool {
        let most = largest_mesh_force(count);
        self.force.0.unsigned_abs() <= most && self.force.1.unsigned_abs() <= most
    }
}

/// What is held of all discs, each where it is stored; empty if nothing is.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeldForces<'a> {
    /// x when the forces were computed.
    pub reference_x: &'a [Fraction],
    /// y likewise.
    pub reference_y: &'a [Fraction],
    /// Force along x, unit 2⁻²⁴ kBT/R0.
    pub force_x: &'a [i64],
    /// Force along y.
    pub force_y: &'a [i64],
}

impl HeldForces<'_> {
    /// Whether nothing is held.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.force_x.is_empty()
    }

    /// What is held of the disc stored in `slot`.
    #[must_use]
    pub fn at(&self, slot: usize) -> Option<HeldForce> {
        let reference = Position { x: *self.reference_x.get(slot)?, y: *self.reference_y.get(slot)? };
        Some(HeldForce { reference, force: (*self.force_x.get(slot)?, *self.force_y.get(slot)?) })
    }
}

/// The bound of a component of the mesh force in a run of `count` discs, unit 2⁻²⁴ kBT/R0: 6 N V0/h for the largest V0 and
/// the smallest h, see [`crate::units`].
#[must_use]
pub const fn largest_mesh_force(count: usize) -> u64 {
    const OF_ONE_DISC: u64 = 6 * 1000 * 8;
    (count as u64).saturating_mul(OF_ONE_DISC << 24)
}
