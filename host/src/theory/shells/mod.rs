//! Cold collapse of concentric shells at any capillary length: Eq. 6 without pressure, for what is round.
//!
//! A shell of m discs at the radius R makes the potential energy −V0·m·I₀(r_</λ)K₀(r_>/λ) of a disc at r, where r_< and r_>
//! are the lesser and the greater of r and R; on itself it acts with the mean of the forces on either side of it. The
//! mobility is 1, so Ṙ is the force. For λ → ∞ only what is within acts, with −V0/r per disc, and a filled patch of
//! shells keeps to Eq. 13.
//!
//! In a periodic box of side L, an image of a shell that is centred at the lattice vector D acts, on average over directions,
//! with −V0·m·I₀(R/λ)K₀(D/λ)I₀(r/λ). The sum of K₀(D/λ) over the lattice is a number, and for λ → ∞ the force is
//! that of the background which makes the box neutral, +πV0·(N/L²)·r for N discs; corrections by the square lattice
//! are of fourth order in angle and have no part in the mean.
//!
//! Shells that meet go on together: of two that pull inwards, the outer one is always the faster, so neither can leave the
//! other. A shell that has shrunk to the centre stays there.
//!
//! In: a [`Shell`] each (radii in R0), V0 in kBT, λ in R0. Out: radii in R0 at times in R0²/D, forces in kBT/R0. Only arithmetic
//! and libm: the same on every machine.
//!
//! ```
//! use meniscus::theory::shells::{Shell, Shells};
//! use meniscus::theory::{cold_collapse_radius, jeans_time};
//!
//! // Nine rings of 10n discs at the radius 20n R0: 10n/(40πn·20) discs per R0².
//! let rings: Vec<Shell> = (1..=9).map(|n| Shell { radius: 20.0 * f64::from(n), discs: 10.0 * f64::from(n) }).collect();
//! let jeans = jeans_time(0.89, 1.0 / (80.0 * core::f64::consts::PI));
//! let newtonian = Shells::new(&rings, 0.89, f64::INFINITY)?;
//! let radii = newtonian.radii_at(&[0.75 * jeans])?;
//! assert!((radii[0][6] - cold_collapse_radius(140.0, 0.75)).abs() < 1e-6);
//! // Screening slows it down.
//! let screened = Shells::new(&rings, 0.89, 270.0)?;
//! assert!(screened.radii_at(&[0.75 * jeans])?[0][6] > radii[0][6]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod collapse;
mod runge_kutta;

use super::attraction::Attraction;
use super::{AttractionError, EvolutionError};
use collapse::Collapse;

/// Discs spread evenly over a circle about the common centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    /// Radius R, R0; 0 for discs in the centre.
    pub radius: f64,
    /// Number of discs m; any positive number.
    pub discs: f64,
}

/// Concentric shells and how they attract.
#[derive(Clone, Debug)]
pub struct Shells {
    shells: Vec<Shell>,
    attraction: Attraction,
}

/// Why shells cannot be collapsed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ShellsError {
    /// A radius that is none.
    #[error("shell {index} has the radius {radius} R0: it must be a number of at least 0")]
    Radius {
        /// Which, from 0.
        index: usize,
        /// The radius given, R0.
        radius: f64,
    },
    /// A number of discs that is none.
    #[error("shell {index} has {discs} discs: it must have a positive number")]
    Discs {
        /// Which, from 0.
        index: usize,
        /// The number given.
        discs: f64,
    },
    /// No such attraction.
    #[error(transparent)]
    Attraction(#[from] AttractionError),
}

impl Shells {
    /// `shells` in any order, in the open plane, with V0 = `capillary_strength` (kBT) and λ = `capillary_length` (R0), which
    /// may be infinite.
    ///
    /// # Errors
    /// [`ShellsError`].
    pub fn new(
        shells: &[Shell],
        capillary_strength: f64,
        capillary_length: f64,
    ) -> Result<Self, ShellsError> {
        for (index, &Shell { radius, discs }) in shells.iter().enumerate() {
            if !(radius >= 0.0 && radius.is_finite()) {
                return Err(ShellsError::Radius { index, radius });
            }
            if !(discs > 0.0 && discs.is_finite()) {
                return Err(ShellsError::Discs { index, discs });
            }
        }
        let attraction = Attraction::new(capillary_strength, capillary_length)?;
        Ok(Self { shells: shells.to_vec(), attraction })
    }

    /// The same with all periodic images in a box of `side` L (R0), on average over directions.
    ///
    /// # Errors
    /// [`AttractionError::Side`] unless all radii are below L/2.
    pub fn periodic(self, side: f64) -> Result<Self, AttractionError> {
        let largest = self.shells.iter().map(|shell| shell.radius).fold(0.0, f64::max);
        Ok(Self { attraction: self.attraction.periodic(side, largest)?, ..self })
    }

    /// The same of discs that do not attract themselves: +V0/2r is added to the force on a disc of a shell.
    ///
    /// Of m discs evenly on a circle of radius r each feels (m − 1)/2r of the others for λ → ∞, and so very nearly for λ ≫ r/m.
    #[must_use]
    pub fn of_discs(mut self) -> Self {
        self.attraction.acts_on_itself = 0.0;
        self
    }

    /// The force on a disc of each shell, outwards, kBT/R0, in the order given.
    ///
    /// That on shells at the same radius is the mean over them, that in the centre is 0.
    ///
    /// ```
    /// use meniscus::theory::shells::{Shell, Shells};
    ///
    /// let rings = [Shell { radius: 10.0, discs: 4.0 }, Shell { radius: 20.0, discs: 6.0 }];
    /// let newtonian = Shells::new(&rings, 1.0, f64::INFINITY)?;
    /// // Nothing within and half of itself; 4 discs within and half of itself.
    /// assert_eq!(newtonian.forces(), [-0.2, -0.35]);
    /// // In a box of 100 R0 the background of 10 discs pushes outwards with 10π/100² per R0.
    /// let periodic = newtonian.periodic(100.0)?;
    /// assert!((periodic.forces()[1] - (-0.35 + 0.02 * core::f64::consts::PI)).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn forces(&self) -> Vec<f64> {
        let collapse = Collapse::new(&self.shells, &self.attraction);
        let rates = collapse.rates();
        let force = |(index, shell): (usize, &Shell)| {
            if shell.radius > 0.0 { 0.5 * rates[collapse.group_of(index)] / shell.radius } else { 0.0 }
        };
        self.shells.iter().enumerate().map(force).collect()
    }

    /// The radii of all shells (R0), in the order given, at each of `times` (R0²/D).
    ///
    /// R² errs by about 1e-9 of the largest R², and by 1e-8 after shells have met.
    ///
    /// # Errors
    /// [`EvolutionError::Time`] unless 0 ≤ t₁ ≤ t₂ ≤ …; [`EvolutionError::Stalled`].
    pub fn radii_at(&self, times: &[f64]) -> Result<Vec<Vec<f64>>, EvolutionError> {
        let mut collapse = Collapse::new(&self.shells, &self.attraction);
        let mut radii = Vec::with_capacity(times.len());
        for &time in times {
            EvolutionError::check(time, collapse.time())?;
            collapse.advance_to(time)?;
            radii.push((0..self.shells.len()).map(|index| collapse.radius(index)).collect());
        }
        Ok(radii)
    }
}

#[cfg(test)]
mod tests;
