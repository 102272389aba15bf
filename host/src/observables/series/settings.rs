//! What series are made with besides states.

use crate::configuration::{Configuration, Output, Start, System};
use meniscus_core::torus::Torus;

/// What series are made with besides states.
///
/// ```
/// use meniscus::observables::series::Settings;
/// use meniscus_core::torus::Torus;
///
/// let settings = Settings::of_box(Torus::new(500.0).unwrap());
/// assert_eq!((settings.minkowski_spacing, settings.groups), (5.3, None));
/// ```
#[derive(Clone, Debug)]
pub struct Settings {
    /// The box.
    pub torus: Torus,
    /// What attracts and repels the discs; None if it is not known, and energies neither.
    pub system: Option<System>,
    /// Spacing of the grid of the density, R0.
    pub minkowski_spacing: f64,
    /// Thresholds of the density, in units of ρ_m = 1/(2√3) R0⁻², increasing.
    pub minkowski_thresholds: Vec<f64>,
    /// Number of shells of modes.
    pub modes_shells: u32,
    /// Which discs belong together in `radii`; None if it is not known.
    pub groups: Option<Grouping>,
}

/// Which discs of a patch belong together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grouping {
    /// Those of a ring, as a start in rings lays them out.
    Rings {
        /// Number of rings.
        rings: u32,
        /// Discs in the innermost ring.
        per_ring: u32,
        /// Distance between rings, R0.
        spacing: f64,
    },
    /// Those whose distances from the middle of the box at time zero lie in a shell.
    Shells {
        /// Width of the shells, R0.
        width: f64,
    },
}

impl Settings {
    /// Those of a run of `configuration` in the box `torus`.
    #[must_use]
    pub fn of(configuration: &Configuration, torus: Torus) -> Self {
        let output = &configuration.output;
        let groups = match configuration.start {
            Start::Rings { rings, spacing, per_ring } => Some(Grouping::Rings { rings, per_ring, spacing }),
            Start::Disc { .. } | Start::File { .. } => Some(Grouping::Shells { width: output.radii_width }),
            Start::Random | Start::Lattice { .. } => None,
        };
        Self { system: Some(configuration.system), groups, ..Self::of_output(output, torus) }
    }

    /// The usual ones of discs of which only the box is known.
    #[must_use]
    pub fn of_box(torus: Torus) -> Self {
        Self::of_output(&Output::default(), torus)
    }

    fn of_output(output: &Output, torus: Torus) -> Self {
        Self {
            torus,
            system: None,
            minkowski_spacing: output.minkowski_spacing,
            minkowski_thresholds: output.minkowski_thresholds.clone(),
            modes_shells: output.modes_shells,
            groups: None,
        }
    }
}
