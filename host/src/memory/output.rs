//! What a run's output takes besides the run, the rows of its tables and its snapshots, at the least: measured, and
//! understood.
//!
//! Each series keeps something from one row to the next, and needs more while its rows are made; series are made one after
//! the other, snapshots after them. What trajectories take is less than what the tables do.

use crate::configuration::Configuration;
use crate::observables::energy::PotentialEnergy;
use crate::observables::series::Series;
use crate::observables::structure_factor::{LARGEST_WAVENUMBER, SHELLS_KEPT};
use crate::snapshot;
use std::f64::consts::TAU;

/// Bytes a disc takes while it is looked at: its position, box crossings and strength.
const BYTES_LOOKED_AT: f64 = 20.0;
/// Bytes a disc takes where it was at the start.
const BYTES_AT_START: f64 = 8.0;

/// Bytes a node of the energy's mesh keeps, a quarter of an element of 8, and needs, 16.
const ENERGY_NODE: [f64; 2] = [2.0, 16.0];
/// Bytes a disc needs while energies are summed: coordinates, strength, eight cells, the next in its cell.
const ENERGY_DISC: f64 = 52.0;
/// Bytes a node of the density's grid needs: its mass in 16, its value in 8.
const DENSITY_NODE: f64 = 24.0;
/// Bytes a disc needs while its neighbours are looked for: at least a place in the table, a link, its position.
const NEIGHBOUR_DISC: f64 = 16.0;
/// Bytes a shell that is looked at keeps and needs: about 100 waves of 12 bytes; of half of them, 32 for sums.
const SHELL: [f64; 2] = [1200.0, 1600.0];
/// Bytes that are needed for each shell up to the last: the phases of 64 discs along both axes.
const PHASES: f64 = 2000.0;
/// Bytes a disc takes that belongs to a group: its id.
const GROUP_DISC: f64 = 4.0;

/// What a series keeps, and what it needs besides while its rows are made, bytes; nothing if it is not written.
fn kept_and_needed(series: Series, configuration: &Configuration) -> [f64; 2] {
    let (system, output) = (&configuration.system, &configuration.output);
    if output.interval(series) <= 0.0 {
        return [0.0; 2];
    }
    let count = system.particles as f64;
    match series {
        Series::Observables => {
            let nodes = PotentialEnergy::mesh_nodes(system) as f64;
            let [kept, needed] = ENERGY_NODE.map(|bytes| bytes * nodes * nodes);
            [kept, needed + ENERGY_DISC * count]
        }
        Series::Minkowski => {
            let grid = (system.side / output.minkowski_spacing).round();
            [0.0, DENSITY_NODE * grid * grid]
        }
        Series::Modes => [0.0; 2],
        Series::RadialDistribution => [0.0, NEIGHBOUR_DISC * count],
        Series::StructureFactor => {
            let shells = LARGEST_WAVENUMBER * system.side / TAU;
            let [kept, needed] = SHELL.map(|bytes| bytes * shells.min(f64::from(SHELLS_KEPT)));
            [kept, needed + PHASES * shells]
        }
        Series::Radii => [GROUP_DISC * count, 0.0],
    }
}

/// Bytes that a snapshot needs, if there are any.
fn snapshot(configuration: &Configuration) -> f64 {
    if configuration.output.snapshots > 0.0 { f64::from(snapshot::MEMORY) } else { 0.0 }
}

/// Bytes that the tables and snapshots of a run of this configuration take.
pub(super) fn estimate(configuration: &Configuration) -> f64 {
    let is_written = |series: &Series| configuration.output.interval(*series) > 0.0;
    let written = || Series::ALL.into_iter().filter(is_written);
    let count = configuration.system.particles as f64;
    let looked_at = if written().next().is_some() { BYTES_LOOKED_AT * count } else { 0.0 };
    let at_start = if written().any(Series::compares_with_start) { BYTES_AT_START * count } else { 0.0 };
    let each = || written().map(|series| kept_and_needed(series, configuration));
    let kept: f64 = each().map(|[kept, _]| kept).sum();
    let needed = each().map(|[_, needed]| needed).fold(snapshot(configuration), f64::max);
    looked_at + at_start + kept + needed
}

/// Something that a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The rows of a table.
    Rows(Series),
    /// Pictures.
    Snapshots,
}

/// The part that takes most while it is made, and how much, bytes.
pub(super) fn largest(configuration: &Configuration) -> Option<(Part, u64)> {
    let taken = |series: Series| {
        let [kept, needed] = kept_and_needed(series, configuration);
        (Part::Rows(series), (kept + needed) as u64)
    };
    let snapshots = (Part::Snapshots, snapshot(configuration) as u64);
    Series::ALL.into_iter().map(taken).chain([snapshots]).max_by_key(|(_, bytes)| *bytes)
}

impl Part {
    /// What it is, in a sentence.
    pub(super) fn name(self) -> String {
        match self {
            Self::Rows(series) => format!("the rows of {}", series.name()),
            Self::Snapshots => "a snapshot".to_owned(),
        }
    }

    /// How it takes less.
    pub(super) fn remedy(self) -> String {
        match self {
            Self::Rows(Series::Minkowski) => "take a larger output.minkowski_spacing".to_owned(),
            Self::Rows(other) => format!("leave the table out by output.{} = 0", other.name()),
            Self::Snapshots => "leave the snapshots out by output.snapshots = 0".to_owned(),
        }
    }
}
