//! External fields: a uniform force and a harmonic trap (optical tweezers).
//!
//! Both act on every disc alike, whatever its capillary strength. The force of a disc is quantised once, as
//! everything that is summed. The trap draws along the nearest image of its centre, with force −k·d along each axis,
//! d the minimum image of the distance along that axis; half a box away, where that image changes, the force jumps.
//!
//! ```
//! use meniscus_core::fields::{Fields, FieldForce};
//! use meniscus_core::torus::Fraction;
//! use meniscus_core::units::force_from_units;
//!
//! let fields = Fields { trap_stiffness: 2.0, trap_center: [32.0, 32.0], ..Fields::NONE };
//! let force = FieldForce::new(&fields, 64.0);
//! // 1 R0 to the right of the centre.
//! let (x, y) = force.at(Fraction::from_bits((1 << 31) + (1 << 26)), Fraction::from_bits(1 << 31));
//! assert_eq!((force_from_units(x), force_from_units(y)), (-2.0, 0.0));
//! ```

use crate::torus::{Fraction, Torus, UNITS, minimum_image};
use crate::units::{FORCE_UNITS, round_half_even};

/// Largest component of the force that an external field may exert anywhere, kBT/R0: far below what would reach the
/// bound of the total force, see [`crate::units`].
pub const LARGEST_FIELD_FORCE: f64 = 1e8;

/// External fields that act on every disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    /// Uniform force along x and y, kBT/R0.
    pub uniform_force: [f64; 2],
    /// Stiffness k of the trap, kBT/R0²; 0 for none.
    pub trap_stiffness: f64,
    /// Centre of the trap, R0; 0 to the side of the box. Not looked at without a trap.
    pub trap_center: [f64; 2],
}

impl Fields {
    /// No field.
    pub const NONE: Self = Self { uniform_force: [0.0; 2], trap_stiffness: 0.0, trap_center: [0.0; 2] };

    /// Whether the numbers are finite, k ≥ 0, the centre in the box of side `side` (R0) if there is a trap, and the
    /// largest force component at most [`LARGEST_FIELD_FORCE`].
    #[must_use]
    pub fn is_valid(&self, side: f64) -> bool {
        let trap = self.trap_stiffness;
        let inside = self.trap_center.iter().all(|&center| center >= 0.0 && center <= side);
        let largest = |uniform: f64| uniform.abs() + trap * 0.5 * side;
        trap >= 0.0
            && (inside || trap == 0.0)
            && self.uniform_force.iter().all(|&force| largest(force) <= LARGEST_FIELD_FORCE)
    }
}

impl Default for Fields {
    fn default() -> Self {
        Self::NONE
    }
}

/// External fields in a box of given side, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldForce {
    /// Unit 2⁻²⁴ kBT/R0.
    uniform: (i64, i64),
    /// Force per unit of separation, in units of 2⁻²⁴ kBT/R0 per L·2⁻³².
    stiffness: f32,
    center: (Fraction, Fraction),
}

impl FieldForce {
    /// `fields`, which are valid, in a box of side `side` (R0).
    #[must_use]
    pub fn new(fields: &Fields, side: f64) -> Self {
        let [x, y] = fields.uniform_force.map(|force| round_half_even((force as f32) * FORCE_UNITS));
        let [center_x, center_y] = fields
            .trap_center
            .map(|center| Torus::new(side).map_or(Fraction::ZERO, |torus| torus.wrapped_fraction(center)));
        let stiffness = (fields.trap_stiffness * (side / UNITS)) as f32 * FORCE_UNITS;
        Self { uniform: (x, y), stiffness, center: (center_x, center_y) }
    }

    /// For statics; of no use before it is replaced.
    pub(crate) const fn blank() -> Self {
        Self { uniform: (0, 0), stiffness: 0.0, center: (Fraction::ZERO, Fraction::ZERO) }
    }

    /// Whether there is no field at all.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.uniform == (0, 0) && self.stiffness == 0.0
    }

    /// The force on a disc at (x, y), unit 2⁻²⁴ kBT/R0.
    #[must_use]
    pub fn at(&self, x: Fraction, y: Fraction) -> (i64, i64) {
        let towards = |center: Fraction, at: Fraction| {
            round_half_even(self.stiffness * minimum_image(center, at) as f32)
        };
        (self.uniform.0 + towards(self.center.0, x), self.uniform.1 + towards(self.center.1, y))
    }
}
