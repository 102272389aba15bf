//! Why an attraction cannot be, and why an evolution cannot be followed: the same for all that is integrated here.
//!
//! ```
//! use meniscus::theory::shells::{Shell, Shells};
//! use meniscus::theory::{AttractionError, EvolutionError};
//!
//! let ring = [Shell { radius: 10.0, discs: 8.0 }];
//! let shells = Shells::new(&ring, 0.89, 270.0).expect("a ring is one");
//! assert_eq!(shells.radii_at(&[2.0, 1.0]), Err(EvolutionError::Time { asked: 1.0, time: 2.0 }));
//! assert_eq!(shells.periodic(20.0).unwrap_err(), AttractionError::Side { side: 20.0, least: 20.0 });
//! ```

/// Why there is no such attraction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AttractionError {
    /// A strength that is none.
    #[error("a capillary strength of {strength} kBT was given: it must be a number of at least 0")]
    Strength {
        /// V0 as given, kBT.
        strength: f64,
    },
    /// A length that is none.
    #[error("a capillary length of {length} R0 was given: it must be positive; inf is allowed")]
    Length {
        /// λ as given, R0.
        length: f64,
    },
    /// A box that is none, or in which what is round meets its images.
    #[error("a box of side {side} R0 was given: it must be a number above {least}")]
    Side {
        /// L as given, R0.
        side: f64,
        /// 0, or the diameter of what is in the box, R0.
        least: f64,
    },
}

impl AttractionError {
    /// Refuses a V0 (kBT) or a λ (R0) that is none.
    pub(super) fn check(strength: f64, length: f64) -> Result<(), Self> {
        if !(strength >= 0.0 && strength.is_finite()) {
            return Err(Self::Strength { strength });
        }
        if length.is_nan() || length <= 0.0 {
            return Err(Self::Length { length });
        }
        Ok(())
    }

    /// Refuses a side (R0) unless it is above `least`.
    pub(super) fn check_side(side: f64, least: f64) -> Result<(), Self> {
        if side > least && side.is_finite() { Ok(()) } else { Err(Self::Side { side, least }) }
    }
}

/// Why a time cannot be reached.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EvolutionError {
    /// A time that has passed.
    #[error("the time {asked} R0^2/D was asked for at {time}: ask for later ones")]
    Time {
        /// The time asked for, R0²/D.
        asked: f64,
        /// The time reached, R0²/D.
        time: f64,
    },
    /// No step is short enough.
    #[error(
        "the density cannot be followed beyond the time {time} R0^2/D: ask for earlier times, take more pressure or a coarser resolution"
    )]
    Stalled {
        /// The time reached, R0²/D.
        time: f64,
    },
}

impl EvolutionError {
    /// Refuses a time `asked` for (R0²/D) unless it is a number at or after `time`.
    pub(super) fn check(asked: f64, time: f64) -> Result<(), Self> {
        if asked >= time && asked.is_finite() { Ok(()) } else { Err(Self::Time { asked, time }) }
    }
}
