//! Mass assignment: what a disc leaves on the mesh and what it takes from it.

use meniscus_core::assignment::{
    Crowded, DISC, LARGEST_NODE_MASS, LARGEST_NODE_STRENGTH, deposit, deposit_strengths, gather,
    gather_strengths,
};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::{Fraction, Position};
use meniscus_core::transform::Complex32;
use meniscus_tests::states::{coordinates, crowded, scattered, shuffled};
use meniscus_tests::tolerances::centre_of_mass;
use proptest::prelude::*;

fn assignments() -> impl Strategy<Value = Assignment> {
    prop::sample::select(&Assignment::ALL[..])
}

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn nodes_of(assignment: Assignment, grid: usize, discs: &[Position]) -> Result<Vec<u32>, Crowded> {
    let mesh = Grid::new(grid).unwrap();
    let (x, y) = coordinates(discs);
    let mut nodes = vec![7; grid * grid];
    deposit(assignment, mesh, &x, &y, &mut nodes)?;
    Ok(nodes)
}

/// Node sums of strengths (unit 2⁻²⁰, either sign).
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn strengths_of(
    assignment: Assignment,
    grid: usize,
    discs: &[Position],
    strengths: &[i32],
) -> Result<Vec<i32>, Crowded> {
    let mesh = Grid::new(grid).unwrap();
    let (x, y) = coordinates(discs);
    let mut nodes = vec![7; grid * grid];
    deposit_strengths(assignment, mesh, (&x, &y), strengths, &mut nodes)?;
    Ok(nodes.into_iter().map(|sum| sum as i32).collect())
}

/// The B-spline of an order at a `distance` (≥ 0) from its middle, in cells: Schoenberg's truncated powers,
/// Σ_k (−1)^k C(P, k) (P/2 − distance − k)₊^(P−1) / (P − 1)!.
fn spline(order: usize, distance: f64) -> f64 {
    let (mut sum, mut binomial) = (0.0, 1.0);
    for k in 0..=order {
        let base = (0.5 * order as f64 - distance - k as f64).max(0.0);
        // base^(P−1)/(P−1)!
        let power: f64 = (1..order).map(|factor| base / factor as f64).product();
        sum += binomial * power;
        binomial *= -((order - k) as f64) / (k + 1) as f64;
    }
    sum
}

/// The exact weight of every node for a disc at (`x`, `y`).
fn exact_weights(assignment: Assignment, grid: usize, (x, y): (u32, u32)) -> Vec<f64> {
    let cell = (1_u64 << 32) as f64 / grid as f64;
    let along = |bits: u32| -> Vec<f64> {
        let node_bits = |node: usize| ((node as u64) << 32) / grid as u64;
        let distance =
            |node: usize| f64::from((node_bits(node) as u32).wrapping_sub(bits) as i32).abs() / cell;
        (0..grid).map(|node| spline(assignment.order(), distance(node))).collect()
    };
    let along_y = along(y);
    along(x).iter().flat_map(|weight| along_y.iter().map(move |other| weight * other)).collect()
}

/// How far a weight may be off, in units of 2⁻²⁰: half for its own rounding, and a little for its factors (integers
/// of unit 2⁻³⁰ in orders 2 and 3; else some 10 roundings of 2⁻²⁴, which add as squares, of products up to
/// 0.44 · 2²⁰).
fn weight_error(assignment: Assignment) -> f64 {
    if assignment.order() <= 3 { 0.51 } else { 0.6 }
}

/// How far the weight of the nearest node may be off: by its own error and those of all others.
fn nearest_error(assignment: Assignment) -> f64 {
    let nodes = (assignment.order() * assignment.order()) as f64;
    0.5 * nodes + weight_error(assignment)
}

/// Whether a coordinate is half way between two nodes, where either is the nearest.
fn is_tie(grid: usize, bits: u32) -> bool {
    bits << grid.trailing_zeros() == 1 << 31
}

/// Coordinates that random bits hardly ever hit: on a node, half way between two, and one unit beside.
fn coordinate() -> impl Strategy<Value = u32> {
    let special = (0_u32..8192, -2_i32..=2).prop_map(|(half_cells, beside)| {
        // A half cell of the finest mesh; coarser meshes see their own nodes and middles among them.
        (half_cells << 19).wrapping_add_signed(beside)
    });
    prop_oneof![any::<u32>(), special]
}

/// Strengths of either sign (unit 2⁻²⁰), weak and strong ones, none and one.
fn strength() -> impl Strategy<Value = i32> {
    let one = DISC as i32;
    prop_oneof![-30 * one..=30 * one, -one..=one, -100..=100, prop::sample::select(vec![0, 1, -1, one, -one])]
}

/// A field that is different on every node and along both axes, exact in binary32.
fn ramp(grid: usize) -> Vec<Complex32> {
    (0..grid * grid).map(|node| Complex32::new(node as f32 - 70.5, 0.25 * node as f32)).collect()
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
        let bound = centre_of_mass(assignment.order());
        prop_assert!(along_x.abs() <= bound && along_y.abs() <= bound, "{along_x} {along_y}");
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
        let exact_weights = exact_weights(assignment, grid, (x, y));
        let largest = exact_weights.iter().copied().fold(0.0, f64::max) * f64::from(DISC);
        let mut corrected = None;
        for (&mass, exact) in nodes.iter().zip(exact_weights) {
            let exact = exact * f64::from(DISC);
            if (f64::from(mass) - exact).abs() > weight_error(assignment) {
                prop_assert!(corrected.is_none(), "a second node that takes the remainder");
                prop_assert!((f64::from(mass) - exact).abs() <= nearest_error(assignment), "{mass} for {exact}");
                corrected = Some(exact);
            }
        }
        // The nearest node takes the remainder: none has more than it.
        prop_assert!(corrected.is_none_or(|exact| exact > largest - 1.0), "{corrected:?} of {largest}");
    }

    #[test]
    fn weights_are_mirrored_with_the_disc(
        assignment in assignments(),
        exponent in 4_u32..=8,
        x in coordinate(),
        y in coordinate(),
    ) {
        let grid = 1_usize << exponent;
        // The position in a cell has 2⁻²⁸ cells for unit, binary32 weights see 2⁻²⁴; a mirror image needs both exact.
        let (x, y) = (x & !255, y & !255);
        prop_assume!(!is_tie(grid, x) && !is_tie(grid, y));
        let of = |x, y| nodes_of(assignment, grid, &[Position::from_bits(x, y)]).unwrap();
        let (nodes, mirrored) = (of(x, y), of(x.wrapping_neg(), y));
        let exchanged = of(y, x);
        for (element, &mass) in nodes.iter().enumerate() {
            let (node_x, node_y) = (element / grid, element % grid);
            prop_assert_eq!(mirrored[(grid - node_x) % grid * grid + node_y], mass);
            prop_assert_eq!(exchanged[node_y * grid + node_x], mass);
        }
    }

    #[test]
    fn shares_of_a_strength_are_those_of_the_weights(
        assignment in assignments(),
        exponent in 4_u32..=6,
        x in coordinate(),
        y in coordinate(),
        strength in strength(),
    ) {
        let grid = 1_usize << exponent;
        let disc = [Position::from_bits(x, y)];
        let shares = strengths_of(assignment, grid, &disc, &[strength]).unwrap();
        prop_assert_eq!(shares.iter().map(|&share| i64::from(share)).sum::<i64>(), i64::from(strength));
        let discs = f64::from(strength) / f64::from(DISC);
        let exact_weights = exact_weights(assignment, grid, (x, y));
        let largest = exact_weights.iter().copied().fold(0.0, f64::max) * f64::from(strength).abs();
        // Half for the rounding of a share, and the error of its weight as often as the disc is strong.
        let allowed = 0.5 + weight_error(assignment) * discs.abs();
        let allowed_to_nearest = allowed * exact_weights.iter().filter(|&&weight| weight > 0.0).count() as f64;
        for (&share, weight) in shares.iter().zip(exact_weights) {
            let exact = weight * f64::from(strength);
            let off = (f64::from(share) - exact).abs();
            let is_nearest = exact.abs() >= largest - 1.0;
            prop_assert!(off <= if is_nearest { allowed_to_nearest } else { allowed }, "{share} for {exact}");
        }
        let opposite = strengths_of(assignment, grid, &disc, &[-strength]).unwrap();
        prop_assert!(opposite.iter().eq(&shares.iter().map(|&share| -share).collect::<Vec<i32>>()));
    }

    #[test]
    fn total_strength_is_exact(
        assignment in assignments(),
        exponent in 4_u32..=6,
        discs in prop::collection::vec((coordinate(), coordinate(), strength()), 1..60),
    ) {
        let positions: Vec<Position> = discs.iter().map(|&(x, y, _)| Position::from_bits(x, y)).collect();
        let strengths: Vec<i32> = discs.iter().map(|disc| disc.2).collect();
        let nodes = strengths_of(assignment, 1 << exponent, &positions, &strengths).unwrap();
        let total: i64 = strengths.iter().map(|&strength| i64::from(strength)).sum();
        prop_assert_eq!(nodes.iter().map(|&sum| i64::from(sum)).sum::<i64>(), total);
    }

    #[test]
    fn a_strength_of_one_is_a_disc(
        assignment in assignments(),
        exponent in 4_u32..=6,
        bits in prop::collection::vec((coordinate(), coordinate()), 1..20),
    ) {
        let grid = 1_usize << exponent;
        let discs: Vec<Position> = bits.iter().map(|&(x, y)| Position::from_bits(x, y)).collect();
        let ones = vec![DISC as i32; discs.len()];
        let nodes = nodes_of(assignment, grid, &discs).unwrap();
        let by_strength = strengths_of(assignment, grid, &discs, &ones).unwrap();
        prop_assert!(by_strength.iter().map(|&sum| sum as u32).eq(nodes.iter().copied()));

        let field = ramp(grid);
        let (x, y) = coordinates(&discs);
        let mesh = Grid::new(grid).unwrap();
        let mut plain = (vec![0; discs.len()], vec![1; discs.len()]);
        let mut strong = (vec![2; discs.len()], vec![3; discs.len()]);
        gather(assignment, mesh, (&x, &y), &field, (&mut plain.0, &mut plain.1));
        gather_strengths(assignment, mesh, (&x, &y), &ones, &field, (&mut strong.0, &mut strong.1));
        prop_assert_eq!(plain, strong);
    }

    #[test]
    fn discs_gather_with_the_shares_they_deposit(
        assignment in assignments(),
        x in coordinate(),
        y in coordinate(),
        // Shares of less than 2²⁴ units, which binary32 holds exactly.
        strength in -(16 << 20)..=(16_i32 << 20),
    ) {
        let mesh = Grid::SMALLEST;
        let shares = strengths_of(assignment, 16, &[Position::from_bits(x, y)], &[strength]).unwrap();
        let (x, y) = ([Fraction::from_bits(x)], [Fraction::from_bits(y)]);
        let mut field = vec![Complex32::new(0.0, 0.0); 256];
        for (node, &share) in shares.iter().enumerate() {
            // A force of one along x and minus a half along y on this node alone.
            field[node] = Complex32::new(1.0, -0.5);
            let (mut force_x, mut force_y) = ([7], [7]);
            let force = (&mut force_x[..], &mut force_y[..]);
            gather_strengths(assignment, mesh, (&x, &y), &[strength], &field, force);
            // 2⁻²⁰ discs times 1 kBT/R0 are 2⁴ units of 2⁻²⁴ kBT/R0.
            prop_assert_eq!((force_x[0], force_y[0]), (16 * i64::from(share), -8 * i64::from(share)));
            field[node] = Complex32::new(0.0, 0.0);
        }
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
        // Weights sum to 2²⁰ exactly; up to 49 products and sums below 1000 · 2²⁰ are rounded to 24 bits, by
        // at most 2⁵ each, and scaled by 2⁴.
        let nodes = (assignment.order() * assignment.order()) as f64;
        let bound = 2.0 * nodes * f64::from(1 << 9);
        prop_assert!((force_x[0] as f64 - f64::from(along_x) * 16_777_216.0).abs() <= bound);
        prop_assert!((force_y[0] as f64 - f64::from(along_y) * 16_777_216.0).abs() <= bound);
    }
}

#[test]
fn every_mesh_from_16_to_4096_keeps_the_mass_of_scattered_discs() {
    let discs = scattered(1, 500);
    for exponent in 4..=12 {
        for assignment in Assignment::ALL {
            // The finest meshes cost most: one order of each kind of weights.
            if exponent > 10 && !matches!(assignment.order(), 3 | 7) {
                continue;
            }
            let nodes = nodes_of(assignment, 1 << exponent, &discs).unwrap();
            let total: u64 = nodes.iter().map(|&mass| u64::from(mass)).sum();
            assert_eq!(total, 500 * u64::from(DISC), "{assignment:?} on {} nodes a side", 1 << exponent);
        }
    }
}

#[test]
fn deposit_does_not_depend_on_storage_order() {
    let discs = crowded(2, 300, 0.3);
    for assignment in Assignment::ALL {
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
    for assignment in Assignment::ALL {
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
fn a_node_holds_strengths_of_either_sign_up_to_2047() {
    let one = DISC as i32;
    let on_a_node = Position::from_bits(3 << 28, 5 << 28);
    let limit = LARGEST_NODE_STRENGTH as i32;
    let deposited = |strengths: &[i32]| {
        strengths_of(Assignment::CloudInCell, 16, &vec![on_a_node; strengths.len()], strengths)
    };
    // A few strong discs, and as many of each sign: moduli count, not the sum.
    assert_eq!(deposited(&[one * limit]).unwrap()[3 * 16 + 5], one * limit);
    assert_eq!(deposited(&[-one * limit]).unwrap()[3 * 16 + 5], -one * limit);
    assert_eq!(deposited(&[one * (limit - 1), -one]).unwrap()[3 * 16 + 5], one * (limit - 2));
    assert_eq!(deposited(&[one * limit, 1]), Err(Crowded));
    assert_eq!(deposited(&[one * limit, -1]), Err(Crowded));
    assert_eq!(deposited(&[one * limit, 0]).unwrap()[3 * 16 + 5], one * limit);
    assert_eq!(deposited(&[i32::MIN]), Err(Crowded));
    assert_eq!(deposited(&vec![i32::MIN; 1000]), Err(Crowded));
    // 2¹³ discs would wrap a sum of moduli of 32 bits to zero.
    assert_eq!(deposited(&vec![-one; 1 << 13]), Err(Crowded));
}

#[test]
fn strengths_crowd_a_node_in_any_order_or_in_none() {
    let one = DISC as i32;
    let patch = crowded(6, 300, 0.02);
    // 8 discs a unit of strength, around the limit of the fullest node.
    for assignment in Assignment::ALL {
        let mut refused = 0;
        for strength in [6, 8, 10, 12, 14, 17, 20, 30, 60] {
            let discs: Vec<(Position, i32)> = (0..)
                .zip(&patch)
                .map(|(id, &disc)| (disc, if id % 2 == 0 { one * strength } else { -one * strength }))
                .collect();
            let found = |discs: &[(Position, i32)]| {
                let (positions, strengths): (Vec<Position>, Vec<i32>) = discs.iter().copied().unzip();
                strengths_of(assignment, 16, &positions, &strengths)
            };
            let expected = found(&discs);
            refused += usize::from(expected.is_err());
            for seed in 0..5 {
                assert_eq!(found(&shuffled(seed, &discs)), expected);
            }
        }
        assert!(refused > 0 && refused < 9, "{assignment:?}: {refused} of 9 refused");
    }
}

#[test]
fn gather_with_strengths_does_not_depend_on_storage_order() {
    let discs = scattered(8, 60);
    let strengths: Vec<i32> = (0..60).map(|id| (id - 30) << 17).collect();
    for assignment in Assignment::ALL {
        let gathered = |order: &[usize]| {
            let positions: Vec<Position> = order.iter().map(|&index| discs[index]).collect();
            let strengths: Vec<i32> = order.iter().map(|&index| strengths[index]).collect();
            let (x, y) = coordinates(&positions);
            let (mut force_x, mut force_y) = (vec![0; 60], vec![0; 60]);
            let forces = (&mut force_x[..], &mut force_y[..]);
            gather_strengths(assignment, Grid::new(32).unwrap(), (&x, &y), &strengths, &ramp(32), forces);
            force_x.into_iter().zip(force_y).collect::<Vec<_>>()
        };
        let in_order = gathered(&(0..60).collect::<Vec<usize>>());
        let order = shuffled(9, &(0..60).collect::<Vec<usize>>());
        let expected: Vec<_> = order.iter().map(|&index| in_order[index]).collect();
        assert_eq!(gathered(&order), expected);
    }
}

#[test]
fn a_crowd_far_beyond_the_range_of_a_node_is_still_refused() {
    // 2¹³ discs would wrap a sum of 32 bits to zero.
    let crowded = vec![Position::from_bits(0, 0); 1 << 13];
    assert_eq!(nodes_of(Assignment::CloudInCell, 16, &crowded), Err(Crowded));
}
