//! The noise: bounds, moments and correlations per particle, across particles, across seeds; purity.
//!
//! Moments are compared in standard errors; seeds are the first ones.

use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::parameters::Noise;
use meniscus_tests::reference::RandomNumbers;
use meniscus_tests::statistics::{
    correlation_score, gaussian_fourth_moment_score, lag_score, mean_score, variance_score,
};
use meniscus_tests::tolerances::{SIGMAS_OF_FEW, SIGMAS_OF_MANY};
use proptest::prelude::*;

/// Δt of the tests, R0²/D.
const STEP_LENGTH: f32 = 0.001;
/// 2Δt as binary32 holds Δt.
const VARIANCE: f64 = 2.0 * STEP_LENGTH as f64;

const DISTRIBUTIONS: [Noise; 2] = [Noise::Uniform, Noise::Gaussian];

/// ⟨x⁴⟩/⟨x²⟩².
fn kurtosis(noise: Noise) -> f64 {
    if noise == Noise::Uniform { 1.8 } else { 3.0 }
}

fn kick(noise: Noise, seed: u64, step: u64) -> ThermalKick {
    ThermalKick::new(noise, STEP_LENGTH, StepKey::new(seed, Purpose::Motion, step))
}

/// The displacements (x, y) in two series.
fn series(displacements: impl Iterator<Item = (f32, f32)>) -> [Vec<f64>; 2] {
    let (x, y) = displacements.map(|(x, y)| (f64::from(x), f64::from(y))).unzip();
    [x, y]
}

/// z-scores of everything one series of pairs (x, y) should obey.
fn scores(noise: Noise, [x, y]: &[Vec<f64>; 2]) -> Vec<f64> {
    let mut scores = vec![correlation_score(x, y, VARIANCE)];
    for component in [x, y] {
        scores.push(mean_score(component, VARIANCE));
        scores.push(variance_score(component, VARIANCE, kurtosis(noise)));
        for lag in 1..=3 {
            scores.push(lag_score(component, lag, VARIANCE));
        }
    }
    scores.push(correlation_score(&x[1..], &y[..y.len() - 1], VARIANCE));
    scores.push(correlation_score(&y[1..], &x[..x.len() - 1], VARIANCE));
    scores
}

fn largest(scores: &[f64]) -> f64 {
    scores.iter().fold(0.0, |largest, score| score.abs().max(largest))
}

#[test]
fn every_particle_diffuses_alike_and_forgets_its_last_kick() {
    // Low ids, high ids and ids that differ in one bit, followed over steps.
    let ids: Vec<u32> = (0..40).chain([511, 1 << 10, (1 << 19) - 1, 1 << 31, u32::MAX]).collect();
    let mut worst: f64 = 0.0;
    for noise in DISTRIBUTIONS {
        for first in [0, 1 << 32, u64::MAX - 3000] {
            let kicks: Vec<ThermalKick> = (first..first + 3000).map(|step| kick(noise, 1, step)).collect();
            for &id in &ids {
                let scores = scores(noise, &series(kicks.iter().map(|kick| kick.displacement(id))));
                worst = worst.max(largest(&scores));
                assert!(
                    largest(&scores) < SIGMAS_OF_MANY,
                    "{noise:?}, id {id}, from step {first}: {scores:?}"
                );
            }
        }
    }
    println!("per particle: largest deviation {worst:.2} standard errors");
}

#[test]
fn diffusion_scatters_from_particle_to_particle_as_chance_has_it() {
    // A few particles that diffuse too fast and others too slowly hide in the mean over all, not in this scatter.
    for noise in DISTRIBUTIONS {
        let kicks: Vec<ThermalKick> = (0..500).map(|step| kick(noise, 1, step)).collect();
        let particles = 0..400;
        let scores: Vec<f64> = particles
            .flat_map(|id| series(kicks.iter().map(|kick| kick.displacement(id))))
            .map(|component| variance_score(&component, VARIANCE, kurtosis(noise)))
            .collect();
        let scatter = variance_score(&scores, 1.0, 3.0);
        assert!(scatter.abs() < SIGMAS_OF_FEW, "{noise:?}: {scatter}");
    }
}

#[test]
fn particles_are_kicked_independently_at_one_step() {
    let mut worst: f64 = 0.0;
    for noise in DISTRIBUTIONS {
        for step in [0, 1, 2, 3, 1000, 1 << 20, 1 << 31, 1 << 32, 1 << 63, u64::MAX] {
            let kick = kick(noise, 1, step);
            for first in [0, 1 << 20, u32::MAX - 10_000] {
                let scores = scores(noise, &series((first..first + 10_000).map(|id| kick.displacement(id))));
                worst = worst.max(largest(&scores));
                assert!(
                    largest(&scores) < SIGMAS_OF_MANY,
                    "{noise:?}, step {step}, ids from {first}: {scores:?}"
                );
            }
        }
    }
    println!("across particles: largest deviation {worst:.2} standard errors");
}

#[test]
fn every_seed_gives_the_same_moments() {
    let mut worst: f64 = 0.0;
    for noise in DISTRIBUTIONS {
        for seed in 1..=32 {
            let kicks: Vec<ThermalKick> = (0..100).map(|step| kick(noise, seed, step)).collect();
            let all = series(kicks.iter().flat_map(|kick| (0..50).map(|id| kick.displacement(id))));
            let scores = scores(noise, &all);
            worst = worst.max(largest(&scores));
            assert!(largest(&scores) < SIGMAS_OF_MANY, "{noise:?}, seed {seed}: {scores:?}");
        }
    }
    println!("across seeds: largest deviation {worst:.2} standard errors");
}

#[test]
fn neighbouring_seeds_are_uncorrelated() {
    let mut worst: f64 = 0.0;
    for noise in DISTRIBUTIONS {
        let of_seed = |seed: u64| {
            let kicks: Vec<ThermalKick> = (0..50).map(|step| kick(noise, seed, step)).collect();
            series(kicks.iter().flat_map(|kick| (0..40).map(|id| kick.displacement(id))))
        };
        let all: Vec<[Vec<f64>; 2]> = (0..=32).map(of_seed).collect();
        for (seed, first) in all.iter().enumerate() {
            for (other, second) in all.iter().enumerate().skip(seed + 1) {
                for (a, b) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
                    let score = correlation_score(&first[a], &second[b], VARIANCE);
                    worst = worst.max(score.abs());
                    assert!(score.abs() < SIGMAS_OF_MANY, "{noise:?}, seeds {seed} and {other}: {score}");
                }
            }
        }
    }
    println!("seeds against each other: largest correlation {worst:.2} standard errors");
}

#[test]
fn seeds_over_their_whole_range_give_one_sample() {
    // Over seeds at one step and id: as random as over anything else.
    for noise in DISTRIBUTIONS {
        for first in [0, 1 << 32, (1 << 63) - 5000] {
            for (step, id) in [(0, 0), (0, 1), (1, 0), (1_000_000, 2499)] {
                let scores = scores(
                    noise,
                    &series((first..first + 5000).map(|seed| kick(noise, seed, step).displacement(id))),
                );
                assert!(largest(&scores) < SIGMAS_OF_MANY, "{noise:?}, step {step}, id {id}: {scores:?}");
            }
        }
    }
}

#[test]
fn steps_and_particles_far_apart_are_uncorrelated() {
    // Distances that are powers of two catch generators whose low bits repeat.
    let mut worst: f64 = 0.0;
    for noise in DISTRIBUTIONS {
        let at = |first: u64| series((first..first + 2000).map(|step| kick(noise, 1, step).displacement(0)));
        let start = at(0);
        // The keys repeat after 2⁶³ steps, which no run can do: a step takes two of the generator's 2⁶⁴ outputs.
        for exponent in 11..63 {
            let later = at(1 << exponent);
            for (a, b) in start.iter().zip(&later) {
                let score = correlation_score(a, b, VARIANCE);
                worst = worst.max(score.abs());
                assert!(score.abs() < SIGMAS_OF_MANY, "{noise:?}, 2^{exponent} steps apart: {score}");
            }
        }
        let kick = kick(noise, 1, 5);
        let of = |first: u32| series((first..first + 2000).map(|id| kick.displacement(id)));
        let low = of(0);
        for exponent in 11..32 {
            let high = of(1 << exponent);
            for (a, b) in low.iter().zip(&high) {
                let score = correlation_score(a, b, VARIANCE);
                worst = worst.max(score.abs());
                assert!(score.abs() < SIGMAS_OF_MANY, "{noise:?}, 2^{exponent} ids apart: {score}");
            }
        }
    }
    println!("powers of two apart: largest correlation {worst:.2} standard errors");
}

#[test]
fn gaussian_kicks_have_the_tails_of_a_gaussian() {
    let deviation = VARIANCE.sqrt();
    let kicks: Vec<ThermalKick> = (0..300).map(|step| kick(Noise::Gaussian, 1, step)).collect();
    let [x, y] = series(kicks.iter().flat_map(|kick| (0..1000).map(|id| kick.displacement(id))));
    for component in [x, y] {
        let score = gaussian_fourth_moment_score(&component, VARIANCE);
        assert!(score.abs() < SIGMAS_OF_FEW, "fourth moment: {score}");
        for (sigmas, probability) in
            [(1.0, 0.317_310_5), (2.0, 0.045_500_3), (3.0, 0.002_699_8), (4.0, 6.334e-5)]
        {
            let beyond = component.iter().filter(|x| x.abs() > sigmas * deviation).count() as f64;
            let expected = probability * component.len() as f64;
            let score = (beyond - expected) / (expected * (1.0 - probability)).sqrt();
            assert!(score.abs() < SIGMAS_OF_FEW, "beyond {sigmas} standard deviations: {beyond}, {expected}");
        }
    }
}

#[test]
fn uniform_kicks_fill_their_square_evenly() {
    let half_width = (6.0 * f64::from(STEP_LENGTH)).sqrt();
    let kicks: Vec<ThermalKick> = (0..100).map(|step| kick(Noise::Uniform, 1, step)).collect();
    let mut counts = [[0_u32; 16]; 16];
    for (x, y) in kicks.iter().flat_map(|kick| (0..1000).map(|id| kick.displacement(id))) {
        let bin = |x: f32| ((f64::from(x) / half_width + 1.0) * 8.0) as usize;
        counts[bin(x)][bin(y)] += 1;
    }
    let expected = 100_000.0 / 256.0;
    let square = |count: u32| (f64::from(count) - expected) * (f64::from(count) - expected) / expected;
    let chi_squared: f64 = counts.iter().flatten().map(|&count| square(count)).sum();
    // 255 degrees of freedom: mean 255, variance 510.
    let score = (chi_squared - 255.0) / 510.0_f64.sqrt();
    assert!(score.abs() < SIGMAS_OF_FEW, "χ² {chi_squared}");
}

#[test]
fn uniform_kicks_stay_within_their_half_width_even_at_extreme_bits() {
    let half_width = libm::sqrtf(6.0 * STEP_LENGTH);
    let key = StepKey::new(1, Purpose::Motion, 0);
    let kick = kick(Noise::Uniform, 1, 0);
    let mut moduli = Vec::new();
    // Ids whose upper 24 bits of x or y are all equal at this step.
    for (id, of_y, ones) in [
        (24_526_680, false, false),
        (8_310_415, false, true),
        (33_078_484, true, false),
        (8_893_558, true, true),
    ] {
        let bits = key.bits(u64::from(id));
        let bits = if of_y { bits as u32 } else { (bits >> 32) as u32 };
        assert_eq!(bits >> 8, if ones { 0x00FF_FFFF } else { 0 });
        let (x, y) = kick.displacement(id);
        let extreme = if of_y { y } else { x };
        assert!(extreme.abs() <= half_width && extreme.abs() > half_width * 0.999_999);
        assert_eq!(extreme > 0.0, ones);
        moduli.push(extreme.abs());
    }
    // The ends mirror each other, so that the mean over all bits is exactly zero.
    assert!(moduli.iter().all(|modulus| modulus == &moduli[0]), "{moduli:?}");
}

#[test]
fn gaussian_kicks_are_finite_even_at_extreme_bits() {
    // Step and id where the upper 32 bits are all zero, where a logarithm of zero would be: √(64 ln 2) = 6.66
    // standard deviations.
    let (step, id) = (1, 3_920_666_284);
    assert_eq!(StepKey::new(1, Purpose::Motion, step).bits(u64::from(id)) >> 32, 0);
    let (x, y) = kick(Noise::Gaussian, 1, step).displacement(id);
    let radius = libm::hypot(f64::from(x), f64::from(y)) / VARIANCE.sqrt();
    assert!((radius - (64.0 * core::f64::consts::LN_2).sqrt()).abs() < 1e-5, "{radius}");
    // And where they are all one: the logarithm of one.
    let (step, id) = (0, 2_627_053_629);
    assert_eq!(StepKey::new(1, Purpose::Motion, step).bits(u64::from(id)) >> 32, u64::from(u32::MAX));
    assert_eq!(kick(Noise::Gaussian, 1, step).displacement(id), (0.0, 0.0));
}

#[test]
fn no_noise_is_no_kick() {
    for id in [0, 1, u32::MAX] {
        let (x, y) = kick(Noise::None, 1, 7).displacement(id);
        assert_eq!((x.to_bits(), y.to_bits()), (0, 0));
    }
}

#[test]
fn purposes_draw_different_numbers() {
    let of = |purpose: Purpose| {
        let bits = (0..100).flat_map(|step| {
            let key = StepKey::new(1, purpose, step);
            (0..20).map(move |id| key.bits(id))
        });
        bits.collect::<Vec<u64>>()
    };
    let (motion, start) = (of(Purpose::Motion), of(Purpose::Start));
    assert!(motion.iter().zip(&start).all(|(a, b)| a != b));
    // Half of all bits differ.
    let differing: u32 = motion.iter().zip(&start).map(|(a, b)| (a ^ b).count_ones()).sum();
    let bits = f64::from(64 * 2000);
    let score = (f64::from(differing) - bits / 2.0) / (bits / 4.0).sqrt();
    assert!(score.abs() < SIGMAS_OF_FEW, "{differing} of {bits} bits differ");
}

#[test]
fn no_bits_are_drawn_twice() {
    let mut all: Vec<u64> = Vec::new();
    for seed in [0, 1, 2, 3] {
        for purpose in [Purpose::Motion, Purpose::Start] {
            for step in 0..50 {
                let key = StepKey::new(seed, purpose, step);
                all.extend((0..100).map(|id| key.bits(id)));
            }
        }
    }
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);
}

#[test]
fn every_bit_is_as_often_one_as_zero() {
    let mut ones = [0_u32; 64];
    let draws = 20_000_u32;
    for step in 0..100 {
        let key = StepKey::new(1, Purpose::Motion, step);
        for id in 0..u64::from(draws / 100) {
            let bits = key.bits(id);
            ones.iter_mut().enumerate().for_each(|(place, ones)| *ones += (bits >> place & 1) as u32);
        }
    }
    for (place, &ones) in ones.iter().enumerate() {
        let score = (f64::from(ones) - f64::from(draws) / 2.0) / (f64::from(draws) / 4.0).sqrt();
        assert!(score.abs() < SIGMAS_OF_FEW, "bit {place}: {ones} of {draws}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_kick_is_a_pure_function_of_seed_step_and_particle(
        seed in 0..1_u64 << 63,
        step in any::<u64>(),
        ids in prop::collection::vec(any::<u32>(), 1..50),
        noise in prop::sample::select(&DISTRIBUTIONS[..]),
        order in any::<u64>(),
    ) {
        let alone: Vec<_> = ids.iter().map(|&id| kick(noise, seed, step).displacement(id)).collect();
        // Others asked in between, from the same and from other keys.
        let shared = kick(noise, seed, step);
        let mut random = RandomNumbers::new(order);
        for (&id, &alone) in ids.iter().zip(&alone).rev() {
            let _ = shared.displacement(random.bits() as u32);
            let _ = kick(noise, random.bits() >> 1, step).displacement(id);
            let (x, y) = shared.displacement(id);
            prop_assert_eq!((x.to_bits(), y.to_bits()), (alone.0.to_bits(), alone.1.to_bits()));
        }
    }

    #[test]
    fn every_kick_is_finite_and_bounded(
        seed in 0..1_u64 << 63,
        step in any::<u64>(),
        id in any::<u32>(),
        step_length in 1_u64..=1 << 40,
    ) {
        let length = step_length as f32 / (1_u64 << 40) as f32;
        let key = StepKey::new(seed, Purpose::Motion, step);
        let (x, y) = ThermalKick::new(Noise::Uniform, length, key).displacement(id);
        let bound = libm::sqrtf(6.0 * length);
        prop_assert!(x.abs() <= bound && y.abs() <= bound);
        let (x, y) = ThermalKick::new(Noise::Gaussian, length, key).displacement(id);
        let bound = 6.67 * libm::sqrtf(2.0 * length);
        prop_assert!(x.abs() <= bound && y.abs() <= bound);
    }
}
