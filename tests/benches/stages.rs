//! Every stage for Table I's discs in two states, uniform and collapsed: the wide stages with each kind of registers
//! beside the core's.
//!
//! `cargo bench -p meniscus-tests --bench stages` prints medians.
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot be set up should stop")]

mod states;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use meniscus_core::assignment::{deposit, gather};
use meniscus_core::cells::for_each_pair;
use meniscus_core::ermak::{Displacement, displace, largest_force};
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve};
use meniscus_core::near_part::{fill_table, table_length};
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::pair_force::{PairForce, near_cutoff};
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::torus::Fraction;
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_wide::assignment::{Field, MeshAssignment};
use meniscus_wide::lanes::{Level, bits_of_fractions};
use meniscus_wide::mesh::Solver;
use meniscus_wide::motion::Motion;
use meniscus_wide::neighbours::Neighbours;
use meniscus_wide::order::permute;
use meniscus_wide::pairs::{Discs, PairLoop, Strengths};
use states::{COUNT, SIDE, parameters, split, split_parameters, states};
use std::hint::black_box;

fn mesh_solve(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("mesh solve");
    for nodes_a_side in [256, 512, 1024] {
        let grid = Grid::new(nodes_a_side).unwrap();
        let parameters = Parameters { grid: nodes_a_side, ..parameters() };
        let nodes: Vec<u32> = (0..nodes_a_side * nodes_a_side)
            .map(|node| (node as u32).wrapping_mul(0x9E37_79B9) >> 12)
            .collect();
        let (mut influence, mut gradient) =
            (vec![0.0; influence_length(nodes_a_side)], vec![0.0; nodes_a_side]);
        fill_influence(&parameters, &mut influence);
        fill_gradient(&parameters, &mut gradient);
        let tables = Tables { influence: &influence, gradient: &gradient };
        let mut field = vec![Complex32::default(); nodes.len()];
        let mut lines = vec![Complex32::default(); nodes_a_side * 16];
        group.bench_function(BenchmarkId::new("core", nodes_a_side), |bencher| {
            bencher.iter(|| solve(&AnySize, grid, &tables, &nodes, black_box(&mut field), &mut lines));
        });
        for level in Level::available() {
            let mut solver = Solver::new(grid, level);
            group.bench_function(BenchmarkId::new(level.name(), nodes_a_side), |bencher| {
                bencher.iter(|| solver.solve(&tables, black_box(&nodes), false, 1));
            });
        }
    }
    group.finish();
}

fn assignment_stages(criterion: &mut Criterion) {
    let [(_, discs), _] = states();
    let (x, y) = split(&discs);
    let grid = Grid::new(256).unwrap();
    let mut nodes = vec![0; 256 * 256];
    let field = vec![Complex32::new(1.0, -1.0); 256 * 256];
    let (mut force_x, mut force_y) = (vec![0; COUNT], vec![0; COUNT]);
    for assignment in Assignment::ALL {
        let mut group = criterion.benchmark_group(format!("deposit {assignment:?}"));
        group.bench_function("core", |bencher| {
            bencher.iter(|| deposit(assignment, grid, &x, &y, black_box(&mut nodes)));
        });
        for level in Level::available() {
            let wide = MeshAssignment { level, pieces: 1, assignment, grid };
            group.bench_function(level.name(), |bencher| {
                bencher.iter(|| wide.deposit((&x, &y), black_box(&mut nodes)));
            });
        }
        group.finish();
        let mut group = criterion.benchmark_group(format!("gather {assignment:?}"));
        group.bench_function("core", |bencher| {
            bencher.iter(|| gather(assignment, grid, (&x, &y), &field, (&mut force_x, &mut force_y)));
        });
        for level in Level::available() {
            let wide = MeshAssignment { level, pieces: 1, assignment, grid };
            let field = Field { nodes: &field, pitch: 256 };
            group.bench_function(level.name(), |bencher| {
                bencher.iter(|| wide.gather((&x, &y), field, (&mut force_x, &mut force_y)));
            });
        }
        group.finish();
    }
}

fn pair_stages(criterion: &mut Criterion) {
    let repulsion = Parameters { capillary_strength: 0.0, ..parameters() };
    for (state, discs) in states() {
        for (name, parameters) in
            [("repulsion", repulsion), ("repulsion and near part", split_parameters(1e-3))]
        {
            let force = PairForce::new(&parameters);
            let mut table = vec![[0.0; 4]; table_length(near_cutoff(&parameters))];
            fill_table(parameters.splitting, parameters.capillary_length, &mut table);
            let (mut x, mut y) = split(&discs);
            let ids: Vec<u32> = (0..COUNT as u32).collect();
            let (mut force_x, mut force_y) = (vec![0; COUNT], vec![0; COUNT]);
            let (mut ends, mut order) = (vec![0; 256 * 256], vec![0; COUNT]);
            let mut group = criterion.benchmark_group(format!("pairs, {name}, {state}"));
            group.bench_function("core, search and forces", |bencher| {
                bencher.iter(|| {
                    for_each_pair(
                        (&x, &y),
                        force.reach(),
                        &mut ends,
                        &mut order,
                        |first, second, separation| {
                            let (along_x, along_y) = force
                                .of(separation, first < second, PairForce::EQUAL, &table)
                                .unwrap_or_default();
                            force_x[first] += along_x;
                            force_y[first] += along_y;
                            force_x[second] -= along_x;
                            force_y[second] -= along_y;
                        },
                    );
                });
            });
            for level in Level::available() {
                let mut neighbours = Neighbours::new(level, force.reach());
                let order = neighbours.arrange(bits_of_fractions(&x), bits_of_fractions(&y)).discs().to_vec();
                permute(&order, &mut x, &mut vec![Fraction::ZERO; COUNT]);
                permute(&order, &mut y, &mut vec![Fraction::ZERO; COUNT]);
                let (x, y) = (bits_of_fractions(&x), bits_of_fractions(&y));
                group.bench_function(BenchmarkId::new(level.name(), "new lists"), |bencher| {
                    bencher.iter(|| neighbours.rebuild(x, y, 1));
                });
                group.bench_function(BenchmarkId::new(level.name(), "are lists fresh"), |bencher| {
                    bencher.iter(|| neighbours.is_fresh(x, y, 1));
                });
                let pairs = PairLoop::new(level, &force, &table);
                let discs = Discs { ids: &ids, strengths: Strengths::Alike(PairForce::EQUAL) };
                group.bench_function(BenchmarkId::new(level.name(), "forces"), |bencher| {
                    bencher.iter(|| pairs.add(&neighbours, &discs, (&mut force_x, &mut force_y)));
                });
            }
            group.finish();
        }
    }
}

fn motion_stages(criterion: &mut Criterion) {
    let [(_, discs), _] = states();
    let (mut x, mut y) = split(&discs);
    let forces = vec![1 << 24; COUNT];
    let ids: Vec<u32> = (0..COUNT as u32).collect();
    let (mut along_x, mut along_y) = (vec![0; COUNT], vec![0; COUNT]);
    let (mut crossings_x, mut crossings_y) = (vec![0; COUNT], vec![0; COUNT]);
    let mut group = criterion.benchmark_group("largest force");
    group.bench_function("core", |bencher| bencher.iter(|| largest_force(black_box(&forces), &forces)));
    for level in Level::available() {
        let motion = Motion { level, pieces: 1 };
        group.bench_function(level.name(), |bencher| {
            bencher.iter(|| motion.largest_force(black_box(&forces), &forces));
        });
    }
    group.finish();
    for noise in [Noise::Uniform, Noise::Gaussian] {
        let kick = ThermalKick::new(noise, 0.001, StepKey::new(1, Purpose::Motion, 7));
        let units = (4_294_967_296.0 / SIDE) as f32;
        let step = Displacement { step_length: 0.001, units, kick };
        let mut group = criterion.benchmark_group(format!("noise {noise:?} and move"));
        group.bench_function("core", |bencher| {
            bencher.iter(|| {
                for (id, (x, y)) in (0..).zip(x.iter_mut().zip(&mut y)) {
                    let (along_x, along_y) = step.of(id, (1 << 24, 1 << 24)).unwrap();
                    displace(x, &mut 0, along_x);
                    displace(y, &mut 0, along_y);
                }
            });
        });
        for level in Level::available() {
            let motion = Motion { level, pieces: 1 };
            group.bench_function(level.name(), |bencher| {
                bencher.iter(|| {
                    let targets = (&mut *along_x, &mut *along_y);
                    motion.displacements(&step, &ids, (&forces, &forces), targets).unwrap();
                    motion.displace(&mut x, &mut crossings_x, &along_x);
                    motion.displace(&mut y, &mut crossings_y, &along_y);
                });
            });
        }
        group.finish();
    }
}

criterion_group!(stages, mesh_solve, assignment_stages, pair_stages, motion_stages);
criterion_main!(stages);
