//! The engine for a JavaScript host: a module that imports nothing and shares three arrays of its memory.
//!
//! The host writes coordinates to [`discs`], calls [`start`], then [`step`] as often as wanted, and reads the
//! coordinates from the same place. A coordinate is a fraction of the box as an unsigned 32-bit number, unit L·2⁻³²; x
//! and y take turns. `example.mjs` beside this crate is such a host, for node and for browsers.
#![no_std]

use core::panic::PanicInfo;
use meniscus_core::engine::Engine;
use meniscus_core::parameters::Parameters;
use meniscus_core::torus::Position;
use meniscus_core::units::time_from_units;

/// Mesh nodes along a side.
const GRID: usize = 64;
/// Room for discs.
const CAPACITY: usize = 256;

/// All that the module remembers.
struct Module {
    engine: Engine<GRID, CAPACITY>,
    discs: [[u32; 2]; CAPACITY],
    digest: [u8; 32],
}

static mut MODULE: Module = Module { engine: Engine::new(), discs: [[0; 2]; CAPACITY], digest: [0; 32] };

/// The module's memory.
///
/// # Safety
/// The reference has to be dropped before this is called again.
unsafe fn module() -> &'static mut Module {
    let module = &raw mut MODULE;
    // SAFETY: a module without shared memory has one thread, and the caller holds no other reference.
    unsafe { &mut *module }
}

/// How many discs fit.
#[unsafe(no_mangle)]
pub extern "C" fn capacity() -> usize {
    CAPACITY
}

/// Where the coordinates are: x and y of disc 0, of disc 1, ….
#[unsafe(no_mangle)]
pub extern "C" fn discs() -> *mut u32 {
    // SAFETY: takes an address and reads nothing.
    unsafe { (&raw mut MODULE.discs).cast() }
}

/// Starts a run of the first `count` discs in a box of `side` R0, attracting each other with `strength` kBT over a
/// capillary length of `length` R0. Gives 0, or 1 if the engine refused.
#[unsafe(no_mangle)]
pub extern "C" fn start(count: usize, side: f64, strength: f64, length: f64, seed: u64) -> i32 {
    // SAFETY: every function here that takes the reference drops it at its end, and none calls another one.
    let module = unsafe { module() };
    let parameters = Parameters {
        side,
        grid: GRID,
        capillary_strength: strength,
        capillary_length: length,
        seed,
        ..Parameters::default()
    };
    let Some(discs) = module.discs.get(..count) else { return 1 };
    let positions = discs.iter().map(|&[x, y]| Position::from_bits(x, y));
    module.engine.init(&parameters, (0..).zip(positions)).is_err().into()
}

/// Does `steps` steps and writes the coordinates. Gives 0, or 1 if the engine refused one: the state is then that after
/// the last one it did.
#[unsafe(no_mangle)]
pub extern "C" fn step(steps: u32) -> i32 {
    // SAFETY: as in `start`.
    let Module { engine, discs, .. } = unsafe { module() };
    let refused = (0..steps).any(|_| engine.step().is_err());
    for (id, disc) in (0..).zip(discs) {
        let Some(position) = engine.position(id) else { break };
        *disc = [position.x.to_bits(), position.y.to_bits()];
    }
    refused.into()
}

/// The time reached, R0²/D.
#[unsafe(no_mangle)]
pub extern "C" fn time() -> f64 {
    // SAFETY: as in `start`.
    let module = unsafe { module() };
    time_from_units(module.engine.clock().time)
}

/// The SHA-256 of the state: where its 32 bytes are.
#[unsafe(no_mangle)]
pub extern "C" fn digest() -> *const u8 {
    // SAFETY: as in `start`.
    let module = unsafe { module() };
    module.digest = module.engine.state().digest().sha256;
    module.digest.as_ptr()
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
