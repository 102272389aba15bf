//! Two repelling discs against Boltzmann's distribution of their distance, and Euler's bias at contact.
//!
//! The separation of two discs in a square box of side L has the density exp(−V), where V is that of the repulsion and,
//! if they attract each other, of all images. Each frame counts for as long as it lasts, the step that follows it.
//!
//! Without attraction the method of summing it changes no bit (tests/invariance.rs), so that one of them is enough.

use core::f64::consts::{FRAC_PI_4, PI};

use meniscus_core::engine::Engine;
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::torus::Position;
use meniscus_core::units::TIME_UNITS;
use meniscus_tests::long_tests;
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::wca;
use meniscus_tests::schemes::BOTH;
use meniscus_tests::states::separation;
use meniscus_tests::statistics::mean_and_error;
use meniscus_tests::tolerances::{ATTRACTED_RESOLUTION, BIAS_AT_SHORT_STEPS, CONTACT_BIAS, SIGMAS_OF_FEW};

/// A box hardly wider than the reach of the repulsion: the discs are often in contact.
const SIDE: f64 = 5.0;

const PAIR: Parameters = Parameters {
    side: SIDE,
    capillary_strength: 0.0,
    grid: 16,
    assignment: Assignment::CloudInCell,
    ..Parameters::PAPER
};

/// Lower ends of the bins, R0; the last has everything from there on.
const BINS: [f64; 6] = [0.0, 1.9, 2.0, 2.1, 2.2, 2.3];
/// The bin from 2.0 to 2.1 R0.
const CONTACT: usize = 2;
/// The bin of discs that do not touch.
const APART: usize = 5;

/// Boltzmann's weight of each bin, R0², but for a factor that all have.
fn boltzmann(parameters: &Parameters) -> [f64; 6] {
    let Parameters { capillary_strength, capillary_length, .. } = *parameters;
    let ewald = Ewald::new(SIDE, capillary_strength, capillary_length);
    let attraction = |x: f64, y: f64| if capillary_strength > 0.0 { ewald.pair_energy(x, y) } else { 0.0 };
    let reference = attraction(0.5 * SIDE, 0.5 * SIDE);
    // Midpoints of so many pieces that the rest does not matter, in an eighth of the box, from the line to the middle
    // of a side to that to a corner.
    let (angles, pieces) = (64, 100);
    let sector = FRAC_PI_4 / f64::from(angles);
    let along = |angle: f64, from: f64, to: f64| -> f64 {
        let (sine, cosine) = libm::sincos(angle);
        let width = (to - from) / f64::from(pieces);
        let weight = |piece: i32| {
            let distance = from + (f64::from(piece) + 0.5) * width;
            let energy = attraction(distance * cosine, distance * sine) - reference + wca::energy(distance);
            8.0 * sector * distance * libm::exp(-energy) * width
        };
        (0..pieces).map(weight).sum()
    };
    core::array::from_fn(|bin| {
        let angle = |index: i32| (f64::from(index) + 0.5) * sector;
        let to = |angle: f64| BINS.get(bin + 1).copied().unwrap_or(0.5 * SIDE / libm::cos(angle));
        (0..angles).map(angle).map(|angle| along(angle, BINS[bin], to(angle))).sum()
    })
}

/// The share of `duration` (R0²/D) that the two discs of a run spend in each bin.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn shares(parameters: &Parameters, duration: f64) -> [f64; 6] {
    let mut engine = Box::new(Engine::<16, 2>::new());
    engine
        .init(parameters, [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 31, 1 << 31))])
        .unwrap();
    let run_until = |engine: &mut Engine<16, 2>, time: f64, spent: &mut [u64; 6]| {
        let end = (time * TIME_UNITS as f64) as u64;
        while engine.clock().time < end {
            let distance = separation(engine.position(0).unwrap(), engine.position(1).unwrap(), SIDE);
            let bin = BINS.iter().rposition(|&from| distance >= from).unwrap();
            spent[bin] += engine.step().unwrap().length;
        }
    };
    // The distance forgets its start in (L/2π)²/2 = 0.3 R0²/D.
    let mut spent = [0; 6];
    run_until(&mut engine, 3.0, &mut spent);
    spent = [0; 6];
    run_until(&mut engine, 3.0 + duration, &mut spent);
    let total = spent.iter().sum::<u64>() as f64;
    spent.map(|spent| spent as f64 / total)
}

/// Density of each bin over that of discs apart, in units of Boltzmann's; and its standard error, from the scatter
/// of `seeds` runs of `duration` each.
fn densities(parameters: &Parameters, seeds: u64, duration: f64) -> [(f64, f64); 6] {
    let runs: Vec<[f64; 6]> =
        (1..=seeds).map(|seed| shares(&Parameters { seed, ..*parameters }, duration)).collect();
    let weights = boltzmann(parameters);
    let mean = |bin: usize| runs.iter().map(|shares| shares[bin]).sum::<f64>() / seeds as f64;
    core::array::from_fn(|bin| {
        let (here, apart) = (mean(bin), mean(APART));
        // The ratio of means, and the scatter of its linear part.
        let linear: Vec<f64> =
            runs.iter().map(|shares| shares[bin] / apart - here * shares[APART] / (apart * apart)).collect();
        let scale = weights[APART] / weights[bin];
        (here / apart * scale, mean_and_error(&linear).1 * scale)
    })
}

#[test]
fn two_discs_keep_boltzmanns_distance() {
    let (seeds, duration) = if long_tests() { (100, 200.0) } else { (12, 16.0) };
    for noise in [Noise::Uniform, Noise::Gaussian] {
        let parameters = Parameters { noise, max_step: 2e-4, ..PAIR };
        let densities = densities(&parameters, seeds, duration);
        println!("{noise:?}, steps of 2e-4, from {BINS:?}: {densities:.4?}");
        // From 1.9 R0 on: nearer, Euler's steps go too often.
        for (bin, (density, error)) in densities.into_iter().enumerate().skip(1) {
            let bound = SIGMAS_OF_FEW * error + BIAS_AT_SHORT_STEPS;
            assert!((density - 1.0).abs() <= bound, "from {}: {density} ± {error}", BINS[bin]);
        }
    }
}

#[test]
fn two_discs_that_attract_each_other_keep_boltzmanns_distance() {
    if !long_tests() {
        return;
    }
    // Makes contacts 1.7 times as frequent: images hold the discs back.
    let attracted = Parameters { capillary_strength: 5.0, max_step: 2e-4, ..PAIR };
    for scheme in BOTH {
        let densities = densities(&scheme.of(attracted), 60, 20.0);
        println!("{}, from {BINS:?}: {densities:.4?}", scheme.name);
        for (bin, (density, error)) in densities.into_iter().enumerate().skip(1) {
            let bound = SIGMAS_OF_FEW * error + BIAS_AT_SHORT_STEPS;
            assert!(
                (density - 1.0).abs() <= bound,
                "{}, from {}: {density} ± {error}",
                scheme.name,
                BINS[bin]
            );
            assert!(error <= ATTRACTED_RESOLUTION, "from {}: {density} ± {error}", BINS[bin]);
        }
    }
}

#[test]
fn the_weights_without_forces_are_areas() {
    // The last bin is the box without a circle.
    let area = boltzmann(&PAIR)[APART];
    assert!((area / (SIDE * SIDE - PI * 2.3 * 2.3) - 1.0).abs() < 1e-3, "{area}");
}

#[test]
fn the_bias_at_contact_falls_linearly_with_the_step() {
    let (steps, seeds, duration): (&[f64], u64, f64) = if long_tests() {
        (&[4e-3, 2e-3, 1e-3, 8e-4, 4e-4, 2e-4], 100, 200.0)
    } else {
        (&[4e-3, 2e-3, 1e-3], 25, 32.0)
    };
    let mut last = f64::INFINITY;
    for &max_step in steps {
        let (density, error) = densities(&Parameters { max_step, ..PAIR }, seeds, duration)[CONTACT];
        println!("steps of {max_step}: {density:.4} ± {error:.4} of Boltzmann's density at contact");
        let (bias, margin) = (1.0 - density, SIGMAS_OF_FEW * error);
        let (least, most) = (CONTACT_BIAS.0 * max_step, CONTACT_BIAS.1 * max_step);
        assert!(bias >= least - margin && bias <= most + margin, "bias {bias} ± {error} at {max_step}");
        assert!(bias < last + margin, "bias {bias} ± {error} at {max_step}, {last} at the step before");
        last = bias;
    }
}
