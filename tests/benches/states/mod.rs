//! Table I's discs in two states, and the schemes that are compared.
#![allow(dead_code, reason = "each benchmark takes what it needs")]

use meniscus::accuracy::{Given, System, choose};
use meniscus_core::grid::Grid;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::parameters::{Influence, Method, Parameters};
use meniscus_core::torus::{Fraction, Position, Torus};

pub const COUNT: usize = 2500;
pub const SIDE: f64 = 500.0;
pub const GRID: usize = 512;

pub fn grid() -> Grid {
    Grid::new(GRID).unwrap()
}

/// Discs on a square lattice, 10 R0 apart, each shifted at random by less than 3 R0.
fn uniform() -> Vec<Position> {
    let key = StepKey::new(1, Purpose::Start, 0);
    let shift = |bits: u64| (bits & 0xFFFF) as f64 * (3.0 / 65536.0);
    place(|id| {
        let bits = key.bits(id as u64);
        ((id % 50) as f64 * 10.0 + shift(bits), (id / 50) as f64 * 10.0 + shift(bits >> 32))
    })
}

/// Discs on a hexagonal lattice 2.1 R0 apart: one dense cluster.
fn collapsed() -> Vec<Position> {
    place(|id| {
        let (column, row) = ((id % 50) as f64, (id / 50) as f64);
        (150.0 + 2.1 * (column + 0.5 * (row % 2.0)), 150.0 + 1.82 * row)
    })
}

fn place(at: impl Fn(usize) -> (f64, f64)) -> Vec<Position> {
    let torus = Torus::new(SIDE).unwrap();
    let position = |(x, y)| Position { x: torus.wrapped_fraction(x), y: torus.wrapped_fraction(y) };
    (0..COUNT).map(|id| position(at(id))).collect()
}

pub fn states() -> [(&'static str, Vec<Position>); 2] {
    [("uniform", uniform()), ("collapsed", collapsed())]
}

/// The paper's scheme on its mesh.
pub fn parameters() -> Parameters {
    Parameters { side: SIDE, grid: GRID, ..Parameters::PAPER }
}

/// The split force, as it is chosen for an accuracy.
pub fn split_parameters(accuracy: f64) -> Parameters {
    let system = System {
        side: SIDE,
        particles: COUNT,
        capillary_strength: parameters().capillary_strength,
        capillary_length: parameters().capillary_length,
        mean_square_strength: 1.0,
    };
    let scheme = choose(&system, accuracy, &Given::default()).unwrap().scheme;
    Parameters {
        method: Method::P3m,
        influence: Influence::Optimal,
        grid: scheme.grid,
        assignment: scheme.assignment,
        splitting: scheme.splitting,
        cutoff: scheme.cutoff,
        ..parameters()
    }
}

/// Both coordinates.
pub fn split(discs: &[Position]) -> (Vec<Fraction>, Vec<Fraction>) {
    discs.iter().map(|disc| (disc.x, disc.y)).unzip()
}
