//! Passes over lines: each does several stages of all lines for groups of elements held in registers.

use super::butterflies::{Complex, Stages};
use super::factors::{self, AtZero, Same};
use crate::lanes::{Comb, Kernel, Lanes, Sixteen, combs};
use core::marker::PhantomData;
use meniscus_core::transform::Complex32;

/// Lanes `part` … `part` + width − 1 of a block.
#[inline(always)]
pub(crate) fn load<L: Lanes>(lanes: L, block: &Sixteen, part: usize) -> Complex<L> {
    let (re, im) = block.0.split_at(16);
    Complex { re: lanes.load_f32(&re[part..]), im: lanes.load_f32(&im[part..]) }
}

/// Lanes `part` … `part` + width − 1 of a block in bit-reversed order.
#[inline(always)]
pub(crate) fn load_reversed<L: Lanes>(lanes: L, block: &Sixteen, part: usize) -> Complex<L> {
    Complex { re: lanes.load_reversed_f32(block.re(), part), im: lanes.load_reversed_f32(block.im(), part) }
}

/// Writes lanes `part` … `part` + width − 1 of a block.
#[inline(always)]
pub(crate) fn store<L: Lanes>(lanes: L, value: Complex<L>, block: &mut Sixteen, part: usize) {
    let (re, im) = block.0.split_at_mut(16);
    lanes.store_f32(value.re, &mut re[part..]);
    lanes.store_f32(value.im, &mut im[part..]);
}

/// Asks for a block to be brought near.
#[inline(always)]
pub(crate) fn prefetch<L: Lanes>(lanes: L, block: &Sixteen, part: usize) {
    // The first part asks for the real parts, the last for the imaginary ones.
    if part == 0 {
        lanes.prefetch(&block.0[0]);
    }
    if part + L::WIDTH == 16 {
        lanes.prefetch(&block.0[16]);
    }
}

/// Where the elements of lines come from.
pub(crate) trait Source {
    /// Lanes `part` … of element `index`; `upper` says whether it is in the second half of the line.
    fn load<L: Lanes>(&self, lanes: L, index: usize, upper: bool, part: usize) -> Complex<L>;
}

/// Where the elements of transformed lines go.
pub(crate) trait Sink {
    /// Takes lanes `part` … of element `index`, whose place in the memory the pass works in is `place`.
    fn store<L: Lanes>(
        &mut self,
        lanes: L,
        place: &mut Sixteen,
        index: usize,
        part: usize,
        value: Complex<L>,
    );
}

/// Elements from a slice.
pub(crate) struct FromSlice<'a>(pub(crate) &'a [Sixteen]);

impl Source for FromSlice<'_> {
    #[inline(always)]
    fn load<L: Lanes>(&self, lanes: L, index: usize, _upper: bool, part: usize) -> Complex<L> {
        load(lanes, &self.0[index], part)
    }
}

/// Elements stay in the scratch memory.
pub(crate) struct InPlace;

impl Sink for InPlace {
    #[inline(always)]
    fn store<L: Lanes>(
        &mut self,
        lanes: L,
        place: &mut Sixteen,
        _index: usize,
        part: usize,
        value: Complex<L>,
    ) {
        store(lanes, value, place, part);
    }
}

/// A pass after the first: joins `radix` blocks of `span` elements.
#[derive(Clone, Debug)]
struct Pass {
    radix: usize,
    span: usize,
    factors: Vec<[f32; 2]>,
}

/// The passes of a transform of a given length.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    points: usize,
    first: usize,
    start: AtZero,
    passes: Vec<Pass>,
}

/// Numbers each pass joins, for lines of 2^`exponent` elements.
fn radices(exponent: u32, width: usize) -> &'static [usize] {
    match (exponent, width) {
        (4, 16) => &[4, 4],
        (5, 16) => &[4, 8],
        (6, 16) => &[8, 8],
        (7, 16) => &[4, 4, 8],
        (8, 16) => &[4, 8, 8],
        (9, 16) => &[8, 8, 8],
        (10, 16) => &[4, 4, 8, 8],
        (11, 16) => &[4, 8, 8, 8],
        (12, 16) => &[8, 8, 8, 8],
        (4, _) => &[4, 4],
        (5, _) => &[8, 4],
        (6, _) => &[4, 4, 4],
        (7, _) => &[8, 4, 4],
        (8, _) => &[4, 4, 4, 4],
        (9, _) => &[8, 4, 4, 4],
        (10, _) => &[4, 4, 4, 4, 4],
        (11, _) => &[8, 4, 4, 4, 4],
        (12, _) => &[4, 4, 4, 4, 4, 4],
        _ => &[],
    }
}

impl Plan {
    /// The plan for lines of 2^`exponent` ≤ M elements, for registers of `width` numbers; `turns` as
    /// [`factors::turns`] gives for M.
    pub(crate) fn new(exponent: u32, turns: &[Complex32], width: usize) -> Self {
        let mut radices = radices(exponent, width).iter().copied();
        let first = radices.next().unwrap_or(2);
        let mut span = first;
        let passes = radices
            .map(|radix| {
                let pass = Pass { radix, span, factors: factors::of_elements(turns, span, radix) };
                span *= radix;
                pass
            })
            .collect();
        Self { points: 1 << exponent, first, start: AtZero::new(turns), passes }
    }

    /// Number of elements of a line.
    pub(crate) const fn points(&self) -> usize {
        self.points
    }

    /// Transforms lines from `source` to `sink`, with `scratch` of as many blocks as a line has elements.
    #[inline(always)]
    pub(crate) fn run<L: Lanes>(
        &self,
        lanes: L,
        scratch: &mut [Sixteen],
        source: &impl Source,
        sink: &mut impl Sink,
    ) {
        let scratch = &mut scratch[..self.points];
        let Some((last, middle)) = self.passes.split_last() else {
            self.first(lanes, 0, scratch, source);
            for (index, place) in scratch.iter_mut().enumerate() {
                for part in (0..16).step_by(L::WIDTH) {
                    let value = load(lanes, place, part);
                    sink.store(lanes, place, index, part, value);
                }
            }
            return;
        };
        // What is joined last is done block by block before, so that it stays in the nearest cache.
        for (number, block) in scratch.chunks_exact_mut(last.span).enumerate() {
            self.first(lanes, number * last.span, block, source);
            for pass in middle {
                pass.join_blocks(lanes, self.start, block);
            }
        }
        last.join(lanes, self.start, scratch, sink);
    }

    /// The first pass alone, to all of `scratch`.
    #[inline(always)]
    pub(crate) fn begin<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], source: &impl Source) {
        self.first(lanes, 0, &mut scratch[..self.points], source);
    }

    /// All passes but the first, in place.
    #[inline(always)]
    pub(crate) fn finish<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen]) {
        for pass in &self.passes {
            pass.join_blocks(lanes, self.start, &mut scratch[..self.points]);
        }
    }

    /// The first pass, for the elements whose places begin with `offset`.
    #[inline(always)]
    fn first<L: Lanes>(&self, lanes: L, offset: usize, block: &mut [Sixteen], source: &impl Source) {
        match self.first {
            4 => lanes.apart(First::<Four, _> { plan: self, offset, block, source, radix: PhantomData }),
            8 => lanes.apart(First::<Eight, _> { plan: self, offset, block, source, radix: PhantomData }),
            _ => {
                lanes.apart(First::<SixteenFold, _> { plan: self, offset, block, source, radix: PhantomData })
            }
        }
    }
}

/// A first pass: loads in bit-reversed order.
struct First<'a, R, S> {
    plan: &'a Plan,
    offset: usize,
    block: &'a mut [Sixteen],
    source: &'a S,
    radix: PhantomData<R>,
}

impl<R: Radix, S: Source> Kernel for First<'_, R, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let stride = self.plan.points / R::RADIX;
        // Of a group's number, as many bits as there are groups.
        let shift = usize::BITS - stride.trailing_zeros();
        for (group, block) in self.block.chunks_exact_mut(R::RADIX).enumerate() {
            let group = self.offset / R::RADIX + group;
            let base = group.reverse_bits().checked_shr(shift).unwrap_or(0);
            for part in (0..16).step_by(L::WIDTH) {
                let x = R::Numbers::<L>::from_source(lanes, self.source, base, stride, part);
                let x = x.joined(lanes, self.plan.start);
                for mut comb in R::Numbers::<L>::combs(block) {
                    x.to_sink(lanes, &mut comb, 0, 1, part, &mut InPlace);
                }
            }
        }
    }
}

impl Pass {
    /// Joins all groups of blocks, in place.
    #[inline(always)]
    fn join_blocks<L: Lanes>(&self, lanes: L, start: AtZero, data: &mut [Sixteen]) {
        self.join(lanes, start, data, &mut InPlace);
    }

    /// Joins groups of blocks.
    #[inline(always)]
    fn join<L: Lanes>(&self, lanes: L, start: AtZero, data: &mut [Sixteen], sink: &mut impl Sink) {
        match self.radix {
            4 => lanes.apart(Join::<Four, _> { pass: self, start, data, sink, radix: PhantomData }),
            8 => lanes.apart(Join::<Eight, _> { pass: self, start, data, sink, radix: PhantomData }),
            _ => lanes.apart(Join::<SixteenFold, _> { pass: self, start, data, sink, radix: PhantomData }),
        }
    }
}

/// A pass after the first.
struct Join<'a, R, K> {
    pass: &'a Pass,
    start: AtZero,
    data: &'a mut [Sixteen],
    sink: &'a mut K,
    radix: PhantomData<R>,
}

impl<R: Radix, K: Sink> Kernel for Join<'_, R, K> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let span = self.pass.span;
        for data in self.data.chunks_exact_mut(R::RADIX * span) {
            let mut combs = R::Numbers::<L>::combs(data);
            if let Some(mut comb) = combs.next() {
                for part in (0..16).step_by(L::WIDTH) {
                    let x = R::Numbers::<L>::from_comb(lanes, &comb, part);
                    x.joined(lanes, self.start).to_sink(lanes, &mut comb, 0, span, part, self.sink);
                }
            }
            let factors = self.pass.factors.chunks_exact(R::RADIX / 2);
            for (element, (factors, mut comb)) in factors.zip(combs).enumerate() {
                for part in (0..16).step_by(L::WIDTH) {
                    let x = R::Numbers::<L>::from_comb(lanes, &comb, part);
                    x.joined(lanes, Same(factors)).to_sink(
                        lanes,
                        &mut comb,
                        element + 1,
                        span,
                        part,
                        self.sink,
                    );
                }
            }
        }
    }
}

/// How many numbers a pass joins.
pub(crate) trait Radix {
    const RADIX: usize;
    type Numbers<L: Lanes>: Numbers<L>;
}

pub(crate) struct Four;
pub(crate) struct Eight;
pub(crate) struct SixteenFold;

/// Elements at equal distances, to registers and back. Written out, so that no loop stands between memory and registers.
pub(crate) trait Numbers<L: Lanes>: Stages<L> {
    /// Elements base + j·stride of a source, the j in bit-reversed order.
    fn from_source(lanes: L, source: &impl Source, base: usize, stride: usize, part: usize) -> Self;
    /// As many blocks of a slice, at the largest equal distances.
    type Comb<'a>;
    /// All combs of a slice.
    fn combs(data: &mut [Sixteen]) -> impl Iterator<Item = Self::Comb<'_>>;
    /// The elements of a comb.
    fn from_comb(lanes: L, comb: &Self::Comb<'_>, part: usize) -> Self;
    /// To elements base + i·stride of a sink, where they have the places of a comb.
    fn to_sink(
        self,
        lanes: L,
        comb: &mut Self::Comb<'_>,
        base: usize,
        stride: usize,
        part: usize,
        sink: &mut impl Sink,
    );
}

macro_rules! numbers {
    ($name:ident, $count:literal: $($i:literal)*; $($reversed:literal)*) => {
        impl Radix for $name {
            const RADIX: usize = $count;
            type Numbers<L: Lanes> = [Complex<L>; $count];
        }

        impl<L: Lanes> Numbers<L> for [Complex<L>; $count] {
            #[inline(always)]
            fn from_source(
                lanes: L,
                source: &impl Source,
                base: usize,
                stride: usize,
                part: usize,
            ) -> Self {
                [$(source.load(lanes, base + $reversed * stride, $reversed >= $count / 2, part)),*]
            }

            type Comb<'a> = Comb<'a, $count>;

            #[inline(always)]
            fn combs(data: &mut [Sixteen]) -> impl Iterator<Item = Comb<'_, $count>> {
                combs(data)
            }

            #[inline(always)]
            fn from_comb(lanes: L, comb: &Comb<'_, $count>, part: usize) -> Self {
                [$(load(lanes, comb.get::<$i>(), part)),*]
            }

            #[inline(always)]
            fn to_sink(
                self,
                lanes: L,
                comb: &mut Comb<'_, $count>,
                base: usize,
                stride: usize,
                part: usize,
                sink: &mut impl Sink,
            ) {
                $(sink.store(lanes, comb.get_mut::<$i>(), base + $i * stride, part, self[$i]);)*
            }
        }
    };
}

numbers!(Four, 4: 0 1 2 3; 0 2 1 3);
numbers!(Eight, 8: 0 1 2 3 4 5 6 7; 0 4 2 6 1 5 3 7);
numbers!(SixteenFold, 16: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; 0 8 4 12 2 10 6 14 1 9 5 13 3 11 7 15);
