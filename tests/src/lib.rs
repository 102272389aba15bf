//! Shared parts of the tests of Meniscus: independent references, named cases, tolerances.

pub mod reference;
