//! `seeds`: how many, or which.

use super::Source;
use crate::configuration::{ConfigurationError, describe, repeat};
use crate::ensemble::sweep::LARGEST_COUNT;
use meniscus_core::parameters::LARGEST_SEED;
use std::collections::HashSet;
use toml_edit::{Item, TableLike};

const SEEDS: &str = "how many seeds, from 1 on, or an array of seeds";

impl Source<'_> {
    pub(super) fn seeds(&self, table: &dyn TableLike) -> Result<Vec<u64>, ConfigurationError> {
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
}
