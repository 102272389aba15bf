//! From TOML to checked values by key, each with its place.
//!
//! In: text and overrides. Out: [`Entries`], in which every key is known and every value is of the
//! kind that [`KEYS`](super::keys::KEYS) asks for. What keys mean together is decided in `assemble`.

use std::collections::BTreeMap;
use std::ops::Range;

use toml_edit::{Document, Item, TableLike, TomlError, Value};

use super::error::{ConfigurationError, Place};
use super::keys::{Key, Kind, TABLES, key, nearest_key, nearest_table};

/// A value of the kind its key asks for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Checked {
    /// Of [`Kind::Whole`] and [`Kind::PowerOfTwo`].
    Whole(u64),
    /// Of [`Kind::Real`].
    Real(f64),
    /// Of [`Kind::Pair`].
    Pair([f64; 2]),
    /// Of [`Kind::Numbers`].
    Numbers(Vec<f64>),
    /// Of [`Kind::Boolean`].
    Boolean(bool),
    /// Of [`Kind::Choice`] and [`Kind::Path`].
    Text(String),
}

/// Checked values by dotted key, with their places.
#[derive(Debug)]
pub(super) struct Entries {
    name: String,
    values: BTreeMap<&'static str, (Checked, Place)>,
    tables: BTreeMap<&'static str, Place>,
}

impl Entries {
    /// Reads `text`, called `name` in messages, then the overrides in their order.
    pub(super) fn read(name: &str, text: &str, overrides: &[String]) -> Result<Self, ConfigurationError> {
        let mut entries = Self { name: name.to_owned(), values: BTreeMap::new(), tables: BTreeMap::new() };
        let document = Document::parse(text).map_err(|error| syntax_error(name, text, &error))?;
        entries.visit_table("", document.as_table(), &|span| Place::File {
            name: name.to_owned(),
            line: span.map_or(1, |span| line_and_column(text, span.start).0),
        })?;
        for text in overrides {
            entries.set(text)?;
        }
        Ok(entries)
    }

    /// The name of the whole text as a place.
    pub(super) fn whole(&self) -> Place {
        Place::Whole { name: self.name.clone() }
    }

    /// Where a key was given, or the whole text for a default.
    pub(super) fn place(&self, name: &str) -> Place {
        self.values.get(name).map_or_else(|| self.whole(), |(_, place)| place.clone())
    }

    /// Where a table was first given.
    pub(super) fn table(&self, name: &str) -> Option<&Place> {
        self.tables.get(name)
    }

    /// Whether a key was given.
    pub(super) fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// Whether a key was given on the command line.
    pub(super) fn is_override(&self, name: &str) -> bool {
        self.place(name) == Place::Override
    }

    /// Forgets a key.
    pub(super) fn forget(&mut self, name: &str) {
        self.values.remove(name);
    }

    /// The whole number of a key, if given.
    pub(super) fn integer(&self, name: &str) -> Option<u64> {
        match self.values.get(name) {
            Some((Checked::Whole(value), _)) => Some(*value),
            _ => None,
        }
    }

    /// The number of a key, if given.
    pub(super) fn real(&self, name: &str) -> Option<f64> {
        match self.values.get(name) {
            Some((Checked::Real(value), _)) => Some(*value),
            _ => None,
        }
    }

    /// The two numbers of a key, if given.
    pub(super) fn pair(&self, name: &str) -> Option<[f64; 2]> {
        match self.values.get(name) {
            Some((Checked::Pair(value), _)) => Some(*value),
            _ => None,
        }
    }

    /// The numbers of a key, if given.
    pub(super) fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.values.get(name) {
            Some((Checked::Numbers(values), _)) => Some(values),
            _ => None,
        }
    }

    /// The truth of a key, if given.
    pub(super) fn boolean(&self, name: &str) -> Option<bool> {
        match self.values.get(name) {
            Some((Checked::Boolean(value), _)) => Some(*value),
            _ => None,
        }
    }

    /// The text of a key, if given.
    pub(super) fn text(&self, name: &str) -> Option<&str> {
        match self.values.get(name) {
            Some((Checked::Text(value), _)) => Some(value),
            _ => None,
        }
    }

    /// Takes one `key=value`.
    fn set(&mut self, text: &str) -> Result<(), ConfigurationError> {
        let (name, value) = text
            .split_once('=')
            .map(|(name, value)| (name.trim(), value.trim()))
            .filter(|(name, _)| !name.is_empty())
            .ok_or_else(|| ConfigurationError::Override { text: text.to_owned() })?;
        let value = match value.parse::<Value>() {
            Ok(value) => value,
            Err(_) if !value.starts_with(['"', '\'', '[', '{']) => Value::from(value),
            Err(_) => {
                return Err(ConfigurationError::Value {
                    place: Place::Override,
                    key: name.to_owned(),
                    found: value.to_owned(),
                    expected: "a TOML value with its quotes and brackets closed".to_owned(),
                });
            }
        };
        self.visit(name.to_owned(), &Item::Value(value), Place::Override, &|_| Place::Override)
    }

    /// Takes every key of a table whose dotted name is `path`.
    fn visit_table(
        &mut self,
        path: &str,
        table: &dyn TableLike,
        place_of: &dyn Fn(Option<Range<usize>>) -> Place,
    ) -> Result<(), ConfigurationError> {
        for (leaf, item) in table.iter() {
            let place = place_of(table.key(leaf).and_then(toml_edit::Key::span).or_else(|| item.span()));
            // A quoted key with a dot in it is one name, not a path.
            let leaf = if leaf.contains('.') { format!("{leaf:?}") } else { leaf.to_owned() };
            let name = if path.is_empty() { leaf } else { format!("{path}.{leaf}") };
            self.visit(name, item, place, place_of)?;
        }
        Ok(())
    }

    /// Takes one item whose dotted name is `name`.
    fn visit(
        &mut self,
        name: String,
        item: &Item,
        place: Place,
        place_of: &dyn Fn(Option<Range<usize>>) -> Place,
    ) -> Result<(), ConfigurationError> {
        if let Some(key) = key(&name) {
            let refuse = |(found, expected)| ConfigurationError::Value {
                place: place.clone(),
                key: name.clone(),
                found,
                expected,
            };
            let value = check(key, item).map_err(refuse)?;
            if let Some(table) = TABLES.iter().find(|table| table.name == key.table()) {
                self.tables.entry(table.name).or_insert_with(|| place.clone());
            }
            self.values.insert(key.name, (value, place));
            return Ok(());
        }
        let Some(table) = TABLES.iter().find(|table| table.name == name) else {
            let nearest = if item.is_table_like() { nearest_table(&name) } else { nearest_key(&name) };
            let nearest = nearest.map(str::to_owned);
            return Err(ConfigurationError::UnknownKey { place, key: name, nearest });
        };
        let Some(inside) = item.as_table_like() else {
            let (found, expected) = (describe(item), format!("a table of keys, as under [{name}]"));
            return Err(ConfigurationError::Value { place, key: name, found, expected });
        };
        self.tables.entry(table.name).or_insert(place);
        self.visit_table(table.name, inside, place_of)
    }
}

/// The value of an item if its key accepts it, else what was found and what is accepted.
fn check(key: &Key, item: &Item) -> Result<Checked, (String, String)> {
    let mistyped = || (describe(item), key.accepted());
    let out_of_range = || (repeat(item), key.accepted());
    match key.kind {
        Kind::Whole { least, most } => {
            let value = whole(key, item)?;
            u64::try_from(value)
                .ok()
                .filter(|value| (least..=most).contains(value))
                .map(Checked::Whole)
                .ok_or_else(out_of_range)
        }
        Kind::PowerOfTwo { least, most } => {
            let value = whole(key, item)?;
            u64::try_from(value)
                .ok()
                .filter(|value| (least..=most).contains(value) && value.is_power_of_two())
                .map(Checked::Whole)
                .ok_or_else(out_of_range)
        }
        Kind::Real { least, closed, most, infinite } => {
            let value = number(item).ok_or_else(mistyped)?;
            let above = if closed { value >= least } else { value > least };
            let accepted = above && value <= most && (value.is_finite() || infinite);
            // The sum turns −0 into 0.
            if accepted { Ok(Checked::Real(value + 0.0)) } else { Err(out_of_range()) }
        }
        Kind::Pair { least, most } => match numbers(key, item, least, most)?[..] {
            [x, y] => Ok(Checked::Pair([x, y])),
            ref others => Err((format!("an array of {} numbers", others.len()), key.accepted())),
        },
        Kind::Numbers { least, most } => match numbers(key, item, least, most)? {
            values if values.is_empty() => Err(("an empty array".to_owned(), key.accepted())),
            values => Ok(Checked::Numbers(values)),
        },
        Kind::Boolean => item.as_bool().map(Checked::Boolean).ok_or_else(mistyped),
        Kind::Choice(words) => {
            let word = item.as_str().ok_or_else(mistyped)?;
            if words.contains(&word) { Ok(Checked::Text(word.to_owned())) } else { Err(out_of_range()) }
        }
        Kind::Path => match item.as_str().ok_or_else(mistyped)? {
            "" => Err(out_of_range()),
            path => Ok(Checked::Text(path.to_owned())),
        },
    }
}

/// The number of an item, whole or not.
fn number(item: &Item) -> Option<f64> {
    item.as_integer().map(|value| value as f64).or_else(|| item.as_float())
}

/// The numbers of an array, each from `least` to `most`.
fn numbers(key: &Key, item: &Item, least: f64, most: f64) -> Result<Vec<f64>, (String, String)> {
    let array = item.as_array().ok_or_else(|| (describe(item), key.accepted()))?;
    let element = |value: &Value| {
        let item = Item::Value(value.clone());
        match number(&item) {
            // The sum turns -0 into 0.
            Some(number) if number >= least && number <= most => Ok(number + 0.0),
            Some(_) => Err((format!("{} in the array", repeat(&item)), key.accepted())),
            None => Err((format!("{} in the array", describe(&item)), key.accepted())),
        }
    };
    array.iter().map(element).collect()
}

/// The whole number of an item.
fn whole(key: &Key, item: &Item) -> Result<i64, (String, String)> {
    item.as_integer().ok_or_else(|| {
        let accepted = key.accepted();
        let expected =
            if item.is_float() { format!("{accepted}, written without a decimal point") } else { accepted };
        (describe(item), expected)
    })
}

/// A value as its user would write it.
pub(crate) fn repeat(item: &Item) -> String {
    match item {
        Item::Value(Value::String(text)) => format!("\"{}\"", text.value()),
        Item::Value(Value::Integer(number)) => number.value().to_string(),
        Item::Value(Value::Float(number)) if number.value().is_nan() => "nan".to_owned(),
        Item::Value(Value::Float(number)) => format!("{:?}", number.value()),
        Item::Value(Value::Boolean(truth)) => truth.value().to_string(),
        Item::Value(Value::Datetime(date)) => date.value().to_string(),
        Item::Value(Value::Array(_)) | Item::ArrayOfTables(_) => "an array".to_owned(),
        Item::Value(Value::InlineTable(_)) | Item::Table(_) => "a table".to_owned(),
        Item::None => "nothing".to_owned(),
    }
}

/// A value with its type.
pub(crate) fn describe(item: &Item) -> String {
    let kind = match item {
        Item::Value(Value::String(_)) => "string",
        Item::Value(Value::Integer(_)) => "whole number",
        Item::Value(Value::Float(_)) => "decimal number",
        Item::Value(Value::Boolean(_)) => "boolean",
        Item::Value(Value::Datetime(_)) => "date or time",
        _ => return repeat(item),
    };
    format!("{} ({kind})", repeat(item))
}

/// The parser's complaint with its place.
pub(crate) fn syntax_error(name: &str, text: &str, error: &TomlError) -> ConfigurationError {
    let start = error.span().map_or(text.len(), |span| span.start);
    let (line, column) = line_and_column(text, start);
    let piece = error.span().and_then(|span| text.get(span)).unwrap_or_default();
    let reason = match error.message() {
        "duplicate key" => format!("duplicate key `{piece}`"),
        "integer number overflowed" => {
            format!("{piece} is beyond the whole numbers of TOML, which end at {}", i64::MAX)
        }
        message => message.split('\n').collect::<Vec<_>>().join(", "),
    };
    ConfigurationError::Syntax { file: name.to_owned(), line, column, reason }
}

/// Line and column, both from 1, of a byte of a text; columns are counted in characters.
pub(crate) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let mut before = text.len().min(byte);
    while !text.is_char_boundary(before) {
        before -= 1;
    }
    let before = &text[..before];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
