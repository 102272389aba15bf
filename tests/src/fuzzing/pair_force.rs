//! The repulsion of a pair.

use super::bytes::Bytes;
use crate::reference::wca;
use crate::tolerances::{FORCE_QUANTUM, PAIR_FORCE};
use meniscus_core::cells::Separation;
use meniscus_core::pair_force::PairForce;
use meniscus_core::repulsion::{CUTOFF, LARGEST_FORCE, SMALLEST_DISTANCE};
use meniscus_core::torus::{LARGEST_SIDE, Torus};
use meniscus_core::units::force_from_units;

/// A side and some separations; then, of each pair force: seen from the other disc it is the negative bit for bit,
/// discs at half a box or beyond the cut-off have none, it is that of the closed form, and no component exceeds the
/// largest force.
pub fn pair_force(data: &[u8]) {
    let mut bytes = Bytes(data);
    let side = bytes.number(2.0 * CUTOFF, LARGEST_SIDE);
    let Ok(torus) = Torus::new(side) else { return };
    if side <= 2.0 * CUTOFF {
        return;
    }
    let repulsion = PairForce::repulsion(side);
    while !bytes.is_empty() {
        let shift = u32::from(bytes.byte() % 32);
        let (x, y) = (bytes.bits_32() as i32 >> shift, bytes.bits_32() as i32 >> shift);
        check(&torus, &repulsion, Separation { x, y }, bytes.flag());
    }
}

fn check(torus: &Torus, repulsion: &PairForce, separation: Separation, first_is_lower: bool) {
    let force = repulsion.of(separation, first_is_lower, PairForce::EQUAL, &[]);
    let Separation { x, y } = separation;
    let exchanged = Separation { x: x.wrapping_neg(), y: y.wrapping_neg() };
    let negative = repulsion.of(exchanged, !first_is_lower, PairForce::EQUAL, &[]).map(|(x, y)| (-x, -y));
    assert_eq!(force, negative, "{separation:?} in {torus:?}");

    let (length_x, length_y) = (torus.length(x), torus.length(y));
    let distance = libm::hypot(length_x, length_y);
    if x == i32::MIN || y == i32::MIN || distance > CUTOFF * (1.0 + PAIR_FORCE) {
        assert_eq!(force, None, "{separation:?} in {torus:?}");
    }
    let Some((force_x, force_y)) = force else {
        assert!(distance > CUTOFF * (1.0 - PAIR_FORCE), "no force of {separation:?} in {torus:?}");
        return;
    };
    assert!(x.unsigned_abs() <= repulsion.reach() && y.unsigned_abs() <= repulsion.reach());
    let force = [force_from_units(force_x), force_from_units(force_y)];
    assert!(force.iter().all(|component| component.abs() <= LARGEST_FORCE), "{force:?} of {separation:?}");
    let held = distance.max(SMALLEST_DISTANCE);
    let sixth = (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held);
    let tolerance = PAIR_FORCE * 24.0 / held * sixth * (2.0 * sixth + 1.0) + FORCE_QUANTUM;
    // The reference gives the force on the disc at the origin from where the other one is.
    let [mut expected_x, expected_y] = wca::pair_force(-length_x, -length_y);
    if distance == 0.0 && !first_is_lower {
        expected_x = -expected_x;
    }
    for (found, expected) in force.iter().zip([expected_x, expected_y]) {
        assert!(
            (found - expected).abs() <= tolerance,
            "{found}, not {expected}, of {separation:?} in {torus:?}"
        );
    }
}
