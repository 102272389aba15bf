//! `meniscus analyze TRAJECTORY|DIR [--series NAME,…] [--out DIR] …`

use super::progress::CountProgress;
use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::configuration::{Configuration, Start};
use crate::files::atomic::AtomicFile;
use crate::files::trajectory::{Format, Recorded, TrajectoryReader};
use crate::files::{FileError, FormatError};
use crate::observables::series::{Grouping, Moment, Observer, Series, SeriesError, Settings};
use crate::start::{StartError, settle_strengths};
use clap::builder::PossibleValuesParser;
use meniscus_core::torus::Torus;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// What to read: .gsd, .xyz, .extxyz, .lammpstrj, .npz, .csv or .state, or the directory of a run for its trajectory.
    #[arg(value_name = "TRAJECTORY|DIR")]
    trajectory: PathBuf,
    /// Only these series. By default all for which enough is known.
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = names())]
    series: Vec<String>,
    /// Directory for the tables, none of which may exist. By default TRAJECTORY-analysis beside the trajectory.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Configuration of the run: attraction, Jeans' time, start. By default the config.toml beside the trajectory.
    #[arg(long, value_name = "CONFIG|PRESET")]
    configuration: Option<String>,
    /// Side of the box, R0, where the file does not have it.
    #[arg(long = "box", value_name = "L", allow_negative_numbers = true)]
    side: Option<f64>,
    /// minkowski: spacing of the grid of the density, R0.
    #[arg(long, value_name = "R0", allow_negative_numbers = true)]
    spacing: Option<f64>,
    /// minkowski: thresholds of the density, of that of closest packing.
    #[arg(long, value_name = "A,B,...", value_delimiter = ',', value_parser = threshold, allow_negative_numbers = true)]
    thresholds: Vec<f64>,
    /// modes: number of shells of wavenumbers.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    shells: Option<u32>,
    /// radii: width of shells by the distance from the middle of the box in the first frame, R0.
    #[arg(long, value_name = "R0", allow_negative_numbers = true)]
    width: Option<f64>,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let stop = StopSignal::catch()?;
    if let Some([below, above]) = arguments.thresholds.array_windows().find(|[below, above]| below >= above) {
        return Err(CommandError::Thresholds { below: *below, above: *above });
    }
    let (path, configuration) = arguments.source()?;
    let given = arguments.torus(&path, configuration.as_ref())?;
    let mut reader = TrajectoryReader::open(&path, given.as_ref())?;
    let mut next = reader.read_frame()?;
    let first = next.as_ref().ok_or_else(|| no_frame(&path))?;
    let torus = reader.torus().or(given).ok_or_else(|| FileError::Box { path: path.clone() })?;
    let configuration =
        configuration.map(|configuration| belonging(configuration, &path, &torus, first)).transpose()?;
    let jeans_time = configuration.as_ref().map(Configuration::jeans_time);

    let settings = arguments.settings(configuration.as_ref(), torus);
    let series = arguments.chosen(&settings);
    tell(&series, &settings, first, reporter);
    let initial = &first.state.positions;
    let observers = series
        .iter()
        .map(|&series| Observer::new(series, &settings, initial).map_err(refusal))
        .collect::<Result<Vec<_>, _>>()?;

    let directory = arguments.out.clone().unwrap_or_else(|| beside(&path));
    let mut tables = Tables::create(&directory, &series)?;
    let mut progress = CountProgress::new("frame", 0, reader.frames(), reporter);
    let mut frames = 0;
    while let Some(recorded) = next {
        let moment = moment(&recorded, jeans_time);
        let frame = recorded.frame(None);
        for (observer, file) in observers.iter().zip(&mut tables.files) {
            file.append(&observer.rows(&moment, &frame))?;
        }
        frames += 1;
        progress.show(frames, reporter);
        if stop.is_raised() {
            progress.finish();
            return Err(CommandError::Interrupted { path: directory });
        }
        next = reader.read_frame()?;
    }
    progress.finish();
    tables.finish()?;
    report(&directory, &series, frames, reporter)?;
    Ok(Verdict::Ok)
}

impl Arguments {
    /// The file to read, and the configuration that it is told by.
    fn source(&self) -> Result<(PathBuf, Option<Configuration>), CommandError> {
        let mut path = self.trajectory.clone();
        let of_run = path.is_dir();
        let beside = if of_run { path.join(CONFIGURATION) } else { path.with_file_name(CONFIGURATION) };
        let configuration = match &self.configuration {
            Some(name) => Some(Configuration::from_argument(name, &[])?),
            None if beside.exists() => Some(Configuration::read(&beside, &[])?),
            None if of_run => return Err(CommandError::NoRun(path)),
            None => None,
        };
        if let (true, Some(configuration)) = (of_run, &configuration) {
            path.push(configuration.output.trajectory_format.file_name());
        }
        Ok((path, configuration))
    }

    /// The box, unless it is to be read from the file.
    fn torus(
        &self,
        path: &Path,
        configuration: Option<&Configuration>,
    ) -> Result<Option<Torus>, CommandError> {
        if let Some(side) = self.side {
            return Torus::new(side).map(Some).map_err(|_| CommandError::Side { side });
        }
        if Format::of_path(path).is_some() {
            return Ok(None);
        }
        Ok(configuration.map(crate::simulation::torus).transpose()?)
    }

    fn settings(&self, configuration: Option<&Configuration>, torus: Torus) -> Settings {
        let mut settings = configuration
            .map_or_else(|| Settings::of_box(torus), |configuration| Settings::of(configuration, torus));
        if let Some(spacing) = self.spacing {
            settings.minkowski_spacing = spacing;
        }
        if !self.thresholds.is_empty() {
            settings.minkowski_thresholds.clone_from(&self.thresholds);
        }
        if let Some(shells) = self.shells {
            settings.modes_shells = shells;
        }
        if let Some(width) = self.width {
            settings.groups = Some(Grouping::Shells { width });
        }
        settings
    }

    /// The series asked for, each once, or all that `settings` do for.
    fn chosen(&self, settings: &Settings) -> Vec<Series> {
        let is_chosen = |series: &Series| {
            if self.series.is_empty() {
                *series != Series::Radii || settings.groups.is_some()
            } else {
                self.series.iter().any(|name| name == series.name())
            }
        };
        Series::ALL.into_iter().filter(is_chosen).collect()
    }
}

/// Name of the configuration in a run's directory.
const CONFIGURATION: &str = "config.toml";

/// The configuration with the strengths of its discs, once it is sure that the discs in the file at `path` are those of
/// a run of it.
fn belonging(
    mut configuration: Configuration,
    path: &Path,
    torus: &Torus,
    first: &Recorded,
) -> Result<Configuration, CommandError> {
    let other = |key: &'static str, found: f64, configured: f64| CommandError::OtherSystem {
        path: path.to_owned(),
        key,
        found,
        configured,
    };
    let (found, system) = (first.state.positions.len(), &configuration.system);
    if torus.side() != system.side {
        return Err(other("box", torus.side(), system.side));
    }
    if found != system.particles {
        return Err(other("particles", found as f64, system.particles as f64));
    }
    if let (Some(strengths), Start::File { .. }) = (&first.state.strengths, &configuration.start) {
        let settled = settle_strengths(configuration.strengths, strengths.clone(), path);
        configuration.strengths =
            settled.map_err(|error: StartError| CommandError::Simulation(error.into()))?;
    }
    Ok(configuration)
}

/// When a frame was: Jeans' time being that of a configuration, if there is one, or else what the file tells.
fn moment(recorded: &Recorded, jeans_time: Option<Option<f64>>) -> Moment {
    let state = &recorded.state;
    // Formats without times have zeros.
    if state.time == 0 && state.step > 0 {
        return Moment { step: state.step, ..Moment::default() };
    }
    match jeans_time {
        Some(jeans_time) => Moment::new(state.step, state.time, jeans_time),
        None => {
            Moment { time_over_jeans: recorded.time_over_jeans, ..Moment::new(state.step, state.time, None) }
        }
    }
}

/// Tells what the tables will lack.
fn tell(series: &[Series], settings: &Settings, first: &Recorded, reporter: &Reporter<'_>) {
    if settings.system.is_none() && series.contains(&Series::Observables) {
        reporter.note(
            "observables: energies stay empty, since the attraction is not known; give it by --configuration FILE",
        );
    }
    let compared: Vec<&str> =
        series.iter().filter(|series| series.compares_with_start()).map(|series| series.name()).collect();
    let step = first.state.step;
    if step > 0 && !compared.is_empty() {
        reporter.note(&format!("{}: compared with the first frame, step {step}", compared.join(", ")));
    }
}

/// Why a series cannot be made, in terms of the command line.
fn refusal(error: SeriesError) -> CommandError {
    match error {
        SeriesError::Groups => CommandError::Groups,
        other => CommandError::Series(other),
    }
}

/// Where tables go unless somebody says.
fn beside(path: &Path) -> PathBuf {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{stem}-analysis"))
}

/// Tables that are made: they get their names when all are whole.
struct Tables {
    files: Vec<AtomicFile>,
    /// The directory if it was made for them; it goes with them if they come to nothing.
    made: Option<PathBuf>,
}

impl Tables {
    fn create(directory: &Path, series: &[Series]) -> Result<Self, CommandError> {
        let made = !directory.exists();
        std::fs::create_dir_all(directory)
            .map_err(|problem| FileError::Write { path: directory.to_owned(), problem })?;
        let mut tables = Self { files: Vec::new(), made: made.then(|| directory.to_owned()) };
        for series in series {
            let path = directory.join(series.file_name());
            if path.exists() {
                return Err(CommandError::Exists { path, another: "another directory by --out" });
            }
            let mut file = AtomicFile::create(&path)?;
            file.append(&format!("{}\n", series.header()))?;
            tables.files.push(file);
        }
        Ok(tables)
    }

    fn finish(mut self) -> Result<(), FileError> {
        self.made = None;
        std::mem::take(&mut self.files).into_iter().try_for_each(AtomicFile::finish)
    }
}

impl Drop for Tables {
    fn drop(&mut self) {
        self.files.clear();
        if let Some(directory) = &self.made {
            // What somebody else has put there meanwhile keeps it.
            let _ = std::fs::remove_dir(directory);
        }
    }
}

fn report(
    directory: &Path,
    series: &[Series],
    frames: u64,
    reporter: &mut Reporter<'_>,
) -> std::io::Result<()> {
    for series in series {
        let path = directory.join(series.file_name());
        reporter.text(&format!(
            "{}: {frames} frame{}\n",
            path.display(),
            if frames == 1 { "" } else { "s" }
        ))?;
    }
    reporter.json(|| {
        let names: Vec<&str> = series.iter().map(|series| series.name()).collect();
        serde_json::json!({ "directory": directory.display().to_string(), "series": names, "frames": frames })
    })
}

fn no_frame(path: &Path) -> FileError {
    let problem = FormatError::Whole { found: "no frame".to_owned(), expected: "at least 1".to_owned() };
    FileError::Read { path: path.to_owned(), problem }
}

fn names() -> PossibleValuesParser {
    Series::ALL.map(Series::name).into()
}

fn threshold(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|threshold: &f64| threshold.is_finite() && *threshold > 0.0)
        .ok_or_else(|| "expected a number above 0".into())
}
