//! Registers from memory and back, whole and in part.

/// Up to the width of elements, zeros after them.
#[cold]
pub(super) fn part<T: Copy + Default, const WIDTH: usize>(from: &[T]) -> [T; WIDTH] {
    let mut array = [T::default(); WIDTH];
    for (place, &value) in array.iter_mut().zip(from) {
        *place = value;
    }
    array
}

/// Writes as many values as there is room for.
#[cold]
pub(super) fn store_part<T: Copy, const WIDTH: usize>(values: [T; WIDTH], to: &mut [T]) {
    for (place, value) in to.iter_mut().zip(values) {
        *place = value;
    }
}

/// Methods that load and store `WIDTH` elements: of which type, in which register, and the instructions, given where an
/// array of as many elements begins.
macro_rules! moves {
    ($($element:ty, $register:ty:
        $load:ident = |$from:ident| $read:expr, $store:ident = |$to:ident, $value:ident| $write:expr;)*) => { $(
        #[inline(always)]
        fn $load(self, elements: &[$element]) -> $register {
            let part;
            let whole: &[$element; WIDTH] = if let Some(whole) = elements.first_chunk() {
                whole
            } else {
                part = crate::lanes::moves::part(elements);
                &part
            };
            let $from = whole.as_ptr();
            // SAFETY: `self` exists only where the processor has the instructions, and the array has all the elements that
            // are read; they need not be aligned.
            unsafe { $read }
        }

        #[inline(always)]
        fn $store(self, $value: $register, elements: &mut [$element]) {
            if let Some(whole) = elements.first_chunk_mut::<WIDTH>() {
                let $to = whole.as_mut_ptr();
                // SAFETY: as in the method that loads, for elements that are written to.
                unsafe { $write }
            } else {
                let mut array = [<$element>::default(); WIDTH];
                let $to = array.as_mut_ptr();
                // SAFETY: as above.
                unsafe { $write }
                crate::lanes::moves::store_part(array, elements);
            }
        }
    )* };
}

pub(super) use moves;
