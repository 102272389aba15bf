//! When something is due: at multiples of an interval, each belonging to the first step at or after it.

use crate::simulation::time_units;
use meniscus_core::units::time_from_units;

/// Due times k·interval, k = 0, 1, 2, … A step that passes several serves them all at once.
///
/// ```
/// use meniscus::run::Schedule;
/// use meniscus_core::units::TIME_UNITS;
///
/// let mut schedule = Schedule::new(0.5, 0);
/// assert!(schedule.is_due(0));
/// assert!(!schedule.is_due(TIME_UNITS / 3));
/// assert!(schedule.is_due(TIME_UNITS / 2 + 1));
/// ```
#[derive(Clone, Debug)]
pub struct Schedule {
    /// R0²/D; 0 for never.
    interval: f64,
    next: u64,
}

impl Schedule {
    /// A schedule of the given interval (R0²/D; 0 for never) as seen at time `now` (unit 2⁻⁴⁰ R0²/D): what was due
    /// before is past.
    #[must_use]
    pub fn new(interval: f64, now: u64) -> Self {
        // A shorter interval than the unit of time is due at every unit.
        let interval = if interval > 0.0 { interval.max(time_from_units(1)) } else { 0.0 };
        let mut schedule = Self { interval, next: 0 };
        if interval > 0.0 && now > 0 {
            schedule.pass(now - 1);
        }
        schedule
    }

    /// A schedule that goes on with its `next` due time, as [`Schedule::next_due`] told it.
    #[must_use]
    pub fn resumed(interval: f64, next: u64) -> Self {
        Self { next, ..Self::new(interval, 0) }
    }

    /// The number k of the next due time.
    #[must_use]
    pub fn next_due(&self) -> u64 {
        self.next
    }

    /// Whether something is due at time `now` (unit 2⁻⁴⁰ R0²/D) that was not before.
    pub fn is_due(&mut self, now: u64) -> bool {
        let due = self.interval > 0.0 && self.due_time() <= now;
        if due {
            self.pass(now);
        }
        due
    }

    /// The number k of the due time served last.
    #[must_use]
    pub fn last_due(&self) -> u64 {
        self.next.saturating_sub(1)
    }

    fn due_time(&self) -> u64 {
        time_units(self.next as f64 * self.interval)
    }

    /// Counts all due times up to `now` as served.
    fn pass(&mut self, now: u64) {
        let intervals = time_from_units(now) / self.interval;
        self.next = self.next.max(intervals as u64);
        while self.due_time() <= now {
            self.next += 1;
        }
    }
}
