//! Entry, write and exit for every processor: all that the program asks of Linux.

use core::arch::{asm, global_asm};

/// Number of the system call `write` and `exit`.
#[cfg(target_arch = "x86_64")]
const CALLS: (usize, usize) = (1, 60);
#[cfg(any(target_arch = "x86", target_arch = "arm", target_arch = "powerpc64"))]
const CALLS: (usize, usize) = (4, 1);
#[cfg(any(target_arch = "aarch64", target_arch = "riscv64"))]
const CALLS: (usize, usize) = (64, 93);

// The entry aligns the stack as each processor's calling convention wants it and goes to `main`.
#[cfg(target_arch = "x86_64")]
global_asm!(".globl _start", "_start:", "xor ebp, ebp", "and rsp, -16", "call {main}", main = sym crate::main);
#[cfg(target_arch = "x86")]
global_asm!(".globl _start", "_start:", "xor ebp, ebp", "and esp, -16", "call {main}", main = sym crate::main);
#[cfg(target_arch = "aarch64")]
global_asm!(".globl _start", "_start:", "mov x29, #0", "bl {main}", main = sym crate::main);
#[cfg(target_arch = "arm")]
global_asm!(".globl _start", "_start:", "mov r11, #0", "bic sp, sp, #7", "bl {main}", main = sym crate::main);
#[cfg(target_arch = "riscv64")]
global_asm!(
    ".globl _start",
    "_start:",
    ".option push",
    ".option norelax",
    "la gp, __global_pointer$",
    ".option pop",
    "andi sp, sp, -16",
    "call {main}",
    main = sym crate::main
);
// Linux enters a program of the second 64-bit PowerPC convention, which musl has, with its address in r12; from it
// follows the table of contents in r2. The frame holds what a called function may store above its own.
#[cfg(target_arch = "powerpc64")]
global_asm!(
    ".globl _start",
    ".type _start, @function",
    "_start:",
    "addis 2, 12, .TOC.-_start@ha",
    "addi 2, 2, .TOC.-_start@l",
    "clrrdi 1, 1, 4",
    "li 0, 0",
    "stdu 0, -64(1)",
    "bl {main}",
    "nop",
    main = sym crate::main
);

/// What the processor can do, of which nobody here makes use: none of it.
#[cfg(target_arch = "aarch64")]
#[unsafe(no_mangle)]
extern "C" fn getauxval(_kind: usize) -> usize {
    0
}

/// Named by the unwind tables of the precompiled `core`; nothing here unwinds, so nothing calls it.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

/// Writes `bytes` to standard output; a failure has nobody to be told to.
pub fn write(bytes: &[u8]) {
    // SAFETY: `write` reads `bytes.len()` bytes at the address given and writes nothing.
    unsafe {
        call(CALLS.0, 1, bytes.as_ptr() as usize, bytes.len());
    }
}

/// Ends the program.
pub fn exit(code: usize) -> ! {
    loop {
        // SAFETY: `exit` takes a number; it does not return.
        unsafe {
            call(CALLS.1, code, 0, 0);
        }
    }
}

/// A system call with up to three arguments.
///
/// # Safety
/// The call has to be harmless with these arguments.
unsafe fn call(number: usize, first: usize, second: usize, third: usize) {
    // SAFETY: the registers are those of Linux's convention for the processor; all that a call may change is declared.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        asm!("syscall", inlateout("rax") number => _, in("rdi") first, in("rsi") second, in("rdx") third,
             lateout("rcx") _, lateout("r11") _);
        #[cfg(target_arch = "x86")]
        asm!("int 0x80", inlateout("eax") number => _, in("ebx") first, in("ecx") second, in("edx") third);
        #[cfg(target_arch = "aarch64")]
        asm!("svc 0", in("x8") number, inlateout("x0") first => _, in("x1") second, in("x2") third);
        #[cfg(target_arch = "arm")]
        asm!("svc 0", in("r7") number, inlateout("r0") first => _, in("r1") second, in("r2") third);
        #[cfg(target_arch = "riscv64")]
        asm!("ecall", in("a7") number, inlateout("a0") first => _, in("a1") second, in("a2") third);
        #[cfg(target_arch = "powerpc64")]
        asm!("sc", inlateout("r0") number => _, inlateout("r3") first => _, inlateout("r4") second => _,
             inlateout("r5") third => _, clobber_abi("C"));
    }
}
