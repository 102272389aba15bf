//! What can be wrong with a configuration, and where it was said.
//!
//! Every message is one line: where, which key, what was found, what is accepted.
//!
//! ```
//! use meniscus::configuration::Configuration;
//!
//! let error = Configuration::from_text("my.toml", "version = 1\n[system]\npartcles = 3\n", &[]).unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "my.toml:3: unknown key `system.partcles`; did you mean `system.particles`?"
//! );
//! ```

use std::fmt;

/// Where a key was given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a file or named text.
    File {
        /// Its name.
        name: String,
        /// Line, from 1.
        line: usize,
    },
    /// On the command line.
    Override,
    /// Nowhere: a default, or several keys together; the name of the whole text.
    Whole {
        /// Its name.
        name: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { name, line } => write!(formatter, "{}:{line}", one_line(name)),
            Self::Override => formatter.write_str("--set"),
            Self::Whole { name } => formatter.write_str(&one_line(name)),
        }
    }
}

/// Why a configuration was refused. `Display` is one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ConfigurationError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {}", one_line(.file), one_line(.reason))]
    Unreadable {
        /// Name of the file.
        file: String,
        /// What the system says.
        reason: String,
    },
    /// The text is not UTF-8.
    #[error("{}: is not text in UTF-8, as TOML must be (byte {})", one_line(.file), .byte)]
    Encoding {
        /// Name of the file.
        file: String,
        /// Offset of the first bad byte.
        byte: usize,
    },
    /// The text is not TOML.
    #[error("{}:{line}:{column}: not valid TOML: {}", one_line(.file), one_line(.reason))]
    Syntax {
        /// Name of the file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What the parser says.
        reason: String,
    },
    /// There is no such preset.
    #[error("unknown preset `{}`{} (`meniscus presets` lists them)", quoted(.name), suggestion(.nearest.as_deref()))]
    UnknownPreset {
        /// The name given.
        name: String,
        /// The most similar preset.
        nearest: Option<String>,
    },
    /// A `--set` is not `key=value`.
    #[error("--set: found `{}`, expected key=value, such as mesh.grid=512", quoted(.text))]
    Override {
        /// What was given.
        text: String,
    },
    /// There is no such key.
    #[error("{place}: unknown key `{}`{}", quoted(.key), suggestion(.nearest.as_deref()))]
    UnknownKey {
        /// Where it was given.
        place: Place,
        /// The dotted key.
        key: String,
        /// The most similar key.
        nearest: Option<String>,
    },
    /// A value is of the wrong type or out of range.
    #[error("{place}: {}: found {}, expected {expected}", quoted(.key), quoted(.found))]
    Value {
        /// Where it was given.
        place: Place,
        /// The dotted key.
        key: String,
        /// What was found.
        found: String,
        /// What is accepted.
        expected: String,
    },
    /// The accuracy of the force cannot be had with what is given.
    #[error("{place}: {}", one_line(.reason))]
    Accuracy {
        /// Where the accuracy was given.
        place: Place,
        /// Why, and what would do.
        reason: String,
    },
    /// Required keys are missing.
    #[error("{place}: missing {keys}")]
    Missing {
        /// The text.
        place: Place,
        /// The keys with what each accepts.
        keys: String,
    },
    /// Keys exclude each other.
    #[error("{place}: {key}: not allowed {reason}")]
    Conflict {
        /// Where it was given.
        place: Place,
        /// The dotted key.
        key: String,
        /// With what it conflicts, and the remedy.
        reason: String,
    },
}

/// `; did you mean …?` for a similar name.
fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!("; did you mean `{nearest}`?"))
}

/// Longest piece of the user's text in a message, characters.
const LONGEST_QUOTE: usize = 120;

/// The text on one line, its end left out if long.
fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{}...", one_line(&text[..end])),
        None => one_line(text),
    }
}

/// The text with control characters escaped.
fn one_line(text: &str) -> String {
    let mut line = String::new();
    for character in text.chars() {
        if character.is_control() || matches!(character, '\u{2028}' | '\u{2029}') {
            line.extend(character.escape_default());
        } else {
            line.push(character);
        }
    }
    line
}
