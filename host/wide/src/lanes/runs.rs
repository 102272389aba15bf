//! Elements at equal distances to read, looked at once whether they are inside.

use core::marker::PhantomData;

/// `COUNT` runs of `LENGTH` elements whose beginnings are at equal distances, or a `PART` of them: [`ALL`], [`LOWER`],
/// [`UPPER`] or [`REST`].
#[derive(Clone, Copy, Debug)]
pub struct Runs<'a, T, const COUNT: usize, const LENGTH: usize, const PART: u8 = ALL> {
    pub(super) first: *const T,
    pub(super) distance: isize,
    pub(super) lifetime: PhantomData<&'a T>,
}

/// All runs.
pub const ALL: u8 = 0;
/// The first half of them.
pub const LOWER: u8 = 1;
/// The second half of them.
pub const UPPER: u8 = 2;
/// All but the first.
pub const REST: u8 = 3;

impl<'a, T, const COUNT: usize, const LENGTH: usize, const PART: u8> Runs<'a, T, COUNT, LENGTH, PART> {
    /// The first run that there is.
    const BEGIN: usize = match PART {
        UPPER => COUNT / 2,
        REST => 1,
        _ => 0,
    };
    /// The last run that there is.
    const LAST: usize = if PART == LOWER { COUNT / 2 - 1 } else { COUNT - 1 };

    /// Those that begin at elements first + i · distance; none unless all are inside.
    #[inline(always)]
    #[must_use]
    pub fn new(elements: &'a [T], first: usize, distance: isize) -> Option<Self> {
        const { assert!(COUNT <= isize::MAX as usize) };
        let begin = first.checked_add_signed(distance.checked_mul(Self::BEGIN as isize)?)?;
        let last = first.checked_add_signed(distance.checked_mul(Self::LAST as isize)?)?;
        let inside = begin.max(last).checked_add(LENGTH)? <= elements.len();
        inside.then(|| Self { first: elements.as_ptr().wrapping_add(first), distance, lifetime: PhantomData })
    }

    /// Run `NUMBER`, or the nearest that there is.
    #[inline(always)]
    #[must_use]
    pub fn get<const NUMBER: usize>(&self) -> &'a [T; LENGTH] {
        let number = const {
            if NUMBER < Self::BEGIN {
                Self::BEGIN
            } else if NUMBER > Self::LAST {
                Self::LAST
            } else {
                NUMBER
            }
        };
        // SAFETY: the first run there is and the last are inside the slice that was borrowed, see `new` and `Row::runs`, and
        // so are those between them.
        unsafe { &*self.first.wrapping_offset(number as isize * self.distance).cast() }
    }
}
