//! Plain arrays of four, for every processor.

use super::Lanes;
use core::array::from_fn;

/// Four numbers in an array.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

const WIDTH: usize = 4;

/// Up to four elements, zeros after them.
#[inline(always)]
fn load<T: Copy + Default>(from: &[T]) -> [T; WIDTH] {
    if let Some(whole) = from.first_chunk() {
        return *whole;
    }
    let mut array = [T::default(); WIDTH];
    for (place, &value) in array.iter_mut().zip(from) {
        *place = value;
    }
    array
}

#[inline(always)]
fn store<T: Copy>(values: [T; WIDTH], to: &mut [T]) {
    if let Some(whole) = to.first_chunk_mut() {
        *whole = values;
        return;
    }
    for (place, value) in to.iter_mut().zip(values) {
        *place = value;
    }
}

#[inline(always)]
fn each<A: Copy, B: Copy, C>(a: [A; WIDTH], b: [B; WIDTH], operation: impl Fn(A, B) -> C) -> [C; WIDTH] {
    from_fn(|lane| operation(a[lane], b[lane]))
}

#[inline(always)]
fn choose<T: Copy>(mask: [bool; WIDTH], yes: [T; WIDTH], no: [T; WIDTH]) -> [T; WIDTH] {
    from_fn(|lane| if mask[lane] { yes[lane] } else { no[lane] })
}

macro_rules! each_lane {
    ($($name:ident($a:ty, $b:ty) -> $c:ty = $operation:expr;)*) => { $(
        #[inline(always)]
        fn $name(self, a: [$a; WIDTH], b: [$b; WIDTH]) -> [$c; WIDTH] {
            each(a, b, $operation)
        }
    )* };
}

macro_rules! each_lane_shifted {
    ($($name:ident($a:ty) = $operation:expr;)*) => { $(
        #[inline(always)]
        fn $name(self, a: [$a; WIDTH], bits: u32) -> [$a; WIDTH] {
            a.map(|a| $operation(a, bits))
        }
    )* };
}

macro_rules! each_lane_alone {
    ($($name:ident($a:ty) -> $b:ty = $operation:expr;)*) => { $(
        #[inline(always)]
        fn $name(self, a: [$a; WIDTH]) -> [$b; WIDTH] {
            a.map($operation)
        }
    )* };
}

macro_rules! moved {
    ($($element:ty: $splat:ident, $load:ident, $store:ident;)*) => { $(
        #[inline(always)]
        fn $splat(self, value: $element) -> [$element; WIDTH] {
            [value; WIDTH]
        }

        #[inline(always)]
        fn $load(self, from: &[$element]) -> [$element; WIDTH] {
            load(from)
        }

        #[inline(always)]
        fn $store(self, value: [$element; WIDTH], to: &mut [$element]) {
            store(value, to);
        }
    )* };
}

impl Lanes for Portable {
    const WIDTH: usize = WIDTH;
    type F32 = [f32; WIDTH];
    type U32 = [u32; WIDTH];
    type U64 = [u64; WIDTH];
    type Mask = [bool; WIDTH];

    moved! {
        f32: splat, load_f32, store_f32;
        u32: splat_u32, load_u32, store_u32;
        u64: splat_u64, load_u64, store_u64;
    }

    each_lane! {
        add(f32, f32) -> f32 = |a, b| a + b;
        sub(f32, f32) -> f32 = |a, b| a - b;
        mul(f32, f32) -> f32 = |a, b| a * b;
        div(f32, f32) -> f32 = |a, b| a / b;
        less(f32, f32) -> bool = |a, b| a < b;
        add_u32(u32, u32) -> u32 = u32::wrapping_add;
        sub_u32(u32, u32) -> u32 = u32::wrapping_sub;
        mul_u32(u32, u32) -> u32 = u32::wrapping_mul;
        and(u32, u32) -> u32 = |a, b| a & b;
        xor(u32, u32) -> u32 = |a, b| a ^ b;
        equal(u32, u32) -> bool = |a, b| a == b;
        less_i32(u32, u32) -> bool = |a, b| (a as i32) < b as i32;
        both(bool, bool) -> bool = |a, b| a & b;
        either(bool, bool) -> bool = |a, b| a | b;
        add_u64(u64, u64) -> u64 = u64::wrapping_add;
        mul_u64(u64, u64) -> u64 = u64::wrapping_mul;
        xor_u64(u64, u64) -> u64 = |a, b| a ^ b;
        product(u32, u32) -> u64 = |a, b| u64::from(a) * u64::from(b);
    }

    each_lane_shifted! {
        shl(u32) = |a, bits| a << (bits & 31);
        shr(u32) = |a, bits| a >> (bits & 31);
        sar(u32) = |a, bits| (a as i32 >> (bits & 31)) as u32;
        shr_u64(u64) = |a, bits| a >> (bits & 63);
    }

    each_lane_alone! {
        to_bits(f32) -> u32 = f32::to_bits;
        of_bits(u32) -> f32 = f32::from_bits;
        of_i32(u32) -> f32 = |a| a as i32 as f32;
        of_u32(u32) -> f32 = |a| a as f32;
        round(f32) -> u32 = |a| meniscus_core::units::round_half_even(a) as u32;
        round_i64(f32) -> u64 = |a| meniscus_core::units::round_half_even(a) as u64;
        widen_i32(u32) -> u64 = |a| i64::from(a as i32) as u64;
        low(u64) -> u32 = |a| a as u32;
        high(u64) -> u32 = |a| (a >> 32) as u32;
    }

    #[inline(always)]
    fn select(self, mask: Self::Mask, yes: Self::F32, no: Self::F32) -> Self::F32 {
        choose(mask, yes, no)
    }

    #[inline(always)]
    fn select_u32(self, mask: Self::Mask, yes: Self::U32, no: Self::U32) -> Self::U32 {
        choose(mask, yes, no)
    }

    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u32 {
        mask.iter().rev().fold(0, |bits, &lane| bits << 1 | u32::from(lane))
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: Self::U32) -> Self::F32 {
        index.map(|index| table.get(index as usize).copied().unwrap_or(0.0))
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: Self::U32) -> Self::U32 {
        index.map(|index| table.get(index as usize).copied().unwrap_or(0))
    }
}
