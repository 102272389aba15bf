//! Growth of long waves in a monolayer of random discs, against Eq. 10: Fig. 2.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::TAU;

use meniscus::configuration::Configuration;
use meniscus::engine::Engine;
use meniscus::observables::modes::growth::{Growth, growth_ratio};
use meniscus::observables::waves::{Waves, order};
use meniscus::simulation::Simulation;
use meniscus::statistics::Estimate;
use meniscus_core::dynamics::Clock;
use meniscus_core::parameters::Parameters;
use meniscus_core::units::time_from_units;
use meniscus_tests::figures::assert_within;
use meniscus_tests::long_tests;
use meniscus_tests::schemes::{BOTH, PAPER, SPLIT, Scheme};
use meniscus_tests::tolerances::{GROWTH_OF_LONG_WAVES, GROWTH_RESOLUTION, GROWTH_SIGMAS, Within};

/// The waves of which Eq. 10 is tested, k/K. Beyond, its pressure, that of an ideal gas, and what clusters are
/// about to do to it, matter.
const LONG: f64 = 0.2;

/// What Fig. 2 is changed to.
#[derive(Clone, Copy)]
struct Resolution {
    /// Nodes a side.
    grid: usize,
    /// R0²/D
    max_step: f64,
    repulsion: bool,
}

/// What makes a run of the waves k < 0.2 K cheap: they do not see a mesh of spacing 4.8 R0 (kh < 0.23, which weakens
/// the paper's force by 1 % at the most and 0.4 % on average), nor whether discs in contact repel, nor a longer step
/// when none do.
const COARSE: Resolution = Resolution { grid: 128, max_step: 0.05, repulsion: false };

/// All of Fig. 2 but the ceiling of the step, which is for pairs in contact.
const FINE: Resolution = Resolution { grid: 512, max_step: 0.005, repulsion: true };

/// The same with the split force, to which the mesh makes no difference.
const FINE_SPLIT: Resolution = Resolution { grid: 256, ..FINE };

/// The preset's way to sum the force gives way to a [`Scheme`], so that there is nothing to be chosen for an accuracy.
const SOON_SET_UP: &str = "force.method=pm";

/// A mode of wavenumber k/K.
type Mode = (f64, Growth);

/// The growth of the long waves of Fig. 2, run with `seed` up to `until` (t/T).
fn growth(scheme: Scheme, resolution: Resolution, seed: u64, until: f64) -> Vec<Mode> {
    let overrides = [format!("seed={seed}"), SOON_SET_UP.to_owned()];
    let configuration = Configuration::from_preset("fig-2", &overrides).unwrap();
    let theory = configuration.instability().unwrap();
    let unit = TAU / configuration.system.side;
    let waves = Waves::below(LONG * theory.jeans_wavenumber / unit);
    let mut simulation = Simulation::new(configuration).unwrap();
    let Resolution { grid, max_step, repulsion } = resolution;
    let parameters = Parameters { grid, max_step, repulsion, ..simulation.configuration.parameters() };
    let start = simulation.engine.positions();
    simulation.engine = Engine::new(&scheme.of(parameters), Clock::START, &start).unwrap();
    let initial = waves.powers(&start);
    while simulation.time_over_jeans().unwrap() < until {
        simulation.engine.step().unwrap();
    }
    let time = time_from_units(simulation.engine.clock().time);
    let count = simulation.engine.count() as f64;
    let later = waves.powers(&simulation.engine.positions());
    let modes = waves.vectors().iter().zip(initial.into_iter().zip(later));
    modes
        .map(|(&wave, (initial_power, later_power))| {
            let wavenumber = unit * order(wave);
            let thermal_power = 2.0 * count * wavenumber * wavenumber * time;
            let exponent = time * theory.growth_rate(wavenumber);
            let growth = Growth { initial_power, later_power, thermal_power, exponent };
            (wavenumber / theory.jeans_wavenumber, growth)
        })
        .collect()
}

/// The modes whose k/K is in `range`.
fn within(modes: &[Mode], range: core::ops::Range<f64>) -> Vec<Growth> {
    modes.iter().filter(|(wavenumber, _)| range.contains(wavenumber)).map(|&(_, growth)| growth).collect()
}

/// Fails unless the growth rate is that of Eq. 10 and the statistics suffice to tell.
fn assert_growth_of_theory(modes: &[Growth], resolution: f64, what: &str) {
    let Estimate { value: ratio, error, .. } = growth_ratio(modes).unwrap();
    let accepted = GROWTH_SIGMAS * error + GROWTH_OF_LONG_WAVES;
    assert_within(ratio, Within(1.0 - accepted, 1.0 + accepted), &format!("growth rate over Eq. 10, {what}"));
    assert_within(error, Within(0.0, resolution), &format!("its standard error, {what}"));
}

#[test]
fn long_waves_grow_as_theory_has_it() {
    for scheme in BOTH {
        let modes: Vec<Mode> = (1..=4).flat_map(|seed| growth(scheme, COARSE, seed, 0.5)).collect();
        let what = format!("{}, k < 0.2 K", scheme.name);
        assert_growth_of_theory(&within(&modes, 0.0..LONG), GROWTH_RESOLUTION, &what);
    }
}

#[test]
fn long_waves_of_figure_2_grow_as_theory_has_it() {
    if !long_tests() {
        return;
    }
    for (scheme, fine) in [(PAPER, FINE), (SPLIT, FINE_SPLIT)] {
        let modes: Vec<Mode> = (1..=8).flat_map(|seed| growth(scheme, fine, seed, 1.0)).collect();
        let what = format!("{}, k < 0.2 K", scheme.name);
        assert_growth_of_theory(&within(&modes, 0.0..LONG), 0.5 * GROWTH_RESOLUTION, &what);
        for range in [0.0..0.1, 0.1..0.15, 0.15..0.2] {
            let what = format!("{}, {} K < k < {} K", scheme.name, range.start, range.end);
            assert_growth_of_theory(&within(&modes, range), GROWTH_RESOLUTION, &what);
        }
    }
}
