//! A run's memory as vectors, each of a length the test chooses.

use meniscus_core::dynamics::Memory;
use meniscus_core::influence::influence_length;
use meniscus_core::near_part::{LARGEST_TABLE, Segment};
use meniscus_core::refresh::HeldForces;
use meniscus_core::torus::Fraction;
use meniscus_core::transform::Complex32;

/// The arrays of [`Memory`], owned.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the fields are those of Memory and documented there")]
pub struct Arrays {
    pub ids: Vec<u32>,
    pub slots: Vec<u32>,
    pub x: Vec<Fraction>,
    pub y: Vec<Fraction>,
    pub crossings_x: Vec<i32>,
    pub crossings_y: Vec<i32>,
    pub force_x: Vec<i64>,
    pub force_y: Vec<i64>,
    pub displacement_x: Vec<i32>,
    pub displacement_y: Vec<i32>,
    pub strengths: Vec<i32>,
    pub held_x: Vec<i64>,
    pub held_y: Vec<i64>,
    pub fresh_x: Vec<i64>,
    pub fresh_y: Vec<i64>,
    pub reference_x: Vec<Fraction>,
    pub reference_y: Vec<Fraction>,
    pub next: Vec<u32>,
    pub nodes: Vec<u32>,
    pub field: Vec<Complex32>,
    pub lines: Vec<Complex32>,
    pub influence: Vec<f32>,
    pub gradient: Vec<f32>,
    pub near: Vec<Segment>,
}

impl Arrays {
    /// Memory for `grid` mesh nodes a side, `rows` rows of the spectrum at once and `capacity` discs.
    #[must_use]
    pub fn new(grid: usize, rows: usize, capacity: usize) -> Self {
        let zero = Complex32::new(0.0, 0.0);
        Self {
            ids: vec![0; capacity],
            slots: vec![0; capacity],
            x: vec![Fraction::ZERO; capacity],
            y: vec![Fraction::ZERO; capacity],
            crossings_x: vec![0; capacity],
            crossings_y: vec![0; capacity],
            force_x: vec![0; capacity],
            force_y: vec![0; capacity],
            displacement_x: vec![0; capacity],
            displacement_y: vec![0; capacity],
            strengths: vec![0; capacity],
            held_x: vec![0; capacity],
            held_y: vec![0; capacity],
            fresh_x: vec![0; capacity],
            fresh_y: vec![0; capacity],
            reference_x: vec![Fraction::ZERO; capacity],
            reference_y: vec![Fraction::ZERO; capacity],
            next: vec![0; capacity],
            nodes: vec![0; grid * grid],
            field: vec![zero; grid * grid],
            lines: vec![zero; 2 * grid * rows],
            influence: vec![0.0; influence_length(grid)],
            gradient: vec![0.0; grid],
            near: vec![[0.0; 4]; LARGEST_TABLE],
        }
    }

    /// What a run in these arrays holds.
    #[must_use]
    pub fn held(&self) -> HeldForces<'_> {
        HeldForces {
            reference_x: &self.reference_x,
            reference_y: &self.reference_y,
            force_x: &self.held_x,
            force_y: &self.held_y,
        }
    }

    /// Lends the arrays to a run.
    pub fn memory(&mut self) -> Memory<'_> {
        Memory {
            ids: &mut self.ids,
            slots: &mut self.slots,
            x: &mut self.x,
            y: &mut self.y,
            crossings_x: &mut self.crossings_x,
            crossings_y: &mut self.crossings_y,
            force_x: &mut self.force_x,
            force_y: &mut self.force_y,
            displacement_x: &mut self.displacement_x,
            displacement_y: &mut self.displacement_y,
            strengths: &mut self.strengths,
            held_x: &mut self.held_x,
            held_y: &mut self.held_y,
            fresh_x: &mut self.fresh_x,
            fresh_y: &mut self.fresh_y,
            reference_x: &mut self.reference_x,
            reference_y: &mut self.reference_y,
            next: &mut self.next,
            nodes: &mut self.nodes,
            field: &mut self.field,
            lines: &mut self.lines,
            influence: &mut self.influence,
            gradient: &mut self.gradient,
            near: &mut self.near,
        }
    }
}
