//! Butterflies of two, four and eight numbers: consecutive stages of microfft's graph, done in registers.
//!
//! A stage of half length m joins elements k and k + m of each block of 2m as x_k ± w·x_{k+m}, w = exp(−iπk/m). Several
//! stages at once change nothing for any number. Elements come in the order of their places; the factors of all
//! stages belong to one k of the first.

use crate::lanes::Lanes;

/// Complex numbers side by side.
#[derive(Clone, Copy)]
pub(crate) struct Complex<L: Lanes> {
    pub(crate) re: L::F32,
    pub(crate) im: L::F32,
}

impl<L: Lanes> Complex<L> {
    #[inline(always)]
    pub(crate) fn add(self, lanes: L, other: Self) -> Self {
        Self { re: lanes.add(self.re, other.re), im: lanes.add(self.im, other.im) }
    }

    #[inline(always)]
    pub(crate) fn sub(self, lanes: L, other: Self) -> Self {
        Self { re: lanes.sub(self.re, other.re), im: lanes.sub(self.im, other.im) }
    }

    /// w·x.
    #[inline(always)]
    pub(crate) fn times(self, lanes: L, w: Self) -> Self {
        Self {
            re: lanes.sub(lanes.mul(w.re, self.re), lanes.mul(w.im, self.im)),
            im: lanes.add(lanes.mul(w.re, self.im), lanes.mul(w.im, self.re)),
        }
    }

    /// (−i·w)·x: the factor has the parts w_im and −w_re, exactly as microfft's table has them.
    #[inline(always)]
    pub(crate) fn times_turned(self, lanes: L, w: Self) -> Self {
        Self {
            re: lanes.add(lanes.mul(w.im, self.re), lanes.mul(w.re, self.im)),
            im: lanes.sub(lanes.mul(w.im, self.im), lanes.mul(w.re, self.re)),
        }
    }

    /// x·(0 − i), with the products with 0 that decide the sign of a zero.
    #[inline(always)]
    pub(crate) fn turned(self, lanes: L) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            re: lanes.add(lanes.mul(self.re, zero), self.im),
            im: lanes.sub(lanes.mul(self.im, zero), self.re),
        }
    }
}

/// Factors of up to four stages for one k: w of k/2m (index 0), k/4m (1), (k + {0, 1}·m)/8m (2, 3) and
/// (k + {0, 1, 2, 3}·m)/16m (4 … 7) turns, where 2m is the length of the first stage's blocks.
pub(crate) trait Factors<L: Lanes>: Copy {
    /// w·x.
    fn times(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L>;
    /// −i·w·x.
    fn times_turned(self, lanes: L, index: usize, x: Complex<L>) -> Complex<L>;
}

/// x ± w·y.
#[inline(always)]
fn two<L: Lanes>(lanes: L, x: Complex<L>, y: Complex<L>) -> (Complex<L>, Complex<L>) {
    (x.add(lanes, y), x.sub(lanes, y))
}

/// Consecutive stages on numbers in registers.
pub(crate) trait Stages<L: Lanes>: Copy {
    fn joined<F: Factors<L>>(self, lanes: L, factors: F) -> Self;
}

impl<L: Lanes> Stages<L> for [Complex<L>; 2] {
    #[inline(always)]
    fn joined<F: Factors<L>>(self, lanes: L, factors: F) -> Self {
        let [a, b] = self;
        let (a, b) = two(lanes, a, factors.times(lanes, 0, b));
        [a, b]
    }
}

impl<L: Lanes> Stages<L> for [Complex<L>; 4] {
    #[inline(always)]
    fn joined<F: Factors<L>>(self, lanes: L, factors: F) -> Self {
        let [a, b, c, d] = self;
        let [a, b] = [a, b].joined(lanes, factors);
        let [c, d] = [c, d].joined(lanes, factors);
        let (a, c) = two(lanes, a, factors.times(lanes, 1, c));
        let (b, d) = two(lanes, b, factors.times_turned(lanes, 1, d));
        [a, b, c, d]
    }
}

impl<L: Lanes> Stages<L> for [Complex<L>; 8] {
    #[inline(always)]
    fn joined<F: Factors<L>>(self, lanes: L, factors: F) -> Self {
        let [a, b, c, d, e, f, g, h] = self;
        let [a, b, c, d] = [a, b, c, d].joined(lanes, factors);
        let [e, f, g, h] = [e, f, g, h].joined(lanes, factors);
        let (a, e) = two(lanes, a, factors.times(lanes, 2, e));
        let (b, f) = two(lanes, b, factors.times(lanes, 3, f));
        let (c, g) = two(lanes, c, factors.times_turned(lanes, 2, g));
        let (d, h) = two(lanes, d, factors.times_turned(lanes, 3, h));
        [a, b, c, d, e, f, g, h]
    }
}
