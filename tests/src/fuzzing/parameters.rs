//! Constructors that take numbers.

use super::bytes::Bytes;
use meniscus_core::ermak::StepLimits;
use meniscus_core::fields::{FieldForce, Fields, LARGEST_FIELD_FORCE};
use meniscus_core::optimal::OptimalInfluence;
use meniscus_core::pair_force::PairForce;
use meniscus_core::parameters::{
    Assignment, DISPLACEMENT_RANGE, GRID_RANGE, Gradient, Influence, LARGEST_CAPILLARY_STRENGTH,
    LARGEST_SEED, LARGEST_SPLITTING_OF_SPACING, MESH_REFRESH_RANGE, Method, Noise, Parameters,
    SMALLEST_CAPILLARY_LENGTH, SMALLEST_CUTOFF, SPACING_RANGE, SPLITTING_RANGE, STEP_RANGE,
};
use meniscus_core::refresh::Refresh;
use meniscus_core::repulsion::CUTOFF;
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
    check_field(&parameters, &mut bytes);
    check_optimal(&parameters, &mut bytes);
    let mesh_refresh = bytes.number(MESH_REFRESH_RANGE.0, MESH_REFRESH_RANGE.1);
    check_refresh(&Parameters { mesh_refresh, ..parameters });
    let pairs = PairForce::new(&parameters);
    if valid.is_ok() {
        assert!(pairs.reach() < 1 << 31, "{parameters:?}");
        // All of the cut-off is reached, or all that is nearer than half a box.
        let unit = parameters.side / 4_294_967_296.0;
        let reach = PairForce::repulsion(parameters.side).reach();
        let covers = f64::from(reach) * unit >= CUTOFF * (1.0 - f64::EPSILON);
        assert!(covers || reach == (1 << 31) - 1, "{reach} in {parameters:?}");
    }
}

fn numbers(bytes: &mut Bytes<'_>) -> Parameters {
    let side = bytes.number(0.0, LARGEST_SIDE);
    Parameters {
        side,
        capillary_strength: bytes.number(0.0, LARGEST_CAPILLARY_STRENGTH),
        capillary_length: bytes.number(SMALLEST_CAPILLARY_LENGTH, f64::MAX),
        repulsion: bytes.flag(),
        grid: match bytes.byte() {
            0 => bytes.bits_64() as usize,
            shift => 1 << (shift % 16),
        },
        assignment: bytes.choice(Assignment::ALL),
        influence: bytes.choice([Influence::Paper, Influence::Continuum, Influence::Optimal]),
        gradient: bytes.choice([Gradient::Spectral, Gradient::Difference2]),
        noise: Noise::default(),
        max_step: bytes.number(STEP_RANGE.0, STEP_RANGE.1),
        max_displacement: bytes.number(DISPLACEMENT_RANGE.0, DISPLACEMENT_RANGE.1),
        seed: bytes.bits_64(),
        method: bytes.choice([Method::ParticleMesh, Method::P3m]),
        splitting: bytes.number(SPLITTING_RANGE.0, SPLITTING_RANGE.1),
        cutoff: bytes.number(SMALLEST_CUTOFF, 0.5 * side),
        mesh_refresh: 0.0,
        fields: Fields {
            uniform_force: [0; 2].map(|_| bytes.number(-LARGEST_FIELD_FORCE, LARGEST_FIELD_FORCE)),
            trap_stiffness: bytes.number(0.0, 2.0 * LARGEST_FIELD_FORCE / side),
            trap_center: [0; 2].map(|_| bytes.number(0.0, side)),
        },
    }
}

/// Held forces are computed anew from the distance on, and not before.
fn check_refresh(parameters: &Parameters) {
    let valid = parameters.validate();
    assert_eq!(valid.is_ok(), in_range(parameters), "{valid:?} of {parameters:?}");
    if valid.is_err() {
        return;
    }
    let refresh = Refresh::new(parameters.mesh_refresh, parameters.side);
    assert_eq!(refresh.holds(), parameters.mesh_refresh > 0.0);
    let units = libm::ceil(parameters.mesh_refresh / parameters.side * 4_294_967_296.0) as u32;
    assert!(units <= 1 << 30, "{parameters:?}");
    let (origin, at) = ([Fraction::ZERO], |bits: u32| [Fraction::from_bits(bits)]);
    for (far, near) in
        [(units, units.wrapping_sub(1)), (units.wrapping_neg(), units.wrapping_neg().wrapping_add(1))]
    {
        assert!(refresh.is_due((&origin, &origin), (&at(far), &origin)), "{parameters:?}");
        let is_due = refresh.is_due((&origin, &origin), (&origin, &at(near)));
        assert_eq!(is_due, !refresh.holds(), "{parameters:?}");
    }
}

/// What belongs to the method, as its documentation says.
fn method_in_range(parameters: &Parameters) -> bool {
    let &Parameters { side, grid, splitting, cutoff, .. } = parameters;
    match parameters.method {
        Method::ParticleMesh => parameters.influence != Influence::Optimal,
        Method::P3m => {
            parameters.influence == Influence::Optimal
                && parameters.gradient == Gradient::Spectral
                && (SPLITTING_RANGE.0..=SPLITTING_RANGE.1).contains(&splitting)
                && splitting * (side / grid as f64) <= LARGEST_SPLITTING_OF_SPACING
                && cutoff >= SMALLEST_CUTOFF
                && libm::ceil(cutoff / side * 4_294_967_296.0) < 2_147_483_648.0
        }
    }
}

/// As their documentation says.
fn fields_in_range(parameters: &Parameters) -> bool {
    let Fields { uniform_force, trap_stiffness, trap_center } = parameters.fields;
    let inside = |center: f64| (0.0..=parameters.side).contains(&center);
    let weak = |force: f64| force.abs() + trap_stiffness * 0.5 * parameters.side <= LARGEST_FIELD_FORCE;
    trap_stiffness >= 0.0
        && (trap_stiffness == 0.0 || trap_center.into_iter().all(inside))
        && uniform_force.into_iter().all(weak)
}

/// A field is finite everywhere, and that of valid parameters at most the largest.
fn check_field(parameters: &Parameters, bytes: &mut Bytes<'_>) {
    let field = FieldForce::new(&parameters.fields, parameters.side);
    if parameters.validate().is_err() {
        return;
    }
    let (x, y) = field.at(Fraction::from_bits(bytes.bits_32()), Fraction::from_bits(bytes.bits_32()));
    let most = LARGEST_FIELD_FORCE * 16_777_216.0 * (1.0 + 1e-6) + 2.0;
    assert!((x.unsigned_abs().max(y.unsigned_abs()) as f64) <= most, "({x}, {y}) of {parameters:?}");
}

/// The optimal influence function is a number, and not negative where waves are long.
fn check_optimal(parameters: &Parameters, bytes: &mut Bytes<'_>) {
    if parameters.validate().is_err() || parameters.method == Method::ParticleMesh {
        return;
    }
    let &Parameters { grid, side, assignment, splitting, capillary_length, .. } = parameters;
    let optimal = OptimalInfluence { grid, side, order: assignment.order(), splitting, capillary_length };
    let frequency = |bits: u32| bits as usize % (grid / 2 + 1);
    let (l, m) = (frequency(bytes.bits_32()), frequency(bytes.bits_32()));
    let value = optimal.at(l, m);
    assert!(value.is_finite(), "{value} at ({l}, {m}) of {optimal:?}");
    assert_eq!(value.to_bits(), optimal.at(m, l).to_bits(), "at ({l}, {m}) of {optimal:?}");
    assert!(optimal.at(1, 0) >= 0.0, "{optimal:?}");
}

/// As its documentation says.
fn refresh_in_range(parameters: &Parameters) -> bool {
    let distance = parameters.mesh_refresh;
    let (least, most) = MESH_REFRESH_RANGE;
    distance == 0.0 || (least..=most).contains(&distance) && distance < 0.25 * parameters.side
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
        && refresh_in_range(parameters)
        && method_in_range(parameters)
        && fields_in_range(parameters)
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
