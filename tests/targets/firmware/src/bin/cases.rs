//! The golden cases that the board's memory holds: M = 16 on the Cortex-M0, M = 16, 64 and 128 on the Cortex-M4.
#![no_std]
#![no_main]

use core::fmt::Write;
use cortex_m_rt::entry;
#[cfg(large_memory)]
use meniscus_cases::Engine64;
use meniscus_cases::{CASES, ROOM, longest_table, run};
use meniscus_core::engine::Engine;
use meniscus_firmware::{exit, output};

#[entry]
fn main() -> ! {
    // The entry point runs once and turns each `static mut` into the only reference to it.
    static mut ENGINE_16: Engine<{ ROOM[0].0 }, { ROOM[0].1 }, { longest_table(16) }> = Engine::new();
    #[cfg(large_memory)]
    static mut ENGINE_64: Engine64 = Engine64::new();
    #[cfg(large_memory)]
    static mut ENGINE_128: Engine<{ ROOM[2].0 }, { ROOM[2].1 }> = Engine::new();

    let mut output = output();
    for case in &CASES {
        let result = match case.parameters.grid {
            16 => run(case, ENGINE_16, &mut output),
            #[cfg(large_memory)]
            64 => run(case, ENGINE_64, &mut output),
            #[cfg(large_memory)]
            128 => run(case, ENGINE_128, &mut output),
            _ => continue,
        };
        if let Err(error) = result {
            let _ = writeln!(output, "error: {}: {error:?}", case.name);
            exit(false);
        }
    }
    exit(true)
}
