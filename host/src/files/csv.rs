//! Positions as comma-separated values.
//!
//! The first line names the columns. `x` and `y` are coordinates in R0 in [0, L); `id`, if there, is the
//! number of the disc from 0, and else rows are in id order; `strength`, if there, is the capillary strength f;
//! other columns are passed over. Lines that begin with `#` and empty lines are too. A quoted value ends on its
//! line.
//!
//! Files are written with the columns `id,x,y`, and `strength` unless all are 1, and as many digits as tell every
//! position from the next, so that reading gives the same bits again.
//!
//! ```
//! use meniscus::files::csv;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(8.0).unwrap();
//! let text = "# two discs\nid,x,y,colour\n1,4,4,red\n0,0.5,7.75,blue\n";
//! let state = csv::parse(text.as_bytes(), &torus).unwrap();
//! assert_eq!(csv::format(&torus, &state.positions, &[]), "id,x,y\n0,0.5,7.75\n1,4,4\n");
//!
//! let state = csv::parse("x,y,strength\n1,2,1\n3,4,-0.5\n".as_bytes(), &torus).unwrap();
//! assert_eq!(state.strengths, Some(vec![1 << 20, -1 << 19]));
//!
//! let error = csv::parse("x,y\n4,8\n".as_bytes(), &torus).unwrap_err();
//! assert_eq!(error.to_string(), "line 2, column y: found `8`, expected a number of R0 in [0, 8)");
//! ```

use super::atomic::AtomicFile;
use super::identities::{Rows, coordinate, strength};
use super::lines::Lines;
use super::state::State;
use super::{FileError, FormatError, read_with};
use crate::strengths;
use csv_core::{Reader, ReaderBuilder, Terminator};
use meniscus_core::torus::{Position, Torus};
use std::io::BufRead;
use std::path::Path;

/// Where the columns are that count.
struct Columns {
    id: Option<usize>,
    x: usize,
    y: usize,
    strength: Option<usize>,
    /// How many there are in all.
    count: usize,
}

/// Reads the discs in the file at `path`, as a state at step 0 and time 0.
///
/// # Errors
/// [`FileError::Read`] naming the line and column.
pub fn read(path: &Path, torus: &Torus) -> Result<State, FileError> {
    read_with(path, |input| parse(input, torus))
}

/// Reads the discs in `input`, as a state at step 0 and time 0.
///
/// # Errors
/// [`FormatError`] for a missing column, a value that is none, an id missing or used twice.
pub fn parse(input: impl BufRead, torus: &Torus) -> Result<State, FormatError> {
    let mut lines = Lines::new(input);
    let mut columns = None;
    let mut rows = Rows::default();
    let mut values = Values::new();
    while let Some(text) = lines.next()? {
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        values.split(text);
        let line = lines.number();
        match &columns {
            None => columns = Some(Columns::named(line, &values)?),
            Some(columns) => columns.add_row(torus, line, &values, &mut rows)?,
        }
    }
    if columns.is_none() {
        return Err(FormatError::Whole {
            found: "no line with the names of the columns".to_owned(),
            expected: "id,x,y or x,y in the first line".to_owned(),
        });
    }
    rows.into_state()
}

/// The values in one line of text.
struct Values {
    reader: Reader,
    /// The values without their quotes, one behind the other.
    bytes: Vec<u8>,
    /// Where each of them ends.
    ends: Vec<usize>,
    count: usize,
}

impl Values {
    fn new() -> Self {
        // Lines are taken apart already: a carriage return within one is part of a value, so that nothing is lost.
        let reader = ReaderBuilder::new().terminator(Terminator::Any(b'\n')).build();
        Self { reader, bytes: Vec::new(), ends: Vec::new(), count: 0 }
    }

    /// Takes the values out of `text`, a line.
    fn split(&mut self, text: &str) {
        // Every line fits, so that the reader never stops before the end of one.
        let enough = self.bytes.len().max(text.len() + 1);
        self.bytes.resize(enough, 0);
        self.ends.resize(enough, 0);
        self.reader.reset();
        let (_, _, bytes, ends) = self.reader.read_record(text.as_bytes(), &mut self.bytes, &mut self.ends);
        // No more of it is the end of the last value.
        let (_, _, _, last) = self.reader.read_record(&[], &mut self.bytes[bytes..], &mut self.ends[ends..]);
        self.count = ends + last;
    }

    /// The value in `column` without blanks around it.
    fn get(&self, column: usize) -> Option<&[u8]> {
        let ends = self.ends.get(..self.count)?;
        let start = column.checked_sub(1).map_or(Some(0), |before| ends.get(before).copied())?;
        self.bytes.get(start..*ends.get(column)?).map(<[u8]>::trim_ascii)
    }
}

impl Columns {
    /// Finds the columns by the names in `values`.
    fn named(line: u64, values: &Values) -> Result<Self, FormatError> {
        let column = |name: &str| {
            let mut places = (0..values.count).filter(|&place| values.get(place) == Some(name.as_bytes()));
            let first = places.next();
            if places.next().is_some() {
                let found = format!("two columns {name}");
                return Err(FormatError::Line { line, found, expected: "one".to_owned() });
            }
            Ok(first)
        };
        let coordinate = |name| {
            column(name)?.ok_or_else(|| FormatError::Line {
                line,
                found: format!("no column {name}"),
                expected: "columns named x and y, and perhaps id".to_owned(),
            })
        };
        Ok(Self {
            id: column("id")?,
            x: coordinate("x")?,
            y: coordinate("y")?,
            strength: column("strength")?,
            count: values.count,
        })
    }

    /// Reads one row.
    fn add_row(&self, torus: &Torus, line: u64, values: &Values, rows: &mut Rows) -> Result<(), FormatError> {
        let value = |column: usize| {
            values.get(column).and_then(|value| std::str::from_utf8(value).ok()).ok_or_else(|| {
                FormatError::Line {
                    line,
                    found: format!("{} values", values.count),
                    expected: format!("at least {}, as the columns named", column + 1),
                }
            })
        };
        let position = Position {
            x: coordinate(torus, line, "x", value(self.x)?)?,
            y: coordinate(torus, line, "y", value(self.y)?)?,
        };
        let strength = self.strength.map(|column| strength(line, value(column)?)).transpose()?;
        if values.count > self.count {
            let (found, expected) = (values.count, self.count);
            let expected = format!("{expected}, as the columns named (decimals have a point)");
            return Err(FormatError::Line { line, found: format!("{found} values"), expected });
        }
        rows.push(line, self.id.map(value).transpose()?, position, strength)
    }
}

/// The discs as text: columns `id,x,y`, coordinates in R0 with digits that give the same bits again, and `strength`
/// (given in units of 2⁻²⁰, written as a number) if there are strengths and not all of them are 1.
#[must_use]
pub fn format(torus: &Torus, positions: &[Position], strengths: &[i32]) -> String {
    lines(torus, positions, strengths).collect()
}

/// The lines of that text, each with its end.
fn lines<'a>(
    torus: &'a Torus,
    positions: &'a [Position],
    strengths: &'a [i32],
) -> impl Iterator<Item = String> + 'a {
    let told = !strengths::all_one(strengths);
    let discs = positions.iter().enumerate().map(move |(id, position)| {
        let (x, y) = (torus.coordinate(position.x), torus.coordinate(position.y));
        match strengths.get(id) {
            Some(&strength) if told => format!("{id},{x},{y},{}\n", strengths::to_number(strength)),
            _ => format!("{id},{x},{y}\n"),
        }
    });
    std::iter::once((if told { "id,x,y,strength\n" } else { "id,x,y\n" }).to_owned()).chain(discs)
}

/// Writes the discs to the file at `path`, whole or not at all.
///
/// # Errors
/// [`FileError::Write`].
pub fn write(path: &Path, torus: &Torus, positions: &[Position], strengths: &[i32]) -> Result<(), FileError> {
    let mut file = AtomicFile::create(path)?;
    lines(torus, positions, strengths).try_for_each(|line| file.append(&line))?;
    file.finish()
}
