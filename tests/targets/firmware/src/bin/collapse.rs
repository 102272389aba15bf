//! A whole firmware around the engine: 200 discs, placed at random, collapse under their attraction.
//!
//! All there is to an embedding: one [`Engine`] in a `static` (it lies in `.bss`, nothing is allocated), a call of
//! [`Engine::init`] with parameters and discs, then [`Engine::step`] as often as wanted; positions, forces, clock and
//! digest can be read in between and change nothing. Only integers are printed, since the code that formats
//! floating-point numbers is as large as half the engine.
//!
//! `cargo run --release --target thumbv7em-none-eabihf --bin collapse` runs it in QEMU. The digests are those of
//! `meniscus run` with the same parameters and seed: `start.kind = "random"` places the same discs.
#![no_std]
#![no_main]

use core::fmt::{self, Write};
use cortex_m_rt::entry;
use meniscus_core::dynamics::{InitError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::parameters::Parameters;
use meniscus_core::torus::{Position, minimum_image};
use meniscus_firmware::{Output, exit, output};

/// Number of discs.
const DISCS: usize = 200;
/// Side of the box, R0.
const SIDE: u32 = 64;
/// Steps to do, and how many of them between two lines of output.
const STEPS: u64 = 400;
const STEPS_PER_LINE: u64 = 50;
/// The largest distance at which two discs are told to be in contact, in 1/1000 R0: where the repulsion ends, 2·2^(1/6).
const CONTACT: u64 = 2245;

/// Why the run ended early.
#[derive(Debug)]
#[expect(dead_code, reason = "the fields are shown by Debug")]
enum Failure {
    Init(InitError),
    Step(StepError),
    Output,
}

impl From<InitError> for Failure {
    fn from(error: InitError) -> Self {
        Self::Init(error)
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<fmt::Error> for Failure {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

#[entry]
fn main() -> ! {
    // The entry point runs once and turns the `static mut` into the only reference to it.
    static mut ENGINE: Engine<64, 256> = Engine::new();

    let mut output = output();
    let result = collapse(ENGINE, &mut output);
    if let Err(failure) = &result {
        let _ = writeln!(output, "error: {failure:?}");
    }
    exit(result.is_ok())
}

/// The run: sets up, steps, and prints a line now and then.
fn collapse(engine: &mut Engine<64, 256>, output: &mut Output) -> Result<(), Failure> {
    let parameters = Parameters {
        side: f64::from(SIDE),
        grid: 64,
        capillary_strength: 20.0,
        capillary_length: 40.0,
        seed: 1,
        ..Parameters::default()
    };
    let mut places = [Position::default(); DISCS];
    place_at_random(&mut places, parameters.seed);
    engine.init(&parameters, (0..).zip(places))?;

    writeln!(output, "step  time (1e-6)  largest force  contacts  digest of the state")?;
    print(engine, 0, output)?;
    for step in 1..=STEPS {
        let done = engine.step()?;
        if step % STEPS_PER_LINE == 0 {
            // Unit 2⁻²⁴ kBT/R0, rounded to whole kBT/R0.
            print(engine, (done.largest_force + (1 << 23)) >> 24, output)?;
        }
    }
    Ok(())
}

/// One line: step, time in 10⁻⁶ R0²/D, largest force before that step in kBT/R0, pairs in contact, digest.
fn print(engine: &Engine<64, 256>, largest_force: u64, output: &mut Output) -> fmt::Result {
    let clock = engine.clock();
    // At most 2⁶⁴ · 10⁶, below 2⁸⁴.
    let millionths = (u128::from(clock.time) * 1_000_000) >> 40;
    let (contacts, digest) = (contacts(engine), engine.state().digest());
    writeln!(output, "{:4}  {millionths:11}  {largest_force:13}  {contacts:8}  {digest}", clock.step)
}

/// Number of pairs within reach of their repulsion.
fn contacts(engine: &Engine<64, 256>) -> usize {
    let reach = (CONTACT << 32) / (1000 * u64::from(SIDE));
    let places = || (0..engine.count() as u32).filter_map(|id| engine.position(id));
    let near =
        |(first, place)| places().take(first).filter(|&other| square(place, other) < reach * reach).count();
    places().enumerate().map(near).sum()
}

/// Places discs one after the other at random, no two closer than 2 R0.
///
/// Each place tried is 64 random bits, half for x and half for y.
fn place_at_random(places: &mut [Position], seed: u64) {
    let contact = (2_u64 << 32) / u64::from(SIDE);
    let key = StepKey::new(seed, Purpose::Start, 0);
    let mut attempts = 0;
    for next in 0..places.len() {
        let (placed, free) = places.split_at_mut(next);
        let Some(place) = free.first_mut() else { return };
        loop {
            let bits = key.bits(attempts);
            attempts += 1;
            *place = Position::from_bits((bits >> 32) as u32, bits as u32);
            if placed.iter().all(|&other| square(*place, other) >= contact * contact) {
                break;
            }
        }
    }
}

/// The squared distance of the nearest images, unit (L·2⁻³²)².
fn square(first: Position, second: Position) -> u64 {
    let along = |to, from| u64::from(minimum_image(to, from).unsigned_abs());
    let (x, y) = (along(first.x, second.x), along(first.y, second.y));
    x * x + y * y
}
