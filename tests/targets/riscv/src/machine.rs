//! QEMU's virt machine: how the program starts, prints and ends.

use core::arch::global_asm;
use core::fmt;

/// The transmit register of the serial port, a 16550.
const SERIAL: *mut u8 = 0x1000_0000 as *mut u8;
/// The device that ends the emulation.
const FINISHER: *mut u32 = 0x0010_0000 as *mut u32;
/// Ends with exit code 0.
const PASS: u32 = 0x5555;
/// Ends with the exit code in the upper half.
const FAIL: u32 = 0x3333;

// Sets the stack, fills the statics with zeros (all that QEMU does not load) and goes to `main`; a
// fault ends the program.
global_asm!(
    ".section .text.start, \"ax\"",
    ".globl _start",
    "_start:",
    "la sp, _stack_top",
    "la t0, 2f",
    "csrw mtvec, t0",
    "la t0, _bss_start",
    "la t1, _bss_end",
    "0:",
    "bgeu t0, t1, 1f",
    "sw zero, 0(t0)",
    "addi t0, t0, 4",
    "j 0b",
    "1:",
    "call {main}",
    // The address of a trap handler is a multiple of 4.
    ".balign 4",
    "2:",
    "j {fault}",
    fault = sym fault,
    main = sym crate::main,
);

/// Standard output: the serial port.
pub struct Output;

impl fmt::Write for Output {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            // SAFETY: the serial port is at this address, and QEMU's is always ready for the next byte.
            unsafe { SERIAL.write_volatile(byte) };
        }
        Ok(())
    }
}

/// Ends the emulation.
pub fn exit(success: bool) -> ! {
    let word = if success { PASS } else { 1 << 16 | FAIL };
    // SAFETY: the device is at this address and takes one word.
    unsafe { FINISHER.write_volatile(word) };
    loop {
        core::hint::spin_loop();
    }
}

/// What a fault does.
extern "C" fn fault() -> ! {
    exit(false)
}
