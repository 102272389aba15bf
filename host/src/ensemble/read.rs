//! A sweep's file: its keys and values, each with its place. What they mean together is decided in `sweep`.

use crate::configuration::keys::{TABLES, nearest, tolerance};
use crate::configuration::{
    ConfigurationError, Place, describe, file_text, line_and_column, preset, repeat, syntax_error,
};
use meniscus_core::parameters::LARGEST_SEED;
use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;
use toml_edit::{Document, Item, TableLike, Value};

use super::sweep::{LARGEST_COUNT, VERSION};

/// The keys of a sweep.
const KEYS: [&str; 6] = ["version", "preset", "configuration", "set", "seeds", "sweep"];
/// Keys of configurations that a sweep gives in its own way.
const OWN: [(&str, &str); 2] =
    [("seed", "give the seeds as `seeds`"), ("version", "the program writes that of its own format")];

const SEEDS: &str = "how many seeds, from 1 on, or an array of seeds";

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

    fn base(&self, table: &dyn TableLike, folder: &Path) -> Result<Base, ConfigurationError> {
        let text = |key: &str, expected: &str| match table.get(key) {
            None => Ok(None),
            Some(item) => match item.as_str() {
                Some(text) if !text.is_empty() => Ok(Some(text)),
                _ => Err(self.refused(self.place_of(table, key), key, describe(item), expected)),
            },
        };
        let name = text("preset", "the name of a preset, in quotes")?;
        let path = text("configuration", "the path of a configuration's file, in quotes")?;
        match (name, path) {
            (Some(name), None) => {
                preset(name).map_err(|error| self.unknown_preset(table, name, error))?;
                Ok(Base::Preset(name.to_owned()))
            }
            (None, Some(path)) => {
                let path = folder.join(path);
                Ok(Base::File { name: path.display().to_string(), text: file_text(&path)? })
            }
            (Some(_), Some(_)) => Err(ConfigurationError::Conflict {
                place: self.place_of(table, "configuration"),
                key: "configuration".to_owned(),
                reason: "together with `preset`: members begin with one of them".to_owned(),
            }),
            (None, None) => Err(self.missing(
                "`preset` (the name of a preset) or `configuration` (the path of a configuration's file)",
            )),
        }
    }

    fn unknown_preset(
        &self,
        table: &dyn TableLike,
        name: &str,
        error: ConfigurationError,
    ) -> ConfigurationError {
        let near = match error {
            ConfigurationError::UnknownPreset { nearest: Some(nearest), .. } => {
                format!(", such as \"{nearest}\"")
            }
            _ => String::new(),
        };
        let expected = format!("the name of a preset{near} (`meniscus presets` lists them)");
        self.refused(self.place_of(table, "preset"), "preset", format!("\"{name}\""), &expected)
    }

    fn set(&self, table: &dyn TableLike) -> Result<Vec<Override>, ConfigurationError> {
        let Some(item) = table.get("set") else { return Ok(Vec::new()) };
        let expected = "an array of key=value, such as [\"time.until=3\"]";
        let place = self.place_of(table, "set");
        let values = item.as_array().ok_or_else(|| self.refused(place, "set", describe(item), expected))?;
        let mut set: Vec<Override> = Vec::new();
        for value in values {
            let place = self.place(value.span());
            let refused = |found| self.refused(place.clone(), "set", found, expected);
            let text = value.as_str().ok_or_else(|| refused(describe(&Item::Value(value.clone()))))?;
            let key = text.split_once('=').map(|(key, _)| key.trim()).filter(|key| !key.is_empty());
            let key = key.ok_or_else(|| refused(format!("\"{text}\"")))?;
            self.refuse_own(&place, key)?;
            if set.iter().any(|earlier| earlier.key == key) {
                let reason = "twice in `set`: leave one of them out".to_owned();
                return Err(ConfigurationError::Conflict { place, key: key.to_owned(), reason });
            }
            set.push(Override { text: text.to_owned(), key: key.to_owned(), place });
        }
        Ok(set)
    }

    /// Refuses keys of configurations that are no matter of `set` and [sweep].
    fn refuse_own(&self, place: &Place, key: &str) -> Result<(), ConfigurationError> {
        match OWN.iter().find(|(own, _)| *own == key) {
            None => Ok(()),
            Some((_, remedy)) => Err(ConfigurationError::Conflict {
                place: place.clone(),
                key: key.to_owned(),
                reason: format!("here: {remedy}"),
            }),
        }
    }

    fn seeds(&self, table: &dyn TableLike) -> Result<Vec<u64>, ConfigurationError> {
        let item = table.get("seeds").ok_or_else(|| self.missing(&format!("`seeds` ({SEEDS})")))?;
        let refused = |place, found, expected: &str| Err(self.refused(place, "seeds", found, expected));
        if let Some(count) = item.as_integer() {
            return match u64::try_from(count) {
                Ok(count) if (1..=LARGEST_COUNT as u64).contains(&count) => Ok((1..=count).collect()),
                _ => {
                    let expected = format!("{SEEDS}; at most {LARGEST_COUNT}");
                    refused(self.place_of(table, "seeds"), repeat(item), &expected)
                }
            };
        }
        let Some(array) = item.as_array() else {
            return refused(self.place_of(table, "seeds"), describe(item), SEEDS);
        };
        if array.is_empty() {
            return refused(self.place_of(table, "seeds"), "an empty array".to_owned(), SEEDS);
        }
        let (mut seeds, mut seen) = (Vec::new(), HashSet::new());
        for value in array {
            let place = self.place(value.span());
            let seed = value.as_integer().and_then(|seed| u64::try_from(seed).ok());
            match seed.filter(|seed| *seed <= LARGEST_SEED) {
                Some(seed) if seen.insert(seed) => seeds.push(seed),
                Some(seed) => return refused(place, format!("{seed} twice"), "each seed once"),
                None => {
                    let expected = format!("whole numbers from 0 to {LARGEST_SEED} in the array");
                    return refused(place, describe(&Item::Value(value.clone())), &expected);
                }
            }
        }
        Ok(seeds)
    }

    fn axes(&self, table: &dyn TableLike, set: &[Override]) -> Result<Vec<Axis>, ConfigurationError> {
        let Some(item) = table.get("sweep") else { return Ok(Vec::new()) };
        let inside = item.as_table_like().ok_or_else(|| {
            let expected = "a table of keys of configurations, as under [sweep]";
            self.refused(self.place_of(table, "sweep"), "sweep", describe(item), expected)
        })?;
        let mut axes = Vec::new();
        self.visit("", inside, &mut axes)?;
        for (number, Axis { key, place, .. }) in axes.iter().enumerate() {
            let reason = if axes.iter().take(number).any(|earlier| earlier.key == *key) {
                "twice in [sweep]: leave one of them out"
            } else if set.iter().any(|one| one.key == *key) {
                "in [sweep] and in `set`: leave one of them out"
            } else {
                continue;
            };
            let (place, reason) = (place.clone(), reason.to_owned());
            return Err(ConfigurationError::Conflict { place, key: key.clone(), reason });
        }
        Ok(axes)
    }

    /// Takes every key of a table in [sweep]; dotted keys may be in quotes or not.
    fn visit(
        &self,
        path: &str,
        table: &dyn TableLike,
        axes: &mut Vec<Axis>,
    ) -> Result<(), ConfigurationError> {
        for (leaf, item) in table.iter() {
            let key = if path.is_empty() { leaf.to_owned() } else { format!("{path}.{leaf}") };
            if let (Some(inside), true) = (item.as_table_like(), !item.is_array()) {
                self.visit(&key, inside, axes)?;
                continue;
            }
            let place = self.place_of(table, leaf);
            self.refuse_own(&place, &key)?;
            axes.push(self.axis(key, place, item)?);
        }
        Ok(())
    }

    fn axis(&self, key: String, place: Place, item: &Item) -> Result<Axis, ConfigurationError> {
        let expected = "an array of values, such as [5, 10, 25]";
        let array = match item.as_array() {
            Some(array) if array.is_empty() => {
                return Err(self.refused(place, &key, "an empty array".to_owned(), expected));
            }
            Some(array) => array,
            None => return Err(self.refused(place, &key, describe(item), expected)),
        };
        let mut values: Vec<AxisValue> = Vec::new();
        for value in array {
            let value = AxisValue::of(value);
            if values.iter().any(|earlier| earlier.plain == value.plain) {
                return Err(self.refused(place, &key, format!("{} twice", value.plain), "each value once"));
            }
            values.push(value);
        }
        Ok(Axis { key, place, values })
    }
}

impl AxisValue {
    fn of(value: &Value) -> Self {
        let mut bare = value.clone();
        bare.decor_mut().clear();
        let toml = bare.to_string().trim().to_owned();
        let plain = match value {
            Value::String(text) => text.value().clone(),
            Value::Integer(number) => number.value().to_string(),
            Value::Float(number) => number.value().to_string(),
            _ => toml.clone(),
        };
        Self { toml, plain }
    }
}
