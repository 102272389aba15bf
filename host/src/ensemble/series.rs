//! The tables that runs write at their own cadence, as gathering needs to know them.

use crate::configuration::{Configuration, Output};
use crate::run::Schedule;
use crate::simulation::time_units;

/// A table that runs write.
pub(super) struct Series {
    /// Name of the file, in a run's directory and in that of an ensemble.
    pub file: &'static str,
    /// Columns that tell the rows of one time from each other.
    pub keys: &'static [&'static str],
    /// Interval of its rows, in the unit of `time.until`; 0 for none.
    pub interval: fn(&Output) -> f64,
}

/// All of them.
pub(super) const SERIES: &[Series] =
    &[Series { file: "observables.csv", keys: &[], interval: |output| output.observables }];

/// The columns that every table begins with.
pub(super) const FIRST_COLUMNS: [&str; 3] = ["step", "time", "time_over_jeans"];

/// Due times k·interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bins {
    /// R0²/D.
    interval: f64,
}

impl Bins {
    /// The bins of a run's table; None if it has none.
    pub(super) fn of(series: &Series, configuration: &Configuration) -> Option<Self> {
        let interval = (series.interval)(&configuration.output);
        (interval > 0.0).then(|| Self { interval: interval * configuration.time_scale() })
    }

    /// The last k that was due at `time` (R0²/D): that of a row written then, which is the row of the first step at or
    /// after the due time.
    pub(super) fn last_due(self, time: f64) -> u64 {
        let mut schedule = Schedule::new(self.interval, 0);
        schedule.is_due(time_units(time));
        schedule.last_due()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_belongs_to_the_first_step_at_or_after_its_due_time() {
        let bins = Bins { interval: 0.25 };
        let times = [0.0, 0.2499, 0.25, 0.26, 0.4999, 0.5, 1.1];
        assert_eq!(times.map(|time| bins.last_due(time)), [0, 0, 1, 1, 1, 2, 4]);
    }

    /// Third parts are no binary fractions: what is written must not fall short of what was due.
    #[test]
    fn due_times_are_met_to_the_bit() {
        let interval = 17.882_510_413_579_f64 / 300.0;
        for k in 0..10_000_u64 {
            let due = time_units(k as f64 * interval);
            let bins = Bins { interval };
            assert_eq!(bins.last_due(meniscus_core::units::time_from_units(due)), k);
            if due > 0 {
                assert_eq!(bins.last_due(meniscus_core::units::time_from_units(due - 1)), k - 1);
            }
        }
    }
}
