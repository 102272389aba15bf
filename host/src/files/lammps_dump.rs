//! Trajectories as LAMMPS writes them with its command `dump custom`, which OVITO, MDAnalysis and ASE open.
//!
//! A frame has the step, the number of discs, the box from 0 to L, and a line for each disc: the id, which with
//! LAMMPS begins at 1; the type, 1; the position in R0 with digits that give the same bits again, and z = 0; how often
//! the disc went around the box along x and y, and 0; and the capillary strength unless all are 1. There is no time.
//!
//! Read are frames with their columns in any order. `x` and `y` are needed, in a square box from 0; `id`, `ix`, `iy` and
//! `strength` count if there; the rest is passed over.
//!
//! ```
//! use meniscus::files::lammps_dump::write_frame;
//! use meniscus::files::trajectory::Frame;
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(8.0).unwrap();
//! let positions = [Position::from_bits(1 << 31, 1 << 30)];
//! let frame = Frame { step: 3, positions: &positions, crossings: &[[0, -1]], ..Frame::default() };
//! let mut text = Vec::new();
//! write_frame(&mut text, &torus, &frame).unwrap();
//! assert_eq!(
//!     std::str::from_utf8(&text).unwrap(),
//!     "ITEM: TIMESTEP\n3\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 8\n0 8\n-0.5 0.5\n\
//!      ITEM: ATOMS id type x y z ix iy iz\n1 1 4 2 0 0 -1 0\n"
//! );
//! ```

use super::FormatError;
use super::error::quoted;
use super::identities::{Rows, coordinate, strength};
use super::lines::Lines;
use super::state::State;
use super::trajectory::{Frame, Recorded};
use crate::strengths;
use meniscus_core::torus::{Position, Torus};
use std::io::{BufRead, Write};

/// Appends `frame` to `output`.
///
/// # Errors
/// What `output` says.
pub fn write_frame(output: &mut impl Write, torus: &Torus, frame: &Frame<'_>) -> std::io::Result<()> {
    let side = torus.side();
    let told = !strengths::all_one(frame.strengths);
    writeln!(output, "ITEM: TIMESTEP\n{}", frame.step)?;
    writeln!(output, "ITEM: NUMBER OF ATOMS\n{}", frame.positions.len())?;
    writeln!(output, "ITEM: BOX BOUNDS pp pp pp\n0 {side}\n0 {side}\n-0.5 0.5")?;
    writeln!(output, "ITEM: ATOMS id type x y z ix iy iz{}", if told { " strength" } else { "" })?;
    for (id, position) in frame.positions.iter().enumerate() {
        let (x, y) = (torus.coordinate(position.x), torus.coordinate(position.y));
        let [around_x, around_y] = frame.crossings.get(id).copied().unwrap_or_default();
        write!(output, "{} 1 {x} {y} 0 {around_x} {around_y} 0", id + 1)?;
        match frame.strengths.get(id) {
            Some(&strength) if told => writeln!(output, " {}", strengths::to_number(strength))?,
            _ => writeln!(output)?,
        }
    }
    Ok(())
}

/// What stands before the discs of a frame.
#[derive(Default)]
struct Header {
    step: u64,
    count: u32,
    side: Option<(u64, f64)>,
}

/// Reads the next frame; none at the end. `torus` is the box, if it is not known that of the frame.
pub(super) fn next_frame<R: BufRead>(
    lines: &mut Lines<R>,
    torus: &mut Option<Torus>,
) -> Result<Option<Recorded>, FormatError> {
    let mut header = Header::default();
    let mut begun = false;
    let columns = loop {
        let Some(text) = lines.next()?.map(str::to_owned) else {
            return if begun { Err(wrong(lines, "the end", "a whole frame")) } else { Ok(None) };
        };
        if text.is_empty() && !begun {
            continue;
        }
        begun = true;
        let Some(item) = text.strip_prefix("ITEM:") else {
            return Err(wrong(lines, &quoted(&text), "ITEM: and the name of a section"));
        };
        match item.split_whitespace().next() {
            Some("TIMESTEP") => header.step = number(lines, "the number of steps")?,
            Some("NUMBER") => header.count = number(lines, "the number of discs")?,
            Some("BOX") => header.side = Some(side(lines)?),
            Some("ATOMS") => break Columns::named(lines, item)?,
            // Of one line each: units, time.
            _ => {
                lines.next()?;
            }
        }
    };
    let Some((line, side)) = header.side else {
        return Err(wrong(lines, "a frame without a box", "ITEM: BOX BOUNDS"));
    };
    let torus = match torus {
        Some(torus) if torus.side() == side => *torus,
        Some(torus) => {
            let (found, expected) = (format!("a box of side {side}"), format!("0 {}", torus.side()));
            return Err(FormatError::Line { line, found, expected });
        }
        None => {
            let refused = |_| FormatError::Line {
                line,
                found: format!("a box of side {side}"),
                expected: "a side that a box can have, R0".to_owned(),
            };
            *torus.insert(Torus::new(side).map_err(refused)?)
        }
    };
    let mut rows = Rows::default();
    let mut crossings = Vec::new();
    for _ in 0..header.count {
        let Some(text) = lines.next()?.map(str::to_owned) else {
            return Err(wrong(lines, "the end", &format!("{} discs", header.count)));
        };
        columns.add_row(&torus, lines.number(), &text, &mut rows, &mut crossings)?;
    }
    // Rows may come in any order.
    crossings.sort_unstable();
    let crossings = crossings.into_iter().map(|(_, crossings)| crossings).collect();
    let state = State { step: header.step, ..rows.into_state()? };
    Ok(Some(Recorded { crossings, ..Recorded::from_state(state) }))
}

/// The number in the next line.
fn number<R: BufRead, T: std::str::FromStr>(lines: &mut Lines<R>, what: &str) -> Result<T, FormatError> {
    let text = lines.next()?.unwrap_or_default().to_owned();
    text.parse().map_err(|_| wrong(lines, &quoted(&text), what))
}

/// The side of a square box from 0, and the line in which it is.
fn side<R: BufRead>(lines: &mut Lines<R>) -> Result<(u64, f64), FormatError> {
    let along = |lines: &mut Lines<R>| {
        let text = lines.next()?.unwrap_or_default().to_owned();
        let ends: Option<Vec<f64>> = text.split_whitespace().map(|end| end.parse().ok()).collect();
        match ends.as_deref() {
            Some(&[0.0, side]) => Ok(side),
            _ => Err(wrong(lines, &quoted(&text), "0 and the side L of the box")),
        }
    };
    let (side, along_y) = (along(lines)?, along(lines)?);
    let line = lines.number();
    if side != along_y {
        return Err(wrong(lines, &format!("a box of {side} by {along_y}"), "a square box"));
    }
    lines.next()?;
    Ok((line, side))
}

/// Where the columns are that count.
struct Columns {
    id: Option<usize>,
    x: usize,
    y: usize,
    around: Option<[usize; 2]>,
    strength: Option<usize>,
}

impl Columns {
    fn named<R: BufRead>(lines: &Lines<R>, item: &str) -> Result<Self, FormatError> {
        let column = |name: &str| item.split_whitespace().skip(1).position(|column| column == name);
        match (column("x"), column("y")) {
            (Some(x), Some(y)) => Ok(Self {
                id: column("id"),
                x,
                y,
                around: column("ix").zip(column("iy")).map(|(x, y)| [x, y]),
                strength: column("strength"),
            }),
            _ => Err(wrong(lines, &quoted(item.trim()), "columns named x and y")),
        }
    }

    fn add_row(
        &self,
        torus: &Torus,
        line: u64,
        text: &str,
        rows: &mut Rows,
        crossings: &mut Vec<(u64, [i32; 2])>,
    ) -> Result<(), FormatError> {
        let refused = |expected: String| FormatError::Line { line, found: quoted(text), expected };
        let value = |column: usize| {
            text.split_whitespace()
                .nth(column)
                .ok_or_else(|| refused(format!("at least {} values", column.saturating_add(1))))
        };
        let position = Position {
            x: coordinate(torus, line, "x", value(self.x)?)?,
            y: coordinate(torus, line, "y", value(self.y)?)?,
        };
        let strength = self.strength.map(|column| strength(line, value(column)?)).transpose()?;
        let id = match self.id {
            Some(column) => value(column)?
                .parse::<u64>()
                .ok()
                .and_then(|id| id.checked_sub(1))
                .ok_or_else(|| refused("an id, a whole number from 1".to_owned()))?,
            None => rows.len() as u64,
        };
        if let Some([x, y]) = self.around {
            let count = |column| {
                let text = value(column)?;
                text.parse().map_err(|_| refused("whole numbers in the columns ix and iy".to_owned()))
            };
            crossings.push((id, [count(x)?, count(y)?]));
        }
        rows.push(line, Some(&id.to_string()), position, strength)
    }
}

fn wrong<R: BufRead>(lines: &Lines<R>, found: &str, expected: &str) -> FormatError {
    FormatError::Line { line: lines.number(), found: found.to_owned(), expected: expected.to_owned() }
}
