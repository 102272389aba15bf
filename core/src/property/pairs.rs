//! Invariants of the force of a pair of discs, and its limits.
//!
//! A pair kernel is anything that takes a separation, where the other disc is as seen from the first (R0), and gives
//! the force on the first one (kBT/R0): an attraction points along the separation. [`of_forces`] makes a pair kernel
//! of a force kernel.
//!
//! The scale of a [`Tolerance`] is the modulus of the force, unless stated otherwise.
//!
//! ```
//! use meniscus_core::property::pairs::{self, Capillary};
//! use meniscus_core::property::{Invariant, Tolerance};
//!
//! // Newton's gravity in two dimensions.
//! let gravity = |[x, y]: [f64; 2]| [0.89 * x / (x * x + y * y), 0.89 * y / (x * x + y * y)];
//! let capillary = Capillary { strength: 0.89, length: 30.0, side: f64::INFINITY };
//! let tolerance = Tolerance::relative(1e-12);
//! pairs::pair_symmetry(gravity, [3.0, 4.0], Tolerance::EXACT).unwrap();
//! pairs::far_field(gravity, capillary, [0.3, 0.4], tolerance).unwrap();
//! // It knows no capillary length.
//! let violation = pairs::screening(gravity, capillary, [90.0, 120.0], tolerance).unwrap_err();
//! assert_eq!(violation.invariant, Invariant::Screening);
//! ```

use super::discs::Discs;
use super::forces::{ForceKernel, difference, modulus};
use super::violation::{Invariant, Tolerance, Violation, check};
use crate::parameters::Parameters;
use crate::torus::{Position, Torus};
use core::f64::consts::{FRAC_PI_2, PI};

/// Force on a disc, kBT/R0, from the separation of the other one, R0: implemented for every closure and function with
/// this signature.
pub trait PairKernel: FnMut([f64; 2]) -> [f64; 2] {}

impl<K: FnMut([f64; 2]) -> [f64; 2]> PairKernel for K {}

/// A force kernel as a pair kernel: the force on a disc at `origin` from another one, both of strength 1. The force is
/// not a number if the kernel gives other than two.
pub fn of_forces(mut kernel: impl ForceKernel, torus: Torus, origin: Position) -> impl PairKernel {
    move |[x, y]| {
        let other = Position {
            x: origin.x.wrapping_add(torus.wrapped_fraction(x)),
            y: origin.y.wrapping_add(torus.wrapped_fraction(y)),
        };
        match kernel(&Discs::new(torus, [origin, other].into())).as_slice() {
            &[force, _] => force,
            _ => [f64::NAN; 2],
        }
    }
}

/// The second disc feels the opposite of what the first one feels: F(−d) = −F(d).
///
/// # Errors
/// A [`Violation`].
pub fn pair_symmetry(
    mut kernel: impl PairKernel,
    separation: [f64; 2],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let force = kernel(separation);
    let [x, y] = kernel(separation.map(|component| -component));
    check(Invariant::PairSymmetry, difference([-x, -y], force), tolerance.at(modulus(force)), [])
}

/// The force lies along the separation. In a periodic box the images of the other disc pull it aside, by 3.15 (d/L)⁴ of
/// V0/d without screening.
///
/// # Errors
/// A [`Violation`] with the component across it.
pub fn centrality(
    mut kernel: impl PairKernel,
    separation: [f64; 2],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let force = kernel(separation);
    let [x, y] = direction(separation);
    let across = (force[0] * y - force[1] * x).abs();
    check(Invariant::Centrality, across, tolerance.at(modulus(force)), [])
}

/// Turning the separation by `angle` (radians) turns the force. In a periodic box this holds only for quarter turns
/// exactly.
///
/// # Errors
/// A [`Violation`].
pub fn isotropy(
    mut kernel: impl PairKernel,
    separation: [f64; 2],
    angle: f64,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let (sine, cosine) = libm::sincos(angle);
    let turned = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    let force = kernel(separation);
    let error = difference(kernel(turned(separation)), turned(force));
    check(Invariant::Isotropy, error, tolerance.at(modulus(force)), [])
}

/// Separations are those of a torus: adding a box of side `side` (R0) along either axis, either way, changes nothing.
///
/// # Errors
/// A [`Violation`].
pub fn wrap(
    mut kernel: impl PairKernel,
    [x, y]: [f64; 2],
    side: f64,
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let force = kernel([x, y]);
    for elsewhere in [[x + side, y], [x - side, y], [x, y + side], [x, y - side]] {
        check(Invariant::Wrap, difference(kernel(elsewhere), force), tolerance.at(modulus(force)), [])?;
    }
    Ok(())
}

/// The discs do not push each other.
///
/// # Errors
/// A [`Violation`] with the push.
pub fn attraction(
    mut kernel: impl PairKernel,
    separation: [f64; 2],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let force = kernel(separation);
    let [x, y] = direction(separation);
    let push = -(force[0] * x + force[1] * y);
    check(Invariant::Attraction, push, tolerance.at(modulus(force)), [])
}

/// The capillary attraction whose limits a kernel should have (Eq. 1): (V0/λ)·K1(d/λ), summed over the images of a
/// periodic box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capillary {
    /// V0, kBT.
    pub strength: f64,
    /// Capillary length λ, R0; may be infinite.
    pub length: f64,
    /// Side L of the periodic box, R0; infinite for none.
    pub side: f64,
}

impl Capillary {
    /// That of a run.
    #[must_use]
    pub fn of(parameters: &Parameters) -> Self {
        let &Parameters { capillary_strength: strength, capillary_length: length, side, .. } = parameters;
        Self { strength, length, side }
    }

    /// Largest fraction of V0/d that screening and images take away at a distance d (R0).
    ///
    /// Screening: 1 − x·K1(x) = (x²/2)[ln(2/x) − 0.577 + ½] + … at x = d/λ, at most (x²/2)[ln(2/x) + ½] below x = 1 and
    /// 1 beyond. Images: those of an unscreened force are Weierstrass's ζ with a uniform background,
    /// πu² + 3.15 u⁴ cos 4φ + 4.3 u⁸ cos 8φ + … at u = d/L, at most πu² + 4u⁴ up to half a box.
    fn deviation(&self, distance: f64) -> f64 {
        let x = distance / self.length;
        let screening = if x == 0.0 {
            0.0
        } else if x < 1.0 {
            0.5 * x * x * (libm::log(2.0 / x) + 0.5)
        } else {
            1.0
        };
        let square = (distance / self.side) * (distance / self.side);
        screening + PI * square + 4.0 * square * square
    }

    /// What (V0/λ)·K1(d/λ) does not exceed: K1(x) < √(π/2x)·e⁻ˣ·(1 + 3/(8x)), the asymptotic series cut before a term
    /// that is negative.
    fn bound(&self, distance: f64) -> f64 {
        let x = distance / self.length;
        if x == 0.0 {
            return self.strength / distance;
        }
        let bessel = libm::sqrt(FRAC_PI_2 / x) * libm::exp(-x) * (1.0 + 0.375 / x);
        self.strength / self.length * bessel
    }
}

/// Far from contact and near on the scale of λ and L, the force is that of gravity in two dimensions: V0/d towards the
/// other disc.
///
/// What screening and images take away at this distance is known and accepted beside the tolerance, the scale of which
/// is V0/d. So any separation may be given; from λ or L/2 on nothing is said.
///
/// # Errors
/// A [`Violation`].
pub fn far_field(
    mut kernel: impl PairKernel,
    capillary: Capillary,
    separation: [f64; 2],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    let distance = modulus(separation);
    let limit = capillary.strength / distance;
    let expected = direction(separation).map(|component| limit * component);
    let error = difference(kernel(separation), expected);
    let allowed = tolerance.at(limit) + limit * capillary.deviation(distance);
    check(Invariant::FarField, error, allowed, [])
}

/// At distances d ≫ λ the force is screened: not more than V0·√(π/(2λd))·e^(−d/λ)·(1 + 3λ/(8d)), summed over the images,
/// which is the scale of the tolerance.
///
/// # Errors
/// A [`Violation`] with the modulus of the force.
pub fn screening(
    mut kernel: impl PairKernel,
    capillary: Capillary,
    separation: [f64; 2],
    tolerance: Tolerance,
) -> Result<(), Violation> {
    // Those beyond are e⁻³ of the nearest at most where L > λ, and cancel each other.
    const IMAGES: core::ops::RangeInclusive<i32> = -3..=3;
    let force = modulus(kernel(separation));
    let bound = if capillary.side.is_finite() {
        let image = |component: f64, number: i32| {
            let nearest = component - capillary.side * libm::rint(component / capillary.side);
            nearest + f64::from(number) * capillary.side
        };
        let images = IMAGES.flat_map(|column| IMAGES.map(move |row| (column, row)));
        let distances =
            images.map(|(column, row)| modulus([image(separation[0], column), image(separation[1], row)]));
        distances.map(|distance| capillary.bound(distance)).sum()
    } else {
        capillary.bound(modulus(separation))
    };
    check(Invariant::Screening, force, bound + tolerance.at(bound), [])
}

/// The unit vector along a separation; zero for none.
fn direction(separation: [f64; 2]) -> [f64; 2] {
    let distance = modulus(separation);
    if distance > 0.0 { separation.map(|component| component / distance) } else { [0.0; 2] }
}
