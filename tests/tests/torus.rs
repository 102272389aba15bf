//! Positions on the torus: fixed point, wrap, minimum image, crossings.

use meniscus_core::ermak::displace;
use meniscus_core::torus::{Fraction, LARGEST_SIDE, SMALLEST_SIDE, Torus, TorusError, minimum_image};
use proptest::prelude::*;

fn sides() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(64.0),
        Just(LARGEST_SIDE),
        Just(f64::from_bits(4.5_f64.to_bits() + 1)),
        Just(SMALLEST_SIDE),
        4.5..LARGEST_SIDE
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_coordinate_comes_back_as_the_same_bits(side in sides(), bits in any::<u32>()) {
        let torus = Torus::new(side).unwrap();
        let fraction = Fraction::from_bits(bits);
        prop_assert_eq!(torus.fraction(torus.coordinate(fraction)), Ok(fraction));
    }

    #[test]
    fn a_coordinate_is_held_to_half_a_unit(side in sides(), share in 0.0..1.0_f64) {
        let torus = Torus::new(side).unwrap();
        let coordinate = (side * share).min(side.next_down());
        let fraction = torus.fraction(coordinate).unwrap();
        let unit = side / 4_294_967_296.0;
        let off = (torus.coordinate(fraction) - coordinate).abs();
        // Within half a unit of the border the nearest position is the origin.
        let off = off.min(side - off);
        prop_assert!(off <= unit * 0.5 * (1.0 + 1e-6), "off by {} units", off / unit);
    }

    #[test]
    fn wrapping_by_whole_boxes_changes_nothing(bits in any::<u32>(), boxes in -1000_i32..1000) {
        // A side that is a power of two: adding boxes is exact in binary64.
        let torus = Torus::new(64.0).unwrap();
        let fraction = Fraction::from_bits(bits);
        let coordinate = torus.coordinate(fraction) + 64.0 * f64::from(boxes);
        prop_assert_eq!(torus.wrapped_fraction(coordinate), fraction);
    }

    #[test]
    fn wrapped_and_plain_fractions_agree_inside_the_box(side in sides(), share in 0.0..1.0_f64) {
        let torus = Torus::new(side).unwrap();
        let coordinate = (side * share).min(side.next_down());
        prop_assert_eq!(torus.fraction(coordinate), Ok(torus.wrapped_fraction(coordinate)));
    }

    #[test]
    fn the_minimum_image_is_antisymmetric(to in any::<u32>(), from in any::<u32>()) {
        let (to, from) = (Fraction::from_bits(to), Fraction::from_bits(from));
        // Half a box is its own negative.
        prop_assert_eq!(minimum_image(to, from), minimum_image(from, to).wrapping_neg());
    }

    #[test]
    fn the_minimum_image_leads_back(to in any::<u32>(), from in any::<u32>()) {
        let separation = minimum_image(Fraction::from_bits(to), Fraction::from_bits(from));
        prop_assert_eq!(from.wrapping_add_signed(separation), to);
    }

    #[test]
    fn the_minimum_image_is_the_nearest_of_all_images(to in any::<u32>(), from in any::<u32>()) {
        let separation = i64::from(minimum_image(Fraction::from_bits(to), Fraction::from_bits(from)));
        let plain = i64::from(to) - i64::from(from);
        let nearest = (-2..=2).map(|boxes| (plain + (boxes << 32)).abs()).min().unwrap();
        prop_assert_eq!(separation.abs(), nearest);
    }

    #[test]
    fn the_minimum_image_does_not_see_a_shift(to in any::<u32>(), from in any::<u32>(), shift in any::<u32>()) {
        let separation = |by: u32| {
            minimum_image(Fraction::from_bits(to.wrapping_add(by)), Fraction::from_bits(from.wrapping_add(by)))
        };
        prop_assert_eq!(separation(shift), separation(0));
    }

    #[test]
    fn crossings_and_position_hold_the_whole_path(
        start in any::<u32>(),
        moves in prop::collection::vec(-i32::MAX..=i32::MAX, 1..100),
    ) {
        let mut coordinate = Fraction::from_bits(start);
        let mut crossings = 0;
        let mut path = i64::from(start);
        for units in moves {
            displace(&mut coordinate, &mut crossings, units);
            path += i64::from(units);
            prop_assert_eq!(i64::from(coordinate.to_bits()) + (i64::from(crossings) << 32), path);
        }
    }
}

#[test]
fn exactly_half_a_box_is_the_most_negative_number_both_ways() {
    let (origin, half) = (Fraction::from_bits(0), Fraction::from_bits(1 << 31));
    assert_eq!(minimum_image(origin, half), i32::MIN);
    assert_eq!(minimum_image(half, origin), i32::MIN);
}

#[test]
fn a_border_is_crossed_by_a_single_unit() {
    let (mut coordinate, mut crossings) = (Fraction::from_bits(u32::MAX), 0);
    displace(&mut coordinate, &mut crossings, 1);
    assert_eq!((coordinate.to_bits(), crossings), (0, 1));
    displace(&mut coordinate, &mut crossings, -1);
    assert_eq!((coordinate.to_bits(), crossings), (u32::MAX, 0));
}

#[test]
fn the_end_of_the_box_is_the_origin() {
    let torus = Torus::new(500.0).unwrap();
    assert_eq!(torus.fraction(500.0_f64.next_down()), Ok(Fraction::from_bits(0)));
}

#[test]
fn coordinates_outside_the_box_are_refused() {
    let torus = Torus::new(500.0).unwrap();
    for coordinate in [-1e-300, -1.0, 500.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(torus.fraction(coordinate), Err(TorusError::Coordinate), "{coordinate}");
    }
    assert_eq!(torus.fraction(-0.0), Ok(Fraction::from_bits(0)));
}

#[test]
fn numbers_that_are_not_finite_wrap_to_the_origin() {
    let torus = Torus::new(500.0).unwrap();
    for coordinate in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(torus.wrapped_fraction(coordinate), Fraction::from_bits(0), "{coordinate}");
    }
}

#[test]
fn sides_that_are_no_side_are_refused() {
    let least = SMALLEST_SIDE.next_down();
    for side in [0.0, -0.0, -1.0, least, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Torus::new(side), Err(TorusError::Side), "{side}");
    }
    assert_eq!(Torus::new(LARGEST_SIDE).map(|torus| torus.side()), Ok(65536.0));
    assert_eq!(Torus::new(LARGEST_SIDE.next_up()), Err(TorusError::SideTooLarge));
}
