//! The stages of a step, as [`crate::dynamics::Dynamics`] composes them.
//!
//! [`Stages`] names them, in the order in which a step calls them; [`Scalar`] has the core's own, one disc after the
//! other. Another engine may do the same in other ways – several discs at once, in arrays of its own – as long as every
//! integer it leaves in the [`Memory`] is the same. When to call which, what a failure leaves behind and how the clock
//! advances is for `Dynamics` alone.
//!
//! ```
//! use meniscus_core::engine::Engine;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::stages::Scalar;
//! use meniscus_core::torus::Position;
//! use meniscus_core::transform::FixedSize;
//!
//! let mut engine = Engine::<64, 1>::new();
//! engine.init(&Parameters::default(), [(0, Position::from_bits(0, 0))]).unwrap();
//! let (dynamics, mut memory) = engine.parts();
//! let step = dynamics.step(&mut Scalar(FixedSize::<64>), &mut memory).unwrap();
//! assert_eq!(step.clock.step, 1);
//! ```

use crate::assignment::{self, Crowded};
use crate::cells::for_each_pair;
use crate::ermak::{self, Displacement, HalfBox};
use crate::forces::{Coupling, Forces};
use crate::memory::Memory;
use crate::mesh::{Tables, solve, solve_strengths};
use crate::pair_force::{PairForce, product_of_strengths};
use crate::transform::LineTransform;

/// The stages of a step.
///
/// The memory that a stage is lent holds the run's discs and no more: each array of discs has an element for every disc.
pub trait Stages {
    /// Whether the working arrays that these stages use, their own and those of the memory (node masses, field, lines),
    /// are right for the run. Arrays of discs and tables are checked by the caller.
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool;

    /// May store the discs in another order: ids, coordinates, crossings, strengths and what is held (force and
    /// reference) alike, and `slots` so that it says where each id is. The other arrays of discs hold nothing that is
    /// looked at afterwards.
    fn arrange(&mut self, _forces: &Forces, _memory: &mut Memory<'_>) {}

    /// Puts the capillary force of the mesh on every disc into `force_x` and `force_y`; 0 if there is none.
    ///
    /// # Errors
    /// [`Crowded`] if a node would hold more than [`crate::assignment`] allows.
    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded>;

    /// Adds the forces of all pairs. Not called if they exert none.
    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>);

    /// Adds the external fields. Not called if there is none.
    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>);

    /// The largest modulus of the forces, see [`ermak::largest_force`].
    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64;

    /// Turns forces and noise into displacements, moving nothing.
    ///
    /// # Errors
    /// [`HalfBox`] if a displacement reaches half a box.
    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox>;

    /// Adds the displacements to the positions, see [`ermak::displace`].
    fn displace(&mut self, memory: &mut Memory<'_>);
}

/// The core's own stages: one disc after the other, with this transform of lines, in the arrays of the memory.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scalar<T: LineTransform>(pub T);

impl<T: LineTransform> Stages for Scalar<T> {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        let side = forces.grid().nodes();
        let nodes = side * side;
        memory.nodes.len() == nodes && memory.field.len() == nodes && memory.lines.len() >= 2 * side
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        let Memory { x, y, force_x, force_y, strengths, nodes, field, lines, influence, gradient, .. } =
            memory;
        let tables = Tables { influence, gradient };
        let (assignment, grid) = (forces.assignment(), forces.grid());
        match forces.coupling() {
            Coupling::None => {
                force_x.fill(0);
                force_y.fill(0);
            }
            Coupling::Equal => {
                assignment::deposit(assignment, grid, x, y, nodes)?;
                solve(&self.0, grid, &tables, nodes, field, lines);
                assignment::gather(assignment, grid, (x, y), field, (force_x, force_y));
            }
            Coupling::Unequal => {
                assignment::deposit_strengths(assignment, grid, (x, y), strengths, nodes)?;
                solve_strengths(&self.0, grid, &tables, nodes, field, lines);
                assignment::gather_strengths(assignment, grid, (x, y), strengths, field, (force_x, force_y));
            }
        }
        Ok(())
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        let Memory { ids, x, y, force_x, force_y, strengths, near, next, nodes, .. } = memory;
        let table = near.get(..forces.near_length()).unwrap_or(&[]);
        let id = |disc: usize| ids.get(disc).copied().unwrap_or(0);
        let strength = |disc: usize| strengths.get(disc).copied().unwrap_or(0);
        let product = |first: usize, second: usize| match forces.coupling() {
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
        let pairs = forces.pairs();
        for_each_pair((x, y), pairs.reach(), nodes, next, |first, second, separation| {
            let first_is_lower = id(first) < id(second);
            let force = pairs.of(separation, first_is_lower, product(first, second), table);
            if let Some((x, y)) = force {
                add(first, (x, y));
                add(second, (-x, -y));
            }
        });
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        let positions = memory.x.iter().zip(memory.y.iter());
        let targets = memory.force_x.iter_mut().zip(memory.force_y.iter_mut());
        for ((&x, &y), (force_x, force_y)) in positions.zip(targets) {
            let (along_x, along_y) = forces.fields().at(x, y);
            *force_x += along_x;
            *force_y += along_y;
        }
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        ermak::largest_force(memory.force_x, memory.force_y)
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        let forces = memory.force_x.iter().zip(memory.force_y.iter());
        let targets = memory.displacement_x.iter_mut().zip(memory.displacement_y.iter_mut());
        for ((&id, (&force_x, &force_y)), (x, y)) in memory.ids.iter().zip(forces).zip(targets) {
            (*x, *y) = displacement.of(id, (force_x, force_y))?;
        }
        Ok(())
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        let along_x =
            memory.x.iter_mut().zip(memory.crossings_x.iter_mut()).zip(memory.displacement_x.iter());
        let along_y =
            memory.y.iter_mut().zip(memory.crossings_y.iter_mut()).zip(memory.displacement_y.iter());
        for ((coordinate, crossings), units) in along_x.chain(along_y) {
            ermak::displace(coordinate, crossings, *units);
        }
    }
}
