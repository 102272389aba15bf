//! Numbers that the paper prints and that exclude each other: no runs, only arithmetic.
//!
//! ```
//! use meniscus::reproduce::figures::text;
//! use meniscus::reproduce::finding::Verdict;
//!
//! let built = text::build();
//! assert!(built.findings.iter().any(|finding| finding.verdict() == Verdict::PaperInconsistent));
//! ```

use super::Built;
use crate::configuration::BOLTZMANN_CONSTANT;
use crate::reproduce::campaign::PATCH_RADIUS;
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::plain;
use crate::statistics::Estimate;
use crate::theory::{Instability, jeans_time, jeans_wavenumber};
use core::f64::consts::PI;

/// V0 of Table I, kBT.
pub(super) const STRENGTH: f64 = 0.89;
/// ρ_h of Table I, N/L², R0⁻².
pub(super) const DENSITY: f64 = 0.01;
/// λ of Table I, R0.
pub(super) const LENGTH: f64 = 270.0;
/// R0 of Table I, m.
const RADIUS: f64 = 1e-5;
/// Room temperature, K.
const TEMPERATURE: f64 = 300.0;
/// Mobility Γ as printed, s/kg.
const PRINTED_MOBILITY: f64 = 10.6e-6;
/// Mobility Γ of a sphere of 10 µm half immersed in water of 1 mPa·s, 1/(3πηR0), s/kg.
const MOBILITY: f64 = 1.0 / (3.0 * PI * 1e-3 * RADIUS);

/// The findings.
#[must_use]
pub fn build() -> Built {
    let finding = |quantity: &str, printed: f64, implied: f64, rounding: f64, from: &str| {
        Finding::new(
            quantity,
            format!("{} printed; {} from {from}", plain(printed), plain(implied)),
            Criterion::consistent(printed, implied, rounding),
        )
        .measured(Some(Estimate::exact(implied)))
    };
    let jeans = jeans_time(STRENGTH, DENSITY);
    let unit = RADIUS * RADIUS / (BOLTZMANN_CONSTANT * TEMPERATURE * 10.6e6);
    let length = RADIUS * 1e6 / jeans_wavenumber(STRENGTH, DENSITY);
    let critical = Instability::of_ideal_gas(STRENGTH, DENSITY, LENGTH)
        .and_then(|instability| instability.critical_wavenumber())
        .map_or(f64::NAN, |wavenumber| wavenumber / (RADIUS * 1e3));
    let closest = 1.0 / (2.0 * 3.0_f64.sqrt());
    let findings = vec![
        finding("mobility Γ, Table I (s/kg)", PRINTED_MOBILITY, MOBILITY, 0.05e6, "1/(3πηR0) in water"),
        finding("Jeans' time T, Table I (s)", 40_780.0, jeans * unit, 250.0, "Eq. 7, Γ = 10.6e6 s/kg, 300 K"),
        finding("Jeans' length 1/K, Table I (µm)", 43.8, length, 0.3, "Eq. 22, V0 = 0.89 kBT"),
        finding("critical wavenumber K_c, Fig. 2 (1/mm)", 22.8, critical, 0.2, "Eq. 11, V0 = 0.89 kBT"),
        finding("mean density ρ_h, Figs. 7 and 8 (1/R0²)", 10.0, DENSITY, 0.005, "N/L², Table I"),
        finding("ρ_m/ρ_h, Fig. 7", 29.0, closest / DENSITY, 0.5, "ρ_m = 1/(2√3 R0²), ρ_h = 0.01/R0²"),
        finding(
            "wavenumber K of the patch, Fig. 14 (1/µm)",
            15.2,
            patch_wavenumber(),
            0.5,
            "Eq. 22, N = 451 in 183 R0",
        ),
        finding(
            "density of the patch, Fig. 12 (1/R0²)",
            4.28e-3,
            patch_density(451.0),
            5e-6,
            "N/(πL²), N = 451",
        ),
        finding(
            "density of the patch without the disc in its middle (1/R0²)",
            4.28e-3,
            patch_density(450.0),
            5e-6,
            "450/(πL²)",
        ),
        finding(
            "Jeans' time of the patch, Figs. 12 and 14 (s)",
            95_340.0,
            jeans_time(STRENGTH, patch_density(450.0)) * unit,
            600.0,
            "Eq. 7 with 450/(πL²)",
        ),
    ];
    let notes = vec![
        "ρ_h = 10 R0⁻² is meant as (10 R0)⁻², Γ as 10.6·10⁶ s/kg, K = 15.2 as mm⁻¹; \
         1/K = 43.8 µm and K_c = 22.8 mm⁻¹ belong together and contain a correction to the ideal gas. We take V0 = 0.89 kBT as given \
         and all else from Eqs. 7, 11 and 22."
            .to_owned(),
        "Sec. III calls L the diameter of a patch: λ/L = 1.48 at λ = 270 R0 makes it the radius. \
         \"n_c(s ≤ 3) = 0 by definition\" holds if discs at the rim belong to the cluster of their core, as here."
            .to_owned(),
        "Two more things cannot be meant as printed: a random displacement uniform in a width of √(2DΔt) (a variance of \
         2DΔt is needed, else the diffusion constant is D/3 or D/12), and the signs and the factor of Eqs. 19 and 21 (as printed \
         discs repel, four times too strongly)."
            .to_owned(),
    ];
    Built { findings, notes, ..Built::default() }
}

/// Density of so many discs in the patch of Figs. 12 to 14, R0⁻².
fn patch_density(discs: f64) -> f64 {
    discs / (PI * PATCH_RADIUS * PATCH_RADIUS)
}

/// K of the patch of Figs. 12 to 14, 1/µm.
fn patch_wavenumber() -> f64 {
    jeans_wavenumber(STRENGTH, patch_density(451.0)) / (RADIUS * 1e6)
}
