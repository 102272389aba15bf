//! Motion in lanes: the largest force, thermal noise, displacements and the move, with the bits of
//! [`meniscus_core::ermak`] and [`meniscus_core::noise`].
//!
//! ```
//! use meniscus_wide::lanes::Level;
//! use meniscus_wide::motion::Motion;
//!
//! let motion = Motion { level: Level::best(), pieces: 1 };
//! assert_eq!(motion.largest_force(&[300 << 24, 0], &[-(400 << 24), 0]), 500 << 24);
//! ```

mod displace;
mod displacement;
mod kick;
mod largest;

use crate::lanes::{Level, bits_of_fractions_mut, bits_of_i32, bits_of_i32_mut, bits_of_i64};
use crate::pieces::in_pieces;
use displace::Displace;
use displacement::FindDisplacements;
use kick::{Gaussian, NoKick, Uniform};
use largest::LargestSquare;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::parameters::Noise;
use meniscus_core::torus::Fraction;

/// By what means discs are moved.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// The registers to use.
    pub level: Level,
    /// In how many pieces to do the work; 1 for all of it here and now.
    pub pieces: usize,
}

impl Motion {
    /// As [`meniscus_core::ermak::largest_force`]: the largest modulus of the forces (`x`, `y`), rounded up to a unit of
    /// 2⁻²⁴ kBT/R0.
    #[must_use]
    pub fn largest_force(&self, x: &[i64], y: &[i64]) -> u64 {
        let work = LargestSquare { level: self.level, x: bits_of_i64(x), y: bits_of_i64(y) };
        let largest = in_pieces(work, self.pieces);
        let root = largest.isqrt();
        let rounded_up = if root * root < largest { root + 1 } else { root };
        u64::try_from(rounded_up).unwrap_or(u64::MAX)
    }

    /// The displacements of discs with these ids and forces (unit 2⁻²⁴ kBT/R0), as [`Displacement::of`] gives each, unit
    /// L·2⁻³².
    ///
    /// # Errors
    /// [`HalfBox`] if a component reaches half a box; `along_x` and `along_y` are then of no use.
    pub fn displacements(
        &self,
        step: &Displacement,
        ids: &[u32],
        (force_x, force_y): (&[i64], &[i64]),
        (along_x, along_y): (&mut [i32], &mut [i32]),
    ) -> Result<(), HalfBox> {
        let (level, step) = (self.level, *step);
        let (force_x, force_y) = (bits_of_i64(force_x), bits_of_i64(force_y));
        let (along_x, along_y) = (bits_of_i32_mut(along_x), bits_of_i32_mut(along_y));
        macro_rules! with {
            ($kick:expr) => {{
                let kick = $kick;
                let work = FindDisplacements { level, step, kick, ids, force_x, force_y, along_x, along_y };
                in_pieces(work, self.pieces)
            }};
        }
        match step.kick.noise() {
            Noise::Uniform => with!(Uniform(step.kick)),
            Noise::Gaussian => with!(Gaussian(step.kick)),
            Noise::None => with!(NoKick(step.kick)),
        }
    }

    /// As [`meniscus_core::ermak::displace`] for each disc: moves one coordinate of them by `units` of L·2⁻³² and counts
    /// the borders crossed.
    pub fn displace(&self, coordinates: &mut [Fraction], crossings: &mut [i32], units: &[i32]) {
        let coordinates = bits_of_fractions_mut(coordinates);
        let (crossings, units) = (bits_of_i32_mut(crossings), bits_of_i32(units));
        in_pieces(Displace { level: self.level, coordinates, crossings, units }, self.pieces);
    }
}
