//! Numbers side by side: one interface over the processor's wide registers, and the choice among them at run time.
//!
//! A computation is written once, as a [`Kernel`] generic over [`Lanes`], and [`Level::dispatch`] runs it with the
//! registers of a level. Whatever the level, each lane has the bits of the same operation on a single number: additions,
//! multiplications and divisions are those of IEEE 754 binary32, rounded to nearest, and never fused.
//!
//! This is the one place around the engine with unsafe code. It rests on one fact: a value of a type that implements
//! [`Lanes`] exists only where the processor has been seen to have the instructions.
//!
//! ```
//! use meniscus_wide::lanes::{Kernel, Lanes, Level};
//!
//! struct Double<'a>(&'a mut [f32]);
//!
//! impl Kernel for Double<'_> {
//!     type Output = ();
//!
//!     #[inline(always)]
//!     fn run<L: Lanes>(self, lanes: L) {
//!         for piece in self.0.chunks_mut(L::WIDTH) {
//!             let value = lanes.load_f32(piece);
//!             lanes.store_f32(lanes.add(value, value), piece);
//!         }
//!     }
//! }
//!
//! for level in Level::available() {
//!     let mut numbers = [1.0, 2.0, 3.0, 4.0, 5.0];
//!     level.dispatch(Double(&mut numbers));
//!     assert_eq!(numbers, [2.0, 4.0, 6.0, 8.0, 10.0]);
//! }
//! ```

#![allow(unsafe_code, reason = "the instructions of wide registers; each block says why it is sound")]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod combs;
mod level;
mod moves;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;
mod rows;
mod runs;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
mod sixteen;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod views;

pub use combs::{Comb, combs};
pub use level::{Kernel, Level};
pub use rows::{Addresses, Row, RowMut, Rows};
pub use runs::{ALL, LOWER, REST, Runs, UPPER};
pub use sixteen::{Sixteen, complex_of_sixteens, complex_of_sixteens_mut};
pub use views::{
    bits_of_fractions, bits_of_fractions_mut, bits_of_i32, bits_of_i32_mut, bits_of_i64, bits_of_i64_mut,
    parts_of_complex,
};

/// The numbers below 16 with their four bits reversed.
const REVERSED: [usize; 16] = [0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15];

/// The largest [`Lanes::WIDTH`].
pub const LARGEST_WIDTH: usize = 16;

/// `WIDTH` numbers side by side, and what can be done to all of them at once.
///
/// A value is a proof that the processor has the instructions, so all methods are safe. Loads take as many elements as
/// there are, up to the width, and fill up with zeros; stores write as many as there is room for. Integers wrap.
pub trait Lanes: Copy + Send + Sync + 'static {
    /// How many numbers are side by side: 4, 8 or 16.
    const WIDTH: usize;
    /// Numbers of binary32.
    type F32: Copy;
    /// Integers of 32 bits, read as signed or not as the operation says.
    type U32: Copy;
    /// As many integers of 64 bits.
    type U64: Copy;
    /// A truth value a lane.
    type Mask: Copy;

    /// The same number in all lanes.
    fn splat(self, value: f32) -> Self::F32;
    /// The first elements of a slice.
    fn load_f32(self, from: &[f32]) -> Self::F32;
    /// Writes to the first elements of a slice.
    fn store_f32(self, value: Self::F32, to: &mut [f32]);
    /// a + b.
    fn add(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// a − b.
    fn sub(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// a·b.
    fn mul(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// a / b.
    fn div(self, a: Self::F32, b: Self::F32) -> Self::F32;
    /// Where a < b.
    fn less(self, a: Self::F32, b: Self::F32) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(self, mask: Self::Mask, yes: Self::F32, no: Self::F32) -> Self::F32;

    /// The same integer in all lanes.
    fn splat_u32(self, value: u32) -> Self::U32;
    /// The first elements of a slice.
    fn load_u32(self, from: &[u32]) -> Self::U32;
    /// Writes to the first elements of a slice.
    fn store_u32(self, value: Self::U32, to: &mut [u32]);
    /// a + b.
    fn add_u32(self, a: Self::U32, b: Self::U32) -> Self::U32;
    /// a − b.
    fn sub_u32(self, a: Self::U32, b: Self::U32) -> Self::U32;
    /// The lower 32 bits of a·b.
    fn mul_u32(self, a: Self::U32, b: Self::U32) -> Self::U32;
    /// Bits in both.
    fn and(self, a: Self::U32, b: Self::U32) -> Self::U32;
    /// Bits in one of both.
    fn xor(self, a: Self::U32, b: Self::U32) -> Self::U32;
    /// Shifted to the left by `bits` < 32.
    fn shl(self, a: Self::U32, bits: u32) -> Self::U32;
    /// Shifted to the right by `bits` < 32, zeros moving in.
    fn shr(self, a: Self::U32, bits: u32) -> Self::U32;
    /// Shifted to the right by `bits` < 32, the sign moving in.
    fn sar(self, a: Self::U32, bits: u32) -> Self::U32;
    /// Where a = b.
    fn equal(self, a: Self::U32, b: Self::U32) -> Self::Mask;
    /// Where a < b, both read as signed.
    fn less_i32(self, a: Self::U32, b: Self::U32) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select_u32(self, mask: Self::Mask, yes: Self::U32, no: Self::U32) -> Self::U32;

    /// Where both are true.
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Where either is true.
    fn either(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One bit a lane, the first lane the lowest.
    fn bits(self, mask: Self::Mask) -> u32;

    /// The bits of the numbers.
    fn to_bits(self, a: Self::F32) -> Self::U32;
    /// The numbers of these bits.
    fn of_bits(self, a: Self::U32) -> Self::F32;
    /// The number nearest to an integer read as signed.
    fn of_i32(self, a: Self::U32) -> Self::F32;
    /// The integer nearest to a number of modulus below 2³¹, ties to even; any integer for others.
    fn round(self, a: Self::F32) -> Self::U32;

    /// The same integer in all lanes.
    fn splat_u64(self, value: u64) -> Self::U64;
    /// The first elements of a slice.
    fn load_u64(self, from: &[u64]) -> Self::U64;
    /// Writes to the first elements of a slice.
    fn store_u64(self, value: Self::U64, to: &mut [u64]);
    /// a + b.
    fn add_u64(self, a: Self::U64, b: Self::U64) -> Self::U64;
    /// The lower 64 bits of a·b.
    fn mul_u64(self, a: Self::U64, b: Self::U64) -> Self::U64;
    /// The product of two integers of 32 bits, not signed.
    fn product(self, a: Self::U32, b: Self::U32) -> Self::U64;
    /// Bits in one of both.
    fn xor_u64(self, a: Self::U64, b: Self::U64) -> Self::U64;
    /// Shifted to the right by `bits` < 64, zeros moving in.
    fn shr_u64(self, a: Self::U64, bits: u32) -> Self::U64;
    /// The same integers with 64 bits, read as signed.
    fn widen_i32(self, a: Self::U32) -> Self::U64;
    /// The lower 32 bits.
    fn low(self, a: Self::U64) -> Self::U32;
    /// The upper 32 bits.
    fn high(self, a: Self::U64) -> Self::U32;

    /// The elements of a table at these indices, not signed; 0 beyond its end. From index 2³¹ − 1 on it may be 0 before the
    /// end too: no offset in a register reaches farther.
    fn gather_f32(self, table: &[f32], index: Self::U32) -> Self::F32;
    /// The elements of a table at these indices, not signed; 0 beyond its end. From index 2³¹ − 1 on it may be 0 before the
    /// end too: no offset in a register reaches farther.
    fn gather_u32(self, table: &[u32], index: Self::U32) -> Self::U32;

    /// The pairs of a table at as many indices, the first numbers of all and the second ones; 0 beyond its end.
    #[inline(always)]
    fn gather_pairs(self, table: &[[u32; 2]], index: &[u32]) -> [Self::U32; 2] {
        let [first, second] = gather_pairs(table, index, Self::WIDTH);
        [self.load_u32(&first), self.load_u32(&second)]
    }

    /// The elements of a short table at the lowest six bits of these indices.
    #[inline(always)]
    fn look_up(self, table: &[f32; 64], index: Self::U32) -> Self::F32 {
        self.gather_f32(table, self.and(index, self.splat_u32(63)))
    }

    /// Asks for the memory of elements that are of use soon, where there is an instruction for that.
    #[inline(always)]
    fn prefetch_slice<T>(self, _elements: &[T]) {}

    /// Runs of 4·`K` elements of a table that begin at these indices, not signed: `[k][i]` holds element 4k + i of each.
    /// A run that would reach beyond the end is moved up to it; a table shorter than a run gives zeros.
    #[inline(always)]
    fn gather_runs<const K: usize>(self, table: &[f32], index: Self::U32) -> [[Self::F32; 4]; K] {
        let mut runs = [[self.splat(0.0); 4]; K];
        let Some(last) = table.len().checked_sub(4 * K) else { return runs };
        let begins = self.array_u32(index).map(|index| last.min(index as usize));
        for (k, run) in runs.iter_mut().enumerate() {
            for (i, element) in run.iter_mut().enumerate() {
                let of = |begin: usize| table.get(begin + 4 * k + i).copied().unwrap_or(0.0);
                *element = self.load_f32(&begins.map(of));
            }
        }
        runs
    }

    /// Writes eight integers a lane, those of each lane side by side.
    #[inline(always)]
    fn store_eights(self, columns: [Self::U32; 8], to: &mut [[u32; 8]; LARGEST_WIDTH]) {
        let columns = columns.map(|column| self.array_u32(column));
        for (lane, eight) in to.iter_mut().enumerate().take(Self::WIDTH) {
            *eight = columns.map(|column| column[lane]);
        }
    }

    /// The upper 32 bits of the product of two integers of 32 bits, not signed.
    #[inline(always)]
    fn high_product(self, a: Self::U32, b: Self::U32) -> Self::U32 {
        self.high(self.product(a, b))
    }

    /// The same integers, not signed, with 64 bits.
    #[inline(always)]
    fn widen_u32(self, a: Self::U32) -> Self::U64 {
        self.product(a, self.splat_u32(1))
    }

    /// The number nearest to an integer of 64 bits read as signed, ties to even.
    #[inline(always)]
    fn of_i64(self, a: Self::U64) -> Self::F32 {
        self.load_f32(&self.array_u64(a).map(|a| a as i64 as f32))
    }

    /// The number nearest to an integer not read as signed.
    #[inline(always)]
    fn of_u32(self, a: Self::U32) -> Self::F32 {
        // Both halves are exact, so that the sum is rounded once.
        let upper = self.mul(self.of_i32(self.shr(a, 16)), self.splat(65536.0));
        let lower = self.of_i32(self.and(a, self.splat_u32(0xFFFF)));
        self.add(upper, lower)
    }

    /// |a|.
    #[inline(always)]
    fn abs(self, a: Self::F32) -> Self::F32 {
        self.of_bits(self.and(self.to_bits(a), self.splat_u32(0x7FFF_FFFF)))
    }

    /// −a, of a zero too.
    #[inline(always)]
    fn negate(self, a: Self::F32) -> Self::F32 {
        self.of_bits(self.xor(self.to_bits(a), self.splat_u32(0x8000_0000)))
    }

    /// Where a < b, neither read as signed.
    #[inline(always)]
    fn less_u32(self, a: Self::U32, b: Self::U32) -> Self::Mask {
        let sign = self.splat_u32(0x8000_0000);
        self.less_i32(self.xor(a, sign), self.xor(b, sign))
    }

    /// The numbers as an array, the lanes beyond the width 0.
    #[inline(always)]
    fn array_f32(self, a: Self::F32) -> [f32; LARGEST_WIDTH] {
        let mut array = [0.0; LARGEST_WIDTH];
        self.store_f32(a, &mut array);
        array
    }

    /// The integers as an array, the lanes beyond the width 0.
    #[inline(always)]
    fn array_u32(self, a: Self::U32) -> [u32; LARGEST_WIDTH] {
        let mut array = [0; LARGEST_WIDTH];
        self.store_u32(a, &mut array);
        array
    }

    /// The integers as an array, the lanes beyond the width 0.
    #[inline(always)]
    fn array_u64(self, a: Self::U64) -> [u64; LARGEST_WIDTH] {
        let mut array = [0; LARGEST_WIDTH];
        self.store_u64(a, &mut array);
        array
    }

    /// The signed integer nearest to a finite number, as [`meniscus_core::units::round_half_even`] says, of modulus
    /// below 2⁶³.
    #[inline(always)]
    fn round_i64(self, a: Self::F32) -> Self::U64 {
        let fits = self.less(self.abs(a), self.splat(2_147_483_648.0));
        if self.bits(fits) == (1 << Self::WIDTH) - 1 {
            return self.widen_i32(self.round(a));
        }
        let mut rounded = [0; LARGEST_WIDTH];
        for (rounded, value) in rounded.iter_mut().zip(self.array_f32(a)) {
            *rounded = meniscus_core::units::round_half_even(value) as u64;
        }
        self.load_u64(&rounded)
    }

    /// Writes the lanes where the mask is true, in their order, to the beginning of `to`, and says how many they are;
    /// elements after them, up to the width, may be written to as well.
    #[inline(always)]
    fn compress(self, mask: Self::Mask, a: Self::U32, to: &mut [u32; LARGEST_WIDTH]) -> usize {
        let bits = self.bits(mask);
        let mut count = 0;
        for (lane, value) in self.array_u32(a).into_iter().enumerate().take(Self::WIDTH) {
            if let Some(place) = to.get_mut(count) {
                *place = value;
            }
            count += (bits >> lane & 1) as usize;
        }
        count
    }

    /// Pairs a₀ b₀ a₁ b₁ …, the first half of them and the second.
    #[inline(always)]
    fn interleave(self, a: Self::F32, b: Self::F32) -> (Self::F32, Self::F32) {
        let (a, b) = (self.array_f32(a), self.array_f32(b));
        let mut pairs = [0.0; 2 * LARGEST_WIDTH];
        for (pair, (a, b)) in pairs.chunks_exact_mut(2).zip(a.into_iter().zip(b)) {
            pair.copy_from_slice(&[a, b]);
        }
        let (first, second) = pairs.split_at(Self::WIDTH);
        (self.load_f32(first), self.load_f32(second))
    }

    /// Lanes `part` … `part` + width − 1 of sixteen: `first[0]`, `rest[15]`, `rest[14]` … `rest[1]`.
    ///
    /// `part` is a multiple of the width below 16.
    #[inline(always)]
    fn mirrored(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> Self::F32 {
        let mut array = [0.0; LARGEST_WIDTH];
        for (lane, value) in array.iter_mut().enumerate().take(Self::WIDTH) {
            let index = (16 - part - lane) & 15;
            *value = if part + lane == 0 { first[0] } else { rest[index] };
        }
        self.load_f32(&array)
    }

    /// As [`mirrored`](Self::mirrored), the lanes of sixteen in bit-reversed order.
    #[inline(always)]
    fn mirrored_reversed(self, first: &[f32; 16], rest: &[f32; 16], part: usize) -> Self::F32 {
        let mut array = [0.0; LARGEST_WIDTH];
        for (value, lane) in array.iter_mut().zip(REVERSED.into_iter().skip(part)).take(Self::WIDTH) {
            *value = if lane == 0 { first[0] } else { rest[16 - lane] };
        }
        self.load_f32(&array)
    }

    /// Lanes `part` … `part` + width − 1 of sixteen in bit-reversed order: elements 0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13,
    /// 3, 11, 7, 15.
    ///
    /// `part` is a multiple of the width below 16.
    #[inline(always)]
    fn load_reversed_f32(self, from: &[f32; 16], part: usize) -> Self::F32 {
        let mut array = [0.0; LARGEST_WIDTH];
        for (value, lane) in array.iter_mut().zip(REVERSED.into_iter().skip(part)).take(Self::WIDTH) {
            *value = from[lane];
        }
        self.load_f32(&array)
    }

    /// As [`load_reversed_f32`](Self::load_reversed_f32).
    #[inline(always)]
    fn load_reversed_u32(self, from: &[u32; 16], part: usize) -> Self::U32 {
        let mut array = [0; LARGEST_WIDTH];
        for (value, lane) in array.iter_mut().zip(REVERSED.into_iter().skip(part)).take(Self::WIDTH) {
            *value = from[lane];
        }
        self.load_u32(&array)
    }

    /// Columns 4·`quarter` … 4·`quarter` + 3 of two squares of 16 × 16 numbers, the real and the imaginary parts, rows
    /// `part` … `part` + width − 1.
    ///
    /// `quarter` is less than 4 and `part` a multiple of the width below 16.
    #[inline(always)]
    fn columns(self, rows: &[Sixteen; 16], quarter: usize, part: usize) -> [[Self::F32; 4]; 2] {
        let mut columns = [[[0.0; LARGEST_WIDTH]; 4]; 2];
        for (lane, row) in rows.iter().skip(part).take(Self::WIDTH).enumerate() {
            for (half, columns) in columns.iter_mut().enumerate() {
                for (place, column) in columns.iter_mut().enumerate() {
                    column[lane] = row.0[16 * half + 4 * (quarter & 3) + place];
                }
            }
        }
        let [[a, b, c, d], [e, f, g, h]] = &columns;
        [
            [self.load_f32(a), self.load_f32(b), self.load_f32(c), self.load_f32(d)],
            [self.load_f32(e), self.load_f32(f), self.load_f32(g), self.load_f32(h)],
        ]
    }

    /// Runs a kernel as a function of its own, not as part of the one that calls it.
    #[inline(always)]
    fn apart<K: Kernel>(self, kernel: K) -> K::Output {
        #[inline(never)]
        fn apart<K: Kernel, L: Lanes>(kernel: K, lanes: L) -> K::Output {
            kernel.run(lanes)
        }
        apart(kernel, self)
    }

    /// Asks for a cache line to be brought into the second cache, where there is an instruction for that: not into the
    /// first, which what is being worked on needs for itself. There need not be anything at the address.
    #[inline(always)]
    fn prefetch<T>(self, _address: *const T) {}
}

/// The pairs of a table at the first `width` indices, the first numbers and the second ones; 0 beyond its end.
#[inline(always)]
fn gather_pairs(table: &[[u32; 2]], index: &[u32], width: usize) -> [[u32; LARGEST_WIDTH]; 2] {
    let mut pairs = [[0; LARGEST_WIDTH]; 2];
    let [first, second] = &mut pairs;
    for ((first, second), &index) in first.iter_mut().zip(second).zip(index).take(width) {
        [*first, *second] = table.get(index as usize).copied().unwrap_or([0; 2]);
    }
    pairs
}
