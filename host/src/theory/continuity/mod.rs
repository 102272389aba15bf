//! The mean-field density ρ(r, t) of the monolayer: ∂ρ/∂t = ∇·(∇p(ρ) − ρ∇U) (Eq. 6) in a periodic box.
//!
//! U is the field of Eq. 4, (κ² − ∇²)U = 2πV0·ρ with κ = 1/λ and its mean left out, so that a disc has the energy −U.
//! Finite volumes on n × n square cells of side h = L/n: what leaves a cell enters its neighbour, so the number of discs is
//! kept to rounding. Between two cells flows what the exponentially fitted scheme of Scharfetter and Gummel says,
//! J·h = B(−ΔW)ρ₁ − B(ΔW)ρ₂ with B(x) = x/(eˣ − 1) and W = U − μ_ex: densities stay positive,
//! ρ ∝ exp(W) is stationary as it should be, and the free energy ∫ f(ρ) − ρU/2 falls. Without pressure it is ρΔU/h with ρ
//! extrapolated from upwind within van Leer's limits. ∇² is that of five points, so that Gauss' law holds cell by cell. All is of
//! second order in h where the field changes by less than kBT from cell to cell, and of first where it
//! changes by more. Steps are explicit (Heun's), and as short as positivity, stability and the growth of the densest cell ask for.
//!
//! In: the box (R0), V0 (kBT), λ (R0), an equation of state, mean densities of the cells (R0⁻²); cell (x, y) is element y·n + x
//! and is centred at (x·h, y·h). Out: densities (R0⁻²) at times in R0²/D. The sines of the transform are the platform's, so the
//! last digits may differ between platforms.
//!
//! ```
//! use meniscus::theory::continuity::{Continuity, sinusoid};
//! use meniscus::theory::{Instability, Pressure};
//!
//! // A wave of 500 R0 and 1 % at Table I's density.
//! let start = sinusoid(32, 0.01, 0.01, [1, 0]);
//! let mut monolayer = Continuity::new(500.0, 32, 0.89, 270.0, Pressure::IdealGas, &start)?;
//! let theory = Instability::of_ideal_gas(0.89, 0.01, 270.0).expect("it attracts");
//! let time = 0.5 * theory.jeans_time;
//! let before = monolayer.spectrum();
//! monolayer.advance_to(time)?;
//! let growth = monolayer.spectrum().log_growth(&before, 1)[0].expect("the wave is there");
//! let wavenumber = core::f64::consts::TAU / 500.0;
//! assert!((growth / (theory.growth_rate(wavenumber) * time) - 1.0).abs() < 0.01);
//! assert!((monolayer.mass() / 2500.0 - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod field;
mod flux;
mod spectrum;
mod starts;
mod transform;

pub use spectrum::Spectrum;
pub use starts::{sinusoid, top_hat};

use super::{AttractionError, EvolutionError, Pressure};
use core::f64::consts::TAU;
use field::Field;
use flux::{Flow, rates};

/// Fraction of its content that a cell may lose in a step, and of the longest stable step.
const COURANT: f64 = 0.5;

/// Longest step as a fraction of Jeans' time in the densest cell. Heun's method errs by a sixth of its square,
/// relative to the rate.
const GROWTH_STEP: f64 = 0.03;

/// Halvings of a step before the solution is given up.
const MOST_HALVINGS: usize = 60;

/// A density field on its way.
#[derive(Clone, Debug)]
pub struct Continuity {
    side: f64,
    cells: usize,
    strength: f64,
    pressure: Pressure,
    field: Field,
    density: Vec<f64>,
    time: f64,
}

/// Why the continuity equation cannot be solved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ContinuityError {
    /// No such attraction, or no such box.
    #[error(transparent)]
    Attraction(#[from] AttractionError),
    /// Fewer cells than neighbours.
    #[error("a mesh of {cells} cells a side was given: it needs at least 4")]
    Cells {
        /// n as given.
        cells: usize,
    },
    /// Not one density per cell.
    #[error("{found} densities were given for {cells} x {cells} cells: give one for each")]
    Count {
        /// Number of densities given.
        found: usize,
        /// n.
        cells: usize,
    },
    /// A density that is none, or that the equation of state does not reach.
    #[error("cell {index} has the density {density} R0^-2: it must be at least 0 and below {largest}")]
    Density {
        /// The first such cell.
        index: usize,
        /// Its density, R0⁻².
        density: f64,
        /// The density at which the pressure diverges, R0⁻².
        largest: f64,
    },
}

impl Continuity {
    /// The field at time 0 with the given mean `density` (R0⁻²) of each of `cells`² cells, in a box of `side` (R0), with
    /// V0 = `strength` (kBT) and λ = `length` (R0), which may be infinite.
    ///
    /// # Errors
    /// [`ContinuityError`].
    pub fn new(
        side: f64,
        cells: usize,
        strength: f64,
        length: f64,
        pressure: Pressure,
        density: &[f64],
    ) -> Result<Self, ContinuityError> {
        AttractionError::check_side(side, 0.0)?;
        AttractionError::check(strength, length)?;
        if cells < 4 {
            return Err(ContinuityError::Cells { cells });
        }
        if cells.checked_mul(cells) != Some(density.len()) {
            return Err(ContinuityError::Count { found: density.len(), cells });
        }
        let largest = pressure.largest_density();
        let fits = |density: f64| density >= 0.0 && density.is_finite() && density <= pressure.densest();
        if let Some(index) = density.iter().position(|&density| !fits(density)) {
            return Err(ContinuityError::Density { index, density: density[index], largest });
        }
        let field = Field::new(side, cells, strength, length);
        Ok(Self { side, cells, strength, pressure, field, density: density.to_vec(), time: 0.0 })
    }

    /// Goes on to the `time` (R0²/D), exactly.
    ///
    /// # Errors
    /// [`EvolutionError::Time`] unless it is at or after [`Continuity::time`]; [`EvolutionError::Stalled`], in which case
    /// the state is that of the last step.
    pub fn advance_to(&mut self, time: f64) -> Result<(), EvolutionError> {
        EvolutionError::check(time, self.time)?;
        while self.time < time {
            self.step(time)?;
        }
        Ok(())
    }

    /// Mean densities of the cells, R0⁻²; none is below 0.
    #[must_use]
    pub fn density(&self) -> &[f64] {
        &self.density
    }

    /// R0²/D
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The number of discs, h²Σρ. It is the same at all times but for rounding.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.cell_area() * self.density.iter().sum::<f64>()
    }

    /// The free energy ∫ f(ρ) − ρU/2, kBT. It never rises.
    #[must_use]
    pub fn free_energy(&self) -> f64 {
        let field = self.field.of(&self.density);
        let per_area =
            |(&density, field): (&f64, f64)| self.pressure.free_energy(density) - 0.5 * density * field;
        self.cell_area() * self.density.iter().zip(field).map(per_area).sum::<f64>()
    }

    /// The density modes ρ̂_k, as those of discs.
    #[must_use]
    pub fn spectrum(&self) -> Spectrum {
        Spectrum::new(self.side, self.cells, &self.density)
    }

    /// h², R0²
    fn cell_area(&self) -> f64 {
        let spacing = self.side / self.cells as f64;
        spacing * spacing
    }

    /// One step of Heun's method, ρ₁ = ρ + τ·r(ρ), ρ ← (ρ + ρ₁ + τ·r(ρ₁))/2: positive if both of its Euler steps are.
    fn step(&mut self, until: f64) -> Result<(), EvolutionError> {
        let first = self.flow(&self.density);
        let densest = largest(&self.density);
        let growth = GROWTH_STEP / (TAU * self.strength * densest);
        let left = until - self.time;
        let mut step = (COURANT * self.longest_step(&self.density, &first)).min(growth).min(left);
        for _ in 0..MOST_HALVINGS {
            if self.time + step <= self.time {
                break;
            }
            let euler = |density: &[f64], flow: &Flow| -> Vec<f64> {
                density.iter().zip(&flow.rates).map(|(density, rate)| density + step * rate).collect()
            };
            let predicted = euler(&self.density, &first);
            if self.is_fluid(&predicted) {
                let second = self.flow(&predicted);
                let mut next = euler(&predicted, &second);
                next.iter_mut()
                    .zip(&self.density)
                    .for_each(|(next, density)| *next = 0.5 * (*next + density));
                if step <= self.longest_step(&predicted, &second) && self.is_fluid(&next) {
                    self.density = next;
                    self.time = if step < left { self.time + step } else { until };
                    return Ok(());
                }
            }
            step *= 0.5;
        }
        Err(EvolutionError::Stalled { time: self.time })
    }

    /// How the cells empty and fill at this density.
    fn flow(&self, density: &[f64]) -> Flow {
        let mut potential = self.field.of(density);
        for (potential, &density) in potential.iter_mut().zip(density) {
            *potential -= self.pressure.excess_potential(density);
        }
        rates(self.pressure, self.cells, 1.0 / self.cell_area(), density, &potential)
    }

    /// The longest Euler step that empties no cell and is stable against the pressure, R0²/D.
    fn longest_step(&self, density: &[f64], flow: &Flow) -> f64 {
        let stiffness = self.pressure.stiffness(largest(density));
        (1.0 / flow.largest_loss).min(self.cell_area() / (4.0 * stiffness))
    }

    /// Whether the equation of state has an answer everywhere.
    fn is_fluid(&self, density: &[f64]) -> bool {
        let most = self.pressure.densest();
        density.iter().all(|&density| density >= 0.0 && density.is_finite() && density <= most)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
