//! The static structure factor S(k) = |ρ̂_k|²/N, averaged over shells of width 2π/L.
//!
//! In: the box and positions. Out: S for each shell of wavenumbers (see [`waves`](super::waves)), a pure number: 1 for
//! discs that know nothing of each other, and for k → ∞. Shells of long waves are averaged over all their waves, larger
//! ones over a selection that is always the same ([`Waves::selected`]). k = 0, where |ρ̂|²/N = N, is left out.
//!
//! ```
//! use meniscus::observables::structure_factor::{StructureFactor, WAVES_PER_SHELL};
//! use meniscus::start;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(100.0).unwrap();
//! let positions = start::square_lattice(400).unwrap();
//! // A lattice of spacing 5 R0 scatters first at k = 2π/5 = 1.257 R0⁻¹.
//! let shells = StructureFactor::new(&torus, 1.3, WAVES_PER_SHELL).unwrap().of(&positions);
//! let largest = shells.iter().max_by(|a, b| a.structure_factor.total_cmp(&b.structure_factor)).unwrap();
//! assert!((largest.wavenumber - 1.257).abs() < 0.01);
//! ```

use core::f64::consts::TAU;

use super::waves::Waves;
use meniscus_core::torus::{Position, Torus};

/// Number of waves a shell that leaves of the scatter of S, which is S itself for one wave, a tenth.
pub const WAVES_PER_SHELL: usize = 100;

/// Number of shells beyond which a largest wavenumber is refused.
pub const MOST_SHELLS: u32 = 1 << 16;

/// S of a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellFactor {
    /// n, what |k|L/2π rounds to.
    pub shell: u32,
    /// The mean of |k| over the waves, R0⁻¹.
    pub wavenumber: f64,
    /// The mean of |ρ̂_k|²/N over the waves.
    pub structure_factor: f64,
}

/// Why a structure factor is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StructureFactorError {
    /// No shell, or too many.
    #[error(
        "a structure factor up to k = {largest} R0^-1 was asked for: the longest wave of the box has k = {unit} R0^-1, take \
         k from there to {MOST_SHELLS} times that"
    )]
    Wavenumber {
        /// The wavenumber asked for, R0⁻¹.
        largest: f64,
        /// 2π/L, R0⁻¹.
        unit: f64,
    },
    /// No waves to average over.
    #[error("a structure factor of 0 waves a shell was asked for: take at least 1")]
    NoWaves,
}

/// What the structure factor is computed with, set up once.
#[derive(Clone, Debug)]
pub struct StructureFactor {
    waves: Waves,
    /// 2π/L, R0⁻¹.
    unit: f64,
}

impl StructureFactor {
    /// The shells up to k = `largest` (R0⁻¹), of each at most about `most` waves.
    ///
    /// # Errors
    /// [`StructureFactorError::Wavenumber`] unless 2π/L ≤ `largest` ≤ 2π/L·[`MOST_SHELLS`];
    /// [`StructureFactorError::NoWaves`] for `most` = 0.
    pub fn new(torus: &Torus, largest: f64, most: usize) -> Result<Self, StructureFactorError> {
        let unit = TAU / torus.side();
        let shells = libm::floor(largest / unit);
        if !(shells >= 1.0 && shells <= f64::from(MOST_SHELLS)) {
            return Err(StructureFactorError::Wavenumber { largest, unit });
        }
        if most == 0 {
            return Err(StructureFactorError::NoWaves);
        }
        Ok(Self { waves: Waves::selected(shells as u32, most), unit })
    }

    /// S of each shell, in rising order, with discs at `positions`; empty without discs.
    #[must_use]
    pub fn of(&self, positions: &[Position]) -> Vec<ShellFactor> {
        if positions.is_empty() {
            return Vec::new();
        }
        let powers = self.waves.powers(positions);
        self.waves
            .shells()
            .iter()
            .map(|shell| {
                let powers = powers.get(shell.waves.clone()).unwrap_or_default();
                let mean = powers.iter().sum::<f64>() / powers.len() as f64;
                ShellFactor {
                    shell: shell.number,
                    wavenumber: self.unit * shell.order,
                    structure_factor: mean / positions.len() as f64,
                }
            })
            .collect()
    }
}
