//! Mass assignment: what a disc leaves on the mesh and what it takes from it.

use meniscus_core::assignment::{Crowded, DISC, LARGEST_NODE_MASS, deposit, gather};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::Complex32;
use meniscus_tests::states::{coordinates, crowded, scattered, shuffled};
use meniscus_tests::tolerances::CENTRE_OF_MASS;
use proptest::prelude::*;

const ASSIGNMENTS: [Assignment; 2] = [Assignment::CloudInCell, Assignment::TriangularShapedCloud];

fn assignments() -> impl Strategy<Value = Assignment> {
    prop::sample::select(&ASSIGNMENTS[..])
}

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn nodes_of(assignment: Assignment, grid: usize, discs: &[Position]) -> Result<Vec<u32>, Crowded> {
    let mesh = Grid::new(grid).unwrap();
    let (x, y) = coordinates(discs);
    let mut nodes = vec![7; grid * grid];
    deposit(assignment, mesh, &x, &y, &mut nodes)?;
    Ok(nodes)
}

/// Coordinates that random bits hardly ever hit: on a node, half way between two, and one unit beside.
fn coordinate() -> impl Strategy<Value = u32> {
    let special = (0_u32..8192, -2_i32..=2).prop_map(|(half_cells, beside)| {
        // A half cell of the finest mesh; coarser meshes see their own nodes and middles among them.
        (half_cells << 19).wrapping_add_signed(beside)
    });
    prop_oneof![any::<u32>(), special]
}

fn exponents() -> impl Strategy<Value = u32> {
    // The finest meshes cost most: they are drawn less often.
    prop_oneof![6 => 4_u32..=8, 1 => 9_u32..=10]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_disc_leaves_exactly_one_disc_of_mass(
        assignment in assignments(),
        exponent in exponents(),
        x in coordinate(),
        y in coordinate(),
    ) {
        let nodes = nodes_of(assignment, 1 << exponent, &[Position::from_bits(x, y)]).unwrap();
        prop_assert_eq!(nodes.iter().map(|&mass| u64::from(mass)).sum::<u64>(), u64::from(DISC));
    }

    #[test]
    fn total_mass_is_exact(
        assignment in assignments(),
        exponent in 4_u32..=6,
        bits in prop::collection::vec((coordinate(), coordinate()), 1..60),
    ) {
        let discs: Vec<Position> = bits.iter().map(|&(x, y)| Position::from_bits(x, y)).collect();
        let nodes = nodes_of(assignment, 1 << exponent, &discs).unwrap();
        let total: u64 = nodes.iter().map(|&mass| u64::from(mass)).sum();
        prop_assert_eq!(total, u64::from(DISC) * discs.len() as u64);
    }

    #[test]
    fn centre_of_mass_is_where_the_disc_is(
        assignment in assignments(),
        exponent in 4_u32..=7,
        x in coordinate(),
        y in coordinate(),
    ) {
        let grid = 1_usize << exponent;
        let nodes = nodes_of(assignment, grid, &[Position::from_bits(x, y)]).unwrap();
        let cell = (1_u64 << 32) as f64 / grid as f64;
        let (mut along_x, mut along_y) = (0.0, 0.0);
        for (element, &mass) in nodes.iter().enumerate() {
            let weight = f64::from(mass) / f64::from(DISC);
            let (node_x, node_y) = ((element / grid) as u32, (element % grid) as u32);
            // Node minus disc at the nearest image, in cells.
            let distance = |node: u32, bits: u32| f64::from((node << (32 - exponent)).wrapping_sub(bits) as i32);
            along_x += weight * distance(node_x, x) / cell;
            along_y += weight * distance(node_y, y) / cell;
        }
        prop_assert!(along_x.abs() <= CENTRE_OF_MASS && along_y.abs() <= CENTRE_OF_MASS, "{along_x} {along_y}");
    }

    #[test]
    fn weights_are_the_products_of_b_splines(
        assignment in assignments(),
        exponent in 4_u32..=6,
        x in coordinate(),
        y in coordinate(),
    ) {
        let grid = 1_usize << exponent;
        let nodes = nodes_of(assignment, grid, &[Position::from_bits(x, y)]).unwrap();
        let cell = (1_u64 << 32) as f64 / grid as f64;
        // Hockney and Eastwood's W, of a distance in cells.
        let spline = |distance: f64| match assignment {
            Assignment::CloudInCell => (1.0 - distance).max(0.0),
            Assignment::TriangularShapedCloud if distance <= 0.5 => 0.75 - distance * distance,
            Assignment::TriangularShapedCloud => 0.5 * (1.5 - distance).max(0.0) * (1.5 - distance).max(0.0),
        };
        let (mut corrected, mut largest) = (None, 0.0_f64);
        for (element, &mass) in nodes.iter().enumerate() {
            let (node_x, node_y) = ((element / grid) as u32, (element % grid) as u32);
            let weight = |node: u32, bits: u32| {
                spline(f64::from((node << (32 - exponent)).wrapping_sub(bits) as i32).abs() / cell)
            };
            let exact = weight(node_x, x) * weight(node_y, y) * f64::from(DISC);
            // Half a unit for the rounding of the product, a little for that of its factors (unit 2⁻³⁰).
            if (f64::from(mass) - exact).abs() > 0.51 {
                prop_assert!(corrected.is_none(), "a second node that takes the remainder");
                prop_assert!((f64::from(mass) - exact).abs() <= 4.51, "{mass} for {exact}");
                corrected = Some(exact);
            }
            largest = largest.max(exact);
        }
        // The nearest node takes the remainder: none has more than it.
        prop_assert!(corrected.is_none_or(|exact| exact > largest - 1.0), "{corrected:?} of {largest}");
    }

    #[test]
    fn a_constant_field_is_gathered_as_it_is(
        assignment in assignments(),
        exponent in 4_u32..=6,
        x in coordinate(),
        y in coordinate(),
        (along_x, along_y) in (-1000_i32..1000, -1000_i32..1000),
    ) {
        let grid = 1_usize << exponent;
        let field = vec![Complex32::new(along_x as f32, along_y as f32); grid * grid];
        let (mut force_x, mut force_y) = ([0], [0]);
        let (x, y) = ([Fraction::from_bits(x)], [Fraction::from_bits(y)]);
        gather(assignment, Grid::new(grid).unwrap(), (&x, &y), &field, (&mut force_x, &mut force_y));
        // Weights sum to 2²⁰ exactly; up to 9 sums below 1000 · 2²⁰ are rounded to 24 bits, 2⁶, and scaled by 2⁴.
        let bound = f64::from(9 * (1 << 6) * (1 << 4));
        prop_assert!((force_x[0] as f64 - f64::from(along_x) * 16_777_216.0).abs() <= bound);
        prop_assert!((force_y[0] as f64 - f64::from(along_y) * 16_777_216.0).abs() <= bound);
    }
}

#[test]
fn every_mesh_from_16_to_4096_keeps_the_mass_of_scattered_discs() {
    let discs = scattered(1, 500);
    for exponent in 4..=12 {
        for assignment in ASSIGNMENTS {
            let nodes = nodes_of(assignment, 1 << exponent, &discs).unwrap();
            let total: u64 = nodes.iter().map(|&mass| u64::from(mass)).sum();
            assert_eq!(total, 500 * u64::from(DISC), "{assignment:?} on {} nodes a side", 1 << exponent);
        }
    }
}

#[test]
fn deposit_does_not_depend_on_storage_order() {
    let discs = crowded(2, 300, 0.3);
    for assignment in ASSIGNMENTS {
        let nodes = nodes_of(assignment, 32, &discs).unwrap();
        for seed in 0..10 {
            assert_eq!(nodes_of(assignment, 32, &shuffled(seed, &discs)).unwrap(), nodes);
        }
    }
}

#[test]
fn gather_does_not_depend_on_storage_order() {
    let discs = scattered(3, 100);
    let field: Vec<Complex32> = scattered(4, 32 * 32)
        .iter()
        .map(|bits| Complex32::new(bits.x.to_bits() as i32 as f32, bits.y.to_bits() as i32 as f32 * 1e-9))
        .collect();
    for assignment in ASSIGNMENTS {
        let gathered = |discs: &[Position]| {
            let (x, y) = coordinates(discs);
            let (mut force_x, mut force_y) = (vec![0; discs.len()], vec![0; discs.len()]);
            gather(assignment, Grid::new(32).unwrap(), (&x, &y), &field, (&mut force_x, &mut force_y));
            force_x.into_iter().zip(force_y).collect::<Vec<_>>()
        };
        let in_order = gathered(&discs);
        let order = shuffled(5, &(0..100).collect::<Vec<usize>>());
        let mixed: Vec<Position> = order.iter().map(|&index| discs[index]).collect();
        let expected: Vec<_> = order.iter().map(|&index| in_order[index]).collect();
        assert_eq!(gathered(&mixed), expected);
    }
}

#[test]
fn a_node_holds_4095_discs_and_not_one_more() {
    let on_a_node = Position::from_bits(3 << 28, 5 << 28);
    let full = vec![on_a_node; LARGEST_NODE_MASS as usize];
    let nodes = nodes_of(Assignment::CloudInCell, 16, &full).unwrap();
    assert_eq!(nodes[3 * 16 + 5], LARGEST_NODE_MASS * DISC);
    let crowded = vec![on_a_node; LARGEST_NODE_MASS as usize + 1];
    assert_eq!(nodes_of(Assignment::CloudInCell, 16, &crowded), Err(Crowded));
}

#[test]
fn a_node_holds_4095_discs_and_not_one_unit_of_mass_more() {
    let mut discs = vec![Position::from_bits(0, 0); LARGEST_NODE_MASS as usize];
    // A disc so near the next node that none or one unit of 2⁻²⁰ discs is left for this one.
    for (distance_to_next, unit) in [((1 << 7) - 1, 0), (1 << 8, 1)] {
        let nearly_one_cell = Position::from_bits((1 << 28) - distance_to_next, 0);
        assert_eq!(nodes_of(Assignment::CloudInCell, 16, &[nearly_one_cell]).unwrap()[0], unit);
        discs.push(nearly_one_cell);
        assert_eq!(nodes_of(Assignment::CloudInCell, 16, &discs).is_ok(), unit == 0);
    }
}

#[test]
fn a_quadratic_cloud_crowds_its_node_later() {
    // The central weight is (3/4)², 589 824 units; 4095 · 2²⁰ units are 7280 of them.
    let on_a_node = Position::from_bits(0, 0);
    let nodes = nodes_of(Assignment::TriangularShapedCloud, 16, &vec![on_a_node; 7280]).unwrap();
    assert_eq!(nodes[0], 7280 * 589_824);
    assert_eq!(nodes_of(Assignment::TriangularShapedCloud, 16, &vec![on_a_node; 7281]), Err(Crowded));
}

#[test]
fn a_crowd_far_beyond_the_range_of_a_node_is_still_refused() {
    // 2¹³ discs would wrap a sum of 32 bits to zero.
    let crowded = vec![Position::from_bits(0, 0); 1 << 13];
    assert_eq!(nodes_of(Assignment::CloudInCell, 16, &crowded), Err(Crowded));
}
