//! The radial distribution function g(r): how many pairs of discs are at a distance, over how many would be if discs knew
//! nothing of each other.
//!
//! In: the box and positions. Out: g in bins of equal width, a pure number. A bin from r to r + w expects of N discs
//! ½N(N − 1)·π[(r + w)² − r²]/L² pairs, since each disc has N − 1 others in the box: an ideal gas has g = 1 on average
//! exactly, of any N. (Programs that put N² there find 1 − 1/N.)
//!
//! Distances are those of nearest images and are compared with the borders of bins as integers.
//!
//! ```
//! use meniscus::observables::radial_distribution::RadialDistribution;
//! use meniscus::start;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(100.0).unwrap();
//! let discs = start::random(&torus, 300, 1).unwrap();
//! let bins = RadialDistribution::new(&torus, 10.0, 0.5).unwrap().of(&discs);
//! assert_eq!(bins.len(), 20);
//! assert_eq!((bins[3].distance, bins[3].g), (1.75, 0.0), "no two discs overlap");
//! ```

use core::f64::consts::PI;

use super::neighbours::Neighbours;
use meniscus_core::torus::{Position, Torus, UNITS};

/// Number of bins beyond which a width is refused.
pub const MOST_BINS: usize = 1 << 20;

/// g in a bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The middle of the bin, R0.
    pub distance: f64,
    /// The number of pairs in it.
    pub pairs: u64,
    /// g; 0 with fewer than two discs.
    pub g: f64,
}

/// Why a radial distribution is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RadialDistributionError {
    /// A largest distance that nearest images do not have.
    #[error("distances up to {largest} R0 were asked for: take more than 0 and at most L/2 = {most} R0")]
    Largest {
        /// The distance asked for, R0.
        largest: f64,
        /// Half the side, R0.
        most: f64,
    },
    /// Bins without width, or too many of them, or none.
    #[error(
        "bins {width} R0 wide were asked for: take a width from {least} R0 to the largest distance, {largest} R0"
    )]
    Width {
        /// The width asked for, R0.
        width: f64,
        /// The smallest width, R0.
        least: f64,
        /// The largest distance, R0.
        largest: f64,
    },
}

/// The bins of a radial distribution function.
#[derive(Clone, Debug)]
pub struct RadialDistribution {
    torus: Torus,
    width: f64,
    /// The end of each bin, squared: the least squared distance beyond it, unit (L·2⁻³²)².
    ends: Vec<u64>,
}

impl RadialDistribution {
    /// Bins of `width` (R0) from 0 on, as many as end at `largest` (R0) or before.
    ///
    /// # Errors
    /// [`RadialDistributionError::Largest`] unless 0 < `largest` ≤ L/2; [`RadialDistributionError::Width`] unless
    /// there is at least one bin and at most [`MOST_BINS`].
    pub fn new(torus: &Torus, largest: f64, width: f64) -> Result<Self, RadialDistributionError> {
        let most = torus.side() / 2.0;
        if !(largest > 0.0 && largest <= most) {
            return Err(RadialDistributionError::Largest { largest, most });
        }
        let least = largest / MOST_BINS as f64;
        if !(width >= least && width <= largest) {
            return Err(RadialDistributionError::Width { width, least, largest });
        }
        // A quotient like 10/0.1 may be a rounding error below the whole number that is meant.
        let bins = libm::floor(largest / width * (1.0 + 1e-12)) as usize;
        let end = |bin: usize| {
            let units = (width * bin as f64).min(largest) / torus.side() * UNITS;
            libm::ceil(units * units) as u64
        };
        Ok(Self { torus: *torus, width, ends: (1..=bins).map(end).collect() })
    }

    /// g in each bin, with discs at `positions`.
    #[must_use]
    pub fn of(&self, positions: &[Position]) -> Vec<Bin> {
        let pairs = self.pairs(positions);
        let count = positions.len() as f64;
        let density_of_pairs = 0.5 * count * (count - 1.0) / (self.torus.side() * self.torus.side());
        (pairs.into_iter().enumerate())
            .map(|(bin, pairs)| {
                let bin = bin as f64;
                let area = PI * self.width * self.width * (2.0 * bin + 1.0);
                let g = if pairs == 0 { 0.0 } else { pairs as f64 / (density_of_pairs * area) };
                Bin { distance: self.width * (bin + 0.5), pairs, g }
            })
            .collect()
    }

    /// The number of pairs in each bin.
    fn pairs(&self, positions: &[Position]) -> Vec<u64> {
        let mut pairs = vec![0; self.ends.len()];
        let reach = self.width * self.ends.len() as f64;
        let neighbours = Neighbours::new(&self.torus, positions, reach);
        for (position, id) in positions.iter().zip(0_u32..) {
            for other in neighbours.near(*position).filter(|other| other.id < id) {
                let bin = self.ends.partition_point(|end| *end <= other.square);
                if let Some(pairs) = pairs.get_mut(bin) {
                    *pairs += 1;
                }
            }
        }
        pairs
    }
}
