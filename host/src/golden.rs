//! Golden files: the length and digest of a run's state at chosen steps, with the configuration that gives them.
//!
//! A golden file is TOML: `format`, the `version` of Meniscus that minted it and the `reason`, the whole
//! `configuration` as text, and
//! `records`, each `[step, time, length, digest of the state, digest of x, digest of y]`, time in units of
//! 2⁻⁴⁰ R0²/D. Digests are SHA-256; those of x and y tell which part of a state differs.
//!
//! ```
//! use meniscus::golden::Golden;
//!
//! let mut golden = Golden::new("version = 1\n".into(), "an example");
//! let text = golden.to_toml();
//! assert_eq!(Golden::from_toml("golden.toml", &text)?.configuration, golden.configuration);
//! # Ok::<(), meniscus::golden::GoldenError>(())
//! ```

use crate::files::{FileError, atomic::write_atomically};
use meniscus_core::digest::StateDigest;
use meniscus_core::units::time_from_units;
use std::fmt;
use std::path::Path;
use thiserror::Error;
use toml_edit::{Array, DocumentMut, Item, Value, value};

/// The version of the layout that this program reads and writes.
const FORMAT: i64 = 1;

/// Why a golden file could not be read.
#[derive(Debug, Error)]
pub enum GoldenError {
    /// The file could not be opened or is no text.
    #[error("{file}: cannot be read: {source}")]
    Unreadable {
        /// The file.
        file: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is no TOML.
    #[error("{file}: not TOML: {reason}")]
    Syntax {
        /// The file.
        file: String,
        /// The parser's first line.
        reason: String,
    },
    /// A key is missing or holds something else than it should.
    #[error("{file}: {key}: expected {expected}")]
    Key {
        /// The file.
        file: String,
        /// The key.
        key: String,
        /// What is accepted.
        expected: &'static str,
    },
}

/// What a state was at one step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// Steps done.
    pub step: u64,
    /// Time, unit 2⁻⁴⁰ R0²/D.
    pub time: u64,
    /// Length of the canonical bytes.
    pub length: u64,
    /// SHA-256 of the canonical bytes, 64 hexadecimal digits.
    pub state: String,
    /// SHA-256 of the section that holds x.
    pub x: String,
    /// SHA-256 of the section that holds y.
    pub y: String,
}

impl From<StateDigest> for Record {
    fn from(digest: StateDigest) -> Self {
        Self {
            step: digest.step,
            time: digest.time,
            length: digest.state.length,
            state: digest.state.to_string(),
            x: digest.x.to_string(),
            y: digest.y.to_string(),
        }
    }
}

/// A difference between an expected and a found record, with the part that is to blame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Step of the record.
    pub step: u64,
    /// What differs.
    pub culprit: Culprit,
}

/// The first part of a state that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Culprit {
    /// The number of bytes: another layout, or another number of discs.
    Length(u64, u64),
    /// The time, unit 2⁻⁴⁰ R0²/D: another length of a step, by another force.
    Time(u64, u64),
    /// x alone, its digest expected and found.
    X(String, String),
    /// y alone.
    Y(String, String),
    /// Both coordinates; the digests of the state.
    Positions(String, String),
    /// What else is in the bytes: format version, step or capillary strengths.
    Header(String, String),
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let step = self.step;
        let (what_differs, expected, found) = match &self.culprit {
            Culprit::Length(expected, found) => {
                return write!(
                    formatter,
                    "step {step}: the length differs, so the encoding or the number of discs changed: \
                     expected {expected} bytes, found {found}"
                );
            }
            Culprit::Time(expected, found) => {
                return write!(
                    formatter,
                    "step {step}: the time differs: expected {} R0^2/D ({expected} * 2^-40), found {} ({found} * 2^-40)",
                    time_from_units(*expected),
                    time_from_units(*found)
                );
            }
            Culprit::X(expected, found) => ("x differs", expected, found),
            Culprit::Y(expected, found) => ("y differs", expected, found),
            Culprit::Positions(expected, found) => ("x and y differ", expected, found),
            Culprit::Header(expected, found) => ("the header or the strengths differ", expected, found),
        };
        write!(formatter, "step {step}: {what_differs}: expected {expected}, found {found}")
    }
}

impl Record {
    /// The difference of `found` from this record, if any.
    #[must_use]
    pub fn difference(&self, found: &Self) -> Option<Difference> {
        let pair = |expected: &String, found: &String| (expected.clone(), found.clone());
        let culprit = if self.length != found.length {
            Culprit::Length(self.length, found.length)
        } else if self.time != found.time {
            Culprit::Time(self.time, found.time)
        } else {
            let (digests, x, y) =
                (pair(&self.state, &found.state), pair(&self.x, &found.x), pair(&self.y, &found.y));
            match (self.x == found.x, self.y == found.y) {
                (false, false) => Culprit::Positions(digests.0, digests.1),
                (false, true) => Culprit::X(x.0, x.1),
                (true, false) => Culprit::Y(y.0, y.1),
                (true, true) if self.state != found.state => Culprit::Header(digests.0, digests.1),
                (true, true) => return None,
            }
        };
        Some(Difference { step: self.step, culprit })
    }
}

/// A run's records and what it was made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Golden {
    /// The version of Meniscus that minted it.
    pub version: String,
    /// Why it was minted.
    pub reason: String,
    /// The configuration, TOML.
    pub configuration: String,
    /// Records in the order of steps.
    pub records: Vec<Record>,
}

impl Golden {
    /// A golden file of this version of Meniscus without records.
    #[must_use]
    pub fn new(configuration: String, reason: &str) -> Self {
        let version = env!("CARGO_PKG_VERSION").into();
        Self { version, reason: reason.into(), configuration, records: Vec::new() }
    }

    /// Adds a record, unless the step has one already.
    pub fn record(&mut self, digest: StateDigest) {
        if self.records.last().is_none_or(|last| last.step != digest.step) {
            self.records.push(digest.into());
        }
    }

    /// The file's text.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut document = DocumentMut::new();
        document["format"] = value(FORMAT);
        document["version"] = value(self.version.clone());
        document["reason"] = value(self.reason.clone());
        document["configuration"] = Item::Value(literal(&self.configuration));
        let mut records = Array::new();
        for record in &self.records {
            let mut row = Array::new();
            row.push(as_value(record.step));
            row.push(as_value(record.time));
            row.push(as_value(record.length));
            row.extend([&record.state, &record.x, &record.y]);
            let mut row = Value::Array(row);
            row.decor_mut().set_prefix("\n  ");
            records.push_formatted(row);
        }
        records.set_trailing("\n");
        records.set_trailing_comma(true);
        document["records"] = value(records);
        format!(
            "# Golden run: step, time (2^-40 R0^2/D), length, SHA-256 of the state, of x, of y.\n\
             # Check it with: meniscus verify THIS_FILE\n{document}"
        )
    }

    /// Reads a file's text; `file` is its name in messages.
    ///
    /// # Errors
    /// A [`GoldenError`].
    pub fn from_toml(file: &str, text: &str) -> Result<Self, GoldenError> {
        let document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
            let reason = error.message().lines().next().unwrap_or_default().to_owned();
            GoldenError::Syntax { file: file.to_owned(), reason }
        })?;
        let wrong =
            |key: &str, expected| GoldenError::Key { file: file.to_owned(), key: key.to_owned(), expected };
        if document.get("format").and_then(Item::as_integer) != Some(FORMAT) {
            return Err(wrong("format", "1: this is no golden file, or one of another version"));
        }
        let text = |key: &str| {
            let found = document.get(key).and_then(Item::as_str).map(str::to_owned);
            found.ok_or_else(|| wrong(key, "a text"))
        };
        let rows =
            document.get("records").and_then(Item::as_array).ok_or_else(|| wrong("records", "an array"))?;
        let records = rows.iter().enumerate().map(|(index, row)| {
            let expected = "[step, time, length, digest of the state, of x, of y]";
            read_record(row).ok_or_else(|| wrong(&format!("records[{index}]"), expected))
        });
        let records: Vec<Record> = records.collect::<Result<_, _>>()?;
        if let Some(place) = records.array_windows().position(|[one, next]| one.step >= next.step) {
            return Err(wrong(
                &format!("records[{}]", place + 1),
                "a later step than that of the record before",
            ));
        }
        Ok(Self {
            version: text("version")?,
            reason: text("reason")?,
            configuration: text("configuration")?,
            records,
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A [`GoldenError`].
    pub fn read(path: &Path) -> Result<Self, GoldenError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|source| GoldenError::Unreadable { file: file.clone(), source })?;
        Self::from_toml(&file, &text)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// A [`FileError`]; the file is then as it was.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        write_atomically(path, self.to_toml().as_bytes())
    }
}

/// A text in as many lines as it has, where TOML allows it.
fn literal(text: &str) -> Value {
    if text.contains("'''") || text.contains('\r') {
        return Value::from(text);
    }
    format!("'''\n{text}'''").parse().unwrap_or_else(|_| Value::from(text))
}

/// TOML's integers are signed; times and steps stay below 2⁶³ for 8·10⁶ R0²/D.
fn as_value(number: u64) -> Value {
    i64::try_from(number).map_or_else(|_| Value::from(number.to_string()), Value::from)
}

fn read_record(row: &Value) -> Option<Record> {
    let row = row.as_array().filter(|row| row.len() == 6)?;
    let number = |index| match row.get(index)? {
        Value::Integer(number) => u64::try_from(*number.value()).ok(),
        Value::String(text) => text.value().parse().ok(),
        _ => None,
    };
    let text = |index| row.get(index)?.as_str().map(str::to_owned);
    Some(Record {
        step: number(0)?,
        time: number(1)?,
        length: number(2)?,
        state: text(3)?,
        x: text(4)?,
        y: text(5)?,
    })
}
