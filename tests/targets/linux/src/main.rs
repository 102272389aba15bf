//! All golden cases on Linux, with nothing below but two system calls: the same program for every processor.
#![no_std]
#![no_main]

mod memory;
mod system;

use core::fmt::{self, Write};
use core::panic::PanicInfo;
use meniscus_cases::{CASES, CaseError, Engine64, ROOM, run};
use meniscus_core::engine::Engine;

/// An engine for each mesh of the cases.
struct Engines {
    of_16: Engine<{ ROOM[0].0 }, { ROOM[0].1 }>,
    of_64: Engine64,
    of_128: Engine<{ ROOM[2].0 }, { ROOM[2].1 }>,
    of_512: Engine<{ ROOM[3].0 }, { ROOM[3].1 }>,
}

static mut ENGINES: Engines =
    Engines { of_16: Engine::new(), of_64: Engine::new(), of_128: Engine::new(), of_512: Engine::new() };

/// Standard output.
struct Output;

impl Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        system::write(text.as_bytes());
        Ok(())
    }
}

/// Where the entry in `system` goes to, once.
extern "C" fn main() -> ! {
    let code = match run_all() {
        Ok(()) => 0,
        Err(error) => {
            let _ = writeln!(Output, "error: {error:?}");
            2
        }
    };
    system::exit(code)
}

fn run_all() -> Result<(), CaseError> {
    let engines = &raw mut ENGINES;
    // SAFETY: the program has one thread, and calls this function once.
    let engines = unsafe { &mut *engines };
    for case in &CASES {
        match case.parameters.grid {
            16 => run(case, &mut engines.of_16, &mut Output)?,
            64 => run(case, &mut engines.of_64, &mut Output)?,
            128 => run(case, &mut engines.of_128, &mut Output)?,
            _ => run(case, &mut engines.of_512, &mut Output)?,
        }
    }
    Ok(())
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let _ = writeln!(Output, "{info}");
    system::exit(101)
}
