//! NEON: four numbers, on every 64-bit ARM.

use super::Lanes;
use super::moves::moves;
use core::arch::aarch64::*;

/// Four numbers in a register of 128 bits.
#[derive(Clone, Copy)]
pub struct Neon(());

impl Neon {
    /// The registers.
    ///
    /// # Safety
    /// The processor must have NEON.
    #[inline(always)]
    pub unsafe fn assume() -> Self {
        Self(())
    }
}

const WIDTH: usize = 4;

/// Methods that are one expression of instructions.
macro_rules! instructions {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty = $value:expr;)*) => { $(
        #[inline(always)]
        fn $name(self, $($argument: $type),*) -> $result {
            // SAFETY: `self` exists only where the processor has the instructions; none of these reads memory.
            unsafe { $value }
        }
    )* };
}

impl Lanes for Neon {
    const WIDTH: usize = WIDTH;
    type F32 = float32x4_t;
    type U32 = uint32x4_t;
    type U64 = [uint64x2_t; 2];
    type Mask = uint32x4_t;

    moves! {
        f32, float32x4_t: load_f32 = |from| vld1q_f32(from), store_f32 = |to, value| vst1q_f32(to, value);
        u32, uint32x4_t: load_u32 = |from| vld1q_u32(from), store_u32 = |to, value| vst1q_u32(to, value);
        u64, [uint64x2_t; 2]: load_u64 = |from| [vld1q_u64(from), vld1q_u64(from.add(2))],
            store_u64 = |to, value| {
                vst1q_u64(to, value[0]);
                vst1q_u64(to.add(2), value[1]);
            };
    }

    instructions! {
        splat(value: f32) -> float32x4_t = vdupq_n_f32(value);
        add(a: float32x4_t, b: float32x4_t) -> float32x4_t = vaddq_f32(a, b);
        sub(a: float32x4_t, b: float32x4_t) -> float32x4_t = vsubq_f32(a, b);
        mul(a: float32x4_t, b: float32x4_t) -> float32x4_t = vmulq_f32(a, b);
        div(a: float32x4_t, b: float32x4_t) -> float32x4_t = vdivq_f32(a, b);
        less(a: float32x4_t, b: float32x4_t) -> uint32x4_t = vcltq_f32(a, b);
        select(mask: uint32x4_t, yes: float32x4_t, no: float32x4_t) -> float32x4_t = vbslq_f32(mask, yes, no);
        splat_u32(value: u32) -> uint32x4_t = vdupq_n_u32(value);
        add_u32(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vaddq_u32(a, b);
        sub_u32(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vsubq_u32(a, b);
        mul_u32(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vmulq_u32(a, b);
        and(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vandq_u32(a, b);
        xor(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = veorq_u32(a, b);
        shl(a: uint32x4_t, bits: u32) -> uint32x4_t = vshlq_u32(a, vdupq_n_s32(bits as i32));
        shr(a: uint32x4_t, bits: u32) -> uint32x4_t = vshlq_u32(a, vdupq_n_s32(-(bits as i32)));
        sar(a: uint32x4_t, bits: u32) -> uint32x4_t =
            vreinterpretq_u32_s32(vshlq_s32(vreinterpretq_s32_u32(a), vdupq_n_s32(-(bits as i32))));
        equal(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vceqq_u32(a, b);
        less_i32(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t =
            vcltq_s32(vreinterpretq_s32_u32(a), vreinterpretq_s32_u32(b));
        less_u32(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vcltq_u32(a, b);
        select_u32(mask: uint32x4_t, yes: uint32x4_t, no: uint32x4_t) -> uint32x4_t = vbslq_u32(mask, yes, no);
        both(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vandq_u32(a, b);
        either(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t = vorrq_u32(a, b);
        to_bits(a: float32x4_t) -> uint32x4_t = vreinterpretq_u32_f32(a);
        of_bits(a: uint32x4_t) -> float32x4_t = vreinterpretq_f32_u32(a);
        of_i32(a: uint32x4_t) -> float32x4_t = vcvtq_f32_s32(vreinterpretq_s32_u32(a));
        of_u32(a: uint32x4_t) -> float32x4_t = vcvtq_f32_u32(a);
        abs(a: float32x4_t) -> float32x4_t = vabsq_f32(a);
        round(a: float32x4_t) -> uint32x4_t = vreinterpretq_u32_s32(vcvtnq_s32_f32(a));
        splat_u64(value: u64) -> [uint64x2_t; 2] = [vdupq_n_u64(value); 2];
        add_u64(a: [uint64x2_t; 2], b: [uint64x2_t; 2]) -> [uint64x2_t; 2] =
            [vaddq_u64(a[0], b[0]), vaddq_u64(a[1], b[1])];
        xor_u64(a: [uint64x2_t; 2], b: [uint64x2_t; 2]) -> [uint64x2_t; 2] =
            [veorq_u64(a[0], b[0]), veorq_u64(a[1], b[1])];
        shr_u64(a: [uint64x2_t; 2], bits: u32) -> [uint64x2_t; 2] = [
            vshlq_u64(a[0], vdupq_n_s64(-i64::from(bits))),
            vshlq_u64(a[1], vdupq_n_s64(-i64::from(bits))),
        ];
        product(a: uint32x4_t, b: uint32x4_t) -> [uint64x2_t; 2] =
            [vmull_u32(vget_low_u32(a), vget_low_u32(b)), vmull_high_u32(a, b)];
        widen_i32(a: uint32x4_t) -> [uint64x2_t; 2] = [
            vreinterpretq_u64_s64(vmovl_s32(vget_low_s32(vreinterpretq_s32_u32(a)))),
            vreinterpretq_u64_s64(vmovl_high_s32(vreinterpretq_s32_u32(a))),
        ];
        low(a: [uint64x2_t; 2]) -> uint32x4_t =
            vuzp1q_u32(vreinterpretq_u32_u64(a[0]), vreinterpretq_u32_u64(a[1]));
        high(a: [uint64x2_t; 2]) -> uint32x4_t =
            vuzp2q_u32(vreinterpretq_u32_u64(a[0]), vreinterpretq_u32_u64(a[1]));
    }

    #[inline(always)]
    fn bits(self, mask: uint32x4_t) -> u32 {
        const PLACES: [u32; WIDTH] = [1, 2, 4, 8];
        let places = self.and(mask, self.load_u32(&PLACES));
        // SAFETY: `self` says that NEON is there.
        unsafe { vaddvq_u32(places) }
    }

    #[inline(always)]
    fn mul_u64(self, a: [uint64x2_t; 2], b: [uint64x2_t; 2]) -> [uint64x2_t; 2] {
        let mut products = self.array_u64(a);
        for (a, b) in products.iter_mut().zip(self.array_u64(b)) {
            *a = a.wrapping_mul(b);
        }
        self.load_u64(&products)
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: uint32x4_t) -> float32x4_t {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0.0));
        self.load_f32(&[a, b, c, d])
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: uint32x4_t) -> uint32x4_t {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0));
        self.load_u32(&[a, b, c, d])
    }
}
