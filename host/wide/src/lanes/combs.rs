//! Elements at equal distances, without looking at every access whether it is inside.

use super::Sixteen;
use core::marker::PhantomData;

/// `TEETH` blocks at equal distances, exclusively borrowed.
#[derive(Debug)]
pub struct Comb<'a, const TEETH: usize> {
    pub(super) first: *mut Sixteen,
    pub(super) distance: usize,
    pub(super) lifetime: PhantomData<&'a mut Sixteen>,
}

impl<'a, const TEETH: usize> Comb<'a, TEETH> {
    /// Blocks first + i · distance of a slice; none unless all are inside and different.
    #[inline(always)]
    #[must_use]
    pub fn new(blocks: &'a mut [Sixteen], first: usize, distance: usize) -> Option<Self> {
        let last = distance.checked_mul(TEETH - 1)?.checked_add(first)?;
        let inside = last < blocks.len() && distance > 0;
        inside.then(|| Self {
            first: blocks.as_mut_ptr().wrapping_add(first),
            distance,
            lifetime: PhantomData,
        })
    }

    /// Block `TOOTH`.
    #[inline(always)]
    #[must_use]
    pub fn get<const TOOTH: usize>(&self) -> &Sixteen {
        const { assert!(TOOTH < TEETH) };
        // SAFETY: the blocks first + tooth · distance with tooth < TEETH are borrowed by this comb, see `new`, `combs` and `RowMut::comb`.
        unsafe { &*self.first.add(TOOTH * self.distance) }
    }

    /// Block `TOOTH`, to write to.
    #[inline(always)]
    #[must_use]
    pub fn get_mut<const TOOTH: usize>(&mut self) -> &mut Sixteen {
        const { assert!(TOOTH < TEETH) };
        // SAFETY: as in `get`; `self` is borrowed exclusively.
        unsafe { &mut *self.first.add(TOOTH * self.distance) }
    }
}

/// The combs of a slice: the i-th has blocks i, i + d, i + 2d …, where d is the slice's length divided by `TEETH`.
#[inline(always)]
pub fn combs<const TEETH: usize>(blocks: &mut [Sixteen]) -> impl Iterator<Item = Comb<'_, TEETH>> {
    let distance = blocks.len() / TEETH;
    let first = blocks.as_mut_ptr();
    // SAFETY of what a comb does: i + tooth · d < TEETH · d, at most the length, so that it is inside the slice, which is
    // borrowed as long as the combs are; with i < d each i and tooth have a block of their own, and each i is given once.
    (0..distance).map(move |offset| Comb {
        first: first.wrapping_add(offset),
        distance,
        lifetime: PhantomData,
    })
}
