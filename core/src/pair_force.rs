//! The force of a pair of discs: repulsion at contact and the near part of the capillary force, quantised as one.
//!
//! Along the separation d of the nearest images a disc is pushed away from the other by
//!
//! F(d) = F_rep(d) − f_i f_j V0·E(d²)/d
//!
//! with the [`crate::repulsion`], and the [`crate::near_part`] up to its cut-off; f are the discs' capillary strengths.
//! Below [`SMALLEST_DISTANCE`] the force is that at this distance; coinciding discs are parted along x, a repelled
//! one with the lower id to the right.
//!
//! A pair's force is quantised once and given to both discs with opposite signs, so that the sum over all discs
//! is exactly zero.
//!
//! ```
//! use meniscus_core::cells::Separation;
//! use meniscus_core::near_part::{fill_table, table_length};
//! use meniscus_core::pair_force::PairForce;
//! use meniscus_core::parameters::{Influence, Method, Parameters};
//! use meniscus_core::units::force_from_units;
//!
//! let split = Parameters {
//!     method: Method::P3m, influence: Influence::Optimal, capillary_strength: 1.0, splitting: 0.01, cutoff: 20.0,
//!     capillary_length: f64::INFINITY, repulsion: false, ..Parameters::default()
//! };
//! let mut table = [[0.0; 4]; table_length(20.0)];
//! fill_table(split.splitting, split.capillary_length, &mut table);
//! let force = PairForce::new(&split);
//! // 4 R0 apart, nearly all of V0/d is in the near part: the first disc is drawn to the left.
//! let (x, y) = force.of(Separation { x: 1 << 28, y: 0 }, true, PairForce::EQUAL, &table).unwrap();
//! assert!((force_from_units(x) + 0.25).abs() < 1e-3 && y == 0);
//! ```

use crate::cells::Separation;
use crate::near_part::{self, Segment};
use crate::parameters::{Method, Parameters};
use crate::repulsion::{self, CUTOFF_SQUARED, SMALLEST_DISTANCE};
use crate::torus::UNITS;
use crate::units::{FORCE_UNITS, round_half_even};

/// The pair force of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairForce {
    /// Unit L·2⁻³²; 0 if pairs exert no force at all.
    reach: u32,
    /// R0 in a unit of separation.
    unit: f32,
    /// Square of the larger cut-off, R0².
    reach_squared: f32,
    /// Square of the cut-off of the repulsion, R0²; 0 without.
    repulsion_squared: f32,
    /// Square of the cut-off of the near part, R0²; 0 without.
    near_squared: f32,
    /// V0, kBT.
    strength: f32,
}

impl PairForce {
    /// The product of the strengths of two discs of strength 1.
    pub const EQUAL: f32 = 1.0;

    /// The square of [`SMALLEST_DISTANCE`], R0².
    pub const SMALLEST_SQUARED: f32 = (SMALLEST_DISTANCE * SMALLEST_DISTANCE) as f32;

    /// The pair force of valid parameters.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let near = near_cutoff(parameters);
        let repels = parameters.repulsion;
        let cutoff = if repels && near < repulsion::CUTOFF { repulsion::CUTOFF } else { near };
        let near_squared = (near * near) as f32;
        let repulsion_squared = if repels { CUTOFF_SQUARED } else { 0.0 };
        Self {
            // Half a box is farther than any cut-off, even where rounding up makes them one.
            reach: (libm::ceil(cutoff / parameters.side * UNITS) as u32).min(i32::MAX as u32),
            unit: (parameters.side / UNITS) as f32,
            reach_squared: if near_squared > repulsion_squared { near_squared } else { repulsion_squared },
            repulsion_squared,
            near_squared,
            strength: parameters.capillary_strength as f32,
        }
    }

    /// The repulsion alone, in a box of side `side` (R0) above twice its cut-off.
    #[must_use]
    pub fn repulsion(side: f64) -> Self {
        Self::new(&Parameters { side, capillary_strength: 0.0, ..Parameters::PAPER })
    }

    /// For statics; of no use before it is replaced.
    pub(crate) const fn blank() -> Self {
        Self {
            reach: 0,
            unit: 0.0,
            reach_squared: 0.0,
            repulsion_squared: 0.0,
            near_squared: 0.0,
            strength: 0.0,
        }
    }

    /// The larger cut-off in units of L·2⁻³², rounded up; 0 if pairs exert no force at all.
    #[must_use]
    pub fn reach(&self) -> u32 {
        self.reach
    }

    /// R0 in a unit of separation.
    #[must_use]
    pub fn unit(&self) -> f32 {
        self.unit
    }

    /// The square of the larger cut-off, R0².
    #[must_use]
    pub fn cutoff_squared(&self) -> f32 {
        self.reach_squared
    }

    /// The square of the cut-off of the repulsion, R0²; 0 without repulsion.
    #[must_use]
    pub fn repulsion_squared(&self) -> f32 {
        self.repulsion_squared
    }

    /// The square of the cut-off of the near part, R0²; 0 without a near part.
    #[must_use]
    pub fn near_squared(&self) -> f32 {
        self.near_squared
    }

    /// V0, kBT.
    #[must_use]
    pub fn strength(&self) -> f32 {
        self.strength
    }

    /// The force on the first disc of a pair, unit 2⁻²⁴ kBT/R0; `None` at or beyond the cut-off.
    ///
    /// The force on the second is the negative, bit for bit the same as with the discs exchanged.
    /// `first_is_lower` says whether the first disc has the lower id; `strengths` is the product f_i f_j, see
    /// [`product_of_strengths`]; `table` is the one of the near part.
    #[inline]
    #[must_use]
    pub fn of(
        &self,
        separation: Separation,
        first_is_lower: bool,
        strengths: f32,
        table: &[Segment],
    ) -> Option<(i64, i64)> {
        let (x, y) = (separation.x as f32 * self.unit, separation.y as f32 * self.unit);
        let squared = x * x + y * y;
        if squared >= self.reach_squared {
            return None;
        }
        if squared >= Self::SMALLEST_SQUARED {
            let factor = self.over_distance(squared, strengths, table);
            return Some((quantise(factor * x), quantise(factor * y)));
        }
        let force = self.over_distance(Self::SMALLEST_SQUARED, strengths, table) * SMALLEST_DISTANCE as f32;
        let distance = libm::sqrtf(squared);
        if distance > 0.0 {
            return Some((quantise(force * (x / distance)), quantise(force * (y / distance))));
        }
        let along_x = quantise(force);
        Some((if first_is_lower { along_x } else { -along_x }, 0))
    }

    /// F(d)/d from d² (R0²), kBT/R0².
    #[inline]
    fn over_distance(&self, squared: f32, strengths: f32, table: &[Segment]) -> f32 {
        let repulsion =
            if squared < self.repulsion_squared { repulsion::force_over_distance(squared) } else { 0.0 };
        if squared < self.near_squared {
            let attraction = self.strength * strengths / squared;
            repulsion - attraction * near_part::evaluate(table, squared)
        } else {
            repulsion
        }
    }
}

/// The cut-off of the near part, R0; 0 if there is none.
#[must_use]
pub const fn near_cutoff(parameters: &Parameters) -> f64 {
    if matches!(parameters.method, Method::P3m) && parameters.capillary_strength > 0.0 {
        parameters.cutoff
    } else {
        0.0
    }
}

/// The product f_i f_j of two strengths of unit 2⁻²⁰, rounded to binary32 once.
#[must_use]
pub fn product_of_strengths(first: i32, second: i32) -> f32 {
    const UNIT: f32 = 1.0 / (1_u64 << 40) as f32;
    (i64::from(first) * i64::from(second)) as f32 * UNIT
}

fn quantise(force: f32) -> i64 {
    round_half_even(force * FORCE_UNITS)
}
