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

use crate::assignment::{Crowded, DISC};
use crate::crowding::Crowding;
use crate::fields::FieldForce;
use crate::grid::Grid;
use crate::memory::Memory;
use crate::near_part::table_length;
use crate::pair_force::{PairForce, near_cutoff};
use crate::parameters::{Assignment, Parameters};
use crate::refresh::Refresh;
use crate::stages::Stages;

/// Why forces could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceError {
    /// There is nothing to move: the engine was not initialised, or its initialisation failed.
    NotInitialised,
    /// The memory lent does not fit the run.
    Memory,
    /// A mesh node would hold more than 4095 discs, or strengths of more than 2047, or too many discs are in one place,
    /// see [`crate::crowding`].
    Crowded,
}

/// Which capillary strengths the discs have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
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
    crowding: Crowding,
    fields: FieldForce,
    refresh: Refresh,
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
            crowding: Crowding::blank(),
            fields: FieldForce::blank(),
            refresh: Refresh::NEVER,
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
        let repels = if parameters.repulsion { PairForce::repulsion(parameters.side).reach() } else { 0 };
        // Where there is no force there is none to hold.
        let refresh = match coupling {
            Coupling::None => Refresh::NEVER,
            Coupling::Equal | Coupling::Unequal => Refresh::new(parameters.mesh_refresh, parameters.side),
        };
        Self {
            grid,
            assignment: parameters.assignment,
            coupling,
            written: !all_one,
            pairs: PairForce::new(parameters),
            crowding: Crowding::new(repels, grid),
            fields: FieldForce::new(&parameters.fields, parameters.side),
            refresh,
            near: table_length(near_cutoff(parameters)),
        }
    }

    /// Whether all discs have strength 1.
    pub(crate) fn strengths_are_equal(&self) -> bool {
        !self.written
    }

    /// The mesh.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// How mass is spread over the mesh and the field gathered.
    #[must_use]
    pub fn assignment(&self) -> Assignment {
        self.assignment
    }

    /// Which capillary strengths the discs have.
    #[must_use]
    pub fn coupling(&self) -> Coupling {
        self.coupling
    }

    /// The force of a pair.
    #[must_use]
    pub fn pairs(&self) -> &PairForce {
        &self.pairs
    }

    /// The external fields.
    #[must_use]
    pub fn fields(&self) -> &FieldForce {
        &self.fields
    }

    /// When held mesh forces are computed anew.
    #[must_use]
    pub fn refresh(&self) -> Refresh {
        self.refresh
    }

    /// Length of the table of the near part; 0 without.
    #[must_use]
    pub fn near_length(&self) -> usize {
        self.near
    }

    /// Refuses so many discs in one place that their forces might overflow.
    fn check_crowding(&self, discs: &mut Memory<'_>) -> Result<(), Crowded> {
        if self.crowding.concerns(discs.x.len()) {
            self.crowding.count((discs.x, discs.y), discs.nodes)?;
        }
        Ok(())
    }

    /// Whether the memory fits `count` discs, their tables and these stages.
    fn fit<S: Stages>(&self, stages: &S, count: usize, memory: &Memory<'_>) -> bool {
        let cells = self.crowding.cells_a_side();
        memory.capacity() >= count
            && (!self.refresh.holds() || memory.room_to_hold() >= count)
            && (!self.crowding.concerns(count) || memory.nodes.len() >= cells * cells)
            && memory.holds_tables(self.grid.nodes(), self.near)
            && stages.fits(self, memory)
    }

    /// Computes the force on each of the first `count` discs into `force_x` and `force_y`, and tells whether that of the
    /// mesh was computed anew; if forces are to be held it is in `fresh_x` and `fresh_y` then. `is_held` says whether
    /// some are.
    ///
    /// # Errors
    /// A [`ForceError`]; the state is not touched either way.
    pub(crate) fn compute<S: Stages>(
        &self,
        stages: &mut S,
        count: usize,
        is_held: bool,
        memory: &mut Memory<'_>,
    ) -> Result<bool, ForceError> {
        if count == 0 {
            return Err(ForceError::NotInitialised);
        }
        if !self.fit(stages, count, memory) {
            return Err(ForceError::Memory);
        }
        let discs = &mut memory.discs(count);
        self.check_crowding(discs).map_err(|Crowded| ForceError::Crowded)?;
        stages.arrange(self, discs);
        let is_fresh = self.mesh(stages, is_held, discs).map_err(|Crowded| ForceError::Crowded)?;
        if self.pairs.reach() > 0 {
            stages.add_pairs(self, discs);
        }
        if !self.fields.is_zero() {
            stages.add_fields(self, discs);
        }
        Ok(is_fresh)
    }

    /// The force of the mesh, held or computed anew; tells whether it was computed.
    fn mesh<S: Stages>(
        &self,
        stages: &mut S,
        is_held: bool,
        discs: &mut Memory<'_>,
    ) -> Result<bool, Crowded> {
        let reference = (&*discs.reference_x, &*discs.reference_y);
        if is_held && !self.refresh.is_due(reference, (discs.x, discs.y)) {
            copy(discs.held_x, discs.force_x);
            copy(discs.held_y, discs.force_y);
            return Ok(false);
        }
        stages.mesh(self, discs)?;
        if self.refresh.holds() {
            copy(discs.force_x, discs.fresh_x);
            copy(discs.force_y, discs.fresh_y);
        }
        Ok(true)
    }
}

/// Copies as many as there are of both; they are of one length.
fn copy(from: &[i64], to: &mut [i64]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = from;
    }
}
