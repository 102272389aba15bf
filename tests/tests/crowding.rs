//! More discs than may all be in one place.

use meniscus_core::assignment::Crowded;
use meniscus_core::crowding::{Crowding, LARGEST_CELL, LARGEST_HEAP, MOST_CELLS};
use meniscus_core::dynamics::{Clock, Dynamics, ForceError, StepError};
use meniscus_core::grid::Grid;
use meniscus_core::pair_force::PairForce;
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, Parameters};
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::stages::Scalar;
use meniscus_core::torus::{Fraction, LARGEST_SIDE, Position};
use meniscus_core::transform::AnySize;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::states::with_ids;

#[expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]
fn started(parameters: &Parameters, discs: &[Position]) -> (Dynamics, Arrays) {
    let mut arrays = Arrays::new(parameters.grid, 1, discs.len());
    let dynamics = Dynamics::new(parameters, Clock::START, with_ids(discs), &mut arrays.memory()).unwrap();
    (dynamics, arrays)
}

/// Discs that only repel each other; a cell is 16 R0 wide.
const REPELLING: Parameters =
    Parameters { side: 4096.0, grid: 1024, capillary_strength: 0.0, ..Parameters::PAPER };

/// `count` discs on a square lattice of 1024 × 1024, 4 R0 apart.
fn spread(count: usize) -> Vec<Position> {
    let place = |index: usize| Position::from_bits((index as u32 % 1024) << 22, (index as u32 / 1024) << 22);
    (0..count).map(place).collect()
}

#[test]
fn a_heap_of_more_than_two_to_the_19_discs_is_refused_and_stays() {
    let (mut dynamics, mut arrays) = started(&REPELLING, &vec![Position::from_bits(7, 9); LARGEST_HEAP + 1]);
    let stages = &mut Scalar(AnySize);
    assert_eq!(dynamics.forces(stages, &mut arrays.memory()), Err(ForceError::Crowded));
    assert_eq!(dynamics.step(stages, &mut arrays.memory()), Err(StepError::Crowded));
    assert_eq!(dynamics.clock(), Clock::START);
    assert!(arrays.x.iter().all(|x| x.to_bits() == 7) && arrays.y.iter().all(|y| y.to_bits() == 9));
    // Without repulsion nothing adds up.
    let free = Parameters { repulsion: false, ..REPELLING };
    let (dynamics, mut arrays) = started(&free, &vec![Position::from_bits(7, 9); LARGEST_HEAP + 1]);
    assert_eq!(dynamics.forces(stages, &mut arrays.memory()), Ok(()));
}

#[test]
fn as_many_discs_side_by_side_are_not_refused() {
    let discs = spread(LARGEST_HEAP + 1);
    let (dynamics, mut arrays) = started(&REPELLING, &discs);
    assert_eq!(dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory()), Ok(()));
    // 4 R0 apart they do not touch.
    assert!(arrays.force_x.iter().chain(&arrays.force_y).all(|&force| force == 0));
}

#[test]
fn a_cell_holds_two_to_the_15_discs_and_not_one_more() {
    let crowding = Crowding::new(PairForce::repulsion(REPELLING.side).reach(), Grid::new(1024).unwrap());
    let mut counts = vec![u32::MAX; MOST_CELLS * MOST_CELLS + 3];
    // Two corners of one cell, in turns.
    let corners = [(1 << 24, 2 << 24), ((2 << 24) - 1, (3 << 24) - 1)];
    let heap = |count: u32| -> (Vec<Fraction>, Vec<Fraction>) {
        let places = (0..count).map(|index| corners[index as usize % 2]);
        places.map(|(x, y)| (Fraction::from_bits(x), Fraction::from_bits(y))).unzip()
    };
    let (mut x, mut y) = heap(LARGEST_CELL);
    // Its neighbours are others.
    x.extend([Fraction::from_bits(2 << 24), Fraction::from_bits((1 << 24) - 1)]);
    y.extend([Fraction::from_bits(2 << 24), Fraction::from_bits(2 << 24)]);
    assert_eq!(crowding.count((&x, &y), &mut counts), Ok(()));
    assert_eq!(counts[MOST_CELLS + 2], LARGEST_CELL);
    assert_eq!(counts.iter().take(MOST_CELLS * MOST_CELLS).sum::<u32>(), LARGEST_CELL + 2);
    let (x, y) = heap(LARGEST_CELL + 1);
    assert_eq!(crowding.count((&x, &y), &mut counts), Err(Crowded));
}

#[test]
fn cells_are_as_many_as_nodes_and_the_reach_of_the_repulsion_allow() {
    for exponent in 4..=12 {
        let grid = Grid::new(1 << exponent).unwrap();
        for side in [2.0 * CUTOFF * (1.0 + 1e-15), 4.0 * CUTOFF, 36.0, 37.0, 500.0, 10_000.0, LARGEST_SIDE] {
            let cells = Crowding::new(PairForce::repulsion(side).reach(), grid).cells_a_side();
            assert!(
                cells >= 2 && cells <= grid.nodes().min(MOST_CELLS) && cells.is_power_of_two(),
                "{cells} in {side}"
            );
            assert!(side / cells as f64 >= CUTOFF * (1.0 - 1e-9), "{cells} in {side}");
            // Twice as many would not do.
            assert!(
                cells == grid.nodes().min(MOST_CELLS) || side / (2 * cells) as f64 <= CUTOFF * (1.0 + 1e-6)
            );
        }
    }
}

#[test]
fn only_large_heaps_of_discs_that_repel_each_other_are_of_concern() {
    let none = Crowding::new(0, Grid::SMALLEST);
    assert_eq!(none.cells_a_side(), 1);
    assert!(!none.concerns(LARGEST_PARTICLE_COUNT));
    let some = Crowding::new(1 << 20, Grid::SMALLEST);
    assert!(some.concerns(LARGEST_HEAP + 1) && !some.concerns(LARGEST_HEAP));
}
