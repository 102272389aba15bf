//! Reading: frames of this program exactly, those of others to single precision.

use super::super::FormatError;
use super::super::extended_xyz::FrameChoice;
use super::super::state::State;
use super::super::trajectory::Recorded;
use super::container::{Chunk, Container, kind};
use super::{centred, name};
use crate::strengths;
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::torus::{Fraction, Position, Torus, UNITS};
use std::io::{Read, Seek};

/// The relative difference up to which a side of single precision is that of a box.
const SIDE_TOLERANCE: f64 = 1e-6;

/// The relative distance up to which a position of single precision may be beyond the edge of the box.
const EDGE_TOLERANCE: f64 = 1e-6;

/// The frames of a GSD file.
pub struct GsdReader<R> {
    container: Container<R>,
    torus: Torus,
}

impl<R: Read + Seek> GsdReader<R> {
    /// Opens the file in `input`. Its frames have to be in the box `torus`; if there is none they have to be in that of
    /// the first.
    ///
    /// # Errors
    /// A [`FormatError`] for a file that is not whole or another box.
    pub fn open(input: R, torus: Option<&Torus>) -> Result<Self, FormatError> {
        let mut container = Container::open(input)?;
        let torus = match torus {
            Some(torus) => *torus,
            None if container.frames() == 0 => {
                return Err(wrong("no frame".to_owned(), "at least 1".to_owned()));
            }
            None => box_of(&mut container, 0)?.into_torus()?,
        };
        Ok(Self { container, torus })
    }

    /// The box.
    #[must_use]
    pub fn torus(&self) -> Torus {
        self.torus
    }

    /// The number of frames.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.container.frames()
    }

    /// The frame chosen.
    ///
    /// # Errors
    /// As [`frame`](Self::frame).
    pub fn choose(&mut self, choice: FrameChoice) -> Result<Recorded, FormatError> {
        match choice {
            FrameChoice::Last => self.frame(self.frames().saturating_sub(1)),
            FrameChoice::Number(number) => self.frame(number),
        }
    }

    /// The frame of this number, from 0.
    ///
    /// # Errors
    /// A [`FormatError`] for a frame that is not there, another box, a third dimension, a position outside the box.
    pub fn frame(&mut self, frame: u64) -> Result<Recorded, FormatError> {
        if frame >= self.frames() {
            let found = format!("{} frames", self.frames());
            return Err(FormatError::Whole { found, expected: format!("more than {frame}") });
        }
        let box_of_file = box_of(&mut self.container, frame)?;
        box_of_file.require(&self.torus)?;
        let count = match self.shared(frame, name::COUNT, kind::U32, 1)? {
            Some(bytes) => one(&bytes, u32::from_ne_bytes)? as usize,
            None => 0,
        };
        if count > LARGEST_PARTICLE_COUNT {
            return Err(wrong(format!("{count} discs"), format!("at most {LARGEST_PARTICLE_COUNT}")));
        }
        let positions = self.positions(frame, count, &box_of_file)?;
        let step = self.number(frame, name::STEP, kind::U64, u64::from_ne_bytes)?.unwrap_or(0);
        let time = self.number(frame, name::EXACT_TIME, kind::U64, u64::from_ne_bytes)?.unwrap_or(0);
        let strengths = self.strengths(frame, count)?;
        Ok(Recorded {
            state: State { step, time, positions, strengths, held: None },
            time_over_jeans: self.observable(frame, name::TIME_OVER_JEANS)?,
            time_step: self.observable(frame, name::TIME_STEP)?.unwrap_or(0.0),
            largest_force: self.observable(frame, name::LARGEST_FORCE)?,
            crossings: self.crossings(frame, count)?,
        })
    }

    fn positions(
        &mut self,
        frame: u64,
        count: usize,
        box_of_file: &BoxOfFile,
    ) -> Result<Vec<Position>, FormatError> {
        let Some(bytes) = self.of_discs(frame, name::POSITION, kind::F32, 3, count)? else {
            return Err(wrong(
                format!("no {}", name::POSITION),
                "positions in the frame or in frame 0".to_owned(),
            ));
        };
        let (numbers, _) = bytes.as_chunks::<4>();
        let (rows, _) = numbers.as_chunks::<3>();
        let side = box_of_file.side;
        let Some(exact) = self.of_discs(frame, name::EXACT_POSITION, kind::U32, 2, count)? else {
            let position = |(id, row): (usize, &[[u8; 4]; 3])| {
                let [x, y, _] = row.map(f32::from_ne_bytes);
                Ok(Position { x: fraction(side, id, x)?, y: fraction(side, id, y)? })
            };
            return rows.iter().enumerate().map(position).collect();
        };
        let (numbers, _) = exact.as_chunks::<4>();
        let (bits, _) = numbers.as_chunks::<2>();
        let mut positions = Vec::with_capacity(rows.len());
        for (id, (bits, row)) in bits.iter().zip(rows).enumerate() {
            let [x, y] = bits.map(u32::from_ne_bytes);
            let position = Position::from_bits(x, y);
            let rounded = [centred(side, position.x), centred(side, position.y)];
            let shown = [f32::from_ne_bytes(row[0]), f32::from_ne_bytes(row[1])];
            if rounded != shown {
                let found = format!("disc {id} at {shown:?}, and {rounded:?} by {}", name::EXACT_POSITION);
                let expected = "the same: if the positions were changed, leave out that chunk";
                return Err(wrong(found, expected.to_owned()));
            }
            positions.push(position);
        }
        Ok(positions)
    }

    /// None if nothing is said or none went around.
    fn crossings(&mut self, frame: u64, count: usize) -> Result<Vec<[i32; 2]>, FormatError> {
        let bytes = self.of_discs(frame, name::IMAGE, kind::I32, 3, count)?.unwrap_or_default();
        let (numbers, _) = bytes.as_chunks::<4>();
        let (rows, _) = numbers.as_chunks::<3>();
        Ok(rows.iter().map(|[x, y, _]| [*x, *y].map(i32::from_ne_bytes)).collect())
    }

    fn strengths(&mut self, frame: u64, count: usize) -> Result<Option<Vec<i32>>, FormatError> {
        let Some(bytes) = self.of_discs(frame, name::STRENGTH, kind::F64, 1, count)? else { return Ok(None) };
        let strength = |(id, bytes): (usize, &[u8; 8])| {
            let number = f64::from_ne_bytes(*bytes);
            strengths::from_number(number).ok_or_else(|| {
                wrong(format!("disc {id} of strength {number}"), "strengths that the core accepts".to_owned())
            })
        };
        bytes.as_chunks().0.iter().enumerate().map(strength).collect::<Result<_, _>>().map(Some)
    }

    /// The bytes of a chunk of `count` rows, if there is one in this frame or, but for a log, in frame 0.
    fn of_discs(
        &mut self,
        frame: u64,
        name: &'static str,
        kind: u8,
        columns: u32,
        count: usize,
    ) -> Result<Option<Vec<u8>>, FormatError> {
        let Some(chunk) = find(&self.container, frame, name) else { return Ok(None) };
        if (chunk.kind, chunk.columns, chunk.rows) != (kind, columns, count as u64) {
            let found = format!("{name} of {} rows and {} columns", chunk.rows, chunk.columns);
            return Err(wrong(
                found,
                format!("{count} rows and {columns} columns of numbers of the schema's kind"),
            ));
        }
        self.container.bytes(&chunk).map(Some)
    }

    fn shared(
        &mut self,
        frame: u64,
        name: &'static str,
        kind: u8,
        rows: usize,
    ) -> Result<Option<Vec<u8>>, FormatError> {
        self.of_discs(frame, name, kind, 1, rows)
    }

    /// A number that a log has of a frame, if it is one.
    fn observable(&mut self, frame: u64, name: &'static str) -> Result<Option<f64>, FormatError> {
        let number = self.number(frame, name, kind::F64, f64::from_ne_bytes)?;
        Ok(number.filter(|number| number.is_finite()))
    }

    /// The number of a chunk of one, if there is one in this frame.
    fn number<T, const LENGTH: usize>(
        &mut self,
        frame: u64,
        name: &'static str,
        kind: u8,
        convert: impl Fn([u8; LENGTH]) -> T,
    ) -> Result<Option<T>, FormatError> {
        self.shared(frame, name, kind, 1)?.map(|bytes| one(&bytes, convert)).transpose()
    }
}

/// The chunk of a frame. What is not in a frame is as in frame 0, unless it is a log.
fn find<R: Read + Seek>(container: &Container<R>, frame: u64, name: &str) -> Option<Chunk> {
    let inherited = || (!name.starts_with("log/")).then(|| container.find(0, name)).flatten();
    container.find(frame, name).or_else(inherited)
}

/// The box of a frame.
struct BoxOfFile {
    /// As in `configuration/box`.
    side: f32,
    /// As this program has it.
    exact: Option<f64>,
}

fn box_of<R: Read + Seek>(container: &mut Container<R>, frame: u64) -> Result<BoxOfFile, FormatError> {
    let mut read = |name: &str, kind: u8, rows: u64| {
        let chunk = find(container, frame, name)
            .filter(|chunk| (chunk.kind, chunk.rows, chunk.columns) == (kind, rows, 1));
        chunk.map(|chunk| container.bytes(&chunk)).transpose()
    };
    // What is not said is three.
    let dimensions =
        read(name::DIMENSIONS, kind::U8, 1)?.and_then(|bytes| bytes.first().copied()).unwrap_or(3);
    if dimensions != 2 {
        return Err(wrong(format!("{dimensions} dimensions"), "configuration/dimensions of 2".to_owned()));
    }
    let Some(bytes) = read(name::BOX, kind::F32, 6)? else {
        return Err(wrong("no configuration/box".to_owned(), "a square box".to_owned()));
    };
    let lengths: Vec<f32> = bytes.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
    let exact = read(name::EXACT_SIDE, kind::F64, 1)?
        .and_then(|bytes| bytes.first_chunk().copied())
        .map(f64::from_ne_bytes);
    match lengths[..] {
        [side, along_y, _, tilt, ..] if side == along_y && tilt == 0.0 => Ok(BoxOfFile { side, exact }),
        _ => Err(wrong(format!("the box {lengths:?}"), "a square box, L, L, 0, 0, 0, 0".to_owned())),
    }
}

impl BoxOfFile {
    /// The side as exactly as the file tells it, if what it tells is one.
    fn into_torus(self) -> Result<Torus, FormatError> {
        let side = self.exact.unwrap_or(f64::from(self.side));
        let torus = Torus::new(side)
            .map_err(|_| wrong(format!("a box of {side}"), "a side that a box can have, R0".to_owned()))?;
        self.require(&torus)?;
        Ok(torus)
    }

    fn require(&self, torus: &Torus) -> Result<(), FormatError> {
        let side = torus.side();
        let single = (f64::from(self.side) - side).abs() <= SIDE_TOLERANCE * side;
        let exact = self.exact.is_none_or(|exact| exact == side && self.side == side as f32);
        if single && exact {
            return Ok(());
        }
        let found = self.exact.filter(|exact| *exact as f32 == self.side).unwrap_or(f64::from(self.side));
        Err(wrong(format!("a box of side {found}"), format!("the box of side {side}")))
    }
}

/// The fraction of the box at a coordinate from the middle.
fn fraction(side: f32, id: usize, coordinate: f32) -> Result<Fraction, FormatError> {
    let (wide, of_side) = (f64::from(side), f64::from(coordinate) / f64::from(side));
    let inside = of_side.abs() <= 0.5 + EDGE_TOLERANCE;
    if !inside {
        let expected = format!("coordinates from {} to {}", -wide / 2.0, wide / 2.0);
        return Err(wrong(format!("disc {id} at {coordinate}"), expected));
    }
    // Wraps at the edge.
    Ok(Fraction::from_bits(libm::rint((of_side + 0.5) * UNITS) as i64 as u32))
}

/// The number that bytes are.
fn one<T, const LENGTH: usize>(bytes: &[u8], convert: impl Fn([u8; LENGTH]) -> T) -> Result<T, FormatError> {
    bytes
        .first_chunk()
        .map(|bytes| convert(*bytes))
        .ok_or_else(|| wrong("no number".to_owned(), "one".to_owned()))
}

fn wrong(found: String, expected: String) -> FormatError {
    FormatError::Whole { found, expected }
}
