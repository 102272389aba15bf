//! AVX-512: sixteen numbers.

use super::moves::moves;
use super::{Kernel, Lanes, Sixteen, gather_pairs};
use core::arch::x86_64::*;

/// Sixteen numbers in a register of 512 bits.
#[derive(Clone, Copy)]
pub struct Avx512(());

impl Avx512 {
    /// The registers.
    ///
    /// # Safety
    /// The processor must have AVX512F, VL, DQ and BW.
    #[inline(always)]
    pub unsafe fn assume() -> Self {
        Self(())
    }
}

const WIDTH: usize = 16;

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

impl Lanes for Avx512 {
    const WIDTH: usize = WIDTH;
    type F32 = __m512;
    type U32 = __m512i;
    type U64 = [__m512i; 2];
    type Mask = __mmask16;

    moves! {
        f32, __m512: load_f32 = |from| _mm512_loadu_ps(from), store_f32 = |to, value| _mm512_storeu_ps(to, value);
        u32, __m512i: load_u32 = |from| _mm512_loadu_si512(from.cast()),
            store_u32 = |to, value| _mm512_storeu_si512(to.cast(), value);
        u64, [__m512i; 2]: load_u64 = |from| [_mm512_loadu_si512(from.cast()), _mm512_loadu_si512(from.add(8).cast())],
            store_u64 = |to, value| {
                _mm512_storeu_si512(to.cast(), value[0]);
                _mm512_storeu_si512(to.add(8).cast(), value[1]);
            };
    }

    instructions! {
        splat(value: f32) -> __m512 = _mm512_set1_ps(value);
        add(a: __m512, b: __m512) -> __m512 = _mm512_add_ps(a, b);
        sub(a: __m512, b: __m512) -> __m512 = _mm512_sub_ps(a, b);
        mul(a: __m512, b: __m512) -> __m512 = _mm512_mul_ps(a, b);
        div(a: __m512, b: __m512) -> __m512 = _mm512_div_ps(a, b);
        less(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
        select(mask: __mmask16, yes: __m512, no: __m512) -> __m512 = _mm512_mask_blend_ps(mask, no, yes);
        splat_u32(value: u32) -> __m512i = _mm512_set1_epi32(value as i32);
        add_u32(a: __m512i, b: __m512i) -> __m512i = _mm512_add_epi32(a, b);
        sub_u32(a: __m512i, b: __m512i) -> __m512i = _mm512_sub_epi32(a, b);
        mul_u32(a: __m512i, b: __m512i) -> __m512i = _mm512_mullo_epi32(a, b);
        and(a: __m512i, b: __m512i) -> __m512i = _mm512_and_si512(a, b);
        xor(a: __m512i, b: __m512i) -> __m512i = _mm512_xor_si512(a, b);
        shl(a: __m512i, bits: u32) -> __m512i = _mm512_sll_epi32(a, _mm_cvtsi32_si128(bits as i32));
        shr(a: __m512i, bits: u32) -> __m512i = _mm512_srl_epi32(a, _mm_cvtsi32_si128(bits as i32));
        sar(a: __m512i, bits: u32) -> __m512i = _mm512_sra_epi32(a, _mm_cvtsi32_si128(bits as i32));
        equal(a: __m512i, b: __m512i) -> __mmask16 = _mm512_cmpeq_epi32_mask(a, b);
        less_i32(a: __m512i, b: __m512i) -> __mmask16 = _mm512_cmplt_epi32_mask(a, b);
        less_u32(a: __m512i, b: __m512i) -> __mmask16 = _mm512_cmplt_epu32_mask(a, b);
        select_u32(mask: __mmask16, yes: __m512i, no: __m512i) -> __m512i = _mm512_mask_blend_epi32(mask, no, yes);
        to_bits(a: __m512) -> __m512i = _mm512_castps_si512(a);
        of_bits(a: __m512i) -> __m512 = _mm512_castsi512_ps(a);
        of_i32(a: __m512i) -> __m512 = _mm512_cvtepi32_ps(a);
        of_u32(a: __m512i) -> __m512 = _mm512_cvtepu32_ps(a);
        abs(a: __m512) -> __m512 = _mm512_abs_ps(a);
        round(a: __m512) -> __m512i = _mm512_cvtps_epi32(a);
        splat_u64(value: u64) -> [__m512i; 2] = [_mm512_set1_epi64(value as i64); 2];
        add_u64(a: [__m512i; 2], b: [__m512i; 2]) -> [__m512i; 2] =
            [_mm512_add_epi64(a[0], b[0]), _mm512_add_epi64(a[1], b[1])];
        mul_u64(a: [__m512i; 2], b: [__m512i; 2]) -> [__m512i; 2] =
            [_mm512_mullo_epi64(a[0], b[0]), _mm512_mullo_epi64(a[1], b[1])];
        xor_u64(a: [__m512i; 2], b: [__m512i; 2]) -> [__m512i; 2] =
            [_mm512_xor_si512(a[0], b[0]), _mm512_xor_si512(a[1], b[1])];
        product(a: __m512i, b: __m512i) -> [__m512i; 2] = [
            _mm512_mul_epu32(
                _mm512_cvtepu32_epi64(_mm512_castsi512_si256(a)),
                _mm512_cvtepu32_epi64(_mm512_castsi512_si256(b)),
            ),
            _mm512_mul_epu32(
                _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64::<1>(a)),
                _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64::<1>(b)),
            ),
        ];
        shr_u64(a: [__m512i; 2], bits: u32) -> [__m512i; 2] = [
            _mm512_srl_epi64(a[0], _mm_cvtsi32_si128(bits as i32)),
            _mm512_srl_epi64(a[1], _mm_cvtsi32_si128(bits as i32)),
        ];
        widen_u32(a: __m512i) -> [__m512i; 2] = [
            _mm512_cvtepu32_epi64(_mm512_castsi512_si256(a)),
            _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64::<1>(a)),
        ];
        widen_i32(a: __m512i) -> [__m512i; 2] = [
            _mm512_cvtepi32_epi64(_mm512_castsi512_si256(a)),
            _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64::<1>(a)),
        ];
        of_i64(a: [__m512i; 2]) -> __m512 = _mm512_insertf32x8::<1>(
            _mm512_castps256_ps512(_mm512_cvtepi64_ps(a[0])),
            _mm512_cvtepi64_ps(a[1]),
        );
        round_i64(a: __m512) -> [__m512i; 2] = [
            _mm512_cvtps_epi64(_mm512_castps512_ps256(a)),
            _mm512_cvtps_epi64(_mm512_extractf32x8_ps::<1>(a)),
        ];
        low(a: [__m512i; 2]) -> __m512i = _mm512_inserti64x4::<1>(
            _mm512_castsi256_si512(_mm512_cvtepi64_epi32(a[0])),
            _mm512_cvtepi64_epi32(a[1]),
        );
        high(a: [__m512i; 2]) -> __m512i = _mm512_inserti64x4::<1>(
            _mm512_castsi256_si512(_mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(a[0]))),
            _mm512_cvtepi64_epi32(_mm512_srli_epi64::<32>(a[1])),
        );
    }

    #[inline(always)]
    fn high_product(self, a: __m512i, b: __m512i) -> __m512i {
        // SAFETY: `self` says that AVX-512 is there.
        unsafe {
            let even = _mm512_mul_epu32(a, b);
            let odd = _mm512_mul_epu32(_mm512_srli_epi64::<32>(a), _mm512_srli_epi64::<32>(b));
            _mm512_mask_blend_epi32(0xAAAA, _mm512_srli_epi64::<32>(even), odd)
        }
    }

    #[inline(always)]
    fn gather_runs<const K: usize>(self, table: &[f32], index: __m512i) -> [[__m512; 4]; K] {
        let mut runs = [[self.splat(0.0); 4]; K];
        let Some(last) = table.len().checked_sub(4 * K) else { return runs };
        let last = last.min(u32::MAX as usize) as u32;
        let mut begins = [0; WIDTH];
        // SAFETY: `self` says that AVX-512 is there.
        self.store_u32(unsafe { _mm512_min_epu32(index, self.splat_u32(last)) }, &mut begins);
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = begins;
        for (run, elements) in runs.iter_mut().enumerate() {
            // SAFETY: `self` says that AVX-512 is there, and from each beginning on the table has 4·K elements, of which
            // these are four.
            unsafe {
                let first = table.as_ptr().add(4 * run);
                let rows = [
                    quadruple(first, [a, e, i, m]),
                    quadruple(first, [b, f, j, n]),
                    quadruple(first, [c, g, k, o]),
                    quadruple(first, [d, h, l, p]),
                ];
                *elements = transposed(rows);
            }
        }
        runs
    }

    #[inline(always)]
    fn store_eights(self, columns: [__m512i; 8], to: &mut [[u32; 8]; WIDTH]) {
        let [a, b, c, d, e, f, g, h] = columns;
        // SAFETY: `self` says that AVX-512 is there, and each place has room for the eight numbers written to it.
        unsafe {
            let lower = transposed([self.of_bits(a), self.of_bits(b), self.of_bits(c), self.of_bits(d)]);
            let upper = transposed([self.of_bits(e), self.of_bits(f), self.of_bits(g), self.of_bits(h)]);
            let halves = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
            let other_halves = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
            for (lane, (lower, upper)) in lower.into_iter().zip(upper).enumerate() {
                let (lower, upper) = (_mm512_castps_pd(lower), _mm512_castps_pd(upper));
                let first = _mm512_castpd_ps(_mm512_permutex2var_pd(lower, halves, upper));
                let second = _mm512_castpd_ps(_mm512_permutex2var_pd(lower, other_halves, upper));
                _mm256_storeu_ps(to[lane].as_mut_ptr().cast(), _mm512_castps512_ps256(first));
                _mm256_storeu_ps(to[lane + 4].as_mut_ptr().cast(), _mm512_extractf32x8_ps::<1>(first));
                _mm256_storeu_ps(to[lane + 8].as_mut_ptr().cast(), _mm512_castps512_ps256(second));
                _mm256_storeu_ps(to[lane + 12].as_mut_ptr().cast(), _mm512_extractf32x8_ps::<1>(second));
            }
        }
    }

    #[inline(always)]
    fn both(self, a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }

    #[inline(always)]
    fn either(self, a: __mmask16, b: __mmask16) -> __mmask16 {
        a | b
    }

    #[inline(always)]
    fn bits(self, mask: __mmask16) -> u32 {
        u32::from(mask)
    }

    #[inline(always)]
    fn gather_f32(self, table: &[f32], index: __m512i) -> __m512 {
        let inside = self.inside(table.len(), index);
        // SAFETY: `self` says that AVX-512 is there; only lanes with an index inside the table are read.
        unsafe { _mm512_mask_i32gather_ps::<4>(_mm512_setzero_ps(), inside, index, table.as_ptr()) }
    }

    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: __m512i) -> __m512i {
        let inside = self.inside(table.len(), index);
        // SAFETY: `self` says that AVX-512 is there; only lanes with an index inside the table are read.
        unsafe {
            _mm512_mask_i32gather_epi32::<4>(_mm512_setzero_si512(), inside, index, table.as_ptr().cast())
        }
    }

    #[inline(always)]
    fn compress(self, mask: __mmask16, a: __m512i, to: &mut [u32; WIDTH]) -> usize {
        // To a register first: compressing into memory takes a hundred cycles on some processors.
        // SAFETY: `self` says that AVX-512 is there, and the array has sixteen elements.
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), _mm512_maskz_compress_epi32(mask, a)) }
        mask.count_ones() as usize
    }

    #[inline(always)]
    fn interleave(self, a: __m512, b: __m512) -> (__m512, __m512) {
        // SAFETY: `self` says that AVX-512 is there.
        unsafe {
            let first = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
            let second = _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
            (_mm512_permutex2var_ps(a, first, b), _mm512_permutex2var_ps(a, second, b))
        }
    }

    #[inline(always)]
    fn mirrored(self, first: &[f32; 16], rest: &[f32; 16], _part: usize) -> __m512 {
        // SAFETY: `self` says that AVX-512 is there, and the arrays have sixteen elements; they need not be aligned.
        unsafe {
            let order = _mm512_setr_epi32(0, 31, 30, 29, 28, 27, 26, 25, 24, 23, 22, 21, 20, 19, 18, 17);
            _mm512_permutex2var_ps(_mm512_loadu_ps(first.as_ptr()), order, _mm512_loadu_ps(rest.as_ptr()))
        }
    }

    #[inline(always)]
    fn mirrored_reversed(self, first: &[f32; 16], rest: &[f32; 16], _part: usize) -> __m512 {
        // SAFETY: `self` says that AVX-512 is there, and the arrays have sixteen elements; they need not be aligned.
        unsafe {
            let order = _mm512_setr_epi32(0, 24, 28, 20, 30, 22, 26, 18, 31, 23, 27, 19, 29, 21, 25, 17);
            _mm512_permutex2var_ps(_mm512_loadu_ps(first.as_ptr()), order, _mm512_loadu_ps(rest.as_ptr()))
        }
    }

    #[inline(always)]
    fn load_reversed_f32(self, from: &[f32; 16], _part: usize) -> __m512 {
        // SAFETY: `self` says that AVX-512 is there, and the array has sixteen elements; they need not be aligned.
        unsafe { _mm512_permutexvar_ps(reversed(), _mm512_loadu_ps(from.as_ptr())) }
    }

    #[inline(always)]
    fn load_reversed_u32(self, from: &[u32; 16], _part: usize) -> __m512i {
        // SAFETY: `self` says that AVX-512 is there, and the array has sixteen elements; they need not be aligned.
        unsafe { _mm512_permutexvar_epi32(reversed(), _mm512_loadu_si512(from.as_ptr().cast())) }
    }

    #[inline(always)]
    fn columns(self, rows: &[Sixteen; 16], quarter: usize, _part: usize) -> [[__m512; 4]; 2] {
        let column = 4 * (quarter & 3);
        // SAFETY: `self` says that AVX-512 is there; a block has 16 real and 16 imaginary parts, and `column` is at most 12.
        unsafe { [fours(rows, column), fours(rows, 16 + column)] }
    }

    #[inline(always)]
    fn apart<K: Kernel>(self, kernel: K) -> K::Output {
        // SAFETY: `self` says that AVX-512 is there.
        unsafe { super::level::avx512(kernel) }
    }

    #[inline(always)]
    fn gather_pairs(self, table: &[[u32; 2]], index: &[u32]) -> [__m512i; 2] {
        let index = match index.first_chunk::<WIDTH>() {
            Some(index) if self.inside(table.len(), self.load_u32(index)) == 0xFFFF => index,
            _ => return self.gather_pairs_of_some(table, index),
        };
        // SAFETY: `self` says that AVX-512 is there; all indices are inside the table, whose elements need not be aligned.
        unsafe {
            let first = table.as_ptr();
            let two = |lane: usize| {
                let lower = _mm_loadl_epi64(first.add(index[lane] as usize).cast());
                let upper = _mm_loadl_epi64(first.add(index[lane + 1] as usize).cast());
                _mm_castsi128_pd(_mm_unpacklo_epi64(lower, upper))
            };
            let eight = |lane: usize| {
                let pairs = _mm512_castpd128_pd512(two(lane));
                let lower = _mm256_insertf128_pd::<1>(_mm512_castpd512_pd256(pairs), two(lane + 4));
                let upper = _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(two(lane + 8)), two(lane + 12));
                _mm512_castpd_ps(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(lower), upper))
            };
            let (a, b) = (eight(0), eight(2));
            [
                _mm512_castps_si512(_mm512_shuffle_ps::<0b10_00_10_00>(a, b)),
                _mm512_castps_si512(_mm512_shuffle_ps::<0b11_01_11_01>(a, b)),
            ]
        }
    }

    #[inline(always)]
    fn look_up(self, table: &[f32; 64], index: __m512i) -> __m512 {
        // SAFETY: `self` says that AVX-512 is there, and the table has four times sixteen elements; they need not be
        // aligned.
        unsafe {
            let part = |number: usize| _mm512_loadu_ps(table.as_ptr().add(16 * number));
            let lower = _mm512_permutex2var_ps(part(0), index, part(1));
            let upper = _mm512_permutex2var_ps(part(2), index, part(3));
            _mm512_mask_blend_ps(_mm512_test_epi32_mask(index, _mm512_set1_epi32(32)), lower, upper)
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

/// The numbers below 16 with their bits reversed.
///
/// # Safety
/// The processor must have AVX-512.
#[inline(always)]
unsafe fn reversed() -> __m512i {
    // SAFETY: the caller's.
    unsafe { _mm512_setr_epi32(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15) }
}

/// Numbers `first` … `first` + 3 of sixteen blocks, transposed.
///
/// # Safety
/// The processor must have AVX-512, and `first` is at most 28.
#[inline(always)]
unsafe fn fours(rows: &[Sixteen; 16], first: usize) -> [__m512; 4] {
    // Rows four apart lie in a register, so that only quarters of registers are to be transposed.
    // SAFETY: the caller's; a block has 32 numbers.
    unsafe {
        let [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] =
            rows.each_ref().map(|row| row.0.as_ptr().add(first));
        transposed([
            quarters([a, e, i, m]),
            quarters([b, f, j, n]),
            quarters([c, g, k, o]),
            quarters([d, h, l, p]),
        ])
    }
}

/// Four numbers from each of four places on, a quarter of the register each.
///
/// # Safety
/// The processor must have AVX-512, and there are as many numbers.
#[inline(always)]
unsafe fn quarters([a, b, c, d]: [*const f32; 4]) -> __m512 {
    // SAFETY: the caller's.
    unsafe {
        let value = _mm512_castps128_ps512(_mm_loadu_ps(a));
        let value = _mm512_insertf32x4::<1>(value, _mm_loadu_ps(b));
        let value = _mm512_insertf32x4::<2>(value, _mm_loadu_ps(c));
        _mm512_insertf32x4::<3>(value, _mm_loadu_ps(d))
    }
}

impl Avx512 {
    /// Where an index is inside a table of this length, as far as an offset reaches.
    #[inline(always)]
    fn inside(self, length: usize, index: __m512i) -> __mmask16 {
        self.less_u32(index, self.splat_u32(length.min(i32::MAX as usize) as u32))
    }

    /// [`Lanes::gather_pairs`] where some indices are beyond the end.
    #[cold]
    fn gather_pairs_of_some(self, table: &[[u32; 2]], index: &[u32]) -> [__m512i; 2] {
        let [first, second] = gather_pairs(table, index, WIDTH);
        [self.load_u32(&first), self.load_u32(&second)]
    }
}

/// Four elements from each of four places, counted from the first.
///
/// # Safety
/// The processor must have AVX-512, and there must be four elements at all places.
#[inline(always)]
unsafe fn quadruple(first: *const f32, [a, b, c, d]: [u32; 4]) -> __m512 {
    // SAFETY: the caller's.
    unsafe {
        let low = _mm256_loadu2_m128(first.add(b as usize), first.add(a as usize));
        let high = _mm256_loadu2_m128(first.add(d as usize), first.add(c as usize));
        _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high)
    }
}

/// Rows of four as columns, in each quarter.
///
/// # Safety
/// The processor must have AVX-512.
#[inline(always)]
unsafe fn transposed([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: the caller's.
    unsafe {
        let (low, high) = (_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
        let (low_next, high_next) = (_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
        [
            _mm512_shuffle_ps::<0b01_00_01_00>(low, low_next),
            _mm512_shuffle_ps::<0b11_10_11_10>(low, low_next),
            _mm512_shuffle_ps::<0b01_00_01_00>(high, high_next),
            _mm512_shuffle_ps::<0b11_10_11_10>(high, high_next),
        ]
    }
}
