//! Progress of an ensemble: a bar for each member at work on a terminal, a line now and then elsewhere, nothing with
//! `--quiet`.

use super::Reporter;
use super::progress::{LINE_INTERVAL, REFRESH, duration};
use super::reporter::say;
use crate::ensemble::{Fate, Limited, Member, Observer};
use crate::simulation::Simulation;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

pub(super) struct Members {
    /// How many are to be looked at.
    count: usize,
    begun: Instant,
    tells_notes: bool,
    bars: Option<Bars>,
    state: Mutex<State>,
}

struct Bars {
    all: MultiProgress,
    /// Of all members.
    total: ProgressBar,
    of_member: ProgressStyle,
}

struct State {
    /// Had finished before.
    kept: usize,
    /// Nothing more is done for them, since this program began.
    ended: usize,
    shown: Instant,
    running: BTreeMap<usize, Running>,
}

/// A member at work.
struct Running {
    bar: Option<ProgressBar>,
    shown: Instant,
    /// Time at which it began or went on, and that it has reached, in parts of its whole.
    first: f64,
    part: f64,
}

impl Members {
    pub(super) fn new(count: usize, reporter: &Reporter<'_>) -> Self {
        let on_terminal = reporter.tells_notes() && std::io::stderr().is_terminal();
        let style = |template: &str| {
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
        };
        let bars = on_terminal.then(|| {
            let all = MultiProgress::new();
            let total = all.add(ProgressBar::new(count as u64).with_style(style("{wide_bar} {msg}")));
            Bars { all, total, of_member: style("{bar:20} {wide_msg}") }
        });
        let now = Instant::now();
        let state = State { kept: 0, ended: 0, shown: now, running: BTreeMap::new() };
        Self { count, begun: now, tells_notes: reporter.tells_notes(), bars, state: Mutex::new(state) }
    }

    /// Takes the bars away.
    pub(super) fn finish(&self) {
        if let Some(bars) = &self.bars {
            bars.total.finish_and_clear();
            let _ = bars.all.clear();
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A line for whoever wants to know how it goes, above the bars.
    fn note(&self, line: &str) {
        match &self.bars {
            Some(bars) => bars.all.suspend(|| say(line)),
            None if self.tells_notes => say(line),
            None => {}
        }
    }

    /// Shows how far all of them are, if it is time to.
    fn show(&self, state: &mut State) {
        let interval = if self.bars.is_some() { REFRESH } else { LINE_INTERVAL };
        if state.shown.elapsed() < interval {
            return;
        }
        state.shown = Instant::now();
        let message = self.message(state);
        match &self.bars {
            Some(bars) => {
                bars.total.set_position((state.kept + state.ended) as u64);
                bars.total.set_message(message);
            }
            None => self.note(&message),
        }
    }

    fn message(&self, state: &State) -> String {
        let (done, running) = (state.kept + state.ended, state.running.len());
        let under_way = |part: fn(&Running) -> f64| state.running.values().map(part).sum::<f64>();
        // In members, as if all were alike.
        let work = state.ended as f64 + under_way(|running| running.part - running.first);
        let left = self.count.saturating_sub(done) as f64 - under_way(|running| running.part);
        let left = match self.begun.elapsed().as_secs_f64() * left / work {
            seconds if seconds.is_finite() => format!(", {} left", duration(seconds.max(0.0))),
            _ => String::new(),
        };
        format!("{done} of {} members done, {running} at work{left}", self.count)
    }
}

impl Observer for Members {
    fn limited(&self, limited: &Limited) {
        let Limited { side_by_side, workers, available } = limited;
        if let Some((bytes, limit)) = available {
            let gigabytes = *bytes as f64 / 1e9;
            self.note(&format!(
                "memory: {gigabytes:.1} GB can be had ({limit}), too little for {workers} of these runs at a time: {side_by_side}"
            ));
        }
    }

    fn began(&self, member: &Member, simulation: &Simulation) {
        let now = Instant::now();
        let part = part(simulation);
        let bar = self.bars.as_ref().map(|bars| {
            let bar = ProgressBar::new(simulation.end()).with_style(bars.of_member.clone());
            bars.all.insert_before(&bars.total, bar)
        });
        if let Some(bar) = &bar {
            bar.set_message(format!("member {} ({})", member.index, member.label()));
        }
        self.state().running.insert(member.index, Running { bar, shown: now, first: part, part });
    }

    fn stepped(&self, member: &Member, simulation: &Simulation) {
        if !self.tells_notes {
            return;
        }
        let mut state = self.state();
        if let Some(running) = state.running.get_mut(&member.index)
            && running.shown.elapsed() >= REFRESH
        {
            running.shown = Instant::now();
            running.part = part(simulation);
            if let Some(bar) = &running.bar {
                bar.set_position(simulation.engine.clock().time);
            }
        }
        self.show(&mut state);
    }

    fn warned(&self, member: &Member, line: &str) {
        self.note(&format!("member {}: {line}", member.index));
    }

    fn ended(&self, member: &Member, fate: &Fate) {
        if let Fate::Failed(error) = fate {
            self.note(&format!("member {} ({}) failed: {error}", member.index, member.label()));
        }
        let mut state = self.state();
        if let Some(Running { bar: Some(bar), .. }) = state.running.remove(&member.index) {
            bar.finish_and_clear();
        }
        match fate {
            Fate::Kept => state.kept += 1,
            _ => state.ended += 1,
        }
        self.show(&mut state);
    }
}

/// How much of a run is done, 0 to 1.
fn part(simulation: &Simulation) -> f64 {
    (simulation.engine.clock().time as f64 / simulation.end().max(1) as f64).min(1.0)
}
