//! SSE2: four numbers, on every x86-64.

use super::{Lanes, Sixteen};
use core::arch::x86_64::*;

/// Four numbers in a register of 128 bits.
#[derive(Clone, Copy)]
pub struct Sse2(());

impl Sse2 {
    /// The registers.
    ///
    /// # Safety
    /// The processor must have SSE2.
    #[inline(always)]
    pub unsafe fn assume() -> Self {
        Self(())
    }
}

const WIDTH: usize = 4;

/// Up to the width of elements, zeros after them.
#[cold]
fn part<T: Copy + Default>(from: &[T]) -> [T; WIDTH] {
    let mut array = [T::default(); WIDTH];
    for (place, &value) in array.iter_mut().zip(from) {
        *place = value;
    }
    array
}

#[cold]
fn store_part<T: Copy>(values: [T; WIDTH], to: &mut [T]) {
    for (place, value) in to.iter_mut().zip(values) {
        *place = value;
    }
}

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

impl Lanes for Sse2 {
    const WIDTH: usize = WIDTH;
    type F32 = __m128;
    type U32 = __m128i;
    type U64 = [__m128i; 2];
    type Mask = __m128i;

    instructions! {
        splat(value: f32) -> __m128 = _mm_set1_ps(value);
        add(a: __m128, b: __m128) -> __m128 = _mm_add_ps(a, b);
        sub(a: __m128, b: __m128) -> __m128 = _mm_sub_ps(a, b);
        mul(a: __m128, b: __m128) -> __m128 = _mm_mul_ps(a, b);
        div(a: __m128, b: __m128) -> __m128 = _mm_div_ps(a, b);
        sqrt(a: __m128) -> __m128 = _mm_sqrt_ps(a);
        less(a: __m128, b: __m128) -> __m128i = _mm_castps_si128(_mm_cmplt_ps(a, b));
        splat_u32(value: u32) -> __m128i = _mm_set1_epi32(value as i32);
        add_u32(a: __m128i, b: __m128i) -> __m128i = _mm_add_epi32(a, b);
        sub_u32(a: __m128i, b: __m128i) -> __m128i = _mm_sub_epi32(a, b);
        and(a: __m128i, b: __m128i) -> __m128i = _mm_and_si128(a, b);
        or(a: __m128i, b: __m128i) -> __m128i = _mm_or_si128(a, b);
        xor(a: __m128i, b: __m128i) -> __m128i = _mm_xor_si128(a, b);
        shl(a: __m128i, bits: u32) -> __m128i = _mm_sll_epi32(a, _mm_cvtsi32_si128(bits as i32));
        shr(a: __m128i, bits: u32) -> __m128i = _mm_srl_epi32(a, _mm_cvtsi32_si128(bits as i32));
        sar(a: __m128i, bits: u32) -> __m128i = _mm_sra_epi32(a, _mm_cvtsi32_si128(bits as i32));
        equal(a: __m128i, b: __m128i) -> __m128i = _mm_cmpeq_epi32(a, b);
        less_i32(a: __m128i, b: __m128i) -> __m128i = _mm_cmplt_epi32(a, b);
        both(a: __m128i, b: __m128i) -> __m128i = _mm_and_si128(a, b);
        either(a: __m128i, b: __m128i) -> __m128i = _mm_or_si128(a, b);
        bits(mask: __m128i) -> u32 = _mm_movemask_ps(_mm_castsi128_ps(mask)) as u32;
        to_bits(a: __m128) -> __m128i = _mm_castps_si128(a);
        of_bits(a: __m128i) -> __m128 = _mm_castsi128_ps(a);
        of_i32(a: __m128i) -> __m128 = _mm_cvtepi32_ps(a);
        round(a: __m128) -> __m128i = _mm_cvtps_epi32(a);
        splat_u64(value: u64) -> [__m128i; 2] = [_mm_set1_epi64x(value as i64); 2];
        add_u64(a: [__m128i; 2], b: [__m128i; 2]) -> [__m128i; 2] =
            [_mm_add_epi64(a[0], b[0]), _mm_add_epi64(a[1], b[1])];
        sub_u64(a: [__m128i; 2], b: [__m128i; 2]) -> [__m128i; 2] =
            [_mm_sub_epi64(a[0], b[0]), _mm_sub_epi64(a[1], b[1])];
        xor_u64(a: [__m128i; 2], b: [__m128i; 2]) -> [__m128i; 2] =
            [_mm_xor_si128(a[0], b[0]), _mm_xor_si128(a[1], b[1])];
        product(a: __m128i, b: __m128i) -> [__m128i; 2] = [
            _mm_mul_epu32(_mm_unpacklo_epi32(a, a), _mm_unpacklo_epi32(b, b)),
            _mm_mul_epu32(_mm_unpackhi_epi32(a, a), _mm_unpackhi_epi32(b, b)),
        ];
        low(a: [__m128i; 2]) -> __m128i =
            _mm_castps_si128(_mm_shuffle_ps::<0b10_00_10_00>(_mm_castsi128_ps(a[0]), _mm_castsi128_ps(a[1])));
        high(a: [__m128i; 2]) -> __m128i =
            _mm_castps_si128(_mm_shuffle_ps::<0b11_01_11_01>(_mm_castsi128_ps(a[0]), _mm_castsi128_ps(a[1])));
    }

    #[inline(always)]
    fn mul_u32(self, a: __m128i, b: __m128i) -> __m128i {
        self.low(self.product(a, b))
    }

    #[inline(always)]
    fn mul_u64(self, a: [__m128i; 2], b: [__m128i; 2]) -> [__m128i; 2] {
        [multiply(a[0], b[0]), multiply(a[1], b[1])]
    }

    #[inline(always)]
    fn shr_u64(self, a: [__m128i; 2], bits: u32) -> [__m128i; 2] {
        // SAFETY: SSE2 is there.
        a.map(|a| unsafe { _mm_srl_epi64(a, _mm_cvtsi32_si128(bits as i32)) })
    }

    #[inline(always)]
    fn widen_i32(self, a: __m128i) -> [__m128i; 2] {
        let sign = self.sar(a, 31);
        // SAFETY: SSE2 is there.
        unsafe { [_mm_unpacklo_epi32(a, sign), _mm_unpackhi_epi32(a, sign)] }
    }

    #[inline(always)]
    fn sum_u64(self, a: [__m128i; 2]) -> u64 {
        // SAFETY: SSE2 is there.
        unsafe {
            let sum = _mm_add_epi64(a[0], a[1]);
            _mm_cvtsi128_si64(_mm_add_epi64(sum, _mm_unpackhi_epi64(sum, sum))) as u64
        }
    }

    #[inline(always)]
    fn select(self, mask: __m128i, yes: __m128, no: __m128) -> __m128 {
        self.of_bits(self.select_u32(mask, self.to_bits(yes), self.to_bits(no)))
    }

    #[inline(always)]
    fn select_u32(self, mask: __m128i, yes: __m128i, no: __m128i) -> __m128i {
        // SAFETY: SSE2 is there.
        unsafe { _mm_or_si128(_mm_and_si128(mask, yes), _mm_andnot_si128(mask, no)) }
    }

    #[inline(always)]
    fn load_f32(self, from: &[f32]) -> __m128 {
        let part;
        let whole = if let Some(whole) = from.first_chunk() {
            whole
        } else {
            part = self::part(from);
            &part
        };
        let whole: &[f32; WIDTH] = whole;
        // SAFETY: SSE2 is there, and the array has four elements; they need not be aligned.
        unsafe { _mm_loadu_ps(whole.as_ptr()) }
    }

    #[inline(always)]
    fn store_f32(self, value: __m128, to: &mut [f32]) {
        if let Some(whole) = to.first_chunk_mut::<WIDTH>() {
            // SAFETY: SSE2 is there, and the array has four elements; they need not be aligned.
            unsafe { _mm_storeu_ps(whole.as_mut_ptr(), value) }
        } else {
            let mut array = [0.0; WIDTH];
            // SAFETY: as above.
            unsafe { _mm_storeu_ps(array.as_mut_ptr(), value) }
            store_part(array, to);
        }
    }

    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> __m128i {
        let part;
        let whole = if let Some(whole) = from.first_chunk() {
            whole
        } else {
            part = self::part(from);
            &part
        };
        let whole: &[u32; WIDTH] = whole;
        // SAFETY: SSE2 is there, and the array has four elements; they need not be aligned.
        unsafe { _mm_loadu_si128(whole.as_ptr().cast()) }
    }

    #[inline(always)]
    fn store_u32(self, value: __m128i, to: &mut [u32]) {
        if let Some(whole) = to.first_chunk_mut::<WIDTH>() {
            // SAFETY: SSE2 is there, and the array has four elements; they need not be aligned.
            unsafe { _mm_storeu_si128(whole.as_mut_ptr().cast(), value) }
        } else {
            let mut array = [0; WIDTH];
            // SAFETY: as above.
            unsafe { _mm_storeu_si128(array.as_mut_ptr().cast(), value) }
            store_part(array, to);
        }
    }

    #[inline(always)]
    fn load_u64(self, from: &[u64]) -> [__m128i; 2] {
        let part;
        let whole = if let Some(whole) = from.first_chunk() {
            whole
        } else {
            part = self::part(from);
            &part
        };
        let whole: &[u64; WIDTH] = whole;
        let first = whole.as_ptr();
        // SAFETY: SSE2 is there, and the array has four elements, two a register; they need not be aligned.
        unsafe { [_mm_loadu_si128(first.cast()), _mm_loadu_si128(first.add(2).cast())] }
    }

    #[inline(always)]
    fn store_u64(self, value: [__m128i; 2], to: &mut [u64]) {
        if let Some(whole) = to.first_chunk_mut::<WIDTH>() {
            let first = whole.as_mut_ptr();
            // SAFETY: SSE2 is there, and the array has four elements, two a register; they need not be aligned.
            unsafe {
                _mm_storeu_si128(first.cast(), value[0]);
                _mm_storeu_si128(first.add(2).cast(), value[1]);
            }
        } else {
            let mut array = [0; WIDTH];
            let first = array.as_mut_ptr();
            // SAFETY: as above.
            unsafe {
                _mm_storeu_si128(first.cast(), value[0]);
                _mm_storeu_si128(first.add(2).cast(), value[1]);
            }
            store_part(array, to);
        }
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: __m128i) -> __m128 {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0.0));
        self.load_f32(&[a, b, c, d])
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: __m128i) -> __m128i {
        let [a, b, c, d, ..] =
            self.array_u32(index).map(|index| table.get(index as usize).copied().unwrap_or(0));
        self.load_u32(&[a, b, c, d])
    }

    #[inline(always)]
    fn interleave(self, a: __m128, b: __m128) -> (__m128, __m128) {
        // SAFETY: SSE2 is there.
        unsafe { (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b)) }
    }

    #[inline(always)]
    fn mirrored(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> __m128 {
        // SAFETY: SSE2 is there; elements 12 … 15 or 13 − part … 16 − part of sixteen are read.
        unsafe {
            if part == 0 {
                let rest = _mm_loadu_ps(rest.as_ptr().add(12));
                _mm_move_ss(_mm_shuffle_ps::<0b01_10_11_00>(rest, rest), _mm_loadu_ps(first.as_ptr()))
            } else {
                let rest = _mm_loadu_ps(rest.as_ptr().add(13 - (part & 12)));
                _mm_shuffle_ps::<0b00_01_10_11>(rest, rest)
            }
        }
    }

    #[inline(always)]
    fn transpose(self, from: &[Sixteen; 16], to: &mut [Sixteen; 16]) {
        // SAFETY: SSE2 is there; a block has 32 numbers, of which four from a multiple of four are read or written.
        unsafe {
            for row in [0, 4, 8, 12] {
                for column in [0, 4, 8, 12] {
                    for half in [0, 16] {
                        let load = |row: usize| _mm_loadu_ps(from[row].0.as_ptr().add(half + column));
                        let (first, second) = (load(row), load(row + 1));
                        let (third, fourth) = (load(row + 2), load(row + 3));
                        let low = _mm_unpacklo_ps(first, second);
                        let high = _mm_unpackhi_ps(first, second);
                        let low_after = _mm_unpacklo_ps(third, fourth);
                        let high_after = _mm_unpackhi_ps(third, fourth);
                        let columns = [
                            _mm_movelh_ps(low, low_after),
                            _mm_movehl_ps(low_after, low),
                            _mm_movelh_ps(high, high_after),
                            _mm_movehl_ps(high_after, high),
                        ];
                        for (place, value) in columns.into_iter().enumerate() {
                            _mm_storeu_ps(to[column + place].0.as_mut_ptr().add(half + row), value);
                        }
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn prefetch(self, block: &Sixteen) {
        let first = block.0.as_ptr();
        // SAFETY: a hint, which reads nothing.
        unsafe {
            _mm_prefetch::<_MM_HINT_T0>(first.cast());
            _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(16).cast());
        }
    }
}

/// The lower 64 bits of the products of two integers of 64 bits.
#[inline(always)]
fn multiply(a: __m128i, b: __m128i) -> __m128i {
    // SAFETY: SSE2 is part of x86-64.
    unsafe {
        let crossed = _mm_add_epi64(
            _mm_mul_epu32(_mm_srli_epi64::<32>(a), b),
            _mm_mul_epu32(a, _mm_srli_epi64::<32>(b)),
        );
        _mm_add_epi64(_mm_mul_epu32(a, b), _mm_slli_epi64::<32>(crossed))
    }
}
