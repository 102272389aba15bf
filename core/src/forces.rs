//! All forces on all discs: mesh ⊕ pairs ⊕ external fields, as sums of integers.
//!
//! ```
//! use meniscus_core::engine::Engine;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::torus::Position;
//!
//! let mut engine = Engine::<64, 2>::new();
//! let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 30, 0))];
//! engine.init(&Parameters::default(), discs).unwrap();
//! engine.compute_forces().unwrap();
//! // A quarter of the box apart they attract each other.
//! assert!(engine.force(0).unwrap().0 > 0 && engine.force(1).unwrap().0 < 0);
//! ```

use crate::assignment::{self, Crowded, DISC};
use crate::cells::for_each_pair;
use crate::fields::FieldForce;
use crate::grid::Grid;
use crate::memory::Memory;
use crate::mesh::{Tables, solve, solve_strengths};
use crate::near_part::table_length;
use crate::pair_force::{PairForce, near_cutoff, product_of_strengths};
use crate::parameters::{Assignment, Parameters};
use crate::transform::LineTransform;

/// Why forces could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceError {
    /// There is nothing to move: the engine was not initialised, or its initialisation failed.
    NotInitialised,
    /// The memory lent does not fit the run.
    Memory,
    /// A mesh node would hold more than 4095 discs, or strengths of more than 2047.
    Crowded,
}

/// Which capillary strengths the discs have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Coupling {
    /// None: V0 or all strengths are 0.
    None,
    /// 1, all of them.
    Equal,
    /// Others.
    Unequal,
}

/// The forces of a run, without its arrays.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    grid: Grid,
    assignment: Assignment,
    coupling: Coupling,
    /// Whether a strength is not 1; only then are they written.
    written: bool,
    pairs: PairForce,
    fields: FieldForce,
    /// Length of the table of the near part.
    near: usize,
}

impl Forces {
    /// For statics; of no use before it is replaced.
    pub(crate) const fn blank() -> Self {
        Self {
            grid: Grid::SMALLEST,
            assignment: Assignment::CloudInCell,
            coupling: Coupling::None,
            written: false,
            pairs: PairForce::blank(),
            fields: FieldForce::blank(),
            near: 0,
        }
    }

    /// The forces of valid parameters on a mesh of `grid` nodes, between discs of these strengths (unit 2⁻²⁰).
    pub(crate) fn new(parameters: &Parameters, grid: Grid, strengths: &[i32]) -> Self {
        let all_one = strengths.iter().all(|&strength| strength == DISC as i32);
        let coupling =
            if parameters.capillary_strength == 0.0 || strengths.iter().all(|&strength| strength == 0) {
                Coupling::None
            } else if all_one {
                Coupling::Equal
            } else {
                Coupling::Unequal
            };
        Self {
            grid,
            assignment: parameters.assignment,
            coupling,
            written: !all_one,
            pairs: PairForce::new(parameters),
            fields: FieldForce::new(&parameters.fields, parameters.side),
            near: table_length(near_cutoff(parameters)),
        }
    }

    /// Whether all discs have strength 1.
    pub(crate) fn strengths_are_equal(&self) -> bool {
        !self.written
    }

    /// Whether the memory fits `count` discs and their mesh.
    fn fit(&self, count: usize, memory: &Memory<'_>) -> bool {
        memory.capacity() >= count && memory.holds_grid(self.grid.nodes()) && memory.near.len() >= self.near
    }

    /// Computes the force on each of the first `count` discs into `force_x` and `force_y`.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub(crate) fn compute<T: LineTransform>(
        &self,
        transform: &T,
        count: usize,
        memory: &mut Memory<'_>,
    ) -> Result<(), ForceError> {
        if count == 0 {
            return Err(ForceError::NotInitialised);
        }
        if !self.fit(count, memory) {
            return Err(ForceError::Memory);
        }
        self.attract(transform, memory.discs(count)).map_err(|Crowded| ForceError::Crowded)?;
        if self.pairs.reach() > 0 {
            self.add_pairs(memory.discs(count));
        }
        if !self.fields.is_zero() {
            self.add_fields(memory.discs(count));
        }
        Ok(())
    }

    /// The capillary force by the mesh.
    fn attract<T: LineTransform>(&self, transform: &T, discs: Memory<'_>) -> Result<(), Crowded> {
        let tables = Tables { influence: discs.influence, gradient: discs.gradient };
        let (assignment, grid) = (self.assignment, self.grid);
        let (x, y) = (&*discs.x, &*discs.y);
        let forces = (&mut *discs.force_x, &mut *discs.force_y);
        match self.coupling {
            Coupling::None => {
                forces.0.fill(0);
                forces.1.fill(0);
            }
            Coupling::Equal => {
                assignment::deposit(assignment, grid, x, y, discs.nodes)?;
                solve(transform, grid, &tables, discs.nodes, discs.field, discs.lines);
                assignment::gather(assignment, grid, (x, y), discs.field, forces);
            }
            Coupling::Unequal => {
                let strengths = &*discs.strengths;
                assignment::deposit_strengths(assignment, grid, (x, y), strengths, discs.nodes)?;
                solve_strengths(transform, grid, &tables, discs.nodes, discs.field, discs.lines);
                assignment::gather_strengths(assignment, grid, (x, y), strengths, discs.field, forces);
            }
        }
        Ok(())
    }

    /// Adds the forces of all pairs.
    fn add_pairs(&self, discs: Memory<'_>) {
        let Memory { ids, x, y, force_x, force_y, strengths, near, next, nodes, .. } = discs;
        let table = near.get(..self.near).unwrap_or(&[]);
        let id = |disc: usize| ids.get(disc).copied().unwrap_or(0);
        let strength = |disc: usize| strengths.get(disc).copied().unwrap_or(0);
        let product = |first: usize, second: usize| match self.coupling {
            Coupling::None => 0.0,
            Coupling::Equal => PairForce::EQUAL,
            Coupling::Unequal => product_of_strengths(strength(first), strength(second)),
        };
        let mut add = |disc: usize, (x, y): (i64, i64)| {
            if let (Some(force_x), Some(force_y)) = (force_x.get_mut(disc), force_y.get_mut(disc)) {
                *force_x += x;
                *force_y += y;
            }
        };
        for_each_pair((x, y), self.pairs.reach(), nodes, next, |first, second, separation| {
            let first_is_lower = id(first) < id(second);
            let force = self.pairs.of(separation, first_is_lower, product(first, second), table);
            if let Some((x, y)) = force {
                add(first, (x, y));
                add(second, (-x, -y));
            }
        });
    }

    /// Adds the external fields.
    fn add_fields(&self, discs: Memory<'_>) {
        let positions = discs.x.iter().zip(discs.y.iter());
        let forces = discs.force_x.iter_mut().zip(discs.force_y);
        for ((&x, &y), (force_x, force_y)) in positions.zip(forces) {
            let (along_x, along_y) = self.fields.at(x, y);
            *force_x += along_x;
            *force_y += along_y;
        }
    }
}
