//! The golden cases on a bare 32-bit RISC-V processor, all floating-point arithmetic in software.
#![no_std]
#![no_main]

mod machine;

use core::fmt::Write;
use core::panic::PanicInfo;
use machine::{Output, exit};
use meniscus_cases::{CASES, CaseError, Engine64, ROOM, run};
use meniscus_core::engine::Engine;

static mut ENGINE_16: Engine<{ ROOM[0].0 }, { ROOM[0].1 }> = Engine::new();
static mut ENGINE_64: Engine64 = Engine64::new();
static mut ENGINE_128: Engine<{ ROOM[2].0 }, { ROOM[2].1 }> = Engine::new();
static mut ENGINE_512: Engine<{ ROOM[3].0 }, { ROOM[3].1 }> = Engine::new();

/// The first Rust function, called once by the entry in `machine`.
extern "C" fn main() -> ! {
    let result = run_all();
    if let Err(error) = &result {
        let _ = writeln!(Output, "error: {error:?}");
    }
    exit(result.is_ok())
}

fn run_all() -> Result<(), CaseError> {
    for case in &CASES {
        // SAFETY: the program runs on one processor without interrupts, and no two of these references live at the
        // same time.
        unsafe {
            match case.parameters.grid {
                16 => run(case, only(&raw mut ENGINE_16), &mut Output)?,
                64 => run(case, only(&raw mut ENGINE_64), &mut Output)?,
                128 => run(case, only(&raw mut ENGINE_128), &mut Output)?,
                _ => run(case, only(&raw mut ENGINE_512), &mut Output)?,
            }
        }
    }
    Ok(())
}

/// The one reference to a static.
///
/// # Safety
/// `it` is valid, and there is no other reference to it as long as this one lives.
unsafe fn only<T>(it: *mut T) -> &'static mut T {
    // SAFETY: the caller says so.
    unsafe { &mut *it }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let _ = writeln!(Output, "{info}");
    exit(false)
}
