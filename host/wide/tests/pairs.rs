//! Pairs in wide lanes against the core's own, bit for bit.

use meniscus_core::cells::for_each_pair;
use meniscus_core::near_part::{Segment, fill_table, table_length};
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::pair_force::{PairForce, near_cutoff, product_of_strengths};
use meniscus_core::parameters::{Influence, Method, Parameters};
use meniscus_core::torus::Fraction;
use meniscus_wide::lanes::Level;
use meniscus_wide::neighbours::Neighbours;
use meniscus_wide::order::permute;
use meniscus_wide::pairs::{Discs, PairLoop, Strengths};

const SIDE: f64 = 500.0;
/// R0 in units of position, at side 500 R0.
const R0: u32 = (4_294_967_296.0 / SIDE) as u32;

/// Whether to look at everything: lanes that are not inlined take a hundred times longer.
fn is_thorough() -> bool {
    !cfg!(debug_assertions) || std::env::var_os("MENISCUS_LONG_TESTS").is_some()
}

/// Numbers without a pattern.
struct Numbers(StepKey, u64);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(StepKey::new(seed, Purpose::Start, 0), 0)
    }

    fn next(&mut self) -> u64 {
        self.1 += 1;
        self.0.bits(self.1)
    }

    fn below(&mut self, end: u32) -> u32 {
        (((self.next() >> 32) * u64::from(end)) >> 32) as u32
    }
}

type State = (Vec<u32>, Vec<u32>);

fn random(count: usize, seed: u64) -> State {
    let mut numbers = Numbers::new(seed);
    (0..count).map(|_| (numbers.next() as u32, numbers.next() as u32)).unzip()
}

/// Discs within `width` (unit L·2⁻³²) of a corner of the box, on both sides of both seams.
fn clustered(count: usize, width: u32, seed: u64) -> State {
    let mut numbers = Numbers::new(seed);
    let mut near = || numbers.below(width).wrapping_sub(width / 2);
    (0..count).map(|_| (near(), near())).unzip()
}

/// A hexagonal lattice 2.1 R0 apart.
fn hexagonal(count: usize) -> State {
    let unit = |length: f64| (length * f64::from(R0)) as u32;
    (0..count)
        .map(|disc| {
            let (column, row) = ((disc % 50) as f64, (disc / 50) as f64);
            (unit(2.1 * (column + 0.5 * (row % 2.0))), unit(1.82 * row).wrapping_sub(20 * R0))
        })
        .unzip()
}

/// A pair force with the rest of what the core asks for.
struct Case {
    force: PairForce,
    table: Vec<Segment>,
    ids: Vec<u32>,
    strengths: Option<Vec<i32>>,
    product: f32,
}

fn split(side: f64, cutoff: f64, repulsion: bool) -> Parameters {
    Parameters {
        method: Method::P3m,
        influence: Influence::Optimal,
        side,
        capillary_strength: 0.97,
        capillary_length: 60.0,
        splitting: 2.6 / cutoff,
        cutoff,
        repulsion,
        ..Parameters::PAPER
    }
}

impl Case {
    fn new(parameters: &Parameters, count: usize) -> Self {
        let mut table = vec![[0.0; 4]; table_length(near_cutoff(parameters))];
        fill_table(parameters.splitting, parameters.capillary_length, &mut table);
        // Ids that are not in the order of storage.
        let ids = (0..count as u32).map(|disc| disc ^ 5).collect();
        Self { force: PairForce::new(parameters), table, ids, strengths: None, product: PairForce::EQUAL }
    }

    fn with_strengths(mut self, strengths: Vec<i32>) -> Self {
        self.strengths = Some(strengths);
        self
    }

    /// The forces by the core's functions, added as `Stages::add_pairs` of the core adds them.
    fn expected(&self, (x, y): &State) -> (Vec<i64>, Vec<i64>) {
        let fractions = |all: &[u32]| all.iter().map(|&bits| Fraction::from_bits(bits)).collect::<Vec<_>>();
        let (x, y) = (fractions(x), fractions(y));
        let (mut force_x, mut force_y) = before(x.len());
        let (mut ends, mut order) = (vec![0; 4096], vec![0; x.len()]);
        for_each_pair((&x, &y), self.force.reach(), &mut ends, &mut order, |first, second, separation| {
            let is_lower = self.ids[first] < self.ids[second];
            let product = match &self.strengths {
                Some(all) => product_of_strengths(all[first], all[second]),
                None => self.product,
            };
            if let Some((x, y)) = self.force.of(separation, is_lower, product, &self.table) {
                force_x[first] += x;
                force_y[first] += y;
                force_x[second] -= x;
                force_y[second] -= y;
            }
        });
        (force_x, force_y)
    }

    fn forces(&self, level: Level, neighbours: &Neighbours, count: usize) -> (Vec<i64>, Vec<i64>) {
        let (mut force_x, mut force_y) = before(count);
        let strengths = self.strengths.as_deref().map_or(Strengths::Alike(self.product), Strengths::Each);
        let discs = Discs { ids: &self.ids, strengths };
        let pairs = PairLoop::new(level, &self.force, &self.table);
        pairs.add(neighbours, &discs, (&mut force_x, &mut force_y));
        (force_x, force_y)
    }

    /// Compares at every level, in several numbers of pieces, with and without a skin; without optimisation, at some.
    fn check(&self, state: &State, name: &str) {
        let expected = self.expected(state);
        let (pieces, skins): (&[_], &[_]) = match state.0.len() {
            _ if is_thorough() => (&[1, 2, 3, 4, 7, 16], &[0, R0]),
            0..100 => (&[1, 2, 16], &[R0]),
            _ => (&[1, 3], &[R0]),
        };
        for level in Level::available() {
            for &pieces in pieces {
                for &skin in skins {
                    let mut neighbours = Neighbours::new(level, self.force.reach()).with_skin(skin);
                    neighbours.rebuild(&state.0, &state.1, pieces);
                    let found = self.forces(level, &neighbours, state.0.len());
                    assert!(found == expected, "{name}: {}, {pieces} pieces, skin {skin}", level.name());
                }
            }
        }
    }
}

/// What is in the force arrays before the pairs are added.
fn before(count: usize) -> (Vec<i64>, Vec<i64>) {
    ((0..count as i64).map(|disc| 3 - disc).collect(), (0..count as i64).map(|disc| disc << 20).collect())
}

/// Stores the discs in the order of cells.
fn arranged(mut state: State, reach: u32) -> State {
    let mut neighbours = Neighbours::new(Level::PORTABLE, reach).with_skin(R0);
    let order = neighbours.arrange(&state.0, &state.1).discs().to_vec();
    permute(&order, &mut state.0, &mut vec![0; order.len()]);
    permute(&order, &mut state.1, &mut vec![0; order.len()]);
    assert!(neighbours.arrange(&state.0, &state.1).is_identity());
    state
}

#[test]
fn random_discs_of_any_number() {
    for count in [1, 2, 3, 17, 250, if is_thorough() { 2500 } else { 700 }] {
        let case = Case::new(&split(SIDE, 7.34, true), count);
        case.check(&random(count, 1), &format!("{count} random discs"));
        case.check(
            &arranged(random(count, 1), case.force.reach()),
            &format!("{count} random discs in order"),
        );
    }
}

#[test]
fn clusters_across_the_seams() {
    for (count, width) in [(2, R0), (3, R0), (17, 4 * R0), (250, 20 * R0), (1000, 60 * R0)] {
        if count > 250 && !is_thorough() {
            continue;
        }
        let case = Case::new(&split(SIDE, 7.34, true), count);
        // Overlaps of all depths: forces far beyond 2³¹ units, and of those that no longer grow.
        case.check(&clustered(count, width, 2), &format!("{count} discs within {width}"));
    }
    let count = if is_thorough() { 1000 } else { 200 };
    let lattice = hexagonal(count);
    for cutoff in [7.34, 20.0, 40.0] {
        let case = Case::new(&split(SIDE, cutoff, true), count);
        case.check(&lattice, &format!("a lattice, cut-off {cutoff}"));
        case.check(&arranged(lattice.clone(), case.force.reach()), "a lattice in order");
    }
}

#[test]
fn coinciding_discs() {
    for count in [2, 3, 17, 250] {
        let case = Case::new(&split(SIDE, 7.34, true), count);
        case.check(&(vec![u32::MAX; count], vec![7; count]), &format!("{count} discs at one place"));
        let mut numbers = Numbers::new(9);
        let near = (0..count).map(|_| (numbers.below(3), numbers.below(3).wrapping_sub(1))).unzip();
        case.check(&near, &format!("{count} discs at nine places"));
    }
}

#[test]
fn forces_without_repulsion_or_near_part() {
    let state = clustered(250, 30 * R0, 3);
    Case::new(&split(SIDE, 7.34, false), 250).check(&state, "no repulsion");
    let paper = Parameters { side: SIDE, ..Parameters::PAPER };
    Case::new(&paper, 250).check(&state, "no near part");
    let mut short = Case::new(&split(SIDE, 7.34, true), 250);
    short.table.truncate(40);
    short.check(&state, "a table that ends early");
    let mut none = Case::new(&split(SIDE, 7.34, true), 250);
    none.product = 0.0;
    none.check(&state, "no strengths");
}

#[test]
fn strengths_of_every_size_and_sign() {
    let state = clustered(250, 30 * R0, 4);
    let mut numbers = Numbers::new(5);
    let special = [0, 1, -1, 1 << 20, -(1 << 20), i32::MAX, i32::MIN, 0x0123_4567, -0x0765_4321];
    let strengths = (0..250).map(|_| match numbers.below(18) {
        chosen @ 0..9 => special[chosen as usize],
        _ => numbers.next() as i32 >> numbers.below(31),
    });
    let strengths: Vec<i32> = strengths.collect();
    Case::new(&split(SIDE, 7.34, true), 250).with_strengths(strengths.clone()).check(&state, "strengths");
    Case::new(&split(SIDE, 7.34, false), 250).with_strengths(strengths).check(&state, "strengths alone");
}

#[test]
fn boxes_of_few_cells_and_cut_offs_up_to_half_a_box() {
    for side in [14.8, 20.0, 23.0, 30.0, 38.0, 46.0] {
        for count in [2, 17, 250] {
            let case = Case::new(&split(side, 7.34, true), count);
            case.check(&random(count, 6), &format!("{count} discs in a box of {side}"));
        }
    }
    // So near half a box that there is no room for a skin.
    let side = 14.68 * (1.0 + 3e-10);
    let parameters = split(side, 7.34, true);
    let case = Case::new(&parameters, 60);
    assert!(((1 << 31) - 8..1 << 31).contains(&case.force.reach()), "{}", case.force.reach());
    case.check(&random(60, 7), "half a box");
    let corners = [0, 1 << 31, (1 << 31) - 1, (1 << 31) + 1, 1 << 30];
    let state = (0..25).map(|disc| (corners[disc % 5], corners[disc / 5])).unzip();
    Case::new(&parameters, 25).check(&state, "discs half a box apart");
}

#[test]
fn pairs_at_the_cut_off() {
    for (side, cutoff) in [(SIDE, 7.34), (SIDE, 20.0), (512.0, 8.0), (400.0, 7.0)] {
        let parameters = split(side, cutoff, true);
        let reach = Case::new(&parameters, 2).force.reach();
        // Along an axis the core looks no farther than the reach; along the diagonal only the square counts.
        let (mut x, mut y) = (vec![5], vec![9]);
        for step in -40_i32..=40 {
            let beyond = 5_u32.wrapping_add(reach).wrapping_add_signed(step);
            let diagonal = (f64::from(reach) * 0.5_f64.sqrt()) as u32;
            x.extend([beyond, 5, diagonal.wrapping_add_signed(step)]);
            y.extend([9, beyond.wrapping_add(4), diagonal]);
        }
        let count = x.len();
        Case::new(&parameters, count).check(&(x, y), &format!("cut-off {cutoff} in {side}"));
    }
}

#[test]
fn lists_are_of_use_until_a_disc_has_moved_by_half_the_skin() {
    const SKIN: u32 = 2 * 5_000_000;
    for level in Level::available() {
        for (count, pieces) in [(17, 1), (250, 1), (250, 3), (1000, 4)] {
            if count > 250 && !is_thorough() {
                continue;
            }
            let case = Case::new(&split(SIDE, 7.34, true), count);
            let state = arranged(clustered(count, 60 * R0, 8), case.force.reach());
            let mut numbers = Numbers::new(10);
            let mut neighbours = Neighbours::new(level, case.force.reach()).with_skin(SKIN);
            neighbours.rebuild(&state.0, &state.1, pieces);
            // All discs anywhere on a circle just inside half the skin.
            for _ in 0..3 {
                let moved: State = state
                    .0
                    .iter()
                    .zip(&state.1)
                    .map(|(&x, &y)| {
                        let tangent = f64::from(numbers.next() as i32) / f64::from(1 << 30);
                        let secant = 1.0 + tangent * tangent;
                        let (sine, cosine) = (2.0 * tangent / secant, (1.0 - tangent * tangent) / secant);
                        let along = |part: f64| (4_999_998.0 * part) as i32;
                        (x.wrapping_add_signed(along(cosine)), y.wrapping_add_signed(along(sine)))
                    })
                    .unzip();
                assert!(neighbours.is_fresh(&moved.0, &moved.1, pieces));
                assert!(case.forces(level, &neighbours, count) == case.expected(&moved));
            }
            // One disc by exactly half the skin, by a unit less and by a unit more: 3² + 4² = 5².
            for disc in [0, count / 2, count - 1] {
                for (along_x, along_y, is_fresh) in [
                    (4_999_999, 0, true),
                    (5_000_000, 0, false),
                    (0, -5_000_001, false),
                    (-3_000_000, 4_000_000, false),
                    (-3_000_000, 3_999_999, true),
                    (i32::MIN, i32::MIN, false),
                ] {
                    let mut moved = state.clone();
                    moved.0[disc] = moved.0[disc].wrapping_add_signed(along_x);
                    moved.1[disc] = moved.1[disc].wrapping_add_signed(along_y);
                    assert_eq!(neighbours.is_fresh(&moved.0, &moved.1, pieces), is_fresh);
                    if is_fresh {
                        assert!(case.forces(level, &neighbours, count) == case.expected(&moved));
                    }
                }
            }
            assert!(!neighbours.is_fresh(&state.0, &state.1, pieces + 1));
            assert!(!neighbours.is_fresh(&state.0[1..], &state.1[1..], pieces));
        }
    }
}

#[test]
fn two_discs_that_meet_as_fast_as_they_may_are_seen() {
    // At the end of cut-off and skin when the list is made, within the cut-off when it is last of use.
    let case = Case::new(&split(SIDE, 7.34, true), 2);
    let (skin, reach) = (1_000_000, case.force.reach());
    for level in Level::available() {
        let mut neighbours = Neighbours::new(level, reach).with_skin(skin);
        let apart = reach + skin - 40;
        neighbours.rebuild(&[0, apart], &[0, 0], 1);
        let moved = (vec![499_999, apart - 499_999], vec![0, 0]);
        assert!(neighbours.is_fresh(&moved.0, &moved.1, 1));
        let expected = case.expected(&moved);
        assert!(expected != before(2), "the pair exerts no force");
        assert!(case.forces(level, &neighbours, 2) == expected);
    }
}

#[test]
fn a_run_has_the_same_forces_whatever_the_skin() {
    let count = if is_thorough() { 500 } else { 150 };
    let case = Case::new(&split(SIDE, 7.34, true), count);
    for (level, pieces) in Level::available().zip([1, 2, 3, 1, 2]) {
        let mut state = arranged(clustered(count, 90 * R0, 11), case.force.reach());
        let mut numbers = Numbers::new(12);
        let mut neighbours = Neighbours::new(level, case.force.reach());
        let (mut made, mut used) = (0, 0);
        for _ in 0..60 {
            if neighbours.is_fresh(&state.0, &state.1, pieces) {
                used += 1;
            } else {
                neighbours.rebuild(&state.0, &state.1, pieces);
                made += 1;
            }
            assert!(case.forces(level, &neighbours, count) == case.expected(&state));
            for coordinate in state.0.iter_mut().chain(&mut state.1) {
                *coordinate = coordinate.wrapping_add(numbers.below(R0 / 5)).wrapping_sub(R0 / 10);
            }
        }
        assert!(used > made && made > 2, "{made} lists, used {used} times more");
    }
}
