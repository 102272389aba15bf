//! AVX2: eight numbers.

use super::moves::moves;
use super::{Kernel, LARGEST_WIDTH, Lanes, Sixteen, gather_pairs};
use core::arch::x86_64::*;

/// Eight numbers in a register of 256 bits.
#[derive(Clone, Copy)]
pub struct Avx2(());

impl Avx2 {
    /// The registers.
    ///
    /// # Safety
    /// The processor must have AVX2.
    #[inline(always)]
    pub unsafe fn assume() -> Self {
        Self(())
    }
}

const WIDTH: usize = 8;

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

impl Lanes for Avx2 {
    const WIDTH: usize = WIDTH;
    type F32 = __m256;
    type U32 = __m256i;
    type U64 = [__m256i; 2];
    type Mask = __m256i;

    moves! {
        f32, __m256: load_f32 = |from| _mm256_loadu_ps(from), store_f32 = |to, value| _mm256_storeu_ps(to, value);
        u32, __m256i: load_u32 = |from| _mm256_loadu_si256(from.cast()),
            store_u32 = |to, value| _mm256_storeu_si256(to.cast(), value);
        u64, [__m256i; 2]: load_u64 = |from| [_mm256_loadu_si256(from.cast()), _mm256_loadu_si256(from.add(4).cast())],
            store_u64 = |to, value| {
                _mm256_storeu_si256(to.cast(), value[0]);
                _mm256_storeu_si256(to.add(4).cast(), value[1]);
            };
    }

    instructions! {
        splat(value: f32) -> __m256 = _mm256_set1_ps(value);
        add(a: __m256, b: __m256) -> __m256 = _mm256_add_ps(a, b);
        sub(a: __m256, b: __m256) -> __m256 = _mm256_sub_ps(a, b);
        mul(a: __m256, b: __m256) -> __m256 = _mm256_mul_ps(a, b);
        div(a: __m256, b: __m256) -> __m256 = _mm256_div_ps(a, b);
        less(a: __m256, b: __m256) -> __m256i = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b));
        select(mask: __m256i, yes: __m256, no: __m256) -> __m256 =
            _mm256_blendv_ps(no, yes, _mm256_castsi256_ps(mask));
        splat_u32(value: u32) -> __m256i = _mm256_set1_epi32(value as i32);
        add_u32(a: __m256i, b: __m256i) -> __m256i = _mm256_add_epi32(a, b);
        sub_u32(a: __m256i, b: __m256i) -> __m256i = _mm256_sub_epi32(a, b);
        mul_u32(a: __m256i, b: __m256i) -> __m256i = _mm256_mullo_epi32(a, b);
        and(a: __m256i, b: __m256i) -> __m256i = _mm256_and_si256(a, b);
        xor(a: __m256i, b: __m256i) -> __m256i = _mm256_xor_si256(a, b);
        shl(a: __m256i, bits: u32) -> __m256i = _mm256_sll_epi32(a, _mm_cvtsi32_si128(bits as i32));
        shr(a: __m256i, bits: u32) -> __m256i = _mm256_srl_epi32(a, _mm_cvtsi32_si128(bits as i32));
        sar(a: __m256i, bits: u32) -> __m256i = _mm256_sra_epi32(a, _mm_cvtsi32_si128(bits as i32));
        equal(a: __m256i, b: __m256i) -> __m256i = _mm256_cmpeq_epi32(a, b);
        less_i32(a: __m256i, b: __m256i) -> __m256i = _mm256_cmpgt_epi32(b, a);
        select_u32(mask: __m256i, yes: __m256i, no: __m256i) -> __m256i = _mm256_blendv_epi8(no, yes, mask);
        both(a: __m256i, b: __m256i) -> __m256i = _mm256_and_si256(a, b);
        either(a: __m256i, b: __m256i) -> __m256i = _mm256_or_si256(a, b);
        bits(mask: __m256i) -> u32 = _mm256_movemask_ps(_mm256_castsi256_ps(mask)) as u32;
        to_bits(a: __m256) -> __m256i = _mm256_castps_si256(a);
        of_bits(a: __m256i) -> __m256 = _mm256_castsi256_ps(a);
        of_i32(a: __m256i) -> __m256 = _mm256_cvtepi32_ps(a);
        round(a: __m256) -> __m256i = _mm256_cvtps_epi32(a);
        splat_u64(value: u64) -> [__m256i; 2] = [_mm256_set1_epi64x(value as i64); 2];
        add_u64(a: [__m256i; 2], b: [__m256i; 2]) -> [__m256i; 2] =
            [_mm256_add_epi64(a[0], b[0]), _mm256_add_epi64(a[1], b[1])];
        xor_u64(a: [__m256i; 2], b: [__m256i; 2]) -> [__m256i; 2] =
            [_mm256_xor_si256(a[0], b[0]), _mm256_xor_si256(a[1], b[1])];
        widen_u32(a: __m256i) -> [__m256i; 2] = [
            _mm256_cvtepu32_epi64(_mm256_castsi256_si128(a)),
            _mm256_cvtepu32_epi64(_mm256_extracti128_si256::<1>(a)),
        ];
        widen_i32(a: __m256i) -> [__m256i; 2] = [
            _mm256_cvtepi32_epi64(_mm256_castsi256_si128(a)),
            _mm256_cvtepi32_epi64(_mm256_extracti128_si256::<1>(a)),
        ];
    }

    #[inline(always)]
    fn product(self, a: __m256i, b: __m256i) -> [__m256i; 2] {
        let (a, b) = (self.widen_i32(a), self.widen_i32(b));
        // The upper halves are not looked at.
        // SAFETY: `self` says that AVX2 is there.
        unsafe { [_mm256_mul_epu32(a[0], b[0]), _mm256_mul_epu32(a[1], b[1])] }
    }

    #[inline(always)]
    fn high_product(self, a: __m256i, b: __m256i) -> __m256i {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let even = _mm256_mul_epu32(a, b);
            let odd = _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), _mm256_srli_epi64::<32>(b));
            _mm256_blend_epi32::<0b1010_1010>(_mm256_srli_epi64::<32>(even), odd)
        }
    }

    #[inline(always)]
    fn gather_runs<const K: usize>(self, table: &[f32], index: __m256i) -> [[__m256; 4]; K] {
        let mut runs = [[self.splat(0.0); 4]; K];
        let Some(last) = table.len().checked_sub(4 * K) else { return runs };
        let last = last.min(u32::MAX as usize) as u32;
        let mut begins = [0; WIDTH];
        // SAFETY: `self` says that AVX2 is there.
        self.store_u32(unsafe { _mm256_min_epu32(index, self.splat_u32(last)) }, &mut begins);
        let [a, b, c, d, e, f, g, h] = begins;
        for (k, run) in runs.iter_mut().enumerate() {
            // SAFETY: `self` says that AVX2 is there, and from each beginning on the table has 4·K elements, of which
            // these are four.
            unsafe {
                let first = table.as_ptr().add(4 * k);
                let pairs = [pair(first, a, e), pair(first, b, f), pair(first, c, g), pair(first, d, h)];
                *run = transposed(pairs);
            }
        }
        runs
    }

    #[inline(always)]
    fn store_eights(self, columns: [__m256i; 8], to: &mut [[u32; 8]; LARGEST_WIDTH]) {
        let [a, b, c, d, e, f, g, h] = columns;
        // SAFETY: `self` says that AVX2 is there, and each place has room for the eight numbers written to it.
        unsafe {
            let lower = transposed([self.of_bits(a), self.of_bits(b), self.of_bits(c), self.of_bits(d)]);
            let upper = transposed([self.of_bits(e), self.of_bits(f), self.of_bits(g), self.of_bits(h)]);
            for (lane, (lower, upper)) in lower.into_iter().zip(upper).enumerate() {
                let (first, second) = (
                    _mm256_insertf128_ps::<1>(lower, _mm256_castps256_ps128(upper)),
                    _mm256_permute2f128_ps::<0x31>(lower, upper),
                );
                _mm256_storeu_ps(to[lane].as_mut_ptr().cast(), first);
                _mm256_storeu_ps(to[lane + 4].as_mut_ptr().cast(), second);
            }
        }
    }

    #[inline(always)]
    fn of_i64(self, a: [__m256i; 2]) -> __m256 {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let offset = _mm256_set1_epi64x(1 << 51);
            let above = _mm256_or_si256(_mm256_add_epi64(a[0], offset), _mm256_add_epi64(a[1], offset));
            if _mm256_testz_si256(above, _mm256_set1_epi64x(!0 << 52)) == 0 {
                let mut converted = [0.0; WIDTH];
                for (converted, value) in converted.iter_mut().zip(self.array_u64(a)) {
                    *converted = value as i64 as f32;
                }
                return self.load_f32(&converted);
            }
            _mm256_set_m128(nearest_number(a[1]), nearest_number(a[0]))
        }
    }

    #[inline(always)]
    fn round_i64(self, a: __m256) -> [__m256i; 2] {
        let fits = self.less(self.abs(a), self.splat(LARGEST_ROUNDED));
        if self.bits(fits) != 255 {
            let mut rounded = [0; WIDTH];
            for (rounded, value) in rounded.iter_mut().zip(self.array_f32(a)) {
                *rounded = meniscus_core::units::round_half_even(value) as u64;
            }
            return self.load_u64(&rounded);
        }
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            [nearest_integer(_mm256_castps256_ps128(a)), nearest_integer(_mm256_extractf128_ps::<1>(a))]
        }
    }

    #[inline(always)]
    fn mul_u64(self, a: [__m256i; 2], b: [__m256i; 2]) -> [__m256i; 2] {
        // SAFETY: `self` says that AVX2 is there.
        unsafe { [multiply(a[0], b[0]), multiply(a[1], b[1])] }
    }

    #[inline(always)]
    fn shr_u64(self, a: [__m256i; 2], bits: u32) -> [__m256i; 2] {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let bits = _mm_cvtsi32_si128(bits as i32);
            [_mm256_srl_epi64(a[0], bits), _mm256_srl_epi64(a[1], bits)]
        }
    }

    #[inline(always)]
    fn low(self, a: [__m256i; 2]) -> __m256i {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let (first, second) = (_mm256_castsi256_ps(a[0]), _mm256_castsi256_ps(a[1]));
            let mixed = _mm256_castps_si256(_mm256_shuffle_ps::<0b10_00_10_00>(first, second));
            _mm256_permute4x64_epi64::<0b11_01_10_00>(mixed)
        }
    }

    #[inline(always)]
    fn high(self, a: [__m256i; 2]) -> __m256i {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let (first, second) = (_mm256_castsi256_ps(a[0]), _mm256_castsi256_ps(a[1]));
            let mixed = _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(first, second));
            _mm256_permute4x64_epi64::<0b11_01_10_00>(mixed)
        }
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: __m256i) -> __m256 {
        let inside = self.inside(table.len(), index);
        // SAFETY: `self` says that AVX2 is there; only lanes with an index inside the table are read.
        unsafe {
            let mask = _mm256_castsi256_ps(inside);
            _mm256_mask_i32gather_ps::<4>(_mm256_setzero_ps(), table.as_ptr(), index, mask)
        }
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: __m256i) -> __m256i {
        let inside = self.inside(table.len(), index);
        // SAFETY: `self` says that AVX2 is there; only lanes with an index inside the table are read.
        unsafe {
            _mm256_mask_i32gather_epi32::<4>(_mm256_setzero_si256(), table.as_ptr().cast(), index, inside)
        }
    }

    #[inline(always)]
    fn interleave(self, a: __m256, b: __m256) -> (__m256, __m256) {
        // SAFETY: `self` says that AVX2 is there.
        unsafe {
            let (low, high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
            (_mm256_permute2f128_ps::<0x20>(low, high), _mm256_permute2f128_ps::<0x31>(low, high))
        }
    }

    #[inline(always)]
    fn mirrored(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> __m256 {
        // SAFETY: `self` says that AVX2 is there; elements 8 … 15 and 1 … 8 of sixteen are read.
        unsafe {
            if part == 0 {
                let order = _mm256_setr_epi32(0, 7, 6, 5, 4, 3, 2, 1);
                let rest = _mm256_permutevar8x32_ps(_mm256_loadu_ps(rest.as_ptr().add(8)), order);
                _mm256_blend_ps::<1>(rest, _mm256_loadu_ps(first.as_ptr()))
            } else {
                let order = _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0);
                _mm256_permutevar8x32_ps(_mm256_loadu_ps(rest.as_ptr().add(1)), order)
            }
        }
    }

    #[inline(always)]
    fn mirrored_reversed(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> __m256 {
        // SAFETY: `self` says that AVX2 is there, and the arrays have sixteen elements.
        unsafe {
            let [low, high] = [_mm256_loadu_ps(rest.as_ptr()), _mm256_loadu_ps(rest.as_ptr().add(8))];
            if part == 0 {
                // 16, 8, 12, 4, 14, 6, 10, 2
                let even = _mm256_shuffle_ps::<0b10_00_10_00>(low, high);
                let order = _mm256_setr_epi32(0, 2, 6, 4, 7, 5, 3, 1);
                let order = _mm256_permutevar8x32_ps(even, order);
                _mm256_blend_ps::<1>(order, _mm256_loadu_ps(first.as_ptr()))
            } else {
                // 15, 7, 11, 3, 13, 5, 9, 1
                let odd = _mm256_shuffle_ps::<0b11_01_11_01>(low, high);
                let order = _mm256_setr_epi32(7, 5, 3, 1, 6, 4, 2, 0);
                _mm256_permutevar8x32_ps(odd, order)
            }
        }
    }

    #[inline(always)]
    fn load_reversed_f32(self, from: &[f32; 16], part: usize) -> __m256 {
        // SAFETY: `self` says that AVX2 is there, and the array has sixteen elements.
        unsafe { reversed(_mm256_loadu_ps(from.as_ptr()), _mm256_loadu_ps(from.as_ptr().add(8)), part) }
    }

    #[inline(always)]
    fn load_reversed_u32(self, from: &[u32; 16], part: usize) -> __m256i {
        // SAFETY: `self` says that AVX2 is there, and the array has sixteen elements.
        unsafe {
            let first = from.as_ptr().cast::<f32>();
            _mm256_castps_si256(reversed(_mm256_loadu_ps(first), _mm256_loadu_ps(first.add(8)), part))
        }
    }

    #[inline(always)]
    fn columns(self, rows: &[Sixteen; 16], quarter: usize, part: usize) -> [[__m256; 4]; 2] {
        let column = 4 * (quarter & 3);
        let (rows, rows_after) = rows.split_at(8);
        let rows = if part == 0 { rows } else { rows_after };
        // SAFETY: `self` says that AVX2 is there; a block has 16 real and 16 imaginary parts, `column` is at most 12.
        unsafe { [fours(rows, column), fours(rows, 16 + column)] }
    }

    #[inline(always)]
    fn apart<K: Kernel>(self, kernel: K) -> K::Output {
        // SAFETY: `self` says that AVX2 is there.
        unsafe { super::level::avx2(kernel) }
    }

    #[inline(always)]
    fn gather_pairs(self, table: &[[u32; 2]], index: &[u32]) -> [__m256i; 2] {
        let index = match index.first_chunk::<WIDTH>() {
            Some(index) if self.bits(self.inside(table.len(), self.load_u32(index))) == 0xFF => index,
            _ => return self.gather_pairs_of_some(table, index),
        };
        // SAFETY: `self` says that AVX2 is there; all indices are inside the table, whose elements need not be aligned.
        unsafe {
            let first = table.as_ptr();
            let two = |lane: usize| {
                let lower = _mm_loadl_epi64(first.add(index[lane] as usize).cast());
                let upper = _mm_loadl_epi64(first.add(index[lane + 1] as usize).cast());
                _mm_castsi128_pd(_mm_unpacklo_epi64(lower, upper))
            };
            let four = |lane: usize| {
                _mm256_castpd_ps(_mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(two(lane)), two(lane + 4)))
            };
            let (a, b) = (four(0), four(2));
            [
                _mm256_castps_si256(_mm256_shuffle_ps::<0b10_00_10_00>(a, b)),
                _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(a, b)),
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

/// Sixteen numbers in two registers to the order of reversed bits, the first half of it or the second.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn reversed(low: __m256, high: __m256, part: usize) -> __m256 {
    // SAFETY: the caller's.
    unsafe {
        // 0 2 8 10 4 6 12 14, or 1 3 9 11 5 7 13 15.
        let mixed = if part == 0 {
            _mm256_shuffle_ps::<0b10_00_10_00>(low, high)
        } else {
            _mm256_shuffle_ps::<0b11_01_11_01>(low, high)
        };
        _mm256_permutevar8x32_ps(mixed, _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7))
    }
}

/// Numbers `first` … `first` + 3 of two blocks.
///
/// # Safety
/// The processor must have AVX2, and `first` is at most 28.
#[inline(always)]
unsafe fn halves(row: &Sixteen, after: &Sixteen, first: usize) -> __m256 {
    // SAFETY: the caller's; a block has 32 numbers.
    unsafe {
        let value = _mm256_castps128_ps256(_mm_loadu_ps(row.0.as_ptr().add(first)));
        _mm256_insertf128_ps::<1>(value, _mm_loadu_ps(after.0.as_ptr().add(first)))
    }
}

/// Numbers `first` … `first` + 3 of eight blocks, transposed.
///
/// # Safety
/// The processor must have AVX2, and `first` is at most 28.
#[inline(always)]
unsafe fn fours(rows: &[Sixteen], first: usize) -> [__m256; 4] {
    // SAFETY: the caller's.
    unsafe {
        let [a, b, c, d, e, f, g, h] = rows else { return [_mm256_setzero_ps(); 4] };
        transposed([halves(a, e, first), halves(b, f, first), halves(c, g, first), halves(d, h, first)])
    }
}

impl Avx2 {
    /// Where an index is inside a table of this length, as far as an offset reaches.
    #[inline(always)]
    fn inside(self, length: usize, index: __m256i) -> __m256i {
        self.less_u32(index, self.splat_u32(length.min(i32::MAX as usize) as u32))
    }

    /// [`Lanes::gather_pairs`] where some indices are beyond the end.
    #[cold]
    fn gather_pairs_of_some(self, table: &[[u32; 2]], index: &[u32]) -> [__m256i; 2] {
        let [first, second] = gather_pairs(table, index, WIDTH);
        [self.load_u32(&first), self.load_u32(&second)]
    }
}

/// Four elements from one place, then four from another, counted from the first.
///
/// # Safety
/// The processor must have AVX2, and there must be four elements at both places.
#[inline(always)]
unsafe fn pair(first: *const f32, low: u32, high: u32) -> __m256 {
    // SAFETY: the caller's.
    unsafe { _mm256_loadu2_m128(first.add(high as usize), first.add(low as usize)) }
}

/// Rows of four as columns, in each half.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn transposed([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: the caller's.
    unsafe {
        let (low, high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (low_next, high_next) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0b01_00_01_00>(low, low_next),
            _mm256_shuffle_ps::<0b11_10_11_10>(low, low_next),
            _mm256_shuffle_ps::<0b01_00_01_00>(high, high_next),
            _mm256_shuffle_ps::<0b11_10_11_10>(high, high_next),
        ]
    }
}

/// The lower 64 bits of the products of two integers of 64 bits.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn multiply(a: __m256i, b: __m256i) -> __m256i {
    // SAFETY: the caller's.
    unsafe {
        let crossed = _mm256_add_epi64(
            _mm256_mul_epu32(_mm256_srli_epi64::<32>(a), b),
            _mm256_mul_epu32(a, _mm256_srli_epi64::<32>(b)),
        );
        _mm256_add_epi64(_mm256_mul_epu32(a, b), _mm256_slli_epi64::<32>(crossed))
    }
}

/// The numbers of binary32 nearest to integers of modulus below 2⁵¹: exact in binary64, so that they are rounded once.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn nearest_number(a: __m256i) -> __m128 {
    // SAFETY: the caller's.
    unsafe {
        let integers = _mm256_set1_pd(INTEGERS);
        let sum = _mm256_castsi256_pd(_mm256_add_epi64(a, _mm256_castpd_si256(integers)));
        _mm256_cvtpd_ps(_mm256_sub_pd(sum, integers))
    }
}

/// The integers nearest to numbers of modulus below 2⁵¹, ties to even.
///
/// # Safety
/// The processor must have AVX2.
#[inline(always)]
unsafe fn nearest_integer(a: __m128) -> __m256i {
    // SAFETY: the caller's.
    unsafe {
        let integers = _mm256_set1_pd(INTEGERS);
        let sum = _mm256_add_pd(_mm256_cvtps_pd(a), integers);
        _mm256_sub_epi64(_mm256_castpd_si256(sum), _mm256_castpd_si256(integers))
    }
}
