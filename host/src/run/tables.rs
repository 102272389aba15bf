//! The tables that grow in a run's directory, each at its own cadence: `observables.csv` and the other series that the
//! configuration asks for.

use super::growing::Growing;
use super::progress::Table;
use super::{RunError, Schedule};
use crate::files::trajectory::Frame;
use crate::observables::series::{Moment, Observer, Series, Settings};
use crate::simulation::Simulation;
use meniscus_core::torus::Position;
use std::collections::BTreeMap;
use std::path::Path;

/// All tables of a run.
#[derive(Debug)]
pub(super) struct Tables(Vec<Entry>);

#[derive(Debug)]
struct Entry {
    series: Series,
    schedule: Schedule,
    /// None if nothing is ever due.
    observer: Option<Observer>,
    file: Growing,
    /// Whether the present state is to have rows.
    is_due: bool,
}

/// Which series are in a run's directory: `observables.csv` is there without rows too.
fn series_of(simulation: &Simulation) -> impl Iterator<Item = Series> {
    let output = &simulation.configuration.output;
    Series::ALL.into_iter().filter(|&series| series == Series::Observables || output.interval(series) > 0.0)
}

/// Whether a run's tables compare states with where the discs were when it began.
pub(super) fn compare_with_start(simulation: &Simulation) -> bool {
    series_of(simulation).any(Series::compares_with_start)
}

impl Tables {
    /// Makes the files in `directory`, of a run that begins with the discs at `initial`.
    pub(super) fn create(
        directory: &Path,
        simulation: &Simulation,
        initial: &[Position],
    ) -> Result<Self, RunError> {
        let now = simulation.engine.clock().time;
        let entry = |series: Series| -> Result<Entry, RunError> {
            let observer = observer(series, simulation, initial)?;
            let mut file = Growing::create(&directory.join(series.file_name()))?;
            file.append(&format!("{}\n", series.header()))?;
            let schedule = Schedule::new(interval(series, simulation), now);
            Ok(Entry { series, schedule, observer, file, is_due: false })
        };
        series_of(simulation).map(entry).collect::<Result<_, _>>().map(Self)
    }

    /// Opens the files in `directory` to go on where `progress` says that they had come; what they have beyond that is for
    /// [`Tables::cut`] to drop.
    pub(super) fn open(
        directory: &Path,
        simulation: &Simulation,
        initial: &[Position],
        progress: &BTreeMap<String, Table>,
    ) -> Result<Self, RunError> {
        let entry = |series: Series| -> Result<Entry, RunError> {
            let path = directory.join(series.file_name());
            let Some(&Table { next, bytes }) = progress.get(series.name()) else {
                return Err(RunError::NoTable { directory: directory.to_owned(), series: series.name() });
            };
            if !path.exists() {
                return Err(RunError::Gone(path));
            }
            let schedule = Schedule::resumed(interval(series, simulation), next);
            let observer = observer(series, simulation, initial)?;
            Ok(Entry { series, schedule, observer, file: Growing::open(&path, bytes)?, is_due: false })
        };
        series_of(simulation).map(entry).collect::<Result<_, _>>().map(Self)
    }

    /// Drops what the files have beyond the lengths that they were opened with.
    pub(super) fn cut(&mut self) -> Result<(), RunError> {
        self.0.iter_mut().try_for_each(|entry| entry.file.cut())
    }

    /// Notes what is due at time `now` (unit 2⁻⁴⁰ R0²/D): whether `observables.csv` is, and whether anything is.
    pub(super) fn note_due(&mut self, now: u64) -> [bool; 2] {
        let mut due = [false; 2];
        for entry in &mut self.0 {
            entry.is_due = entry.schedule.is_due(now);
            due[0] |= entry.is_due && entry.series == Series::Observables;
            due[1] |= entry.is_due;
        }
        due
    }

    /// Writes the rows that are due.
    pub(super) fn write(&mut self, moment: &Moment, frame: &Frame<'_>) -> Result<(), RunError> {
        for entry in self.0.iter_mut().filter(|entry| entry.is_due) {
            if let Some(observer) = &entry.observer {
                entry.file.append(&observer.rows(moment, frame))?;
            }
        }
        Ok(())
    }

    /// Waits until the files are on the disk; tells how far they have come.
    pub(super) fn sync(&mut self) -> Result<BTreeMap<String, Table>, RunError> {
        let told = |entry: &mut Entry| {
            let table = Table { next: entry.schedule.next_due(), bytes: entry.file.sync()? };
            Ok((entry.series.name().to_owned(), table))
        };
        self.0.iter_mut().map(told).collect()
    }
}

/// What makes the rows, if any ever will be.
fn observer(
    series: Series,
    simulation: &Simulation,
    initial: &[Position],
) -> Result<Option<Observer>, RunError> {
    let configuration = &simulation.configuration;
    if configuration.output.interval(series) == 0.0 {
        return Ok(None);
    }
    Ok(Some(Observer::new(series, &Settings::of(configuration, simulation.torus), initial)?))
}

/// Interval of a series, R0²/D.
fn interval(series: Series, simulation: &Simulation) -> f64 {
    let configuration = &simulation.configuration;
    configuration.output.interval(series) * configuration.time_scale()
}
