//! Factors of the butterflies, with the bits of microfft's table.

use super::butterflies::{Complex, Factors};
use crate::lanes::{Lanes, Sixteen};
use meniscus_core::transform::{AnySize, Complex32, LineTransform};

/// exp(−2πi k/M) for k = 0 … M/2 − 1 as microfft has them.
///
/// The transform of a unit impulse at 1 gives them: until its last stage all numbers are 1 and 0, and that stage
/// multiplies 1 with each factor and adds it to 0.
pub(crate) fn turns(points: usize) -> Vec<Complex32> {
    let mut line = vec![Complex32::new(0.0, 0.0); points];
    if let Some(impulse) = line.get_mut(1) {
        *impulse = Complex32::new(1.0, 0.0);
    }
    AnySize.forward(&mut line);
    line.truncate(points / 2);
    line
}

/// The factors of up to `radix` / 2 indices (see [`Factors`]) for element `k` of blocks of `span` elements.
fn of_element(turns: &[Complex32], span: usize, radix: usize, k: usize) -> impl Iterator<Item = Complex32> {
    let whole = 2 * turns.len();
    let stages = [(2, 0), (4, 0), (8, 0), (8, 1), (16, 0), (16, 1), (16, 2), (16, 3)];
    stages.into_iter().take(radix / 2).map(move |(length, shift)| {
        let index = (k + shift * span) * (whole / (length * span));
        turns.get(index).copied().unwrap_or_default()
    })
}

/// Factors of the elements 1 … `span` − 1, `radix` / 2 each.
pub(crate) fn of_elements(turns: &[Complex32], span: usize, radix: usize) -> Vec<[f32; 2]> {
    (1..span).flat_map(|k| of_element(turns, span, radix, k)).map(|factor| [factor.re, factor.im]).collect()
}

/// Factors of sixteen elements side by side from 0, 16, 32, …, eight blocks each, for stages that join sixteen blocks of
/// `span` elements.
pub(crate) fn side_by_side(turns: &[Complex32], span: usize) -> Vec<[Sixteen; 8]> {
    let mut factors = vec![[Sixteen::ZERO; 8]; span / 16];
    for (group, blocks) in factors.iter_mut().enumerate() {
        for lane in 0..16 {
            for (block, factor) in blocks.iter_mut().zip(of_element(turns, span, 16, 16 * group + lane)) {
                block.0[lane] = factor.re;
                block.0[lane + 16] = factor.im;
            }
        }
    }
    factors
}

/// Factors of element 0, of which many are 1 and −i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtZero {
    /// An eighth of a turn, and one, two and three sixteenths.
    turns: [[f32; 2]; 4],
}

impl AtZero {
    pub(crate) fn new(turns: &[Complex32]) -> Self {
        let sixteenth = |k: usize| {
            let factor = turns.get(k * turns.len() / 8).copied().unwrap_or_default();
            [factor.re, factor.im]
        };
        Self { turns: [sixteenth(2), sixteenth(1), sixteenth(2), sixteenth(3)] }
    }

    #[inline(always)]
    fn factor<L: Lanes>(self, lanes: L, index: usize) -> Option<Complex<L>> {
        let [re, im] = match index {
            3 => self.turns[0],
            5 => self.turns[1],
            6 => self.turns[2],
            7 => self.turns[3],
            _ => return None,
        };
        Some(Complex { re: lanes.splat(re), im: lanes.splat(im) })
    }
}

impl<L: Lanes> Factors<L> for AtZero {
    #[inline(always)]
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        match self.factor(lanes, index) {
            Some(factor) => x.times(lanes, factor),
            None => x,
        }
    }

    #[inline(always)]
    fn times_turned(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        match self.factor(lanes, index) {
            Some(factor) => x.times_turned(lanes, factor),
            None => x.turned(lanes),
        }
    }
}

/// Factors of one element, the same in all lanes.
#[derive(Clone, Copy)]
pub(crate) struct Same<'a>(pub(crate) &'a [[f32; 2]]);

impl Same<'_> {
    #[inline(always)]
    fn factor<L: Lanes>(self, lanes: L, index: usize) -> Complex<L> {
        let [re, im] = self.0[index];
        Complex { re: lanes.splat(re), im: lanes.splat(im) }
    }
}

impl<L: Lanes> Factors<L> for Same<'_> {
    #[inline(always)]
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        x.times(lanes, self.factor(lanes, index))
    }

    #[inline(always)]
    fn times_turned(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        x.times_turned(lanes, self.factor(lanes, index))
    }
}

/// Factors of consecutive elements, one a lane, from lane `part` on.
#[derive(Clone, Copy)]
pub(crate) struct SideBySide<'a> {
    pub(crate) factors: &'a [Sixteen; 8],
    pub(crate) part: usize,
}

impl SideBySide<'_> {
    #[inline(always)]
    fn factor<L: Lanes>(self, lanes: L, index: usize) -> Complex<L> {
        super::passes::load(lanes, &self.factors[index], self.part)
    }
}

impl<L: Lanes> Factors<L> for SideBySide<'_> {
    #[inline(always)]
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        x.times(lanes, self.factor(lanes, index))
    }

    #[inline(always)]
    fn times_turned(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        x.times_turned(lanes, self.factor(lanes, index))
    }
}

/// As [`SideBySide`], the first lane that of element 0, where w = 1 and −i leave a number as it is but for its turn:
/// multiplied with 1 + 0i, a zero could get another sign.
#[derive(Clone, Copy)]
pub(crate) struct SideBySideFromZero<'a, L: Lanes> {
    pub(crate) factors: SideBySide<'a>,
    /// True for element 0.
    pub(crate) zero: L::Mask,
}

impl<L: Lanes> Factors<L> for SideBySideFromZero<'_, L> {
    #[inline(always)]
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        let product = self.factors.times(lanes, index, x);
        match index {
            0 | 1 | 2 | 4 => Complex {
                re: lanes.select(self.zero, x.re, product.re),
                im: lanes.select(self.zero, x.im, product.im),
            },
            _ => product,
        }
    }

    #[inline(always)]
    fn times_turned(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L> {
        self.factors.times_turned(lanes, index, x)
    }
}
