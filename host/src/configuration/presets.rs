//! Presets: the paper's runs as complete, commented TOML.
//!
//! ```
//! use meniscus::configuration::{PRESETS, preset};
//!
//! assert_eq!(PRESETS[0].name, "table-1");
//! assert!(preset("fig-2")?.text.contains("particles = 3844"));
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

use super::error::ConfigurationError;
use super::keys::{nearest, tolerance};

/// One preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preset {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// Its TOML.
    pub text: &'static str,
}

/// All presets, in the order of the paper.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "table-1",
        summary: "Table I: 2500 discs at random, lambda/L = 0.54",
        text: include_str!("presets/table-1.toml"),
    },
    Preset {
        name: "table-1-si",
        summary: "Table I in SI units, its misprint corrected",
        text: include_str!("presets/table-1-si.toml"),
    },
    Preset {
        name: "fig-2",
        summary: "Growth of the unstable modes, 3844 discs",
        text: include_str!("presets/fig-2.toml"),
    },
    Preset {
        name: "fig-3",
        summary: "Snapshots, short-ranged attraction, lambda/L = 0.05",
        text: include_str!("presets/fig-3.toml"),
    },
    Preset {
        name: "fig-4",
        summary: "Snapshots, long-ranged attraction, lambda/L = 0.54",
        text: include_str!("presets/fig-4.toml"),
    },
    Preset {
        name: "fig-5",
        summary: "Number of clusters in time, lambda/L = 0.54",
        text: include_str!("presets/fig-5.toml"),
    },
    Preset {
        name: "fig-6",
        summary: "Mean cluster mass in time, lambda/L = 0.54",
        text: include_str!("presets/fig-6.toml"),
    },
    Preset {
        name: "fig-7",
        summary: "Boundary length M1 at several density thresholds",
        text: include_str!("presets/fig-7.toml"),
    },
    Preset {
        name: "fig-8",
        summary: "Area M0 of the dense regions in time, lambda/L = 0.54",
        text: include_str!("presets/fig-8.toml"),
    },
    Preset {
        name: "fig-9",
        summary: "Boundary length M1 of the dense regions in time, lambda/L = 0.54",
        text: include_str!("presets/fig-9.toml"),
    },
    Preset {
        name: "fig-10",
        summary: "Euler characteristic M2 of the dense regions in time, lambda/L = 0.54",
        text: include_str!("presets/fig-10.toml"),
    },
    Preset {
        name: "fig-11",
        summary: "Shape factor of the dense regions in time, lambda/L = 0.54",
        text: include_str!("presets/fig-11.toml"),
    },
    Preset {
        name: "fig-12",
        summary: "Cold collapse of a patch of rings, lambda/R = 1.48",
        text: include_str!("presets/fig-12.toml"),
    },
    Preset {
        name: "fig-13",
        summary: "Cold collapse of the outermost ring at several lambda",
        text: include_str!("presets/fig-13.toml"),
    },
    Preset {
        name: "fig-14",
        summary: "Collapse of a random patch with thermal motion",
        text: include_str!("presets/fig-14.toml"),
    },
];

/// The preset called `name`.
///
/// # Errors
/// [`ConfigurationError::UnknownPreset`] with the most similar name.
pub fn preset(name: &str) -> Result<&'static Preset, ConfigurationError> {
    PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| ConfigurationError::UnknownPreset {
        name: name.to_owned(),
        nearest: nearest(name, PRESETS.iter().map(|preset| preset.name), tolerance(name)).map(str::to_owned),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::keys::KEYS;
    use crate::configuration::{Configuration, Place};

    #[test]
    fn every_preset_is_accepted_and_reads_back_equal() {
        for preset in PRESETS {
            let configuration = Configuration::from_preset(preset.name, &[]).expect(preset.name);
            let text = configuration.to_toml();
            assert_eq!(
                Configuration::from_text(preset.name, &text, &[]),
                Ok(configuration),
                "{}",
                preset.name
            );
        }
    }

    #[test]
    fn every_preset_gives_every_key_that_applies() {
        use crate::configuration::entries::Entries;
        for preset in PRESETS {
            let given = Entries::read(preset.name, preset.text, &[]).unwrap();
            let written = Configuration::from_preset(preset.name, &[]).unwrap().to_toml();
            let complete = Entries::read(preset.name, &written, &[]).unwrap();
            for key in KEYS {
                assert_eq!(given.has(key.name), complete.has(key.name), "{} in {}", key.name, preset.name);
            }
            assert!(matches!(given.place("seed"), Place::File { .. }));
        }
    }

    #[test]
    fn the_overrides_that_a_preset_tells_are_accepted() {
        let mut count = 0;
        for preset in PRESETS {
            let told = preset.text.lines().filter_map(|line| line.strip_prefix("#   --set "));
            for line in told {
                count += 1;
                let result = Configuration::from_preset(preset.name, &[line.to_owned()]);
                assert!(result.is_ok(), "{}: {line}: {result:?}", preset.name);
            }
        }
        assert!(count > 0);
    }

    #[test]
    fn names_are_unique_and_summaries_one_line() {
        for (index, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[..index].iter().all(|other| other.name != preset.name));
            assert!(!preset.summary.is_empty() && preset.summary.lines().count() == 1);
        }
    }
}
