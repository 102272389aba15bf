//! Series: tables that a run writes at their own cadence, and `meniscus analyze` from any trajectory.
//!
//! In: states of a run, one after the other. Out: comma-separated values, some rows a state. The first columns of every
//! series are [`HEAD_COLUMNS`]; then come its key columns, which tell the rows of a state from each other, and its values.
//! A cell is empty where a value does not exist. Lengths are in R0, times in R0²/D, energies in kBT.
//!
//! | Series | Rows of a state | Key columns | Value columns |
//! |---|---|---|---|
//! | `observables` | 1 | | next step, largest force, [clusters](super::clusters), [energies](super::energy) |
//! | `minkowski` | one a threshold | `threshold`, of ρ_m | Minkowski functionals and shape factor, by pixels and by contours |
//! | `modes` | one a shell | `shell`, `wavenumber` | mean \|ρ̂\|, \|ρ̂\|² and ln(\|ρ̂\|/\|ρ̂(0)\|) of the waves in it |
//! | `radial_distribution` | one a distance | `distance` | g(r) |
//! | `structure_factor` | one a wavenumber | `wavenumber` | S(k) |
//! | `radii` | one a group of discs | `group`, `initial_radius` | mean distance from the patch's middle and its spread |
//!
//! ```
//! use meniscus::observables::series::Series;
//!
//! assert_eq!(Series::Modes.file_name(), "modes.csv");
//! assert_eq!(
//!     Series::Modes.header(),
//!     "step,time,time_over_jeans,shell,wavenumber,amplitude,power,log_growth"
//! );
//! assert_eq!(Series::of_name("radii"), Some(Series::Radii));
//! ```

mod observer;
mod rows;
mod settings;

pub use observer::{Observer, SeriesError};
pub use rows::Moment;
pub use settings::{Grouping, Settings};

/// The columns that every series begins with: steps made, time in R0²/D, and time in Jeans' times, empty where there is
/// none.
pub const HEAD_COLUMNS: [&str; 3] = ["step", "time", "time_over_jeans"];

/// A table that is written in the course of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Series {
    /// What a run is followed by: step rule, clusters, energies.
    Observables,
    /// Minkowski functionals of the dense regions (Figs. 7 to 11).
    Minkowski,
    /// Density modes by shells of wavenumbers (Fig. 2).
    Modes,
    /// Pair distribution g(r).
    RadialDistribution,
    /// Static structure factor S(k).
    StructureFactor,
    /// Radii of the rings or shells of a collapsing patch (Figs. 12 to 14).
    Radii,
}

impl Series {
    /// All of them, in the order of the table above.
    pub const ALL: [Self; 6] = [
        Self::Observables,
        Self::Minkowski,
        Self::Modes,
        Self::RadialDistribution,
        Self::StructureFactor,
        Self::Radii,
    ];

    /// The series of that name, if there is one.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|series| series.name() == name)
    }

    /// Its name: that of the key of its interval, in the table `output` of a configuration.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Observables => "observables",
            Self::Minkowski => "minkowski",
            Self::Modes => "modes",
            Self::RadialDistribution => "radial_distribution",
            Self::StructureFactor => "structure_factor",
            Self::Radii => "radii",
        }
    }

    /// Name of its file in a run's directory.
    #[must_use]
    pub fn file_name(self) -> String {
        format!("{}.csv", self.name())
    }

    /// The columns that tell the rows of one state from each other; none if there is one row.
    #[must_use]
    pub const fn key_columns(self) -> &'static [&'static str] {
        match self {
            Self::Observables => &[],
            Self::Minkowski => &["threshold"],
            Self::Modes => &["shell", "wavenumber"],
            Self::RadialDistribution => &["distance"],
            Self::StructureFactor => &["wavenumber"],
            Self::Radii => &["group", "initial_radius"],
        }
    }

    /// The columns of what is measured.
    #[must_use]
    pub const fn value_columns(self) -> &'static [&'static str] {
        match self {
            Self::Observables => &[
                "dt",
                "max_force",
                "clusters",
                "mean_cluster_size",
                "mass_weighted_cluster_size",
                "largest_cluster",
                "capillary_energy",
                "repulsive_energy",
            ],
            Self::Minkowski => &[
                "pixel_area",
                "pixel_length",
                "pixel_euler",
                "pixel_shape",
                "area",
                "length",
                "euler",
                "shape",
            ],
            Self::Modes => &["amplitude", "power", "log_growth"],
            Self::RadialDistribution => &["g"],
            Self::StructureFactor => &["structure_factor"],
            Self::Radii => &["radius", "spread"],
        }
    }

    /// Whether its rows compare a state with where the discs were at time zero.
    #[must_use]
    pub const fn compares_with_start(self) -> bool {
        matches!(self, Self::Modes | Self::Radii)
    }

    /// The first line of its file, without the end of the line.
    #[must_use]
    pub fn header(self) -> String {
        [&HEAD_COLUMNS, self.key_columns(), self.value_columns()].concat().join(",")
    }
}
