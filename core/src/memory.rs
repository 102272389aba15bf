//! The arrays that a run works in, lent by their owner.
//!
//! ```
//! use meniscus_core::engine::Engine;
//!
//! let mut engine = Engine::<16, 3>::new();
//! let (_dynamics, memory) = engine.parts();
//! assert_eq!((memory.x.len(), memory.nodes.len()), (3, 256));
//! ```

use crate::influence::influence_length;
use crate::near_part::Segment;
use crate::parameters::LARGEST_PARTICLE_COUNT;
use crate::torus::Fraction;
use crate::transform::Complex32;

/// The arrays a run works in. The first group has an element for each disc, in storage order except `slots`; n is
/// at most the length of `ids`. The arrays of held forces have one too, or are empty if the run holds none.
#[derive(Debug, Default)]
pub struct Memory<'a> {
    /// Id of each disc.
    pub ids: &'a mut [u32],
    /// Where the disc of each id is stored.
    pub slots: &'a mut [u32],
    /// x, unit L·2⁻³².
    pub x: &'a mut [Fraction],
    /// y, unit L·2⁻³².
    pub y: &'a mut [Fraction],
    /// Borders crossed along x, + to the right.
    pub crossings_x: &'a mut [i32],
    /// Borders crossed along y.
    pub crossings_y: &'a mut [i32],
    /// Force along x, unit 2⁻²⁴ kBT/R0.
    pub force_x: &'a mut [i64],
    /// Force along y.
    pub force_y: &'a mut [i64],
    /// Displacement along x, unit L·2⁻³².
    pub displacement_x: &'a mut [i32],
    /// Displacement along y.
    pub displacement_y: &'a mut [i32],
    /// Capillary strength of each disc, unit 2⁻²⁰.
    pub strengths: &'a mut [i32],
    /// Mesh force held along x, unit 2⁻²⁴ kBT/R0, see [`crate::refresh`].
    pub held_x: &'a mut [i64],
    /// Mesh force held along y.
    pub held_y: &'a mut [i64],
    /// Mesh force computed anew along x; after a step that kept it, the one that was held before.
    pub fresh_x: &'a mut [i64],
    /// Mesh force computed anew along y.
    pub fresh_y: &'a mut [i64],
    /// x where the held force was computed, unit L·2⁻³².
    pub reference_x: &'a mut [Fraction],
    /// y where the held force was computed.
    pub reference_y: &'a mut [Fraction],
    /// The discs in the order of their cells.
    pub next: &'a mut [u32],
    /// M × M: node masses, unit 2⁻²⁰ discs; then, the field being solved, the ends of the cells.
    pub nodes: &'a mut [u32],
    /// M × M: the force field, kBT/R0. This and `lines` may be empty if the stages have their own.
    pub field: &'a mut [Complex32],
    /// Working memory of the solver, 2M elements or a multiple.
    pub lines: &'a mut [Complex32],
    /// The influence table, (M/2+1)² elements.
    pub influence: &'a mut [f32],
    /// The gradient table, M elements.
    pub gradient: &'a mut [f32],
    /// The table of the near part, [`crate::near_part::table_length`] elements; none without a near part.
    pub near: &'a mut [Segment],
}

impl Memory<'_> {
    /// How many discs fit.
    pub(crate) fn capacity(&self) -> usize {
        let by_u32 = [self.ids.len(), self.slots.len(), self.next.len()];
        let by_coordinate = [self.x.len(), self.y.len()];
        let by_i32 = [
            self.crossings_x.len(),
            self.crossings_y.len(),
            self.displacement_x.len(),
            self.displacement_y.len(),
            self.strengths.len(),
        ];
        let by_i64 = [self.force_x.len(), self.force_y.len()];
        let lengths = by_u32.into_iter().chain(by_coordinate).chain(by_i32).chain(by_i64);
        lengths.min().unwrap_or(0).min(LARGEST_PARTICLE_COUNT)
    }

    /// How many discs there is room to hold mesh forces of.
    pub(crate) fn room_to_hold(&self) -> usize {
        let forces = [self.held_x.len(), self.held_y.len(), self.fresh_x.len(), self.fresh_y.len()];
        let references = [self.reference_x.len(), self.reference_y.len()];
        forces.into_iter().chain(references).min().unwrap_or(0)
    }

    /// Whether the tables are long enough for M nodes a side and `near` segments of the near part.
    pub(crate) fn holds_tables(&self, grid: usize, near: usize) -> bool {
        self.influence.len() >= influence_length(grid)
            && self.gradient.len() >= grid
            && self.near.len() >= near
    }

    /// The same memory, cut to `count` discs.
    pub(crate) fn discs(&mut self, count: usize) -> Memory<'_> {
        Memory {
            ids: cut(self.ids, count),
            slots: cut(self.slots, count),
            x: cut(self.x, count),
            y: cut(self.y, count),
            crossings_x: cut(self.crossings_x, count),
            crossings_y: cut(self.crossings_y, count),
            force_x: cut(self.force_x, count),
            force_y: cut(self.force_y, count),
            displacement_x: cut(self.displacement_x, count),
            displacement_y: cut(self.displacement_y, count),
            strengths: cut(self.strengths, count),
            held_x: cut(self.held_x, count),
            held_y: cut(self.held_y, count),
            fresh_x: cut(self.fresh_x, count),
            fresh_y: cut(self.fresh_y, count),
            reference_x: cut(self.reference_x, count),
            reference_y: cut(self.reference_y, count),
            next: cut(self.next, count),
            nodes: self.nodes,
            field: self.field,
            lines: self.lines,
            influence: self.influence,
            gradient: self.gradient,
            near: self.near,
        }
    }
}

/// The first `count` elements, or none if there are fewer.
fn cut<T>(all: &mut [T], count: usize) -> &mut [T] {
    all.get_mut(..count).unwrap_or(&mut [])
}
