//! The potential energy against Ewald sums, image sums and closed forms, and against the forces it belongs to.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::TAU;
use meniscus::configuration::{Configuration, System};
use meniscus::engine::Engine;
use meniscus::observables::energy::{Energies, PotentialEnergy};
use meniscus::run::{GoldenRequest, Outcome, Run, Stop};
use meniscus::simulation::Simulation;
use meniscus_core::assignment::DISC;
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::{Gradient, Influence, Parameters};
use meniscus_core::repulsion::SMALLEST_DISTANCE;
use meniscus_core::torus::{Fraction, Position, Torus, UNITS};
use meniscus_tests::reference::bessel::{k0, k1};
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::images::ImageSum;
use meniscus_tests::reference::{RandomNumbers, minimum_image, rms, rms_difference, wca};
use meniscus_tests::states::{at, crowded, scattered, separated};
use std::fs;
use std::path::Path;

/// Side of the box, R0.
const SIDE: f64 = 100.0;
/// Strength of Table I, kBT.
const STRENGTH: f64 = 0.89;
/// Discs in the box.
const DISCS: usize = 150;

/// Capillary energy of a few hundred discs against a reference, kBT: each has an error of the splitting that is 1e-7 of a
/// force of order 1 kBT/R0 over the mesh spacing.
const ERROR: f64 = 1e-6;
/// Rounding of sums of up to 10⁵ terms, relative to the sum of their moduli.
const ROUNDING: f64 = 1e-13;
/// Forces by differences of energy against Ewald sums, rms over rms: ten times better than 1e-6, which is demanded.
const FORCE_ERROR: f64 = 3e-7;
/// Total forces by differences of energy against those of the mesh scheme, rms over rms: with h = 0.39 R0, TSC and four-point
/// differences the mesh is off by 0.2 % at contact.
const MESH_FORCE_ERROR: f64 = 3e-3;
/// The energy of a single pair, kBT: up to 3e-8 was seen of two that nearly coincide.
const PAIR_ERROR: f64 = 1e-7;

fn system(side: f64, capillary_length: f64) -> System {
    System { particles: DISCS, side, capillary_strength: STRENGTH, capillary_length, repulsion: true }
}

fn in_radii(positions: &[Position], side: f64) -> Vec<[f64; 2]> {
    let torus = Torus::new(side).unwrap();
    positions.iter().map(|position| [torus.coordinate(position.x), torus.coordinate(position.y)]).collect()
}

fn ones(count: usize) -> Vec<f64> {
    vec![1.0; count]
}

/// Σ over pairs of f_i f_j `energy`(separation).
fn over_pairs(places: &[[f64; 2]], strengths: &[f64], energy: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (i, first) in places.iter().enumerate() {
        for (second, strength) in places.iter().zip(strengths).skip(i + 1) {
            sum += strengths[i] * strength * energy(second[0] - first[0], second[1] - first[1]);
        }
    }
    sum
}

/// What the mean over a pair's positions adds to all pairs, kBT: Ewald sums leave it out.
fn uniform(strengths: &[f64], side: f64, capillary_length: f64) -> f64 {
    if capillary_length.is_infinite() {
        return 0.0;
    }
    let per_pair = -TAU * STRENGTH * capillary_length * capillary_length / (side * side);
    per_pair * over_pairs(&vec![[0.0; 2]; strengths.len()], strengths, |_, _| 1.0)
}

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected}: {:e}", value - expected);
}

#[track_caller]
fn assert_is_energy(value: f64, expected: f64) {
    assert_near(value, expected, ERROR + ROUNDING * expected.abs());
}

#[test]
fn the_capillary_energy_is_the_ewald_sum() {
    let discs = separated(1, DISCS, SIDE, 2.0);
    assert_eq!(discs.len(), DISCS);
    for capillary_length in [1.0, 25.0, 270.0, f64::INFINITY] {
        let energy = PotentialEnergy::new(&system(SIDE, capillary_length)).of(&discs, None).capillary;
        let ewald = Ewald::new(SIDE, STRENGTH, capillary_length).energy(&in_radii(&discs, SIDE));
        assert_is_energy(energy, ewald + uniform(&ones(DISCS), SIDE, capillary_length));
    }
}

#[test]
fn the_capillary_energy_is_the_sum_over_images() {
    // Discs at 0.9 R0 and more from each other; at λ = 0.05 R0 they hardly feel each other.
    for (capillary_length, side) in [(0.05, 20.0), (0.5, 20.0), (3.0, 20.0), (2.0, 8.0)] {
        let discs = separated(2, 20, side, SMALLEST_DISTANCE);
        let energy = PotentialEnergy::new(&system(side, capillary_length)).of(&discs, None).capillary;
        let images = ImageSum::new(side, STRENGTH, capillary_length);
        let expected =
            over_pairs(&in_radii(&discs, side), &ones(discs.len()), |x, y| images.pair_energy(x, y));
        assert_is_energy(energy, expected);
    }
}

#[test]
fn strengths_of_either_sign_weight_every_pair() {
    let discs = separated(3, 100, SIDE, 2.0);
    let mut random = RandomNumbers::new(4);
    let quantised: Vec<i32> =
        (0..discs.len()).map(|_| ((4.0 * random.uniform() - 2.0) * f64::from(DISC)) as i32).collect();
    let strengths: Vec<f64> =
        quantised.iter().map(|strength| f64::from(*strength) / f64::from(DISC)).collect();
    for capillary_length in [25.0, f64::INFINITY] {
        let system = System { repulsion: false, ..system(SIDE, capillary_length) };
        let energies = PotentialEnergy::new(&system).of(&discs, Some(&quantised));
        let ewald = Ewald::new(SIDE, STRENGTH, capillary_length);
        let pairs = over_pairs(&in_radii(&discs, SIDE), &strengths, |x, y| ewald.pair_energy(x, y));
        assert_is_energy(energies.capillary, pairs + uniform(&strengths, SIDE, capillary_length));
    }
}

#[test]
fn strengths_of_one_are_those_left_out() {
    let discs = scattered(5, 50);
    let energy = PotentialEnergy::new(&system(SIDE, 25.0));
    assert_eq!(energy.of(&discs, Some(&[DISC as i32; 50])), energy.of(&discs, None));
    assert_eq!(energy.of(&discs, Some(&[])), energy.of(&discs, None));
}

#[test]
fn where_the_sum_is_cut_makes_no_difference() {
    // Many of these discs overlap, some nearly coincide.
    let discs = [scattered(6, 100), crowded(7, 60, 0.02)].concat();
    for capillary_length in [0.3, 25.0, f64::INFINITY] {
        let by_mesh = |nodes| {
            PotentialEnergy::with_mesh(&system(SIDE, capillary_length), nodes).of(&discs, None).capillary
        };
        let coarse = by_mesh(32);
        // The discs of the crowd add their errors pair by pair.
        let tolerance = over_pairs(&[[0.0; 2]; 60], &ones(60), |_, _| PAIR_ERROR);
        assert_near(by_mesh(64), coarse, tolerance);
        assert_near(by_mesh(128), coarse, tolerance);
        // A near part shorter than the distance below which forces no longer grow.
        assert_near(by_mesh(1024), coarse, tolerance);
    }
}

/// Minus the gradient of `energy` for disc `id`, by differences of fourth order over a few thousandths of R0.
fn force(energy: impl Fn(&[Position]) -> f64, discs: &[Position], id: usize) -> [f64; 2] {
    const SHIFT: i32 = 1 << 17;
    let moved = |x: i32, y: i32| {
        let mut discs = discs.to_vec();
        let by = |coordinate: Fraction, units: i32| {
            Fraction::from_bits(coordinate.to_bits().wrapping_add_signed(units))
        };
        discs[id] = Position { x: by(discs[id].x, x), y: by(discs[id].y, y) };
        energy(&discs)
    };
    let along = |x: i32, y: i32| {
        let difference = |units: i32| {
            let length = 2.0 * f64::from(units) * SIDE / UNITS;
            (moved(-x * units, -y * units) - moved(x * units, y * units)) / length
        };
        (4.0 * difference(SHIFT) - difference(2 * SHIFT)) / 3.0
    };
    [along(1, 0), along(0, 1)]
}

#[test]
fn the_capillary_force_is_minus_the_gradient() {
    const TRIED: usize = 4;
    let discs = separated(1, DISCS, SIDE, 2.0);
    for capillary_length in [5.0, 270.0, f64::INFINITY] {
        let energy = PotentialEnergy::new(&system(SIDE, capillary_length));
        let gradients: Vec<[f64; 2]> =
            (0..TRIED).map(|id| force(|discs| energy.of(discs, None).capillary, &discs, id)).collect();
        let ewald = Ewald::new(SIDE, STRENGTH, capillary_length).forces(&in_radii(&discs, SIDE));
        let error = rms_difference(&gradients, &ewald[..TRIED]) / rms(&ewald);
        assert!(error < FORCE_ERROR, "λ = {capillary_length}: {error:e}");
    }
}

#[test]
fn the_engine_moves_discs_down_the_gradient() {
    const TRIED: usize = 4;
    let parameters = Parameters {
        side: SIDE,
        grid: 256,
        influence: Influence::Continuum,
        gradient: Gradient::Difference4,
        ..Parameters::default()
    };
    let discs = separated(1, DISCS, SIDE, 1.9);
    let forces = Engine::new(&parameters, Clock::START, &discs).unwrap().forces().unwrap();
    let energy = PotentialEnergy::new(&system(SIDE, parameters.capillary_length));
    let total = |discs: &[Position]| {
        let Energies { capillary, repulsive } = energy.of(discs, None);
        capillary + repulsive
    };
    let gradients: Vec<[f64; 2]> = (0..TRIED).map(|id| force(total, &discs, id)).collect();
    let error = rms_difference(&gradients, &forces[..TRIED]) / rms(&forces[..TRIED]);
    assert!(error < MESH_FORCE_ERROR, "{error:e}");
}

#[test]
fn moving_all_discs_and_storing_them_otherwise_changes_nothing() {
    let discs = scattered(8, 200);
    let energy = PotentialEnergy::new(&system(SIDE, 25.0));
    let expected = energy.of(&discs, None);
    let shift = |position: &Position| {
        let by = |coordinate: Fraction, bits: u32| coordinate.wrapping_add(Fraction::from_bits(bits));
        Position { x: by(position.x, 0x9ABC_DEF1), y: by(position.y, 0x1234_5678) }
    };
    let moved: Vec<Position> = discs.iter().rev().map(shift).collect();
    let energies = energy.of(&moved, None);
    assert_is_energy(energies.capillary, expected.capillary);
    assert_near(energies.repulsive, expected.repulsive, ROUNDING * expected.repulsive);
}

#[test]
fn the_capillary_energy_of_overlapping_discs_is_a_straight_line() {
    for (side, capillary_length) in [(SIDE, 25.0), (SIDE, 0.6), (4.6, 3.0)] {
        let energy = PotentialEnergy::new(&system(side, capillary_length));
        let images = ImageSum::new(side, STRENGTH, capillary_length);
        let argument = SMALLEST_DISTANCE / capillary_length;
        for (x, y) in [(0.0, 0.0), (1e-6, 0.0), (0.1, 0.2), (0.0, 0.7), (0.6, 0.67), (0.9, 0.001)] {
            let discs = [at(side, 1.0, 0.5).unwrap(), at(side, 1.0 + x, 0.5 + y).unwrap()];
            let distance = libm::hypot(x, y);
            let line =
                -STRENGTH * (k0(argument) + k1(argument) / capillary_length * (SMALLEST_DISTANCE - distance));
            // The images but the nearest one; at d = 0 those of a small distance, on which they hardly depend.
            let apart = distance.max(1e-6);
            let images = images.pair_energy(x.max(apart - y), y) + STRENGTH * k0(apart / capillary_length);
            let nearest =
                if distance < SMALLEST_DISTANCE { line } else { -STRENGTH * k0(distance / capillary_length) };
            assert_near(energy.of(&discs, None).capillary, nearest + images, PAIR_ERROR);
        }
    }
}

#[test]
fn the_repulsive_energy_is_the_closed_form() {
    let discs = [scattered(9, 500), crowded(10, 30, 0.02)].concat();
    let energies = PotentialEnergy::new(&system(SIDE, 25.0)).of(&discs, None);
    let expected = over_pairs(&in_radii(&discs, SIDE), &ones(discs.len()), |x, y| {
        wca::energy(libm::hypot(minimum_image(x, SIDE), minimum_image(y, SIDE)))
    });
    assert!(expected > 1e5, "some of these discs nearly coincide");
    assert_near(energies.repulsive, expected, 1e-9 * expected);
    let without = System { repulsion: false, ..system(SIDE, 25.0) };
    assert_eq!(PotentialEnergy::new(&without).of(&discs, None).repulsive, 0.0);
}

#[test]
fn nothing_to_attract_has_no_energy() {
    let discs = scattered(11, 20);
    let none = System { capillary_strength: 0.0, repulsion: false, ..system(SIDE, 25.0) };
    assert_eq!(PotentialEnergy::new(&none).of(&discs, None), Energies::default());
    for capillary_length in [0.01, 25.0, 1e200, f64::INFINITY] {
        let energy = PotentialEnergy::new(&system(SIDE, capillary_length));
        assert_eq!(energy.of(&discs, Some(&[0; 20])).capillary, 0.0);
        assert_eq!(energy.of(&[], None), Energies::default());
        assert_near(energy.of(&discs[..1], None).capillary, 0.0, PAIR_ERROR);
    }
}

#[test]
fn the_ends_of_the_ranges_give_numbers() {
    for (side, particles) in [(4.5, 3), (4.5, 1 << 19), (65536.0, 1000)] {
        for capillary_length in [0.01, 1.0, 1e9, f64::INFINITY] {
            let system = System {
                particles,
                capillary_strength: 1000.0,
                capillary_length,
                side,
                ..system(side, capillary_length)
            };
            let energies = PotentialEnergy::with_mesh(&system, 32).of(&scattered(12, 30), None);
            assert!(energies.capillary.is_finite() && energies.repulsive.is_finite(), "{system:?}");
        }
    }
}

/// The rows of a short run's table, the first of them the names, and how the run ended.
fn short_run(folder: &Path, overrides: &[&str]) -> (Vec<Vec<String>>, Outcome) {
    let usual = ["system.particles=60", "system.box=60", "mesh.grid=64", "output.snapshots=0"];
    let overrides: Vec<String> = usual.iter().chain(overrides).map(|text| (*text).to_owned()).collect();
    let configuration = Configuration::from_preset("table-1", &overrides).unwrap();
    let simulation = Simulation::new(configuration).unwrap();
    let outcome = Run::create(simulation, folder, GoldenRequest::in_directory(folder))
        .unwrap()
        .to_end(|_| None::<Stop>)
        .unwrap();
    let table = fs::read_to_string(folder.join("observables.csv")).unwrap();
    (table.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect(), outcome)
}

#[test]
fn a_run_writes_the_energies_and_is_not_changed_by_them() {
    let folder = tempfile::tempdir().unwrap();
    let until = "time.until=0.003";
    let (rows, observed) = short_run(&folder.path().join("often"), &[until, "output.observables=0.001"]);
    let (none, alone) = short_run(&folder.path().join("never"), &[until, "output.observables=0"]);
    assert_eq!((observed.digest, observed.clock), (alone.digest, alone.clock));
    assert_eq!(none.len(), 1);
    assert_eq!(rows[0][9..], ["capillary_energy", "repulsive_energy"]);
    assert_eq!(rows.len(), 1 + 4);

    let overrides = ["system.particles=60", "system.box=60", "mesh.grid=64"].map(str::to_owned);
    let configuration = Configuration::from_preset("table-1", &overrides).unwrap();
    let energy = PotentialEnergy::new(&configuration.system);
    let start = Simulation::new(configuration).unwrap().engine.positions();
    let Energies { capillary, repulsive } = energy.of(&start, None);
    assert_eq!(rows[1][9..], [capillary.to_string(), repulsive.to_string()]);
}
