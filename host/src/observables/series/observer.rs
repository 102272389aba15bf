//! From a state to the rows of a series.

use super::rows::{Rows, cell};
use super::{Grouping, Moment, Series, Settings};
use crate::files::trajectory::Frame;
use crate::observables::clusters::Clusters;
use crate::observables::density::{CLOSE_PACKING, Density, DensityError};
use crate::observables::energy::PotentialEnergy;
use crate::observables::minkowski::{by_contours, by_pixels};
use crate::observables::modes::Modes;
use crate::observables::radial_distribution::{RadialDistribution, RadialDistributionError};
use crate::observables::radii::{Groups, GroupsError};
use crate::observables::structure_factor::{
    LARGEST_WAVENUMBER, StructureFactor, StructureFactorError, WAVES_PER_SHELL,
};
use meniscus_core::torus::{Position, Torus};
use thiserror::Error;

/// g(r) goes up to this distance, R0, or to half the box.
const LARGEST_DISTANCE: f64 = 20.0;
/// Width of the bins of g(r), R0.
const BIN_WIDTH: f64 = 0.1;

/// Why a series cannot be made.
#[derive(Debug, Error)]
pub enum SeriesError {
    /// Nobody knows which discs belong together.
    #[error(
        "radii: which discs belong together is not known; give a width of shells, or a configuration whose discs start \
         in a patch"
    )]
    Groups,
    /// The density of the Minkowski functionals.
    #[error("minkowski: {0}")]
    Density(#[from] DensityError),
    /// The shells of a patch.
    #[error("radii: {0}")]
    Shells(#[from] GroupsError),
    /// The bins of g(r).
    #[error("radial_distribution: {0}")]
    RadialDistribution(#[from] RadialDistributionError),
    /// The waves of S(k).
    #[error("structure_factor: {0}")]
    StructureFactor(#[from] StructureFactorError),
}

/// What makes the rows of a series, set up once.
///
/// ```
/// use meniscus::files::trajectory::Frame;
/// use meniscus::observables::series::{Moment, Observer, Series, Settings};
/// use meniscus::start;
/// use meniscus_core::torus::Torus;
///
/// let torus = Torus::new(100.0).unwrap();
/// let positions = start::square_lattice(100).unwrap();
/// let settings = Settings { minkowski_thresholds: vec![0.01], ..Settings::of_box(torus) };
/// let minkowski = Observer::new(Series::Minkowski, &settings, &positions).unwrap();
/// let frame = Frame { positions: &positions, ..Frame::default() };
/// let rows = minkowski.rows(&Moment::new(7, 1 << 40, Some(2.0)), &frame);
/// assert!(rows.starts_with("7,1,0.5,0.01,"));
/// ```
#[derive(Clone, Debug)]
pub struct Observer(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// With the energy, if it is known.
    Observables(Torus, Option<Box<PotentialEnergy>>),
    Minkowski(Torus, f64, Vec<f64>),
    Modes(Box<Modes>),
    RadialDistribution(Box<RadialDistribution>),
    StructureFactor(Box<StructureFactor>),
    Radii(Torus, Groups),
}

impl Observer {
    /// That of a series, the discs being at `initial` at time zero.
    ///
    /// # Errors
    /// A [`SeriesError`] if `settings` do not do for the series.
    pub fn new(series: Series, settings: &Settings, initial: &[Position]) -> Result<Self, SeriesError> {
        let torus = settings.torus;
        Ok(Self(match series {
            Series::Observables => {
                let energy = settings.system.as_ref().map(|system| Box::new(PotentialEnergy::new(system)));
                Kind::Observables(torus, energy)
            }
            Series::Minkowski => {
                // What is refused does not depend on the discs.
                Density::new(&torus, &[], settings.minkowski_spacing)?;
                Kind::Minkowski(torus, settings.minkowski_spacing, settings.minkowski_thresholds.clone())
            }
            Series::Modes => Kind::Modes(Box::new(Modes::new(&torus, initial, settings.modes_shells))),
            Series::RadialDistribution => {
                let largest = LARGEST_DISTANCE.min(torus.side() / 2.0);
                let bins = RadialDistribution::new(&torus, largest, BIN_WIDTH.min(largest))?;
                Kind::RadialDistribution(Box::new(bins))
            }
            Series::StructureFactor => {
                // A box that is smaller than any run's has its longest wave.
                let largest = LARGEST_WAVENUMBER.max(core::f64::consts::TAU / torus.side());
                Kind::StructureFactor(Box::new(StructureFactor::new(&torus, largest, WAVES_PER_SHELL)?))
            }
            Series::Radii => Kind::Radii(torus, groups(settings, initial)?),
        }))
    }

    /// The rows of the state in `frame`, each with the end of its line.
    #[must_use]
    pub fn rows(&self, moment: &Moment, frame: &Frame<'_>) -> String {
        let mut rows = Rows::of(moment);
        match &self.0 {
            Kind::Observables(torus, energy) => observables(&mut rows, torus, energy.as_deref(), frame),
            Kind::Minkowski(torus, spacing, thresholds) => {
                if let Ok(density) = Density::new(torus, frame.positions, *spacing) {
                    minkowski(&mut rows, &density, thresholds);
                }
            }
            Kind::Modes(modes) => {
                for mode in modes.of(frame.positions) {
                    let [wavenumber, amplitude, power] =
                        [mode.wavenumber, mode.amplitude, mode.power].map(cell);
                    rows.add(&[&mode.shell, &wavenumber, &amplitude, &power, &cell(mode.log_growth)]);
                }
            }
            Kind::RadialDistribution(distribution) => {
                for bin in distribution.of(frame.positions) {
                    rows.add(&[&cell(bin.distance), &cell(bin.g)]);
                }
            }
            Kind::StructureFactor(factor) => {
                for shell in factor.of(frame.positions) {
                    rows.add(&[&cell(shell.wavenumber), &cell(shell.structure_factor)]);
                }
            }
            Kind::Radii(torus, groups) => {
                for found in groups.radii(torus, frame.positions) {
                    let [initial, radius, spread] =
                        [found.initial_radius, found.radius, found.spread].map(cell);
                    rows.add(&[&found.group, &initial, &radius, &spread]);
                }
            }
        }
        rows.into_text()
    }
}

fn groups(settings: &Settings, initial: &[Position]) -> Result<Groups, SeriesError> {
    match settings.groups.ok_or(SeriesError::Groups)? {
        Grouping::Rings { rings, per_ring, spacing } => Ok(Groups::rings(rings, per_ring, spacing)),
        Grouping::Shells { width } => Ok(Groups::shells(&settings.torus, initial, width)?),
    }
}

fn observables(rows: &mut Rows, torus: &Torus, energy: Option<&PotentialEnergy>, frame: &Frame<'_>) {
    let found;
    let clusters = match frame.clustered {
        Some(clusters) => clusters,
        None => {
            found = Clusters::find(torus, frame.positions);
            &found
        }
    };
    let strengths = (!frame.strengths.is_empty()).then_some(frame.strengths);
    let energies = energy.map(|energy| energy.of(frame.positions, strengths));
    // 0 is no step unless a force has refused one.
    let step_is_known = frame.time_step > 0.0 || frame.largest_force.is_some();
    rows.add(&[
        &cell(step_is_known.then_some(frame.time_step)),
        &cell(frame.largest_force),
        &clusters.count(),
        &clusters.number_average(),
        &clusters.mass_average(),
        &clusters.largest(),
        &cell(energies.map(|energies| energies.capillary)),
        &cell(energies.map(|energies| energies.repulsive)),
    ]);
}

/// One row a threshold, in units of the density of closest packing.
fn minkowski(rows: &mut Rows, density: &Density, thresholds: &[f64]) {
    for &threshold in thresholds {
        let level = threshold * CLOSE_PACKING;
        let (pixels, contours) = (by_pixels(density, level), by_contours(density, level));
        rows.add(&[
            &cell(threshold),
            &cell(pixels.area),
            &cell(pixels.length),
            &pixels.euler,
            &cell(pixels.shape()),
            &cell(contours.area),
            &cell(contours.length),
            &contours.euler,
            &cell(contours.shape()),
        ]);
    }
}
