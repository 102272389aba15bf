//! What a trajectory holds of a state, and the names of the formats.

use crate::observables::clusters::Clusters;
use meniscus_core::torus::Position;
use std::path::Path;

/// A state of a run as a trajectory shows it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frame<'a> {
    /// Steps made.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
    /// Time in Jeans' times, where there is one.
    pub time_over_jeans: Option<f64>,
    /// Length of the next step, R0²/D.
    pub time_step: f64,
    /// The largest force on a disc, kBT/R0; None if it is not known.
    pub largest_force: Option<f64>,
    /// Positions in id order.
    pub positions: &'a [Position],
    /// How often each disc went around the box along x and y, in id order; may be empty if none did.
    pub crossings: &'a [[i32; 2]],
    /// Capillary strengths in id order, unit 2⁻²⁰; may be empty if all are 1.
    pub strengths: &'a [i32],
    /// The clusters, if they are to be in the file.
    pub clustered: Option<&'a Clusters>,
}

/// A format of trajectories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Extended XYZ, for OVITO and ASE.
    ExtendedXyz,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 1] = [Self::ExtendedXyz];

    /// The word for it in a configuration.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::ExtendedXyz => "xyz",
        }
    }

    /// The endings of its files' names, without the dot, the usual one first.
    #[must_use]
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            Self::ExtendedXyz => &["xyz", "extxyz"],
        }
    }

    /// The format whose word is `word`.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.word() == word)
    }

    /// The format that the ending of `path` tells.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        Self::ALL.into_iter().find(|format| format.endings().contains(&ending))
    }

    /// The name of a run's trajectory of this format.
    #[must_use]
    pub fn file_name(self) -> &'static str {
        match self {
            Self::ExtendedXyz => "trajectory.xyz",
        }
    }
}
