//! The engine: set-up and steps.

use super::bytes::Bytes;
use meniscus_core::assignment::DISC;
use meniscus_core::digest::StateDigest;
use meniscus_core::dynamics::{Clock, Disc, InitError, Step, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::fields::{Fields, LARGEST_FIELD_FORCE};
use meniscus_core::near_part::LARGEST_TABLE;
use meniscus_core::parameters::{
    Assignment, DISPLACEMENT_RANGE, Gradient, Influence, LARGEST_CAPILLARY_STRENGTH,
    LARGEST_SPLITTING_OF_SPACING, LARGEST_STRENGTH, Method, Noise, Parameters, SMALLEST_CAPILLARY_LENGTH,
    SMALLEST_CUTOFF, STEP_RANGE,
};
use meniscus_core::refresh::HeldForce;
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::torus::Position;
use meniscus_core::units::TIME_UNITS;

type SmallEngine = Engine<16, 32, LARGEST_TABLE, 32>;

/// Largest side of a mesh of 16 nodes, R0.
const LARGEST_SIDE: f64 = 256.0;

/// Parameters, a clock and discs; then: set-up succeeds exactly when the parameters are valid, the ids are 0 … n − 1 and
/// no strength is too large, and of every step: its length is within its bounds, a refusal leaves the state as it was,
/// pair forces alone sum to zero, and neither the order of the discs, nor a restart, nor looking at forces changes anything,
/// whether the forces of the mesh are held over several steps or not.
pub fn step(data: &[u8]) {
    let mut bytes = Bytes(data);
    let parameters = parameters(&mut bytes);
    let clock = match bytes.byte() {
        0 => Clock { step: bytes.bits_64(), time: bytes.bits_64() },
        _ => Clock::START,
    };
    let steps = bytes.byte();
    let parameters = Parameters { mesh_refresh: mesh_refresh(steps / 8), ..parameters };
    let steps = steps % 8;
    let discs = discs(&mut bytes);

    let mut engine = Box::new(SmallEngine::new());
    let result = engine.init_at(&parameters, clock, discs.iter().copied());
    check_init(&parameters, &discs, result);
    if result.is_err() {
        assert_eq!(engine.count(), 0);
        assert_eq!(engine.step(), Err(StepError::NotInitialised));
        return;
    }
    let mut reversed = Box::new(SmallEngine::new());
    assert_eq!(reversed.init_at(&parameters, clock, discs.iter().rev().copied()), Ok(()));
    assert_eq!(digest(&engine), digest(&reversed));
    for _ in 0..steps {
        let mut restarted = restart(&parameters, &engine);
        let before = digest(&engine);
        assert_eq!(engine.compute_forces().is_ok(), reversed.compute_forces().is_ok());
        assert_eq!(digest(&engine), before);
        let result = engine.step();
        assert_eq!(result, reversed.step());
        assert_eq!(result, restarted.step());
        match result {
            Ok(step) => check_step(&parameters, &before, &step),
            Err(_) => assert_eq!(digest(&engine), before),
        }
        assert_eq!(digest(&engine), digest(&reversed));
        assert_eq!(digest(&engine), digest(&restarted));
        check_net_force(&parameters, &engine);
    }
}

fn parameters(bytes: &mut Bytes<'_>) -> Parameters {
    let side = bytes.number(2.0 * CUTOFF, LARGEST_SIDE);
    let paper = Parameters {
        side,
        capillary_strength: bytes.number(0.0, LARGEST_CAPILLARY_STRENGTH),
        capillary_length: bytes.number(SMALLEST_CAPILLARY_LENGTH, f64::MAX),
        repulsion: bytes.flag(),
        grid: bytes.choice([16, 16, 16, 16, 16, 16, 16, 64]),
        assignment: bytes.choice(Assignment::ALL),
        influence: bytes.choice([Influence::Paper, Influence::Continuum]),
        gradient: bytes.choice([Gradient::Spectral, Gradient::Difference2, Gradient::Difference4]),
        noise: bytes.choice([Noise::Uniform, Noise::Gaussian, Noise::None]),
        max_step: bytes.number(STEP_RANGE.0, STEP_RANGE.1),
        max_displacement: bytes.number(DISPLACEMENT_RANGE.0, DISPLACEMENT_RANGE.1),
        seed: bytes.bits_64(),
        ..Parameters::PAPER
    };
    let fields = if bytes.byte() > 200 { fields(bytes, side) } else { Fields::NONE };
    if bytes.flag() {
        return Parameters { fields, ..paper };
    }
    Parameters {
        fields,
        method: Method::P3m,
        influence: if bytes.byte() == 7 { paper.influence } else { Influence::Optimal },
        gradient: if bytes.byte() == 7 { paper.gradient } else { Gradient::Spectral },
        splitting: bytes.number(0.0, LARGEST_SPLITTING_OF_SPACING * 16.0 / side),
        cutoff: bytes.number(SMALLEST_CUTOFF, 0.5 * side),
        ..paper
    }
}

/// None for half of the choices, 0 to 31, and 2⁻²⁰ to 2¹⁰ R0 in steps of four for the others: the largest are out of range.
fn mesh_refresh(choice: u8) -> f64 {
    let exponent = u32::from(choice.saturating_sub(16));
    if choice < 16 { 0.0 } else { (1_u64 << (2 * exponent)) as f64 / 1_048_576.0 }
}

fn fields(bytes: &mut Bytes<'_>, side: f64) -> Fields {
    let mut force = || bytes.number(-LARGEST_FIELD_FORCE, LARGEST_FIELD_FORCE);
    let uniform_force = [force(), force()];
    let trap_stiffness = bytes.number(0.0, 2.0 * LARGEST_FIELD_FORCE / side);
    Fields { uniform_force, trap_stiffness, trap_center: [bytes.number(0.0, side), bytes.number(0.0, side)] }
}

/// Up to 33 discs. Ids are those of the order, mixed, or whatever the bytes say; strengths all 1, or whatever the bytes
/// say.
fn discs(bytes: &mut Bytes<'_>) -> Vec<Disc> {
    let (kind, near, strength) = (bytes.byte(), bytes.byte() % 32, bytes.byte());
    let mut discs = Vec::new();
    while !bytes.is_empty() && discs.len() <= 32 {
        let id = if kind == 0 { u32::from(bytes.byte()) } else { discs.len() as u32 };
        // Shifted, discs are close to each other, across the border.
        let coordinate = |bits: u32| (bits as i32 >> near) as u32;
        let position = Position::from_bits(coordinate(bytes.bits_32()), coordinate(bytes.bits_32()));
        let any = |bytes: &mut Bytes<'_>| bytes.bits_32() as i32 >> (strength % 32);
        let strength = if strength < 128 { DISC as i32 } else { any(bytes) };
        discs.push(Disc { id, position, strength });
    }
    if kind != 0 && !discs.is_empty() {
        let turn = usize::from(kind) % discs.len();
        discs.rotate_left(turn);
    }
    discs
}

fn check_init(parameters: &Parameters, discs: &[Disc], result: Result<(), InitError>) {
    let mut ids: Vec<u32> = discs.iter().map(|disc| disc.id).collect();
    ids.sort_unstable();
    let dense = ids.iter().copied().eq(0..ids.len() as u32);
    let sound = parameters.validate().is_ok() && parameters.grid == 16;
    let moderate = discs.iter().all(|disc| {
        let strength = f64::from(disc.strength) / f64::from(DISC);
        let coupling = parameters.capillary_strength * strength * strength;
        strength.abs() <= LARGEST_STRENGTH && coupling <= LARGEST_CAPILLARY_STRENGTH
    });
    let expected = sound && dense && moderate && (1..=32).contains(&discs.len());
    assert_eq!(result.is_ok(), expected, "{result:?}");
}

fn digest(engine: &SmallEngine) -> StateDigest {
    engine.state().digest_by_field()
}

/// Another engine that starts where this one is.
fn restart(parameters: &Parameters, engine: &SmallEngine) -> Box<SmallEngine> {
    let disc = |id| Some(Disc { id, position: engine.position(id)?, strength: engine.strength(id)? });
    let discs = (0..engine.count() as u32).filter_map(disc);
    let mut restarted = Box::new(SmallEngine::new());
    assert_eq!(restarted.init_at(parameters, engine.clock(), discs), Ok(()));
    let held: Vec<HeldForce> = (0..engine.count() as u32).filter_map(|id| engine.held(id)).collect();
    if !held.is_empty() {
        assert_eq!(restarted.hold(held), Ok(()));
    }
    assert_eq!(digest(engine), digest(&restarted));
    restarted
}

fn check_step(parameters: &Parameters, before: &StateDigest, step: &Step) {
    const DISPLACEMENT_UNITS: f64 = 18_446_744_073_709_551_616.0;
    let &Step { length, largest_force, clock, .. } = step;
    assert!(length > 0 && length as f64 <= parameters.max_step * TIME_UNITS as f64, "{step:?}");
    let displacement = u128::from(length) * u128::from(largest_force);
    let most = (parameters.max_displacement * DISPLACEMENT_UNITS) as u128;
    assert!(displacement <= most, "{step:?} with {parameters:?}");
    assert_eq!((clock.step, clock.time), (before.step + 1, before.time + length));
}

/// The forces of the last step or refusal.
fn check_net_force(parameters: &Parameters, engine: &SmallEngine) {
    if parameters.capillary_strength > 0.0 || parameters.fields != Fields::NONE {
        return;
    }
    let forces = (0..engine.count() as u32).filter_map(|id| engine.force(id));
    let sum = forces.fold((0, 0), |sum, force| (sum.0 + force.0, sum.1 + force.1));
    assert_eq!(sum, (0, 0));
}
