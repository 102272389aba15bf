//! Trajectories as extended XYZ, which OVITO and ASE open.
//!
//! A frame is a line with the number of discs, a line of `key=value`, and a line for each disc. Written
//! are the box as `Lattice`, the columns as `Properties`, then `pbc`, `step`, `time` (R0²/D; exact below 8192),
//! `time_over_jeans` and `dt`, the length of the next step (R0²/D). The columns are the species `X`, which to ASE is no chemical element;
//! the position in R0 with digits that give the same bits again, and z = 0; the id; the capillary strength unless
//! all are 1; and perhaps whether the disc belongs to a cluster (1 or 0).
//!
//! Read are frames with their columns in any order. `pos` is needed, coordinates being in [0, L); a
//! `Lattice` has to be that of the box; `id`, `strength`, `step` and `time` count if there; the rest is passed over.
//!
//! ```
//! use meniscus::files::extended_xyz::{FrameChoice, parse, write_frame};
//! use meniscus::files::trajectory::Frame;
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(8.0).unwrap();
//! let positions = [Position::from_bits(1 << 31, 1 << 30)];
//! let frame = Frame { step: 3, time: 1 << 39, time_step: 0.001, positions: &positions, ..Frame::default() };
//! let mut text = Vec::new();
//! write_frame(&mut text, &torus, &frame).unwrap();
//! assert_eq!(
//!     std::str::from_utf8(&text).unwrap(),
//!     "1\nLattice=\"8 0 0 0 8 0 0 0 1\" Properties=species:S:1:pos:R:3:id:I:1 pbc=\"T T F\" \
//!      step=3 time=0.5 dt=0.001\nX 4 2 0 0\n"
//! );
//! let state = parse(std::io::Cursor::new(text), &torus, FrameChoice::Last).unwrap();
//! assert_eq!((state.step, state.time, state.positions), (3, 1 << 39, positions.to_vec()));
//! ```

use super::error::quoted;
use super::identities::{Rows, coordinate, strength};
use super::lines::{Lines, Place};
use super::state::State;
use super::trajectory::{Frame, Recorded};
use super::{FileError, FormatError, read_with};
use crate::strengths;
use meniscus_core::torus::{Position, Torus};
use meniscus_core::units::{TIME_UNITS, time_from_units};
use std::io::{BufRead, Seek, Write};
use std::path::Path;

/// The relative difference up to which the side of a `Lattice` is that of the box: programs print as few
/// as ten digits.
const SIDE_TOLERANCE: f64 = 1e-9;

/// Appends `frame` to `output`.
///
/// # Errors
/// What `output` says.
pub fn write_frame(output: &mut impl Write, torus: &Torus, frame: &Frame<'_>) -> std::io::Result<()> {
    let side = torus.side();
    let told = !strengths::all_one(frame.strengths);
    let strength = if told { ":strength:R:1" } else { "" };
    let clustered = if frame.clustered.is_some() { ":clustered:I:1" } else { "" };
    writeln!(output, "{}", frame.positions.len())?;
    write!(
        output,
        "Lattice=\"{side} 0 0 0 {side} 0 0 0 1\" Properties=species:S:1:pos:R:3:id:I:1{strength}{clustered} "
    )?;
    write!(output, "pbc=\"T T F\" step={} time={} ", frame.step, time_from_units(frame.time))?;
    if let Some(time_over_jeans) = frame.time_over_jeans {
        write!(output, "time_over_jeans={time_over_jeans} ")?;
    }
    writeln!(output, "dt={}", frame.time_step)?;
    for (id, position) in frame.positions.iter().enumerate() {
        write!(output, "X {} {} 0 {id}", torus.coordinate(position.x), torus.coordinate(position.y))?;
        if let Some(&strength) = frame.strengths.get(id).filter(|_| told) {
            write!(output, " {}", strengths::to_number(strength))?;
        }
        match frame.clustered {
            Some(clusters) => writeln!(output, " {}", u8::from(clusters.clustered(id)))?,
            None => writeln!(output)?,
        }
    }
    Ok(())
}

/// Which frame of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameChoice {
    /// The last.
    Last,
    /// The one of this number, from 0.
    Number(u64),
}

/// Reads a frame of the file at `path`.
///
/// # Errors
/// [`FileError::Read`] naming the line and column.
pub fn read(path: &Path, torus: &Torus, choice: FrameChoice) -> Result<State, FileError> {
    read_with(path, |input| parse(input, torus, choice))
}

/// Reads a frame of `input`.
///
/// # Errors
/// [`FormatError`] for a frame that is not there or cut off, another box, a missing column, a value
/// that is none, an id missing or used twice.
pub fn parse(input: impl BufRead + Seek, torus: &Torus, choice: FrameChoice) -> Result<State, FormatError> {
    let mut lines = Lines::new(input);
    let place = find(&mut lines, choice)?;
    lines.go_back(place)?;
    let frame = next_frame(&mut lines, &mut Some(*torus))?;
    frame.map(|frame| frame.state).ok_or_else(|| no_frame(0, choice))
}

/// Reads the next frame; none at the end. `torus` is the box, if it is not known that of the frame's `Lattice`.
pub(super) fn next_frame<R: BufRead>(
    lines: &mut Lines<R>,
    torus: &mut Option<Torus>,
) -> Result<Option<Recorded>, FormatError> {
    let Some(count) = frame_start(lines)? else {
        return Ok(None);
    };
    let text = lines.next()?.unwrap_or_default().to_owned();
    if torus.is_none() {
        *torus = Some(lattice(lines.number(), &text)?);
    }
    let Some(torus) = torus else {
        return Ok(None);
    };
    let header = Header::parse(torus, lines.number(), &text)?;
    let mut rows = Rows::default();
    for _ in 0..count {
        let line = lines.number() + 1;
        let text = lines.next()?.ok_or_else(|| cut_off(line, rows.len(), count))?;
        header.columns.add_row(torus, line, text, &mut rows)?;
    }
    Ok(Some(Recorded {
        state: State { step: header.step, time: header.time, ..rows.into_state()? },
        time_over_jeans: header.time_over_jeans,
        time_step: header.time_step,
        ..Recorded::default()
    }))
}

/// The box that the second line of a frame tells.
fn lattice(line: u64, text: &str) -> Result<Torus, FormatError> {
    let refused = |found: String| FormatError::Line {
        line,
        found,
        expected: "Lattice=\"L 0 0 0 L 0 0 0 1\", a square box".to_owned(),
    };
    let (key, value) = KeysAndValues(text)
        .find(|(key, _)| *key == "Lattice")
        .ok_or_else(|| refused("no Lattice".to_owned()))?;
    let side = value.split_whitespace().next().and_then(|side| side.parse().ok());
    side.and_then(|side| Torus::new(side).ok())
        .filter(|torus| is_box(torus, value))
        .ok_or_else(|| refused(format!("{key}={}", quoted(value))))
}

/// Where the frame chosen begins.
fn find<R: BufRead>(lines: &mut Lines<R>, choice: FrameChoice) -> Result<Place, FormatError> {
    let mut last = None;
    let mut frames = 0;
    loop {
        let place = lines.place();
        let Some(count) = frame_start(lines)? else {
            break;
        };
        if choice == FrameChoice::Number(frames) {
            return Ok(place);
        }
        for read in 0..=u64::from(count) {
            if lines.next()?.is_none() {
                return Err(cut_off(lines.number(), read.saturating_sub(1) as usize, count));
            }
        }
        frames += 1;
        last = Some(place);
    }
    match choice {
        FrameChoice::Last => last.ok_or_else(|| no_frame(0, choice)),
        FrameChoice::Number(_) => Err(no_frame(frames, choice)),
    }
}

fn no_frame(frames: u64, choice: FrameChoice) -> FormatError {
    let expected = match choice {
        FrameChoice::Last => "at least one".to_owned(),
        FrameChoice::Number(number) => format!("more than {number}"),
    };
    FormatError::Whole { found: format!("{frames} frames"), expected }
}

fn cut_off(line: u64, found: usize, count: u32) -> FormatError {
    FormatError::Line {
        line,
        found: format!("the end after {found} of {count} discs"),
        expected: "whole frames: cut the last one away".to_owned(),
    }
}

/// The number of discs of the next frame; none at the end of the input. Empty lines between frames are
/// passed over.
fn frame_start<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<u32>, FormatError> {
    loop {
        let line = lines.number() + 1;
        match lines.next()? {
            None => return Ok(None),
            Some("") => {}
            Some(text) => {
                return text.parse().map(Some).map_err(|_| FormatError::Line {
                    line,
                    found: quoted(text),
                    expected: "the number of discs of a frame".to_owned(),
                });
            }
        }
    }
}

/// What the second line of a frame tells.
struct Header {
    columns: Columns,
    step: u64,
    time: u64,
    time_over_jeans: Option<f64>,
    time_step: f64,
}

impl Header {
    fn parse(torus: &Torus, line: u64, text: &str) -> Result<Self, FormatError> {
        // What a file without `Properties` has.
        let columns = Columns { x: 1, y: 2, id: None, strength: None };
        let mut header = Self { columns, step: 0, time: 0, time_over_jeans: None, time_step: 0.0 };
        let refused = |key: &str, value: &str, expected: String| FormatError::Line {
            line,
            found: format!("{key}={}", quoted(value)),
            expected,
        };
        for (key, value) in KeysAndValues(text) {
            match key {
                "Properties" => {
                    header.columns = Columns::named(value)
                        .ok_or_else(|| refused(key, value, "name:type:count with pos:R:3".to_owned()))?;
                }
                "Lattice" if !is_box(torus, value) => {
                    let side = torus.side();
                    return Err(refused(key, value, format!("the box \"{side} 0 0 0 {side} 0 0 0 1\"")));
                }
                "step" => {
                    header.step =
                        value.parse().map_err(|_| refused(key, value, "a whole number".to_owned()))?;
                }
                "time" => {
                    header.time = time_units(value)
                        .ok_or_else(|| refused(key, value, "a time from 0, R0^2/D".to_owned()))?;
                }
                "time_over_jeans" => header.time_over_jeans = finite(value),
                "dt" => header.time_step = finite(value).unwrap_or(0.0),
                _ => {}
            }
        }
        Ok(header)
    }
}

fn finite(value: &str) -> Option<f64> {
    value.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The time in units of 2⁻⁴⁰ R0²/D.
fn time_units(value: &str) -> Option<u64> {
    let units = libm::rint(value.parse::<f64>().ok()? * TIME_UNITS as f64);
    (units >= 0.0 && units < u64::MAX as f64).then_some(units as u64)
}

/// Whether nine numbers are the square box; that of z does not matter.
fn is_box(torus: &Torus, value: &str) -> bool {
    let numbers: Option<Vec<f64>> = value.split_whitespace().map(|number| number.parse().ok()).collect();
    let close = |number: f64, to: f64| (number - to).abs() <= SIDE_TOLERANCE * torus.side();
    let side = torus.side();
    numbers.is_some_and(|numbers| match numbers[..] {
        [ax, ay, az, bx, by, bz, cx, cy, _] => {
            close(ax, side)
                && close(by, side)
                && [ay, az, bx, bz, cx, cy].iter().all(|number| close(*number, 0.0))
        }
        _ => false,
    })
}

/// Where the columns are that count.
struct Columns {
    id: Option<usize>,
    x: usize,
    y: usize,
    strength: Option<usize>,
}

impl Columns {
    /// Finds the columns in the value of `Properties`, `name:type:count` again and again.
    fn named(value: &str) -> Option<Self> {
        let (mut place, mut pos, mut id, mut strength) = (0_usize, None, None, None);
        let mut fields = value.split(':');
        while let Some(name) = fields.next() {
            let _type = fields.next()?;
            let count: usize = fields.next()?.parse().ok()?;
            match name {
                "pos" if count >= 2 => pos = Some(place),
                "id" if count == 1 => id = Some(place),
                "strength" if count == 1 => strength = Some(place),
                _ => {}
            }
            place = place.checked_add(count)?;
        }
        pos.map(|pos| Self { id, x: pos, y: pos + 1, strength })
    }

    /// Reads the line of one disc.
    fn add_row(&self, torus: &Torus, line: u64, text: &str, rows: &mut Rows) -> Result<(), FormatError> {
        let value = |column: usize| {
            text.split_whitespace().nth(column).ok_or_else(|| FormatError::Line {
                line,
                found: quoted(text),
                expected: format!("at least {} values, as Properties says", column.saturating_add(1)),
            })
        };
        let position = Position {
            x: coordinate(torus, line, "x", value(self.x)?)?,
            y: coordinate(torus, line, "y", value(self.y)?)?,
        };
        let strength = self.strength.map(|column| strength(line, value(column)?)).transpose()?;
        rows.push(line, self.id.map(value).transpose()?, position, strength)
    }
}

/// The pairs of a line of `key=value key="several words" flag`. A flag has the value of an empty text.
struct KeysAndValues<'a>(&'a str);

impl<'a> Iterator for KeysAndValues<'a> {
    type Item = (&'a str, &'a str);

    fn next(&mut self) -> Option<Self::Item> {
        let text = self.0.trim_start();
        if text.is_empty() {
            return None;
        }
        let key_end = text.find(|letter: char| letter == '=' || letter.is_whitespace());
        let (key, rest) = text.split_at(key_end.unwrap_or(text.len()));
        let Some(rest) = rest.strip_prefix('=') else {
            self.0 = rest;
            return Some((key, ""));
        };
        let (value, rest) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None => rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len())),
        };
        self.0 = rest;
        Some((key, value))
    }
}
