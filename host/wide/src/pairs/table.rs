//! The table of the near part as lanes read it.

use crate::lanes::{LARGEST_WIDTH, Lanes};
use meniscus_core::near_part::{FIRST, FRACTION_BITS, Segment};

/// The length of a table that fits registers of sixteen numbers.
const SHORT: usize = 64;

/// The table of the near part twice: as it is, and its last segments coefficient by coefficient.
#[derive(Clone, Debug)]
pub(super) struct Table {
    segments: Vec<Segment>,
    coefficients: [[f32; SHORT]; 4],
    /// The first of the last segments.
    first: u32,
}

impl Table {
    /// The table for a cut-off with square `cutoff_squared` (R0²; 0 without a near part).
    pub(super) fn new(segments: &[Segment], cutoff_squared: f32) -> Self {
        let length = match cutoff_squared.to_bits().checked_sub(FIRST.to_bits()) {
            Some(bits) => (bits >> FRACTION_BITS) as usize + 1,
            None => 0,
        };
        let mut segments = segments.to_vec();
        // Beyond its end a table is zero.
        segments.resize(length, [0.0; 4]);
        let first = segments.len().saturating_sub(SHORT);
        let mut coefficients = [[0.0; SHORT]; 4];
        for (index, segment) in segments.iter().enumerate().skip(first) {
            for (coefficients, &coefficient) in coefficients.iter_mut().zip(segment) {
                coefficients[index % SHORT] = coefficient;
            }
        }
        Self { segments, coefficients, first: first as u32 }
    }

    pub(super) fn segments(&self) -> &[Segment] {
        &self.segments
    }

    pub(super) fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Whether lanes of this width read the last segments only.
    #[inline(always)]
    fn is_short(&self, width: usize) -> bool {
        // Longer ones begin where discs often are.
        width == LARGEST_WIDTH && self.segments.len() <= SHORT + 24
    }

    /// The square of the distance from which lanes of this width can evaluate the table, R0².
    #[inline(always)]
    pub(super) fn begin(&self, width: usize) -> f32 {
        if self.is_short(width) {
            f32::from_bits(FIRST.to_bits() + (self.first << FRACTION_BITS))
        } else {
            FIRST
        }
    }

    /// [`meniscus_core::near_part::evaluate`] from [`Table::begin`] to the table's end; elsewhere anything.
    #[inline(always)]
    pub(super) fn evaluate<L: Lanes>(&self, lanes: L, squared: L::F32) -> L::F32 {
        const UNIT: f32 = 1.0 / (1_u32 << FRACTION_BITS) as f32;
        let bits = lanes.sub_u32(lanes.to_bits(squared), lanes.splat_u32(FIRST.to_bits()));
        let index = lanes.shr(bits, FRACTION_BITS);
        let [constant, linear, quadratic, cubic] = if self.is_short(L::WIDTH) {
            let [constant, linear, quadratic, cubic] = &self.coefficients;
            [
                lanes.look_up(constant, index),
                lanes.look_up(linear, index),
                lanes.look_up(quadratic, index),
                lanes.look_up(cubic, index),
            ]
        } else {
            let [coefficients] = lanes.gather_runs(self.segments.as_flattened(), lanes.shl(index, 2));
            coefficients
        };
        let fraction = lanes.and(bits, lanes.splat_u32((1 << FRACTION_BITS) - 1));
        let fraction = lanes.mul(lanes.of_i32(fraction), lanes.splat(UNIT));
        let sum = lanes.add(lanes.mul(cubic, fraction), quadratic);
        let sum = lanes.add(lanes.mul(sum, fraction), linear);
        lanes.add(lanes.mul(sum, fraction), constant)
    }
}
