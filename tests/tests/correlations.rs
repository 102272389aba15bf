//! g(r) and S(k): lattices, the ideal gas, and the definitions word by word.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::{PI, TAU};

use meniscus::observables::radial_distribution::{MOST_BINS, RadialDistribution};
use meniscus::observables::structure_factor::{MOST_SHELLS, StructureFactor, WAVES_PER_SHELL};
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::reference::minimum_image;
use meniscus_tests::states::{in_radii, lattice, scattered, separated};

fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

/// Distances of all pairs in binary64.
fn distances(positions: &[Position], side: f64) -> Vec<f64> {
    let places = in_radii(positions, side);
    let pairs = (0..places.len()).flat_map(|first| (0..first).map(move |second| (first, second)));
    pairs
        .map(|(first, second)| {
            let along = |axis: usize| minimum_image(places[first][axis] - places[second][axis], side);
            libm::hypot(along(0), along(1))
        })
        .collect()
}

#[test]
fn pairs_are_counted_as_defined() {
    // To half a box, over borders, with bins whose borders are no binary fractions.
    for (side, largest, width) in
        [(40.0, 20.0, 0.1), (100.0, 33.3, 1.7), (64.0, 10.0, 10.0), (50.0, 6.0, 0.7)]
    {
        let positions = separated(7, 150, side, 2.0);
        let bins = RadialDistribution::new(&torus(side), largest, width).unwrap().of(&positions);
        let distances = distances(&positions, side);
        let count = positions.len() as f64;
        for (number, bin) in bins.iter().enumerate() {
            let (from, to) = (width * number as f64, width * (number + 1) as f64);
            let pairs = distances.iter().filter(|distance| (from..to).contains(*distance)).count();
            assert_eq!(bin.pairs, pairs as u64, "{from} to {to}");
            let expected = 0.5 * count * (count - 1.0) * PI * (to * to - from * from) / (side * side);
            assert!((bin.g - pairs as f64 / expected).abs() <= 1e-9 * bin.g, "{from} to {to}");
            assert!((bin.distance - 0.5 * (from + to)).abs() < 1e-12 * to);
        }
        assert_eq!(bins.len(), (largest / width * (1.0 + 1e-9)) as usize);
    }
}

#[test]
fn neighbours_of_a_lattice_are_at_its_distances() {
    // Spacing 4 R0: a disc has 4 neighbours at 4, 4 at 5.66, 4 at 8, 8 at 8.94 R0.
    let positions = lattice(16);
    let bins = RadialDistribution::new(&torus(64.0), 10.0, 0.5).unwrap().of(&positions);
    let neighbours: Vec<u64> = bins.iter().map(|bin| 2 * bin.pairs / 256).collect();
    let mut expected = vec![0; 20];
    for (distance, count) in [(4.0, 4), (5.66, 4), (8.0, 4), (8.94, 8)] {
        expected[(distance / 0.5) as usize] += count;
    }
    assert_eq!(neighbours, expected);
}

#[test]
fn an_ideal_gas_has_a_radial_distribution_of_one() {
    // Few discs, of which N − 1 and N are not the same.
    let mut pairs = [0_u64; 6];
    let (runs, mut expected) = (400, [0.0; 6]);
    for seed in 0..runs {
        let bins = RadialDistribution::new(&torus(100.0), 48.0, 8.0).unwrap().of(&scattered(seed, 12));
        for (bin, (pairs, expected)) in bins.iter().zip(pairs.iter_mut().zip(&mut expected)) {
            *pairs += bin.pairs;
            *expected += if bin.g > 0.0 { bin.pairs as f64 / bin.g } else { 0.0 };
        }
    }
    for (bin, pairs) in pairs.into_iter().enumerate() {
        let area = PI * 64.0 * (2.0 * bin as f64 + 1.0);
        let expected = runs as f64 * 66.0 * area / 10_000.0;
        let score = (pairs as f64 - expected) / expected.sqrt();
        assert!(score.abs() < 4.0, "bin {bin}: {score} standard errors from 1");
    }
    // With N in the place of N − 1, the last bin would be 9 % of 4000 pairs, 6 standard errors, too low.
    assert!(pairs[5] > 3500);
}

#[test]
fn fewer_than_two_discs_have_no_pairs() {
    for count in [0, 1] {
        let bins = RadialDistribution::new(&torus(100.0), 10.0, 1.0).unwrap().of(&scattered(1, count));
        assert!(bins.iter().all(|bin| bin.g == 0.0 && bin.pairs == 0));
    }
}

#[test]
fn bins_that_make_no_sense_are_refused() {
    let refusal = |largest, width| {
        RadialDistribution::new(&torus(100.0), largest, width).err().map(|error| error.to_string())
    };
    assert_eq!(
        refusal(50.5, 0.1).unwrap(),
        "distances up to 50.5 R0 were asked for: take more than 0 and at most L/2 = 50 R0"
    );
    assert_eq!(
        refusal(10.0, 11.0).unwrap(),
        format!(
            "bins 11 R0 wide were asked for: take a width from {} R0 to the largest distance, 10 R0",
            10.0 / MOST_BINS as f64
        )
    );
    for (largest, width) in
        [(0.0, 0.1), (-1.0, 0.1), (f64::NAN, 0.1), (10.0, 0.0), (10.0, f64::NAN), (10.0, 1e-9)]
    {
        assert!(refusal(largest, width).is_some(), "{largest} {width}");
    }
    assert_eq!(refusal(50.0, 50.0), None);
}

#[test]
fn bragg_peaks_of_a_lattice_are_where_they_should_be() {
    // Spacing 5 R0, shells of 2π/80 R0⁻¹: Bragg waves are (16, 0), (0, 16), (16, ±16) (shell 23), (32, 0), (0, 32).
    let positions = lattice(16);
    let shells = StructureFactor::new(&torus(80.0), 2.7, usize::MAX).unwrap().of(&positions);
    assert_eq!(shells.len(), 34);
    for shell in &shells {
        let peaks = if [16, 23, 32].contains(&shell.shell) { 2.0 } else { 0.0 };
        // Waves of a shell, one of each pair: half of the points of an annulus, πn.
        let total = shell.structure_factor * PI * f64::from(shell.shell);
        assert!((total - 256.0 * peaks).abs() < 0.15 * 256.0 * peaks + 1e-9, "{shell:?}");
        assert!((shell.wavenumber - TAU / 80.0 * f64::from(shell.shell)).abs() < 0.25 * TAU / 80.0);
    }
}

#[test]
fn an_ideal_gas_has_a_structure_factor_of_one() {
    let structure = StructureFactor::new(&torus(100.0), 4.0, WAVES_PER_SHELL).unwrap();
    let shells = structure.of(&scattered(3, 500));
    let mean = shells.iter().map(|shell| shell.structure_factor).sum::<f64>() / shells.len() as f64;
    // Waves scatter by their mean, 1; all but the lowest shells have 100.
    let error = 1.0 / (WAVES_PER_SHELL as f64 * shells.len() as f64).sqrt();
    assert!((mean - 1.0).abs() < 4.0 * error, "{mean} ± {error}");
}

#[test]
fn separate_discs_have_a_hole_at_long_waves_and_one_at_short_ones() {
    let positions = separated(5, 600, 62.0, 2.0);
    let shells = StructureFactor::new(&torus(62.0), 40.0, 30).unwrap().of(&positions);
    let mean = |range: core::ops::Range<f64>| {
        let values: Vec<f64> = (shells.iter().filter(|shell| range.contains(&shell.wavenumber)))
            .map(|shell| shell.structure_factor)
            .collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    assert!(mean(0.1..1.0) < 0.3);
    assert!(mean(3.0..3.5) > 1.3);
    assert!((mean(30.0..40.0) - 1.0).abs() < 0.1);
}

#[test]
fn wavenumbers_that_make_no_sense_are_refused() {
    let refusal =
        |largest, most| StructureFactor::new(&torus(100.0), largest, most).err().map(|e| e.to_string());
    assert_eq!(
        refusal(0.06, 10).unwrap(),
        format!(
            "a structure factor up to k = 0.06 R0^-1 was asked for: the longest wave of the box has k = {} R0^-1, take \
             k from there to {MOST_SHELLS} times that",
            TAU / 100.0
        )
    );
    assert_eq!(
        refusal(1.0, 0).unwrap(),
        "a structure factor of 0 waves a shell was asked for: take at least 1"
    );
    for largest in [f64::NAN, -1.0, f64::INFINITY, 1e9] {
        assert!(refusal(largest, 10).is_some(), "{largest}");
    }
    assert!(StructureFactor::new(&torus(100.0), 1.0, 10).unwrap().of(&[]).is_empty());
}
