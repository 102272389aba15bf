//! Tables with named columns as comma-separated values: those that runs write, and those gathered over ensembles.
//!
//! The first line names the columns, no two alike; every other line has as many cells. A cell is text, a number, or
//! empty where a value does not exist. Numbers are written with the fewest digits that read back to the same bits.
//!
//! ```
//! use meniscus::files::table::Table;
//!
//! let text = "step,time,shape\n0,0,\n180,0.18,1.5\n";
//! let table = Table::parse(text.as_bytes())?;
//! assert_eq!(table.columns().collect::<Vec<_>>(), ["step", "time", "shape"]);
//! assert_eq!(table.numbers("shape")?, [None, Some(1.5)]);
//! assert_eq!(table.with("step", "180")?.numbers("time")?, [Some(0.18)]);
//!
//! let error = table.numbers("shpae").unwrap_err();
//! assert_eq!(error.to_string(), "found no column shpae, expected one of step, time, shape");
//! # Ok::<(), meniscus::files::FormatError>(())
//! ```

use super::error::quoted;
use super::{FileError, FormatError, read_with};
use ::csv::{ErrorKind, ReaderBuilder, StringRecord, Terminator, WriterBuilder};
use std::io::Read;
use std::path::Path;

/// A table in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: StringRecord,
    rows: Vec<StringRecord>,
}

impl Table {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`FileError::Read`] as [`Table::parse`], or if the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        read_with(path, Self::parse)
    }

    /// Reads `input`.
    ///
    /// # Errors
    /// [`FormatError`] if there is no line of names, if a name is there twice, if a row has more or fewer cells, or if the
    /// text is not UTF-8.
    pub fn parse(input: impl Read) -> Result<Self, FormatError> {
        let mut reader = ReaderBuilder::new().from_reader(input);
        let columns = reader.headers().map_err(refused)?.clone();
        if columns.is_empty() {
            let (found, expected) =
                ("no line".to_owned(), "the names of the columns in the first".to_owned());
            return Err(FormatError::Whole { found, expected });
        }
        for (place, name) in columns.iter().enumerate() {
            if columns.iter().take(place).any(|earlier| earlier == name) {
                let found = format!("two columns {}", quoted(name));
                return Err(FormatError::Line { line: 1, found, expected: "one".to_owned() });
            }
        }
        let rows = reader.into_records().collect::<Result<_, _>>().map_err(refused)?;
        Ok(Self { columns, rows })
    }

    /// The names of the columns.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.columns.iter()
    }

    /// How many columns there are.
    #[must_use]
    pub fn width(&self) -> usize {
        self.columns.len()
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of the column called `name`, from 0.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    /// The text in a row and a column, both from 0; empty if there is none.
    #[must_use]
    pub fn cell(&self, row: usize, column: usize) -> &str {
        self.rows.get(row).and_then(|cells| cells.get(column)).unwrap_or_default()
    }

    /// The number in a row and a column, both from 0; None for an empty cell.
    ///
    /// # Errors
    /// [`FormatError::Line`] if it is no finite number.
    pub fn number(&self, row: usize, column: usize) -> Result<Option<f64>, FormatError> {
        let text = self.cell(row, column);
        if text.is_empty() {
            return Ok(None);
        }
        match text.parse() {
            Ok(number) if f64::is_finite(number) => Ok(Some(number)),
            _ => Err(FormatError::Line {
                line: self.line(row),
                found: quoted(text),
                expected: format!("a number in column {}", self.columns.get(column).unwrap_or_default()),
            }),
        }
    }

    /// All cells of the column called `name`.
    ///
    /// # Errors
    /// [`FormatError::Whole`] if there is no such column.
    pub fn text(&self, name: &str) -> Result<Vec<&str>, FormatError> {
        let column = self.require(name)?;
        Ok((0..self.len()).map(|row| self.cell(row, column)).collect())
    }

    /// All numbers of the column called `name`, None for empty cells.
    ///
    /// # Errors
    /// [`FormatError`] if there is no such column, or something else than a number in it.
    pub fn numbers(&self, name: &str) -> Result<Vec<Option<f64>>, FormatError> {
        let column = self.require(name)?;
        (0..self.len()).map(|row| self.number(row, column)).collect()
    }

    /// The rows that have `text` in the column called `name`.
    ///
    /// # Errors
    /// [`FormatError::Whole`] if there is no such column.
    pub fn with(&self, name: &str, text: &str) -> Result<Self, FormatError> {
        let column = self.require(name)?;
        let rows = self.rows.iter().filter(|cells| cells.get(column) == Some(text)).cloned().collect();
        Ok(Self { columns: self.columns.clone(), rows })
    }

    /// What stands in the column called `name`, each text once, in the order in which they come first.
    ///
    /// # Errors
    /// [`FormatError::Whole`] if there is no such column.
    pub fn distinct(&self, name: &str) -> Result<Vec<&str>, FormatError> {
        let mut seen = std::collections::HashSet::new();
        Ok(self.text(name)?.into_iter().filter(|text| seen.insert(*text)).collect())
    }

    /// Number of a row's line in the file, from 1.
    #[must_use]
    pub fn line(&self, row: usize) -> u64 {
        self.rows.get(row).and_then(StringRecord::position).map_or(0, ::csv::Position::line)
    }

    fn require(&self, name: &str) -> Result<usize, FormatError> {
        self.column(name).ok_or_else(|| FormatError::Whole {
            found: format!("no column {name}"),
            expected: format!("one of {}", self.columns().collect::<Vec<_>>().join(", ")),
        })
    }
}

/// A table as it is written, row by row.
#[derive(Debug)]
pub struct TableText(::csv::Writer<Vec<u8>>);

impl TableText {
    /// A table with these columns and no row.
    #[must_use]
    pub fn new<T: AsRef<[u8]>>(columns: impl IntoIterator<Item = T>) -> Self {
        let terminator = Terminator::Any(b'\n');
        let mut text =
            Self(WriterBuilder::new().terminator(terminator).flexible(true).from_writer(Vec::new()));
        text.row(columns);
        text
    }

    /// Appends a row, which is to have as many cells as there are columns.
    pub fn row<T: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = T>) {
        // Writing to memory cannot fail.
        let _ = self.0.write_record(cells);
    }

    /// The text.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.0.into_inner().unwrap_or_default()
    }
}

/// What the reader of comma-separated values complains of.
fn refused(error: ::csv::Error) -> FormatError {
    let line = error.position().map_or(1, ::csv::Position::line);
    match error.into_kind() {
        ErrorKind::Io(source) => FormatError::Input(source),
        ErrorKind::UnequalLengths { expected_len, len, .. } => FormatError::Line {
            line,
            found: format!("{len} cells"),
            expected: format!("{expected_len}, as many as there are columns"),
        },
        ErrorKind::Utf8 { .. } => {
            let (found, expected) = ("bytes that are no text".to_owned(), "text in UTF-8".to_owned());
            FormatError::Line { line, found, expected }
        }
        other => {
            FormatError::Line { line, found: format!("{other:?}"), expected: "a row of cells".to_owned() }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table, String> {
        Table::parse(text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut text = TableText::new(["key", "x"]);
        text.row(["a, \"b\"", "1"]);
        text.row(["", "2.5"]);
        let bytes = text.into_bytes();
        assert_eq!(bytes, b"key,x\n\"a, \"\"b\"\"\",1\n,2.5\n");
        let table = Table::parse(&bytes[..]).unwrap();
        assert_eq!(table.text("key").unwrap(), ["a, \"b\"", ""]);
        assert_eq!(table.numbers("x").unwrap(), [Some(1.0), Some(2.5)]);
        assert_eq!(table.distinct("key").unwrap(), ["a, \"b\"", ""]);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        assert_eq!(parse("").unwrap_err(), "found no line, expected the names of the columns in the first");
        assert_eq!(parse("a,b,a\n").unwrap_err(), "line 1: found two columns `a`, expected one");
        assert_eq!(
            parse("a,b\n1,2\n3\n").unwrap_err(),
            "line 3: found 1 cells, expected 2, as many as there are columns"
        );
        let table = parse("a,b\n1,2\n3,x\n4,inf\n").unwrap();
        let errors = [1, 2].map(|row| table.number(row, 1).unwrap_err().to_string());
        assert_eq!(errors[0], "line 3: found `x`, expected a number in column b");
        assert_eq!(errors[1], "line 4: found `inf`, expected a number in column b");
        assert!(Table::parse(&b"a\n\xff\n"[..]).unwrap_err().to_string().starts_with("line 2: found bytes"));
    }
}
