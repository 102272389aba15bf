//! Progress of a run: a bar on a terminal, a line now and then elsewhere, nothing with `--quiet`.

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
        let on_terminal = reporter.tells_notes() && std::io::stderr().is_terminal();
        let bar = on_terminal.then(|| {
            let style =
                ProgressStyle::with_template("{wide_bar} {msg}").unwrap_or(ProgressStyle::default_bar());
            ProgressBar::new(simulation.end()).with_style(style)
        });
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

/// A duration as a person would say it.
pub(super) fn duration(seconds: f64) -> String {
    let minutes = seconds / 60.0;
    match minutes {
        _ if seconds < 100.0 => format!("{seconds:.0} s"),
        _ if minutes < 100.0 => format!("{minutes:.0} min"),
        _ => format!("{:.1} h", minutes / 60.0),
    }
}
