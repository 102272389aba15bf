//! The largest squared modulus of the forces.

use crate::lanes::{Kernel, Lanes, Level};
use crate::pieces::{Divisible, place};

/// Finds the largest squared modulus of forces, bits of signed integers.
pub(super) struct LargestSquare<'a> {
    pub level: Level,
    pub x: &'a [u64],
    pub y: &'a [u64],
}

impl Divisible for LargestSquare<'_> {
    type Output = u128;

    fn divide(self, first: usize, pieces: usize) -> (Self, Self) {
        let Self { level, x, y } = self;
        let at = place(x.len().min(y.len()), first, pieces);
        let ((x, x_after), (y, y_after)) = (x.split_at(at), y.split_at(at));
        (Self { level, x, y }, Self { level, x: x_after, y: y_after })
    }

    fn run(self) -> u128 {
        self.level.dispatch(self)
    }

    fn unite(first: u128, second: u128) -> u128 {
        first.max(second)
    }
}

impl Kernel for LargestSquare<'_> {
    type Output = u128;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> u128 {
        // A square found in binary32 is off by less than 2⁻²² of it, below 2¹²⁸ always: what may exceed the largest one
        // so far exceeds this part of it.
        const PART: f32 = 1.0 - 1.0 / 1_048_576.0;
        let (mut largest, mut threshold) = (0, lanes.splat(0.0));
        for (x, y) in self.x.chunks(L::WIDTH).zip(self.y.chunks(L::WIDTH)) {
            let along_x = lanes.of_i64(lanes.load_u64(x));
            let along_y = lanes.of_i64(lanes.load_u64(y));
            let square = lanes.add(lanes.mul(along_x, along_x), lanes.mul(along_y, along_y));
            if lanes.bits(lanes.less(threshold, square)) != 0 {
                largest = x.iter().zip(y).map(|(&x, &y)| squared(x) + squared(y)).fold(largest, u128::max);
                threshold = lanes.splat(largest as f32 * PART);
            }
        }
        largest
    }
}

fn squared(bits: u64) -> u128 {
    let modulus = u128::from((bits as i64).unsigned_abs());
    modulus * modulus
}
