//! Progress of a run, and of what goes through frames or repeats steps: a bar on a terminal, a line now and then
//! elsewhere, nothing with `--quiet`.

use super::Reporter;
use crate::simulation::Simulation;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Time between looks at the clock's reading on a terminal.
pub(super) const REFRESH: Duration = Duration::from_millis(200);
/// Time between lines elsewhere.
pub(super) const LINE_INTERVAL: Duration = Duration::from_secs(30);

pub(super) struct Progress {
    begun: Instant,
    shown: Instant,
    first_step: u64,
    first_time: u64,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(super) fn new(simulation: &Simulation, reporter: &Reporter<'_>) -> Self {
        let clock = simulation.engine.clock();
        let bar = bar(Some(simulation.end()), reporter);
        let now = Instant::now();
        Self { begun: now, shown: now, first_step: clock.step, first_time: clock.time, bar }
    }

    /// Shows where the run is, if it is time to.
    pub(super) fn show(&mut self, simulation: &Simulation, reporter: &Reporter<'_>) {
        let interval = if self.bar.is_some() { REFRESH } else { LINE_INTERVAL };
        if self.shown.elapsed() < interval {
            return;
        }
        self.shown = Instant::now();
        let message = self.message(simulation);
        match &self.bar {
            Some(bar) => {
                bar.set_position(simulation.engine.clock().time);
                bar.set_message(message);
            }
            None => reporter.note(&message),
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn message(&self, simulation: &Simulation) -> String {
        let clock = simulation.engine.clock();
        let elapsed = self.begun.elapsed().as_secs_f64();
        let rate = (clock.step - self.first_step) as f64 / elapsed;
        let left = simulation.end().saturating_sub(clock.time) as f64;
        let eta = elapsed * left / (clock.time - self.first_time).max(1) as f64;
        let until = simulation.configuration.time.until;
        let time = match simulation.time_over_jeans() {
            Some(time) => format!("t = {time:.3} of {until} T"),
            None => {
                format!("t = {:.3} of {until} R0^2/D", meniscus_core::units::time_from_units(clock.time))
            }
        };
        format!("step {}, {time}, {rate:.0} steps/s, {} left", clock.step, duration(eta))
    }
}

/// Progress through things that are counted, the frames of a file or the steps that a run is to have.
pub(super) struct CountProgress {
    begun: Instant,
    shown: Instant,
    /// One of them.
    unit: &'static str,
    /// How many there were at the beginning.
    first: u64,
    /// How many there are in the end, if that is known.
    total: Option<u64>,
    bar: Option<ProgressBar>,
}

impl CountProgress {
    pub(super) fn new(unit: &'static str, first: u64, total: Option<u64>, reporter: &Reporter<'_>) -> Self {
        let now = Instant::now();
        Self { begun: now, shown: now, unit, first, total, bar: bar(total, reporter) }
    }

    /// Shows that `count` are done, if it is time to.
    pub(super) fn show(&mut self, count: u64, reporter: &Reporter<'_>) {
        let interval = if self.bar.is_some() { REFRESH } else { LINE_INTERVAL };
        if self.shown.elapsed() < interval {
            return;
        }
        self.shown = Instant::now();
        let (unit, rate) = (self.unit, (count - self.first) as f64 / self.begun.elapsed().as_secs_f64());
        let message = match self.total {
            Some(total) => {
                let left = total.saturating_sub(count) as f64 / rate;
                format!("{unit} {count} of {total}, {rate:.1} {unit}s/s, {} left", duration(left))
            }
            None => format!("{unit} {count}, {rate:.1} {unit}s/s"),
        };
        match &self.bar {
            Some(bar) => {
                bar.set_position(count);
                bar.set_message(message);
            }
            None => reporter.note(&message),
        }
    }

    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar of that length, or without one, if somebody looks at a terminal.
fn bar(length: Option<u64>, reporter: &Reporter<'_>) -> Option<ProgressBar> {
    if !(reporter.tells_notes() && std::io::stderr().is_terminal()) {
        return None;
    }
    let template = if length.is_some() { "{wide_bar} {msg}" } else { "{spinner} {msg}" };
    let style = ProgressStyle::with_template(template).unwrap_or(ProgressStyle::default_bar());
    let bar = length.map_or_else(ProgressBar::no_length, ProgressBar::new);
    Some(bar.with_style(style))
}

/// A duration as a person would say it.
pub(super) fn duration(seconds: f64) -> String {
    let minutes = seconds / 60.0;
    match minutes {
        _ if seconds < 100.0 => format!("{seconds:.0} s"),
        _ if minutes < 100.0 => format!("{minutes:.0} min"),
        _ => format!("{:.1} h", minutes / 60.0),
    }
}
