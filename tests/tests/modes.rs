//! Density modes against the sums that define them, and their growth where it is known.

use core::f64::consts::TAU;

use meniscus::observables::modes::Modes;
use meniscus::observables::modes::growth::{Growth, growth_ratio};
use meniscus::observables::waves::{Wave, Waves, order};
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::reference::RandomNumbers;
use meniscus_tests::states::{lattice, scattered};
use meniscus_tests::tolerances::DENSITY_MODE;

/// |ρ̂_k|² as it is defined, every phase by itself.
fn power(discs: &[Position], (l, m): Wave) -> f64 {
    let (mut real, mut imaginary) = (0.0, 0.0);
    for disc in discs {
        // A phase wraps as positions do, and so it is exact.
        let along_x = disc.x.to_bits().wrapping_mul(l as u32);
        let along_y = disc.y.to_bits().wrapping_mul(m as u32);
        let turns = f64::from(along_x.wrapping_add(along_y)) / 4_294_967_296.0;
        let (sine, cosine) = libm::sincos(TAU * turns);
        real += cosine;
        imaginary -= sine;
    }
    real * real + imaginary * imaginary
}

/// The largest difference of |ρ̂_k| from its definition, per disc.
fn largest_difference(waves: &Waves, discs: &[Position]) -> f64 {
    let powers = waves.powers(discs);
    assert_eq!(powers.len(), waves.vectors().len());
    let difference = |(&wave, found): (&Wave, f64)| (found.sqrt() - power(discs, wave).sqrt()).abs();
    waves.vectors().iter().zip(powers).map(difference).fold(0.0, f64::max) / discs.len() as f64
}

#[test]
fn half_of_the_plane_has_each_wave_once() {
    assert_eq!(Waves::below(1.1).vectors(), [(0, 1), (1, 0)]);
    // 37 points of the square lattice within a circle of radius 3.4, but for the middle.
    let waves = Waves::below(3.4);
    assert_eq!(waves.vectors().len(), 18);
    for &(l, m) in Waves::below(12.0).vectors() {
        assert!(!waves.vectors().contains(&(-l, -m)), "{l} {m} and its opposite");
    }
    for limit in [0.0, 1.0, -3.0, f64::NAN] {
        assert!(Waves::below(limit).vectors().is_empty(), "{limit}");
    }
}

#[test]
fn a_shell_has_all_waves_that_round_to_it() {
    let waves = Waves::of_shells(12);
    let mut expected: Vec<Wave> = (-13..=13)
        .flat_map(|l| (-13..=13).map(move |m| (l, m)))
        .filter(|&(l, m)| l > 0 || (l == 0 && m > 0))
        .filter(|&wave| order(wave).round() <= 12.0)
        .collect();
    let mut found = waves.vectors().to_vec();
    expected.sort_unstable();
    found.sort_unstable();
    assert_eq!(found, expected);
    for (shell, number) in waves.shells().iter().zip(1..) {
        assert_eq!(shell.number, number);
        let vectors = &waves.vectors()[shell.waves.clone()];
        assert!(vectors.iter().all(|&wave| order(wave).round() == f64::from(number)));
        let mean = vectors.iter().map(|&wave| order(wave)).sum::<f64>() / vectors.len() as f64;
        assert!((shell.order - mean).abs() < 1e-12);
    }
}

#[test]
fn powers_are_those_of_the_definition() {
    // Whole blocks, a part of one, and fewer than one.
    for (seed, count) in [(1, 128), (2, 1000), (3, 7), (4, 1)] {
        let discs = scattered(seed, count);
        assert!(largest_difference(&Waves::of_shells(12), &discs) < DENSITY_MODE, "{count} discs");
    }
    assert!(largest_difference(&Waves::selected(1..=300, 2), &scattered(5, 20)) < DENSITY_MODE);
}

#[test]
fn no_discs_have_no_power() {
    assert!(Waves::of_shells(2).powers(&[]).iter().all(|&power| power == 0.0));
}

#[test]
fn a_lattice_scatters_at_its_own_waves_only() {
    let waves = Waves::of_shells(18);
    for (&(l, m), power) in waves.vectors().iter().zip(waves.powers(&lattice(8))) {
        let expected = if l % 8 == 0 && m % 8 == 0 { 4096.0 } else { 0.0 };
        assert!((power - expected).abs() < 1e-6, "{l} {m}: {power}");
    }
}

#[test]
fn scattered_discs_have_the_power_of_shot_noise() {
    let waves = Waves::below(12.0);
    let powers = waves.powers(&scattered(1, 1000));
    let count = powers.len() as f64;
    let mean = powers.iter().sum::<f64>() / count;
    // Powers are exponentially distributed: each scatters by its mean.
    assert!((mean / 1000.0 - 1.0).abs() < 4.0 / count.sqrt());
}

#[test]
fn a_selection_is_even_and_leaves_small_shells_whole() {
    let waves = Waves::selected(1..=200, 20);
    let all = Waves::of_shells(200);
    for (shell, whole) in waves.shells().iter().zip(all.shells()) {
        let (some, every) = (&waves.vectors()[shell.waves.clone()], &all.vectors()[whole.waves.clone()]);
        if every.len() <= 20 {
            assert_eq!(some, every);
        } else {
            assert!((10..=20).contains(&some.len()), "{} of shell {}", some.len(), shell.number);
            assert!(some.iter().all(|wave| every.contains(wave)));
            // l² and m² share |k|² alike where directions are evenly spread.
            let squares =
                |along: fn(&Wave) -> i32| some.iter().map(along).map(|l| f64::from(l * l)).sum::<f64>();
            let (along_x, along_y) = (squares(|wave| wave.0), squares(|wave| wave.1));
            assert!((along_x / (along_x + along_y) - 0.5).abs() < 0.1, "shell {}", shell.number);
        }
    }
}

#[test]
fn shell_means_are_means_over_the_waves_of_the_shell() {
    let torus = Torus::new(620.0).unwrap();
    let (initial, later) = (scattered(1, 200), scattered(2, 200));
    let shells = Modes::new(&torus, &initial, 6).of(&later);
    assert_eq!(shells.len(), 6);
    for (mode, number) in shells.iter().zip(1_u32..) {
        let waves = Waves::of_shells(number);
        let waves: Vec<Wave> = waves.vectors()[waves.shells().last().unwrap().waves.clone()].to_vec();
        let mean = |value: &dyn Fn(Wave) -> f64| {
            waves.iter().map(|&wave| value(wave)).sum::<f64>() / waves.len() as f64
        };
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-9;
        assert_eq!(mode.shell, number);
        assert!(near(mode.wavenumber, TAU / 620.0 * mean(&order)));
        assert!(near(mode.amplitude, mean(&|wave| power(&later, wave).sqrt())));
        assert!(near(mode.power, mean(&|wave| power(&later, wave))));
        let growth = mean(&|wave| 0.5 * libm::log(power(&later, wave) / power(&initial, wave)));
        assert!(near(mode.log_growth.unwrap(), growth));
    }
}

/// Discs of a lattice moved by a small amplitude A along a wave: |ρ̂_k| is A times the wavenumber along the motion times
/// N/2.
#[test]
fn waves_that_grow_by_e_have_grown_by_one() {
    let torus = Torus::new(100.0).unwrap();
    let rippled = |amplitude: f64| -> Vec<Position> {
        let wave = |phase: f64| amplitude * libm::sin(TAU / 100.0 * phase);
        let moved = |disc: &Position| {
            let (x, y) = (torus.coordinate(disc.x), torus.coordinate(disc.y));
            let along_x = wave(x) + wave(x + y) + wave(x - y);
            Position { x: torus.wrapped_fraction(x + along_x), y: torus.wrapped_fraction(y + wave(y)) }
        };
        lattice(16).iter().map(moved).collect()
    };
    let shells = Modes::new(&torus, &rippled(1e-3), 1).of(&rippled(1e-3 * core::f64::consts::E));
    assert!((shells[0].log_growth.unwrap() - 1.0).abs() < 1e-3, "{shells:?}");
    let expected = 1e-3 * core::f64::consts::E * TAU / 100.0 * 256.0 / 2.0;
    assert!((shells[0].amplitude / expected - 1.0).abs() < 1e-3, "{shells:?}");
}

#[test]
fn modes_that_are_absent_have_not_grown() {
    let torus = Torus::new(100.0).unwrap();
    let (ordered, scattered) = (lattice(16), scattered(1, 256));
    assert_eq!(Modes::new(&torus, &ordered, 3).of(&scattered)[1].log_growth, None);
    assert_eq!(Modes::new(&torus, &scattered, 3).of(&ordered)[1].log_growth, None);
    assert_eq!(Modes::new(&torus, &scattered, 3).of(&scattered)[1].log_growth, Some(0.0));
}

#[test]
fn the_growth_of_made_up_modes_is_found_within_its_error() {
    let mut random = RandomNumbers::new(1);
    // Box and Muller.
    let mut normal_pair = move |variance: f64| {
        let radius = (-variance * libm::log(1.0 - random.uniform())).sqrt();
        let (sine, cosine) = libm::sincos(TAU * random.uniform());
        [radius * cosine, radius * sine]
    };
    let (faster, thermal_power) = (1.1, 0.05);
    let modes: Vec<Growth> = (0..400)
        .map(|index| {
            let exponent = 0.5 + 0.001 * f64::from(index);
            let twice = 2.0 * faster * exponent;
            let initial = normal_pair(1.0);
            let noise = normal_pair(thermal_power * libm::expm1(twice) / twice);
            let later = [0, 1].map(|part| initial[part] * libm::exp(0.5 * twice) + noise[part]);
            let square = |[real, imaginary]: [f64; 2]| real * real + imaginary * imaginary;
            Growth { initial_power: square(initial), later_power: square(later), thermal_power, exponent }
        })
        .collect();
    let ratio = growth_ratio(&modes).unwrap();
    assert!(ratio.agrees_with(faster, 3.0), "{ratio}");
    assert!(ratio.error > 0.002 && ratio.error < 0.02, "{ratio}");
    assert_eq!(growth_ratio(&modes[..1]), None);
}
