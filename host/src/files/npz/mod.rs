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

mod read;
mod write;

pub(super) use read::NpzReader;
pub(super) use write::NpzTrajectory;

use super::trajectory::Frame;
use crate::strengths::{self, ONE};
use meniscus_core::torus::Torus;
use meniscus_core::units::time_from_units;
use std::io::{Error, Read};

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
