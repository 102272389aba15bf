//! Ermak's step without hydrodynamic interactions: Δr = F·Δt + ξ (Eqs. 16 and 17), and its length.
//!
//! The step is the longest that moves no disc farther by force than a given distance (the paper's R0/4), and
//! not longer than a ceiling. It is found with integers alone: never above its bounds, the same everywhere.
//!
//! ```
//! use meniscus_core::ermak::{largest_force, StepLimits};
//! use meniscus_core::units::TIME_UNITS;
//!
//! let limits = StepLimits::new(0.001, 0.25);
//! assert_eq!(limits.step_length(0), Some(TIME_UNITS / 1000));
//! // 500 kBT/R0 move a disc by R0/4 in 1/2000 R0²/D.
//! let largest = largest_force(&[300 << 24, 0], &[-(400 << 24), 0]);
//! assert_eq!(limits.step_length(largest), Some(TIME_UNITS / 2000));
//! ```

use crate::noise::ThermalKick;
use crate::torus::Fraction;
use crate::units::{FORCE_UNITS, TIME_UNITS, round_half_even};

/// The largest modulus of the forces (`x`, `y`), rounded up to a unit of 2⁻²⁴ kBT/R0.
#[must_use]
pub fn largest_force(x: &[i64], y: &[i64]) -> u64 {
    let squared = |x: i64| u128::from(x.unsigned_abs()) * u128::from(x.unsigned_abs());
    let largest = x.iter().zip(y).map(|(&x, &y)| squared(x) + squared(y)).max().unwrap_or(0);
    let root = largest.isqrt();
    let rounded_up = if root * root < largest { root + 1 } else { root };
    u64::try_from(rounded_up).unwrap_or(u64::MAX)
}

/// What a step may not exceed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepLimits {
    /// Unit 2⁻⁴⁰ R0²/D.
    max_step: u64,
    /// Unit 2⁻⁶⁴ R0: that of force times time.
    max_displacement: u64,
}

impl StepLimits {
    /// A ceiling `max_step` (R0²/D) and a largest displacement by force `max_displacement` (R0), both within
    /// the ranges of [`crate::parameters`], rounded down.
    #[must_use]
    pub fn new(max_step: f64, max_displacement: f64) -> Self {
        const DISPLACEMENT_UNITS: f64 = 18_446_744_073_709_551_616.0;
        Self {
            max_step: (max_step * TIME_UNITS as f64) as u64,
            max_displacement: (max_displacement * DISPLACEMENT_UNITS) as u64,
        }
    }

    /// For statics; of no use before it is replaced.
    pub(crate) const fn blank() -> Self {
        Self { max_step: 0, max_displacement: 0 }
    }

    /// The length of a step in which the largest force is `largest` (unit 2⁻²⁴ kBT/R0), rounded down to a unit
    /// of 2⁻⁴⁰ R0²/D; `None` if that is no unit at all.
    #[must_use]
    pub fn step_length(&self, largest: u64) -> Option<u64> {
        let by_force = self.max_displacement.checked_div(largest).unwrap_or(u64::MAX);
        Some(self.max_step.min(by_force)).filter(|&length| length > 0)
    }
}

/// A displacement of half a box or more, which no minimum image could tell from a shorter one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfBox;

/// One step's displacement of every disc.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// Δt, R0²/D.
    pub step_length: f32,
    /// Units of position in 1 R0, 2³²/L.
    pub units: f32,
    /// The thermal part.
    pub kick: ThermalKick,
}

impl Displacement {
    /// F·Δt + ξ of particle `id` from its force in units of 2⁻²⁴ kBT/R0, in units of L·2⁻³², rounded to nearest.
    ///
    /// # Errors
    /// [`HalfBox`] if a component reaches half a box.
    pub fn of(&self, id: u32, force: (i64, i64)) -> Result<(i32, i32), HalfBox> {
        let kick = self.kick.displacement(id);
        Ok((self.component(force.0, kick.0)?, self.component(force.1, kick.1)?))
    }

    fn component(&self, force: i64, kick: f32) -> Result<i32, HalfBox> {
        const FORCE_UNIT: f32 = 1.0 / FORCE_UNITS;
        let by_force = (force as f32 * FORCE_UNIT) * self.step_length;
        let units = round_half_even((by_force + kick) * self.units);
        if units.unsigned_abs() < 1 << 31 { i32::try_from(units).map_err(|_| HalfBox) } else { Err(HalfBox) }
    }
}

/// Moves a coordinate by `units` of L·2⁻³² and counts in `crossings` the borders it crosses, + to the right.
pub fn displace(coordinate: &mut Fraction, crossings: &mut i32, units: i32) {
    let moved = i64::from(coordinate.to_bits()) + i64::from(units);
    *coordinate = Fraction::from_bits(moved as u32);
    // 2³² boxes cannot be crossed in the time a run can last, each step being shorter than half a box.
    *crossings = crossings.wrapping_add((moved >> 32) as i32);
}
