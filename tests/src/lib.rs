//! Shared parts of the tests of Meniscus: independent references, named cases, tolerances.
//!
//! With `MENISCUS_LONG_TESTS=1` in the environment, tests that gain from it take longer and look closer; use
//! `--release` then.

pub mod arrays;
pub mod checkpoints;
pub mod directories;
pub mod field;
pub mod figures;
pub mod fits;
pub mod fuzzing;
pub mod program;
pub mod reference;
pub mod schemes;
pub mod states;
pub mod statistics;
pub mod tolerances;

/// Whether the long version of the tests was asked for.
pub fn long_tests() -> bool {
    std::env::var_os("MENISCUS_LONG_TESTS").is_some_and(|value| value == "1")
}
