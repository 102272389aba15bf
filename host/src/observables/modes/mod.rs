//! Density modes by shells, and how they have grown (Fig. 2).
//!
//! In: where the discs were at time zero and where they are. Out: for each shell of wavenumbers (see
//! [`waves`](super::waves)) the means over its waves of |ρ̂_k|, |ρ̂_k|² and ln(|ρ̂_k(t)|/|ρ̂_k(0)|), pure numbers; and in
//! [`growth`] the rates of Eq. 10 from the powers.
//!
//! ```
//! use meniscus::observables::modes::Modes;
//! use meniscus::start;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(620.0).unwrap();
//! let initial = start::random(&torus, 3844, 1).unwrap();
//! let modes = Modes::new(&torus, &initial, 8);
//! let shells = modes.of(&initial);
//! assert_eq!(shells.len(), 8);
//! assert_eq!(shells[0].shell, 1);
//! assert_eq!(shells[0].log_growth, Some(0.0));
//! ```

pub mod growth;

use core::f64::consts::TAU;

use super::waves::Waves;
use meniscus_core::torus::{Position, Torus};

/// |ρ̂_k|/N below which a mode counts as absent: far above rounding, far below the 1/N of a single disc.
const ABSENT: f64 = 1e-12;

/// The means over the waves of a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellModes {
    /// n, what |k|L/2π rounds to.
    pub shell: u32,
    /// The mean of |k|, R0⁻¹.
    pub wavenumber: f64,
    /// The mean of |ρ̂_k|, 0 to N.
    pub amplitude: f64,
    /// The mean of |ρ̂_k|², 0 to N².
    pub power: f64,
    /// The mean of ln(|ρ̂_k(t)|/|ρ̂_k(0)|); none where a mode is or was absent, as on a lattice.
    pub log_growth: Option<f64>,
}

/// The modes of the box and what they were at time zero.
#[derive(Clone, Debug)]
pub struct Modes {
    waves: Waves,
    /// 2π/L, R0⁻¹.
    unit: f64,
    /// Number of discs at time zero.
    initial_count: usize,
    /// |ρ̂_k(0)|²
    initial: Vec<f64>,
}

impl Modes {
    /// The modes of the shells 1 to `shells`, the discs being at `initial` at time zero.
    #[must_use]
    pub fn new(torus: &Torus, initial: &[Position], shells: u32) -> Self {
        let waves = Waves::of_shells(shells);
        let powers = waves.powers(initial);
        Self { waves, unit: TAU / torus.side(), initial_count: initial.len(), initial: powers }
    }

    /// The means over each shell, in rising order, with discs at `positions`.
    #[must_use]
    pub fn of(&self, positions: &[Position]) -> Vec<ShellModes> {
        let powers = self.waves.powers(positions);
        let present = |power: f64, count: usize| power.sqrt() > ABSENT * count as f64;
        self.waves
            .shells()
            .iter()
            .map(|shell| {
                let later = powers.get(shell.waves.clone()).unwrap_or_default();
                let initial = self.initial.get(shell.waves.clone()).unwrap_or_default();
                let count = later.len() as f64;
                let growth: Option<f64> = (later.iter().zip(initial))
                    .map(|(&later, &initial)| {
                        let both = present(later, positions.len()) && present(initial, self.initial_count);
                        both.then(|| 0.5 * libm::log(later / initial))
                    })
                    .sum();
                ShellModes {
                    shell: shell.number,
                    wavenumber: self.unit * shell.order,
                    amplitude: later.iter().map(|power| power.sqrt()).sum::<f64>() / count,
                    power: later.iter().sum::<f64>() / count,
                    log_growth: growth.map(|sum| sum / count),
                }
            })
            .collect()
    }
}
