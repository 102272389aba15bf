//! How much memory a run takes, and how much there is: a run that cannot have it is refused before it asks for any.
//!
//! The estimate is of what a run takes at the least: the arrays of the mesh and of the discs, and the lists of neighbours
//! at the mean density of the box. What there is, is the least of what the system calls available, swap included, the
//! limit of the process's control group, and that of its address space (`ulimit -v`). It is known on Linux; elsewhere
//! nothing is refused.
//!
//! ```
//! use meniscus::configuration::Configuration;
//! use meniscus::memory::estimate;
//!
//! let largest = ["system.particles=4194304", "system.box=32768", "force.method=pm", "mesh.grid=4096"];
//! let table_1 = Configuration::from_preset("table-1", &["force.method=pm".to_owned()])?;
//! let largest = Configuration::from_preset("table-1", &largest.map(str::to_owned))?;
//! assert!(estimate(&table_1) < 10 << 20);
//! assert!(estimate(&largest) > 600 << 20);
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

use crate::configuration::{Configuration, Force};
use meniscus_core::repulsion::CUTOFF;
use std::f64::consts::PI;
use std::fs;

/// Bytes a mesh node takes: its mass, the field, and a quarter of an element of the influence function, 4 + 8 + 1.
const BYTES_PER_NODE: f64 = 13.0;
/// Bytes a disc takes: 56 in the engine's arrays, as many where neighbours are searched, and what the start and the state's
/// bytes hold; measured for 10⁶ discs, 120 with the core's stages and 155 with the wide ones.
const BYTES_PER_DISC: f64 = 120.0;
/// Bytes more if mesh forces are held: two forces, and where they were computed.
const BYTES_HELD: f64 = 40.0;
/// Bytes of an entry in a list of neighbours.
const BYTES_PER_NEIGHBOUR: f64 = 4.0;

/// A run needs more memory than there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{particles} discs and a mesh of {grid} x {grid} nodes need at least {needed} bytes of memory ({:.1} GB), and \
     {available} can be had ({limit}): lower the number of particles or mesh.grid, or raise the limit",
    *.needed as f64 / 1e9
)]
pub struct MemoryError {
    /// Number of discs.
    pub particles: usize,
    /// Mesh nodes a side.
    pub grid: usize,
    /// The estimate, bytes.
    pub needed: u64,
    /// What there is, bytes.
    pub available: u64,
    /// Who says so.
    pub limit: &'static str,
}

/// What a run of this configuration takes at the least, bytes.
#[must_use]
pub fn estimate(configuration: &Configuration) -> u64 {
    let system = &configuration.system;
    let (count, grid) = (system.particles as f64, configuration.mesh.grid as f64);
    let reach = match configuration.force {
        Force::ParticleMesh => CUTOFF,
        Force::P3m { cutoff, .. } => cutoff.max(CUTOFF),
    };
    // Each pair is in one list.
    let neighbours = 0.5 * PI * reach * reach * count / (system.side * system.side);
    let held = if configuration.mesh_refresh > 0.0 { BYTES_HELD } else { 0.0 };
    let per_disc = BYTES_PER_DISC + held + BYTES_PER_NEIGHBOUR * neighbours;
    (BYTES_PER_NODE * grid * grid + per_disc * count) as u64
}

/// Refuses a configuration whose run would not fit the memory there is.
///
/// # Errors
/// [`MemoryError`].
pub fn check(configuration: &Configuration) -> Result<(), MemoryError> {
    let needed = estimate(configuration);
    match available() {
        Some((available, limit)) if needed > available => Err(MemoryError {
            particles: configuration.system.particles,
            grid: configuration.mesh.grid,
            needed,
            available,
            limit,
        }),
        _ => Ok(()),
    }
}

/// How many bytes of memory this process can still have, and who says so; None where nobody does.
#[must_use]
pub fn available() -> Option<(u64, &'static str)> {
    let read = |path: &str| fs::read_to_string(path).ok();
    let of_system = read("/proc/meminfo").and_then(|text| of_meminfo(&text));
    let of_group = read("/proc/self/cgroup").and_then(|text| {
        let unified = text.lines().find_map(|line| line.strip_prefix("0::"))?;
        let folders = std::path::Path::new(unified.trim()).ancestors();
        let limits = folders.filter_map(|folder| {
            let folder = folder.strip_prefix("/").unwrap_or(folder);
            let path = std::path::Path::new("/sys/fs/cgroup").join(folder).join("memory.max");
            fs::read_to_string(path).ok()?.trim().parse().ok()
        });
        limits.min()
    });
    // The first version of control groups.
    let of_group =
        of_group.or_else(|| read("/sys/fs/cgroup/memory/memory.limit_in_bytes")?.trim().parse().ok());
    let of_process = read("/proc/self/limits").and_then(|text| of_limits(&text)).map(|limit| {
        let taken = read("/proc/self/status").and_then(|text| kilobytes(&text, "VmSize:")).unwrap_or(0);
        limit.saturating_sub(taken)
    });
    [
        of_system.map(|bytes| (bytes, "the system's memory")),
        of_group.map(|bytes| (bytes, "the limit of the control group")),
        of_process.map(|bytes| (bytes, "the limit of the address space, ulimit -v")),
    ]
    .into_iter()
    .flatten()
    .min()
}

/// The number of a line `name   12 kB`, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let number = text.lines().find_map(|line| line.strip_prefix(name))?;
    number.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

/// What `/proc/meminfo` calls available, and free swap.
fn of_meminfo(text: &str) -> Option<u64> {
    Some(kilobytes(text, "MemAvailable:")?.saturating_add(kilobytes(text, "SwapFree:").unwrap_or(0)))
}

/// The soft limit of the address space in `/proc/self/limits`; None if there is none.
fn of_limits(text: &str) -> Option<u64> {
    text.lines()
        .find_map(|line| line.strip_prefix("Max address space"))?
        .split_whitespace()
        .next()?
        .parse()
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_understood() {
        let meminfo = "MemTotal:  16 kB\nMemFree:   1 kB\nMemAvailable:    5 kB\nSwapFree:   2 kB\n";
        assert_eq!(of_meminfo(meminfo), Some(7 * 1024));
        assert_eq!(of_meminfo("MemTotal: 16 kB\n"), None);
        let limits = |limit: &str| {
            format!("Limit  Soft Limit  Hard Limit  Units\nMax address space   {limit}   unlimited   bytes\n")
        };
        assert_eq!(of_limits(&limits("1000")), Some(1000));
        assert_eq!(of_limits(&limits("unlimited")), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_machine_has_memory() {
        assert!(available().is_some_and(|(bytes, _)| bytes > 1 << 20));
    }
}
