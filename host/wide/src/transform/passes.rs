//! Passes over lines: each does several stages of all lines for groups of elements held in registers.

use super::butterflies::{Complex, Stages};
use super::factors::{self, AtZero, Same};
use crate::lanes::{Comb, Kernel, Lanes, Runs, Sixteen, combs};
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
pub(crate) fn prefetch<L: Lanes>(lanes: L, block: *const Sixteen, part: usize) {
    let halves = block.cast::<[f32; 16]>();
    // The first part asks for the real parts, the last for the imaginary ones.
    if part == 0 {
        lanes.prefetch(halves);
    }
    if part + L::WIDTH == 16 {
        lanes.prefetch(halves.wrapping_add(1));
    }
}

/// Where the elements of lines come from. A copy, not a reference, so that what it holds stays in registers while numbers
/// are written.
pub(crate) trait Source: Copy {
    /// Elements at equal distances.
    type Elements<const COUNT: usize>: Elements;
    /// Elements base + j·stride of a line of `COUNT`·stride; none if there are no such elements.
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>>;
}

/// Elements of lines at equal distances.
pub(crate) trait Elements {
    /// Lanes `part` … of element `J`.
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L>;
}

/// Where the elements of transformed lines go.
pub(crate) trait Sink {
    /// Places at equal distances.
    type Places<'a, const COUNT: usize>: Places
    where
        Self: 'a;
    /// The places of elements base + i·stride; none if there are no such elements.
    fn places<const COUNT: usize>(&mut self, base: usize, stride: usize) -> Option<Self::Places<'_, COUNT>>;
}

/// Places for elements at equal distances.
pub(crate) trait Places {
    /// Takes lanes `part` … of element `I`, whose place in the memory the pass works in is `here`.
    fn store<L: Lanes, const I: usize>(
        &mut self,
        lanes: L,
        here: &mut Sixteen,
        part: usize,
        value: Complex<L>,
    );
}

/// Blocks in memory are elements.
impl<const COUNT: usize> Elements for Runs<'_, Sixteen, COUNT, 1> {
    #[inline(always)]
    fn load<L: Lanes, const J: usize>(&self, lanes: L, part: usize) -> Complex<L> {
        load(lanes, &self.get::<J>()[0], part)
    }
}

/// Elements from a slice.
#[derive(Clone, Copy)]
pub(crate) struct FromSlice<'a>(pub(crate) &'a [Sixteen]);

impl<'a> Source for FromSlice<'a> {
    type Elements<const COUNT: usize> = Runs<'a, Sixteen, COUNT, 1>;

    #[inline(always)]
    fn elements<const COUNT: usize>(self, base: usize, stride: usize) -> Option<Self::Elements<COUNT>> {
        Runs::new(self.0, base, stride as isize)
    }
}

/// Elements stay in the scratch memory.
pub(crate) struct InPlace;

impl Sink for InPlace {
    type Places<'a, const COUNT: usize> = Self;

    #[inline(always)]
    fn places<const COUNT: usize>(&mut self, _base: usize, _stride: usize) -> Option<Self> {
        Some(Self)
    }
}

impl Places for InPlace {
    #[inline(always)]
    fn store<L: Lanes, const I: usize>(
        &mut self,
        lanes: L,
        here: &mut Sixteen,
        part: usize,
        value: Complex<L>,
    ) {
        store(lanes, value, here, part);
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
        source: impl Source,
        sink: impl Sink,
    ) {
        let scratch = &mut scratch[..self.points];
        // A plan has at least two passes, see `radices`.
        let Some((last, middle)) = self.passes.split_last() else { return };
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
    pub(crate) fn begin<L: Lanes>(&self, lanes: L, scratch: &mut [Sixteen], source: impl Source) {
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
    fn first<L: Lanes>(&self, lanes: L, offset: usize, block: &mut [Sixteen], source: impl Source) {
        let (points, start) = (self.points, self.start);
        match self.first {
            4 => lanes.apart(First::<Four, _> { points, start, offset, block, source, radix: PhantomData }),
            _ => lanes.apart(First::<Eight, _> { points, start, offset, block, source, radix: PhantomData }),
        }
    }
}

/// A first pass: loads in bit-reversed order.
struct First<'a, R, S> {
    points: usize,
    start: AtZero,
    offset: usize,
    block: &'a mut [Sixteen],
    source: S,
    radix: PhantomData<R>,
}

impl<R: Radix, S: Source> Kernel for First<'_, R, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { points, start, offset, block, source, .. } = self;
        let stride = points / R::RADIX;
        // Of a group's number, as many bits as there are groups.
        let shift = usize::BITS - stride.trailing_zeros();
        for (group, block) in block.chunks_exact_mut(R::RADIX).enumerate() {
            let group = offset / R::RADIX + group;
            let base = group.reverse_bits().checked_shr(shift).unwrap_or(0);
            let Some(elements) = R::Numbers::<L>::elements(source, base, stride) else { return };
            for mut comb in R::Numbers::<L>::combs(block) {
                parts!(L, part, {
                    let x = R::Numbers::<L>::loaded(lanes, &elements, part).joined(lanes, start);
                    x.stored(lanes, &mut comb, &mut InPlace, part);
                });
            }
        }
    }
}

impl Pass {
    /// Joins all groups of blocks, in place.
    #[inline(always)]
    fn join_blocks<L: Lanes>(&self, lanes: L, start: AtZero, data: &mut [Sixteen]) {
        self.join(lanes, start, data, InPlace);
    }

    /// Joins groups of blocks.
    #[inline(always)]
    fn join<L: Lanes>(&self, lanes: L, start: AtZero, data: &mut [Sixteen], sink: impl Sink) {
        let Self { radix, span, ref factors } = *self;
        match radix {
            4 => lanes.apart(Join::<Four, _> { span, factors, start, data, sink, radix: PhantomData }),
            _ => lanes.apart(Join::<Eight, _> { span, factors, start, data, sink, radix: PhantomData }),
        }
    }
}

/// A pass after the first.
struct Join<'a, R, K> {
    span: usize,
    factors: &'a [[f32; 2]],
    start: AtZero,
    data: &'a mut [Sixteen],
    sink: K,
    radix: PhantomData<R>,
}

impl<R: Radix, K: Sink> Kernel for Join<'_, R, K> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { span, factors, start, data, mut sink, .. } = self;
        for data in data.chunks_exact_mut(R::RADIX * span) {
            let mut combs = R::Numbers::<L>::combs(data);
            if let Some(mut comb) = combs.next() {
                let Some(mut places) = R::Numbers::<L>::places(&mut sink, 0, span) else { return };
                parts!(L, part, {
                    let x = R::Numbers::<L>::from_comb(lanes, &comb, part);
                    x.joined(lanes, start).stored(lanes, &mut comb, &mut places, part);
                });
            }
            let factors = factors.chunks_exact(R::RADIX / 2);
            for (element, (factors, mut comb)) in (1..).zip(factors.zip(combs)) {
                let Some(mut places) = R::Numbers::<L>::places(&mut sink, element, span) else { return };
                parts!(L, part, {
                    let x = R::Numbers::<L>::from_comb(lanes, &comb, part);
                    x.joined(lanes, Same(factors)).stored(lanes, &mut comb, &mut places, part);
                });
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

/// Elements at equal distances, to registers and back. Written out, so that no loop stands between memory and registers.
pub(crate) trait Numbers<L: Lanes>: Stages<L> {
    /// As many elements of a source.
    type Elements<S: Source>: Elements;
    /// Elements base + j·stride of a source.
    fn elements<S: Source>(source: S, base: usize, stride: usize) -> Option<Self::Elements<S>>;
    /// Elements of a source, the j in bit-reversed order.
    fn loaded(lanes: L, elements: &impl Elements, part: usize) -> Self;
    /// As many blocks of a slice, at the largest equal distances.
    type Comb<'a>;
    /// All combs of a slice.
    fn combs(data: &mut [Sixteen]) -> impl Iterator<Item = Self::Comb<'_>>;
    /// The elements of a comb.
    fn from_comb(lanes: L, comb: &Self::Comb<'_>, part: usize) -> Self;
    /// As many places of a sink.
    type Places<'a, K: Sink + 'a>: Places;
    /// Places base + i·stride of a sink.
    fn places<K: Sink>(sink: &mut K, base: usize, stride: usize) -> Option<Self::Places<'_, K>>;
    /// To places whose elements have the places of a comb.
    fn stored(self, lanes: L, comb: &mut Self::Comb<'_>, places: &mut impl Places, part: usize);
}

macro_rules! numbers {
    ($name:ident, $count:literal: $($i:literal)*; $($reversed:literal)*) => {
        impl Radix for $name {
            const RADIX: usize = $count;
            type Numbers<L: Lanes> = [Complex<L>; $count];
        }

        impl<L: Lanes> Numbers<L> for [Complex<L>; $count] {
            type Elements<S: Source> = S::Elements<$count>;

            #[inline(always)]
            fn elements<S: Source>(source: S, base: usize, stride: usize) -> Option<S::Elements<$count>> {
                source.elements(base, stride)
            }

            #[inline(always)]
            fn loaded(lanes: L, elements: &impl Elements, part: usize) -> Self {
                [$(elements.load::<L, $reversed>(lanes, part)),*]
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

            type Places<'a, K: Sink + 'a> = K::Places<'a, $count>;

            #[inline(always)]
            fn places<K: Sink>(sink: &mut K, base: usize, stride: usize) -> Option<K::Places<'_, $count>> {
                sink.places(base, stride)
            }

            #[inline(always)]
            fn stored(self, lanes: L, comb: &mut Comb<'_, $count>, places: &mut impl Places, part: usize) {
                $(places.store::<L, $i>(lanes, comb.get_mut::<$i>(), part, self[$i]);)*
            }
        }
    };
}

numbers!(Four, 4: 0 1 2 3; 0 2 1 3);
numbers!(Eight, 8: 0 1 2 3 4 5 6 7; 0 4 2 6 1 5 3 7);
