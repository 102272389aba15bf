//! Trajectories as NumPy's archives of arrays: `numpy.load("trajectory.npz")["positions"]`.
//!
//! With F frames of N discs in the order of their ids:
//!
//! | Array | Numbers | What |
//! |---|---|---|
//! | `box` | f64 | L, R0 |
//! | `step` | u64, F | steps made |
//! | `time`, `dt` | f64, F | time, and length of the next step, R0²/D |
//! | `time_units` | u64, F | time exactly, unit 2⁻⁴⁰ R0²/D |
//! | `time_over_jeans` | f64, F | time in Jeans' times; NaN where there is none |
//! | `max_force` | f64, F | largest force, kBT/R0; NaN if not known |
//! | `clusters` | i32, F | number of clusters n_c; −1 if not known |
//! | `positions` | f64, F × N × 2 | x and y in R0, in [0, L) |
//! | `position_bits` | u32, F × N × 2 | the same exactly, unit L·2⁻³² |
//! | `images` | i32, F × N × 2 | how often a disc went around the box |
//! | `strengths` | f64, F × N | capillary strengths |
//!
//! A frame is somewhere in the midst of such a file, so each one appended writes the file anew, whole or not at all:
//! good for short trajectories. Read are files of this program.
//!
//! ```
//! use meniscus::files::trajectory::{Format, Frame, Trajectory, TrajectoryReader};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("trajectory.npz");
//! let torus = Torus::new(33.3).unwrap();
//! let positions = [Position::from_bits(1, u32::MAX)];
//! let mut trajectory = Trajectory::create(&path, Format::Npz, &torus).unwrap();
//! trajectory.append(&Frame { step: 7, positions: &positions, ..Frame::default() }).unwrap();
//!
//! let frame = TrajectoryReader::open(&path, None).unwrap().read_last().unwrap().unwrap();
//! assert_eq!((frame.state.step, frame.state.positions), (7, positions.to_vec()));
//! ```

use super::atomic::{take_place, temporary_beside};
use super::error::quoted;
use super::state::State;
use super::trajectory::{Extent, Frame, Recorded};
use super::{FileError, FormatError};
use crate::strengths::{self, ONE};
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::time_from_units;
use std::fs::File;
use std::io::{BufReader, BufWriter, Error, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// What stands before the header of an array: NumPy's magic bytes and the version of the format.
const MAGIC: &[u8; 8] = b"\x93NUMPY\x01\x00";

/// The data of an array begin at a multiple of so many bytes.
const ALIGNMENT: usize = 64;

/// How many numbers an array has.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    /// One.
    One,
    /// One a frame.
    Frames,
    /// So many a disc and frame.
    Discs(u64),
}

/// An array: its name, NumPy's word for the numbers, their length in bytes, and how many there are.
struct Array {
    name: &'static str,
    kind: &'static str,
    length: u64,
    shape: Shape,
}

const fn array(name: &'static str, kind: &'static str, length: u64, shape: Shape) -> Array {
    Array { name, kind, length, shape }
}

const BOX: Array = array("box", "<f8", 8, Shape::One);
const STEP: Array = array("step", "<u8", 8, Shape::Frames);
const TIME: Array = array("time", "<f8", 8, Shape::Frames);
const TIME_STEP: Array = array("dt", "<f8", 8, Shape::Frames);
const EXACT_TIME: Array = array("time_units", "<u8", 8, Shape::Frames);
const TIME_OVER_JEANS: Array = array("time_over_jeans", "<f8", 8, Shape::Frames);
const LARGEST_FORCE: Array = array("max_force", "<f8", 8, Shape::Frames);
const CLUSTERS: Array = array("clusters", "<i4", 4, Shape::Frames);
const POSITIONS: Array = array("positions", "<f8", 8, Shape::Discs(2));
const EXACT_POSITIONS: Array = array("position_bits", "<u4", 4, Shape::Discs(2));
const IMAGES: Array = array("images", "<i4", 4, Shape::Discs(2));
const STRENGTHS: Array = array("strengths", "<f8", 8, Shape::Discs(1));

/// All arrays in the order in which they are in the file.
const ARRAYS: [&Array; 12] = [
    &BOX,
    &STEP,
    &TIME,
    &TIME_STEP,
    &EXACT_TIME,
    &TIME_OVER_JEANS,
    &LARGEST_FORCE,
    &CLUSTERS,
    &POSITIONS,
    &EXACT_POSITIONS,
    &IMAGES,
    &STRENGTHS,
];

impl Array {
    fn file_name(&self) -> String {
        format!("{}.npy", self.name)
    }

    /// Bytes of a frame of `count` discs.
    fn bytes_of_frame(&self, count: u64) -> u64 {
        match self.shape {
            Shape::One | Shape::Frames => self.length,
            Shape::Discs(numbers) => self.length * numbers * count,
        }
    }

    /// Bytes before the data, NumPy's description of the array.
    fn header(&self, frames: u64, count: u64) -> Vec<u8> {
        let shape = match self.shape {
            Shape::One => "()".to_owned(),
            Shape::Frames => format!("({frames},)"),
            Shape::Discs(1) => format!("({frames}, {count})"),
            Shape::Discs(numbers) => format!("({frames}, {count}, {numbers})"),
        };
        let kind = self.kind;
        let mut text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        let before = MAGIC.len() + 2;
        let whole = (before + text.len() + 1).next_multiple_of(ALIGNMENT);
        while before + text.len() + 1 < whole {
            text.push(' ');
        }
        text.push('\n');
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&(text.len() as u16).to_le_bytes());
        bytes.extend_from_slice(text.as_bytes());
        bytes
    }

    /// The data of a frame.
    fn data(&self, torus: &Torus, frame: &Frame<'_>) -> Vec<u8> {
        let number = |number: f64| number.to_le_bytes().to_vec();
        let fractions = frame.positions.iter().flat_map(|position| [position.x, position.y]);
        let discs = 0..frame.positions.len();
        match self.name {
            name if name == BOX.name => number(torus.side()),
            name if name == STEP.name => frame.step.to_le_bytes().to_vec(),
            name if name == TIME.name => number(time_from_units(frame.time)),
            name if name == TIME_STEP.name => number(frame.time_step),
            name if name == EXACT_TIME.name => frame.time.to_le_bytes().to_vec(),
            name if name == TIME_OVER_JEANS.name => number(frame.time_over_jeans.unwrap_or(f64::NAN)),
            name if name == LARGEST_FORCE.name => number(frame.largest_force.unwrap_or(f64::NAN)),
            name if name == CLUSTERS.name => {
                frame.clustered.map_or(-1, |clusters| clusters.count() as i32).to_le_bytes().to_vec()
            }
            name if name == POSITIONS.name => {
                fractions.flat_map(|fraction| torus.coordinate(fraction).to_le_bytes()).collect()
            }
            name if name == EXACT_POSITIONS.name => {
                fractions.flat_map(|fraction| fraction.to_bits().to_le_bytes()).collect()
            }
            name if name == IMAGES.name => discs
                .flat_map(|id| frame.crossings.get(id).copied().unwrap_or_default())
                .flat_map(i32::to_le_bytes)
                .collect(),
            _ => discs
                .map(|id| frame.strengths.get(id).copied().unwrap_or(ONE))
                .flat_map(|strength| strengths::to_number(strength).to_le_bytes())
                .collect(),
        }
    }
}

/// A growing archive.
#[derive(Debug)]
pub(super) struct NpzTrajectory {
    path: PathBuf,
    torus: Torus,
    frames: u64,
    /// Number of discs; of no meaning without frames.
    count: u64,
}

impl NpzTrajectory {
    pub(super) fn create(path: &Path, torus: &Torus) -> Result<Self, FileError> {
        let trajectory = Self { path: path.to_owned(), torus: *torus, frames: 0, count: 0 };
        File::create_new(path)
            .and_then(|_| trajectory.store(&[]))
            .map_err(|error| trajectory.failed(error))?;
        Ok(trajectory)
    }

    /// The file is always whole, but may have more frames.
    pub(super) fn resume(path: &Path, torus: &Torus, extent: Extent) -> Result<Self, FileError> {
        let mut trajectory = Self { path: path.to_owned(), torus: *torus, frames: 0, count: 0 };
        if extent.frames > 0 {
            let refused = |problem| FileError::Read { path: path.to_owned(), problem };
            let input = File::open(path).map_err(|error| refused(FormatError::Input(error)))?;
            let reader = NpzReader::open(BufReader::new(input), Some(torus)).map_err(refused)?;
            if reader.frames < extent.frames {
                return Err(FileError::Extent {
                    path: path.to_owned(),
                    found: format!("{} frames", reader.frames),
                    expected: format!("{} frames", extent.frames),
                });
            }
            trajectory.frames = extent.frames;
            trajectory.count = reader.count;
        }
        trajectory.store(&[]).map_err(|error| trajectory.failed(error))?;
        Ok(trajectory)
    }

    pub(super) fn append(&mut self, frames: &[Frame<'_>]) -> Result<(), FileError> {
        let mut counts = frames.iter().map(|frame| frame.positions.len() as u64);
        let all = if self.frames > 0 { Some(self.count) } else { counts.clone().next() };
        if let Some(other) = counts.find(|count| Some(*count) != all) {
            let problem = format!("a frame of {other} discs after others: .npz holds one number of discs");
            return Err(self.failed(Error::other(problem)));
        }
        self.count = all.unwrap_or(0);
        self.store(frames).map_err(|error| self.failed(error))?;
        self.frames += frames.len() as u64;
        Ok(())
    }

    pub(super) fn sync(&mut self) -> Result<Extent, FileError> {
        // Every frame is on the disk.
        let length = std::fs::metadata(&self.path).map(|metadata| metadata.len());
        Ok(Extent { frames: self.frames, bytes: length.map_err(|error| self.failed(error))? })
    }

    /// Writes the first frames of the file and these.
    fn store(&self, new: &[Frame<'_>]) -> std::io::Result<()> {
        let frames = self.frames + new.len() as u64;
        let mut old = match self.frames {
            0 => None,
            _ => Some(ZipArchive::new(BufReader::new(File::open(&self.path)?)).map_err(Error::other)?),
        };
        let temporary = temporary_beside(&self.path)?;
        let mut zip = ZipWriter::new(BufWriter::new(temporary.as_file()));
        for array in ARRAYS {
            let header = array.header(frames, self.count);
            let kept =
                if array.shape == Shape::One { 0 } else { self.frames * array.bytes_of_frame(self.count) };
            let whole = header.len() as u64 + frames.max(1) * array.bytes_of_frame(self.count);
            let options = SimpleFileOptions::default()
                .compression_method(CompressionMethod::Stored)
                .last_modified_time(DateTime::DEFAULT)
                .large_file(whole >= u64::from(u32::MAX));
            zip.start_file(array.file_name(), options).map_err(Error::other)?;
            zip.write_all(&header)?;
            if let Some(old) = &mut old {
                let mut old = old.by_name(&array.file_name()).map_err(Error::other)?;
                skip_header(&mut old)?;
                if std::io::copy(&mut old.take(kept), &mut zip)? != kept {
                    return Err(Error::other(format!("the array {} is cut off", array.name)));
                }
            }
            if array.shape == Shape::One {
                zip.write_all(&array.data(&self.torus, &Frame::default()))?;
            } else {
                new.iter().try_for_each(|frame| zip.write_all(&array.data(&self.torus, frame)))?;
            }
        }
        zip.finish().map_err(Error::other)?.into_inner().map_err(|error| error.into_error())?.sync_all()?;
        take_place(temporary, &self.path)
    }

    fn failed(&self, problem: Error) -> FileError {
        FileError::Write { path: self.path.clone(), problem }
    }
}

/// Reads what stands before the data, of which it gives the text.
fn skip_header(input: &mut impl Read) -> std::io::Result<String> {
    let mut begin = [0; 10];
    input.read_exact(&mut begin)?;
    let (magic, length) = begin.split_at(MAGIC.len());
    if magic != MAGIC {
        return Err(Error::other("an array of another version of NumPy's format"));
    }
    let length = length.first_chunk().map_or(0, |bytes| u16::from_le_bytes(*bytes));
    let mut text = Vec::new();
    input.take(u64::from(length)).read_to_end(&mut text)?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// The frames of an archive.
pub(super) struct NpzReader<R> {
    archive: ZipArchive<R>,
    torus: Torus,
    frames: u64,
    count: u64,
}

impl<R: Read + Seek> NpzReader<R> {
    /// Opens the archive in `input`, whose box has to be `torus` if there is one.
    pub(super) fn open(input: R, torus: Option<&Torus>) -> Result<Self, FormatError> {
        let mut archive = ZipArchive::new(input).map_err(|error| damaged(&error.to_string()))?;
        let (frames, count) = shape(&mut archive)?;
        if count > LARGEST_PARTICLE_COUNT as u64 {
            return Err(wrong(format!("{count} discs"), format!("at most {LARGEST_PARTICLE_COUNT}")));
        }
        let side = f64::from_le_bytes(one(&data(&mut archive, &BOX, 1, 0, 0)?));
        let torus = match torus {
            Some(torus) if torus.side() == side => *torus,
            Some(torus) => {
                return Err(wrong(
                    format!("a box of side {side}"),
                    format!("the box of side {}", torus.side()),
                ));
            }
            None => Torus::new(side).map_err(|_| {
                wrong(format!("a box of side {side}"), "a side that a box can have, R0".to_owned())
            })?,
        };
        Ok(Self { archive, torus, frames, count })
    }

    /// The box.
    pub(super) fn torus(&self) -> Torus {
        self.torus
    }

    /// The number of frames.
    pub(super) fn frames(&self) -> u64 {
        self.frames
    }

    /// The frame of this number, from 0.
    pub(super) fn frame(&mut self, frame: u64) -> Result<Recorded, FormatError> {
        let mut data = |array| data(&mut self.archive, array, self.frames, self.count, frame);
        let known = |bytes: Vec<u8>| Some(f64::from_le_bytes(one(&bytes))).filter(|number| !number.is_nan());
        let (step, time) = (data(&STEP)?, data(&EXACT_TIME)?);
        let (bits, images, strengths) = (data(&EXACT_POSITIONS)?, data(&IMAGES)?, data(&STRENGTHS)?);
        let (time_over_jeans, largest_force) = (known(data(&TIME_OVER_JEANS)?), known(data(&LARGEST_FORCE)?));
        let time_step = f64::from_le_bytes(one(&data(&TIME_STEP)?));
        let pairs = |bytes: &[u8]| -> Vec<[[u8; 4]; 2]> { bytes.as_chunks().0.as_chunks().0.to_vec() };
        let position = |pair: [[u8; 4]; 2]| {
            let [x, y] = pair.map(u32::from_le_bytes);
            Position::from_bits(x, y)
        };
        let strength = |bytes: &[u8; 8]| {
            let number = f64::from_le_bytes(*bytes);
            strengths::from_number(number).ok_or_else(|| {
                wrong(format!("a strength of {number}"), "strengths that the core accepts".to_owned())
            })
        };
        let strengths: Vec<i32> = strengths.as_chunks().0.iter().map(strength).collect::<Result<_, _>>()?;
        let state = State {
            step: u64::from_le_bytes(one(&step)),
            time: u64::from_le_bytes(one(&time)),
            positions: pairs(&bits).into_iter().map(position).collect(),
            strengths: (!strengths::all_one(&strengths)).then_some(strengths),
            held: None,
        };
        let crossings = pairs(&images).into_iter().map(|pair| pair.map(i32::from_le_bytes)).collect();
        Ok(Recorded { state, time_over_jeans, time_step, largest_force, crossings })
    }
}

/// The numbers of frames and discs.
fn shape<R: Read + Seek>(archive: &mut ZipArchive<R>) -> Result<(u64, u64), FormatError> {
    let name = EXACT_POSITIONS.file_name();
    let Ok(mut file) = archive.by_name(&name) else {
        return Err(wrong(
            format!("no array {}", EXACT_POSITIONS.name),
            "an archive of this program".to_owned(),
        ));
    };
    let text = skip_header(&mut file).map_err(FormatError::Input)?;
    let numbers: Option<Vec<u64>> = text
        .split_once("'shape': (")
        .and_then(|(_, rest)| rest.split_once(')'))
        .and_then(|(shape, _)| shape.split(',').map(|number| number.trim().parse().ok()).collect());
    match numbers.as_deref() {
        Some(&[frames, count, 2]) => Ok((frames, count)),
        _ => Err(wrong(quoted(text.trim()), "position_bits of frames, discs and 2 columns".to_owned())),
    }
}

/// The bytes of a frame in an array, which has to be as this program writes it.
fn data<R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    array: &Array,
    frames: u64,
    count: u64,
    frame: u64,
) -> Result<Vec<u8>, FormatError> {
    let refused = |error: &dyn std::fmt::Display| damaged(&format!("array {}: {error}", array.name));
    let mut file = archive.by_name_seek(&array.file_name()).map_err(|error| refused(&error))?;
    let header = array.header(frames, count);
    let mut found = Vec::new();
    file.by_ref().take(header.len() as u64).read_to_end(&mut found).map_err(|error| refused(&error))?;
    if found != header {
        return Err(refused(&"another shape or kind of numbers"));
    }
    let length = array.bytes_of_frame(count);
    let begin = length.checked_mul(frame).and_then(|begin| begin.checked_add(header.len() as u64));
    let begin = begin.ok_or_else(|| refused(&"too many frames"))?;
    file.seek(SeekFrom::Start(begin)).map_err(|error| refused(&error))?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(|error| refused(&error))?;
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(refused(&"cut off")) }
}

/// The bytes of a number; `bytes` has them.
fn one(bytes: &[u8]) -> [u8; 8] {
    bytes.first_chunk().copied().unwrap_or_default()
}

fn damaged(what: &str) -> FormatError {
    wrong(what.to_owned(), "a whole .npz file, not compressed".to_owned())
}

fn wrong(found: String, expected: String) -> FormatError {
    FormatError::Whole { found, expected }
}
