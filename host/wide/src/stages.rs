//! The wide stages of a step, for [`meniscus_core::dynamics::Dynamics`].

use crate::division::Division;
use crate::lanes::Level;
use meniscus_core::assignment::{self, Crowded};
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::forces::{Coupling, Forces};
use meniscus_core::memory::Memory;
use meniscus_core::mesh::{LINES, Tables, solve, solve_strengths};
use meniscus_core::parameters::Parameters;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::transform::{AnySize, Complex32};

/// The stages and the arrays that are theirs alone.
#[derive(Debug)]
pub struct Wide {
    field: Vec<Complex32>,
    lines: Vec<Complex32>,
    division: Division,
    scalar: Scalar<AnySize>,
}

impl Wide {
    /// Stages for `count` discs, in up to `threads` threads.
    #[must_use]
    pub fn new(parameters: &Parameters, count: usize, threads: usize) -> Self {
        Self::with(parameters, count, Level::best(), Division::of(threads, parameters.grid, count))
    }

    /// Stages for `count` discs with the registers of a level, divided as asked for; several pieces are done in the
    /// threads of the rayon pool in which a stage is called.
    #[must_use]
    pub fn with(parameters: &Parameters, _count: usize, _level: Level, division: Division) -> Self {
        let (zero, grid) = (Complex32::new(0.0, 0.0), parameters.grid);
        Self {
            field: vec![zero; grid * grid],
            lines: vec![zero; grid * LINES],
            division,
            scalar: Scalar(AnySize),
        }
    }

    /// In how many threads a step is to be called.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.division.threads()
    }
}

impl Stages for Wide {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        let side = forces.grid().nodes();
        memory.nodes.len() == side * side && self.field.len() == side * side
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        let Memory { x, y, force_x, force_y, strengths, nodes, influence, gradient, .. } = memory;
        let tables = Tables { influence, gradient };
        let (assignment, grid) = (forces.assignment(), forces.grid());
        let (field, lines) = (&mut self.field, &mut self.lines);
        match forces.coupling() {
            Coupling::None => {
                force_x.fill(0);
                force_y.fill(0);
            }
            Coupling::Equal => {
                assignment::deposit(assignment, grid, x, y, nodes)?;
                solve(&self.scalar.0, grid, &tables, nodes, field, lines);
                assignment::gather(assignment, grid, (x, y), field, (force_x, force_y));
            }
            Coupling::Unequal => {
                assignment::deposit_strengths(assignment, grid, (x, y), strengths, nodes)?;
                solve_strengths(&self.scalar.0, grid, &tables, nodes, field, lines);
                assignment::gather_strengths(assignment, grid, (x, y), strengths, field, (force_x, force_y));
            }
        }
        Ok(())
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.scalar.add_pairs(forces, memory);
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.scalar.add_fields(forces, memory);
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        self.scalar.largest_force(memory)
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        self.scalar.displacements(displacement, memory)
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        self.scalar.displace(memory);
    }
}
