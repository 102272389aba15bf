//! Equations of state p(ρ) of the monolayer without its capillary attraction (Eq. 2), in kBT/R0².
//!
//! In: number densities in R0⁻². Out: pressures in kBT/R0², their slopes and chemical potentials in kBT.
//!
//! Hard discs of radius a follow Henderson (1975): p = ρ(1 + η²/8)/(1 − η)², η = πa²ρ, which has the first two virial
//! coefficients (the third to a thousandth), and is good to a per cent up to η ≈ 0.6. It diverges at η = 1,
//! beyond the densest packing, 0.907: densities in between are a fluid that discs cannot make.
//!
//! ```
//! use meniscus::theory::Pressure;
//!
//! let (gas, discs) = (Pressure::IdealGas, Pressure::discs());
//! assert_eq!(gas.stiffness(0.01), 1.0);
//! // Discs cover 3 % of the area at the density of Table I, and p' = 1 + 4η + ….
//! assert!((discs.stiffness(0.01) - 1.14).abs() < 0.01);
//! assert_eq!(Pressure::None.stiffness(0.01), 0.0);
//! ```

use core::f64::consts::PI;

/// Radius of the hard discs that stand for discs with the repulsion of Eq. 15, R0.
///
/// They have its second virial coefficient, (2a)² = 2∫₀^∞ (1 − exp(−V_WCA(d))) d dd, so that p' is exact to first order in
/// the density; the repulsion is then within its reach 2·2^(1/6) R0 and hardly soft at kBT. Barker and Henderson's diameter,
/// ∫₀^∞ (1 − exp(−V_WCA(d))) dd, makes it 1.0156.
pub const DISC_RADIUS: f64 = 1.016_433;

/// How the pressure rises with the density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pressure {
    /// None: the cold limit, p = 0.
    None,
    /// p = ρ.
    IdealGas,
    /// Henderson's p = ρ(1 + η²/8)/(1 − η)².
    HardDiscs {
        /// Radius of the discs a, R0; [`DISC_RADIUS`] stands for the simulated ones.
        radius: f64,
    },
}

impl Pressure {
    /// Hard discs that stand for the simulated ones.
    #[must_use]
    pub const fn discs() -> Self {
        Self::HardDiscs { radius: DISC_RADIUS }
    }

    /// p, kBT/R0², at the `density` ρ (R0⁻²); infinite at [`Pressure::largest_density`] and beyond.
    #[must_use]
    pub fn pressure(&self, density: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::IdealGas => density,
            Self::HardDiscs { radius } => {
                let covered = covered(radius, density);
                if covered >= 1.0 {
                    return f64::INFINITY;
                }
                density * (1.0 + 0.125 * covered * covered) / ((1.0 - covered) * (1.0 - covered))
            }
        }
    }

    /// p'(ρ), kBT, at the `density` ρ (R0⁻²): the inverse of ρ times the compressibility of Eq. 8. Infinite at
    /// [`Pressure::largest_density`] and beyond.
    #[must_use]
    pub fn stiffness(&self, density: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::IdealGas => 1.0,
            Self::HardDiscs { radius } => {
                let covered = covered(radius, density);
                if covered >= 1.0 {
                    return f64::INFINITY;
                }
                let square = covered * covered;
                let free = 1.0 - covered;
                (1.0 + covered + 0.375 * square - 0.125 * square * covered) / (free * free * free)
            }
        }
    }

    /// Excess chemical potential μ_ex, kBT, beyond the ideal gas's ln ρ: dμ_ex = (p' − 1) dρ/ρ, zero at ρ = 0.
    ///
    /// 0 for [`Pressure::None`], which has no ln ρ either.
    #[must_use]
    pub fn excess_potential(&self, density: f64) -> f64 {
        let Self::HardDiscs { radius } = *self else { return 0.0 };
        let covered = covered(radius, density);
        if covered >= 1.0 {
            return f64::INFINITY;
        }
        let free = 1.0 - covered;
        (1.0 + 0.125 * covered * covered) / (free * free) - 1.0 + excess_energy(covered)
    }

    /// Free energy per area f, kBT/R0², at the `density` ρ (R0⁻²): ρ f' − f = p. ρ(ln ρ − 1) for the ideal gas.
    #[must_use]
    pub fn free_energy(&self, density: f64) -> f64 {
        let ideal = if density > 0.0 { density * (libm::log(density) - 1.0) } else { 0.0 };
        match *self {
            Self::None => 0.0,
            Self::IdealGas => ideal,
            Self::HardDiscs { radius } => {
                let covered = covered(radius, density);
                if covered >= 1.0 { f64::INFINITY } else { ideal + density * excess_energy(covered) }
            }
        }
    }

    /// The density (R0⁻²) at which the pressure diverges; infinite if it does nowhere.
    #[must_use]
    pub fn largest_density(&self) -> f64 {
        match *self {
            Self::None | Self::IdealGas => f64::INFINITY,
            Self::HardDiscs { radius } => 1.0 / covered(radius, 1.0),
        }
    }

    /// The density (R0⁻²) that nothing may exceed on its way: a little less, where the pressure is finite.
    pub(super) fn densest(&self) -> f64 {
        0.999_999 * self.largest_density()
    }
}

/// The covered fraction η = πa²ρ.
fn covered(radius: f64, density: f64) -> f64 {
    PI * radius * radius * density
}

/// Free energy per disc beyond the ideal gas's, kBT: ∫₀^η (Z − 1) dη/η with Z = p/ρ.
fn excess_energy(covered: f64) -> f64 {
    1.125 * covered / (1.0 - covered) - 0.875 * libm::log1p(-covered)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Pressure; 3] = [Pressure::None, Pressure::IdealGas, Pressure::HardDiscs { radius: 1.0 }];

    /// The derivative of `function` at `place`, to fourth order.
    fn slope(function: impl Fn(f64) -> f64, place: f64) -> f64 {
        let step = 1e-4 * place;
        let difference = |step: f64| (function(place + step) - function(place - step)) / (2.0 * step);
        (4.0 * difference(step) - difference(2.0 * step)) / 3.0
    }

    #[test]
    fn pressure_slope_and_potentials_are_of_one_free_energy() {
        for pressure in ALL {
            for density in [1e-4, 0.01, 0.1, 0.25] {
                let context = format!("{pressure:?} at {density}");
                let stiffness = slope(|density| pressure.pressure(density), density);
                assert!(
                    (stiffness - pressure.stiffness(density)).abs() < 1e-8 * (1.0 + stiffness),
                    "{context}"
                );
                let potential = slope(|density| pressure.free_energy(density), density);
                let from_energy = density * potential - pressure.free_energy(density);
                assert!((from_energy - pressure.pressure(density)).abs() < 1e-9, "{context}");
                let ideal = if pressure == Pressure::None { 0.0 } else { libm::log(density) };
                assert!((potential - ideal - pressure.excess_potential(density)).abs() < 1e-8, "{context}");
            }
        }
    }

    /// Z = 1 + 2η + 3.128η² + …: the second and third virial coefficients of hard discs are 2 and 4(4/3 − √3/π) in η.
    #[test]
    fn hard_discs_have_their_virial_coefficients() {
        let discs = Pressure::HardDiscs { radius: 1.0 };
        let beyond = |covered: f64| {
            let density = covered / PI;
            (discs.pressure(density) / density - 1.0) / covered - 2.0
        };
        let third = 4.0 * (4.0 / 3.0 - 3.0_f64.sqrt() / PI);
        assert!((beyond(1e-4) / 1e-4 / third - 1.0).abs() < 2e-3, "{}", beyond(1e-4) / 1e-4);
    }

    /// Molecular dynamics of Erpenbeck and Luban (1985): p/ρ = 3.424 at twice the area of the densest packing.
    #[test]
    fn hard_discs_press_as_simulated() {
        let density = 0.25 / 3.0_f64.sqrt();
        let compressibility = Pressure::HardDiscs { radius: 1.0 }.pressure(density) / density;
        assert!((compressibility / 3.424 - 1.0).abs() < 5e-3, "{compressibility}");
    }

    #[test]
    fn the_disc_radius_has_the_second_virial_coefficient_of_the_repulsion() {
        let reach = 2.0 * libm::pow(2.0, 1.0 / 6.0);
        let repulsion = |distance: f64| {
            let sixth = libm::pow(2.0 / distance, 6.0);
            4.0 * (sixth * sixth - sixth + 0.25)
        };
        let points = 20_000;
        let step = reach / f64::from(points);
        let middles = (0..points).map(|point| step * (f64::from(point) + 0.5));
        let square: f64 = 2.0 * step * middles.map(|d| d * (1.0 - libm::exp(-repulsion(d)))).sum::<f64>();
        assert!((0.5 * square.sqrt() - DISC_RADIUS).abs() < 1e-6, "{}", 0.5 * square.sqrt());
    }

    #[test]
    fn the_pressure_diverges_where_it_says() {
        let discs = Pressure::discs();
        let largest = discs.largest_density();
        assert!(discs.pressure(0.999 * largest) > 1e4 && discs.pressure(0.999 * largest).is_finite());
        assert_eq!(discs.pressure(largest * (1.0 + 1e-12)), f64::INFINITY);
        assert_eq!(discs.stiffness(largest * (1.0 + 1e-12)), f64::INFINITY);
    }
}
