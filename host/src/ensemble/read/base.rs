//! `preset` or `configuration`: what every member begins with.

use super::{Base, Source};
use crate::configuration::{ConfigurationError, describe, file_text, preset};
use std::path::Path;
use toml_edit::TableLike;

impl Source<'_> {
    pub(super) fn base(&self, table: &dyn TableLike, folder: &Path) -> Result<Base, ConfigurationError> {
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
}
