//! `set` and [sweep]: keys of configurations, with a value for all members or values to go through.

use super::{Axis, AxisValue, Override, Source};
use crate::configuration::{ConfigurationError, Place, describe};
use toml_edit::{Item, TableLike, Value};

/// Keys of configurations that a sweep gives in its own way.
const OWN: [(&str, &str); 2] =
    [("seed", "give the seeds as `seeds`"), ("version", "the program writes that of its own format")];

impl Source<'_> {
    pub(super) fn set(&self, table: &dyn TableLike) -> Result<Vec<Override>, ConfigurationError> {
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

    pub(super) fn axes(
        &self,
        table: &dyn TableLike,
        set: &[Override],
    ) -> Result<Vec<Axis>, ConfigurationError> {
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
