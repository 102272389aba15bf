//! One benchmark a stage and one for the whole step, for Table I's discs in two states: uniform and collapsed.
//!
//! `cargo bench -p meniscus-tests` prints medians.
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot be set up should stop")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use meniscus::accuracy::{Given, System, choose};
use meniscus::engine::Engine;
use meniscus_core::assignment::{deposit, gather};
use meniscus_core::cells::for_each_pair;
use meniscus_core::dynamics::Clock;
use meniscus_core::ermak::{Displacement, displace, largest_force};
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve};
use meniscus_core::near_part::{fill_table, table_length};
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::pair_force::PairForce;
use meniscus_core::parameters::{Assignment, Influence, Method, Noise, Parameters};
use meniscus_core::torus::{Fraction, Position, Torus};
use meniscus_core::transform::{AnySize, Complex32};
use std::hint::black_box;

const COUNT: usize = 2500;
const SIDE: f64 = 500.0;
const GRID: usize = 512;

fn grid() -> Grid {
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

fn states() -> [(&'static str, Vec<Position>); 2] {
    [("uniform", uniform()), ("collapsed", collapsed())]
}

/// The paper's scheme on its mesh.
fn parameters() -> Parameters {
    Parameters { side: SIDE, grid: GRID, ..Parameters::PAPER }
}

/// The split force, as it is chosen for an accuracy.
fn split_parameters(accuracy: f64) -> Parameters {
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

fn split(discs: &[Position]) -> (Vec<Fraction>, Vec<Fraction>) {
    discs.iter().map(|disc| (disc.x, disc.y)).unzip()
}

fn whole_step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    for (name, discs) in states() {
        for assignment in [Assignment::CloudInCell, Assignment::TriangularShapedCloud] {
            let parameters = Parameters { assignment, ..parameters() };
            let mut engine = Engine::new(&parameters, Clock::START, &discs).unwrap();
            let id = BenchmarkId::new(name, format!("paper {assignment:?}"));
            group.bench_function(id, |bencher| bencher.iter(|| engine.step().unwrap()));
        }
        for accuracy in [1e-3, 1e-4, 1e-5] {
            let mut engine = Engine::new(&split_parameters(accuracy), Clock::START, &discs).unwrap();
            let id = BenchmarkId::new(name, format!("split {accuracy:e}"));
            group.bench_function(id, |bencher| bencher.iter(|| engine.step().unwrap()));
        }
        let parameters = Parameters { capillary_strength: 0.0, ..parameters() };
        let mut engine = Engine::new(&parameters, Clock::START, &discs).unwrap();
        let id = BenchmarkId::new(name, "repulsion and moving alone");
        group.bench_function(id, |bencher| bencher.iter(|| engine.step().unwrap()));
    }
    group.finish();
}

fn mesh_stages(criterion: &mut Criterion) {
    let (x, y) = split(&uniform());
    let zero = Complex32::new(0.0, 0.0);
    let mut nodes = vec![0; GRID * GRID];
    let mut field = vec![zero; GRID * GRID];
    let mut lines = vec![zero; GRID * 16];
    let (mut influence, mut gradient) = (vec![0.0; influence_length(GRID)], vec![0.0; GRID]);
    fill_influence(&parameters(), &mut influence);
    fill_gradient(&parameters(), &mut gradient);
    let tables = Tables { influence: &influence, gradient: &gradient };
    let (mut force_x, mut force_y) = (vec![0; COUNT], vec![0; COUNT]);
    for assignment in Assignment::ALL {
        criterion.bench_function(&format!("deposit {assignment:?}"), |bencher| {
            bencher.iter(|| deposit(assignment, grid(), &x, &y, black_box(&mut nodes)));
        });
        criterion.bench_function(&format!("gather {assignment:?}"), |bencher| {
            bencher.iter(|| gather(assignment, grid(), (&x, &y), &field, (&mut force_x, &mut force_y)));
        });
    }
    criterion.bench_function("mesh solve", |bencher| {
        bencher.iter(|| solve(&AnySize, grid(), &tables, &nodes, black_box(&mut field), &mut lines));
    });
}

fn particle_stages(criterion: &mut Criterion) {
    let repulsion = PairForce::repulsion(SIDE);
    for (name, discs) in states() {
        let (mut x, mut y) = split(&discs);
        let (mut heads, mut next) = (vec![0; GRID * GRID], vec![0; COUNT]);
        criterion.bench_function(&format!("pairs and repulsion, {name}"), |bencher| {
            bencher.iter(|| {
                let mut sum = 0_i64;
                for_each_pair((&x, &y), repulsion.reach(), &mut heads, &mut next, |_, _, separation| {
                    let (along_x, _) =
                        repulsion.of(separation, true, PairForce::EQUAL, &[]).unwrap_or_default();
                    sum = sum.wrapping_add(along_x);
                });
                sum
            });
        });
        let split = split_parameters(1e-3);
        let pair_force = PairForce::new(&split);
        let mut table = vec![[0.0; 4]; table_length(split.cutoff)];
        fill_table(split.splitting, split.capillary_length, &mut table);
        criterion.bench_function(&format!("pairs, repulsion and near part, {name}"), |bencher| {
            bencher.iter(|| {
                let mut sum = 0_i64;
                for_each_pair((&x, &y), pair_force.reach(), &mut heads, &mut next, |_, _, separation| {
                    let force = pair_force.of(separation, true, PairForce::EQUAL, &table);
                    sum = sum.wrapping_add(force.unwrap_or_default().0);
                });
                sum
            });
        });
        let forces = vec![1 << 24; COUNT];
        criterion.bench_function(&format!("largest force, {name}"), |bencher| {
            bencher.iter(|| largest_force(black_box(&forces), &forces));
        });
        for noise in [Noise::Uniform, Noise::Gaussian] {
            criterion.bench_function(&format!("noise {noise:?} and move, {name}"), |bencher| {
                bencher.iter(|| {
                    let kick = ThermalKick::new(noise, 0.001, StepKey::new(1, Purpose::Motion, 7));
                    let displacement = Displacement { step_length: 0.001, units: 8.6e6, kick };
                    for (id, (x, y)) in (0..).zip(x.iter_mut().zip(&mut y)) {
                        let (along_x, along_y) = displacement.of(id, (1 << 24, 1 << 24)).unwrap();
                        displace(x, &mut 0, along_x);
                        displace(y, &mut 0, along_y);
                    }
                });
            });
        }
    }
}

criterion_group!(stages, whole_step, mesh_stages, particle_stages);
criterion_main!(stages);
