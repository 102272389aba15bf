//! The force of a pair with the near part of the split force.

use super::bytes::Bytes;
use crate::reference::near_part::near_force as reference;
use crate::reference::wca;
use crate::tolerances::{FORCE_QUANTUM, NEAR_FORCE, PAIR_FORCE};
use meniscus_core::assignment::DISC;
use meniscus_core::cells::Separation;
use meniscus_core::near_part::{fill_table, table_length};
use meniscus_core::pair_force::{PairForce, near_cutoff, product_of_strengths};
use meniscus_core::parameters::{
    Influence, LARGEST_CAPILLARY_STRENGTH, LARGEST_STRENGTH, Method, Parameters, SMALLEST_CAPILLARY_LENGTH,
    SMALLEST_CUTOFF, SPLITTING_RANGE,
};
use meniscus_core::repulsion::{CUTOFF, SMALLEST_DISTANCE};
use meniscus_core::torus::{LARGEST_SIDE, Torus};
use meniscus_core::units::force_from_units;

/// Most separations: the reference integrates for each.
const SEPARATIONS: usize = 32;

/// Parameters, two strengths and some separations; then, of each pair force: seen from the other disc it is the
/// negative bit for bit, exchanging the strengths changes nothing, discs beyond the cut-offs or at half a box have
/// none, and it is that of closed form and quadrature.
pub fn near_force(data: &[u8]) {
    let mut bytes = Bytes(data);
    let side = bytes.number(2.0 * CUTOFF, LARGEST_SIDE);
    let mut grid = 16;
    while grid < 4096 && side / grid as f64 > 1.0 {
        grid *= 2;
    }
    let parameters = Parameters {
        side,
        grid,
        capillary_strength: bytes.number(0.0, LARGEST_CAPILLARY_STRENGTH),
        capillary_length: bytes.number(SMALLEST_CAPILLARY_LENGTH, 1e5),
        repulsion: bytes.flag(),
        method: Method::P3m,
        influence: Influence::Optimal,
        splitting: bytes.number(SPLITTING_RANGE.0, 0.7 * grid as f64 / side),
        cutoff: bytes.number(SMALLEST_CUTOFF, 0.5 * side),
        ..Parameters::PAPER
    };
    let (Ok(()), Ok(torus)) = (parameters.validate(), Torus::new(side)) else { return };
    let strengths = [0; 2].map(|_| strength(&mut bytes, parameters.capillary_strength));
    let mut table = vec![[f32::NAN; 4]; table_length(near_cutoff(&parameters))];
    fill_table(parameters.splitting, parameters.capillary_length, &mut table);
    assert!(table.iter().flatten().all(|coefficient| coefficient.is_finite()), "{parameters:?}");
    let pair = Pair { parameters, torus, force: PairForce::new(&parameters), strengths, table: &table };
    for _ in 0..SEPARATIONS {
        if bytes.is_empty() {
            return;
        }
        let shift = u32::from(bytes.byte() % 32);
        let (x, y) = (bytes.bits_32() as i32 >> shift, bytes.bits_32() as i32 >> shift);
        pair.check(Separation { x, y }, bytes.flag());
    }
}

/// A strength that the core accepts with this V0, unit 2⁻²⁰.
fn strength(bytes: &mut Bytes<'_>, capillary_strength: f64) -> i32 {
    let largest = (LARGEST_CAPILLARY_STRENGTH / capillary_strength).sqrt().min(LARGEST_STRENGTH);
    let units = (largest * f64::from(DISC)) as i32;
    match bytes.byte() {
        0 => 0,
        1 => units,
        2 => -units,
        3 => DISC as i32,
        _ => (bytes.bits_32() as i32).clamp(-units, units),
    }
    .clamp(-units, units)
}

struct Pair<'a> {
    parameters: Parameters,
    torus: Torus,
    force: PairForce,
    strengths: [i32; 2],
    table: &'a [[f32; 4]],
}

impl Pair<'_> {
    fn check(&self, separation: Separation, first_is_lower: bool) {
        let [first, second] = self.strengths;
        let of = |separation, lower, product| self.force.of(separation, lower, product, self.table);
        let force = of(separation, first_is_lower, product_of_strengths(first, second));
        let Separation { x, y } = separation;
        let exchanged = Separation { x: x.wrapping_neg(), y: y.wrapping_neg() };
        let negative = of(exchanged, !first_is_lower, product_of_strengths(second, first));
        assert_eq!(force, negative.map(|(x, y)| (-x, -y)), "{separation:?} with {:?}", self.parameters);

        let (length_x, length_y) = (self.torus.length(x), self.torus.length(y));
        let distance = libm::hypot(length_x, length_y);
        let repulsion = if self.parameters.repulsion { CUTOFF } else { 0.0 };
        let cutoff = repulsion.max(near_cutoff(&self.parameters));
        let Some((force_x, force_y)) = force else {
            assert!(distance >= cutoff * (1.0 - PAIR_FORCE), "no force of {separation:?}");
            return;
        };
        assert!(distance < cutoff * (1.0 + PAIR_FORCE), "a force of {separation:?}");
        assert!(x.unsigned_abs().max(y.unsigned_abs()) <= self.force.reach());
        self.compare([force_x, force_y].map(force_from_units), (length_x, length_y), first_is_lower);
    }

    /// Against the references; at the cut-offs, where the force may jump, it may be on either side.
    fn compare(&self, force: [f64; 2], (x, y): (f64, f64), first_is_lower: bool) {
        let distance = libm::hypot(x, y);
        let held = distance.max(SMALLEST_DISTANCE);
        let (mut outward, mut tolerance) = (0.0, FORCE_QUANTUM);
        if self.parameters.repulsion && held < CUTOFF * (1.0 + PAIR_FORCE) {
            let sixth =
                (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held) * (2.0 / held);
            outward += wca::force_magnitude(held);
            tolerance += PAIR_FORCE * 24.0 / held * sixth * (2.0 * sixth + 1.0);
        }
        let near = near_cutoff(&self.parameters);
        if held < near * (1.0 + PAIR_FORCE) {
            let unit = f64::from(DISC);
            let product = f64::from(self.strengths[0]) / unit * (f64::from(self.strengths[1]) / unit);
            let Parameters { capillary_strength, capillary_length, splitting, .. } = self.parameters;
            let attraction = product * reference(held, capillary_strength, capillary_length, splitting);
            outward -= attraction;
            tolerance += NEAR_FORCE * (product * capillary_strength / held).abs();
            if held > near * (1.0 - PAIR_FORCE) {
                tolerance += attraction.abs();
            }
        }
        let along = match distance {
            0.0 if first_is_lower => [1.0, 0.0],
            0.0 => [-1.0, 0.0],
            _ => [x / distance, y / distance],
        };
        for (found, direction) in force.iter().zip(along) {
            let expected = outward * direction;
            assert!(
                (found - expected).abs() <= tolerance,
                "{found}, not {expected}, at ({x}, {y}) with {:?} and strengths {:?}",
                self.parameters,
                self.strengths
            );
        }
    }
}
