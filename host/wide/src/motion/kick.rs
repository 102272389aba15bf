//! The thermal displacement of discs, the core's [`ThermalKick`] a disc a lane.

use crate::lanes::{LARGEST_WIDTH, Lanes};
use meniscus_core::noise::{GOLDEN_GAMMA, MULTIPLIERS, ThermalKick};

/// Where thermal displacements come from.
pub(super) trait Kick: Copy + Send + Sync {
    /// The displacements (x, y) of discs with these ids, R0.
    fn of<L: Lanes>(self, lanes: L, ids: &[u32]) -> (L::F32, L::F32);
}

/// A kick that is uniform.
#[derive(Clone, Copy)]
pub(super) struct Uniform(pub ThermalKick);

impl Kick for Uniform {
    #[inline(always)]
    fn of<L: Lanes>(self, lanes: L, ids: &[u32]) -> (L::F32, L::F32) {
        let bits = bits(lanes, self.0.key().state(), lanes.load_u32(ids));
        let width = lanes.splat(self.0.width());
        let (x, y) = (symmetric(lanes, lanes.high(bits)), symmetric(lanes, lanes.low(bits)));
        (lanes.mul(width, x), lanes.mul(width, y))
    }
}

/// A Gaussian kick: logarithm, sine and cosine are the core's, one by one.
#[derive(Clone, Copy)]
pub(super) struct Gaussian(pub ThermalKick);

impl Kick for Gaussian {
    #[inline(always)]
    fn of<L: Lanes>(self, lanes: L, ids: &[u32]) -> (L::F32, L::F32) {
        let (mut x, mut y) = ([0.0; LARGEST_WIDTH], [0.0; LARGEST_WIDTH]);
        for ((&id, x), y) in ids.iter().zip(&mut x).zip(&mut y) {
            (*x, *y) = self.0.displacement(id);
        }
        (lanes.load_f32(&x), lanes.load_f32(&y))
    }
}

/// No kick, whatever the id.
#[derive(Clone, Copy)]
pub(super) struct NoKick(pub ThermalKick);

impl Kick for NoKick {
    #[inline(always)]
    fn of<L: Lanes>(self, lanes: L, _: &[u32]) -> (L::F32, L::F32) {
        let (x, y) = self.0.displacement(0);
        (lanes.splat(x), lanes.splat(y))
    }
}

/// 64 random bits for each id, see [`meniscus_core::noise::StepKey::bits`].
#[inline(always)]
fn bits<L: Lanes>(lanes: L, state: u64, ids: L::U32) -> L::U64 {
    let steps = lanes.mul_u64(lanes.widen_u32(ids), lanes.splat_u64(GOLDEN_GAMMA));
    let bits = lanes.add_u64(steps, lanes.splat_u64(state.wrapping_add(GOLDEN_GAMMA)));
    let bits = lanes.mul_u64(folded(lanes, bits, 30), lanes.splat_u64(MULTIPLIERS[0]));
    let bits = lanes.mul_u64(folded(lanes, bits, 27), lanes.splat_u64(MULTIPLIERS[1]));
    folded(lanes, bits, 31)
}

/// The bits and the same shifted to the right, those in one of both.
#[inline(always)]
fn folded<L: Lanes>(lanes: L, bits: L::U64, shift: u32) -> L::U64 {
    lanes.xor_u64(bits, lanes.shr_u64(bits, shift))
}

/// Numbers uniform in (−1, 1) from the upper 24 of 32 bits: odd multiples of 2⁻²⁴.
#[inline(always)]
fn symmetric<L: Lanes>(lanes: L, bits: L::U32) -> L::F32 {
    const UNIT: f32 = 1.0 / 16_777_216.0;
    let twice = lanes.shl(lanes.shr(bits, 8), 1);
    let odd = lanes.sub_u32(twice, lanes.splat_u32((1 << 24) - 1));
    lanes.mul(lanes.of_i32(odd), lanes.splat(UNIT))
}
