//! Mass assignment in lanes: from discs to mesh nodes and back, with the bits of [`meniscus_core::assignment`].
//!
//! The weights of as many discs as there are lanes are found at once. To deposit them, they are turned into rows of a
//! disc's nodes, which are added to the mesh row by row; to gather, runs of the field's rows are turned into lanes, and
//! each lane sums its own disc's products in the core's order.
//!
//! Discs may come in any order. Work is quick if they come by cells: neighbours touch the same nodes, and of the mesh
//! columns that a piece of a deposit owns few discs touch a part only.
//!
//! ```
//! use meniscus_core::assignment::DISC;
//! use meniscus_core::grid::Grid;
//! use meniscus_core::parameters::Assignment;
//! use meniscus_core::torus::Fraction;
//! use meniscus_wide::assignment::MeshAssignment;
//! use meniscus_wide::lanes::Level;
//!
//! let scheme = MeshAssignment { level: Level::best(), pieces: 1, assignment: Assignment::Order5, grid: Grid::SMALLEST };
//! let mut nodes = [0; 256];
//! let (x, y) = ([Fraction::from_bits(12345)], [Fraction::from_bits(u32::MAX)]);
//! scheme.deposit((&x, &y), &mut nodes).unwrap();
//! assert_eq!(nodes.iter().sum::<u32>(), DISC);
//! ```

mod deposit;
mod gather;
mod shares;
mod weights;

use crate::lanes::{Level, bits_of_fractions, bits_of_i64_mut};
use crate::pieces::in_pieces;
use deposit::Deposit;
use gather::Gather;
use meniscus_core::assignment::{Crowded, DISC, LARGEST_NODE_MASS, LARGEST_NODE_STRENGTH};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::Fraction;
use meniscus_core::transform::Complex32;
use shares::Shares;

/// How discs are assigned to a mesh, and by what means.
#[derive(Clone, Copy, Debug)]
pub struct MeshAssignment {
    /// The registers to use.
    pub level: Level,
    /// In how many pieces to do the work; 1 for all of it here and now.
    pub pieces: usize,
    /// The order of assignment.
    pub assignment: Assignment,
    /// The size of the mesh.
    pub grid: Grid,
}

/// A force field on M × M nodes, F_x + i·F_y in kBT/R0.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// Node (x, y) is element `x·pitch + y`.
    pub nodes: &'a [Complex32],
    /// How far apart rows begin, M or more.
    pub pitch: usize,
}

/// Does work generic over the order P, and over the number of pairs of nodes in P, with those of an assignment.
macro_rules! in_pieces_by_order {
    ($scheme:expr, $work:ident { $($field:ident),* }) => {
        match $scheme.assignment {
            Assignment::CloudInCell => in_pieces($work::<2, 1> { $($field),* }, $scheme.pieces),
            Assignment::TriangularShapedCloud => in_pieces($work::<3, 2> { $($field),* }, $scheme.pieces),
            Assignment::Order4 => in_pieces($work::<4, 2> { $($field),* }, $scheme.pieces),
            Assignment::Order5 => in_pieces($work::<5, 3> { $($field),* }, $scheme.pieces),
            Assignment::Order6 => in_pieces($work::<6, 3> { $($field),* }, $scheme.pieces),
            Assignment::Order7 => in_pieces($work::<7, 4> { $($field),* }, $scheme.pieces),
        }
    };
}

impl MeshAssignment {
    /// As [`meniscus_core::assignment::deposit`]: spreads the mass of the discs at (x, y) over `nodes`, M × M elements
    /// of unit 2⁻²⁰ discs.
    ///
    /// # Errors
    /// [`Crowded`] if a node holds more than [`LARGEST_NODE_MASS`] discs; `nodes` is then of no use.
    pub fn deposit(&self, positions: (&[Fraction], &[Fraction]), nodes: &mut [u32]) -> Result<(), Crowded> {
        // Fewer discs cannot crowd a node.
        let counted = positions.0.len() > LARGEST_NODE_MASS as usize;
        let largest = self.spread(positions, Shares::Equal, counted, nodes);
        if largest > LARGEST_NODE_MASS * DISC { Err(Crowded) } else { Ok(()) }
    }

    /// As [`meniscus_core::assignment::deposit_strengths`]: spreads the capillary strengths (unit 2⁻²⁰) of the discs.
    ///
    /// # Errors
    /// [`Crowded`] if the moduli of the shares of a node sum to more than [`LARGEST_NODE_STRENGTH`]; `nodes` is then of
    /// no use.
    pub fn deposit_strengths(
        &self,
        positions: (&[Fraction], &[Fraction]),
        strengths: &[i32],
        nodes: &mut [u32],
    ) -> Result<(), Crowded> {
        let limit = LARGEST_NODE_STRENGTH * DISC;
        let total: u64 = strengths.iter().map(|strength| u64::from(strength.unsigned_abs())).sum();
        // See the core: below that no sum can overflow.
        if total > u64::from(limit) && self.spread(positions, Shares::Moduli(strengths), true, nodes) > limit
        {
            return Err(Crowded);
        }
        self.spread(positions, Shares::Signed(strengths), false, nodes);
        Ok(())
    }

    /// As [`meniscus_core::assignment::gather`]: gathers the force on the discs at (x, y), unit 2⁻²⁴ kBT/R0.
    pub fn gather(
        &self,
        positions: (&[Fraction], &[Fraction]),
        field: Field<'_>,
        forces: (&mut [i64], &mut [i64]),
    ) {
        self.collect(positions, Shares::Equal, field, forces);
    }

    /// As [`meniscus_core::assignment::gather_strengths`]: for discs of the given capillary strengths (unit 2⁻²⁰).
    pub fn gather_strengths(
        &self,
        positions: (&[Fraction], &[Fraction]),
        strengths: &[i32],
        field: Field<'_>,
        forces: (&mut [i64], &mut [i64]),
    ) {
        self.collect(positions, Shares::Signed(strengths), field, forces);
    }

    /// Spreads the shares over the nodes; gives the largest sum on a node if they are counted, else 0.
    fn spread(
        &self,
        (x, y): (&[Fraction], &[Fraction]),
        shares: Shares<'_>,
        counted: bool,
        nodes: &mut [u32],
    ) -> u32 {
        let (x, y) = (bits_of_fractions(x), bits_of_fractions(y));
        let (level, grid, first_column) = (self.level, self.grid, 0);
        in_pieces_by_order!(self, Deposit { level, grid, x, y, shares, counted, first_column, nodes })
    }

    /// Collects from the field with the shares.
    fn collect(
        &self,
        (x, y): (&[Fraction], &[Fraction]),
        shares: Shares<'_>,
        field: Field<'_>,
        (force_x, force_y): (&mut [i64], &mut [i64]),
    ) {
        let (x, y) = (bits_of_fractions(x), bits_of_fractions(y));
        let (force_x, force_y) = (bits_of_i64_mut(force_x), bits_of_i64_mut(force_y));
        let (level, grid) = (self.level, self.grid);
        in_pieces_by_order!(self, Gather { level, grid, x, y, shares, field, force_x, force_y });
    }
}
