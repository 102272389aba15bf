//! Jeans' instability of a homogeneous monolayer, in closed form.
//!
//! In: the strength V0 (kBT) and length λ (R0) of the capillary attraction and the mean density ρ_h
//! (R0⁻²). Out: times in R0²/D, wavenumbers in R0⁻¹, rates in D/R0².
//!
//! ```
//! use meniscus::theory::Instability;
//!
//! let table_1 = Instability::of_ideal_gas(0.89, 0.01, 270.0).expect("there is attraction");
//! assert!((table_1.jeans_time - 17.88).abs() < 0.005);
//! let critical = table_1.critical_wavenumber().expect("the capillary length exceeds Jeans' length");
//! assert!(table_1.growth_rate(0.5 * critical) > 0.0);
//! assert!(table_1.growth_rate(2.0 * critical) < 0.0);
//! ```

use core::f64::consts::PI;

/// Jeans' time T = 1/(2π V0 ρ_h), R0²/D (Eq. 7).
///
/// `capillary_strength` is V0 in kBT, `density` is ρ_h in R0⁻². Infinite without attraction. For discs of unequal
/// strengths f, V0·⟨f²⟩ takes the place of V0 here and below.
#[must_use]
pub fn jeans_time(capillary_strength: f64, density: f64) -> f64 {
    1.0 / (2.0 * PI * capillary_strength * density)
}

/// Jeans' wavenumber K of an ideal gas, K² = 2π ρ_h V0, R0⁻¹ (Eq. 22).
///
/// `capillary_strength` is V0 in kBT, `density` is ρ_h in R0⁻².
#[must_use]
pub fn jeans_wavenumber(capillary_strength: f64, density: f64) -> f64 {
    (2.0 * PI * density * capillary_strength).sqrt()
}

/// Jeans' instability of a homogeneous monolayer: what decides how fast its modes grow.
///
/// The fields are free, so that a wavenumber with another compressibility than the ideal gas's can
/// be put in (Eq. 8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instability {
    /// Jeans' time T, R0²/D (Eq. 7).
    pub jeans_time: f64,
    /// Jeans' wavenumber K, R0⁻¹ (Eq. 8).
    pub jeans_wavenumber: f64,
    /// Capillary length λ, R0; infinity allowed.
    pub capillary_length: f64,
}

impl Instability {
    /// That of an ideal gas of density ρ_h = `density` (R0⁻²) with V0 = `capillary_strength` (kBT)
    /// and λ = `capillary_length` (R0): T by Eq. 7, K by Eq. 22.
    ///
    /// None unless V0 and ρ_h are positive.
    #[must_use]
    pub fn of_ideal_gas(capillary_strength: f64, density: f64, capillary_length: f64) -> Option<Self> {
        (capillary_strength > 0.0 && density > 0.0).then(|| Self {
            jeans_time: jeans_time(capillary_strength, density),
            jeans_wavenumber: jeans_wavenumber(capillary_strength, density),
            capillary_length,
        })
    }

    /// That of a fluid whose pressure p rises with its density as p'(ρ_h) = `stiffness` (kBT): K by Eq. 8, which is Eq. 22
    /// over √p'. The stiffness is that of [`Pressure::stiffness`](super::Pressure::stiffness), 1 for the ideal gas.
    ///
    /// None unless V0, ρ_h and p' are positive.
    ///
    /// ```
    /// use meniscus::theory::{Instability, Pressure};
    ///
    /// let discs = Instability::of_fluid(0.89, 0.01, 270.0, Pressure::discs().stiffness(0.01)).expect("it attracts");
    /// let ideal_gas = Instability::of_ideal_gas(0.89, 0.01, 270.0).expect("it attracts");
    /// assert_eq!(discs.jeans_time, ideal_gas.jeans_time);
    /// assert!(discs.jeans_wavenumber < ideal_gas.jeans_wavenumber);
    /// ```
    #[must_use]
    pub fn of_fluid(
        capillary_strength: f64,
        density: f64,
        capillary_length: f64,
        stiffness: f64,
    ) -> Option<Self> {
        let ideal = Self::of_ideal_gas(capillary_strength, density, capillary_length)?;
        let jeans_wavenumber = ideal.jeans_wavenumber / stiffness.sqrt();
        (stiffness > 0.0).then_some(Self { jeans_wavenumber, ..ideal })
    }

    /// Growth rate 1/τ(k) of the mode of wavenumber `wavenumber` (R0⁻¹), D/R0² (Eq. 10):
    /// (1/T)(k/K)²[1/((k/K)² + (λK)⁻²) − 1].
    ///
    /// Positive for growth, negative for decay, 0 at k = 0: the number of discs is conserved.
    #[must_use]
    pub fn growth_rate(&self, wavenumber: f64) -> f64 {
        if wavenumber == 0.0 {
            return 0.0;
        }
        let ratio_squared = squared(wavenumber / self.jeans_wavenumber);
        let screening_squared = squared(1.0 / (self.capillary_length * self.jeans_wavenumber));
        ratio_squared * (1.0 / (ratio_squared + screening_squared) - 1.0) / self.jeans_time
    }

    /// Critical wavenumber K_c = K√(1 − 1/(λK)²), R0⁻¹ (Eq. 11): slower waves grow.
    ///
    /// None if λK ≤ 1: the homogeneous monolayer is stable.
    #[must_use]
    pub fn critical_wavenumber(&self) -> Option<f64> {
        let reach = self.capillary_length * self.jeans_wavenumber;
        (reach > 1.0).then(|| self.jeans_wavenumber * (1.0 - 1.0 / squared(reach)).sqrt())
    }
}

fn squared(value: f64) -> f64 {
    value * value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean density of Table I, R0⁻².
    const DENSITY: f64 = 0.01;
    /// Capillary strength of Table I, kBT.
    const STRENGTH: f64 = 0.89;
    /// Capillary length of Table I, R0.
    const LENGTH: f64 = 270.0;
    /// Disc radius of Table I, mm.
    const RADIUS_IN_MILLIMETRES: f64 = 0.01;

    fn table_1() -> Instability {
        Instability::of_ideal_gas(STRENGTH, DENSITY, LENGTH).unwrap()
    }

    #[track_caller]
    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
    }

    #[test]
    fn jeans_time_of_table_1() {
        assert_near(jeans_time(STRENGTH, DENSITY), 17.88, 0.005);
    }

    #[test]
    fn jeans_length_of_table_1_is_42_micrometres() {
        assert_near(1e3 * RADIUS_IN_MILLIMETRES / jeans_wavenumber(STRENGTH, DENSITY), 42.3, 0.05);
    }

    #[test]
    fn critical_wavenumber_of_table_1() {
        let per_millimetre = |wavenumber: f64| wavenumber / RADIUS_IN_MILLIMETRES;
        let ideal = table_1().critical_wavenumber().unwrap();
        assert_near(per_millimetre(ideal), 23.6, 0.05);
        // The printed 22.8/mm belongs to the printed Jeans' length of 43.8 µm.
        let printed = Instability { jeans_wavenumber: RADIUS_IN_MILLIMETRES / 0.0438, ..table_1() };
        assert_near(per_millimetre(printed.critical_wavenumber().unwrap()), 22.8, 0.05);
    }

    #[test]
    fn jeans_time_of_the_patch_of_figure_12() {
        let density = 450.0 / (PI * 183.0 * 183.0);
        assert_near(density, 4.28e-3, 5e-6);
        // 95 340 s over 2 278 s.
        assert_near(jeans_time(STRENGTH, density), 41.85, 0.1);
    }

    #[test]
    fn growth_vanishes_at_the_critical_wavenumber() {
        let instability = table_1();
        let critical = instability.critical_wavenumber().unwrap();
        assert_near(instability.growth_rate(critical), 0.0, 1e-12);
        assert!(instability.growth_rate(0.99 * critical) > 0.0);
        assert!(instability.growth_rate(1.01 * critical) < 0.0);
    }

    #[test]
    fn the_longest_waves_grow_in_jeans_time_when_the_range_is_infinite() {
        let newtonian = Instability { capillary_length: f64::INFINITY, ..table_1() };
        assert_near(newtonian.growth_rate(1e-6) * newtonian.jeans_time, 1.0, 1e-9);
        assert_eq!(newtonian.critical_wavenumber(), Some(newtonian.jeans_wavenumber));
    }

    #[test]
    fn screening_stops_the_longest_waves() {
        assert_eq!(table_1().growth_rate(0.0), 0.0);
        assert!(table_1().growth_rate(1e-6) * table_1().jeans_time < 1e-6);
    }

    #[test]
    fn a_capillary_length_below_jeans_length_is_stable() {
        let short = Instability { capillary_length: 4.0, ..table_1() };
        assert_eq!(short.critical_wavenumber(), None);
        assert!([1e-3, 1e-2, 0.1, 1.0].iter().all(|&wavenumber| short.growth_rate(wavenumber) < 0.0));
    }

    #[test]
    fn no_attraction_has_no_instability() {
        assert_eq!(Instability::of_ideal_gas(0.0, DENSITY, LENGTH), None);
        assert_eq!(jeans_time(0.0, DENSITY), f64::INFINITY);
    }
}
