//! The calls to this engine; nothing else in the comparison knows it.

use crate::batches::Work;
use crate::problem::{checked_nodes, mass, parameters};
use meniscus::configuration::Configuration;
use meniscus::engine::{Kind, Machinery};
use meniscus::simulation::Simulation;
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{LINES, Tables, solve};
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_wide::lanes::Level;
use meniscus_wide::mesh::Solver;
use std::error::Error;

/// Who can solve a mesh on this machine: the wide engine by its registers, the widest first, then the core.
pub fn solvers() -> impl Iterator<Item = &'static str> {
    Level::available().rev().map(Level::name).chain(["core"])
}

/// A mesh with masses on its nodes, and who solves it.
pub struct Mesh {
    grid: Grid,
    influence: Vec<f32>,
    gradient: Vec<f32>,
    nodes: Vec<u32>,
    solver: MeshSolver,
}

enum MeshSolver {
    Wide(Solver),
    Core { field: Vec<Complex32>, lines: Vec<Complex32> },
}

impl Mesh {
    pub fn new(solver: &str, side: usize) -> Result<Self, Box<dyn Error>> {
        let grid = Grid::new(side).ok_or("no such mesh")?;
        let zero = Complex32::new(0.0, 0.0);
        let solver = match Level::available().find(|level| level.name() == solver) {
            Some(level) => MeshSolver::Wide(Solver::new(grid, level)),
            None if solver == "core" => {
                MeshSolver::Core { field: vec![zero; side * side], lines: vec![zero; side * LINES] }
            }
            None => return Err(format!("no {solver} on this machine").into()),
        };
        let mut mesh = Self {
            grid,
            influence: vec![0.0; influence_length(side)],
            gradient: vec![0.0; side],
            nodes: (0..side * side).map(mass).collect(),
            solver,
        };
        fill_influence(&parameters(side), &mut mesh.influence);
        fill_gradient(&parameters(side), &mut mesh.gradient);
        Ok(mesh)
    }
}

impl Work for Mesh {
    fn once(&mut self) -> Result<(), Box<dyn Error>> {
        let tables = Tables { influence: &self.influence, gradient: &self.gradient };
        match &mut self.solver {
            MeshSolver::Wide(solver) => solver.solve(&tables, &self.nodes, false, 1),
            MeshSolver::Core { field, lines } => {
                solve(&AnySize, self.grid, &tables, &self.nodes, field, lines)
            }
        }
        Ok(())
    }

    fn values(&self) -> Vec<f32> {
        let side = self.grid.nodes();
        let (field, pitch) = match &self.solver {
            MeshSolver::Wide(solver) => (solver.field(), solver.pitch()),
            MeshSolver::Core { field, .. } => (&field[..], side),
        };
        let value = |node: usize| field[node / side * pitch + node % side];
        checked_nodes(side).map(value).flat_map(|force| [force.re, force.im]).collect()
    }
}

/// A run.
pub struct Run(Simulation);

impl Run {
    pub fn new(engine: &str, threads: usize, overrides: &[&str]) -> Result<Self, Box<dyn Error>> {
        let kinds = [Kind::Host, Kind::Core];
        let kind =
            kinds.into_iter().find(|kind| kind.word() == engine).ok_or("the engine is host or core")?;
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        let configuration = Configuration::from_preset("table-1", &overrides)?;
        Ok(Self(Simulation::with_machinery(configuration, Machinery { kind, threads })?))
    }

    pub fn describe(&self) -> String {
        self.0.configuration.scheme_line()
    }
}

impl Work for Run {
    fn once(&mut self) -> Result<(), Box<dyn Error>> {
        self.0.engine.step()?;
        Ok(())
    }
}
