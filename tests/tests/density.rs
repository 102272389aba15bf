//! The density on a grid: nothing is lost, and it is what the definition of the clouds says.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use meniscus::observables::density::{CLOSE_PACKING, Density, DensityError, LARGEST_GRID};
use meniscus_core::torus::{Position, Torus};
use meniscus_tests::tolerances;
use proptest::prelude::*;

/// Order 3 in one dimension at a distance in cells: a box of one cell, smeared twice over one cell.
fn triangular_shaped_cloud(distance: f64) -> f64 {
    match distance.abs() {
        near if near <= 0.5 => 0.75 - near * near,
        far if far <= 1.5 => 0.5 * (1.5 - far) * (1.5 - far),
        _ => 0.0,
    }
}

/// The density at every node by the definition, all discs and some of their images.
fn by_definition(torus: &Torus, positions: &[Position], grid: usize) -> Vec<f64> {
    let spacing = torus.side() / grid as f64;
    let weight = |node: usize, coordinate: f64| -> f64 {
        (-1..=1)
            .map(|image| node as f64 - (coordinate + f64::from(image) * torus.side()) / spacing)
            .map(triangular_shaped_cloud)
            .sum()
    };
    let discs: Vec<_> = positions.iter().map(|at| (torus.coordinate(at.x), torus.coordinate(at.y))).collect();
    (0..grid * grid)
        .map(|node| discs.iter().map(|(x, y)| weight(node / grid, *x) * weight(node % grid, *y)).sum::<f64>())
        .map(|mass| mass / (spacing * spacing))
        .collect()
}

fn any_discs() -> impl Strategy<Value = Vec<Position>> {
    prop::collection::vec(any::<(u32, u32)>().prop_map(|(x, y)| Position::from_bits(x, y)), 0..60)
}

/// Spacings that give grids of 3 to some 40 nodes.
fn any_box() -> impl Strategy<Value = (Torus, f64)> {
    (2.0..700.0_f64, 0.025..2.0_f64).prop_map(|(side, share)| (Torus::new(side).unwrap(), side * share))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_density_is_that_of_the_definition((torus, spacing) in any_box(), discs in any_discs()) {
        let density = Density::new(&torus, &discs, spacing).unwrap();
        let grid = density.grid();
        prop_assert_eq!(grid, ((torus.side() / spacing).round() as usize).max(3));
        let cell = density.spacing() * density.spacing();
        for (found, wanted) in density.values().iter().zip(by_definition(&torus, &discs, grid)) {
            let largest = discs.len() as f64 * tolerances::CLOUD_SHARE;
            prop_assert!((found - wanted).abs() * cell <= largest, "{} for {}", found, wanted);
        }
    }

    #[test]
    fn the_total_is_the_number_of_discs((torus, spacing) in any_box(), discs in any_discs()) {
        let density = Density::new(&torus, &discs, spacing).unwrap();
        let total = density.values().iter().sum::<f64>() * density.spacing() * density.spacing();
        let count = discs.len() as f64;
        prop_assert!((total - count).abs() <= count * tolerances::DENSITY_TOTAL, "{} of {}", total, count);
    }

    #[test]
    fn the_order_of_discs_does_not_show((torus, spacing) in any_box(), mut discs in any_discs()) {
        let density = Density::new(&torus, &discs, spacing).unwrap();
        discs.reverse();
        prop_assert_eq!(Density::new(&torus, &discs, spacing).unwrap(), density);
    }

    #[test]
    fn turned_discs_have_a_turned_density((torus, spacing) in any_box(), discs in any_discs()) {
        let turned: Vec<_> = discs.iter().map(|at| Position { x: at.y, y: at.x }).collect();
        let (density, turned) =
            (Density::new(&torus, &discs, spacing).unwrap(), Density::new(&torus, &turned, spacing).unwrap());
        let grid = density.grid();
        for node in 0..grid * grid {
            prop_assert_eq!(density.values()[node], turned.values()[node % grid * grid + node / grid]);
        }
    }

    #[test]
    fn discs_moved_by_whole_cells_move_their_density(discs in any_discs(), moved in 0_u32..16) {
        let torus = Torus::new(80.0).unwrap();
        // Cells of 2²⁸ units exactly.
        let shifted: Vec<_> =
            discs.iter().map(|at| Position::from_bits(at.x.to_bits().wrapping_add(moved << 28), at.y.to_bits())).collect();
        let at_rest = Density::new(&torus, &discs, 5.0).unwrap();
        let shifted = Density::new(&torus, &shifted, 5.0).unwrap();
        let mut wanted = at_rest.values().to_vec();
        wanted.rotate_right(moved as usize * 16);
        prop_assert_eq!(shifted.values(), wanted);
    }
}

#[test]
fn a_disc_on_a_node_has_nine_shares() {
    let torus = Torus::new(12.0).unwrap();
    let density = Density::new(&torus, &[Position::from_bits(1 << 30, 0)], 3.0).unwrap();
    // The disc is at (3, 0), on node (1, 0); 1/8, 3/4 and 1/8 along each axis, over cells of 9 R0².
    let (middle, side, corner) = (36.0 / 64.0 / 9.0, 6.0 / 64.0 / 9.0, 1.0 / 64.0 / 9.0);
    #[rustfmt::skip]
    let wanted = [
        side,   corner, 0.0, corner,
        middle, side,   0.0, side,
        side,   corner, 0.0, corner,
        0.0,    0.0,    0.0, 0.0,
    ];
    assert_eq!(density.values(), wanted);
    assert_eq!((density.grid(), density.spacing()), (4, 3.0));
}

#[test]
fn a_square_goes_around_anticlockwise_and_over_the_border() {
    let torus = Torus::new(3.0).unwrap();
    let density = Density::from_values(&torus, (0..9).map(f64::from).collect()).unwrap();
    let squares: Vec<_> = density.squares().collect();
    assert_eq!(squares.len(), 9);
    // Element x·n + y: along x comes 3 after 0, along y comes 1.
    assert_eq!(squares[0], [0.0, 3.0, 4.0, 1.0]);
    assert_eq!(squares[8], [8.0, 2.0, 0.0, 6.0]);
}

#[test]
fn table_1_has_94_nodes_along_a_side_and_29_times_less_than_close_packing() {
    let torus = Torus::new(500.0).unwrap();
    assert_eq!(Density::new(&torus, &[], 5.3).unwrap().grid(), 94);
    assert!((CLOSE_PACKING - 0.5 / 3.0_f64.sqrt()).abs() < 1e-16);
    assert!((CLOSE_PACKING / 0.01 - 29.0).abs() < 0.2);
}

#[test]
fn what_is_no_density_is_refused_with_the_remedy() {
    let torus = Torus::new(500.0).unwrap();
    let spacing = |spacing| Density::new(&torus, &[], spacing).unwrap_err().to_string();
    for bad in [0.0, -5.3, f64::NAN, f64::INFINITY] {
        let message = format!("spacing of the density's grid is {bad}; it has to be a positive number of R0");
        assert_eq!(spacing(bad), message);
    }
    assert_eq!(
        spacing(0.01),
        "spacing of the density's grid is 0.01 R0 in a box of 500 R0; at most 16384 nodes fit along a side: take a \
         larger spacing"
    );
    assert!(matches!(Density::new(&torus, &[], 1e-300), Err(DensityError::TooFine { .. })));
    let values = |values| Density::from_values(&torus, values).unwrap_err();
    for count in [0, 1, 4, 8, 10, 15] {
        assert_eq!(values(vec![0.0; count]), DensityError::Values(count));
    }
    assert_eq!(values(vec![0.0, 0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), DensityError::NotFinite(2));
    // The largest box at the paper's spacing.
    assert!(65536.0 / 5.3 < LARGEST_GRID as f64);
}
