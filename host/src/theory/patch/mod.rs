//! Collapse of a round patch with pressure: Eq. 6 for what is round, with the discs within as coordinate.
//!
//! The patch is cut into shells of m discs each, which keep their discs. With q = R² of a shell and the pressure p between two,
//! ρ = m/(πΔq), the mobility being 1, dq/dt = 2RF − 4πq Δp/m with the attraction F of concentric shells (see
//! [`shells`](super::shells)), in the open plane or in a periodic box on average over directions. So nothing diffuses that
//! should not, discs are kept exactly, and without pressure a shell keeps to cold collapse.
//!
//! Discs that are followed, those that began between two radii, also mix with the others: their share c of a shell obeys
//! ρ ∂c/∂t = ∇·(ρD_s∇c). Long-time self-diffusion of hard discs goes as D_s/D = ρ/p, which is exact to first order in the
//! density (Ackerson and Fleishman 1982; Leegwater and Szamel 1992 have 1/(1 + 2ηg) at any density, and p/ρ is 1 + 2ηg in two
//! dimensions), is D for the ideal gas, and ends where discs are packed. The mean radius of the discs followed is what is
//! measured of groups of discs.
//!
//! On a mesh ([`continuity`](super::continuity)) what is pulled by more than kBT from cell to cell spreads too fast: 128² cells in
//! the box of Fig. 14 leave its patch 3 % too large at 0.8 T, an error that falls with the first power of the spacing. Here 64 shells
//! err by 0.2 %.
//!
//! Pressure is implicit, so steps are as long as accuracy asks for: one Euler step and two of half the length make one of second
//! order and an estimate of the error.
//!
//! In: numbers of discs, radii in R0, V0 in kBT, λ in R0, an equation of state. Out: radii in R0 at times in R0²/D. Only
//! arithmetic and libm: the same on every machine.
//!
//! ```
//! use meniscus::theory::patch::Patch;
//! use meniscus::theory::{Pressure, cold_collapse_radius, jeans_time};
//!
//! // The patch of Fig. 14 for λ → ∞ in the open plane.
//! let patch = Patch::top_hat(451.0, 183.0, 64, 0.89, f64::INFINITY, Pressure::discs())?;
//! let mut patch = patch.following(&[(127.5, 135.0)]);
//! let jeans = jeans_time(0.89, 451.0 / (core::f64::consts::PI * 183.0 * 183.0));
//! patch.advance_to(0.75 * jeans)?;
//! // So far pressure hardly matters.
//! assert!((patch.mean_radii()[0] - cold_collapse_radius(131.25, 0.75)).abs() < 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod mixing;
mod squeeze;
mod tridiagonal;

use super::attraction::Attraction;
use super::{AttractionError, EvolutionError, Pressure};
use mixing::mix;
use squeeze::{apart, squeezed};

/// Estimated error of a step, of the largest R² at the start.
const TOLERANCE: f64 = 3e-5;

/// The first step to try, of Jeans' time.
const FIRST_STEP: f64 = 1e-3;

/// A step is shortened and lengthened by no more than these at a time.
const SHORTEN: f64 = 0.2;
const LENGTHEN: f64 = 2.0;

/// A round patch on its way.
#[derive(Clone, Debug)]
pub struct Patch {
    attraction: Attraction,
    pressure: Pressure,
    /// R² of the shells from the inside outwards, R0².
    squares: Vec<f64>,
    /// Discs of each.
    discs: Vec<f64>,
    /// Of the discs of each shell, the share that is followed, by groups.
    groups: Vec<Vec<f64>>,
    /// R² of the border of the patch at time 0, R0².
    scale: f64,
    time: f64,
    /// The step to try next, R0²/D.
    step: f64,
}

/// Why there is no such patch.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PatchError {
    /// Too few shells.
    #[error("{shells} shells were asked for: take at least 4")]
    Shells {
        /// The number asked for.
        shells: usize,
    },
    /// A number of discs that is none.
    #[error("shells of {discs} discs were asked for: it must be a positive number")]
    Discs {
        /// The number of a shell.
        discs: f64,
    },
    /// Shells out of order, or with less room than the equation of state gives their discs.
    #[error(
        "shell {index} at the radius {radius} R0 has no room for its discs: take larger radii, in rising order"
    )]
    Radius {
        /// Which, from 0.
        index: usize,
        /// The radius given, R0.
        radius: f64,
    },
    /// No such attraction.
    #[error(transparent)]
    Attraction(#[from] AttractionError),
}

impl Patch {
    /// `discs` spread evenly within `radius` (R0) as `shells` shells of equally many, in the open plane, with V0 =
    /// `strength` (kBT) and λ = `length` (R0), which may be infinite (Eq. 12).
    ///
    /// A shell feels half of itself. N discs at random do not act upon themselves: V0·(1 − 1/N) stands for that on average
    /// over their places, [`Patch::of_discs`] where these are known.
    ///
    /// # Errors
    /// [`PatchError`].
    pub fn top_hat(
        discs: f64,
        radius: f64,
        shells: usize,
        strength: f64,
        length: f64,
        pressure: Pressure,
    ) -> Result<Self, PatchError> {
        let count = shells as f64;
        let middle = |shell: usize| radius * ((shell as f64 + 0.5) / count).sqrt();
        let radii: Vec<f64> = (0..shells).map(middle).collect();
        Self::of_shells(&radii, discs / count, strength, length, pressure)
    }

    /// Shells of `discs` discs each at `radii` (R0), in rising order; each radius is the one within which half of the
    /// shell's discs are. All else is as in [`Patch::top_hat`].
    ///
    /// # Errors
    /// [`PatchError`].
    pub fn of_shells(
        radii: &[f64],
        discs: f64,
        strength: f64,
        length: f64,
        pressure: Pressure,
    ) -> Result<Self, PatchError> {
        let shells = radii.len();
        let &[.., before, last] = radii else { return Err(PatchError::Shells { shells }) };
        if shells < 4 {
            return Err(PatchError::Shells { shells });
        }
        if !(discs > 0.0 && discs.is_finite()) {
            return Err(PatchError::Discs { discs });
        }
        let squares: Vec<f64> = radii.iter().map(|radius| radius * radius).collect();
        let placed = |count: usize| last.is_finite() && apart(pressure, &squares[..count], discs);
        if let Some(index) = (0..shells).find(|index| radii[*index] < 0.0 || !placed(index + 1)) {
            return Err(PatchError::Radius { index, radius: radii[index] });
        }
        let attraction = Attraction::new(strength, length)?;
        let scale = last * last + 0.5 * (last * last - before * before);
        let all = discs * shells as f64;
        let jeans = super::jeans_time(strength.max(1.0 / all), all / (core::f64::consts::PI * scale));
        Ok(Self {
            attraction,
            pressure,
            squares,
            discs: vec![discs; shells],
            groups: Vec::new(),
            scale,
            time: 0.0,
            step: FIRST_STEP * jeans,
        })
    }

    /// The same of discs whose places are known, which do not attract themselves: one of a shell of m feels (m − 1)/2 of it.
    #[must_use]
    pub fn of_discs(mut self) -> Self {
        self.attraction.acts_on_itself = 0.0;
        self
    }

    /// The same with all periodic images in a box of `side` L (R0), on average over directions.
    ///
    /// # Errors
    /// [`AttractionError::Side`] unless the patch is narrower than L.
    pub fn periodic(self, side: f64) -> Result<Self, AttractionError> {
        let attraction = self.attraction.periodic(side, self.scale.sqrt())?;
        Ok(Self { attraction, ..self })
    }

    /// The same, the discs between each two radii (R0) being followed from now on.
    #[must_use]
    pub fn following(self, groups: &[(f64, f64)]) -> Self {
        // Shells with fractions within a radius: they are even up to the middles between them.
        let within = |radius: f64| {
            let square = radius * radius;
            let mut inner = 0.0;
            let mut count = 0.0;
            for (shell, own) in self.squares.iter().enumerate() {
                let outer = match (self.squares.get(shell + 1), shell.checked_sub(1)) {
                    (Some(next), _) => 0.5 * (own + next),
                    (None, Some(before)) => 1.5 * own - 0.5 * self.squares[before],
                    (None, None) => 2.0 * own,
                };
                count += ((square - inner) / (outer - inner)).clamp(0.0, 1.0);
                inner = outer;
            }
            count
        };
        let shares = |&(from, to): &(f64, f64)| {
            let (from, to) = (within(from), within(to));
            let share = |shell: usize| {
                let (inner, outer) = (shell as f64, shell as f64 + 1.0);
                (to.min(outer) - from.max(inner)).max(0.0)
            };
            (0..self.squares.len()).map(share).collect()
        };
        let groups = groups.iter().map(shares).collect();
        Self { groups, ..self }
    }

    /// The mean radii of the discs that are followed, R0; not a number for a group without discs.
    #[must_use]
    pub fn mean_radii(&self) -> Vec<f64> {
        let mean = |shares: &Vec<f64>| {
            let sum: f64 =
                shares.iter().zip(&self.squares).map(|(share, square)| share * square.sqrt()).sum();
            sum / shares.iter().sum::<f64>()
        };
        self.groups.iter().map(mean).collect()
    }

    /// Goes on to the `time` (R0²/D), exactly.
    ///
    /// # Errors
    /// [`EvolutionError::Time`] unless it is at or after [`Patch::time`]; [`EvolutionError::Stalled`] where shells meet, as
    /// without pressure and with that of an ideal gas they do.
    pub fn advance_to(&mut self, time: f64) -> Result<(), EvolutionError> {
        EvolutionError::check(time, self.time)?;
        while self.time < time {
            let left = time - self.time;
            let step = self.step.min(left);
            if self.time + step <= self.time {
                return Err(EvolutionError::Stalled { time: self.time });
            }
            let (next, error) = match self.tried(step) {
                Some(tried) => tried,
                None => {
                    self.step = SHORTEN * step;
                    continue;
                }
            };
            let factor = (0.9 * (TOLERANCE * self.scale / error.max(f64::MIN_POSITIVE)).sqrt())
                .clamp(SHORTEN, LENGTHEN);
            self.step =
                if step < left || factor < 1.0 { step * factor } else { self.step.max(step * factor) };
            if error > TOLERANCE * self.scale {
                continue;
            }
            self.squares = next;
            for group in &mut self.groups {
                mix(self.pressure, &self.squares, self.discs[0], step, group);
            }
            self.time = if step < left { self.time + step } else { time };
        }
        Ok(())
    }

    /// Squared radii after a step (R0²/D), and the estimated error of the largest; None if shells meet.
    fn tried(&self, step: f64) -> Option<(Vec<f64>, f64)> {
        let euler = |squares: &[f64], rates: &[f64], step: f64| {
            squeezed(self.pressure, squares, rates, self.discs[0], step)
        };
        let rates = self.rates(&self.squares);
        let whole = euler(&self.squares, &rates, step)?;
        let middle = euler(&self.squares, &rates, 0.5 * step)?;
        let halves = euler(&middle, &self.rates(&middle), 0.5 * step)?;
        let error =
            halves.iter().zip(&whole).map(|(halves, whole)| (halves - whole).abs()).fold(0.0, f64::max);
        let next: Vec<f64> = halves.iter().zip(&whole).map(|(halves, whole)| 2.0 * halves - whole).collect();
        apart(self.pressure, &next, self.discs[0]).then_some((next, error))
    }

    /// d(R²)/dt by the attraction.
    fn rates(&self, squares: &[f64]) -> Vec<f64> {
        let mut rates = Vec::with_capacity(squares.len());
        self.attraction.rates(squares, &self.discs, &mut rates);
        rates
    }

    /// The radii of the shells from the inside outwards, R0.
    #[must_use]
    pub fn radii(&self) -> Vec<f64> {
        self.squares.iter().map(|square| square.sqrt()).collect()
    }

    /// R0²/D
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }
}

#[cfg(test)]
mod tests;
