//! The wide stages of a step, for [`meniscus_core::dynamics::Dynamics`].
//!
//! ```
//! use meniscus_core::engine::Engine;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::torus::Position;
//! use meniscus_wide::stages::Wide;
//!
//! let parameters = Parameters::default().with_p3m();
//! let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 27, 1 << 20))];
//! let (mut core, mut wide) = (Engine::<64, 2>::new(), Engine::<64, 2>::new());
//! core.init(&parameters, discs).unwrap();
//! wide.init(&parameters, discs).unwrap();
//! core.step().unwrap();
//! let (dynamics, mut memory) = wide.parts();
//! dynamics.step(&mut Wide::new(&parameters, 2, 1), &mut memory).unwrap();
//! assert_eq!(core.state().digest(), wide.state().digest());
//! ```

use crate::assignment::{Field, MeshAssignment};
use crate::division::Division;
use crate::lanes::{Level, bits_of_fractions, bits_of_fractions_mut, bits_of_i32_mut};
use crate::mesh::Solver;
use crate::motion::Motion;
use crate::neighbours::Neighbours;
use crate::order::permute;
use crate::pairs::{Discs, PairLoop, Strengths};
use meniscus_core::assignment::Crowded;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::forces::{Coupling, Forces};
use meniscus_core::grid::Grid;
use meniscus_core::memory::Memory;
use meniscus_core::mesh::Tables;
use meniscus_core::near_part::{Segment, fill_table, table_length};
use meniscus_core::pair_force::{PairForce, near_cutoff};
use meniscus_core::parameters::Parameters;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::transform::AnySize;

/// The stages of one run, and the arrays that are theirs alone: `field` and `lines` of the memory are not used.
#[derive(Debug)]
pub struct Wide {
    level: Level,
    division: Division,
    solver: Solver,
    force: PairForce,
    table: Vec<Segment>,
    pairs: PairLoop,
    neighbours: Neighbours,
    is_heap: bool,
}

impl Wide {
    /// Stages for `count` discs, in up to `threads` threads.
    #[must_use]
    pub fn new(parameters: &Parameters, count: usize, threads: usize) -> Self {
        Self::with(parameters, Level::best(), Division::of(threads, parameters.grid, count))
    }

    /// Stages with the registers of a level, divided as asked for; several pieces are done in the threads of the rayon pool
    /// in which a stage is called.
    #[must_use]
    pub fn with(parameters: &Parameters, level: Level, division: Division) -> Self {
        // What `Dynamics` was made of is valid; stages of other parameters do not fit it.
        let grid = Grid::new(parameters.grid).unwrap_or(Grid::SMALLEST);
        let force = PairForce::new(parameters);
        let mut table = vec![Segment::default(); table_length(near_cutoff(parameters))];
        fill_table(parameters.splitting, parameters.capillary_length, &mut table);
        Self {
            level,
            division,
            solver: Solver::new(grid, level),
            force,
            pairs: PairLoop::new(level, &force, &table),
            table,
            neighbours: Neighbours::new(level, force.reach()),
            is_heap: false,
        }
    }

    /// In how many threads a step is best called.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.division.threads()
    }

    /// The registers in use.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// Whether so many discs were so close to each other when the forces were last computed that pairs were found without
    /// lists, by the core.
    #[must_use]
    pub fn is_heap(&self) -> bool {
        self.is_heap
    }

    /// The field on the nodes that the last step which solved for it found.
    #[must_use]
    pub fn field(&self) -> Field<'_> {
        Field { nodes: self.solver.field(), pitch: self.solver.pitch() }
    }

    fn motion(&self) -> Motion {
        Motion { level: self.level, pieces: self.division.discs }
    }
}

/// Close pairs among `count` discs up to which lists are made: discs side by side with a cut-off of 24 R0 have 350 each.
const fn most_close_pairs(count: usize) -> u64 {
    (1 << 22) + 512 * count as u64
}

/// Stores the discs in this order; their displacements and forces, which are yet to be computed, serve as working memory.
fn store(order: &[u32], discs: &mut Memory<'_>) {
    let scratch = bits_of_i32_mut(discs.displacement_x);
    permute(order, discs.ids, scratch);
    for (slot, &id) in discs.ids.iter().enumerate() {
        if let Some(place) = discs.slots.get_mut(id as usize) {
            *place = slot as u32;
        }
    }
    for values in [&mut *discs.x, discs.y, discs.reference_x, discs.reference_y] {
        permute(order, bits_of_fractions_mut(values), scratch);
    }
    for values in [&mut *discs.crossings_x, discs.crossings_y, discs.strengths] {
        permute(order, bits_of_i32_mut(values), scratch);
    }
    for values in [&mut *discs.held_x, discs.held_y] {
        permute(order, values, discs.force_x);
    }
}

impl Stages for Wide {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        let side = forces.grid().nodes();
        memory.nodes.len() == side * side
            && self.solver.grid() == forces.grid()
            && self.force == *forces.pairs()
            && memory.near.get(..forces.near_length()) == Some(self.table.as_slice())
    }

    /// Makes new lists of neighbours where the old ones have become useless, and stores the discs in the order of cells.
    fn arrange(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        let pieces = self.division.discs;
        let (x, y) = (bits_of_fractions(memory.x), bits_of_fractions(memory.y));
        if forces.pairs().reach() == 0 || self.neighbours.is_fresh(x, y, pieces) {
            return;
        }
        let order = self.neighbours.arrange(x, y);
        self.is_heap = order.close_pairs() > most_close_pairs(x.len());
        if !order.is_identity() {
            store(order.discs(), memory);
        }
        if self.is_heap {
            self.neighbours.forget();
            return;
        }
        self.neighbours.rebuild(bits_of_fractions(memory.x), bits_of_fractions(memory.y), pieces);
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        let Memory { x, y, force_x, force_y, strengths, nodes, influence, gradient, .. } = memory;
        let Division { mesh: lines, discs: pieces } = self.division;
        let assignment = MeshAssignment {
            level: self.level,
            pieces,
            assignment: forces.assignment(),
            grid: forces.grid(),
        };
        let is_signed = match forces.coupling() {
            Coupling::None => {
                force_x.fill(0);
                force_y.fill(0);
                return Ok(());
            }
            Coupling::Equal => false,
            Coupling::Unequal => true,
        };
        if is_signed {
            assignment.deposit_strengths((x, y), strengths, nodes)?;
        } else {
            assignment.deposit((x, y), nodes)?;
        }
        self.solver.solve(&Tables { influence, gradient }, nodes, is_signed, lines);
        let field = self.field();
        if is_signed {
            assignment.gather_strengths((x, y), strengths, field, (force_x, force_y));
        } else {
            assignment.gather((x, y), field, (force_x, force_y));
        }
        Ok(())
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        if self.is_heap {
            return Scalar(AnySize).add_pairs(forces, memory);
        }
        let strengths = match forces.coupling() {
            Coupling::None => Strengths::Alike(0.0),
            Coupling::Equal => Strengths::Alike(PairForce::EQUAL),
            Coupling::Unequal => Strengths::Each(memory.strengths),
        };
        let discs = Discs { ids: memory.ids, strengths };
        self.pairs.add(&self.neighbours, &discs, (memory.force_x, memory.force_y));
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        Scalar(AnySize).add_fields(forces, memory);
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        self.motion().largest_force(memory.force_x, memory.force_y)
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        let Memory { ids, force_x, force_y, displacement_x, displacement_y, .. } = memory;
        let forces = (&**force_x, &**force_y);
        self.motion().displacements(displacement, ids, forces, (displacement_x, displacement_y))
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        let motion = self.motion();
        motion.displace(memory.x, memory.crossings_x, memory.displacement_x);
        motion.displace(memory.y, memory.crossings_y, memory.displacement_y);
    }
}
