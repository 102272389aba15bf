//! A fault planted for every invariant.

use super::{ATTRACTION, SIDE, mesh_rounding, torus};
use meniscus_core::grid::Grid;
use meniscus_core::parameters::Assignment;
use meniscus_core::property::pairs::Capillary;
use meniscus_core::property::{Discs, Invariant, Tolerance, Violation, forces, kernels, masses, pairs};
use meniscus_tests::reference::minimum_image;
use std::collections::HashSet;

/// Attraction V0·f·f′/d without images: what the faults are planted in.
fn gravity([x, y]: [f64; 2]) -> [f64; 2] {
    let square = x * x + y * y;
    if square > 0.0 { [0.89 * x / square, 0.89 * y / square] } else { [0.0; 2] }
}

/// The forces of a state by those of its pairs, from the ids of this disc and the other and their separation.
fn by_pairs(
    coordinates: &[[f64; 2]],
    separation: impl Fn(f64) -> f64,
    force: impl Fn(usize, usize, [f64; 2]) -> [f64; 2],
) -> Vec<[f64; 2]> {
    let ids = 0..coordinates.len();
    let on = |disc: usize| {
        let add = |sum: [f64; 2], other: usize| {
            let [x, y] = [0, 1].map(|axis| separation(coordinates[other][axis] - coordinates[disc][axis]));
            let force = force(disc, other, [x, y]);
            [sum[0] + force[0], sum[1] + force[1]]
        };
        ids.clone().filter(|&other| other != disc).fold([0.0; 2], add)
    };
    ids.clone().map(on).collect()
}

/// Sound: the nearest image of every other disc.
fn nearest_images(discs: &Discs) -> Vec<[f64; 2]> {
    let side = discs.side();
    by_pairs(
        &discs.coordinates(),
        |x| minimum_image(x, side),
        |disc, other, separation| {
            let strengths = discs.strength(disc) * discs.strength(other);
            gravity(separation).map(|component| strengths * component)
        },
    )
}

/// Forgets the wrap.
pub(super) fn unwrapped(discs: &Discs) -> Vec<[f64; 2]> {
    by_pairs(&discs.coordinates(), |x| x, |_, _, separation| gravity(separation))
}

/// As a force kernel, sound but for a change of the forces.
fn altered(change: impl Fn(&mut Vec<[f64; 2]>, &Discs)) -> impl Fn(&Discs) -> Vec<[f64; 2]> {
    move |discs| {
        let mut forces = nearest_images(discs);
        change(&mut forces, discs);
        forces
    }
}

/// Sound: the core's cloud in cell, but for a change of the node masses.
fn altered_masses(change: impl Fn(&mut Vec<i64>, &Discs)) -> impl Fn(&Discs) -> Vec<i64> {
    let sound = kernels::masses(Assignment::CloudInCell, Grid::SMALLEST);
    move |discs| {
        let mut nodes = sound(discs);
        change(&mut nodes, discs);
        nodes
    }
}

/// Energy of [`nearest_images`], kBT.
fn energy(discs: &Discs) -> f64 {
    let side = discs.side();
    let coordinates = discs.coordinates();
    let mut sum = 0.0;
    for (disc, at) in coordinates.iter().enumerate() {
        for (other, from) in coordinates[..disc].iter().enumerate() {
            let [x, y] = [0, 1].map(|axis| minimum_image(from[axis] - at[axis], side));
            sum += 0.89 * discs.strength(disc) * discs.strength(other) * libm::log(libm::hypot(x, y));
        }
    }
    sum
}

/// Every invariant of forces on a sound or unsound kernel, with an energy.
fn all_of_forces(kernel: &impl Fn(&Discs) -> Vec<[f64; 2]>, discs: &Discs) -> Vec<Violation> {
    let tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };
    let slope = Tolerance::relative(1e-5);
    let shift = (0x2345_6789, 0xA987_6543);
    [
        forces::momentum(kernel, discs, tolerance),
        forces::self_force(kernel, discs, tolerance),
        forces::translation(kernel, discs, shift, tolerance),
        forces::translation_by_cells(kernel, discs, Grid::SMALLEST, (5, 9), tolerance),
        forces::quarter_turns(kernel, discs, tolerance),
        forces::reflections(kernel, discs, tolerance),
        forces::permutation(kernel, discs, tolerance),
        forces::opposite_strength(kernel, discs, tolerance),
        forces::energy_consistency(kernel, energy, discs, 1e-4, slope),
    ]
    .into_iter()
    .filter_map(Result::err)
    .collect()
}

/// Seven discs of different strengths, two pairs of them across the border.
fn some_discs() -> Discs {
    let at = [[1.0, 2.0], [63.0, 5.0], [20.0, 63.5], [21.0, 3.0], [40.0, 33.0], [47.0, 31.0], [10.0, 20.0]];
    Discs::from_coordinates(torus(SIDE), &at).with_strengths(&[1 << 20, -(1 << 19), 3 << 18])
}

#[test]
fn a_sound_kernel_violates_nothing() {
    assert_eq!(all_of_forces(&nearest_images, &some_discs()), []);
}

/// A fault, the invariant made for it, and what the invariant says.
type Planted = (&'static str, Invariant, Result<(), Violation>);

fn planted_in_forces() -> Vec<Planted> {
    let discs = &some_discs();
    let tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };
    let first_of_two = altered(|forces, _| forces.truncate(1));
    let sign = altered(|forces, _| forces[3] = forces[3].map(|component| -component));
    let not_a_number = altered(|forces, _| forces[2][0] = f64::NAN);
    let pulls_itself = altered(|forces, _| forces.iter_mut().for_each(|force| force[1] += 1e-6));
    let near_the_border = altered(|forces, discs| {
        for (force, [x, _]) in forces.iter_mut().zip(discs.coordinates()) {
            force[0] *= if x > 60.0 { 0.99 } else { 1.0 };
        }
    });
    let coarse_along_y = altered(|forces, _| {
        forces.iter_mut().for_each(|force| force[1] = (force[1] * 1e6).floor() / 1e6);
    });
    let whirl = altered(|forces, _| {
        forces.iter_mut().for_each(|force| *force = [force[0] - 0.01 * force[1], force[1] + 0.01 * force[0]]);
    });
    let first_is_heavier = altered(|forces, _| forces[0][0] *= 1.001);
    let moduli = |discs: &Discs| {
        let positive: Vec<i32> = discs.strengths().iter().map(|strength| strength.abs()).collect();
        nearest_images(&discs.clone().with_strengths(&positive))
    };
    let too_strong = altered(|forces, _| {
        forces.iter_mut().for_each(|force| *force = force.map(|component| 1.001 * component));
    });
    let no_wrap = |coordinates: &[[f64; 2]], _: f64| by_pairs(coordinates, |x| x, |_, _, at| gravity(at));
    vec![
        ("a force too few", Invariant::Count, forces::momentum(first_of_two, discs, tolerance)),
        ("one sign exchanged", Invariant::Momentum, forces::momentum(sign, discs, tolerance)),
        ("not a number", Invariant::Momentum, forces::momentum(not_a_number, discs, tolerance)),
        ("a force on itself", Invariant::SelfForce, forces::self_force(pulls_itself, discs, tolerance)),
        (
            "the border is seen",
            Invariant::Translation,
            forces::translation_by_cells(near_the_border, discs, Grid::SMALLEST, (3, 0), tolerance),
        ),
        (
            "no minimum image",
            Invariant::Translation,
            forces::translation(unwrapped, discs, (1 << 31, 0), tolerance),
        ),
        (
            "one axis rounded",
            Invariant::QuarterTurns,
            forces::quarter_turns(coarse_along_y, discs, tolerance),
        ),
        ("a whirl", Invariant::Reflections, forces::reflections(&whirl, discs, tolerance)),
        ("the id is seen", Invariant::Permutation, forces::permutation(first_is_heavier, discs, tolerance)),
        ("no minimum image of coordinates", Invariant::Wrap, forces::wrap(no_wrap, discs, tolerance)),
        (
            "moduli of strengths",
            Invariant::OppositeStrength,
            forces::opposite_strength(moduli, discs, tolerance),
        ),
        (
            "a thousandth too strong",
            Invariant::EnergyConsistency,
            forces::energy_consistency(too_strong, energy, discs, 1e-4, Tolerance::relative(1e-5)),
        ),
    ]
}

fn planted_in_pairs() -> Vec<Planted> {
    let tolerance = Tolerance::relative(1e-9);
    let capillary = Capillary { strength: 0.89, length: 30.0, side: f64::INFINITY };
    let (near, far) = ([2.0, 1.5], [120.0, 160.0]);
    let rounded_down = |at: [f64; 2]| gravity(at).map(|component| (component * 1e6).floor() / 1e6);
    let across = |[x, y]: [f64; 2]| [gravity([x, y])[0] - 1e-3 * y, gravity([x, y])[1] + 1e-3 * x];
    let square = |[x, y]: [f64; 2]| [0.89 * x / x.abs().max(y.abs()), 0.89 * y / x.abs().max(y.abs())];
    let repels = |at: [f64; 2]| gravity(at).map(|component| -component);
    let in_space = |at: [f64; 2]| gravity(at).map(|component| component / libm::hypot(at[0], at[1]));
    vec![
        ("rounded down", Invariant::PairSymmetry, pairs::pair_symmetry(rounded_down, near, tolerance)),
        ("a force across", Invariant::Centrality, pairs::centrality(across, near, tolerance)),
        ("a square metric", Invariant::Isotropy, pairs::isotropy(square, near, 0.3, tolerance)),
        ("no minimum image of a pair", Invariant::Wrap, pairs::wrap(gravity, near, SIDE, tolerance)),
        ("the sign of Eq. 21 as printed", Invariant::Attraction, pairs::attraction(repels, near, tolerance)),
        ("V0/d²", Invariant::FarField, pairs::far_field(in_space, capillary, near, tolerance)),
        ("no screening", Invariant::Screening, pairs::screening(gravity, capillary, far, tolerance)),
    ]
}

fn planted_in_masses() -> Vec<Planted> {
    let (discs, grid, tolerance) = (&some_discs(), Grid::SMALLEST, Tolerance::EXACT);
    let quantum_lost = altered_masses(|nodes, _| nodes[7] -= 1);
    let saturates =
        altered_masses(|nodes, _| nodes.iter_mut().for_each(|mass| *mass = (*mass).max(-100_000)));
    let last_row = altered_masses(|nodes, _| nodes.swap(254, 255));
    let beside = altered_masses(|nodes, _| nodes.rotate_right(1));
    vec![
        ("a quantum lost", Invariant::TotalMass, masses::total(quantum_lost, discs, tolerance)),
        ("a saturated node", Invariant::Superposition, masses::superposition(saturates, discs, tolerance)),
        (
            "nodes of the border exchanged",
            Invariant::MassTranslation,
            masses::translation_by_cells(
                last_row,
                &Discs::from_coordinates(torus(SIDE), &[[59.0, 57.0]]),
                grid,
                (1, 0),
                tolerance,
            ),
        ),
        (
            "one node aside",
            Invariant::CenterOfMass,
            masses::center_of_mass(beside, discs, grid, Tolerance::absolute(1e-3)),
        ),
    ]
}

#[test]
fn every_invariant_catches_the_fault_planted_for_it() {
    let planted = [planted_in_forces(), planted_in_pairs(), planted_in_masses()].concat();
    for (fault, invariant, result) in &planted {
        let violation = result.as_ref().expect_err(fault);
        assert_eq!(violation.invariant, *invariant, "{fault}: {violation}");
        println!("{fault}: {violation}");
    }
    let caught: HashSet<Invariant> = planted.iter().map(|&(_, invariant, _)| invariant).collect();
    assert_eq!(caught.len(), Invariant::ALL.len(), "no fault is planted for some invariant");
}

#[test]
fn faults_are_told_apart() {
    let discs = some_discs();
    // A whirl conserves momentum, turns with the box and is no gradient.
    let whirl = altered(|forces, _| {
        forces.iter_mut().for_each(|force| *force = [force[0] - 0.01 * force[1], force[1] + 0.01 * force[0]]);
    });
    let found: Vec<_> = all_of_forces(&whirl, &discs).iter().map(|violation| violation.invariant).collect();
    assert_eq!(found, [Invariant::Reflections, Invariant::EnergyConsistency]);
    // Too strong by a constant factor is sound but for the energy.
    let strong = altered(|forces, _| forces.iter_mut().for_each(|force| *force = force.map(|f| 1.1 * f)));
    let found: Vec<_> = all_of_forces(&strong, &discs).iter().map(|violation| violation.invariant).collect();
    assert_eq!(found, [Invariant::EnergyConsistency]);
}

#[test]
fn the_rounding_allowed_to_the_mesh_hides_no_thousandth() {
    let mut mesh = kernels::forces(&ATTRACTION).unwrap();
    let altered = |discs: &Discs| {
        let mut forces = mesh(discs);
        forces[0] = forces[0].map(|component| 1.001 * component);
        forces
    };
    // Equal strengths: the first disc is pulled with about 0.1 kBT/R0.
    let discs = some_discs().with_strengths(&[1 << 20]);
    let violation = forces::momentum(altered, &discs, mesh_rounding(&ATTRACTION, 1)).unwrap_err();
    assert_eq!(violation.invariant, Invariant::Momentum);
}

#[test]
fn a_violation_names_the_discs_at_fault() {
    let quicker = altered(|forces, _| {
        for disc in [1, 4] {
            forces[disc][0] += 0.5;
        }
    });
    let violation =
        forces::energy_consistency(quicker, energy, &some_discs(), 1e-4, Tolerance::relative(1e-5));
    let violation = violation.unwrap_err();
    assert_eq!(violation.at, [1, 4]);
    assert!((violation.found - 0.5).abs() < 1e-4);
    let line = violation.to_string();
    assert!(line.starts_with("energy consistency: off by ") && line.ends_with("; at 1, 4"), "{line}");
    assert!(line.is_ascii() && !line.contains('\n'));
}

#[test]
fn an_empty_state_violates_nothing() {
    let nobody = Discs::new(torus(SIDE), vec![]);
    assert_eq!(all_of_forces(&nearest_images, &nobody), []);
    let mut kernel = kernels::forces(&ATTRACTION).unwrap();
    assert_eq!(forces::momentum(&mut kernel, &nobody, Tolerance::EXACT), Ok(()));
    let kernel = kernels::masses(Assignment::Order4, Grid::SMALLEST);
    assert_eq!(masses::total(kernel, &nobody, Tolerance::EXACT), Ok(()));
}
