//! The force that errors are compared with: the root mean square force of a random start.

use super::System;
use crate::bessel::scaled_k0_k1;
use core::f64::consts::PI;

/// The least distance of two discs, R0: contact.
const CONTACT: f64 = 2.0;
/// κ0·L of the auxiliary interaction whose periodic images are negligible: they add e⁻¹⁰ ≈ 5·10⁻⁵.
const AUXILIARY_SCREENING: f64 = 10.0;
/// Wave numbers summed along a half-axis; the rest is integrated.
const MODES: usize = 32;
/// Euler's constant γ.
const EULER: f64 = 0.577_215_664_901_532_9;
/// Arguments below this are 0 to the functions here.
const NEGLIGIBLE_SCREENING: f64 = 1e-8;

/// The root mean square capillary force on a disc, kBT/R0, of discs that are uncorrelated but for not overlapping.
///
/// ρ⟨f²⟩²V0²·I under the root, ρ = N/L², where I = ∫ (force/V0)² d²r over separations of at least contact, 2 R0:
/// without that least distance the integral would diverge logarithmically. It is the force of discs
/// placed at random without overlap, as `start.kind = "random"` does. In a plane
/// I = 2π·P(2κ), P(x) = ∫ₓ^∞ y·K₁(y)² dy = (x²/2)[K₀(x)K₂(x) − K₁(x)²]. In a periodic box with λ above L/10 the images
/// count, see `periodic`.
///
/// 0 without attraction, without strength or without discs.
#[must_use]
pub fn reference_force(system: &System) -> f64 {
    let kappa = system.screening();
    let integral = if kappa < AUXILIARY_SCREENING / system.side {
        periodic(system.side, kappa)
    } else {
        2.0 * PI * plane(kappa)
    };
    system.force_scale() * integral.max(0.0).sqrt()
}

/// P(2κ) for κ > 0.
fn plane(kappa: f64) -> f64 {
    let x = CONTACT * kappa;
    let (k0, k1) = scaled_k0_k1(x);
    let k2 = k0 + 2.0 * k1 / x;
    0.5 * x * x * (k0 * k2 - k1 * k1).max(0.0) * libm::exp(-2.0 * x)
}

/// I of a periodic box with κ < κ0 = 10/L.
///
/// For κ0 the images are negligible, and over all separations the difference is, by Parseval's theorem,
/// (2π/L)²·Σ_{k≠0} [k²/(k²+κ²)² − k²/(k²+κ0²)²]. Added to 2π·P(2κ0), it lacks what the difference is
/// closer than contact: 2π[ln(κ0/κ) − P(2κ) + P(2κ0)] by the discs themselves, as P(x) → −ln(x/2) − γ − 1/2 for x → 0, and
/// by the images' field, which there is that of an even background, −wπr/L² with w = κa·K₁(κa), πa² = L².
fn periodic(side: f64, kappa: f64) -> f64 {
    let auxiliary = AUXILIARY_SCREENING / side;
    let own = if kappa < NEGLIGIBLE_SCREENING {
        -libm::log(auxiliary) - EULER - 0.5
    } else {
        plane(kappa) + libm::log(kappa / auxiliary)
    };
    let background = PI * CONTACT * CONTACT * background_share(side, kappa) / (side * side);
    difference(side, kappa, auxiliary) + 2.0 * PI * (own + background - 0.25 * background * background)
}

/// w: 1 without screening, 0 where screening leaves nothing of the images.
fn background_share(side: f64, kappa: f64) -> f64 {
    let x = kappa * side / PI.sqrt();
    if x < NEGLIGIBLE_SCREENING { 1.0 } else { x * scaled_k0_k1(x).1 * libm::exp(-x) }
}

/// The difference of screening κ < κ0 over all separations.
fn difference(side: f64, kappa: f64, auxiliary: f64) -> f64 {
    let unit = 2.0 * PI / side;
    let (kappa_squared, auxiliary_squared) = (kappa * kappa, auxiliary * auxiliary);
    let mut sum = 0.0;
    for l in 1..=MODES {
        for m in 0..=l {
            let copies = if m == 0 || m == l { 4.0 } else { 8.0 };
            let k_squared = unit * unit * (l * l + m * m) as f64;
            let (near, far) = (k_squared + kappa_squared, k_squared + auxiliary_squared);
            sum += copies * k_squared * (1.0 / (near * near) - 1.0 / (far * far));
        }
    }
    unit * unit * sum + tail(side, auxiliary_squared - kappa_squared)
}

/// The modes outside the square of [`MODES`]: the integral of 2(κ0² − κ²)/k⁴ over what is outside a square of half-width
/// K, (2 + π)/K² · (κ0² − κ²).
fn tail(side: f64, difference: f64) -> f64 {
    let half_width = 2.0 * PI / side * (MODES as f64 + 0.5);
    (2.0 + PI) * difference / (half_width * half_width)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(side: f64, capillary_length: f64) -> System {
        System { side, particles: 1, capillary_strength: 1.0, capillary_length, mean_square_strength: 1.0 }
    }

    /// I of a system of one disc and V0 = 1.
    fn integral(side: f64, capillary_length: f64) -> f64 {
        let force = reference_force(&system(side, capillary_length));
        force * force * side * side
    }

    #[test]
    fn without_screening_it_is_the_logarithm_of_the_side() {
        // From Kronecker's second limit formula; 3.7081 = 2πη(i)² with η(i) = Γ(1/4)/(2π^{3/4}).
        // Lengths are far above the side; the background's field is what is left out here.
        for (side, tolerance) in [(30.0, 2e-2), (100.0, 1e-3), (500.0, 1e-4), (5000.0, 1e-4)] {
            let expected = 2.0 * PI * libm::log(side / (3.7081 * CONTACT));
            for capillary_length in [f64::INFINITY, 1e3 * side, 1e12] {
                let found = integral(side, capillary_length);
                assert!((found / expected - 1.0).abs() < tolerance, "{side}: {found} instead of {expected}");
            }
        }
    }

    #[test]
    fn with_screening_it_is_the_integral_of_the_square_of_the_force() {
        for capillary_length in [0.5, 3.0, 20.0] {
            let kappa = 1.0 / capillary_length;
            // Simpson's rule in ln r of 2π r² (κ K₁(κr))².
            let (intervals, least, most) =
                (4000, libm::log(CONTACT), libm::log(CONTACT + 40.0 * capillary_length));
            let step = (most - least) / f64::from(intervals);
            let mut sum = 0.0;
            for i in 0..=intervals {
                let r = libm::exp(least + step * f64::from(i));
                let force = kappa * scaled_k0_k1(kappa * r).1 * libm::exp(-kappa * r);
                let weight = if i == 0 || i == intervals {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                sum += weight * 2.0 * PI * r * r * force * force;
            }
            let expected = sum * step / 3.0;
            let found = integral(500.0, capillary_length);
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{capillary_length}: {found} instead of {expected}"
            );
        }
    }

    #[test]
    fn in_a_box_it_is_the_integral_over_the_box() {
        // The force as a sum over images, midpoints over an eighth of the box: 3 % for the ragged edge at contact.
        for (side, capillary_length) in [(20.0, 5.0), (60.0, 30.0)] {
            let kappa = 1.0 / capillary_length;
            let points = 30;
            let mut sum = 0.0;
            for i in 0..points {
                for j in 0..=i {
                    let place = |index: i32| 0.5 * side * (f64::from(index) + 0.5) / f64::from(points);
                    let (x, y) = (place(i), place(j));
                    if x * x + y * y < CONTACT * CONTACT {
                        continue;
                    }
                    let mut force = [0.0; 2];
                    let reach = libm::ceil(10.0 * capillary_length / side) as i32;
                    for l in -reach..=reach {
                        for m in -reach..=reach {
                            let (dx, dy) = (x + side * f64::from(l), y + side * f64::from(m));
                            let r = (dx * dx + dy * dy).sqrt();
                            let pair = kappa * scaled_k0_k1(kappa * r).1 * libm::exp(-kappa * r) / r;
                            force[0] += pair * dx;
                            force[1] += pair * dy;
                        }
                    }
                    let copies = if i == j { 4.0 } else { 8.0 };
                    sum += copies * (force[0] * force[0] + force[1] * force[1]);
                }
            }
            let expected = sum * 0.25 * side * side / f64::from(points * points);
            let found = integral(side, capillary_length);
            assert!((found / expected - 1.0).abs() < 3e-2, "{side}: {found} instead of {expected}");
        }
    }

    #[test]
    fn it_does_not_jump_where_the_images_begin_to_count() {
        for side in [30.0, 500.0] {
            let (below, above) = (integral(side, 0.099_999 * side), integral(side, 0.100_001 * side));
            assert!((above / below - 1.0).abs() < 1e-3, "{below}, {above}");
        }
    }

    #[test]
    fn it_is_proportional_to_strength_and_to_the_root_of_the_density() {
        let one = reference_force(&system(100.0, 30.0));
        let many = System {
            particles: 400,
            capillary_strength: 3.0,
            mean_square_strength: 2.0,
            ..system(100.0, 30.0)
        };
        assert!((reference_force(&many) / one - 120.0).abs() < 1e-9);
    }

    #[test]
    fn strong_screening_gives_a_tiny_force_and_none_gives_none() {
        let force = reference_force(&system(100.0, 0.01));
        assert!(force > 0.0 && force < 1e-80, "{force}");
        assert_eq!(reference_force(&System { capillary_strength: 0.0, ..system(100.0, 30.0) }), 0.0);
    }
}
