//! The host's engine and the scalar core: the same state, whichever does the steps.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::configuration::{Configuration, PRESETS};

use meniscus::engine::{Engine, Kind, Machinery};
use meniscus::simulation::Simulation;
use meniscus_tests::long_tests;

const CORE: Machinery = Machinery { kind: Kind::Core, threads: 1 };

fn simulation(preset: &str, overrides: &[String], machinery: Machinery) -> Simulation {
    let configuration = Configuration::from_preset(preset, overrides).unwrap();
    Simulation::with_machinery(configuration, machinery).unwrap()
}

/// Steps both; panics at the first step after which they differ.
fn compare(what: &str, expected: &mut Engine, found: &mut Engine, steps: u64) {
    for step in 1..=steps {
        let [one, other] = [&mut *expected, &mut *found].map(|engine| engine.step().unwrap());
        assert_eq!(one, other, "{what}, step {step}");
        let [one, other] = [&*expected, &*found].map(|engine| engine.state().digest());
        assert_eq!(one, other, "{what}, step {step}");
    }
    let [one, other] = [&*expected, &*found].map(Engine::crossings);
    assert_eq!(one, other, "{what}: crossings");
    let [one, other] = [expected, found].map(|engine| engine.forces().unwrap());
    assert_eq!(one, other, "{what}: forces");
}

/// A thousand steps in the long tests.
fn steps() -> u64 {
    if long_tests() { 1000 } else { 8 }
}

#[test]
fn every_preset_gives_the_same_states() {
    for preset in PRESETS {
        let mut core = simulation(preset.name, &[], CORE);
        let mut host = simulation(preset.name, &[], Machinery { kind: Kind::Host, threads: 2 });
        assert_eq!((core.engine.kind(), host.engine.kind()), (Kind::Core, Kind::Host));
        compare(preset.name, &mut core.engine, &mut host.engine, steps());
    }
}

#[test]
fn threads_and_storage_orders_cannot_be_seen_in_a_large_run() {
    let large = ["system.particles=20000", "system.box=1400", "mesh.grid=512"].map(str::to_owned);
    let mut core = simulation("table-1", &large, CORE);
    let discs: Vec<_> = core.engine.discs().into_iter().rev().collect();
    let parameters = core.configuration.parameters();
    let mut engines: Vec<Engine> = [1, 2, 3, 4, 7, 16]
        .map(|threads| {
            let machinery = Machinery { kind: Kind::Host, threads };
            Engine::with_machinery(machinery, &parameters, core.engine.clock(), discs.iter().copied())
                .unwrap()
        })
        .into();
    for (engine, threads) in engines.iter().zip([1, 2, 3, 4, 7, 16]) {
        assert_eq!(engine.threads(), threads);
    }
    for step in 1..=4 {
        core.engine.step().unwrap();
        let expected = core.engine.state().digest();
        for engine in &mut engines {
            engine.step().unwrap();
            assert_eq!(engine.state().digest(), expected, "{} threads, step {step}", engine.threads());
        }
    }
}

#[test]
fn held_mesh_forces_are_the_same_for_every_machinery() {
    let held = ["force.mesh_refresh=0.4", "system.particles=1000", "system.box=400"].map(str::to_owned);
    let mut core = simulation("table-1", &held, CORE);
    let (parameters, discs) = (core.configuration.parameters(), core.engine.discs());
    let mut engines: Vec<Engine> = [1, 2, 3, 7]
        .map(|threads| {
            let machinery = Machinery { kind: Kind::Host, threads };
            let discs = discs.iter().rev().copied();
            Engine::with_machinery(machinery, &parameters, core.engine.clock(), discs).unwrap()
        })
        .into();
    let mut refreshed = 0;
    for step in 1..=4 * steps() {
        let expected = core.engine.step().unwrap();
        refreshed += u64::from(expected.refreshed);
        let (digest, held) = (core.engine.state().digest(), core.engine.held());
        for engine in &mut engines {
            let what = format!("{} threads, step {step}", engine.threads());
            assert_eq!(engine.step().unwrap(), expected, "{what}");
            assert_eq!(engine.held(), held, "{what}");
            assert_eq!(engine.state().digest(), digest, "{what}");
        }
    }
    assert!(refreshed > 1 && refreshed < 4 * steps(), "computed anew {refreshed} times");
}
