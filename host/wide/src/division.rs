//! Into how many pieces the work of a step is divided.
//!
//! ```
//! use meniscus_wide::division::Division;
//!
//! // Two threads do not pay for the 2500 discs and 256² nodes of a small run.
//! assert_eq!(Division::of(2, 256, 2500), Division::WHOLE);
//! assert_eq!(Division::of(2, 2048, 1_000_000), Division { mesh: 2, discs: 2 });
//! ```

/// Mesh nodes a side from which a second thread pays: a solve takes a third of a millisecond, waking a thread a
/// hundredth.
const SMALLEST_GRID: usize = 512;

/// Discs from which a second thread pays: each stage takes some tens of nanoseconds for each of them.
const FEWEST_DISCS: usize = 16_384;

/// Pieces of each kind of work, at least 1 each. What comes out does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Division {
    /// Of the mesh solver's lines.
    pub mesh: usize,
    /// Of the discs.
    pub discs: usize,
}

impl Division {
    /// One piece of all, in the thread that asks for it.
    pub const WHOLE: Self = Self { mesh: 1, discs: 1 };

    /// For `threads` threads, a mesh of `grid` nodes a side and `count` discs: a piece a thread where that pays.
    #[must_use]
    pub const fn of(threads: usize, grid: usize, count: usize) -> Self {
        let threads = if threads == 0 { 1 } else { threads };
        Self {
            mesh: if grid >= SMALLEST_GRID { threads } else { 1 },
            discs: if count >= FEWEST_DISCS { threads } else { 1 },
        }
    }

    /// The most pieces there are of anything.
    #[must_use]
    pub const fn threads(self) -> usize {
        if self.mesh > self.discs { self.mesh } else { self.discs }
    }
}
