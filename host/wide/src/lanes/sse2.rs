//! SSE2: four numbers, on every x86-64.

use super::moves::moves;
use super::{LARGEST_WIDTH, Lanes, Sixteen, gather_pairs};
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

/// 1.5·2⁵²: added to a number of binary64 of modulus up to 2⁵¹, it leaves the nearest integer in the last bits of the sum.
const INTEGERS: f64 = 6_755_399_441_055_744.0;

/// 2⁵¹
const LARGEST_ROUNDED: f32 = 2_251_799_813_685_248.0;

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

    moves! {
        f32, __m128: load_f32 = |from| _mm_loadu_ps(from), store_f32 = |to, value| _mm_storeu_ps(to, value);
        u32, __m128i: load_u32 = |from| _mm_loadu_si128(from.cast()),
            store_u32 = |to, value| _mm_storeu_si128(to.cast(), value);
        u64, [__m128i; 2]: load_u64 = |from| [_mm_loadu_si128(from.cast()), _mm_loadu_si128(from.add(2).cast())],
            store_u64 = |to, value| {
                _mm_storeu_si128(to.cast(), value[0]);
                _mm_storeu_si128(to.add(2).cast(), value[1]);
            };
    }

    instructions! {
        splat(value: f32) -> __m128 = _mm_set1_ps(value);
        add(a: __m128, b: __m128) -> __m128 = _mm_add_ps(a, b);
        sub(a: __m128, b: __m128) -> __m128 = _mm_sub_ps(a, b);
        mul(a: __m128, b: __m128) -> __m128 = _mm_mul_ps(a, b);
        div(a: __m128, b: __m128) -> __m128 = _mm_div_ps(a, b);
        less(a: __m128, b: __m128) -> __m128i = _mm_castps_si128(_mm_cmplt_ps(a, b));
        splat_u32(value: u32) -> __m128i = _mm_set1_epi32(value as i32);
        add_u32(a: __m128i, b: __m128i) -> __m128i = _mm_add_epi32(a, b);
        sub_u32(a: __m128i, b: __m128i) -> __m128i = _mm_sub_epi32(a, b);
        and(a: __m128i, b: __m128i) -> __m128i = _mm_and_si128(a, b);
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
        xor_u64(a: [__m128i; 2], b: [__m128i; 2]) -> [__m128i; 2] =
            [_mm_xor_si128(a[0], b[0]), _mm_xor_si128(a[1], b[1])];
        widen_u32(a: __m128i) -> [__m128i; 2] =
            [_mm_unpacklo_epi32(a, _mm_setzero_si128()), _mm_unpackhi_epi32(a, _mm_setzero_si128())];
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
    fn gather_runs<const K: usize>(self, table: &[f32], index: __m128i) -> [[__m128; 4]; K] {
        let mut runs = [[self.splat(0.0); 4]; K];
        let Some(last) = table.len().checked_sub(4 * K) else { return runs };
        let [a, b, c, d, ..] = self.array_u32(index).map(|index| last.min(index as usize));
        for (k, run) in runs.iter_mut().enumerate() {
            // SAFETY: SSE2 is there, and from each beginning on the table has 4·K elements, of which these are four.
            unsafe {
                let four = |begin: usize| _mm_loadu_ps(table.as_ptr().add(begin + 4 * k));
                *run = transposed([four(a), four(b), four(c), four(d)]);
            }
        }
        runs
    }

    #[inline(always)]
    fn store_eights(self, columns: [__m128i; 8], to: &mut [[u32; 8]; LARGEST_WIDTH]) {
        let [a, b, c, d, e, f, g, h] = columns.map(|column| self.of_bits(column));
        let rows = transposed([a, b, c, d]).into_iter().zip(transposed([e, f, g, h]));
        for (eight, (lower, upper)) in to.iter_mut().zip(rows) {
            let (first, last) = eight.split_at_mut(4);
            self.store_u32(self.to_bits(lower), first);
            self.store_u32(self.to_bits(upper), last);
        }
    }

    #[inline(always)]
    fn of_i64(self, a: [__m128i; 2]) -> __m128 {
        // SAFETY: SSE2 is there.
        unsafe {
            let offset = _mm_set1_epi64x(1 << 51);
            let above = |a| _mm_srli_epi64::<52>(_mm_add_epi64(a, offset));
            if self.bits(self.equal(_mm_or_si128(above(a[0]), above(a[1])), _mm_setzero_si128())) != 15 {
                let mut converted = [0.0; WIDTH];
                for (converted, value) in converted.iter_mut().zip(self.array_u64(a)) {
                    *converted = value as i64 as f32;
                }
                return self.load_f32(&converted);
            }
            // Exact in binary64, so that it is rounded once.
            let exact = |a| {
                let sum = _mm_add_epi64(a, _mm_castpd_si128(_mm_set1_pd(INTEGERS)));
                _mm_cvtpd_ps(_mm_sub_pd(_mm_castsi128_pd(sum), _mm_set1_pd(INTEGERS)))
            };
            _mm_movelh_ps(exact(a[0]), exact(a[1]))
        }
    }

    #[inline(always)]
    fn round_i64(self, a: __m128) -> [__m128i; 2] {
        let fits = self.less(self.abs(a), self.splat(LARGEST_ROUNDED));
        if self.bits(fits) != 15 {
            let mut rounded = [0; WIDTH];
            for (rounded, value) in rounded.iter_mut().zip(self.array_f32(a)) {
                *rounded = meniscus_core::units::round_half_even(value) as u64;
            }
            return self.load_u64(&rounded);
        }
        // SAFETY: SSE2 is there.
        unsafe {
            let integers = _mm_set1_pd(INTEGERS);
            let round = |a| {
                let sum = _mm_add_pd(_mm_cvtps_pd(a), integers);
                _mm_sub_epi64(_mm_castpd_si128(sum), _mm_castpd_si128(integers))
            };
            [round(a), round(_mm_movehl_ps(a, a))]
        }
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
    fn select(self, mask: __m128i, yes: __m128, no: __m128) -> __m128 {
        self.of_bits(self.select_u32(mask, self.to_bits(yes), self.to_bits(no)))
    }

    #[inline(always)]
    fn select_u32(self, mask: __m128i, yes: __m128i, no: __m128i) -> __m128i {
        // SAFETY: SSE2 is there.
        unsafe { _mm_or_si128(_mm_and_si128(mask, yes), _mm_andnot_si128(mask, no)) }
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
        let part = part & 12;
        // SAFETY: SSE2 is there; elements 12 … 15 or, for a part of 4, 8 or 12, 13 − part … 16 − part of sixteen are read.
        unsafe {
            if part == 0 {
                let rest = _mm_loadu_ps(rest.as_ptr().add(12));
                _mm_move_ss(_mm_shuffle_ps::<0b01_10_11_00>(rest, rest), _mm_loadu_ps(first.as_ptr()))
            } else {
                let rest = _mm_loadu_ps(rest.as_ptr().add(13 - part));
                _mm_shuffle_ps::<0b00_01_10_11>(rest, rest)
            }
        }
    }

    #[inline(always)]
    fn mirrored_reversed(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> __m128 {
        let lane = |index: usize| if index == 0 { first[0] } else { rest[16 - index] };
        let [a, b, c, d] = reversed(part).map(lane);
        // SAFETY: SSE2 is there.
        unsafe { _mm_setr_ps(a, b, c, d) }
    }

    #[inline(always)]
    fn load_reversed_f32(self, from: &[f32; 16], part: usize) -> __m128 {
        let [a, b, c, d] = reversed(part).map(|index| from[index]);
        // SAFETY: SSE2 is there.
        unsafe { _mm_setr_ps(a, b, c, d) }
    }

    #[inline(always)]
    fn load_reversed_u32(self, from: &[u32; 16], part: usize) -> __m128i {
        let [a, b, c, d] = reversed(part).map(|index| from[index] as i32);
        // SAFETY: SSE2 is there.
        unsafe { _mm_setr_epi32(a, b, c, d) }
    }

    #[inline(always)]
    fn columns(self, rows: &[Sixteen; 16], quarter: usize, part: usize) -> [[__m128; 4]; 2] {
        let column = 4 * (quarter & 3);
        let part = part & 12;
        let rows = [&rows[part], &rows[part + 1], &rows[part + 2], &rows[part + 3]];
        // SAFETY: SSE2 is there; a block has 16 real and 16 imaginary parts, and `column` is at most 12.
        unsafe { [fours(rows, column), fours(rows, 16 + column)] }
    }

    #[inline(always)]
    fn gather_pairs(self, table: &[[u32; 2]], index: &[u32]) -> [__m128i; 2] {
        let pair = |lane: usize| index.get(lane).and_then(|&index| table.get(index as usize));
        let (Some(a), Some(b), Some(c), Some(d)) = (pair(0), pair(1), pair(2), pair(3)) else {
            let [first, second] = gather_pairs(table, index, WIDTH);
            return [self.load_u32(&first), self.load_u32(&second)];
        };
        // SAFETY: SSE2 is there, and each pair has 64 bits, which need not be aligned.
        unsafe {
            let two = |lower: &[u32; 2], upper: &[u32; 2]| {
                let (lower, upper) =
                    (_mm_loadl_epi64(lower.as_ptr().cast()), _mm_loadl_epi64(upper.as_ptr().cast()));
                _mm_castsi128_ps(_mm_unpacklo_epi64(lower, upper))
            };
            let (ab, cd) = (two(a, b), two(c, d));
            [
                _mm_castps_si128(_mm_shuffle_ps::<0b10_00_10_00>(ab, cd)),
                _mm_castps_si128(_mm_shuffle_ps::<0b11_01_11_01>(ab, cd)),
            ]
        }
    }

    #[inline(always)]
    fn prefetch<T>(self, address: *const T) {
        // SAFETY: every x86-64 has the instruction, which does nothing that can be seen, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(address.cast()) }
    }

    #[inline(always)]
    fn prefetch_slice<T>(self, elements: &[T]) {
        for offset in (0..size_of_val(elements)).step_by(64) {
            // SAFETY: every x86-64 has the instruction, which does nothing that can be seen; the address is inside the slice.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(elements.as_ptr().cast::<i8>().add(offset)) }
        }
    }
}

/// Four numbers below 16 from `part` on, with their bits reversed.
#[inline(always)]
fn reversed(part: usize) -> [usize; 4] {
    let first = (part >> 3 & 1) | (part >> 1 & 2);
    [first, first + 8, first + 4, first + 12]
}

/// Numbers `first` … `first` + 3 of four blocks, transposed.
///
/// # Safety
/// `first` is at most 28.
#[inline(always)]
unsafe fn fours(rows: [&Sixteen; 4], first: usize) -> [__m128; 4] {
    // SAFETY: SSE2 is part of x86-64; a block has 32 numbers.
    unsafe {
        let [a, b, c, d] = rows.map(|row| _mm_loadu_ps(row.0.as_ptr().add(first)));
        let (low, low_after) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
        let (high, high_after) = (_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
        [
            _mm_movelh_ps(low, low_after),
            _mm_movehl_ps(low_after, low),
            _mm_movelh_ps(high, high_after),
            _mm_movehl_ps(high_after, high),
        ]
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

/// Rows of four as columns.
#[inline(always)]
fn transposed([a, b, c, d]: [__m128; 4]) -> [__m128; 4] {
    // SAFETY: SSE2 is part of x86-64.
    unsafe {
        let (low, high) = (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
        let (low_next, high_next) = (_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
        [
            _mm_movelh_ps(low, low_next),
            _mm_movehl_ps(low_next, low),
            _mm_movelh_ps(high, high_next),
            _mm_movehl_ps(high_next, high),
        ]
    }
}
