//! The repulsion at contact: Weeks, Chandler and Andersen's potential with the scale k_B T (Eq. 15).

use super::minimum_image;

/// Separation below which the force keeps its value, in R₀. It is about 7.7e5 k_B T/R₀ there: the engine
/// caps it so that every pair force has a bound, and the step rule parts such discs in a few steps.
pub const SMALLEST_SEPARATION: f64 = 0.9;

/// Separation d_c = 2·2^(1/6) (R₀) of the minimum of the potential, beyond which there is no repulsion.
pub fn cutoff() -> f64 {
    2.0 * libm::cbrt(core::f64::consts::SQRT_2)
}

/// Energy (k_B T) of two discs `separation` (R₀) apart: 4[(2/d)¹² − (2/d)⁶ + ¼] up to d_c, then 0; below
/// [`SMALLEST_SEPARATION`] it goes on as the straight line whose slope is the capped force.
pub fn energy(separation: f64) -> f64 {
    if separation >= cutoff() {
        return 0.0;
    }
    let held = separation.max(SMALLEST_SEPARATION);
    let sixth = sixth_power_of_ratio(held);
    4.0 * (sixth * sixth - sixth + 0.25) + force_magnitude(held) * (held - separation)
}

/// Magnitude (k_B T/R₀) of the repulsion of two discs `separation` (R₀) apart:
/// (24/d)[2(2/d)¹² − (2/d)⁶] up to d_c, then 0; below [`SMALLEST_SEPARATION`] the value there.
pub fn force_magnitude(separation: f64) -> f64 {
    if separation >= cutoff() {
        return 0.0;
    }
    let held = separation.max(SMALLEST_SEPARATION);
    let sixth = sixth_power_of_ratio(held);
    24.0 / held * sixth * (2.0 * sixth - 1.0)
}

/// Force (k_B T/R₀) on a disc at the origin due to a disc at (`dx`, `dy`) (R₀), no images.
///
/// Discs at the same place have no direction: the disc at the origin is then taken as the one with the
/// lower id, which is pushed along +x.
pub fn pair_force(dx: f64, dy: f64) -> [f64; 2] {
    let separation = libm::hypot(dx, dy);
    let magnitude = force_magnitude(separation);
    if separation == 0.0 {
        return [magnitude, 0.0];
    }
    [-magnitude * dx / separation, -magnitude * dy / separation]
}

/// Forces (k_B T/R₀) on discs at `positions` (R₀) in a periodic box of this `side` (R₀), which must be
/// wider than 2 d_c: every pair at its minimum image.
pub fn forces(positions: &[[f64; 2]], side: f64) -> Vec<[f64; 2]> {
    let mut forces = vec![[0.0; 2]; positions.len()];
    for (i, first) in positions.iter().enumerate() {
        for (j, second) in positions.iter().enumerate().skip(i + 1) {
            let dx = minimum_image(second[0] - first[0], side);
            let dy = minimum_image(second[1] - first[1], side);
            let [x, y] = pair_force(dx, dy);
            forces[i][0] += x;
            forces[i][1] += y;
            forces[j][0] -= x;
            forces[j][1] -= y;
        }
    }
    forces
}

/// (2/d)⁶.
fn sixth_power_of_ratio(separation: f64) -> f64 {
    let square = 4.0 / (separation * separation);
    square * square * square
}

#[cfg(test)]
mod tests {
    use super::super::RandomNumbers;
    use super::*;

    #[test]
    fn force_at_contact_is_twelve() {
        assert_eq!(force_magnitude(2.0), 12.0);
        assert_eq!(energy(2.0), 1.0);
    }

    #[test]
    fn force_and_energy_vanish_at_the_cutoff() {
        let just_inside = cutoff() * (1.0 - 1e-9);
        assert!(force_magnitude(just_inside).abs() < 1e-6);
        assert!(energy(just_inside).abs() < 1e-14);
        assert_eq!(force_magnitude(cutoff()), 0.0);
    }

    #[test]
    fn force_is_minus_the_slope_of_the_energy() {
        for separation in [0.2, 0.6, 0.95, 1.3, 1.9, 2.1, 2.24] {
            let h = 1e-4;
            let difference = |h: f64| (energy(separation - h) - energy(separation + h)) / (2.0 * h);
            let slope = (4.0 * difference(h) - difference(2.0 * h)) / 3.0;
            let force = force_magnitude(separation);
            assert!((slope / force - 1.0).abs() < 1e-8, "at {separation}: {slope} {force}");
        }
    }

    #[test]
    fn discs_at_one_place_are_parted_along_x() {
        let forces = forces(&[[1.0, 1.0], [1.0, 1.0]], 100.0);
        assert!(forces[0][0] > 7e5 && forces[0][0] < 8e5);
        assert_eq!(forces[0][1], 0.0);
        assert_eq!(forces[1], [-forces[0][0], 0.0]);
    }

    #[test]
    fn repulsion_crosses_the_border_of_the_box() {
        let forces = forces(&[[0.5, 3.0], [8.5, 3.0]], 10.0);
        assert_eq!(forces, [[12.0, 0.0], [-12.0, 0.0]]);
    }

    #[test]
    fn repulsion_sums_to_zero() {
        let positions = RandomNumbers::new(3).positions(60, 20.0);
        let forces = forces(&positions, 20.0);
        let largest = forces.iter().map(|f| f[0].abs().max(f[1].abs())).fold(0.0, f64::max);
        for axis in 0..2 {
            let total: f64 = forces.iter().map(|f| f[axis]).sum();
            assert!(total.abs() < 1e-13 * largest);
        }
    }
}
