//! Bodies of the fuzz targets: what must hold whatever the bytes are.
//!
//! Each takes any bytes, makes of them what its subject takes, and asserts. The workspace `fuzz/` searches for bytes
//! that break one; `tests/fuzz_corpus.rs` replays what it kept.
//!
//! ```
//! for (_, target) in meniscus_tests::fuzzing::TARGETS {
//!     target(b"");
//! }
//! ```

mod assignment;
mod bytes;
mod checkpoint;
mod configuration;
mod golden;
mod gsd;
mod mesh_solve;
mod near_force;
mod pair_force;
mod parameters;
mod positions;
mod step;

pub use assignment::assignment;
pub use checkpoint::checkpoint;
pub use configuration::configuration;
pub use golden::golden;
pub use gsd::gsd;
pub use mesh_solve::mesh_solve;
pub use near_force::near_force;
pub use pair_force::pair_force;
pub use parameters::parameters;
pub use positions::positions;
pub use step::step;

/// The body of a target.
pub type Target = fn(&[u8]);

/// Every target with the name of its folder in the corpus.
pub const TARGETS: [(&str, Target); 11] = [
    ("assignment", assignment),
    ("checkpoint", checkpoint),
    ("configuration", configuration),
    ("golden", golden),
    ("gsd", gsd),
    ("mesh_solve", mesh_solve),
    ("near_force", near_force),
    ("pair_force", pair_force),
    ("parameters", parameters),
    ("positions", positions),
    ("step", step),
];
