//! The golden cases of `tests/targets` on this machine, as it is built here: the same lines as on every other.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::observables::clusters::Clusters;
use meniscus::observables::neighbours::squared_distance;
use meniscus_cases::{CASES, Case, Engine64, ROOM, discs, longest_table, run};
use meniscus_core::dynamics::Disc;
use meniscus_core::engine::Engine;
use meniscus_core::fields::Fields;
use meniscus_core::near_part::LARGEST_TABLE;
use meniscus_core::parameters::{Assignment, Method};
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::torus::{Position, Torus, UNITS};
use std::collections::BTreeSet;
use std::sync::Mutex;

const GOLDENS: &str = include_str!("../targets/goldens.txt");

/// How many lines a case has: seven stages, and with them the near part's table and the external fields, the step and the
/// last state.
fn lines_of(case: &Case) -> usize {
    let parameters = &case.parameters;
    let with_table = parameters.method == Method::P3m && parameters.capillary_strength > 0.0;
    9 + usize::from(with_table) + usize::from(parameters.fields != Fields::NONE)
}

// With as short a table of the near part as the microcontrollers have.
static ENGINE_16: Mutex<Engine<{ ROOM[0].0 }, { ROOM[0].1 }, { longest_table(16) }>> =
    Mutex::new(Engine::new());
static ENGINE_64: Mutex<Engine64> = Mutex::new(Engine64::new());
static ENGINE_128: Mutex<Engine<{ ROOM[2].0 }, { ROOM[2].1 }>> = Mutex::new(Engine::new());
static ENGINE_512: Mutex<Engine<{ ROOM[3].0 }, { ROOM[3].1 }>> = Mutex::new(Engine::new());

/// The golden lines of a case.
fn golden(case: &Case) -> Vec<&'static str> {
    GOLDENS.lines().filter(|line| line.split(' ').next() == Some(case.name)).collect()
}

fn cases_of(grid: usize) -> impl Iterator<Item = &'static Case> {
    CASES.iter().filter(move |case| case.parameters.grid == grid)
}

/// Runs all cases of a mesh; tells how often each of them crossed the border.
fn have_the_golden_lines<const M: usize, const N: usize, const SEGMENTS: usize, const HELD: usize>(
    engine: &Mutex<Engine<M, N, SEGMENTS, HELD>>,
) -> Vec<u32> {
    let mut engine = engine.lock().unwrap();
    let run_one = |case: &Case| {
        let mut found = String::new();
        run(case, &mut engine, &mut found).unwrap();
        for (expected, found) in golden(case).iter().zip(found.lines()) {
            assert_eq!(
                found, *expected,
                "\nif this is meant, say why in CHANGELOG.md and mint anew: tests/targets/run --mint 'REASON'"
            );
        }
        let expected = lines_of(case);
        assert_eq!((golden(case).len(), found.lines().count()), (expected, expected), "{}", case.name);
        let crossings = (0..engine.count() as u32).filter_map(|id| engine.crossings(id));
        crossings.map(|(x, y)| x.unsigned_abs() + y.unsigned_abs()).sum()
    };
    cases_of(M).map(run_one).collect()
}

#[test]
fn cases_of_16_nodes_have_the_golden_lines_and_cross_the_border() {
    assert!(have_the_golden_lines(&ENGINE_16).iter().all(|&crossings| crossings > 0));
}

#[test]
fn cases_of_64_nodes_have_the_golden_lines_and_cross_the_border() {
    assert!(have_the_golden_lines(&ENGINE_64).iter().all(|&crossings| crossings > 0));
}

#[test]
fn cases_of_128_nodes_have_the_golden_lines() {
    have_the_golden_lines(&ENGINE_128);
}

#[test]
#[cfg_attr(
    debug_assertions,
    ignore = "slow where nothing is optimised; tests/targets/run has it in debug too"
)]
fn cases_of_512_nodes_have_the_golden_lines() {
    have_the_golden_lines(&ENGINE_512);
}

#[test]
fn the_golden_file_holds_the_cases_and_nothing_else_and_says_why() {
    let names =
        GOLDENS.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split(' ').next());
    assert_eq!(names.collect::<BTreeSet<_>>(), CASES.iter().map(|case| case.name).collect());
    assert!(GOLDENS.lines().any(|line| line.starts_with("# Minted by Meniscus ")));
}

#[test]
fn the_cases_have_every_assignment_of_the_split_force_and_unequal_strengths_in_a_trap() {
    assert!(longest_table(16) < LARGEST_TABLE / 4);
    let split = || CASES.iter().filter(|case| case.parameters.method == Method::P3m);
    for assignment in Assignment::ALL {
        assert!(split().any(|case| case.parameters.assignment == assignment), "{assignment:?}");
    }
    for grid in ROOM.map(|(grid, _)| grid) {
        assert!(split().any(|case| case.parameters.grid == grid), "{grid} nodes");
    }
    assert!(split().any(|case| case.parameters.capillary_length == f64::INFINITY));
    for method in [Method::ParticleMesh, Method::P3m] {
        let mut cases = CASES.iter().filter(|case| case.parameters.method == method);
        assert!(cases.any(|case| case.parameters.fields != Fields::NONE && !case.has_equal_strengths()));
    }
}

#[test]
fn the_case_of_held_mesh_forces_computes_them_anew_now_and_then() {
    let mut held = CASES.iter().filter(|case| case.parameters.mesh_refresh > 0.0);
    let (case, mut engine) = (held.next().unwrap(), Box::new(Engine64::new()));
    assert!(held.next().is_none() && !case.has_equal_strengths());
    let strengths = case.strengths.iter().cycle();
    let start = discs(case.start).unwrap().zip(strengths);
    let start = start.map(|((id, position), &strength)| Disc { id, position, strength });
    engine.init(&case.parameters, start).unwrap();
    let refreshed = (0..case.steps).filter(|_| engine.step().unwrap().refreshed).count();
    assert!(refreshed >= 3 && refreshed <= case.steps as usize / 3, "{refreshed} of {}", case.steps);
}

/// The first state of a case.
fn start(case: &Case) -> (Torus, Vec<Position>) {
    let positions = discs(case.start).unwrap().map(|(_, position)| position).collect();
    (Torus::new(case.parameters.side).unwrap(), positions)
}

#[test]
fn crowded_and_clustered_starts_have_contacts() {
    for case in CASES.iter().filter(|case| case.parameters.grid <= 64) {
        let (torus, positions) = start(case);
        let reach = CUTOFF / torus.side() * UNITS;
        let pairs = positions.iter().enumerate().flat_map(|(index, &first)| {
            positions[..index].iter().map(move |&second| squared_distance(first, second) as f64)
        });
        let contacts = pairs.filter(|&squared| squared < reach * reach).count();
        assert!(contacts >= positions.len() / 4, "{}: {contacts} contacts", case.name);
    }
}

#[test]
fn clustered_starts_have_large_clusters() {
    for case in cases_of(64) {
        let (torus, positions) = start(case);
        let largest = Clusters::find(&torus, &positions).largest();
        assert!(largest >= 10, "{}: {largest} discs", case.name);
    }
}
