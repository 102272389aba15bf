//! Presets: the paper's runs as commented TOML that leaves nothing to defaults but what the accuracy decides.
//!
//! ```
//! use meniscus::configuration::{PRESETS, preset};
//!
//! assert_eq!(PRESETS[0].name, "table-1");
//! assert!(preset("fig-2")?.text.contains("particles = 3844"));
//! # Ok::<(), meniscus::configuration::ConfigurationError>(())
//! ```

use super::Configuration;
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

impl Preset {
    /// The complete configuration as TOML: what is said at its head, then every key, those that are chosen too.
    ///
    /// # Errors
    /// A [`ConfigurationError`], which no preset gives.
    pub fn complete(&self) -> Result<String, ConfigurationError> {
        let configuration = Configuration::from_preset(self.name, &[])?;
        let head: String = self.text.split_inclusive('\n').take_while(|line| line.starts_with('#')).collect();
        Ok(format!("{head}\n{}", configuration.to_toml()))
    }
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
    use crate::configuration::keys::{KEYS, Key};
    use crate::configuration::{Force, Mesh, Place, default_grid};
    use crate::observables::series::Series;
    use meniscus_core::parameters::Parameters;

    /// With the splitting given the rest is chosen fast.
    fn quickly(preset: &Preset, more: &[&str]) -> Configuration {
        let overrides = more.iter().chain(&["force.splitting=0.1"]).map(|&text| text.to_owned());
        Configuration::from_preset(preset.name, &overrides.collect::<Vec<_>>()).expect(preset.name)
    }

    #[test]
    fn every_preset_is_accepted_and_reads_back_equal() {
        for preset in PRESETS {
            let configuration = quickly(preset, &[]);
            let text = configuration.to_toml();
            let again = Configuration::from_text(preset.name, &text, &[]);
            assert_eq!(again, Ok(configuration), "{}", preset.name);
        }
    }

    #[test]
    fn every_preset_gives_every_key_that_applies_and_is_not_chosen() {
        use crate::configuration::entries::Entries;
        /// Chosen for the accuracy, or nothing: no preset has external fields or unequal discs, or holds mesh forces. Or no
        /// matter of the system: in which format files are, and how often it is seen to it that a run can go on.
        fn is_left(key: &str) -> bool {
            let tables = ["mesh.", "field.", "output.trajectory_format", "output.checkpoint_"];
            let leaves =
                ["force.splitting", "force.cutoff", "force.mesh_refresh", ".strengths", ".modes_shells"];
            tables.iter().any(|table| key.starts_with(table)) || leaves.iter().any(|leaf| key.ends_with(leaf))
        }
        fn is_of_series(key: &str) -> bool {
            let leaf = key.strip_prefix("output.");
            leaf.is_some_and(|leaf| Series::ALL.iter().any(|series| leaf.starts_with(series.name())))
        }
        for preset in PRESETS {
            let given = Entries::read(preset.name, preset.text, &[]).unwrap();
            let written = quickly(preset, &[]).to_toml();
            let complete = Entries::read(preset.name, &written, &[]).unwrap();
            let output = quickly(preset, &[]).output;
            for key in KEYS.iter().filter(|key| !is_of_series(key.name)) {
                let expected = complete.has(key.name) && !is_left(key.name);
                assert_eq!(given.has(key.name), expected, "{} in {}", key.name, preset.name);
            }
            // A series with its settings is given where the figure needs it.
            for series in Series::ALL {
                let own = |key: &&Key| key.leaf().starts_with(series.name()) && !is_left(key.name);
                for key in KEYS.iter().filter(|key| key.table() == "output").filter(own) {
                    let expected = output.interval(series) > 0.0;
                    assert_eq!(given.has(key.name), expected, "{} in {}", key.name, preset.name);
                }
            }
            assert!(matches!(given.place("seed"), Place::File { .. }));
        }
    }

    #[test]
    fn a_complete_preset_has_what_was_chosen_and_what_its_head_says() {
        let text = preset("table-1").unwrap().complete().unwrap();
        assert!(
            text.starts_with("# Table I, in disc radii") && text.contains("#   --set force.method=pm\n"),
            "{text}"
        );
        let again = Configuration::from_text("complete", &text, &[]).unwrap();
        assert_eq!(Configuration::from_preset("table-1", &[]), Ok(again));
    }

    #[test]
    fn the_papers_scheme_is_one_override_away() {
        let pm = ["force.method=pm".to_owned()];
        for preset in PRESETS {
            let paper = Configuration::from_preset(preset.name, &pm).unwrap();
            assert_eq!(paper.force, Force::ParticleMesh, "{}", preset.name);
            let Parameters { assignment, influence, gradient, .. } = Parameters::DEFAULT;
            let grid = default_grid(paper.system.side);
            assert_eq!(paper.mesh, Mesh { grid, assignment, influence, gradient }, "{}", preset.name);
        }
        assert_eq!(Configuration::from_preset("table-1", &pm).unwrap().mesh.grid, 512);
    }

    #[test]
    fn the_overrides_that_a_preset_tells_are_accepted() {
        let mut count = 0;
        for preset in PRESETS {
            let told = preset.text.lines().filter_map(|line| line.strip_prefix("#   --set "));
            for line in told {
                count += 1;
                if line.starts_with("force.method") {
                    Configuration::from_preset(preset.name, &[line.to_owned()]).expect(line);
                } else {
                    quickly(preset, &[line]);
                }
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
