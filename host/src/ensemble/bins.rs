//! Which rows of several runs belong together: those of the same multiple of an interval.

use crate::configuration::Output;
use crate::observables::series::Series;
use crate::run::Schedule;
use crate::simulation::time_units;

/// Due times k·interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    /// R0²/D.
    interval: f64,
}

impl Bins {
    /// The bins of a run's table; None if it has no rows. Intervals count in `time_unit`, R0²/D.
    pub(crate) fn of(series: Series, output: &Output, time_unit: f64) -> Option<Self> {
        let interval = output.interval(series);
        (interval > 0.0).then_some(Self { interval: interval * time_unit })
    }

    /// The last k that was due at `time` (R0²/D): that of a row written then, which is the row of the first step at or
    /// after the due time.
    pub(crate) fn last_due(self, time: f64) -> u64 {
        let mut schedule = Schedule::new(self.interval, 0);
        schedule.is_due(time_units(time));
        schedule.last_due()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meniscus_core::units::time_from_units;

    #[test]
    fn a_row_belongs_to_the_first_step_at_or_after_its_due_time() {
        let bins = Bins { interval: 0.25 };
        let times = [0.0, 0.2499, 0.25, 0.26, 0.4999, 0.5, 1.1];
        assert_eq!(times.map(|time| bins.last_due(time)), [0, 0, 1, 1, 1, 2, 4]);
    }

    /// Third parts are no binary fractions: what is written must not fall short of what was due.
    #[test]
    fn due_times_are_met_to_the_bit() {
        let bins = Bins { interval: 17.882_510_413_579 / 300.0 };
        for k in 0..10_000 {
            let due = time_units(k as f64 * bins.interval);
            assert_eq!(bins.last_due(time_from_units(due)), k);
            if due > 0 {
                assert_eq!(bins.last_due(time_from_units(due - 1)), k - 1);
            }
        }
    }
}
