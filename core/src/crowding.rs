//! How many discs may be in one place, so that the sum of their forces stays a number.
//!
//! [`LARGEST_HEAP`] discs may lie anywhere, all of them in one place if need be. Of more discs that repel each other, no
//! cell of a division of the box into c × c may hold more than [`LARGEST_CELL`]; c is the largest power of two for which a cell
//! is at least as wide as the cut-off of the repulsion, and at most M and [`MOST_CELLS`]. All discs that repel one disc then lie in 3 × 3
//! cells. [`crate::units`] shows that this is enough. Nothing physical is refused: 19 000 discs side by side fill the widest
//! cell of the largest box.
//!
//! The count is of integers, hence free of order.
//!
//! ```
//! use meniscus_core::crowding::{Crowding, LARGEST_CELL, LARGEST_HEAP};
//! use meniscus_core::grid::Grid;
//! use meniscus_core::torus::Fraction;
//!
//! // Cells of a quarter of the box.
//! let crowding = Crowding::new(1 << 30, Grid::SMALLEST);
//! assert_eq!(crowding.cells_a_side(), 4);
//! let one_place = vec![Fraction::from_bits(7); LARGEST_CELL as usize];
//! let mut counts = [0; 16];
//! assert!(crowding.count((&one_place, &one_place), &mut counts).is_ok());
//! ```

use crate::assignment::Crowded;
use crate::grid::Grid;
use crate::torus::Fraction;

/// So many discs may lie anywhere.
pub const LARGEST_HEAP: usize = 1 << 19;

/// So many of a larger number of discs may lie in one cell.
pub const LARGEST_CELL: u32 = 1 << 15;

/// So many cells a side, 2⁸, are counted in at most: few enough to stay near the processor.
pub const MOST_CELLS: usize = 256;

/// The cells in which discs are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crowding {
    /// The binary logarithm of the number of cells a side; 0 if none are counted.
    exponent: u32,
}

impl Crowding {
    /// For a repulsion that reaches `reach` (unit L·2⁻³², below 2³¹; 0 without) and memory for the nodes of `grid`.
    #[must_use]
    pub fn new(reach: u32, grid: Grid) -> Self {
        // 2³² over the power of two at or above the reach.
        let widest = reach.checked_sub(1).map_or(0, u32::leading_zeros);
        Self { exponent: widest.min(grid.exponent()).min(MOST_CELLS.trailing_zeros()) }
    }

    /// For statics; of no use before it is replaced.
    pub(crate) const fn blank() -> Self {
        Self { exponent: 0 }
    }

    /// The number c of cells along a side, a power of two; 1 if nothing repels and none are counted.
    #[must_use]
    pub fn cells_a_side(&self) -> usize {
        1 << self.exponent
    }

    /// Whether so many discs have to be counted at all.
    #[must_use]
    pub fn concerns(&self, count: usize) -> bool {
        self.exponent > 0 && count > LARGEST_HEAP
    }

    /// Counts the discs at (`x`, `y`) in each of the c × c cells, in the first elements of `counts`, whose c² or more
    /// elements are forgotten.
    ///
    /// # Errors
    /// [`Crowded`] if a cell holds more than [`LARGEST_CELL`], or `counts` is too short.
    pub fn count(&self, (x, y): (&[Fraction], &[Fraction]), counts: &mut [u32]) -> Result<(), Crowded> {
        let counts = counts.get_mut(..self.cells_a_side() * self.cells_a_side()).ok_or(Crowded)?;
        counts.fill(0);
        let index = |at: Fraction| (u64::from(at.to_bits()) << self.exponent >> 32) as usize;
        for (&x, &y) in x.iter().zip(y) {
            if let Some(count) = counts.get_mut((index(x) << self.exponent) + index(y)) {
                *count = count.saturating_add(1);
            }
        }
        if counts.iter().any(|&count| count > LARGEST_CELL) { Err(Crowded) } else { Ok(()) }
    }
}
