//! Deposit and gather in lanes have the bits of the core's, at every level and in any number of pieces.

use meniscus_core::assignment::{self, Crowded, DISC, LARGEST_NODE_MASS};
use meniscus_core::grid::Grid;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::parameters::Assignment;
use meniscus_core::torus::Fraction;
use meniscus_core::transform::Complex32;
use meniscus_wide::assignment::{Field, MeshAssignment};
use meniscus_wide::lanes::Level;

/// Numbers of discs.
fn counts() -> impl Iterator<Item = usize> {
    [1, 3, 16, 17, if long() { 2500 } else { 100 }].into_iter()
}

/// Whether there is time for all: the ordinary tests are not optimised.
fn long() -> bool {
    std::env::var_os("MENISCUS_LONG_TESTS").is_some_and(|value| value == "1")
}

/// Pieces to do the work in.
fn pieces() -> &'static [usize] {
    if long() { &[1, 2, 3, 4, 7, 16] } else { &[1, 3] }
}

type Discs = (Vec<Fraction>, Vec<Fraction>);

/// 64 random bits for each number.
fn random(number: usize) -> u64 {
    StepKey::new(7, Purpose::Start, 0).bits(number as u64)
}

/// Sorted by x but for a shift, as discs are some steps after they were put in order.
fn nearly_sorted(count: usize) -> Discs {
    let mut discs: Vec<u64> = (0..count).map(random).collect();
    discs.sort_unstable_by_key(|bits| bits >> 32);
    let shift = |bits: u64| (bits.wrapping_mul(0x9E37_79B9) as u32 >> 6).wrapping_sub(1 << 25);
    discs
        .iter()
        .map(|&bits| (Fraction::from_bits((bits >> 32) as u32), Fraction::from_bits(bits as u32)))
        .map(|(x, y)| (Fraction::from_bits(x.to_bits().wrapping_add(shift(u64::from(y.to_bits())))), y))
        .unzip()
}

/// In no order.
fn unsorted(count: usize) -> Discs {
    (0..count)
        .map(|disc| (random(disc), random(disc + count)))
        .map(|(x, y)| (Fraction::from_bits(x as u32), Fraction::from_bits(y as u32)))
        .unzip()
}

/// On nodes, half-way between them and one unit to either side, many of them at the seams.
fn special(grid: Grid, count: usize) -> Discs {
    let half_cell = 1_u32 << (31 - grid.exponent());
    let place = |bits: u64| {
        let node = match bits & 3 {
            0 => bits as u32 >> 8,
            1 => bits as u32 >> 8 & 7,
            _ => (bits as u32 >> 8 & 7).wrapping_neg(),
        };
        let place = node.wrapping_mul(half_cell);
        Fraction::from_bits(place.wrapping_add((bits >> 40 & 3) as u32).wrapping_sub(1))
    };
    (0..count).map(|disc| (place(random(disc)), place(random(disc + 100_000)))).unzip()
}

/// In a corner of the box, across both seams.
fn cluster(count: usize) -> Discs {
    let place = |bits: u64| Fraction::from_bits((bits as u32 >> 5).wrapping_sub(1 << 26));
    (0..count).map(|disc| (place(random(disc)), place(random(disc + 100_000)))).unzip()
}

/// All in one place.
fn coincident(count: usize, x: u32, y: u32) -> Discs {
    (vec![Fraction::from_bits(x); count], vec![Fraction::from_bits(y); count])
}

fn grids() -> impl Iterator<Item = Grid> {
    let all: &[usize] = &[16, 64, 256];
    (if long() { all } else { &[16, 64] }).iter().copied().filter_map(Grid::new)
}

/// Calls `check` with schemes of all levels and some pieces.
fn for_each_scheme(grid: Grid, assignment: Assignment, mut check: impl FnMut(MeshAssignment)) {
    for level in Level::available() {
        for &pieces in pieces() {
            check(MeshAssignment { level, pieces, assignment, grid });
        }
    }
}

fn strengths(count: usize) -> Vec<i32> {
    let extremes = [0, 1, -1, DISC as i32, -(DISC as i32), 3, 1000 * DISC as i32, -1000 * DISC as i32];
    let strength = |bits: u64| match bits & 7 {
        0 => extremes[(bits >> 8 & 7) as usize],
        _ => (bits >> 32) as i32 >> 8,
    };
    (0..count).map(|disc| strength(random(disc + 300_000))).collect()
}

fn check_deposit(grid: Grid, assignment: Assignment, (x, y): &Discs) -> Result<(), Crowded> {
    let mut expected = vec![0; grid.nodes() * grid.nodes()];
    let verdict = assignment::deposit(assignment, grid, x, y, &mut expected);
    let mut nodes = vec![0; expected.len()];
    for_each_scheme(grid, assignment, |scheme| {
        nodes.fill(1234);
        assert_eq!(scheme.deposit((x, y), &mut nodes), verdict, "{scheme:?}");
        assert!(verdict.is_err() || nodes == expected, "{scheme:?}, {} discs", x.len());
    });
    verdict
}

fn check_strengths(
    grid: Grid,
    assignment: Assignment,
    (x, y): &Discs,
    strengths: &[i32],
) -> Result<(), Crowded> {
    let mut expected = vec![0; grid.nodes() * grid.nodes()];
    let verdict = assignment::deposit_strengths(assignment, grid, (x, y), strengths, &mut expected);
    let mut nodes = vec![0; expected.len()];
    for_each_scheme(grid, assignment, |scheme| {
        nodes.fill(1234);
        assert_eq!(scheme.deposit_strengths((x, y), strengths, &mut nodes), verdict, "{scheme:?}");
        assert!(verdict.is_err() || nodes == expected, "{scheme:?}, {} discs", x.len());
    });
    verdict
}

/// A field and the same with another pitch, what lies between the rows being anything.
fn fields(grid: Grid, value: impl Fn(u64) -> f32) -> [(Vec<Complex32>, usize); 2] {
    let nodes = grid.nodes();
    let force = |node: usize| {
        let bits = random(node + 500_000);
        Complex32::new(value(bits), value(bits.rotate_left(32)))
    };
    let pitch = nodes + 8;
    let junk = Complex32::new(f32::NAN, 1e30);
    let padded = |place: usize| match place % pitch {
        y if y < nodes => force(place / pitch * nodes + y),
        _ => junk,
    };
    [((0..nodes * nodes).map(force).collect(), nodes), ((0..nodes * pitch).map(padded).collect(), pitch)]
}

fn check_gather(grid: Grid, assignment: Assignment, (x, y): &Discs, value: impl Fn(u64) -> f32) {
    let count = x.len();
    let strengths = strengths(count);
    let fields = fields(grid, value);
    let (mut expected_x, mut expected_y) = (vec![0; count], vec![0; count]);
    let (mut force_x, mut force_y) = (vec![0; count], vec![0; count]);
    for equal in [true, false] {
        let field = &fields[0].0;
        let expected = (&mut expected_x[..], &mut expected_y[..]);
        if equal {
            assignment::gather(assignment, grid, (x, y), field, expected);
        } else {
            assignment::gather_strengths(assignment, grid, (x, y), &strengths, field, expected);
        }
        for (nodes, pitch) in &fields {
            let field = Field { nodes, pitch: *pitch };
            for_each_scheme(grid, assignment, |scheme| {
                force_x.fill(7);
                force_y.fill(7);
                let forces = (&mut force_x[..], &mut force_y[..]);
                if equal {
                    scheme.gather((x, y), field, forces);
                } else {
                    scheme.gather_strengths((x, y), &strengths, field, forces);
                }
                assert_eq!(force_x, expected_x, "{scheme:?}, {count} discs, equal: {equal}");
                assert_eq!(force_y, expected_y, "{scheme:?}, {count} discs, equal: {equal}");
            });
        }
    }
}

#[test]
fn deposits_of_equal_discs_are_the_cores() {
    for grid in grids() {
        for assignment in Assignment::ALL {
            for count in counts() {
                check_deposit(grid, assignment, &nearly_sorted(count)).unwrap();
            }
            check_deposit(grid, assignment, &special(grid, 64)).unwrap();
            check_deposit(grid, assignment, &unsorted(100)).unwrap();
            check_deposit(grid, assignment, &cluster(50)).unwrap();
            check_deposit(grid, assignment, &unsorted(0)).unwrap();
        }
    }
}

#[test]
fn deposits_of_strengths_are_the_cores() {
    for grid in grids() {
        for assignment in Assignment::ALL {
            for count in counts() {
                let _ = check_strengths(grid, assignment, &nearly_sorted(count), &strengths(count));
            }
            let _ = check_strengths(grid, assignment, &special(grid, 64), &strengths(64));
            check_strengths(grid, assignment, &cluster(300), &[-5_000_000; 300]).unwrap();
        }
    }
}

#[test]
fn a_node_is_crowded_when_the_core_says_so() {
    let grid = Grid::SMALLEST;
    // On a node, at the seams, and in the middle of a cell.
    let places = [(0, 0), (1 << 31, 0xF800_0001), (0x0800_0000, 0x0800_0000)];
    let few = [Assignment::CloudInCell, Assignment::Order5];
    for &assignment in if long() { &Assignment::ALL[..] } else { &few } {
        for (x, y) in places.into_iter().take(if long() { 3 } else { 1 }) {
            let (one_x, one_y) = coincident(1, x, y);
            let mut nodes = [0; 256];
            assignment::deposit(assignment, grid, &one_x, &one_y, &mut nodes).unwrap();
            let largest_weight = nodes.into_iter().max().unwrap();
            let most = (LARGEST_NODE_MASS * DISC / largest_weight) as usize;
            assert_eq!(check_deposit(grid, assignment, &coincident(most, x, y)), Ok(()));
            assert_eq!(check_deposit(grid, assignment, &coincident(most + 1, x, y)), Err(Crowded));
        }
    }
    // Four times what a sum of 32 bits can hold.
    if long() {
        assert_eq!(check_deposit(grid, Assignment::CloudInCell, &coincident(16_384, 0, 0)), Err(Crowded));
    }
}

#[test]
fn strengths_crowd_a_node_when_the_core_says_so() {
    let unit = DISC as i32;
    let few: &[usize] = &[1, 2, 3, 5];
    for assignment in Assignment::ALL {
        for (x, y) in [(0, 0), (1 << 31, 0xF800_0001)] {
            for strength in [unit, -unit, i32::MIN, i32::MAX, 1000 * unit + 1, -7] {
                for &count in if long() { &[1, 2, 3, 5, 2047, 2048, 4095, 4100] } else { few } {
                    let discs = coincident(count, x, y);
                    let mut strengths = vec![strength; count];
                    let _ = check_strengths(Grid::SMALLEST, assignment, &discs, &strengths);
                    strengths.iter_mut().step_by(2).for_each(|strength| *strength = strength.wrapping_neg());
                    let _ = check_strengths(Grid::SMALLEST, assignment, &discs, &strengths);
                }
            }
        }
    }
    for (count, verdict) in [(2047, Ok(())), (2048, Err(Crowded))] {
        let discs = coincident(count, 0, 0);
        let cloud = Assignment::CloudInCell;
        assert_eq!(check_strengths(Grid::SMALLEST, cloud, &discs, &vec![-unit; count]), verdict);
    }
}

#[test]
fn forces_gathered_are_the_cores() {
    let ordinary = |bits: u64| (bits as i32 as f32) * 1e-8;
    for grid in grids() {
        for assignment in Assignment::ALL {
            for count in counts() {
                check_gather(grid, assignment, &nearly_sorted(count), ordinary);
            }
            check_gather(grid, assignment, &special(grid, 64), ordinary);
            check_gather(grid, assignment, &cluster(50), ordinary);
            check_gather(grid, assignment, &unsorted(0), ordinary);
        }
    }
}

#[test]
fn forces_gathered_from_extreme_fields_are_the_cores() {
    // Any finite number, subnormal ones and zeros of either sign among them.
    let any = |bits: u64| {
        let bits = bits as u32;
        match bits & 7 {
            0 => f32::from_bits(bits & 0x8000_0000),
            1 => f32::from_bits(bits & 0x807F_FFFF),
            _ => Some(f32::from_bits(bits)).filter(|value| value.is_finite()).unwrap_or(f32::MAX),
        }
    };
    let large = |bits: u64| (bits as i32 as f32) * [1.0, 256.0, 1e6][(bits >> 40) as usize % 3];
    let no_numbers = |bits: u64| if bits & 15 == 0 { f32::INFINITY } else { large(bits) };
    let grid = Grid::new(16).unwrap();
    for assignment in Assignment::ALL {
        for value in [&any as &dyn Fn(u64) -> f32, &large, &no_numbers] {
            check_gather(grid, assignment, &unsorted(50), value);
        }
    }
}
