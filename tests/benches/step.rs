//! The whole step of Table I's discs in two states, uniform and collapsed: the host's engine beside the core.
//!
//! `cargo bench -p meniscus-tests --bench step` prints medians.
#![expect(clippy::unwrap_used, reason = "a benchmark that cannot be set up should stop")]

mod states;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use meniscus::engine::{Engine, Kind, Machinery};
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::{Assignment, Parameters};
use states::{parameters, split_parameters, states};

fn schemes() -> Vec<(String, Parameters)> {
    let paper = [Assignment::CloudInCell, Assignment::TriangularShapedCloud]
        .map(|assignment| (format!("paper {assignment:?}"), Parameters { assignment, ..parameters() }));
    let split =
        [1e-3, 1e-4, 1e-5].map(|accuracy| (format!("split {accuracy:e}"), split_parameters(accuracy)));
    let reused = Parameters { mesh_refresh: 0.3, ..split_parameters(1e-3) };
    let alone = Parameters { capillary_strength: 0.0, ..parameters() };
    let others = [("split 1e-3, mesh_refresh 0.3", reused), ("repulsion and moving alone", alone)];
    let others = others.map(|(name, parameters)| (name.to_owned(), parameters));
    paper.into_iter().chain(split).chain(others).collect()
}

fn whole_step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("step");
    for (state, discs) in states() {
        for (scheme, parameters) in schemes() {
            for kind in [Kind::Core, Kind::Host] {
                let machinery = Machinery { kind, threads: 1 };
                let discs = (0..).zip(discs.iter().copied());
                let mut engine = Engine::with_machinery(machinery, &parameters, Clock::START, discs).unwrap();
                let id = BenchmarkId::new(format!("{state}, {scheme}"), kind.word());
                group.bench_function(id, |bencher| bencher.iter(|| engine.step().unwrap()));
            }
        }
    }
    group.finish();
}

criterion_group!(step, whole_step);
criterion_main!(step);
