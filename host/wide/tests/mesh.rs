//! The wide mesh solver has the bits of the core's, for every mesh, width and number of pieces.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{LINES, Tables, solve, solve_strengths};
use meniscus_core::parameters::{Gradient, Influence, Parameters};
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_wide::lanes::Level;
use meniscus_wide::mesh::Solver;

/// The influence function and the gradient of a mesh.
struct Operator {
    grid: Grid,
    influence: Vec<f32>,
    gradient: Vec<f32>,
}

impl Operator {
    fn new(nodes: usize, influence: Influence, gradient: Gradient) -> Self {
        let parameters = Parameters {
            grid: nodes,
            side: 1.3 * nodes as f64,
            capillary_length: 20.0,
            splitting: 2.0,
            influence,
            gradient,
            ..Parameters::default()
        };
        let mut influence = vec![0.0; influence_length(nodes)];
        let mut gradient = vec![0.0; nodes];
        fill_influence(&parameters, &mut influence);
        fill_gradient(&parameters, &mut gradient);
        Self { grid: Grid::new(nodes).unwrap(), influence, gradient }
    }

    fn tables(&self) -> Tables<'_> {
        Tables { influence: &self.influence, gradient: &self.gradient }
    }

    /// The bits of the field as the core gives it, real and imaginary part of a node together.
    fn expected(&self, nodes: &[u32], signed: bool) -> Vec<u64> {
        let side = self.grid.nodes();
        let mut field = vec![Complex32::new(0.0, 0.0); side * side];
        let mut lines = vec![Complex32::new(0.0, 0.0); LINES * side];
        let solve = if signed { solve_strengths } else { solve };
        solve(&AnySize, self.grid, &self.tables(), nodes, &mut field, &mut lines);
        field.iter().copied().map(bits).collect()
    }

    /// Compares what a solver gives; whatever is left in it of other masses cannot matter.
    fn compare(
        &self,
        solver: &mut Solver,
        level: Level,
        nodes: &[u32],
        signed: bool,
        pieces: usize,
        expected: &[u64],
    ) {
        let side = self.grid.nodes();
        solver.solve(&self.tables(), nodes, signed, pieces);
        let rows = solver.field().chunks_exact(solver.pitch());
        for (x, (row, expected)) in rows.zip(expected.chunks_exact(side)).enumerate() {
            for (y, (&value, &expected)) in row.iter().zip(expected).enumerate() {
                assert_eq!(
                    bits(value),
                    expected,
                    "node ({x}, {y}) of {side}, {}, {pieces} pieces, signed: {signed}",
                    level.name()
                );
            }
        }
    }
}

fn bits(value: Complex32) -> u64 {
    u64::from(value.re.to_bits()) << 32 | u64::from(value.im.to_bits())
}

/// Node masses: of `of` nodes one is not empty, and that has any of `range` bits, or with `signed` either sign.
fn masses(side: usize, of: u64, range: u32, signed: bool) -> Vec<u32> {
    let mut state = side as u64 ^ of << 32;
    let mut bits = || {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        (state >> 32) ^ state >> 17
    };
    (0..side * side)
        .map(|_| {
            let mass = (bits() as u32) >> (32 - range);
            let negative = signed && bits() & 1 == 1;
            if bits() % of > 0 {
                0
            } else if negative {
                mass.wrapping_neg()
            } else {
                mass
            }
        })
        .collect()
}

/// Node masses that fill all of the mesh with any bits, few discs, and strengths of either sign.
const KINDS: [(bool, u64, u32); 3] = [(false, 1, 32), (false, 50, 20), (true, 3, 28)];

fn compare_at(nodes: usize, kinds: &[(bool, u64, u32)], levels: &[Level], pieces: &[usize]) {
    let operator = Operator::new(nodes, Influence::Continuum, Gradient::Spectral);
    for &(signed, of, range) in kinds {
        let masses = masses(nodes, of, range, signed);
        let expected = operator.expected(&masses, signed);
        for &level in levels {
            let mut solver = Solver::new(operator.grid, level);
            for &pieces in pieces {
                operator.compare(&mut solver, level, &masses, signed, pieces, &expected);
            }
        }
    }
}

fn levels() -> Vec<Level> {
    Level::available().collect()
}

#[test]
fn small_meshes_are_those_of_the_core() {
    for nodes in [16, 32, 64, 128] {
        compare_at(nodes, &KINDS, &[Level::best()], &[1, 2]);
    }
}

#[test]
fn a_mesh_is_that_of_the_core_with_lanes_of_any_width() {
    compare_at(256, &KINDS, &levels(), &[1]);
}

#[test]
fn any_number_of_pieces_gives_the_field_of_the_core() {
    compare_at(256, &KINDS[..1], &[Level::best()], &[1, 2, 3, 4, 7, 16, 40]);
}

#[test]
fn a_larger_mesh_is_that_of_the_core() {
    compare_at(512, &KINDS[..1], &[Level::best()], &[1]);
}

#[test]
fn meshes_of_all_sizes_are_those_of_the_core() {
    if std::env::var_os("MENISCUS_LONG_TESTS").is_none_or(|value| value != "1") {
        return;
    }
    for nodes in [16, 32, 64, 128, 256, 512, 1024] {
        compare_at(nodes, &KINDS, &levels(), &[1, 2, 3, 4, 7, 16]);
    }
    for nodes in [2048, 4096] {
        compare_at(nodes, &KINDS[..1], &levels(), &[1, 7]);
    }
}

#[test]
fn every_influence_function_and_gradient_has_the_field_of_the_core() {
    for influence in [Influence::Paper, Influence::Continuum, Influence::Optimal] {
        for gradient in [Gradient::Spectral, Gradient::Difference2, Gradient::Difference4] {
            let operator = Operator::new(256, influence, gradient);
            let masses = masses(256, 7, 22, false);
            let expected = operator.expected(&masses, false);
            let level = Level::best();
            operator.compare(&mut Solver::new(operator.grid, level), level, &masses, false, 1, &expected);
        }
    }
}

#[test]
fn influence_tables_are_symmetric() {
    // The solver reads a column of the table where it needs a row.
    for influence in [Influence::Paper, Influence::Continuum, Influence::Optimal] {
        let operator = Operator::new(64, influence, Gradient::Spectral);
        for (row, column) in (0..33).flat_map(|row| (0..row).map(move |column| (row, column))) {
            let (value, mirror) =
                (operator.influence[row * 33 + column], operator.influence[column * 33 + row]);
            assert_eq!(value.to_bits(), mirror.to_bits(), "{influence:?}, ({row}, {column})");
        }
    }
}

#[test]
fn an_empty_mesh_exerts_no_force() {
    let operator = Operator::new(256, Influence::Continuum, Gradient::Spectral);
    let nodes = vec![0; 256 * 256];
    let expected = operator.expected(&nodes, false);
    for level in Level::available() {
        operator.compare(&mut Solver::new(operator.grid, level), level, &nodes, false, 1, &expected);
    }
}

#[test]
fn with_too_few_nodes_or_too_short_tables_nothing_is_done() {
    let operator = Operator::new(256, Influence::Continuum, Gradient::Spectral);
    let mut solver = Solver::new(operator.grid, Level::best());
    let nodes = vec![1; 256 * 256];
    let short = Tables { influence: &operator.influence[1..], gradient: &operator.gradient };
    solver.solve(&short, &nodes, false, 1);
    solver.solve(&operator.tables(), &nodes[1..], false, 1);
    assert!(solver.field().iter().all(|value| bits(*value) == 0));
}
