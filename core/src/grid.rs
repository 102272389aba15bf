//! The size of a mesh: M × M nodes, M a power of two.
//!
//! ```
//! use meniscus_core::grid::Grid;
//!
//! let grid = Grid::new(512).unwrap();
//! assert_eq!((grid.nodes(), grid.exponent()), (512, 9));
//! assert_eq!(Grid::new(500), None);
//! ```

/// Smallest and largest number of mesh nodes along a side.
pub const RANGE: (usize, usize) = (16, 4096);

/// Number of mesh nodes along a side, known to be a power of two in [`RANGE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Grid {
    /// How often 16 is doubled, 0 to 8; all zero bits are a grid too.
    doublings: u8,
}

impl Grid {
    /// The smallest grid, 16 nodes a side.
    pub const SMALLEST: Self = Self { doublings: 0 };

    /// A grid of `nodes` nodes a side; `None` unless that is a power of two from 16 to 4096.
    #[must_use]
    pub const fn new(nodes: usize) -> Option<Self> {
        if nodes.is_power_of_two() && nodes >= RANGE.0 && nodes <= RANGE.1 {
            Some(Self { doublings: (nodes.trailing_zeros() - RANGE.0.trailing_zeros()) as u8 })
        } else {
            None
        }
    }

    /// Nodes along a side, M.
    #[must_use]
    pub const fn nodes(self) -> usize {
        // The mask changes nothing; it shows the compiler that a grid is never empty.
        RANGE.0 << (self.doublings & 15)
    }

    /// The binary logarithm of M, 4 to 12.
    #[must_use]
    pub const fn exponent(self) -> u32 {
        RANGE.0.trailing_zeros() + self.doublings as u32
    }

    /// An index or a sum of two along a side, wrapped to 0 … M − 1.
    #[must_use]
    pub const fn wrap(self, index: usize) -> usize {
        index & (self.nodes() - 1)
    }
}
