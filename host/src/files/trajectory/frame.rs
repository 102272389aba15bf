//! What a trajectory holds of a state, and the names of the formats.

use crate::files::state::State;
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

/// A frame that was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorded {
    /// Step, time, positions and strengths, as far as the file has them.
    pub state: State,
    /// Time in Jeans' times, where there is one.
    pub time_over_jeans: Option<f64>,
    /// Length of the next step, R0²/D; 0 if it is not known.
    pub time_step: f64,
    /// The largest force on a disc, kBT/R0.
    pub largest_force: Option<f64>,
    /// How often each disc went around the box along x and y, in id order; empty if nothing is said of it.
    pub crossings: Vec<[i32; 2]>,
}

impl Recorded {
    /// A state of which nothing more is known.
    #[must_use]
    pub fn from_state(state: State) -> Self {
        Self { state, ..Self::default() }
    }

    /// The frame to be written, with its clusters.
    #[must_use]
    pub fn frame<'a>(&'a self, clusters: Option<&'a Clusters>) -> Frame<'a> {
        Frame {
            step: self.state.step,
            time: self.state.time,
            time_over_jeans: self.time_over_jeans,
            time_step: self.time_step,
            largest_force: self.largest_force,
            positions: &self.state.positions,
            crossings: &self.crossings,
            strengths: self.state.strengths.as_deref().unwrap_or_default(),
            clustered: clusters,
        }
    }
}

/// A format of trajectories.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// GSD, exact, for gsd, freud, MDAnalysis and OVITO.
    Gsd,
    /// Extended XYZ, exact, for OVITO and ASE.
    ExtendedXyz,
    /// LAMMPS dump, exact but for the time, for OVITO, MDAnalysis and others.
    LammpsDump,
    /// NumPy's archive of arrays, exact.
    Npz,
}

/// What belongs to a format: its word in a configuration, the endings of its files, the usual one first.
const TABLE: [(Format, &str, &[&str]); 4] = [
    (Format::Gsd, "gsd", &["gsd"]),
    (Format::ExtendedXyz, "xyz", &["xyz", "extxyz"]),
    (Format::LammpsDump, "lammps", &["lammpstrj"]),
    (Format::Npz, "npz", &["npz"]),
];

impl Format {
    /// The word for it in a configuration, and the format.
    pub const WORDS: [(&'static str, Self); TABLE.len()] = {
        let mut words = [("", Self::Gsd); TABLE.len()];
        let mut index = 0;
        while index < words.len() {
            words[index] = (TABLE[index].1, TABLE[index].0);
            index += 1;
        }
        words
    };

    /// The format that the ending of `path` tells.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        TABLE.iter().find(|(_, _, endings)| endings.contains(&ending)).map(|(format, _, _)| *format)
    }

    /// The name of a run's trajectory of this format: `trajectory.gsd` and the like.
    #[must_use]
    pub fn file_name(self) -> String {
        let endings = TABLE.iter().find(|(format, _, _)| *format == self).map(|(_, _, endings)| *endings);
        format!("trajectory.{}", endings.and_then(|endings| endings.first()).copied().unwrap_or_default())
    }
}
