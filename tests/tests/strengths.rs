//! Discs of unequal capillary strengths: like attract, unlike repel, f_i·f_j times what equal discs do.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::TAU;

use meniscus_core::assignment::{DISC, deposit_strengths, gather_strengths};
use meniscus_core::digest::StateDigest;
use meniscus_core::dynamics::{Clock, Disc, Dynamics, InitError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve_strengths};
use meniscus_core::parameters::{Assignment, Influence, Method, Noise, Parameters};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::Position;
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_core::units::force_from_units;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::figures::assert_within;
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::near_part::near_force;
use meniscus_tests::reference::{RandomNumbers, rms, rms_difference, wca};
use meniscus_tests::states::{at, coordinates, crowded, in_radii, scattered, separated, shuffled, with_ids};
use meniscus_tests::tolerances::{
    FORCE_QUANTUM, MESH_NET_FORCE, PAIR_FORCE, SPLIT_PAIR, STRENGTH_RATIO, UNEQUAL_ERROR,
};

/// Strength 1.
const ONE: i32 = DISC as i32;

/// The split force and nothing else, exact to 1e-5.
const SPLIT: Parameters = Parameters {
    side: 40.0,
    capillary_strength: 0.89,
    capillary_length: 25.0,
    repulsion: false,
    method: Method::P3m,
    splitting: 0.25,
    cutoff: 17.0,
    grid: 32,
    assignment: Assignment::Order7,
    influence: Influence::Optimal,
    noise: Noise::None,
    ..Parameters::DEFAULT
};

/// All on the mesh, as in the paper.
const MESH: Parameters = Parameters {
    method: Method::ParticleMesh,
    assignment: Assignment::TriangularShapedCloud,
    influence: Influence::Paper,
    ..SPLIT
};

/// Both methods, with repulsion and noise.
fn everything() -> [Parameters; 2] {
    [SPLIT, MESH].map(|parameters| Parameters { repulsion: true, noise: Noise::Uniform, ..parameters })
}

/// Discs of ids 0, 1, 2 … with their strengths.
fn discs(positions: &[Position], strengths: &[i32]) -> Vec<Disc> {
    assert_eq!(positions.len(), strengths.len());
    let disc = |(id, (&position, &strength))| Disc { id, position, strength };
    (0..).zip(positions.iter().zip(strengths)).map(disc).collect()
}

/// `count` strengths between −1.5 and 1.5.
fn mixed(seed: u64, count: usize) -> Vec<i32> {
    let mut random = RandomNumbers::new(seed);
    (0..count).map(|_| ((3.0 * random.uniform() - 1.5) * f64::from(ONE)) as i32).collect()
}

/// The strengths as numbers.
fn as_numbers(strengths: &[i32]) -> Vec<f64> {
    strengths.iter().map(|&strength| f64::from(strength) / f64::from(ONE)).collect()
}

/// Forces by id, unit 2⁻²⁴ kBT/R0.
fn quantised<D: Into<Disc>>(parameters: &Parameters, discs: Vec<D>) -> Vec<[i64; 2]> {
    let mut arrays = Arrays::new(parameters.grid, 8, discs.len());
    let dynamics = Dynamics::new(parameters, Clock::START, discs, &mut arrays.memory()).unwrap();
    dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory()).unwrap();
    arrays.slots.iter().map(|&slot| [arrays.force_x[slot as usize], arrays.force_y[slot as usize]]).collect()
}

/// Forces by id, kBT/R0.
fn forces<D: Into<Disc>>(parameters: &Parameters, discs: Vec<D>) -> Vec<[f64; 2]> {
    quantised(parameters, discs).into_iter().map(|force| force.map(force_from_units)).collect()
}

/// The part of the force that comes from the mesh, by its stages alone, unit 2⁻²⁴ kBT/R0.
fn mesh_part(parameters: &Parameters, discs: &[Disc]) -> Vec<[i64; 2]> {
    let Parameters { assignment, grid, .. } = *parameters;
    let mesh = Grid::new(grid).unwrap();
    let positions: Vec<Position> = discs.iter().map(|disc| disc.position).collect();
    let strengths: Vec<i32> = discs.iter().map(|disc| disc.strength).collect();
    let (x, y) = coordinates(&positions);
    let (mut influence, mut gradient) = (vec![0.0; influence_length(grid)], vec![0.0; grid]);
    fill_influence(parameters, &mut influence);
    fill_gradient(parameters, &mut gradient);
    let tables = Tables { influence: &influence, gradient: &gradient };
    let zero = Complex32::new(0.0, 0.0);
    let (mut nodes, mut field) = (vec![0; grid * grid], vec![zero; grid * grid]);
    deposit_strengths(assignment, mesh, (&x, &y), &strengths, &mut nodes).unwrap();
    solve_strengths(&AnySize, mesh, &tables, &nodes, &mut field, &mut vec![zero; 16 * grid]);
    let (mut along_x, mut along_y) = (vec![0; discs.len()], vec![0; discs.len()]);
    gather_strengths(assignment, mesh, (&x, &y), &strengths, &field, (&mut along_x, &mut along_y));
    along_x.into_iter().zip(along_y).map(|(x, y)| [x, y]).collect()
}

fn total(forces: &[[i64; 2]]) -> [i64; 2] {
    [0, 1].map(|axis| forces.iter().map(|force| force[axis]).sum())
}

#[test]
fn like_discs_attract_and_unlike_ones_repel() {
    let side = SPLIT.side;
    for parameters in [SPLIT, MESH] {
        // Within the cut-off and beyond it; on the mesh near enough for the ringing of its gradient not to show.
        for distance in [1.0, 2.5, 9.0, 18.0] {
            let pair = [
                at(side, 20.0, 20.0).unwrap(),
                at(side, 20.0 + 0.8 * distance, 20.0 + 0.5 * distance).unwrap(),
            ];
            for (first, second) in [(1.0, 1.0), (1.0, -1.0), (-0.5, -1.0), (-0.25, 0.5), (2.0, -3.0)] {
                let strengths = [first, second].map(|f| (f * f64::from(ONE)) as i32);
                let [[x, y], [other_x, other_y]] = forces(&parameters, discs(&pair, &strengths))[..] else {
                    panic!("two discs");
                };
                let towards = first * second * (0.8 * x + 0.5 * y);
                let back = first * second * (0.8 * other_x + 0.5 * other_y);
                assert!(towards > 0.0 && back < 0.0, "{towards} {back} at {distance}, {first} {second}");
            }
        }
    }
}

#[test]
fn forces_between_unequal_discs_agree_with_ewald() {
    let positions = separated(1, 60, SPLIT.side, 1.0);
    let strengths = mixed(2, 60);
    for capillary_length in [4.0, 25.0, f64::INFINITY] {
        let parameters = Parameters { capillary_length, ..SPLIT };
        let ewald = Ewald::new(SPLIT.side, SPLIT.capillary_strength, capillary_length);
        let exact = ewald.forces_of(&in_radii(&positions, SPLIT.side), &as_numbers(&strengths));
        let found = forces(&parameters, discs(&positions, &strengths));
        let error = rms_difference(&found, &exact) / rms(&exact);
        assert_within(error, UNEQUAL_ERROR, &format!("lambda = {capillary_length}"));
    }
}

#[test]
fn repulsion_does_not_look_at_strengths() {
    let positions = crowded(3, 80, 0.3);
    let repelling = Parameters { repulsion: true, ..SPLIT };
    let strengths = mixed(4, 80);
    let both = quantised(&repelling, discs(&positions, &strengths));
    let attraction = quantised(&SPLIT, discs(&positions, &strengths));
    let places = in_radii(&positions, SPLIT.side);
    let exact = wca::forces(&places, SPLIT.side);
    for disc in 0..positions.len() {
        // The rounding of a pair's force is relative to the sum of the moduli of its terms.
        let moduli: f64 = places
            .iter()
            .enumerate()
            .filter(|&(other, _)| other != disc)
            .map(|(_, place)| {
                let distance = meniscus_tests::states::separation(
                    positions[disc],
                    at(SPLIT.side, place[0], place[1]).unwrap(),
                    SPLIT.side,
                );
                let held = distance.max(wca::SMALLEST_SEPARATION);
                let sixth = 64.0 / (held * held * held * held * held * held);
                if distance < wca::cutoff() { 24.0 / held * (2.0 * sixth * sixth + sixth) } else { 0.0 }
            })
            .sum();
        for axis in 0..2 {
            let found = force_from_units(both[disc][axis] - attraction[disc][axis]);
            let allowed = 1.5 * PAIR_FORCE * moduli + 160.0 * FORCE_QUANTUM;
            let off = (found - exact[disc][axis]).abs();
            assert!(off <= allowed, "disc {disc}: off by {off:e}, accepted {allowed:e}");
        }
    }
}

#[test]
fn discs_without_strength_exert_and_feel_exactly_no_capillary_force() {
    let positions = crowded(5, 100, 0.5);
    for parameters in [SPLIT, MESH] {
        assert_eq!(quantised(&parameters, discs(&positions, &[0; 100])), [[0; 2]; 100]);
        let repelling = Parameters { repulsion: true, ..parameters };
        let unattracted = Parameters { capillary_strength: 0.0, ..repelling };
        let expected = quantised(&unattracted, with_ids(&positions));
        assert_eq!(quantised(&repelling, discs(&positions, &[0; 100])), expected);
        assert!(expected.iter().any(|&force| force != [0; 2]));
    }
}

#[test]
fn a_disc_without_strength_changes_nothing_for_the_others() {
    let positions = scattered(6, 60);
    let strengths = mixed(7, 60);
    for parameters in [SPLIT, MESH] {
        // Among discs of any strengths, and among discs of strength 1, whose forces are then found by another way.
        for strengths in [strengths.clone(), vec![ONE; 60]] {
            let mut more_positions = positions.clone();
            let mut more_strengths = strengths.clone();
            more_positions.extend(scattered(8, 3));
            more_strengths.extend([0; 3]);
            let found = quantised(&parameters, discs(&more_positions, &more_strengths));
            assert_eq!(found[..60], quantised(&parameters, discs(&positions, &strengths)));
            assert_eq!(found[60..], [[0; 2]; 3]);
        }
    }
}

#[test]
fn all_signs_exchanged_are_the_same_forces() {
    let positions = crowded(9, 100, 0.6);
    let strengths = mixed(10, 100);
    let opposite: Vec<i32> = strengths.iter().map(|strength| -strength).collect();
    for parameters in everything() {
        assert_eq!(
            quantised(&parameters, discs(&positions, &opposite)),
            quantised(&parameters, discs(&positions, &strengths))
        );
    }
}

#[test]
fn forces_are_proportional_to_both_strengths() {
    let positions = scattered(11, 40);
    for parameters in [SPLIT, MESH] {
        let unit = forces(&parameters, with_ids(&positions));
        for factor in [-2.0, 0.3, 5.0] {
            let strength = (factor * f64::from(ONE)) as i32;
            let squared = as_numbers(&[strength])[0] * as_numbers(&[strength])[0];
            let found = forces(&parameters, discs(&positions, &[strength; 40]));
            let expected: Vec<[f64; 2]> = unit.iter().map(|force| force.map(|f| squared * f)).collect();
            assert!(rms_difference(&found, &expected) <= STRENGTH_RATIO * rms(&expected), "{factor}");
        }
    }
}

#[test]
fn forces_of_pairs_sum_to_zero_bit_for_bit() {
    for (width, seed) in [(0.99, 12), (0.4, 13), (0.1, 14)] {
        let positions = crowded(seed, 120, width);
        for strengths in [mixed(seed, 120), vec![ONE; 120]] {
            for parameters in everything() {
                let discs = discs(&positions, &strengths);
                // What is not from the mesh is from pairs.
                let mesh = mesh_part(&parameters, &discs);
                let all = quantised(&parameters, discs);
                assert_ne!(all, mesh);
                assert_eq!(total(&all), total(&mesh));
                let moduli: f64 = mesh.iter().map(|force| rms(&[force.map(|units| units as f64)])).sum();
                let net = rms(&[total(&mesh).map(|units| units as f64)]);
                assert!(net <= MESH_NET_FORCE * moduli, "{:e} of the moduli", net / moduli);
            }
        }
    }
}

#[test]
fn below_the_smallest_distance_the_pair_force_is_held() {
    let side = SPLIT.side;
    let parameters = Parameters { repulsion: true, ..SPLIT };
    let Parameters { capillary_strength, capillary_length, splitting, .. } = SPLIT;
    let ewald = Ewald::new(side, capillary_strength, capillary_length);
    let near = |distance: f64| near_force(distance, capillary_strength, capillary_length, splitting);
    let first = at(side, 13.3, 7.7).unwrap();
    for distance in [0.0, 1e-6, 0.1, 0.5, 0.85] {
        for (f, g) in [(1.0, 1.0), (1.0, -1.0), (1.5, -0.5)] {
            let (sine, cosine) = libm::sincos(TAU * 0.1);
            let second = at(side, 13.3 + distance * cosine, 7.7 + distance * sine).unwrap();
            let [a, b] = [in_radii(&[first], side)[0], in_radii(&[second], side)[0]];
            let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
            let separation = libm::hypot(dx, dy);
            // Away from the second disc, which is to the upper right; to the right if they coincide.
            let away = if separation > 0.0 { [-dx / separation, -dy / separation] } else { [1.0, 0.0] };
            let held = wca::force_magnitude(0.9) - f * g * near(0.9);
            // Only the far part, which the mesh has, still depends on the distance.
            let smooth = if separation > 0.0 {
                let [x, y] = ewald.pair_force(dx, dy);
                let bare = near(separation);
                [f * g * (x + bare * away[0]), f * g * (y + bare * away[1])]
            } else {
                [0.0; 2]
            };
            let strengths = [f, g].map(|f: f64| (f * f64::from(ONE)) as i32);
            let found = forces(&parameters, discs(&[first, second], &strengths));
            let exact = [held * away[0] + smooth[0], held * away[1] + smooth[1]];
            let allowed = PAIR_FORCE * held + SPLIT_PAIR;
            let off = rms_difference(&[found[0]], &[exact]);
            assert!(
                off <= allowed,
                "{off:e}, accepted {allowed:e}, at {distance}, {f} {g}: {found:?} {exact:?}"
            );
            // The same without repulsion, where the near part is all that is held.
            let found = forces(&SPLIT, discs(&[first, second], &strengths));
            let held = -f * g * near(0.9);
            let exact = [held * away[0] + smooth[0], held * away[1] + smooth[1]];
            let off = rms_difference(&[found[0]], &[exact]);
            assert!(off <= SPLIT_PAIR, "{off:e} at {distance}, {f} {g}: {found:?} {exact:?}");
        }
    }
}

type Small = Engine<32, 160>;

fn started<D: Into<Disc>>(parameters: &Parameters, discs: Vec<D>) -> Box<Small> {
    let mut engine = Box::new(Engine::new());
    engine.init(parameters, discs).unwrap();
    engine
}

/// Digest, step by step, and forces of the last step by id.
fn history(engine: &mut Small, steps: usize) -> (Vec<StateDigest>, Vec<Option<(i64, i64)>>) {
    let mut digests = Vec::new();
    for _ in 0..steps {
        digests.push(engine.state().digest_by_field());
        engine.step().unwrap();
    }
    (digests, (0..engine.count() as u32).map(|id| engine.force(id)).collect())
}

#[test]
fn the_order_of_storage_changes_no_bit() {
    let positions = crowded(15, 150, 0.8);
    let discs = discs(&positions, &mixed(16, 150));
    for parameters in everything() {
        let expected = history(&mut started(&parameters, discs.clone()), 8);
        for order in 0..4 {
            assert_eq!(history(&mut started(&parameters, shuffled(order, &discs)), 8), expected);
        }
    }
}

#[test]
fn a_strength_belongs_to_its_id() {
    let positions = scattered(17, 50);
    let strengths = mixed(18, 50);
    let reversed: Vec<i32> = strengths.iter().rev().copied().collect();
    let state = |strengths: &[i32]| started(&SPLIT, discs(&positions, strengths)).state().digest();
    assert_ne!(state(&strengths), state(&reversed));
    // The same places and strengths under other ids feel the same.
    let mirrored: Vec<Position> = positions.iter().rev().copied().collect();
    let mut expected = quantised(&SPLIT, discs(&positions, &strengths));
    expected.reverse();
    assert_eq!(quantised(&SPLIT, discs(&mirrored, &reversed)), expected);
}

#[test]
fn strengths_of_one_given_are_as_none_given() {
    let positions = crowded(19, 150, 0.8);
    for parameters in everything() {
        let mut none_given = started(&parameters, with_ids(&positions));
        let mut given = started(&parameters, discs(&positions, &[ONE; 150]));
        assert_eq!(history(&mut given, 10), history(&mut none_given, 10));
        assert_eq!(given.state().digest(), none_given.state().digest());
    }
}

#[test]
fn strengths_out_of_range_are_refused() {
    let positions = scattered(20, 3);
    let refusal = |capillary_strength: f64, strengths: [i32; 3]| {
        let parameters = Parameters { capillary_strength, ..SPLIT };
        let mut engine = Box::new(Small::new());
        let result = engine.init(&parameters, discs(&positions, &strengths));
        (result, engine.step().err())
    };
    let refused = (Err(InitError::Strength { id: 1 }), Some(StepError::NotInitialised));
    // |f| at most 1000, V0·f² at most 1000 kBT.
    assert_eq!(refusal(0.001, [ONE, 1000 * ONE, -1000 * ONE]).0, Ok(()));
    assert_eq!(refusal(0.001, [ONE, 1000 * ONE + 1, ONE]), refused);
    assert_eq!(refusal(0.001, [ONE, -1000 * ONE - 1, ONE]), refused);
    assert_eq!(refusal(0.0, [ONE, i32::MIN, ONE]), refused);
    assert_eq!(refusal(0.0, [ONE, i32::MAX, ONE]), refused);
    assert_eq!(refusal(10.0, [10 * ONE, -10 * ONE, 0]).0, Ok(()));
    assert_eq!(refusal(10.0, [10 * ONE, 10 * ONE + 1, 0]), refused);
}

#[test]
fn strengths_that_crowd_a_node_refuse_the_step_and_leave_the_state() {
    let positions = vec![at(SPLIT.side, 5.0, 5.0).unwrap(); 3];
    let weak = Parameters { capillary_strength: 1e-3, assignment: Assignment::CloudInCell, ..MESH };
    let mut engine = started(&weak, discs(&positions, &[1000 * ONE, -1000 * ONE, 48 * ONE]));
    let before = engine.state().digest();
    assert_eq!(engine.step(), Err(StepError::Crowded));
    assert_eq!(engine.state().digest(), before);
    let mut engine = started(&weak, discs(&positions, &[1000 * ONE, -1000 * ONE, 47 * ONE]));
    assert!(engine.step().is_ok());
}
