//! Golden trajectories: the same bits as on the day they were minted.
//!
//! A change of a golden is an event. Where the physics or the order of operations was changed on purpose, mint anew
//! with a reason, and give the same reason in CHANGELOG.md:
//!
//! `MENISCUS_MINT_GOLDENS="REASON" cargo test --package meniscus-tests --test goldens`

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus::configuration::{Assignment, Configuration, Gradient, Influence, Method, Noise};
use meniscus::engine::{Kind, Machinery};
use meniscus::golden::Golden;
use meniscus::simulation::Simulation;
use meniscus::verification::compare;
use meniscus_core::fields::FieldForce;
use std::path::{Path, PathBuf};

const MINT: &str = "MENISCUS_MINT_GOLDENS";

fn golden_files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens");
    let entries = std::fs::read_dir(&folder).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn configuration_of(golden: &Golden) -> Configuration {
    Configuration::from_text("golden", &golden.configuration, &[]).unwrap()
}

const CORE: Machinery = Machinery { kind: Kind::Core, threads: 1 };

/// Each golden is compared with the core and with the host's engine, in three threads where these pay.
const MACHINERY: [Machinery; 2] = [CORE, Machinery { kind: Kind::Host, threads: 3 }];

fn simulation_of(golden: &Golden, machinery: Machinery) -> Simulation {
    Simulation::with_machinery(configuration_of(golden), machinery).unwrap()
}

fn mint(path: &Path, golden: &Golden, reason: &str) {
    let mut simulation = simulation_of(golden, CORE);
    let mut minted = Golden::new(simulation.configuration.to_toml(), reason);
    for record in &golden.records {
        while simulation.engine.clock().step < record.step {
            simulation.engine.step().unwrap();
        }
        minted.record(simulation.engine.state().digest_by_field());
    }
    minted.write(path).unwrap();
}

#[test]
fn trajectories_have_the_bits_they_were_minted_with() {
    let mint_reason = std::env::var(MINT).ok();
    let mut differences = Vec::new();
    for path in golden_files() {
        let golden = Golden::read(&path).unwrap();
        assert!(golden.records.len() > 1, "{}", path.display());
        if let Some(reason) = &mint_reason {
            assert!(!reason.trim().is_empty(), "{MINT} must hold the reason");
            mint(&path, &golden, reason);
            continue;
        }
        for machinery in MACHINERY {
            let mut simulation = simulation_of(&golden, machinery);
            let difference = compare(&golden, &mut simulation.engine, |_| ()).unwrap();
            let told =
                difference.map(|difference| format!("{}, {machinery:?}: {difference}", path.display()));
            differences.extend(told);
        }
    }
    assert!(
        differences.is_empty(),
        "{}\nmint with {MINT}=\"REASON\" only if this change is meant, and say why in CHANGELOG.md",
        differences.join("\n")
    );
}

#[test]
fn goldens_cover_every_choice_of_scheme() {
    let all: Vec<Configuration> =
        golden_files().iter().map(|path| configuration_of(&Golden::read(path).unwrap())).collect();
    let has = |what: &dyn Fn(&Configuration) -> bool| all.iter().any(what);
    assert!(all.len() >= 6);
    for assignment in [Assignment::CloudInCell, Assignment::TriangularShapedCloud] {
        for influence in [Influence::Paper, Influence::Continuum] {
            assert!(has(&|c| c.mesh.assignment == assignment && c.mesh.influence == influence));
        }
    }
    for assignment in Assignment::ALL {
        assert!(has(&|c| c.mesh.assignment == assignment && c.force.method() == Method::P3m));
    }
    for method in [Method::ParticleMesh, Method::P3m] {
        let of_method = |c: &Configuration| c.force.method() == method;
        assert!(has(&|c| of_method(c) && c.to_toml().contains("strengths = [1.0, -")));
    }
    assert!(has(&|c| c.mesh_refresh > 0.0 && c.force.method() == Method::P3m));
    let has_field = |c: &Configuration| !FieldForce::new(&c.parameters().fields, c.system.side).is_zero();
    assert!(has(&has_field));
    assert!(has(&|c| c.system.capillary_length == f64::INFINITY && c.force.method() == Method::P3m));
    for gradient in [Gradient::Spectral, Gradient::Difference2, Gradient::Difference4] {
        assert!(has(&|c| c.mesh.gradient == gradient));
    }
    for noise in [Noise::Uniform, Noise::Gaussian, Noise::None] {
        assert!(has(&|c| c.motion.noise == noise));
    }
    for grid in [16, 64, 512] {
        assert!(has(&|c| c.mesh.grid == grid));
    }
}

#[test]
fn a_flipped_bit_is_found_and_its_field_named() {
    let path = golden_files().into_iter().find(|path| path.to_string_lossy().contains("16")).unwrap();
    let mut golden = Golden::read(&path).unwrap();
    let last = golden.records.last_mut().unwrap();
    last.y = last.y.replace(|digit: char| digit.is_ascii_hexdigit(), "0");
    let step = last.step;
    let mut simulation = simulation_of(&golden, CORE);
    let difference = compare(&golden, &mut simulation.engine, |_| ()).unwrap().unwrap();
    assert!(difference.to_string().starts_with(&format!("step {step}: y differs")), "{difference}");
}
