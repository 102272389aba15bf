//! A row of `observables.csv`.

use crate::observables::clusters::Clusters;
use crate::observables::energy::Energies;
use meniscus_core::dynamics::Clock;
use meniscus_core::units::{force_from_units, time_from_units};

/// A row, apart from the clusters.
pub(super) struct Row {
    pub clock: Clock,
    pub time_over_jeans: Option<f64>,
    /// Length of the next step (unit 2⁻⁴⁰ R0²/D) and the largest force in this state (unit 2⁻²⁴ kBT/R0).
    pub next_step: Option<(u64, u64)>,
    pub energies: Energies,
}

impl Row {
    /// Names of the columns, those of the clusters included.
    pub(super) const HEADER: &str = "step,time,time_over_jeans,dt,max_force,clusters,mean_cluster_size,\
                                     mass_weighted_cluster_size,largest_cluster,capillary_energy,repulsive_energy";

    pub(super) fn format(&self, clusters: &Clusters) -> String {
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        format!(
            "{},{},{},{},{},{},{},{},{},{},{}",
            self.clock.step,
            time_from_units(self.clock.time),
            cell(self.time_over_jeans),
            cell(self.next_step.map(|(length, _)| time_from_units(length))),
            cell(self.next_step.map(|(_, force)| largest_force(force))),
            clusters.count(),
            clusters.number_average(),
            clusters.mass_average(),
            clusters.largest(),
            self.energies.capillary,
            self.energies.repulsive,
        )
    }
}

/// A largest force of unit 2⁻²⁴ kBT/R0 in kBT/R0.
pub(super) fn largest_force(units: u64) -> f64 {
    force_from_units(i64::try_from(units).unwrap_or(i64::MAX))
}
