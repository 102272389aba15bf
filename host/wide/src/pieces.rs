//! Work in pieces, each done by whichever thread of a pool is free.

use crate::lanes::LARGEST_WIDTH;

/// Work that can be divided among threads: pieces write to what they alone own.
pub(crate) trait Divisible: Sized + Send {
    /// What comes of it.
    type Output: Send;

    /// Two parts of it, `first` and `pieces − first` of `pieces` like pieces.
    fn divide(self, first: usize, pieces: usize) -> (Self, Self);

    /// Does it.
    fn run(self) -> Self::Output;

    /// What comes of both parts.
    fn unite(first: Self::Output, second: Self::Output) -> Self::Output;
}

/// Does the work in so many pieces, in the thread pool it is called in; one piece is done here and now.
pub(crate) fn in_pieces<W: Divisible>(work: W, pieces: usize) -> W::Output {
    if pieces <= 1 {
        return work.run();
    }
    let first = pieces / 2;
    let (before, after) = work.divide(first, pieces);
    let (before, after) = rayon::join(|| in_pieces(before, first), || in_pieces(after, pieces - first));
    W::unite(before, after)
}

/// Where to divide so many elements: whole registers come before it.
pub(crate) fn place(elements: usize, first: usize, pieces: usize) -> usize {
    (elements / pieces * first).next_multiple_of(LARGEST_WIDTH).min(elements)
}
