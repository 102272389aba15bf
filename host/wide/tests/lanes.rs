//! Every operation of every kind of lanes against the same operation on single numbers.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_core::units::round_half_even;
use meniscus_wide::lanes::{
    Comb, Kernel, LOWER, Lanes, Level, REST, Rows, Runs, Sixteen, UPPER, combs, complex_of_sixteens,
};
use std::ops::Range;

/// A SplitMix64 sequence.
struct Sequence(u64);

impl Sequence {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    fn of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.bits() as usize % values.len()]
    }

    /// Any bits, numbers of moderate size, integers and halves, and the ends of ranges.
    fn number(&mut self) -> f32 {
        let bits = self.bits();
        match bits >> 62 {
            0 => f32::from_bits(bits as u32),
            1 => bits as i32 as f32 / 65536.0,
            2 => (bits as i32 >> (bits >> 40 & 31)) as f32 * 0.5,
            _ => self.of(&[
                0.0,
                -0.0,
                1.0,
                0.5,
                1.5,
                2.5,
                -2.5,
                f32::MIN_POSITIVE,
                -f32::from_bits(1),
                4_194_304.0,
                4_194_303.5,
                8_388_607.5,
                -8_388_608.0,
                16_777_217.0,
                2_147_483_520.0,
                2_147_483_648.0,
                -2_147_483_648.0,
                2_251_799_813_685_248.0,
                9.0e18,
                f32::MAX,
                f32::INFINITY,
                f32::NEG_INFINITY,
                f32::NAN,
            ]),
        }
    }

    fn integer(&mut self) -> u32 {
        let bits = self.bits();
        match bits >> 62 {
            0 | 1 => bits as u32 >> (bits >> 40 & 31),
            2 => (bits as u32 >> (bits >> 40 & 31)).wrapping_neg(),
            _ => self.of(&[0, 1, 2, 63, 64, 0x7FFF_FFFF, 0x8000_0000, 0x8000_0001, 0xFFFF_FFFF, 0x00FF_FFFF]),
        }
    }

    fn long(&mut self) -> u64 {
        let bits = self.bits();
        match bits & 3 {
            0 => bits,
            1 => (bits as i64 >> (self.bits() & 63)) as u64,
            2 => u64::from(bits as u32) << 32 | u64::from(self.integer()),
            _ => self.of(&[0, 1, u64::MAX, 1 << 63, (1 << 63) - 1, 1 << 51, (1 << 51) - 1, 1 << 32, 1 << 24]),
        }
    }
}

/// The bits, the same for all that is not a number.
fn bits(value: f32) -> u32 {
    if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() }
}

/// Two values a lane of each type.
struct Values {
    level: Level,
    f32: [[f32; 16]; 2],
    u32: [[u32; 16]; 2],
    u64: [[u64; 16]; 2],
    shift: u32,
}

impl Values {
    fn new(level: Level, sequence: &mut Sequence) -> Self {
        let f32 = [(); 2].map(|()| [(); 16].map(|()| sequence.number()));
        let mut u32 = [(); 2].map(|()| [(); 16].map(|()| sequence.integer()));
        // Some equal ones.
        u32[1][sequence.bits() as usize % 4] = u32[0][0];
        let u64 = [(); 2].map(|()| [(); 16].map(|()| sequence.long()));
        Self { level, f32, u32, u64, shift: sequence.bits() as u32 }
    }

    fn same_f32(&self, what: &str, found: [f32; 16], expected: impl Fn(usize) -> f32) {
        for (lane, found) in found.into_iter().enumerate().take(self.level.width()) {
            let (found, expected) = (bits(found), bits(expected(lane)));
            assert_eq!(found, expected, "{what}, lane {lane}, {}, {:?}", self.level.name(), self.f32);
        }
    }

    fn same<T: PartialEq + core::fmt::Debug>(
        &self,
        what: &str,
        found: [T; 16],
        expected: impl Fn(usize) -> T,
    ) {
        for (lane, found) in found.into_iter().enumerate().take(self.level.width()) {
            let name = self.level.name();
            assert_eq!(found, expected(lane), "{what}, lane {lane}, {name}, {:?}, {:?}", self.u32, self.u64);
        }
    }

    fn same_mask(&self, what: &str, found: u32, expected: impl Fn(usize) -> bool) {
        let expected = (0..self.level.width()).fold(0, |bits, lane| bits | u32::from(expected(lane)) << lane);
        assert_eq!(found, expected, "{what}, {}, {:?}, {:?}", self.level.name(), self.f32, self.u32);
    }
}

struct Numbers<'a>(&'a Values);

impl Kernel for Numbers<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self(values) = self;
        let [x, y] = &values.f32;
        let (a, b) = (l.load_f32(x), l.load_f32(y));
        let of = |value| l.array_f32(value);
        values.same_f32("splat", of(l.splat(x[3])), |_| x[3]);
        values.same_f32("add", of(l.add(a, b)), |i| x[i] + y[i]);
        values.same_f32("sub", of(l.sub(a, b)), |i| x[i] - y[i]);
        values.same_f32("mul", of(l.mul(a, b)), |i| x[i] * y[i]);
        values.same_f32("div", of(l.div(a, b)), |i| x[i] / y[i]);
        values.same_f32("abs", of(l.abs(a)), |i| x[i].abs());
        values.same_f32("negate", of(l.negate(a)), |i| -x[i]);
        let less = l.less(a, b);
        values.same_mask("less", l.bits(less), |i| x[i] < y[i]);
        values.same_f32("select", of(l.select(less, a, b)), |i| if x[i] < y[i] { x[i] } else { y[i] });
        values.same("to_bits", l.array_u32(l.to_bits(a)), |i| x[i].to_bits());
        let small = |value: f32| if value.abs() < 2_147_483_520.0 { value } else { 1.5 };
        let rounded = l.round(l.load_f32(&x.map(small)));
        values.same("round", l.array_u32(rounded), |i| round_half_even(small(x[i])) as u32);
        let finite = |value: f32| if value.abs() < 9.2e18 { value } else { -2.5 };
        let rounded = l.round_i64(l.load_f32(&x.map(finite)));
        values.same("round_i64", l.array_u64(rounded), |i| round_half_even(finite(x[i])) as u64);
        let (first, second) = l.interleave(a, b);
        let pairs: Vec<_> =
            of(first)[..L::WIDTH].iter().chain(&of(second)[..L::WIDTH]).copied().map(bits).collect();
        for (pair, i) in pairs.chunks_exact(2).zip(0..) {
            assert_eq!(pair, [bits(x[i]), bits(y[i])], "interleave, {}", values.level.name());
        }
    }
}

struct Integers<'a>(&'a Values);

impl Kernel for Integers<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self(values) = self;
        let [x, y] = &values.u32;
        let (a, b) = (l.load_u32(x), l.load_u32(y));
        let of = |value| l.array_u32(value);
        let shift = values.shift & 31;
        values.same("splat_u32", of(l.splat_u32(x[1])), |_| x[1]);
        values.same("add_u32", of(l.add_u32(a, b)), |i| x[i].wrapping_add(y[i]));
        values.same("sub_u32", of(l.sub_u32(a, b)), |i| x[i].wrapping_sub(y[i]));
        values.same("mul_u32", of(l.mul_u32(a, b)), |i| x[i].wrapping_mul(y[i]));
        values.same("and", of(l.and(a, b)), |i| x[i] & y[i]);
        values.same("xor", of(l.xor(a, b)), |i| x[i] ^ y[i]);
        values.same("shl", of(l.shl(a, shift)), |i| x[i] << shift);
        values.same("shr", of(l.shr(a, shift)), |i| x[i] >> shift);
        values.same("sar", of(l.sar(a, shift)), |i| (x[i] as i32 >> shift) as u32);
        values.same("high_product", of(l.high_product(a, b)), |i| {
            ((u64::from(x[i]) * u64::from(y[i])) >> 32) as u32
        });
        let (equal, less) = (l.equal(a, b), l.less_i32(a, b));
        values.same_mask("equal", l.bits(equal), |i| x[i] == y[i]);
        values.same_mask("less_i32", l.bits(less), |i| (x[i] as i32) < y[i] as i32);
        values.same_mask("less_u32", l.bits(l.less_u32(a, b)), |i| x[i] < y[i]);
        values.same_mask("both", l.bits(l.both(less, l.less_u32(a, b))), |i| {
            (x[i] as i32) < y[i] as i32 && x[i] < y[i]
        });
        values.same_mask("either", l.bits(l.either(less, equal)), |i| x[i] as i32 <= y[i] as i32);
        values.same("select_u32", of(l.select_u32(less, a, b)), |i| (x[i] as i32).min(y[i] as i32) as u32);
        values.same_f32("of_bits", l.array_f32(l.of_bits(a)), |i| f32::from_bits(x[i]));
        values.same_f32("of_i32", l.array_f32(l.of_i32(a)), |i| x[i] as i32 as f32);
        values.same_f32("of_u32", l.array_f32(l.of_u32(a)), |i| x[i] as f32);
        values.same("product", l.array_u64(l.product(a, b)), |i| u64::from(x[i]) * u64::from(y[i]));
        values.same("widen_u32", l.array_u64(l.widen_u32(a)), |i| u64::from(x[i]));
        values.same("widen_i32", l.array_u64(l.widen_i32(a)), |i| i64::from(x[i] as i32) as u64);
        let mut places = [0; 16];
        let count = l.compress(less, a, &mut places);
        let expected: Vec<_> = (0..L::WIDTH).filter(|&i| (x[i] as i32) < y[i] as i32).map(|i| x[i]).collect();
        assert_eq!(places[..count], expected, "compress, {}", values.level.name());
        let mut eights = [[0; 8]; 16];
        let (s, d, p, e) = (l.add_u32(a, b), l.sub_u32(a, b), l.mul_u32(a, b), l.xor(a, b));
        l.store_eights([a, b, l.and(a, b), s, d, p, e, b], &mut eights);
        values.same("store_eights", eights, |i| {
            let (x, y) = (x[i], y[i]);
            [x, y, x & y, x.wrapping_add(y), x.wrapping_sub(y), x.wrapping_mul(y), x ^ y, y]
        });
    }
}

struct Longs<'a>(&'a Values);

impl Kernel for Longs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self(values) = self;
        let [x, y] = &values.u64;
        let (a, b) = (l.load_u64(x), l.load_u64(y));
        let of = |value| l.array_u64(value);
        let shift = values.shift & 63;
        values.same("splat_u64", of(l.splat_u64(x[1])), |_| x[1]);
        values.same("add_u64", of(l.add_u64(a, b)), |i| x[i].wrapping_add(y[i]));
        values.same("mul_u64", of(l.mul_u64(a, b)), |i| x[i].wrapping_mul(y[i]));
        values.same("xor_u64", of(l.xor_u64(a, b)), |i| x[i] ^ y[i]);
        values.same("shr_u64", of(l.shr_u64(a, shift)), |i| x[i] >> shift);
        values.same("low", l.array_u32(l.low(a)), |i| x[i] as u32);
        values.same("high", l.array_u32(l.high(a)), |i| (x[i] >> 32) as u32);
        values.same_f32("of_i64", l.array_f32(l.of_i64(a)), |i| x[i] as i64 as f32);
    }
}

#[test]
fn every_operation_is_that_on_single_numbers() {
    let mut sequence = Sequence(1);
    for level in Level::available() {
        for _ in 0..2000 {
            let values = Values::new(level, &mut sequence);
            level.dispatch(Numbers(&values));
            level.dispatch(Integers(&values));
            level.dispatch(Longs(&values));
        }
    }
}

/// Loads, stores and gathers at the ends of slices.
struct Memory<'a> {
    values: &'a Values,
    numbers: &'a [f32],
}

impl Kernel for Memory<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { values, numbers } = self;
        let name = values.level.name();
        let length = numbers.len();
        let integers: Vec<_> = numbers.iter().map(|value| value.to_bits()).collect();
        let longs: Vec<_> = integers.iter().map(|&value| u64::from(value) << 20).collect();
        values.same_f32("load_f32", l.array_f32(l.load_f32(numbers)), |i| *numbers.get(i).unwrap_or(&0.0));
        values.same("load_u32", l.array_u32(l.load_u32(&integers)), |i| *integers.get(i).unwrap_or(&0));
        values.same("load_u64", l.array_u64(l.load_u64(&longs)), |i| *longs.get(i).unwrap_or(&0));
        // A store writes the width or what there is, and nothing more.
        let written = length.min(L::WIDTH);
        let mut stored = (vec![7.0; length], vec![7; length], vec![7; length]);
        l.store_f32(l.splat(1.0), &mut stored.0);
        l.store_u32(l.splat_u32(1), &mut stored.1);
        l.store_u64(l.splat_u64(1), &mut stored.2);
        for i in 0..length {
            let expected = if i < written { 1 } else { 7 };
            assert_eq!(
                (stored.0[i], stored.1[i], stored.2[i]),
                (expected as f32, expected, expected as u64),
                "{name}"
            );
        }
        let [index, other] = values.u32.map(|index| index.map(|index| index % (length as u32 + 3)));
        let any = values.u32[0];
        for index in [index, other, any] {
            let lanes = l.load_u32(&index);
            let of = |i: usize| numbers.get(index[i] as usize).copied().unwrap_or(0.0);
            values.same_f32("gather_f32", l.array_f32(l.gather_f32(numbers, lanes)), of);
            values.same("gather_u32", l.array_u32(l.gather_u32(&integers, lanes)), |i| of(i).to_bits());
            let pairs: Vec<_> = integers.iter().map(|&value| [value, !value]).collect();
            let pair = |i: usize| pairs.get(index[i] as usize).copied().unwrap_or([0, 0]);
            let [first, second] = l.gather_pairs(&pairs, &index);
            values.same("gather_pairs", l.array_u32(first), |i| pair(i)[0]);
            values.same("gather_pairs", l.array_u32(second), |i| pair(i)[1]);
            let mut table = [0.0; 64];
            table.iter_mut().zip(numbers.iter().cycle()).for_each(|(place, &value)| *place = value);
            values.same_f32("look_up", l.array_f32(l.look_up(&table, lanes)), |i| {
                table[index[i] as usize % 64]
            });
            let runs = l.gather_runs::<2>(numbers, lanes);
            for (element, run) in runs.as_flattened().iter().enumerate() {
                values.same_f32("gather_runs", l.array_f32(*run), |i| {
                    let Some(last) = length.checked_sub(8) else { return 0.0 };
                    numbers[last.min(index[i] as usize) + element]
                });
            }
        }
    }
}

#[test]
fn memory_is_read_and_written_to_its_ends() {
    let mut sequence = Sequence(2);
    for level in Level::available() {
        for length in 0..70 {
            let numbers: Vec<_> = (0..length).map(|_| sequence.number()).collect();
            // Gathers take bits as they are; what is no number is compared as such.
            let values = Values::new(level, &mut sequence);
            level.dispatch(Memory { values: &values, numbers: &numbers });
        }
    }
}

/// The orders in which lines are read.
struct Orders<'a>(&'a Values);

impl Kernel for Orders<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self(values) = self;
        let ([first, rest], integers) = (&values.f32, &values.u32[0]);
        let reversed = |lane: usize| (lane as u8).reverse_bits() as usize >> 4;
        let mirror = |lane: usize| if lane == 0 { first[0] } else { rest[16 - lane] };
        let mut rows = [Sixteen::ZERO; 16];
        for (number, value) in rows.iter_mut().flat_map(|row| &mut row.0).enumerate() {
            *value = number as f32;
        }
        for part in (0..16).step_by(L::WIDTH) {
            let of = |value| l.array_f32(value);
            values.same_f32("mirrored", of(l.mirrored(first, rest, part)), |i| mirror(part + i));
            values.same_f32("mirrored_reversed", of(l.mirrored_reversed(first, rest, part)), |i| {
                mirror(reversed(part + i))
            });
            values.same_f32("load_reversed_f32", of(l.load_reversed_f32(first, part)), |i| {
                first[reversed(part + i)]
            });
            values.same("load_reversed_u32", l.array_u32(l.load_reversed_u32(integers, part)), |i| {
                integers[reversed(part + i)]
            });
            for quarter in 0..4 {
                let halves = l.columns(&rows, quarter, part);
                for (half, columns) in halves.into_iter().enumerate() {
                    for (place, column) in columns.into_iter().enumerate() {
                        values.same_f32("columns", of(column), |i| {
                            rows[part + i].0[16 * half + 4 * quarter + place]
                        });
                    }
                }
            }
        }
    }
}

#[test]
fn lines_are_read_in_the_orders_that_are_said() {
    let mut sequence = Sequence(3);
    for level in Level::available() {
        for _ in 0..200 {
            level.dispatch(Orders(&Values::new(level, &mut sequence)));
        }
    }
}

/// Gives the width, as a function of its own.
struct Apart;

impl Kernel for Apart {
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        struct Width;
        impl Kernel for Width {
            type Output = usize;

            #[inline(always)]
            fn run<L: Lanes>(self, lanes: L) -> usize {
                lanes.prefetch(&0);
                lanes.prefetch(core::ptr::null::<u8>());
                L::WIDTH
            }
        }
        lanes.apart(Width)
    }
}

#[test]
fn a_kernel_apart_has_the_same_lanes() {
    for level in Level::available() {
        assert_eq!(level.dispatch(Apart), level.width());
    }
}

#[test]
fn combs_have_every_block_once() {
    for length in [0, 3, 4, 7, 32] {
        let mut blocks = vec![Sixteen::ZERO; length];
        for (offset, mut comb) in combs::<4>(&mut blocks).enumerate() {
            comb.get_mut::<0>().0[0] += (offset + 1) as f32;
            comb.get_mut::<1>().0[0] += (offset + 101) as f32;
            comb.get_mut::<2>().0[0] += (offset + 201) as f32;
            comb.get_mut::<3>().0[0] += (offset + 301) as f32;
            assert_eq!(comb.get::<3>().0[0], (offset + 301) as f32);
        }
        let distance = length / 4;
        for (place, block) in blocks.iter().enumerate() {
            let expected =
                if place < 4 * distance { 100 * (place / distance) + place % distance + 1 } else { 0 };
            assert_eq!(block.0[0], expected as f32, "block {place} of {length}");
        }
    }
}

#[test]
fn combs_of_some_blocks_are_inside_and_apart() {
    let mut blocks = vec![Sixteen::ZERO; 10];
    for (first, distance, there) in
        [(0, 3, true), (1, 3, false), (0, 0, false), (9, usize::MAX, false), (usize::MAX, 1, false)]
    {
        assert_eq!(Comb::<4>::new(&mut blocks, first, distance).is_some(), there, "{first} {distance}");
    }
    let mut comb = Comb::<4>::new(&mut blocks, 0, 3).unwrap();
    comb.get_mut::<3>().0[5] = 1.0;
    assert_eq!(blocks[9].0[5], 1.0);
}

#[test]
fn runs_are_where_they_say_and_inside() {
    let numbers: Vec<u32> = (0..20).collect();
    let up = Runs::<u32, 4, 2>::new(&numbers, 3, 5).unwrap();
    assert_eq!(
        [up.get::<0>(), up.get::<1>(), up.get::<2>(), up.get::<3>()],
        [&[3, 4], &[8, 9], &[13, 14], &[18, 19]]
    );
    let down = Runs::<u32, 4, 1>::new(&numbers, 19, -6).unwrap();
    assert_eq!([down.get::<0>(), down.get::<3>()], [&[19], &[1]]);
    assert!(
        Runs::<u32, 4, 3>::new(&numbers, 3, 5).is_none()
            && Runs::<u32, 4, 1>::new(&numbers, 17, -6).is_none()
    );
    for distance in [isize::MIN, isize::MAX, isize::MAX / 2, isize::MIN / 3] {
        for first in [0, 19, usize::MAX, usize::MAX / 2 + 1] {
            assert!(Runs::<u32, 4, 1>::new(&numbers, first, distance).is_none(), "{first} {distance}");
        }
    }
    // Of a part only that has to be inside, and what is not there is the nearest that is.
    let lower = Runs::<u32, 4, 1, LOWER>::new(&numbers, 8, 10).unwrap();
    assert_eq!([lower.get::<0>(), lower.get::<1>(), lower.get::<3>()], [&[8], &[18], &[18]]);
    let upper = Runs::<u32, 4, 1, UPPER>::new(&numbers, 39, -10).unwrap();
    assert_eq!([upper.get::<0>(), upper.get::<2>(), upper.get::<3>()], [&[19], &[19], &[9]]);
    let rest = Runs::<u32, 4, 1, REST>::new(&numbers, 20, -5).unwrap();
    assert_eq!([rest.get::<0>(), rest.get::<1>(), rest.get::<3>()], [&[15], &[15], &[5]]);
    assert!(Runs::<u32, 4, 1, REST>::new(&numbers, 25, -5).is_none());
}

/// Marks every block of some rows with their numbers.
fn mark(rows: &mut Rows<'_>, numbers: Range<usize>, columns: usize) {
    assert_eq!(rows.count(), numbers.len());
    for (row, number) in numbers.enumerate() {
        for column in 0..columns {
            let (mut blocks, _) = rows.row_and_next(row).unwrap();
            let mut comb = blocks.comb::<1>(column, Rows::TOGETHER).unwrap();
            let block = comb.get_mut::<0>();
            assert_eq!(block.0[0], 0.0, "row {number}, column {column} is not its own");
            block.0[0] = (1000 * number + column + 1) as f32;
        }
    }
}

#[test]
#[cfg_attr(target_family = "wasm", ignore = "there are no threads")]
fn rows_have_blocks_of_their_own() {
    let (pitch, groups) = (5 * Rows::TOGETHER, 3);
    let mut blocks = vec![Sixteen::ZERO; pitch * groups + 7];
    let columns = groups * Rows::TOGETHER;
    let (mut first, rest) = Rows::new(&mut blocks, pitch).split(2);
    let (mut second, mut none) = rest.split(9);
    std::thread::scope(|scope| {
        scope.spawn(|| mark(&mut first, 0..2, columns));
        scope.spawn(|| mark(&mut second, 2..5, columns));
    });
    assert_eq!(none.count(), 0);
    for (rows, count) in [(&mut first, 2), (&mut second, 3), (&mut none, 0)] {
        assert!(rows.row_and_next(count).is_none() && rows.row_and_next(usize::MAX).is_none());
        let Some((mut row, _)) = rows.row_and_next(0) else { continue };
        let together = Rows::TOGETHER;
        for (column, distance) in [
            (columns, together),
            (usize::MAX, together),
            (columns - together, together),
            (0, usize::MAX - 7),
            (0, 1),
        ] {
            assert!(row.shared().runs::<2>(column, distance).is_none(), "{column} {distance}");
            assert!(row.comb::<2>(column, distance).is_none(), "{column} {distance}");
        }
        assert!(row.comb::<2>(0, 0).is_none(), "two teeth in one place");
        let runs = row.shared().runs::<3>(1, together).unwrap();
        let marks = [&runs.get::<0>()[0], &runs.get::<1>()[0], &runs.get::<2>()[0]].map(|block| block.0[0]);
        assert_eq!(marks.map(|mark| mark as usize % 1000), [2, 2 + together, 2 + 2 * together]);
    }
    for (place, block) in blocks.iter().enumerate() {
        let (group, row) = (place / pitch, place % pitch / Rows::TOGETHER);
        let column = group * Rows::TOGETHER + place % Rows::TOGETHER;
        let expected = if group < groups { 1000 * row + column + 1 } else { 0 };
        assert_eq!(block.0[0], expected as f32, "block {place}");
    }
    assert_eq!(Rows::new(&mut blocks, 0).count(), 0);
}

#[test]
fn blocks_of_pairs_are_complex_numbers() {
    let mut block = Sixteen::ZERO;
    block.0.iter_mut().zip(0u8..).for_each(|(number, value)| *number = f32::from(value));
    let numbers = [block];
    let complex = complex_of_sixteens(&numbers);
    assert_eq!((complex.len(), complex[3].re, complex[3].im), (16, 6.0, 7.0));
}
