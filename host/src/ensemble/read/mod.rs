//! A sweep's file: its keys and values, each with its place, one file here for each kind of key. What they mean together
//! is decided in `sweep`.

mod axes;
mod base;
mod seeds;

use super::sweep::VERSION;
use crate::configuration::keys::{TABLES, nearest, tolerance};
use crate::configuration::{ConfigurationError, Place, describe, line_and_column, syntax_error};
use std::ops::Range;
use std::path::Path;
use toml_edit::{Document, Item, TableLike};

/// The keys of a sweep.
const KEYS: [&str; 6] = ["version", "preset", "configuration", "set", "seeds", "sweep"];

/// What every member begins with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Base {
    /// A preset, by its name.
    Preset(String),
    /// A configuration's file.
    File {
        /// Its path as a message names it.
        name: String,
        /// What is in it.
        text: String,
    },
}

/// An override of every member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Override {
    pub text: String,
    pub key: String,
    pub place: Place,
}

/// A swept key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Axis {
    pub key: String,
    pub place: Place,
    pub values: Vec<AxisValue>,
}

/// A value of a swept key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AxisValue {
    /// As TOML.
    pub toml: String,
    /// As a table shows it.
    pub plain: String,
}

/// All that a sweep's file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Given {
    pub whole: Place,
    pub base: Base,
    pub set: Vec<Override>,
    pub seeds: Vec<u64>,
    pub axes: Vec<Axis>,
}

/// A text with its name in messages.
struct Source<'a> {
    name: &'a str,
    text: &'a str,
}

/// Reads `text`, called `name` in messages, in which paths are relative to `folder`.
pub(super) fn read(name: &str, text: &str, folder: &Path) -> Result<Given, ConfigurationError> {
    let document = Document::parse(text).map_err(|error| syntax_error(name, text, &error))?;
    let (source, table) = (Source { name, text }, document.as_table());
    for (key, item) in table.iter() {
        if !KEYS.contains(&key) {
            return Err(source.unknown(table, key, item));
        }
    }
    source.version(table)?;
    let base = source.base(table, folder)?;
    let set = source.set(table)?;
    let seeds = source.seeds(table)?;
    let axes = source.axes(table, &set)?;
    Ok(Given { whole: source.whole(), base, set, seeds, axes })
}

impl Source<'_> {
    fn whole(&self) -> Place {
        Place::Whole { name: self.name.to_owned() }
    }

    fn place(&self, span: Option<Range<usize>>) -> Place {
        let line = span.map_or(1, |span| line_and_column(self.text, span.start).0);
        Place::File { name: self.name.to_owned(), line }
    }

    fn place_of(&self, table: &dyn TableLike, key: &str) -> Place {
        let item = || table.get(key).and_then(Item::span);
        self.place(table.key(key).and_then(toml_edit::Key::span).or_else(item))
    }

    fn unknown(&self, table: &dyn TableLike, key: &str, item: &Item) -> ConfigurationError {
        let place = self.place_of(table, key);
        if TABLES.iter().any(|table| table.name == key) {
            let reason = "in a sweep: it belongs to configurations; give one value for all members in `set`, such as \
                          set = [\"time.until=3\"], several in [sweep]";
            return ConfigurationError::Conflict { place, key: key.to_owned(), reason: reason.to_owned() };
        }
        let found = if item.is_table_like() { nearest(key, ["sweep"], tolerance(key)) } else { None };
        let nearest = found.or_else(|| nearest(key, KEYS, tolerance(key))).map(str::to_owned);
        ConfigurationError::UnknownKey { place, key: key.to_owned(), nearest }
    }

    fn refused(&self, place: Place, key: &str, found: String, expected: &str) -> ConfigurationError {
        ConfigurationError::Value { place, key: key.to_owned(), found, expected: expected.to_owned() }
    }

    fn missing(&self, keys: &str) -> ConfigurationError {
        ConfigurationError::Missing { place: self.whole(), keys: keys.to_owned() }
    }

    fn version(&self, table: &dyn TableLike) -> Result<(), ConfigurationError> {
        let item =
            table.get("version").ok_or_else(|| self.missing("`version` (version of this format: 1)"))?;
        match item.as_integer() {
            Some(VERSION) => Ok(()),
            _ => Err(self.refused(self.place_of(table, "version"), "version", describe(item), "1")),
        }
    }
}
