//! How much memory a run takes, and how much there is: a run that cannot have it is refused before it asks for any.
//!
//! The estimate is of what a run takes at the least: the arrays of the mesh and of the discs, the lists of neighbours
//! at the mean density of the box, and what the rows of its tables and its snapshots are made of. What there is, is the
//! least of what the system calls available, swap included, the limit of the process's control group, and that of its
//! address space (`ulimit -v`). It is known on Linux; elsewhere nothing is refused.
//!
//! ```
//! use meniscus::configuration::Configuration;
//! use meniscus::memory::estimate;
//!
//! let largest = ["system.particles=4194304", "system.box=32768", "force.method=pm", "mesh.grid=4096"];
//! let table_1 = Configuration::from_preset("table-1", &["force.method=pm".to_owned()])?;
//! let largest = Configuration::from_preset("table-1", &largest.map(str::to_owned))?;
//! assert!(estimate(&table_1) < 65 << 20);
//! assert!(estimate(&largest) > 600 << 20);
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

mod available;
mod output;

pub use available::available;
pub use output::Part;

use crate::configuration::{Configuration, Force};
use meniscus_core::repulsion::CUTOFF;
use std::f64::consts::PI;

/// Bytes a mesh node takes: its mass, the field, and a quarter of an element of the influence function, 4 + 8 + 1.
const BYTES_PER_NODE: f64 = 13.0;
/// Bytes a disc takes: 56 in the engine's arrays, as many where neighbours are searched, and what the start and the state's
/// bytes hold; measured for 10⁶ discs, 120 with the core's stages and 155 with the wide ones.
const BYTES_PER_DISC: f64 = 120.0;
/// Bytes a disc takes of these while rows are made, when the start is long done.
const BYTES_AT_REST: f64 = 76.0;
/// Bytes more if mesh forces are held: two forces, and where they were computed.
const BYTES_HELD: f64 = 40.0;
/// A part is told to take much if it takes more than this part of all, inverted.
const LARGE_PART: u64 = 4;
/// Bytes of an entry in a list of neighbours.
const BYTES_PER_NEIGHBOUR: f64 = 4.0;

/// A run needs more memory than there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{particles} discs and a mesh of {grid} x {grid} nodes need at least {needed} bytes of memory ({:.1} GB){}, and \
     {available} can be had ({limit}): lower the number of particles or mesh.grid{}, or raise the limit",
    *.needed as f64 / 1e9,
    .largest.map_or(String::new(), |(part, bytes)| format!(", {bytes} of them for {}", part.name())),
    .largest.map_or(String::new(), |(part, _)| format!(", or {}", part.remedy()))
)]
pub struct MemoryError {
    /// Number of discs.
    pub particles: usize,
    /// Mesh nodes a side.
    pub grid: usize,
    /// The estimate, bytes.
    pub needed: u64,
    /// What of its output takes most and how much, if that is a large part.
    pub largest: Option<(Part, u64)>,
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
    let touching = if system.repulsion { CUTOFF } else { 0.0 };
    let reach = match configuration.force {
        Force::ParticleMesh => touching,
        Force::P3m { cutoff, .. } => cutoff.max(touching),
    };
    // Each pair is in one list.
    let neighbours = 0.5 * PI * reach * reach * count / (system.side * system.side);
    let held = if configuration.mesh_refresh > 0.0 { BYTES_HELD } else { 0.0 };
    let always = BYTES_PER_NODE * grid * grid + (held + BYTES_PER_NEIGHBOUR * neighbours) * count;
    let at_rest = BYTES_AT_REST * count + output::estimate(configuration);
    (always + at_rest.max(BYTES_PER_DISC * count)) as u64
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
            largest: output::largest(configuration)
                .filter(|(_, bytes)| bytes.saturating_mul(LARGE_PART) > needed),
            available,
            limit,
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observables::series::Series;

    fn configuration(overrides: &str) -> Configuration {
        let overrides: Vec<String> = overrides.split_whitespace().map(str::to_owned).collect();
        Configuration::from_preset("table-1", &overrides).unwrap()
    }

    /// Peaks of resident memory of runs of a few steps with one thread on x86-64 Linux, less the 14.3 MB of the program.
    #[test]
    fn estimates_are_a_little_less_than_what_is_measured() {
        let many = "force.method=pm system.particles=300000 system.box=3000 mesh.grid=512 output.snapshots=0";
        let none = "output.observables=0";
        for (run, megabytes) in [
            (format!("{many} {none}"), 45.5),
            (format!("{many} system.capillary_strength=0 time.until=1"), 52.9),
            (format!("{many} {none} output.minkowski=0.1 output.minkowski_spacing=1.5"), 129.7),
            (format!("{many} {none} output.modes=0.1"), 47.6),
        ] {
            let ratio = estimate(&configuration(&run)) as f64 / (megabytes * 1e6);
            assert!((0.75..=1.0).contains(&ratio), "{run}: {ratio}");
        }
    }

    #[test]
    fn tables_are_made_one_after_the_other() {
        let run = |more: &str| {
            let own = "force.method=pm system.particles=100000 system.box=2000 mesh.grid=256 \
                       output.observables=0 output.snapshots=0";
            estimate(&configuration(&format!("{own} {more}")))
        };
        let [density, pairs] =
            ["output.minkowski=0.1 output.minkowski_spacing=1", "output.radial_distribution=0.1"];
        assert!(run(density) > 2 * run(pairs));
        assert_eq!(run(&format!("{density} {pairs}")), run(density));
        assert_eq!(
            run("output.minkowski=0.1 output.minkowski_spacing=1 output.modes=0.1") - run(density),
            800_000
        );
    }

    #[test]
    fn the_table_that_takes_most_is_named_with_a_remedy() {
        let largest = |part, bytes| {
            let error = MemoryError {
                particles: 2,
                grid: 32,
                needed: 3_000_000_000,
                largest: Some((part, bytes)),
                available: 1000,
                limit: "a limit",
            };
            error.to_string()
        };
        assert_eq!(
            largest(Part::Rows(Series::Minkowski), 2_000_000_000),
            "2 discs and a mesh of 32 x 32 nodes need at least 3000000000 bytes of memory (3.0 GB), 2000000000 of them \
             for the rows of minkowski, and 1000 can be had (a limit): lower the number of particles or mesh.grid, or \
             take a larger output.minkowski_spacing, or raise the limit"
        );
        let observables = Part::Rows(Series::Observables);
        assert!(largest(observables, 1).contains("leave the table out by output.observables = 0"));
        assert!(largest(Part::Snapshots, 55).contains(
            ", 55 of them for a snapshot, and 1000 can be had (a limit): lower the number of particles"
        ));
    }
}
