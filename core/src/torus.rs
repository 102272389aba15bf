//! Positions on the torus: a coordinate is a fraction of the box.
//!
//! A coordinate is held as an unsigned 0.32 fixed-point fraction of the side L, unit L·2⁻³². Wrapping
//! at the border is integer overflow, and the minimum image of a separation is the wrapping
//! difference read as a signed number. Both are exact.
//!
//! ```
//! use meniscus_core::torus::{minimum_image, Torus};
//!
//! let torus = Torus::new(512.0).unwrap();
//! let left = torus.fraction(511.0).unwrap();
//! let right = torus.fraction(1.0).unwrap();
//! assert_eq!(torus.length(minimum_image(right, left)), 2.0);
//! ```

/// A coordinate: fraction of the box side, unsigned 0.32 fixed point, unit L·2⁻³².
pub type Fraction = fixed::types::U0F32;

/// Largest side, R0: beyond it the unit of position L·2⁻³² is coarser than 2⁻¹⁶ R0.
pub const LARGEST_SIDE: f64 = 65536.0;

/// Smallest side, R0. Far below it the unit of position would be a subnormal number or zero.
pub const SMALLEST_SIDE: f64 = 1.0 / 65536.0;

/// Number of units of position along a side, 2³².
pub const UNITS: f64 = 4_294_967_296.0;

/// Where a disc is: two coordinates, each a fraction of the side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Position {
    /// Coordinate along x.
    pub x: Fraction,
    /// Coordinate along y.
    pub y: Fraction,
}

impl Position {
    /// The position with the given bits, unit L·2⁻³².
    #[must_use]
    pub const fn from_bits(x: u32, y: u32) -> Self {
        Self { x: Fraction::from_bits(x), y: Fraction::from_bits(y) }
    }
}

/// Why a side or a coordinate was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorusError {
    /// The side is not a finite number of R0, or below [`SMALLEST_SIDE`].
    Side,
    /// The side exceeds [`LARGEST_SIDE`].
    SideTooLarge,
    /// The coordinate is not in [0, L).
    Coordinate,
}

/// The square periodic box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    side: f64,
}

impl Torus {
    /// A box of side `side` (R0), from [`SMALLEST_SIDE`] to [`LARGEST_SIDE`].
    ///
    /// # Errors
    /// [`TorusError::Side`] or [`TorusError::SideTooLarge`].
    pub fn new(side: f64) -> Result<Self, TorusError> {
        if !(side.is_finite() && side >= SMALLEST_SIDE) {
            return Err(TorusError::Side);
        }
        if side > LARGEST_SIDE {
            return Err(TorusError::SideTooLarge);
        }
        Ok(Self { side })
    }

    /// The side L in R0.
    #[must_use]
    pub fn side(&self) -> f64 {
        self.side
    }

    /// The fraction nearest to `coordinate` (R0), which must lie in [0, L).
    ///
    /// A coordinate within half a unit of L is the origin. `fraction(coordinate(f)) == f` for every f.
    ///
    /// # Errors
    /// [`TorusError::Coordinate`] outside [0, L) or when not finite.
    pub fn fraction(&self, coordinate: f64) -> Result<Fraction, TorusError> {
        if !(coordinate >= 0.0 && coordinate < self.side) {
            return Err(TorusError::Coordinate);
        }
        Ok(self.wrapped_fraction(coordinate))
    }

    /// The fraction nearest to `coordinate` (R0, any finite number) after wrapping into the box.
    ///
    /// A number that is not finite gives the origin.
    #[must_use]
    pub fn wrapped_fraction(&self, coordinate: f64) -> Fraction {
        let boxes = coordinate / self.side;
        let units = libm::rint((boxes - libm::floor(boxes)) * UNITS);
        // At most 2³², which wraps to 0; `as` makes 0 of a NaN.
        Fraction::from_bits(units as u64 as u32)
    }

    /// The coordinate in R0, in [0, L).
    #[must_use]
    pub fn coordinate(&self, fraction: Fraction) -> f64 {
        f64::from(fraction.to_bits()) * (self.side / UNITS)
    }

    /// A signed number of units L·2⁻³² in R0.
    #[must_use]
    pub fn length(&self, units: i32) -> f64 {
        f64::from(units) * (self.side / UNITS)
    }
}

/// The separation `to − from` of the nearest images along one axis, unit L·2⁻³².
///
/// Exactly half a box gives `i32::MIN` both ways; no cut-off reaches that far.
#[must_use]
pub fn minimum_image(to: Fraction, from: Fraction) -> i32 {
    to.to_bits().wrapping_sub(from.to_bits()) as i32
}
