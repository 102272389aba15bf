//! Constructors that take numbers.

use super::bytes::Bytes;
use meniscus_core::ermak::StepLimits;
use meniscus_core::parameters::{
    Assignment, DISPLACEMENT_RANGE, GRID_RANGE, Gradient, Influence, LARGEST_CAPILLARY_STRENGTH,
    LARGEST_SEED, Noise, Parameters, SMALLEST_CAPILLARY_LENGTH, SPACING_RANGE, STEP_RANGE,
};
use meniscus_core::repulsion::{CUTOFF, Repulsion};
use meniscus_core::torus::{Fraction, LARGEST_SIDE, SMALLEST_SIDE, Torus};
use meniscus_core::units::TIME_UNITS;

/// Any numbers; then: valid parameters are in every range, coordinates on a torus go to the nearest fraction and back,
/// a step is as long as its limits allow and no longer, and no constructor breaks down.
pub fn parameters(data: &[u8]) {
    let mut bytes = Bytes(data);
    let parameters = numbers(&mut bytes);
    let valid = parameters.validate();
    assert_eq!(valid.is_ok(), in_range(&parameters), "{valid:?} of {parameters:?}");
    check_torus(parameters.side, &mut bytes);
    check_limits(&parameters, bytes.bits_64());
    let repulsion = Repulsion::new(parameters.side);
    if valid.is_ok() {
        let reach = f64::from(repulsion.reach()) * (parameters.side / 4_294_967_296.0);
        assert!(reach >= CUTOFF * (1.0 - f64::EPSILON), "{reach} in {parameters:?}");
    }
}

fn numbers(bytes: &mut Bytes<'_>) -> Parameters {
    Parameters {
        side: bytes.number(0.0, LARGEST_SIDE),
        capillary_strength: bytes.number(0.0, LARGEST_CAPILLARY_STRENGTH),
        capillary_length: bytes.number(SMALLEST_CAPILLARY_LENGTH, f64::MAX),
        repulsion: bytes.flag(),
        grid: match bytes.byte() {
            0 => bytes.bits_64() as usize,
            shift => 1 << (shift % 16),
        },
        assignment: Assignment::default(),
        influence: Influence::default(),
        gradient: Gradient::default(),
        noise: Noise::default(),
        max_step: bytes.number(STEP_RANGE.0, STEP_RANGE.1),
        max_displacement: bytes.number(DISPLACEMENT_RANGE.0, DISPLACEMENT_RANGE.1),
        seed: bytes.bits_64(),
        ..Parameters::DEFAULT
    }
}

/// The ranges as their constants give them.
fn in_range(parameters: &Parameters) -> bool {
    let spacing = parameters.side / parameters.grid as f64;
    let is_side = parameters.side > 2.0 * CUTOFF && parameters.side <= LARGEST_SIDE;
    let is_grid =
        (GRID_RANGE.0..=GRID_RANGE.1).contains(&parameters.grid) && parameters.grid.count_ones() == 1;
    is_side
        && is_grid
        && (SPACING_RANGE.0..=SPACING_RANGE.1).contains(&spacing)
        && (0.0..=LARGEST_CAPILLARY_STRENGTH).contains(&parameters.capillary_strength)
        && parameters.capillary_length >= SMALLEST_CAPILLARY_LENGTH
        && (STEP_RANGE.0..=STEP_RANGE.1).contains(&parameters.max_step)
        && (DISPLACEMENT_RANGE.0..=DISPLACEMENT_RANGE.1).contains(&parameters.max_displacement)
        && parameters.seed <= LARGEST_SEED
}

fn check_torus(side: f64, bytes: &mut Bytes<'_>) {
    let Ok(torus) = Torus::new(side) else {
        assert!(!(SMALLEST_SIDE..=LARGEST_SIDE).contains(&side), "refused {side}");
        return;
    };
    let fraction = Fraction::from_bits(bytes.bits_32());
    let coordinate = torus.coordinate(fraction);
    assert!(coordinate >= 0.0 && coordinate < side, "{fraction} of {side} is {coordinate}");
    assert_eq!(torus.fraction(coordinate), Ok(fraction), "{coordinate} in {side}");
    assert_eq!(torus.wrapped_fraction(coordinate), fraction);

    let coordinate = bytes.number(0.0, side);
    let wrapped = torus.wrapped_fraction(coordinate);
    match torus.fraction(coordinate) {
        Ok(nearest) => {
            assert!(coordinate >= 0.0 && coordinate < side);
            assert_eq!(nearest, wrapped);
            let off = (torus.coordinate(nearest) - coordinate).abs();
            let half_unit = side / 8_589_934_592.0;
            assert!(off.min((side - off).abs()) <= half_unit * (1.0 + 1e-6), "{coordinate} in {side}");
        }
        Err(_) => assert!(!(coordinate >= 0.0 && coordinate < side)),
    }
}

/// Limits within the ranges give the longest step within both, rounded down.
fn check_limits(parameters: &Parameters, largest: u64) {
    const DISPLACEMENT_UNITS: f64 = 18_446_744_073_709_551_616.0;
    let limits = StepLimits::new(parameters.max_step, parameters.max_displacement);
    let length = limits.step_length(largest);
    if parameters.validate().is_err() {
        return;
    }
    let ceiling = (parameters.max_step * TIME_UNITS as f64) as u64;
    let most = (parameters.max_displacement * DISPLACEMENT_UNITS) as u128;
    let fits = |length: u64| length <= ceiling && u128::from(length) * u128::from(largest) <= most;
    let length = length.unwrap_or(0);
    assert!(fits(length) && !fits(length + 1), "{length} with {limits:?} and {largest}");
}
