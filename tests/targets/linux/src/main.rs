//! All golden cases on Linux, with nothing below but two system calls: the same program for every processor.
#![no_std]
#![no_main]

mod memory;
mod system;

use core::fmt::{self, Write};
use core::panic::PanicInfo;
use meniscus_cases::{CASES, CaseError, ROOM, run};
use meniscus_core::engine::Engine;

static mut ENGINE_16: Engine<{ ROOM[0].0 }, { ROOM[0].1 }> = Engine::new();
static mut ENGINE_64: Engine<{ ROOM[1].0 }, { ROOM[1].1 }> = Engine::new();
static mut ENGINE_128: Engine<{ ROOM[2].0 }, { ROOM[2].1 }> = Engine::new();
static mut ENGINE_512: Engine<{ ROOM[3].0 }, { ROOM[3].1 }> = Engine::new();

/// Standard output.
struct Output;

impl Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        system::write(text.as_bytes());
        Ok(())
    }
}

/// The program's first and only Rust function, called by the entry in `system`.
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
    for case in &CASES {
        // SAFETY: this program has one thread, and no two of these references live at the same time.
        unsafe {
            match case.parameters.grid {
                16 => run(case, &mut *&raw mut ENGINE_16, &mut Output)?,
                64 => run(case, &mut *&raw mut ENGINE_64, &mut Output)?,
                128 => run(case, &mut *&raw mut ENGINE_128, &mut Output)?,
                _ => run(case, &mut *&raw mut ENGINE_512, &mut Output)?,
            }
        }
    }
    Ok(())
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let _ = writeln!(Output, "{info}");
    system::exit(101)
}
