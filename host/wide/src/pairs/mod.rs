//! The forces of pairs in wide lanes, bit for bit those of [`PairForce`].
//!
//! As many discs as there are lanes, and a neighbour of each, are looked at a time. What is rare in a lane – a distance so small that the
//! force no longer grows, or so near the cut-off that rounding decides – is left to the core's own function.
//!
//! ```
//! use meniscus_core::pair_force::PairForce;
//! use meniscus_wide::lanes::Level;
//! use meniscus_wide::neighbours::Neighbours;
//! use meniscus_wide::pairs::{Discs, PairLoop, Strengths};
//!
//! // Two discs in contact, in a box of 512 R0: 12 kBT/R0 push them apart.
//! let force = PairForce::repulsion(512.0);
//! let mut neighbours = Neighbours::new(Level::best(), force.reach());
//! neighbours.rebuild(&[2 << 23, 0], &[0, 0], 1);
//! let pairs = PairLoop::new(Level::best(), &force, &[]);
//! let (mut force_x, mut force_y) = ([0; 2], [0; 2]);
//! let discs = Discs { ids: &[0, 1], strengths: Strengths::Alike(PairForce::EQUAL) };
//! pairs.add(&neighbours, &discs, (&mut force_x, &mut force_y));
//! assert_eq!(force_x, [12 << 24, -12 << 24]);
//! ```

mod table;

use crate::lanes::{Kernel, LARGEST_WIDTH, Lanes, Level, bits_of_i32};
use crate::neighbours::{Neighbours, Part, Piece, piece_size};
use meniscus_core::cells::Separation;
use meniscus_core::near_part::Segment;
use meniscus_core::pair_force::{PairForce, product_of_strengths};
use meniscus_core::units::FORCE_UNITS;
use rayon::prelude::*;
use std::hint::black_box;
use table::Table;

/// The capillary strengths of discs.
#[derive(Clone, Copy, Debug)]
pub enum Strengths<'a> {
    /// The same product f_i f_j for all pairs: [`PairForce::EQUAL`], or 0 if there is no attraction.
    Alike(f32),
    /// The strength of each disc, unit 2⁻²⁰.
    Each(&'a [i32]),
}

/// What there is to know of discs beside their positions.
#[derive(Clone, Copy, Debug)]
pub struct Discs<'a> {
    /// The id of each.
    pub ids: &'a [u32],
    /// Their strengths.
    pub strengths: Strengths<'a>,
}

/// The pair force of a run, for lanes.
#[derive(Clone, Debug)]
pub struct PairLoop {
    level: Level,
    force: PairForce,
    table: Table,
}

impl PairLoop {
    /// The loop for a pair force and the table of its near part.
    #[must_use]
    pub fn new(level: Level, force: &PairForce, table: &[Segment]) -> Self {
        Self { level, force: *force, table: Table::new(table, force.near_squared()) }
    }

    /// Adds the forces (unit 2⁻²⁴ kBT/R0) of all pairs at the positions last given to `neighbours`, whose lists have to
    /// be fresh, in the pieces of the lists. Discs beyond the end of a slice exert none.
    pub fn add(
        &self,
        neighbours: &Neighbours,
        discs: &Discs<'_>,
        (force_x, force_y): (&mut [i64], &mut [i64]),
    ) {
        let positions = neighbours.positions();
        if discs.ids.len() < positions.len()
            || force_x.len() != positions.len()
            || force_y.len() != positions.len()
        {
            return;
        }
        let pieces = neighbours.pieces();
        let size = piece_size(positions.len(), pieces.len());
        let add = |(number, ((force_x, force_y), piece)): Piecewise<'_>| {
            let first = (number * size) as u32;
            self.level.dispatch(Add { pairs: self, positions, discs, piece, first, force_x, force_y });
        };
        if pieces.len() > 1 {
            let forces = force_x.par_chunks_mut(size).zip(force_y.par_chunks_mut(size));
            forces.zip(pieces).enumerate().for_each(add);
        } else {
            let forces = force_x.chunks_mut(size).zip(force_y.chunks_mut(size));
            forces.zip(pieces).enumerate().for_each(add);
        }
    }
}

/// The number of a piece, where the forces of its discs go, and its lists.
type Piecewise<'a> = (usize, ((&'a mut [i64], &'a mut [i64]), &'a Piece));

/// The pairs of one piece.
struct Add<'a> {
    pairs: &'a PairLoop,
    positions: &'a [[u32; 2]],
    discs: &'a Discs<'a>,
    piece: &'a Piece,
    /// The first disc of the piece.
    first: u32,
    force_x: &'a mut [i64],
    force_y: &'a mut [i64],
}

impl Kernel for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        // Two loops, so that what is the same for all pairs stays in registers.
        match self.discs.strengths {
            Strengths::Alike(_) => self.slices::<L, false>(lanes),
            Strengths::Each(_) => self.slices::<L, true>(lanes),
        }
    }
}

impl Add<'_> {
    /// Adds the forces of all slices; `EACH` says that each disc has its own strength.
    #[inline(always)]
    fn slices<L: Lanes, const EACH: bool>(&mut self, lanes: L) {
        let law = Law::new(lanes, self.pairs, self.discs);
        for part in self.piece.inner.parts(L::WIDTH) {
            self.ask_for(lanes, &part);
            self.part::<L, EACH, true>(lanes, &law, &part);
        }
        for part in self.piece.outer.parts(L::WIDTH) {
            self.part::<L, EACH, false>(lanes, &law, &part);
        }
    }

    /// Asks for the memory of discs to come.
    #[inline(always)]
    fn ask_for<L: Lanes>(&self, lanes: L, part: &Part<'_>) {
        let (first, own) = (part.ahead as usize, part.ahead.wrapping_sub(self.first) as usize);
        if part.lane > 0 {
            return;
        }
        if let Some(positions) = self.positions.get(first..first + LARGEST_WIDTH) {
            lanes.prefetch_slice(positions);
        }
        for force in [&*self.force_x, &*self.force_y] {
            if let Some(force) = force.get(own..own.saturating_add(LARGEST_WIDTH)) {
                lanes.prefetch_slice(force);
            }
        }
    }

    /// Adds the forces of a part of a slice to its discs and, if `BOTH`, to their neighbours.
    #[inline(always)]
    fn part<L: Lanes, const EACH: bool, const BOTH: bool>(
        &mut self,
        lanes: L,
        law: &Law<'_, L>,
        part: &Part<'_>,
    ) {
        let members = lanes.load_u32(part.members);
        let own = lanes.gather_pairs(self.positions, part.members);
        let own_strength = if EACH { lanes.gather_u32(law.strengths, members) } else { members };
        let mut sums = [lanes.splat_u64(0); 2];
        for neighbours in part.neighbours {
            let Some(neighbours) = neighbours.get(part.lane..part.lane + L::WIDTH) else { return };
            let others = lanes.load_u32(neighbours);
            let other = lanes.gather_pairs(self.positions, neighbours);
            let x = law.length(lanes.sub_u32(own[0], other[0]));
            let y = law.length(lanes.sub_u32(own[1], other[1]));
            let squared = lanes.add(lanes.mul(x, x), lanes.mul(y, y));
            // A disc is no neighbour of its own.
            let squared = lanes.select(lanes.equal(members, others), lanes.splat(f32::INFINITY), squared);
            let attraction = if EACH {
                law.attraction(own_strength, lanes.gather_u32(law.strengths, others))
            } else {
                law.alike
            };
            let (factor, rare) = law.force_over_distance(squared, attraction);
            // A power of two may be multiplied with first.
            let factor = lanes.mul(factor, lanes.splat(FORCE_UNITS));
            let force = [lanes.round_i64(lanes.mul(factor, x)), lanes.round_i64(lanes.mul(factor, y))];
            sums = [lanes.add_u64(sums[0], force[0]), lanes.add_u64(sums[1], force[1])];
            if BOTH {
                self.subtract(lanes, neighbours, force);
            }
            if rare != 0 {
                self.add_rare::<BOTH>(rare, part.members, neighbours);
            }
        }
        let [x, y] = [lanes.array_u64(sums[0]), lanes.array_u64(sums[1])];
        let lanes = part.members.iter().zip(x.into_iter().zip(y)).take(L::WIDTH);
        for (&disc, (x, y)) in lanes {
            self.add_to(disc, (x as i64, y as i64));
        }
    }

    #[inline(always)]
    fn add_to(&mut self, disc: u32, (x, y): (i64, i64)) {
        let place = disc.wrapping_sub(self.first) as usize;
        if let (Some(force_x), Some(force_y)) = (self.force_x.get_mut(place), self.force_y.get_mut(place)) {
            *force_x = force_x.wrapping_add(x);
            *force_y = force_y.wrapping_add(y);
        }
    }

    #[inline(always)]
    fn subtract<L: Lanes>(&mut self, lanes: L, discs: &[u32], force: [L::U64; 2]) {
        // Through memory: to take registers apart would take longer.
        let forces = black_box([lanes.array_u64(force[0]), lanes.array_u64(force[1])]);
        for ((&disc, &x), &y) in discs.iter().zip(&forces[0]).zip(&forces[1]) {
            self.add_to(disc, ((x as i64).wrapping_neg(), (y as i64).wrapping_neg()));
        }
    }

    /// Adds the forces of the pairs whose bit is set as the core does.
    #[cold]
    #[inline(never)]
    fn add_rare<const BOTH: bool>(&mut self, rare: u32, members: &[u32], neighbours: &[u32]) {
        for (lane, (&first, &second)) in members.iter().zip(neighbours).enumerate().take(LARGEST_WIDTH) {
            if rare >> lane & 1 == 0 {
                continue;
            }
            if let Some((x, y)) = self.of(first as usize, second as usize) {
                self.add_to(first, (x, y));
                if BOTH {
                    self.add_to(second, (-x, -y));
                }
            }
        }
    }

    /// The force on the first disc of a pair.
    fn of(&self, first: usize, second: usize) -> Option<(i64, i64)> {
        let (&[x, y], &[x_second, y_second]) = (self.positions.get(first)?, self.positions.get(second)?);
        let separation =
            Separation { x: x.wrapping_sub(x_second) as i32, y: y.wrapping_sub(y_second) as i32 };
        let PairLoop { force, table, .. } = self.pairs;
        // Beyond it along an axis the core does not see a pair, however its distance is rounded.
        let is_in_reach = |along: i32| along.unsigned_abs() <= force.reach();
        if !is_in_reach(separation.x) || !is_in_reach(separation.y) {
            return None;
        }
        let product = match self.discs.strengths {
            Strengths::Alike(product) => product,
            Strengths::Each(all) => product_of_strengths(*all.get(first)?, *all.get(second)?),
        };
        let first_is_lower = self.discs.ids.get(first)? < self.discs.ids.get(second)?;
        force.of(separation, first_is_lower, product, table.segments())
    }
}

/// The pair force in registers.
struct Law<'a, L: Lanes> {
    lanes: L,
    unit: L::F32,
    /// Below it the core's function is asked; the square of a distance, R0², as all that follow.
    just_below_smallest: L::F32,
    /// From here on rounding decides whether a pair is within the cut-off.
    surely_within: L::F32,
    cutoff: L::F32,
    repulsion: L::F32,
    repels: bool,
    near: L::F32,
    strength: L::F32,
    /// V0 f_i f_j, kBT, if it is that of all pairs.
    alike: L::F32,
    strengths: &'a [u32],
    table: &'a Table,
}

impl<'a, L: Lanes> Law<'a, L> {
    #[inline(always)]
    fn new(lanes: L, pairs: &'a PairLoop, discs: &Discs<'a>) -> Self {
        /// The square of the distance is rounded by less than 2⁻²¹ of it.
        const MARGIN: f32 = 1.0 / 262_144.0;
        let PairLoop { force, table, .. } = pairs;
        let (alike, strengths) = match discs.strengths {
            Strengths::Alike(product) => (force.strength() * product, &[][..]),
            Strengths::Each(all) => (0.0, bits_of_i32(all)),
        };
        let smallest = PairForce::SMALLEST_SQUARED.max(table.begin(L::WIDTH));
        Self {
            lanes,
            unit: lanes.splat(force.unit()),
            just_below_smallest: lanes.splat(smallest.next_down()),
            surely_within: lanes.splat(force.cutoff_squared() * (1.0 - MARGIN)),
            cutoff: lanes.splat(force.cutoff_squared()),
            repulsion: lanes.splat(force.repulsion_squared()),
            repels: force.repulsion_squared() > 0.0,
            near: lanes.splat(force.near_squared()),
            strength: lanes.splat(force.strength()),
            alike: lanes.splat(alike),
            strengths,
            table,
        }
    }

    /// A separation, read as signed, in R0.
    #[inline(always)]
    fn length(&self, separation: L::U32) -> L::F32 {
        self.lanes.mul(self.lanes.of_i32(separation), self.unit)
    }

    /// V0 f_i f_j, kBT, with a product of strengths that is rounded once.
    #[inline(always)]
    fn attraction(&self, first: L::U32, second: L::U32) -> L::F32 {
        const UNIT: f32 = 1.0 / (1_u64 << 40) as f32;
        let lanes = self.lanes;
        let product = lanes.mul_u64(lanes.widen_i32(first), lanes.widen_i32(second));
        lanes.mul(self.strength, lanes.mul(lanes.of_i64(product), lanes.splat(UNIT)))
    }

    /// F(d)/d (kBT/R0²) from the squares of distances and V0 f_i f_j, 0 beyond the cut-off and where a bit tells that the core is
    /// to be asked.
    #[inline(always)]
    fn force_over_distance(&self, squared: L::F32, attraction: L::F32) -> (L::F32, u32) {
        let lanes = self.lanes;
        let is_ordinary = lanes
            .both(lanes.less(self.just_below_smallest, squared), lanes.less(squared, self.surely_within));
        let is_within = lanes.bits(lanes.less(squared, self.cutoff));
        let rare = is_within & !lanes.bits(is_ordinary);
        let zero = lanes.splat(0.0);
        let mut factor = zero;
        if self.repels {
            let repel = lanes.less(squared, self.repulsion);
            if lanes.bits(repel) != 0 {
                factor = lanes.select(repel, repulsion(lanes, squared), zero);
            }
        }
        if !self.table.is_empty() {
            let attraction = lanes.div(attraction, squared);
            let near = lanes.sub(factor, lanes.mul(attraction, self.table.evaluate(lanes, squared)));
            factor = lanes.select(lanes.less(squared, self.near), near, factor);
        }
        (lanes.select(is_ordinary, factor, zero), rare)
    }
}

/// [`meniscus_core::repulsion::force_over_distance`].
#[inline(always)]
fn repulsion<L: Lanes>(lanes: L, squared: L::F32) -> L::F32 {
    let [two, four, six] = [lanes.splat(2.0), lanes.splat(4.0), lanes.splat(6.0)];
    let inverse = lanes.div(four, squared);
    let sixth = lanes.mul(lanes.mul(inverse, inverse), inverse);
    let twelfth = lanes.mul(lanes.mul(two, sixth), sixth);
    lanes.mul(lanes.mul(six, inverse), lanes.sub(twelfth, sixth))
}
