//! A sweep: which configurations an ensemble has, seeds times every combination of values.

use super::SWEEP;
use super::error::EnsembleError;
use super::member::{Member, Setting, describe, hash};
use super::read::{self, Axis, Base, Given};
use crate::configuration::{Configuration, ConfigurationError, Place, file_text, preset};
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::Path;
use toml_edit::{Array, DocumentMut, Item, Table, Value, value};

/// The version of the format of sweeps that this program reads and writes.
pub const VERSION: i64 = 1;

/// Most members of an ensemble.
pub const LARGEST_COUNT: usize = 100_000;

/// Name under which an ensemble keeps the configuration of a file that its members begin with.
pub(super) const CONFIGURATION: &str = "configuration.toml";

/// A sweep with all its members, each configuration checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    given: Given,
    members: Vec<Member>,
}

impl Sweep {
    /// Reads a sweep's file.
    ///
    /// # Errors
    /// [`EnsembleError`] that says in one line what is wrong where, in the file or in a member's configuration.
    pub fn read(path: &Path) -> Result<Self, EnsembleError> {
        let text = file_text(path)?;
        Self::from_text(&path.display().to_string(), &text, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a text, called `name` in messages; the path of a configuration in it is relative to `folder`.
    ///
    /// # Errors
    /// As [`Sweep::read`].
    pub fn from_text(name: &str, text: &str, folder: &Path) -> Result<Self, EnsembleError> {
        let given = read::read(name, text, folder)?;
        let members = members(&given)?;
        Ok(Self { given, members })
    }

    /// The sweep of the ensemble in `directory`.
    ///
    /// # Errors
    /// [`EnsembleError::NoSweep`], otherwise as [`Sweep::read`].
    pub fn of(directory: &Path) -> Result<Self, EnsembleError> {
        let path = directory.join(SWEEP);
        if path.exists() { Self::read(&path) } else { Err(EnsembleError::NoSweep(directory.to_owned())) }
    }

    /// All members in the order of their numbers: seeds count fastest, then the last swept key.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The swept keys, in the order of the sweep.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = &str> {
        self.given.axes.iter().map(|axis| axis.key.as_str())
    }

    /// The members that differ in their seeds alone, one slice for each combination of swept values.
    pub fn combinations(&self) -> impl ExactSizeIterator<Item = &[Member]> {
        self.members.chunks(self.given.seeds.len().max(1))
    }

    /// The sweep as TOML, a configuration's file being called `configuration.toml`: it reads back to equal members
    /// beside [`Sweep::configuration`] under that name.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut document = DocumentMut::new();
        document.insert("version", value(VERSION));
        match &self.given.base {
            Base::Preset(name) => document.insert("preset", value(name)),
            Base::File { .. } => document.insert("configuration", value(CONFIGURATION)),
        };
        let set: Array = self.given.set.iter().map(|one| one.text.as_str()).collect();
        document.insert("set", value(set));
        // TOML's whole numbers are those of i64, as seeds are.
        let seeds: Array =
            self.given.seeds.iter().map(|&seed| i64::try_from(seed).unwrap_or(i64::MAX)).collect();
        document.insert("seeds", value(seeds));
        let mut sweep = Table::new();
        for Axis { key, values, .. } in &self.given.axes {
            // What was read is TOML.
            let values: Array = values.iter().filter_map(|one| one.toml.parse::<Value>().ok()).collect();
            sweep.insert(key, value(values));
        }
        document.insert("sweep", Item::Table(sweep));
        document.to_string()
    }

    /// What is in the file of the configuration that members begin with; None if they begin with a preset.
    #[must_use]
    pub fn configuration(&self) -> Option<&str> {
        match &self.given.base {
            Base::Preset(_) => None,
            Base::File { text, .. } => Some(text),
        }
    }
}

/// Every member, its configuration read and checked.
fn members(given: &Given) -> Result<Vec<Member>, EnsembleError> {
    let mut combinations: usize = 1;
    for axis in &given.axes {
        combinations = combinations.saturating_mul(axis.values.len());
    }
    let count = combinations.saturating_mul(given.seeds.len());
    if count > LARGEST_COUNT {
        return Err(EnsembleError::Sweep(ConfigurationError::Value {
            place: given.whole.clone(),
            key: "sweep".to_owned(),
            found: format!("{count} members"),
            expected: format!("at most {LARGEST_COUNT}: leave out seeds or values"),
        }));
    }
    // Reading is slow where a scheme has to be chosen, and the first in order that is refused is told.
    let read: Vec<_> = (0..combinations).into_par_iter().map(|number| combination(given, number)).collect();
    let read = read.into_iter().collect::<Result<Vec<_>, _>>()?;
    refuse_same(given, &read)?;
    let seeds = given.seeds.len();
    let member = |number: usize| {
        let (settings, configuration) = &read[number / seeds];
        let seed = given.seeds[number % seeds];
        // Nothing else of a configuration hangs on its seed.
        let configuration = Configuration { seed, ..configuration.clone() };
        let hash = hash(&configuration);
        Member { index: number + 1, seed, settings: settings.clone(), configuration, hash }
    };
    Ok((0..count).into_par_iter().map(member).collect())
}

/// The swept values of the combination of this number, the last key counting fastest, and the configuration.
fn combination(given: &Given, number: usize) -> Result<(Vec<Setting>, Configuration), EnsembleError> {
    let mut rest = number;
    let mut chosen = Vec::with_capacity(given.axes.len());
    for axis in given.axes.iter().rev() {
        chosen.push((axis, &axis.values[rest % axis.values.len()]));
        rest /= axis.values.len();
    }
    chosen.reverse();
    let set = given.set.iter().map(|one| one.text.clone());
    let swept = chosen.iter().map(|(axis, value)| format!("{}={}", axis.key, value.toml));
    let overrides: Vec<String> = set.chain(swept).collect();
    let settings: Vec<Setting> = chosen
        .iter()
        .map(|(axis, value)| Setting { key: axis.key.clone(), value: value.plain.clone() })
        .collect();
    let read = match &given.base {
        Base::Preset(name) => preset(name)
            .and_then(|preset| Configuration::from_text(&format!("preset {name}"), preset.text, &overrides)),
        Base::File { name, text } => Configuration::from_text(name, text, &overrides),
    };
    match read {
        Ok(configuration) => Ok((settings, configuration)),
        Err(error) => {
            let source = located(error, given);
            if settings.is_empty() {
                return Err(source.into());
            }
            Err(EnsembleError::Member { source: Box::new(source), settings: describe(&settings) })
        }
    }
}

/// The error with the place in the sweep's file where it would be one of an override.
fn located(mut error: ConfigurationError, given: &Given) -> ConfigurationError {
    use ConfigurationError::{Accuracy, Conflict, UnknownKey, Value};
    let find = |key: &str| {
        let swept = given.axes.iter().find(|axis| axis.key == key).map(|axis| &axis.place);
        swept.or_else(|| given.set.iter().find(|one| one.key == key).map(|one| &one.place))
    };
    let found = match &error {
        Value { key, .. } | UnknownKey { key, .. } | Conflict { key, .. } => find(key),
        Accuracy { .. } => find("force.accuracy"),
        _ => None,
    };
    let place_in_sweep = found.unwrap_or(&given.whole).clone();
    match &mut error {
        Value { place, .. } | UnknownKey { place, .. } | Conflict { place, .. } | Accuracy { place, .. }
            if *place == Place::Override =>
        {
            *place = place_in_sweep;
        }
        _ => {}
    }
    error
}

/// Refuses combinations that give the same run.
fn refuse_same(given: &Given, read: &[(Vec<Setting>, Configuration)]) -> Result<(), EnsembleError> {
    let texts: Vec<String> = read.par_iter().map(|(_, configuration)| configuration.to_toml()).collect();
    let mut first = HashMap::new();
    for (number, text) in texts.iter().enumerate() {
        if let Some(earlier) = first.insert(text, number) {
            let place = given.axes.first().map_or(&given.whole, |axis| &axis.place).clone();
            let settings = [earlier, number].map(|number| describe(&read[number].0));
            return Err(EnsembleError::Same { place, settings });
        }
    }
    Ok(())
}
