//! WebAssembly's registers of 128 bits: four numbers, in programs built with `simd128`.

use super::Lanes;
use super::moves::moves;
use core::arch::wasm32::*;

/// Four numbers in a register of 128 bits.
#[derive(Clone, Copy)]
pub struct Simd128(());

impl Simd128 {
    /// The registers.
    ///
    /// # Safety
    /// The processor must have `simd128`.
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
            $value
        }
    )* };
}

impl Lanes for Simd128 {
    const WIDTH: usize = WIDTH;
    type F32 = v128;
    type U32 = v128;
    type U64 = [v128; 2];
    type Mask = v128;

    moves! {
        f32, v128: load_f32 = |from| v128_load(from.cast()), store_f32 = |to, value| v128_store(to.cast(), value);
        u32, v128: load_u32 = |from| v128_load(from.cast()), store_u32 = |to, value| v128_store(to.cast(), value);
        u64, [v128; 2]: load_u64 = |from| [v128_load(from.cast()), v128_load(from.add(2).cast())],
            store_u64 = |to, value| {
                v128_store(to.cast(), value[0]);
                v128_store(to.add(2).cast(), value[1]);
            };
    }

    instructions! {
        splat(value: f32) -> v128 = f32x4_splat(value);
        add(a: v128, b: v128) -> v128 = f32x4_add(a, b);
        sub(a: v128, b: v128) -> v128 = f32x4_sub(a, b);
        mul(a: v128, b: v128) -> v128 = f32x4_mul(a, b);
        div(a: v128, b: v128) -> v128 = f32x4_div(a, b);
        less(a: v128, b: v128) -> v128 = f32x4_lt(a, b);
        select(mask: v128, yes: v128, no: v128) -> v128 = v128_bitselect(yes, no, mask);
        splat_u32(value: u32) -> v128 = u32x4_splat(value);
        add_u32(a: v128, b: v128) -> v128 = u32x4_add(a, b);
        sub_u32(a: v128, b: v128) -> v128 = u32x4_sub(a, b);
        mul_u32(a: v128, b: v128) -> v128 = u32x4_mul(a, b);
        and(a: v128, b: v128) -> v128 = v128_and(a, b);
        xor(a: v128, b: v128) -> v128 = v128_xor(a, b);
        shl(a: v128, bits: u32) -> v128 = u32x4_shl(a, bits);
        shr(a: v128, bits: u32) -> v128 = u32x4_shr(a, bits);
        sar(a: v128, bits: u32) -> v128 = i32x4_shr(a, bits);
        equal(a: v128, b: v128) -> v128 = u32x4_eq(a, b);
        less_i32(a: v128, b: v128) -> v128 = i32x4_lt(a, b);
        less_u32(a: v128, b: v128) -> v128 = u32x4_lt(a, b);
        select_u32(mask: v128, yes: v128, no: v128) -> v128 = v128_bitselect(yes, no, mask);
        both(a: v128, b: v128) -> v128 = v128_and(a, b);
        either(a: v128, b: v128) -> v128 = v128_or(a, b);
        bits(mask: v128) -> u32 = u32::from(u32x4_bitmask(mask));
        of_i32(a: v128) -> v128 = f32x4_convert_i32x4(a);
        of_u32(a: v128) -> v128 = f32x4_convert_u32x4(a);
        abs(a: v128) -> v128 = f32x4_abs(a);
        round(a: v128) -> v128 = i32x4_trunc_sat_f32x4(f32x4_nearest(a));
        splat_u64(value: u64) -> [v128; 2] = [u64x2_splat(value); 2];
        add_u64(a: [v128; 2], b: [v128; 2]) -> [v128; 2] = [u64x2_add(a[0], b[0]), u64x2_add(a[1], b[1])];
        mul_u64(a: [v128; 2], b: [v128; 2]) -> [v128; 2] = [u64x2_mul(a[0], b[0]), u64x2_mul(a[1], b[1])];
        xor_u64(a: [v128; 2], b: [v128; 2]) -> [v128; 2] = [v128_xor(a[0], b[0]), v128_xor(a[1], b[1])];
        shr_u64(a: [v128; 2], bits: u32) -> [v128; 2] = [u64x2_shr(a[0], bits), u64x2_shr(a[1], bits)];
        product(a: v128, b: v128) -> [v128; 2] = [u64x2_extmul_low_u32x4(a, b), u64x2_extmul_high_u32x4(a, b)];
        widen_i32(a: v128) -> [v128; 2] = [i64x2_extend_low_i32x4(a), i64x2_extend_high_i32x4(a)];
        low(a: [v128; 2]) -> v128 = u32x4_shuffle::<0, 2, 4, 6>(a[0], a[1]);
        high(a: [v128; 2]) -> v128 = u32x4_shuffle::<1, 3, 5, 7>(a[0], a[1]);
    }

    #[inline(always)]
    fn to_bits(self, a: v128) -> v128 {
        a
    }

    #[inline(always)]
    fn of_bits(self, a: v128) -> v128 {
        a
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: v128) -> v128 {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0.0));
        self.load_f32(&[a, b, c, d])
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: v128) -> v128 {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0));
        self.load_u32(&[a, b, c, d])
    }
}
