//! A member of an ensemble: one run, and where it is kept.

use crate::configuration::Configuration;
use sha2::{Digest as _, Sha256};
use std::path::{Path, PathBuf};

/// Folder of the members' run directories in the directory of an ensemble.
pub const RUNS: &str = "runs";

/// Digits of a hash that name a run's directory.
const HASH_DIGITS: usize = 16;

/// A swept key with one of its values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Dotted key of the configuration.
    pub key: String,
    /// Its value as a table shows it: a number with the fewest digits, a word without quotes.
    pub value: String,
}

/// One run of an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Its number, from 1: seeds count fastest, then the last swept key.
    pub index: usize,
    /// Its seed.
    pub seed: u64,
    /// The swept keys with its values, in the order of the sweep.
    pub settings: Vec<Setting>,
    /// Its configuration.
    pub configuration: Configuration,
    /// First 16 hexadecimal digits of SHA-256 of the program's version, an end of line, and the complete configuration.
    pub hash: String,
}

impl Member {
    /// The member's run directory in the directory of its ensemble.
    #[must_use]
    pub fn directory(&self, ensemble: &Path) -> PathBuf {
        ensemble.join(RUNS).join(&self.hash)
    }

    /// The value of a swept key, if it is one.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<&str> {
        self.settings.iter().find(|setting| setting.key == key).map(|setting| setting.value.as_str())
    }

    /// Seed and swept values, for a person.
    #[must_use]
    pub fn label(&self) -> String {
        match describe(&self.settings) {
            settings if self.settings.is_empty() => format!("seed {}{settings}", self.seed),
            settings => format!("seed {}, {settings}", self.seed),
        }
    }
}

/// Swept values, for a person.
pub(super) fn describe(settings: &[Setting]) -> String {
    let each = settings.iter().map(|Setting { key, value }| format!("{key} = {value}"));
    each.collect::<Vec<_>>().join(", ")
}

/// What names the directory of a run of this configuration.
pub(super) fn hash(configuration: &Configuration) -> String {
    let text = format!("{}\n{}", env!("CARGO_PKG_VERSION"), configuration.to_toml());
    hexadecimal(&Sha256::digest(text.as_bytes())).chars().take(HASH_DIGITS).collect()
}

/// Bytes as hexadecimal digits.
pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
