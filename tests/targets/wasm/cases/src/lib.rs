//! All golden cases in a WebAssembly module that imports nothing: the host calls [`run_all`], then reads the text.
//!
//! The text is in the module's memory, [`output_length`] bytes from [`output_address`] on.
#![no_std]

use core::fmt::{self, Write};
use core::panic::PanicInfo;
use meniscus_cases::{CASES, CaseError, Engine64, ROOM, run};
use meniscus_core::engine::Engine;

/// Room for the text, about three times what the cases print.
const ROOM_FOR_TEXT: usize = 64 * 1024;

static mut ENGINE_16: Engine<{ ROOM[0].0 }, { ROOM[0].1 }> = Engine::new();
static mut ENGINE_64: Engine64 = Engine64::new();
static mut ENGINE_128: Engine<{ ROOM[2].0 }, { ROOM[2].1 }> = Engine::new();
static mut ENGINE_512: Engine<{ ROOM[3].0 }, { ROOM[3].1 }> = Engine::new();
static mut OUTPUT: Output = Output { text: [0; ROOM_FOR_TEXT], length: 0 };

/// The text for the host.
struct Output {
    text: [u8; ROOM_FOR_TEXT],
    length: usize,
}

impl Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length + text.len();
        self.text.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

/// Runs all cases; 0 if every one went to its end.
#[unsafe(no_mangle)]
pub extern "C" fn run_all() -> i32 {
    // SAFETY: a module without shared memory has one thread, and nothing here calls back into the host, so that this
    // is the only reference to the output while it lives.
    let output = unsafe { only(&raw mut OUTPUT) };
    output.length = 0;
    match run_each(output) {
        Ok(()) => 0,
        Err(error) => {
            let _ = writeln!(output, "error: {error:?}");
            1
        }
    }
}

fn run_each(output: &mut Output) -> Result<(), CaseError> {
    for case in &CASES {
        // SAFETY: one thread, as above, and no two of these references live at the same time.
        unsafe {
            match case.parameters.grid {
                16 => run(case, only(&raw mut ENGINE_16), output)?,
                64 => run(case, only(&raw mut ENGINE_64), output)?,
                128 => run(case, only(&raw mut ENGINE_128), output)?,
                _ => run(case, only(&raw mut ENGINE_512), output)?,
            }
        }
    }
    Ok(())
}

/// Where the text begins in the module's memory.
#[unsafe(no_mangle)]
pub extern "C" fn output_address() -> *const u8 {
    // SAFETY: takes an address and reads nothing.
    unsafe { (&raw const OUTPUT.text).cast() }
}

/// How many bytes of text there are.
#[unsafe(no_mangle)]
pub extern "C" fn output_length() -> usize {
    // SAFETY: one thread, and no reference to the output outlives a call of `run_all`.
    unsafe { (&raw const OUTPUT.length).read() }
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
fn panic(_: &PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
