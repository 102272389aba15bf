//! Hands the linker the memory map of the board that goes with the target, and tells the programs how large it is.

use std::path::Path;
use std::{env, error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rustc-check-cfg=cfg(large_memory)");
    let target = env::var("TARGET")?;
    let map = match target.split('-').next() {
        Some("thumbv7em") => {
            println!("cargo:rustc-cfg=large_memory");
            "memory/thumbv7em.x"
        }
        Some("thumbv6m") => "memory/thumbv6m.x",
        _ => return Err(format!("no board for {target}").into()),
    };
    let folder = env::var("OUT_DIR")?;
    fs::copy(map, Path::new(&folder).join("memory.x"))?;
    println!("cargo:rustc-link-search={folder}");
    println!("cargo:rerun-if-changed=memory");
    println!("cargo:rerun-if-changed=build.rs");
    Ok(())
}
