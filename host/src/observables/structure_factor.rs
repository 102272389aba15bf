//! The static structure factor S(k) = |ρ̂_k|²/N, averaged over shells of width 2π/L.
//!
//! In: the box and positions. Out: S for each shell of wavenumbers (see [`waves`](super::waves)), a pure number: 1 for
//! discs that know nothing of each other, and for k → ∞. Shells of long waves are averaged over all their waves, larger
//! ones over a selection that is always the same ([`Waves::selected`]). Of more than [`SHELLS_KEPT`] shells only the first
//! half of that number are all taken, the others at ever larger distances, so that a large box costs what a small one does
//! per disc. k = 0, where |ρ̂|²/N = N, is left out.
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

/// Number of shells that are looked at: all up to half of it, beyond that in geometric progression.
pub const SHELLS_KEPT: u32 = 512;

/// Largest wavenumber of a run's table, R0⁻¹: beyond the peak for discs in contact, near 2π/2.2 R0.
pub const LARGEST_WAVENUMBER: f64 = 4.0;

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
        Ok(Self { waves: Waves::selected(kept(shells as u32), most), unit })
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

/// Of the shells 1 to `last` those that are looked at, in rising order, `last` among them.
fn kept(last: u32) -> impl Iterator<Item = u32> {
    let few = last <= SHELLS_KEPT;
    let (all, thinned) = if few { (last, 0) } else { (SHELLS_KEPT / 2, SHELLS_KEPT / 2) };
    let growth = libm::log(f64::from(last) / f64::from(all.max(1))) / f64::from(thinned.max(1));
    let number = move |place: u32| libm::round(f64::from(all) * libm::exp(growth * f64::from(place))) as u32;
    // Where neighbours lie less than a shell apart, rounding may name one twice.
    (1..=all).chain(
        (1..=thinned)
            .map(number)
            .scan(all, |before, shell| {
                let shell = shell.max(*before + 1);
                *before = shell;
                Some(shell)
            })
            .take_while(move |shell| *shell <= last),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_few_shells_all_are_kept_and_of_many_the_first_and_the_last() {
        for last in [1, 2, 318, SHELLS_KEPT] {
            assert!(kept(last).eq(1..=last), "{last}");
        }
        for last in [SHELLS_KEPT + 1, 600, 1000, 6366, MOST_SHELLS] {
            let shells: Vec<u32> = kept(last).collect();
            assert!(shells.len() <= SHELLS_KEPT as usize && shells.is_sorted_by(|a, b| a < b), "{last}");
            assert!(shells.starts_with(&(1..=SHELLS_KEPT / 2).collect::<Vec<_>>()), "{last}");
            assert_eq!(shells.last(), Some(&last));
            // Never a gap of more than a few per cent of k.
            assert!(
                shells.windows(2).all(|pair| f64::from(pair[1]) < 1.03 * f64::from(pair[0]) + 1.0),
                "{last}"
            );
        }
    }
}
