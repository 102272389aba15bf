//! Initial states: what each promises, and the bits of those that are random.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use meniscus::files::csv;
use meniscus::observables::neighbours::{closest_pair, squared_distance};
use meniscus::start::{self, StartError};
use meniscus_core::digest::State;
use meniscus_core::torus::{Fraction, Position, Torus};
use proptest::prelude::*;

fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

/// The distance of a disc from the centre of the box, R0.
fn from_centre(torus: &Torus, position: Position) -> f64 {
    let half = torus.side() / 2.0;
    libm::hypot(torus.coordinate(position.x) - half, torus.coordinate(position.y) - half)
}

/// The smallest squared distance, all pairs tried.
fn closest_square(positions: &[Position]) -> Option<u64> {
    let later = |first: usize| positions[first + 1..].iter();
    (0..positions.len())
        .flat_map(|first| later(first).map(move |second| squared_distance(positions[first], *second)))
        .min()
}

/// The square of 2 R0 in units of position, rounded up.
fn contact_square(torus: &Torus) -> u64 {
    let units = 2.0 / torus.side() * 4294967296.0;
    libm::ceil(units * units) as u64
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn random_discs_never_overlap(seed in any::<u64>(), side in 20.0..300.0_f64, coverage in 0.0..0.4_f64) {
        let count = (coverage * side * side / core::f64::consts::PI) as usize;
        prop_assume!(count <= 2000);
        let torus = torus(side);
        let positions = start::random(&torus, count, seed).unwrap();
        prop_assert_eq!(positions.len(), count);
        prop_assert!(closest_square(&positions).is_none_or(|square| square >= contact_square(&torus)));
    }

    #[test]
    fn discs_of_a_patch_stay_in_it_and_never_overlap(seed in any::<u64>(), radius in 1.0..100.0_f64) {
        let torus = torus(200.0);
        let count = (0.3 * radius * radius) as usize;
        let positions = start::disc(&torus, count, radius, seed).unwrap();
        prop_assert_eq!(positions.len(), count);
        prop_assert!(positions.iter().all(|position| from_centre(&torus, *position) <= radius));
        prop_assert!(closest_square(&positions).is_none_or(|square| square >= contact_square(&torus)));
    }

    #[test]
    fn the_closest_pair_is_that_of_all_pairs(
        bits in prop::collection::vec(any::<(u32, u32)>(), 0..60),
        shift in 0..31_u32,
        side in 0.01..60000.0_f64,
    ) {
        let positions: Vec<Position> =
            bits.iter().map(|(x, y)| Position::from_bits(x >> shift, y.wrapping_shl(shift))).collect();
        let expected = closest_square(&positions)
            .map(|square| libm::sqrt(square as f64) * (side / 4294967296.0));
        prop_assert_eq!(closest_pair(&torus(side), &positions), expected);
    }

    #[test]
    fn rings_have_their_radii_and_equal_angles(
        rings in 0..8_u32, per_ring in 1..12_u32, spacing in 0.5..50.0_f64,
    ) {
        let torus = torus(1000.0);
        let positions = start::rings(&torus, rings, per_ring, spacing).unwrap();
        let unit = torus.side() / 4294967296.0;
        prop_assert_eq!(positions.len() as u32, 1 + per_ring * rings * (rings + 1) / 2);
        prop_assert_eq!(positions[0], Position::from_bits(1 << 31, 1 << 31));
        let mut id = 1;
        for ring in 1..=rings {
            let radius = spacing * f64::from(ring);
            for disc in 0..per_ring * ring {
                let position = positions[id];
                prop_assert!((from_centre(&torus, position) - radius).abs() < unit);
                let angle = core::f64::consts::TAU * f64::from(disc) / f64::from(per_ring * ring);
                let x = 500.0 + radius * libm::cos(angle);
                let y = 500.0 + radius * libm::sin(angle);
                prop_assert!((torus.coordinate(position.x) - x).abs() < unit);
                prop_assert!((torus.coordinate(position.y) - y).abs() < unit);
                id += 1;
            }
        }
    }

    #[test]
    fn hexagonal_sites_are_apart_across_the_border_too(count in 1..3000_usize) {
        let torus = torus(100.0);
        let hexagonal = start::hexagonal_lattice(count).unwrap();
        prop_assert_eq!(hexagonal.len(), count);
        // Nearly the distance of the densest lattice, and far from a row falling onto another.
        let densest = 100.0 * libm::sqrt(2.0 / libm::sqrt(3.0) / count as f64);
        let least = if count < 30 { 0.5 } else { 0.8 };
        prop_assert!(closest_pair(&torus, &hexagonal).is_none_or(|distance| distance > least * densest));
    }
}

/// SHA-256 of the canonical bytes of discs at step and time 0.
fn digest(positions: Result<Vec<Position>, StartError>) -> String {
    let positions = positions.unwrap();
    let slots: Vec<u32> = (0..positions.len() as u32).collect();
    let (x, y): (Vec<Fraction>, Vec<Fraction>) =
        positions.iter().map(|position| (position.x, position.y)).unzip();
    State { step: 0, time: 0, slots: &slots, x: &x, y: &y, ..State::default() }.digest().to_string()
}

#[test]
fn the_bits_of_starts_are_pinned() {
    // Another version may change them only with a line in the changelog that says why.
    let (table_1, patch) = (torus(500.0), torus(800.0));
    assert_eq!(
        digest(start::random(&table_1, 2500, 1)),
        "620f461a0afe427096cc7cba5a40fc346b80bcbba20919c450a3ebdf18dc2bc7"
    );
    assert_eq!(
        digest(start::disc(&patch, 451, 183.0, 1)),
        "e93c461cdab4e4ed997c6a6ac2addd8fbefbd49fd2e6fd06bb521579755adae1"
    );
    assert_eq!(
        digest(start::rings(&patch, 9, 10, 19.29)),
        "7916ce56642d91e8b5fee56c575f8940b60c61648bf958069da27fb07ff19b64"
    );
    assert_eq!(
        digest(start::square_lattice(2500)),
        "b0d8f16e81e01f7dc39f151f8e637d78667cbab3ed28c93a3876257d72302947"
    );
    assert_eq!(
        digest(start::hexagonal_lattice(2500)),
        "7ab6677dc336d7c16e4d16693a40bf0aa16f59259b930d4ef2586b0395f4cdc4"
    );
}

#[test]
fn random_starts_are_the_beginning_of_larger_ones() {
    let torus = torus(100.0);
    let larger = start::random(&torus, 400, 5).unwrap();
    assert_eq!(start::random(&torus, 399, 5).unwrap(), larger[..399]);
    assert_ne!(start::random(&torus, 399, 6).unwrap(), larger[..399]);
}

#[test]
fn random_discs_are_uniform_over_the_box() {
    let torus = torus(1000.0);
    let positions = start::random(&torus, 10_000, 3).unwrap();
    // χ² of 64 cells: mean 63, standard deviation 11.
    let mut cells = [0_u32; 64];
    for position in &positions {
        cells[((position.x.to_bits() >> 29) * 8 + (position.y.to_bits() >> 29)) as usize] += 1;
    }
    let expected = 10_000.0 / 64.0;
    let deviation = |count: u32| (f64::from(count) - expected) * (f64::from(count) - expected) / expected;
    let chi_squared: f64 = cells.iter().map(|count| deviation(*count)).sum();
    assert!((25.0..110.0).contains(&chi_squared), "χ² = {chi_squared}");
}

#[test]
fn discs_of_a_patch_are_uniform_over_its_area() {
    let torus = torus(800.0);
    let positions = start::disc(&torus, 4000, 300.0, 2).unwrap();
    // Rings of equal area hold equally many; a standard deviation is 28.
    let mut rings = [0_i32; 5];
    for position in &positions {
        let fraction = from_centre(&torus, *position) / 300.0;
        rings[((fraction * fraction * 5.0) as usize).min(4)] += 1;
    }
    assert!(rings.iter().all(|count| (count - 800).abs() < 120), "{rings:?}");
    let mean: f64 = positions.iter().map(|position| torus.coordinate(position.x)).sum::<f64>() / 4000.0;
    assert!((mean - 400.0).abs() < 10.0, "mean x {mean}");
}

#[test]
fn a_hundred_thousand_random_discs_do_not_overlap() {
    let torus = torus(1800.0);
    let positions = start::random(&torus, 100_000, 1).unwrap();
    assert!(closest_pair(&torus, &positions).is_some_and(|distance| distance >= 2.0));
}

#[test]
fn too_many_discs_are_refused_with_the_coverage() {
    let torus = torus(100.0);
    let error = start::random(&torus, 1900, 1).unwrap_err();
    assert!(matches!(
        error,
        StartError::TooDense { wanted: 1900, placed: 1600..1800, attempts: 1_900_000, .. }
    ));
    assert!(error.to_string().contains("0.597"), "{error}");
    let error = start::random(&torus, 3000, 1).unwrap_err();
    assert!(matches!(error, StartError::TooDense { attempts: 0, .. }), "beyond close packing");
    assert!(start::random(&torus, usize::MAX, 1).is_err());
    assert!(start::disc(&torus, 900, 30.0, 1).is_err());
}

#[test]
fn a_coverage_of_one_half_is_reached() {
    let torus = torus(100.0);
    assert_eq!(start::random(&torus, 1592, 1).unwrap().len(), 1592);
}

#[test]
fn boxes_and_patches_without_room_are_refused() {
    assert!(matches!(start::random(&torus(1.9), 1, 1), Err(StartError::BoxTooSmall { .. })));
    for radius in [0.0, -1.0, f64::NAN, 50.1, f64::INFINITY] {
        assert!(matches!(start::disc(&torus(100.0), 1, radius, 1), Err(StartError::PatchRadius { .. })));
    }
    assert_eq!(start::disc(&torus(100.0), 1, 50.0, 1).unwrap().len(), 1);
}

#[test]
fn rings_that_do_not_fit_are_refused() {
    let torus = torus(100.0);
    assert!(matches!(start::rings(&torus, 5, 6, 10.0), Err(StartError::RingsOutside { .. })));
    assert!(start::rings(&torus, 5, 6, 9.99).is_ok());
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(start::rings(&torus, 5, 6, spacing), Err(StartError::RingSpacing { .. })));
    }
    assert!(matches!(start::rings(&torus, 4, u32::MAX, 1.0), Err(StartError::TooMany { .. })));
}

#[test]
fn a_ring_begins_on_the_right_and_goes_round_counter_clockwise() {
    let torus = torus(128.0);
    let positions = start::rings(&torus, 1, 4, 16.0).unwrap();
    let places: Vec<(f64, f64)> =
        positions.iter().map(|disc| (torus.coordinate(disc.x), torus.coordinate(disc.y))).collect();
    assert_eq!(places, [(64.0, 64.0), (80.0, 64.0), (64.0, 80.0), (48.0, 64.0), (64.0, 48.0)]);
}

#[test]
fn a_square_lattice_of_a_power_of_two_is_exactly_regular() {
    let positions = start::square_lattice(64 * 64).unwrap();
    for (id, position) in (0_u32..).zip(&positions) {
        assert_eq!(position.x.to_bits(), (id % 64) * (1 << 26) + (1 << 25));
        assert_eq!(position.y.to_bits(), (id / 64) * (1 << 26) + (1 << 25));
    }
}

#[test]
fn lattices_hold_as_many_discs_as_asked_for() {
    for count in [0, 1, 2, 3, 4, 5, 9, 10, 2499, 2500, 2501] {
        assert_eq!(start::square_lattice(count).unwrap().len(), count);
        assert_eq!(start::hexagonal_lattice(count).unwrap().len(), count);
    }
    // 50 × 50 sites.
    let last = start::square_lattice(2500).unwrap()[2499];
    assert!((torus(500.0).coordinate(last.x) - 495.0).abs() < 1e-6);
    // One more asks for 51 × 51.
    let distance = closest_pair(&torus(500.0), &start::square_lattice(2501).unwrap());
    assert!(distance.is_some_and(|distance| (distance - 500.0 / 51.0).abs() < 1e-6));
    #[cfg(target_pointer_width = "64")]
    assert!(matches!(start::square_lattice(1 << 32), Err(StartError::TooMany { .. })));
}

#[test]
fn a_file_holds_as_many_discs_as_configured_or_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("start.csv");
    let torus = torus(500.0);
    let positions = start::random(&torus, 20, 1).unwrap();
    csv::write(&path, &torus, &positions, &[]).unwrap();
    assert_eq!(start::file(&torus, &path, 20).unwrap().positions, positions);
    let error = start::file(&torus, &path, 21).unwrap_err();
    assert!(matches!(error, StartError::Count { found: 20, wanted: 21, .. }));
    assert!(error.to_string().contains("start.csv"));
}
