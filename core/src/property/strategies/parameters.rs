//! Valid parameters.

use crate::fields::{Fields, LARGEST_FIELD_FORCE};
use crate::parameters::{
    Assignment, DISPLACEMENT_RANGE, GRID_RANGE, Gradient, Influence, LARGEST_CAPILLARY_STRENGTH,
    LARGEST_SEED, LARGEST_SPLITTING_OF_SPACING, Method, Noise, Parameters, SMALLEST_CAPILLARY_LENGTH,
    SMALLEST_CUTOFF, SPACING_RANGE, SPLITTING_RANGE, STEP_RANGE,
};
use crate::repulsion::CUTOFF;
use crate::torus::{LARGEST_SIDE, UNITS};
use proptest::prelude::*;
use proptest::sample::select;

/// Valid [`Parameters`] of both methods over all their ranges, on a mesh of at most `largest_grid` nodes a side (at
/// least 16 are taken).
pub fn parameters(largest_grid: usize) -> impl Strategy<Value = Parameters> {
    let largest_exponent = largest_grid.clamp(GRID_RANGE.0, GRID_RANGE.1).ilog2();
    let parts = (in_a_box(largest_exponent), capillarity(), scheme(), motion(), any::<bool>());
    (parts, splitting(), fields()).prop_map(
        |((sized, attraction, scheme, motion, repulsion), splitting, fields)| {
            let parameters = Parameters {
                side: sized.side,
                grid: sized.grid,
                capillary_strength: attraction.capillary_strength,
                capillary_length: attraction.capillary_length,
                repulsion,
                noise: motion.noise,
                max_step: motion.max_step,
                max_displacement: motion.max_displacement,
                seed: motion.seed,
                ..scheme
            };
            Parameters { fields: fields.of(parameters.side), ..splitting.of(parameters) }
        },
    )
}

/// Where in its range a number is, 0 to 1: the ends are as likely as a tenth of what is between.
fn fraction() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 8 => 0.0..1.0, 1 => Just(1.0)]
}

fn linear(least: f64, most: f64, fraction: f64) -> f64 {
    (least + (most - least) * fraction).clamp(least, most)
}

/// Every order of magnitude is as likely.
fn logarithmic(least: f64, most: f64, fraction: f64) -> f64 {
    if fraction >= 1.0 {
        return most;
    }
    (least * libm::exp(libm::log(most / least) * fraction)).clamp(least, most)
}

/// `side` and `grid`.
fn in_a_box(largest_exponent: u32) -> impl Strategy<Value = Parameters> {
    (GRID_RANGE.0.ilog2()..=largest_exponent, fraction()).prop_map(|(exponent, fraction)| {
        let nodes = f64::from(1_u32 << exponent);
        let least = (SPACING_RANGE.0 * nodes).max((2.0 * CUTOFF).next_up());
        let most = (SPACING_RANGE.1 * nodes).min(LARGEST_SIDE);
        Parameters { side: logarithmic(least, most, fraction), grid: 1 << exponent, ..Parameters::DEFAULT }
    })
}

/// `capillary_strength` and `capillary_length`.
fn capillarity() -> impl Strategy<Value = Parameters> {
    let strength = prop_oneof![
        6 => fraction().prop_map(|fraction| logarithmic(1e-6, LARGEST_CAPILLARY_STRENGTH, fraction)),
        1 => Just(0.0),
    ];
    let length = prop_oneof![
        6 => fraction().prop_map(|fraction| logarithmic(SMALLEST_CAPILLARY_LENGTH, 1e6, fraction)),
        1 => select(&[f64::MAX, f64::INFINITY][..]),
    ];
    (strength, length).prop_map(|(capillary_strength, capillary_length)| Parameters {
        capillary_strength,
        capillary_length,
        ..Parameters::DEFAULT
    })
}

/// `method`, `assignment`, `influence` and `gradient`.
fn scheme() -> impl Strategy<Value = Parameters> {
    const GRADIENTS: [Gradient; 3] = [Gradient::Spectral, Gradient::Difference2, Gradient::Difference4];
    let schemes = (
        select(&[Method::ParticleMesh, Method::P3m][..]),
        select(&Assignment::ALL[..]),
        select(&[Influence::Paper, Influence::Continuum][..]),
        select(&GRADIENTS[..]),
    );
    schemes.prop_map(|(method, assignment, influence, gradient)| {
        let scheme = Parameters { method, assignment, influence, gradient, ..Parameters::DEFAULT };
        match method {
            Method::ParticleMesh => scheme,
            Method::P3m => {
                Parameters { influence: Influence::Optimal, gradient: Gradient::Spectral, ..scheme }
            }
        }
    })
}

/// `noise`, `max_step`, `max_displacement` and `seed`.
fn motion() -> impl Strategy<Value = Parameters> {
    let noise = select(&[Noise::None, Noise::Uniform, Noise::Gaussian][..]);
    (noise, fraction(), fraction(), 0..=LARGEST_SEED).prop_map(|(noise, step, displacement, seed)| {
        Parameters {
            noise,
            max_step: logarithmic(STEP_RANGE.0, STEP_RANGE.1, step),
            max_displacement: logarithmic(DISPLACEMENT_RANGE.0, DISPLACEMENT_RANGE.1, displacement),
            seed,
            ..Parameters::DEFAULT
        }
    })
}

/// Where in their ranges α and r_c are.
#[derive(Clone, Copy, Debug)]
struct Splitting {
    splitting: f64,
    cutoff: f64,
}

fn splitting() -> impl Strategy<Value = Splitting> {
    (fraction(), fraction()).prop_map(|(splitting, cutoff)| Splitting { splitting, cutoff })
}

impl Splitting {
    fn of(self, parameters: Parameters) -> Parameters {
        let spacing = parameters.side / parameters.grid as f64;
        // The largest α·h without what rounding may add.
        let finest = LARGEST_SPLITTING_OF_SPACING.next_down() / spacing;
        // Two units of position below half a box: what rounding may add leaves one.
        let farthest = (0.5 - 2.0 / UNITS) * parameters.side;
        Parameters {
            splitting: logarithmic(SPLITTING_RANGE.0, SPLITTING_RANGE.1.min(finest), self.splitting),
            cutoff: logarithmic(SMALLEST_CUTOFF, farthest, self.cutoff),
            ..parameters
        }
    }
}

/// Signed fractions of the largest forces, and of the side; none is what it shrinks to.
#[derive(Clone, Copy, Debug)]
struct FieldShares {
    uniform: [f64; 2],
    trap: f64,
    center: [f64; 2],
}

fn fields() -> impl Strategy<Value = FieldShares> {
    let none = FieldShares { uniform: [0.0; 2], trap: 0.0, center: [0.0; 2] };
    let signed = || prop_oneof![Just(0.0), -1.0..1.0];
    let some = ([signed(), signed()], signed(), [fraction(), fraction()]);
    prop_oneof![
        2 => Just(none),
        1 => some.prop_map(|(uniform, trap, center)| FieldShares { uniform, trap, center }),
    ]
}

impl FieldShares {
    fn of(self, side: f64) -> Fields {
        // Forces of up to 10 kBT/R0 matter more than those at the limit: cubes reach both.
        let component = |share: f64| 0.49 * LARGEST_FIELD_FORCE * share * share * share;
        Fields {
            uniform_force: self.uniform.map(component),
            trap_stiffness: component(self.trap).abs() / (0.5 * side),
            trap_center: self.center.map(|share| linear(0.0, side, share)),
        }
    }
}
