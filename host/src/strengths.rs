//! Capillary strengths of the discs: discs i and j attract each other with V0·f_i·f_j.
//!
//! A strength f is a number of modulus at most [`LARGEST_STRENGTH`], of either sign, held in units of 2⁻²⁰; without
//! anything said it is 1. Discs of f = 0 feel no capillary force and cause none. In a mixture V0·⟨f²⟩ takes the
//! place of V0 where an ideal gas is taken to collapse: Jeans' time and wavenumber (Eqs. 7 and 22) are those of the
//! mean square of the vertical force on a disc, whatever the signs.
//!
//! ```
//! use meniscus::strengths::{Strengths, from_number};
//!
//! let pattern = [1.0, -1.0, 0.5].map(|number| from_number(number).unwrap());
//! let strengths = Strengths::Pattern(pattern.to_vec());
//! assert_eq!(strengths.of(4), -(1 << 20));
//! assert_eq!(strengths.mean_square(2), 1.0);
//! assert_eq!(strengths.mean_square(3), 0.75);
//! assert_eq!(from_number(2000.0), None);
//! ```

use meniscus_core::assignment::DISC;
use meniscus_core::parameters::LARGEST_STRENGTH;

/// Strength 1, in units of 2⁻²⁰.
pub const ONE: i32 = DISC as i32;

/// The strength nearest to a number, unit 2⁻²⁰; None if its modulus exceeds [`LARGEST_STRENGTH`] or it is none.
#[must_use]
pub fn from_number(number: f64) -> Option<i32> {
    (number.abs() <= LARGEST_STRENGTH).then(|| libm::rint(number * f64::from(ONE)) as i32)
}

/// The number that a strength of unit 2⁻²⁰ stands for, exactly.
#[must_use]
pub fn to_number(strength: i32) -> f64 {
    f64::from(strength) / f64::from(ONE)
}

/// Whether all strengths are 1, which files then do not say.
#[must_use]
pub fn all_one(strengths: &[i32]) -> bool {
    strengths.iter().all(|&strength| strength == ONE)
}

/// Which strengths the discs of a run have, unit 2⁻²⁰.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Strengths {
    /// As configured: repeated over the ids; not empty.
    Pattern(Vec<i32>),
    /// As the file of the start has them, in the order of ids.
    OfFile(Vec<i32>),
}

impl Default for Strengths {
    fn default() -> Self {
        Self::Pattern(vec![ONE])
    }
}

impl Strengths {
    /// The strength of the disc of that id.
    #[must_use]
    pub fn of(&self, id: usize) -> i32 {
        let repeated = self.repeated();
        repeated.get(id % repeated.len().max(1)).copied().unwrap_or(ONE)
    }

    /// Mean square ⟨f²⟩ over the discs of ids 0 … `count` − 1.
    #[must_use]
    pub fn mean_square(&self, count: usize) -> f64 {
        let repeated = self.repeated();
        let sum = |length: usize| -> u128 {
            repeated.iter().take(length).map(|strength| u128::from(strength.unsigned_abs()).pow(2)).sum()
        };
        let length = repeated.len().max(1);
        let total = sum(length) * (count / length) as u128 + sum(count % length);
        let one = f64::from(ONE);
        total as f64 / (one * one) / count.max(1) as f64
    }

    /// What is repeated over the ids.
    #[must_use]
    pub fn repeated(&self) -> &[i32] {
        match self {
            Self::Pattern(strengths) | Self::OfFile(strengths) => strengths,
        }
    }
}
