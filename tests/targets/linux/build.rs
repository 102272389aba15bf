//! On AArch64, sha2 asks libc for the features of the processor and so asks the linker for the system's libraries.
//! The program brings the one function itself (see `system`); the libraries are empty archives.

use std::env;
use std::fs;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_ARCH").as_deref() != Ok("aarch64") {
        return;
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    for library in ["c", "m", "rt", "pthread", "util", "dl", "gcc_s", "gcc"] {
        fs::write(folder.join(format!("lib{library}.a")), "!<arch>\n").expect("OUT_DIR can be written to");
    }
    println!("cargo::rustc-link-search=native={}", folder.display());
}
