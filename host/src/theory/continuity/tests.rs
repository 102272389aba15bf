//! The solver against linear theory, closed forms, and what the equation keeps.

use super::*;
use crate::theory::Instability;
use core::f64::consts::PI;

const STRENGTH: f64 = 0.89;
const DENSITY: f64 = 0.01;
const LENGTH: f64 = 270.0;
const SIDE: f64 = 500.0;

fn of_table_1(cells: usize, pressure: Pressure, density: &[f64]) -> Continuity {
    Continuity::new(SIDE, cells, STRENGTH, LENGTH, pressure, density).unwrap()
}

/// The growth rate of a wave of amplitude 10⁻⁴ on `cells`² cells over `time`, D/R0².
fn measured_rate(cells: usize, pressure: Pressure, wave: [i32; 2], time: f64) -> f64 {
    let mut monolayer = of_table_1(cells, pressure, &sinusoid(cells, DENSITY, 1e-4, wave));
    let amplitude = |density: &[f64]| density[0] / DENSITY - 1.0;
    let before = amplitude(monolayer.density());
    monolayer.advance_to(time).unwrap();
    libm::log(amplitude(monolayer.density()) / before) / time
}

fn wavenumber([l, m]: [i32; 2]) -> f64 {
    TAU / SIDE * libm::hypot(f64::from(l), f64::from(m))
}

fn theory(pressure: Pressure) -> Instability {
    // A stiffness of 0 has no Jeans' wavenumber: next to nothing serves.
    let stiffness = pressure.stiffness(DENSITY).max(1e-12);
    Instability::of_fluid(STRENGTH, DENSITY, LENGTH, stiffness).unwrap()
}

/// The five-point Laplacian has k²(1 − k²h²/12) at least; the rate's error is of that order, relative to either
/// of its two terms.
#[test]
fn small_waves_grow_as_equation_10_says() {
    for pressure in [Pressure::None, Pressure::IdealGas, Pressure::discs()] {
        for wave in [[1, 0], [1, 1], [2, 1]] {
            let expected = theory(pressure).growth_rate(wavenumber(wave));
            let found = measured_rate(32, pressure, wave, 2.0);
            let attraction = theory(Pressure::None).growth_rate(wavenumber(wave));
            let spacing = wavenumber(wave) * SIDE / 32.0;
            let accepted = attraction * (spacing * spacing / 12.0 + 1e-3);
            assert!((found - expected).abs() < accepted, "{pressure:?}, {wave:?}: {found}, not {expected}");
        }
    }
}

/// With k² of the mesh's Laplacian Eq. 10 is exact but for the amplitude and the step, also beyond K_c, where waves decay.
#[test]
fn on_the_mesh_equation_10_is_exact() {
    let (cells, side) = (32, 100.0);
    let spacing = side / cells as f64;
    for pressure in [Pressure::IdealGas, Pressure::discs()] {
        for (order, grows) in [(2, true), (6, false)] {
            let wavenumber = TAU * f64::from(order) / side;
            let on_mesh = 2.0 / spacing * libm::sin(0.5 * wavenumber * spacing);
            let expected = theory(pressure).growth_rate(on_mesh);
            assert_eq!(expected > 0.0, grows);
            let start = sinusoid(cells, DENSITY, 1e-4, [0, order]);
            let mut monolayer = Continuity::new(side, cells, STRENGTH, LENGTH, pressure, &start).unwrap();
            monolayer.advance_to(2.0).unwrap();
            let amplitude = 1e4 * (monolayer.density()[0] / DENSITY - 1.0);
            let found = 0.5 * libm::log(amplitude);
            assert!((found / expected - 1.0).abs() < 2e-3, "{pressure:?}, {order}: {found}, not {expected}");
        }
    }
}

#[test]
fn the_error_falls_with_the_square_of_the_spacing() {
    let expected = theory(Pressure::IdealGas).growth_rate(wavenumber([3, 0]));
    let error = |cells| (measured_rate(cells, Pressure::IdealGas, [3, 0], 1.0) - expected).abs();
    let order = libm::log2(error(16) / error(32));
    assert!((order - 2.0).abs() < 0.15, "{order}");
}

/// A nonlinear state, each on the mesh after the next finer one: differences fall by four.
#[test]
fn the_nonlinear_solution_converges_to_second_order() {
    let solution = |cells: usize| {
        let start: Vec<f64> = sinusoid(cells, DENSITY, 0.5, [1, 0])
            .iter()
            .zip(sinusoid(cells, 1.0, 0.4, [0, 1]))
            .map(|(along_x, along_y)| along_x * along_y)
            .collect();
        let mut monolayer =
            Continuity::new(100.0, cells, STRENGTH, LENGTH, Pressure::discs(), &start).unwrap();
        monolayer.advance_to(4.0).unwrap();
        monolayer.density().to_vec()
    };
    let [coarse, middle, fine] = [16, 32, 64].map(solution);
    // Cell centres of a coarse mesh are every other one of the next.
    let difference = |coarse: &[f64], fine: &[f64], cells: usize| {
        let squares = (0..cells * cells).map(|cell| {
            let (x, y) = (cell % cells, cell / cells);
            let difference = coarse[cell] - fine[4 * y * cells + 2 * x];
            difference * difference
        });
        (squares.sum::<f64>() / (cells * cells) as f64).sqrt()
    };
    let order = libm::log2(difference(&coarse, &middle, 16) / difference(&middle, &fine, 32));
    assert!((1.7..2.4).contains(&order), "{order}");
}

#[test]
fn without_attraction_waves_diffuse() {
    let (cells, side, time) = (32, 40.0, 5.0);
    let start = sinusoid(cells, DENSITY, 0.9, [1, 2]);
    let mut gas = Continuity::new(side, cells, 0.0, LENGTH, Pressure::IdealGas, &start).unwrap();
    gas.advance_to(time).unwrap();
    let square = TAU * TAU * 5.0 / (side * side);
    let expected = sinusoid(cells, DENSITY, 0.9 * libm::exp(-square * time), [1, 2]);
    for (found, expected) in gas.density().iter().zip(&expected) {
        // k²h²/12 of the decayed amplitude, and its decay of 3.1.
        assert!((found / expected - 1.0).abs() < 0.01, "{found}, not {expected}");
    }
}

/// All discs in two cells, which is as far from smooth as can be.
fn violent(pressure: Pressure) -> Continuity {
    let cells = 24;
    let mut density = vec![0.0; cells * cells];
    density[5] = 0.2;
    density[300] = 0.25;
    Continuity::new(96.0, cells, 0.3, LENGTH, pressure, &density).unwrap()
}

#[test]
fn discs_are_kept_and_densities_positive_from_a_violent_start() {
    for pressure in [Pressure::None, Pressure::IdealGas, Pressure::discs()] {
        let mut monolayer = violent(pressure);
        let mass = monolayer.mass();
        for time in [0.1, 1.0, 20.0] {
            monolayer.advance_to(time).unwrap();
            assert_eq!(monolayer.time(), time);
            assert!(monolayer.density().iter().all(|density| *density >= 0.0), "{pressure:?} at {time}");
            assert!((monolayer.mass() / mass - 1.0).abs() < 1e-12, "{pressure:?} at {time}");
        }
        // It went somewhere, but for the cold: two points hold each other from afar, each deep in its own field.
        let occupied = monolayer.density().iter().filter(|density| **density > 1e-6).count();
        assert_eq!(occupied > 2, pressure != Pressure::None, "{pressure:?}: {occupied}");
    }
}

#[test]
fn the_free_energy_never_rises() {
    for pressure in [Pressure::None, Pressure::IdealGas, Pressure::discs()] {
        for mut monolayer in [violent(pressure), unstable(pressure)] {
            let mut before = monolayer.free_energy();
            for step in 1..=15 {
                monolayer.advance_to(0.5 * f64::from(step)).unwrap();
                let energy = monolayer.free_energy();
                assert!(energy <= before + 1e-12 * before.abs(), "{pressure:?}: {before} to {energy}");
                before = energy;
            }
        }
    }
}

/// A monolayer that soon collapses.
fn unstable(pressure: Pressure) -> Continuity {
    Continuity::new(60.0, 16, STRENGTH, LENGTH, pressure, &sinusoid(16, 0.05, 0.3, [1, 1])).unwrap()
}

/// ln ρ + μ_ex − U is the same everywhere.
#[test]
fn a_collapsed_monolayer_is_in_equilibrium_with_its_field() {
    let start = sinusoid(12, 0.05, 0.3, [1, 0]);
    let mut monolayer = Continuity::new(36.0, 12, 0.5, LENGTH, Pressure::discs(), &start).unwrap();
    monolayer.advance_to(300.0).unwrap();
    let field = monolayer.field.of(monolayer.density());
    let potentials: Vec<f64> = monolayer
        .density()
        .iter()
        .zip(field)
        .map(|(&density, field)| libm::log(density) + monolayer.pressure.excess_potential(density) - field)
        .collect();
    let (most, least) = potentials
        .iter()
        .fold((f64::MIN, f64::MAX), |(most, least), &value| (most.max(value), least.min(value)));
    let density = |choose: fn(f64, f64) -> f64| monolayer.density().iter().copied().reduce(choose).unwrap();
    assert!(density(f64::max) > 3.0 * density(f64::min), "it must have collapsed for this to say anything");
    assert!(most - least < 1e-6, "{least} to {most}");
}

/// Without pressure and screening a patch stays even while its background thins it: d(R²)/dt = −2V0(N − πρ̄R²),
/// which is Eq. 13 for ρ̄ → 0.
#[test]
fn a_cold_patch_collapses_as_the_closed_form() {
    let (side, cells, radius) = (600.0, 48, 183.0);
    let start = top_hat(side, cells, 0.004_28, radius);
    let mut patch = Continuity::new(side, cells, STRENGTH, f64::INFINITY, Pressure::None, &start).unwrap();
    let discs = patch.mass();
    let jeans_time = crate::theory::jeans_time(STRENGTH, 0.004_28);
    let background = discs / (side * side);
    let square_radius = |patch: &Continuity| {
        // Of an even patch the mean square distance is R²/2.
        let spacing = side / cells as f64;
        let square = |index: usize| {
            let (x, y) = (spacing * (index % cells) as f64 - 300.0, spacing * (index / cells) as f64 - 300.0);
            x * x + y * y
        };
        let moments = patch.density().iter().enumerate().map(|(index, density)| density * square(index));
        2.0 * moments.sum::<f64>() / patch.density().iter().sum::<f64>()
    };
    let initial = square_radius(&patch);
    assert!((initial / (radius * radius) - 1.0).abs() < 0.01, "{initial}");
    for time in [0.3, 0.6] {
        patch.advance_to(time * jeans_time).unwrap();
        let balance = discs / (PI * background);
        let growth = libm::exp(TAU * STRENGTH * background * patch.time());
        let expected = balance - (balance - initial) * growth;
        let found = square_radius(&patch);
        // Its edge is worn over a cell or two of 12.5 R0.
        assert!((found / expected - 1.0).abs() < 0.05, "at {time} T: {found}, not {expected}");
        let middle = patch.density()[cells / 2 * cells + cells / 2];
        // d ln ρ/dt = 2πV0(ρ − ρ̄)
        let excess = 1.0 / (1.0 - (1.0 - background / 0.004_28) * growth);
        let expected = background * excess;
        assert!((middle / expected - 1.0).abs() < 0.01, "at {time} T: {middle}, not {expected}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let even = [0.01; 16];
    let new = |side, cells, strength, length, density: &[f64]| {
        Continuity::new(side, cells, strength, length, Pressure::discs(), density).unwrap_err()
    };
    assert_eq!(new(0.0, 4, 1.0, 1.0, &even), AttractionError::Side { side: 0.0, least: 0.0 }.into());
    assert_eq!(new(1.0, 3, 1.0, 1.0, &even), ContinuityError::Cells { cells: 3 });
    assert_eq!(new(1.0, 4, -1.0, 1.0, &even), AttractionError::Strength { strength: -1.0 }.into());
    assert_eq!(new(1.0, 4, 1.0, 0.0, &even), AttractionError::Length { length: 0.0 }.into());
    assert_eq!(new(1.0, 5, 1.0, 1.0, &even), ContinuityError::Count { found: 16, cells: 5 });
    let mut dense = even;
    dense[3] = 0.4;
    assert!(matches!(new(1.0, 4, 1.0, 1.0, &dense), ContinuityError::Density { index: 3, .. }));
    let mut monolayer = of_table_1(4, Pressure::IdealGas, &even);
    monolayer.advance_to(1.0).unwrap();
    assert_eq!(monolayer.advance_to(0.5), Err(EvolutionError::Time { asked: 0.5, time: 1.0 }));
}
