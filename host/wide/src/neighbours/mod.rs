//! Lists of neighbours, of use until a disc has moved by half a skin.
//!
//! A list holds the pairs up to a cut-off and a *skin* more. While no disc has moved by half the skin or more, every
//! pair within the cut-off is in it (Verlet, 1967). Which pairs are looked at beyond those, and how long a list is
//! kept, has no bearing on forces: those of pairs beyond the cut-off are not added, and sums are of integers.
//!
//! The skin is chosen anew for every list, from how long the last one lasted. Of each pair of discs one has the other in
//! its list, which takes less time than to have both look at each other; in several pieces, each of the two if they
//! belong to different ones, so that a piece adds forces to its own discs only.
//!
//! ```
//! use meniscus_wide::lanes::Level;
//! use meniscus_wide::neighbours::Neighbours;
//!
//! let (x, y) = ([0, 1 << 24, 1 << 31], [0; 3]);
//! let mut neighbours = Neighbours::new(Level::best(), 1 << 25);
//! assert!(!neighbours.is_fresh(&x, &y, 1));
//! neighbours.rebuild(&x, &y, 1);
//! assert_eq!(neighbours.count(), 1);
//! assert!(neighbours.is_fresh(&[100, 1 << 24, 1 << 31], &y, 1));
//! assert!(!neighbours.is_fresh(&[1 << 24, 1 << 24, 1 << 31], &y, 1));
//! ```

mod search;
mod slices;

use crate::lanes::{Kernel, LARGEST_WIDTH, Lanes, Level};
use crate::order::{Cells, Order};
use rayon::prelude::*;
use search::Search;

pub(crate) use search::Piece;
pub(crate) use slices::Part;

/// Exclusive upper end of separations, half a box, unit L·2⁻³².
const HALF_BOX: u32 = 1 << 31;

/// Room for rounding when squares of distances are compared in binary32: the square is off by less than 2⁻²¹ of it.
const MARGIN: f64 = 1.0 / 65536.0;

/// Lists of neighbours of discs, and the positions they were made at.
#[derive(Clone, Debug)]
pub struct Neighbours {
    level: Level,
    /// The farthest a pair within the cut-off can be, unit L·2⁻³².
    farthest: u32,
    skin: u32,
    /// Whether the skin is not to be chosen.
    fixed_skin: bool,
    /// How often the lists have been found fresh; none once the skin of the next ones is chosen.
    uses: Option<u32>,
    /// Positions as they were last given.
    positions: Vec<[u32; 2]>,
    /// Coordinates for which the lists were made.
    made_x: Vec<u32>,
    made_y: Vec<u32>,
    order: Order,
    ordered: [Vec<u32>; 3],
    pieces: Vec<Piece>,
}

impl Neighbours {
    /// Lists, none yet, for pairs up to `reach` (unit L·2⁻³², below half a box) along either axis and in distance, and
    /// a part in 2¹⁶ beyond.
    #[must_use]
    pub fn new(level: Level, reach: u32) -> Self {
        let farthest = reach.saturating_add(reach >> 16).saturating_add(1).min(HALF_BOX - 1);
        Self {
            level,
            farthest,
            skin: reach / 8,
            fixed_skin: false,
            uses: None,
            positions: Vec::new(),
            made_x: Vec::new(),
            made_y: Vec::new(),
            order: Order::default(),
            ordered: [const { Vec::new() }; 3],
            pieces: Vec::new(),
        }
    }

    /// Has all lists made with this skin, unit L·2⁻³².
    #[must_use]
    pub fn with_skin(mut self, skin: u32) -> Self {
        self.skin = skin;
        self.fixed_skin = true;
        self
    }

    /// The skin of the lists, unit L·2⁻³²: what was chosen or asked for, or less, so that cut-off and skin stay
    /// below half a box.
    #[must_use]
    pub fn skin(&self) -> u32 {
        self.skin.min(HALF_BOX - 1 - self.farthest)
    }

    /// How many pairs are in the lists; those of discs of different pieces count twice.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pieces.iter().map(Piece::count).sum()
    }

    /// Bytes in use for the lists.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.pieces.iter().map(Piece::bytes).sum()
    }

    /// Takes in the positions (unit L·2⁻³²) and says whether the lists are of use for them: whether they were
    /// made for as many discs and pieces, of which none has moved by half the skin or more.
    pub fn is_fresh(&mut self, x: &[u32], y: &[u32], pieces: usize) -> bool {
        if x.len() != self.made_x.len() || y.len() != self.made_y.len() || pieces.max(1) != self.pieces.len()
        {
            return false;
        }
        let (level, skin) = (self.level, u64::from(self.skin()));
        let limit = (skin * skin).div_ceil(4);
        let size = piece_size(x.len(), pieces);
        let look = |(((x, y), made), positions): Piecewise<'_>| {
            level.dispatch(Look { x, y, made, limit, positions })
        };
        // All of them, so that the positions are taken in.
        let is_fresh = if pieces > 1 {
            let made = self.made_x.par_chunks(size).zip(self.made_y.par_chunks(size));
            let now = x.par_chunks(size).zip(y.par_chunks(size));
            now.zip(made).zip(self.positions.par_chunks_mut(size)).map(look).reduce(|| true, |a, b| a & b)
        } else {
            look((((x, y), (&self.made_x, &self.made_y)), &mut self.positions))
        };
        if is_fresh {
            self.uses = self.uses.map(|uses| uses.saturating_add(1));
        }
        is_fresh
    }

    /// Makes the lists for discs at these positions (unit L·2⁻³²), in as many pieces.
    ///
    /// They are right for discs in any order, and made and used fastest if discs are stored as
    /// [`Neighbours::arrange`] says.
    pub fn rebuild(&mut self, x: &[u32], y: &[u32], pieces: usize) {
        self.choose_skin(x.len());
        self.sort(x, y);
        self.positions.clear();
        self.positions.extend(x.iter().zip(y).map(|(&x, &y)| [x, y]));
        for (made, now) in [(&mut self.made_x, x), (&mut self.made_y, y)] {
            made.clear();
            made.extend_from_slice(now);
        }
        let [ordered_x, ordered_y, discs] = &mut self.ordered;
        for (ordered, values) in [(&mut *ordered_x, x), (ordered_y, y)] {
            ordered.clear();
            ordered.extend(self.order.discs().iter().filter_map(|&disc| values.get(disc as usize)));
            ordered.resize(values.len() + LARGEST_WIDTH, 0);
        }
        discs.clear();
        discs.extend_from_slice(self.order.discs());
        discs.resize(x.len() + LARGEST_WIDTH, 0);

        self.pieces.resize_with(pieces.max(1), Piece::default);
        let (level, order, size) = (self.level, &self.order, piece_size(x.len(), pieces));
        let ordered = [0, 1, 2].map(|array| self.ordered[array].as_slice());
        let reach = f64::from(self.farthest) + f64::from(self.skin.min(HALF_BOX - 1 - self.farthest));
        let bound = (reach * reach * (1.0 + MARGIN)) as f32;
        let search = |(number, piece): (usize, &mut Piece)| {
            let owned = (number * size).min(x.len()) as u32..((number + 1) * size).min(x.len()) as u32;
            level.dispatch(Search { x, y, order, ordered, bound, owned, piece });
        };
        if pieces > 1 {
            self.pieces.par_iter_mut().enumerate().for_each(search);
        } else {
            self.pieces.iter_mut().enumerate().for_each(search);
        }
        self.uses = Some(0);
    }

    /// The order in which these discs are best stored when the next lists are made, which a call of
    /// [`Neighbours::rebuild`] has to follow: that of cells as wide as cut-off and skin.
    pub fn arrange(&mut self, x: &[u32], y: &[u32]) -> &Order {
        self.choose_skin(x.len());
        self.sort(x, y);
        &self.order
    }

    /// Forgets the lists: no positions are fresh for them.
    pub fn forget(&mut self) {
        self.pieces.clear();
    }

    fn sort(&mut self, x: &[u32], y: &[u32]) {
        self.order.sort(Cells::new(self.farthest + self.skin(), x.len()), x, y);
    }

    /// Chooses the skin with the least work a step.
    ///
    /// With p pairs a disc within the cut-off r, forces cost about p(1 + s/r)² a step, a new list
    /// about 15 + 1.5·p in the same unit, and one with skin s lasts about (s/2σ)² steps, where the last one tells σ.
    fn choose_skin(&mut self, discs: usize) {
        let Some(uses) = self.uses.take() else { return };
        if self.fixed_skin || discs == 0 {
            return;
        }
        let reach = f64::from(self.farthest);
        let skin = f64::from(self.skin());
        let grown = 1.0 + skin / reach;
        let pairs = self.count() as f64 / discs as f64 / (grown * grown);
        let lasted = f64::from(uses) + 1.0;
        let square_of_step = 0.25 * skin * skin / lasted;
        let ratio = (15.0 + 1.5 * pairs) / (pairs + 0.2);
        // The least of p(1 + s/r)² + c(2σ/s)²: where s³(1 + s/r) = 4 c σ² r/p, for which s may be doubled or halved.
        let wanted = 4.0 * ratio * square_of_step * reach;
        let excess = |skin: f64| skin * skin * skin * (1.0 + skin / reach) - wanted;
        let (mut low, mut high) = (0.5 * skin, (2.0 * skin).min(0.5 * reach));
        for _ in 0..10 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        self.skin = (0.5 * (low + high)).max(reach / 256.0) as u32;
    }

    /// The positions last given.
    pub(crate) fn positions(&self) -> &[[u32; 2]] {
        &self.positions
    }

    /// The lists, piece by piece.
    pub(crate) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}

/// How many discs a piece owns, but for the last ones.
pub(crate) fn piece_size(discs: usize, pieces: usize) -> usize {
    discs.div_ceil(pieces.max(1)).max(1)
}

/// Of a piece: the coordinates, those that the lists were made for, and where positions go.
type Piecewise<'a> = (((&'a [u32], &'a [u32]), (&'a [u32], &'a [u32])), &'a mut [[u32; 2]]);

/// A look at discs: takes in positions, and says whether no disc has moved too far.
struct Look<'a> {
    x: &'a [u32],
    y: &'a [u32],
    made: (&'a [u32], &'a [u32]),
    /// The least square of a displacement that is too far.
    limit: u64,
    positions: &'a mut [[u32; 2]],
}

impl Kernel for Look<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> bool {
        let clearly_below = lanes.splat((self.limit as f64 * (1.0 - MARGIN)) as f32);
        let mut is_fresh = true;
        let now = self.x.chunks(L::WIDTH).zip(self.y.chunks(L::WIDTH));
        let made = self.made.0.chunks(L::WIDTH).zip(self.made.1.chunks(L::WIDTH));
        for (((x, y), (made_x, made_y)), positions) in now.zip(made).zip(self.positions.chunks_mut(L::WIDTH))
        {
            let moved_x = lanes.of_i32(lanes.sub_u32(lanes.load_u32(x), lanes.load_u32(made_x)));
            let moved_y = lanes.of_i32(lanes.sub_u32(lanes.load_u32(y), lanes.load_u32(made_y)));
            let squared = lanes.add(lanes.mul(moved_x, moved_x), lanes.mul(moved_y, moved_y));
            if lanes.bits(lanes.less(squared, clearly_below)) != (1 << L::WIDTH) - 1 {
                is_fresh &= are_within(self.limit, (x, y), (made_x, made_y));
            }
            for (position, (&x, &y)) in positions.iter_mut().zip(x.iter().zip(y)) {
                *position = [x, y];
            }
        }
        is_fresh
    }
}

/// Whether the square of every displacement is below `limit`, in integers.
#[cold]
fn are_within(limit: u64, (x, y): (&[u32], &[u32]), (made_x, made_y): (&[u32], &[u32])) -> bool {
    let square = |(&now, &made): (&u32, &u32)| {
        let moved = u64::from((now.wrapping_sub(made) as i32).unsigned_abs());
        moved * moved
    };
    let along_x = x.iter().zip(made_x).map(square);
    along_x.zip(y.iter().zip(made_y).map(square)).all(|(along_x, along_y)| along_x + along_y < limit)
}
