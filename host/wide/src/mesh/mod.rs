//! The mesh solver in wide lanes: node masses to the force field on the nodes, with the bits of
//! [`meniscus_core::mesh`].
//!
//! Three sweeps through one field of M × M complex numbers. Line x is what belongs to column x of the mesh:
//!
//! 1. columns x and x + M/2 together along y, with lanes along the line, split by symmetry at once, frequencies
//!    0 … M/2 − 1 of both stored (and M/2 by itself);
//! 2. rows along x, sixteen frequencies m … m + 15 in the lanes: transformed, multiplied, transformed back, and the same
//!    for their mirrors −m … −m − 15;
//! 3. lines along y again, with lanes along the line, and the field lies there as complex numbers.
//!
//! Between the sweeps a line is M/16 blocks: sixteen frequencies each, first the blocks of 0 … M/2 − 1, then those of the
//! mirrors 0 (Nyquist in its place), −1, −2 …. Block t of eight consecutive lines lies together, so that a row reads
//! and writes 1 KB at a time, and the lines of a group are then the same memory as the eight rows of the field. A line
//! has a block more than it needs: lines a power of two apart would compete for the same places in the caches.
//!
//! ```
//! use meniscus_core::grid::Grid;
//! use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
//! use meniscus_core::mesh::Tables;
//! use meniscus_core::parameters::{Gradient, Parameters};
//! use meniscus_wide::lanes::Level;
//! use meniscus_wide::mesh::Solver;
//!
//! let gradient = Gradient::Difference2;
//! let parameters = Parameters { grid: 16, side: 16.0, gradient, ..Parameters::default() };
//! let mut influence = [0.0; influence_length(16)];
//! let mut gradient = [0.0; 16];
//! fill_influence(&parameters, &mut influence);
//! fill_gradient(&parameters, &mut gradient);
//! let mut nodes = [0; 256];
//! nodes[8 * 16 + 8] = 1 << 20;
//! let mut solver = Solver::new(Grid::SMALLEST, Level::best());
//! solver.solve(&Tables { influence: &influence, gradient: &gradient }, &nodes, false, 1);
//! // A disc at the middle attracts from its left to the right.
//! assert!(solver.field()[4 * solver.pitch() + 8].re > 0.0);
//! ```

mod columns;
mod lines;
mod rows;

use crate::lanes::{Level, Rows, Sixteen, complex_of_sixteens, complex_of_sixteens_mut};
use crate::transform::{Along, Plan, turns};
use meniscus_core::grid::Grid;
use meniscus_core::mesh::{self, Tables};
use meniscus_core::transform::{AnySize, Complex32};

/// Lines that lie together between the sweeps.
const GROUP: usize = Rows::TOGETHER;

/// The mesh solver for one grid, its working memory and the field it gives.
#[derive(Clone, Debug)]
pub struct Solver {
    grid: Grid,
    level: Level,
    /// M lines of `pitch()` complex numbers, in groups of [`GROUP`].
    field: Vec<Sixteen>,
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    /// With the core's own function, for meshes too small for wide lines.
    Core {
        lines: Vec<Complex32>,
    },
    Wide(Box<Wide>),
}

/// Tables and working memory of the wide lanes.
#[derive(Clone, Debug)]
struct Wide {
    along: Along,
    across: Plan,
    /// Row M/2 of the spectrum: of the density, then of the force.
    nyquist: Vec<Complex32>,
    /// Working memory, for each piece as much as [`Wide::scratch_length`] says.
    scratch: Vec<Sixteen>,
}

impl Solver {
    /// A solver for a grid, with these registers.
    #[must_use]
    pub fn new(grid: Grid, level: Level) -> Self {
        let nodes = grid.nodes();
        let method = if nodes < Along::SMALLEST {
            Method::Core { lines: vec![Complex32::default(); mesh::LINES * nodes] }
        } else {
            Method::Wide(Box::new(Wide {
                along: Along::new(grid, level.width()),
                across: Plan::new(grid.exponent(), &turns(nodes), level.width()),
                nyquist: vec![Complex32::default(); nodes],
                scratch: Vec::new(),
            }))
        };
        let field = vec![Sixteen::ZERO; nodes * pitch(grid) / 16];
        Self { grid, level, field, method }
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> Grid {
        self.grid
    }

    /// The field: F_x + i·F_y of node (x, y), in kBT/R0, is element x·[`pitch`](Self::pitch) + y.
    ///
    /// Before anything is solved, and between the elements of a row and the next, it holds anything.
    #[must_use]
    pub fn field(&self) -> &[Complex32] {
        complex_of_sixteens(&self.field)
    }

    /// From a row of the field to the next, in elements: M or a little more.
    #[must_use]
    pub const fn pitch(&self) -> usize {
        pitch(self.grid)
    }

    /// Turns node masses, or with `signed` sums of strengths (M × M, unit 2⁻²⁰ discs), into the field, as
    /// [`meniscus_core::mesh::solve`] and [`meniscus_core::mesh::solve_strengths`] do, with the same bits.
    ///
    /// The influence table is that of [`meniscus_core::influence`], symmetric: its columns are read as its rows. The work
    /// is divided into as many `pieces` for rayon's current pool. With nodes or tables that are too short nothing is
    /// done.
    pub fn solve(&mut self, tables: &Tables<'_>, nodes: &[u32], signed: bool, pieces: usize) {
        let side = self.grid.nodes();
        let half = side / 2;
        let fits = nodes.len() >= side * side
            && tables.gradient.len() >= side
            && tables.influence.len() >= (half + 1) * (half + 1);
        if !fits {
            return;
        }
        match &mut self.method {
            Method::Core { lines } => {
                let field = complex_of_sixteens_mut(&mut self.field);
                let solve = if signed { mesh::solve_strengths } else { mesh::solve };
                solve(&AnySize, self.grid, tables, &nodes[..side * side], field, lines);
            }
            Method::Wide(wide) => {
                let nodes = &nodes[..side * side];
                wide.solve(self.grid, self.level, tables, nodes, signed, &mut self.field, pieces.max(1));
            }
        }
    }
}

/// From a row of the field to the next, in elements.
const fn pitch(grid: Grid) -> usize {
    if grid.nodes() < Along::SMALLEST { grid.nodes() } else { grid.nodes() + 16 }
}

impl Wide {
    /// Blocks of working memory of a piece: two tiles of rows; lines along y need less.
    const fn scratch_length(grid: Grid) -> usize {
        2 * grid.nodes()
    }

    #[allow(clippy::too_many_arguments, reason = "the whole of the solver's parts")]
    fn solve(
        &mut self,
        grid: Grid,
        level: Level,
        tables: &Tables<'_>,
        nodes: &[u32],
        signed: bool,
        field: &mut [Sixteen],
        pieces: usize,
    ) {
        let length = Self::scratch_length(grid);
        if self.scratch.len() < pieces * length {
            self.scratch.resize(pieces * length, Sixteen::ZERO);
        }
        let Self { along, across, nyquist, scratch } = self;
        let pitch = pitch(grid) / 16;
        let columns = columns::Columns { level, along, grid, pitch, signed };
        columns.transform(nodes, field, nyquist, scratch, pieces);
        rows::nyquist(grid, tables, nyquist);
        let rows = rows::Force { level, across, grid, tables, nyquist };
        rows.transform(Rows::new(field, GROUP * pitch), scratch, pieces);
        let lines = lines::Lines { level, along, grid, pitch };
        lines.transform(field, scratch, pieces);
    }
}
