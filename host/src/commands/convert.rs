//! `meniscus convert A B [--box L] [--frame K]`

use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::configuration::Configuration;
use crate::files::trajectory::{Format, Recorded, Trajectory, TrajectoryReader};
use crate::files::{FileError, FormatError, csv};
use crate::observables::clusters::Clusters;
use meniscus_core::torus::Torus;
use std::path::{Path, PathBuf};

/// Discs in the frames that are held in memory, roughly: an archive is written anew for so many at a time.
const DISCS_AT_A_TIME: usize = 1 << 22;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// What to read: .gsd, .xyz, .extxyz, .lammpstrj, .npz, .csv or .state.
    #[arg(value_name = "A")]
    from: PathBuf,
    /// The file to make, of the same endings. Of several frames .csv and .state take the last.
    #[arg(value_name = "B")]
    to: PathBuf,
    /// Side of the box, R0. Without it, that in the file A, or else that of the config.toml beside it.
    #[arg(long = "box", value_name = "L")]
    side: Option<f64>,
    /// Take only the frame of this number, from 0.
    #[arg(long, value_name = "K")]
    frame: Option<u64>,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let Arguments { from, to, side, frame } = arguments;
    let target = Target::of_path(to)?;
    if to.exists() {
        return Err(CommandError::Exists { path: to.clone(), another: "another file" });
    }
    let has_times = Format::of_path(from) != Some(Format::LammpsDump);
    if !has_times && !matches!(target, Target::Csv | Target::Trajectory(Format::LammpsDump)) {
        reporter.note(&format!(
            "{} has no times: that of every frame is 0 in {}",
            from.display(),
            to.display()
        ));
    }
    let torus = box_given(from, *side)?;
    let mut frames =
        Frames { reader: TrajectoryReader::open(from, torus.as_ref())?, from, only: *frame, read: 0 };
    let written = match target {
        Target::Trajectory(format) => write_trajectory(&mut frames, to, format)?,
        Target::Csv | Target::State => {
            let mut last = None;
            while let Some(frame) = frames.next()? {
                last = Some(frame);
            }
            let Recorded { state, .. } = last.ok_or_else(|| frames.missing())?;
            if let Target::Csv = target {
                let strengths = state.strengths.as_deref().unwrap_or_default();
                csv::write(to, &frames.torus()?, &state.positions, strengths)?;
            } else {
                state.write(to)?;
            }
            1
        }
    };
    reporter.text(&format!("{}: {written} frame{}\n", to.display(), if written == 1 { "" } else { "s" }))?;
    reporter.json(|| serde_json::json!({ "file": to.display().to_string(), "frames": written }))?;
    Ok(Verdict::Ok)
}

/// What to make.
#[derive(Clone, Copy)]
enum Target {
    Trajectory(Format),
    Csv,
    State,
}

impl Target {
    fn of_path(path: &Path) -> Result<Self, FileError> {
        match (Format::of_path(path), path.extension().and_then(|ending| ending.to_str())) {
            (Some(format), _) => Ok(Self::Trajectory(format)),
            (None, Some("csv")) => Ok(Self::Csv),
            (None, Some("state")) => Ok(Self::State),
            (None, _) => Err(FileError::Ending { path: path.to_owned() }),
        }
    }
}

/// The box, unless it is to be read from the file: that of the command line, or for files that have none that of the
/// configuration beside the file.
fn box_given(from: &Path, side: Option<f64>) -> Result<Option<Torus>, CommandError> {
    if let Some(side) = side {
        return Torus::new(side).map(Some).map_err(|_| CommandError::Side { side });
    }
    let beside = from.with_file_name("config.toml");
    if Format::of_path(from).is_some() || !beside.exists() {
        return Ok(None);
    }
    let configuration = Configuration::from_argument(&beside.to_string_lossy(), &[])?;
    Ok(Some(crate::simulation::torus(&configuration)?))
}

/// The frames to be converted.
struct Frames<'a> {
    reader: TrajectoryReader,
    from: &'a Path,
    only: Option<u64>,
    read: u64,
}

impl Frames<'_> {
    /// The next frame that is wanted.
    fn next(&mut self) -> Result<Option<Recorded>, FileError> {
        while let Some(frame) = self.reader.read_frame()? {
            self.read += 1;
            if self.only.is_none_or(|only| self.read - 1 == only) {
                return Ok(Some(frame));
            }
        }
        Ok(None)
    }

    /// The box, which is known when a frame has been read.
    fn torus(&self) -> Result<Torus, FileError> {
        self.reader.torus().ok_or_else(|| FileError::Box { path: self.from.to_owned() })
    }

    fn missing(&self) -> FileError {
        let expected = self.only.map_or("at least 1".to_owned(), |only| format!("more than {only}"));
        let problem = FormatError::Whole { found: format!("{} frames", self.read), expected };
        FileError::Read { path: self.from.to_owned(), problem }
    }
}

/// Writes the frames to a new file; how many.
fn write_trajectory(frames: &mut Frames<'_>, to: &Path, format: Format) -> Result<u64, CommandError> {
    let next = frames.next()?;
    if next.is_none() {
        return Err(frames.missing().into());
    }
    let torus = frames.torus()?;
    let stop = StopSignal::catch()?;
    let trajectory = Trajectory::create(to, format, &torus)?;
    let written = match append_frames(frames, next, &torus, trajectory, &stop) {
        Ok(Some(written)) => Ok(written),
        Ok(None) => Err(CommandError::Interrupted { path: to.to_owned() }),
        Err(error) => Err(error.into()),
    };
    if written.is_err() {
        // Half a trajectory is of no use, and there is nothing to be done if it cannot be removed.
        let _ = std::fs::remove_file(to);
    }
    written
}

/// How many frames there are when all are on the disk; None if somebody stopped it.
fn append_frames(
    frames: &mut Frames<'_>,
    mut next: Option<Recorded>,
    torus: &Torus,
    mut trajectory: Trajectory,
    stop: &StopSignal,
) -> Result<Option<u64>, FileError> {
    while next.is_some() {
        let (mut batch, mut discs) = (Vec::new(), 0);
        while discs < DISCS_AT_A_TIME
            && let Some(frame) = next
        {
            discs += frame.state.positions.len().max(1);
            let clusters = Clusters::find(torus, &frame.state.positions);
            batch.push((frame, clusters));
            if stop.is_raised() {
                return Ok(None);
            }
            next = frames.next()?;
        }
        let batch: Vec<_> = batch.iter().map(|(frame, clusters)| frame.frame(Some(clusters))).collect();
        trajectory.append_all(&batch)?;
    }
    Ok(Some(trajectory.sync()?.frames))
}
