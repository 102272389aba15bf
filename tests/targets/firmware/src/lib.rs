//! What both programs need of their board: a way to print, a way to end, and what happens on a panic or a fault.
//!
//! Everything goes through semihosting, that is through the debugger or QEMU, so that any Cortex-M will do.
#![no_std]

use core::fmt::Write;
use core::panic::PanicInfo;
use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio;

pub use cortex_m_semihosting::hio::HostStream as Output;

/// The standard output of the debugger or of QEMU; without one there is nobody to talk to, and the program ends.
#[must_use]
pub fn output() -> Output {
    hio::hstdout().unwrap_or_else(|()| exit(false))
}

/// Ends the program in QEMU; a board stays here.
pub fn exit(success: bool) -> ! {
    debug::exit(if success { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    if let Ok(mut output) = hio::hstderr() {
        let _ = writeln!(output, "{info}");
    }
    exit(false)
}

// SAFETY: the handler reads the frame that the processor saved and ends the program; it goes back to nothing.
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    if let Ok(mut output) = hio::hstderr() {
        let _ = writeln!(output, "fault at {:#010x}", frame.pc());
    }
    exit(false)
}
