//! The catalogue: each figure of the paper, what the paper says of it, which runs it takes and what it is made by.
//!
//! ```
//! use meniscus::reproduce::catalogue::{CATALOGUE, entry};
//!
//! assert_eq!(CATALOGUE[0].name, "text");
//! assert!(entry("fig-12").unwrap().paper.contains("Eq. 30"));
//! ```

use super::ReproduceError;
use super::campaign::Campaign;
use super::evidence::Evidence;
use super::figures::morphology::Functional;
use super::figures::{Built, clusters, collapse, energy, forces, meshes, modes, morphology, snapshots, text};

/// A figure of the paper, or one of ours.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its heading.
    pub title: &'static str,
    /// What the paper says of it.
    pub paper: &'static str,
    /// The runs it takes.
    pub campaigns: &'static [Campaign],
    /// What makes it.
    pub build: fn(&Evidence) -> Result<Built, ReproduceError>,
}

/// All figures, in the order of the paper; then ours.
pub const CATALOGUE: [Entry; 17] = [
    Entry {
        name: "text",
        title: "Numbers of the text",
        paper: "Table I and the captions print numbers that follow from each other.",
        campaigns: &[],
        build: |_| Ok(text::build()),
    },
    Entry {
        name: "fig-2",
        title: "Fig. 2: growth of unstable modes",
        paper: "Modes with k < K_c of 3844 discs in a box of 620 R0 grow exponentially with the rates of Eq. 10; up to ≈ 1.5 T the \
                agreement is very good, so the linear stability analysis is reliable up to T. 20 runs; errors smaller than the symbols.",
        campaigns: &[Campaign::Modes],
        build: modes::build,
    },
    Entry {
        name: "fig-3",
        title: "Fig. 3: snapshots, short-ranged attraction",
        paper: "2500 discs in a box of 500 R0 at λ/L = 0.02, 0.05, 0.1, after 1, 3 and 5 T: clusters form and grow on times much longer than T.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| snapshots::build(evidence, true),
    },
    Entry {
        name: "fig-4",
        title: "Fig. 4: snapshots, long-ranged attraction",
        paper: "λ/L = 0.54, 3, 10: a few clusters form within T and merge quickly into a single one with basically all colloids; for λ/L = 10 \
                almost all particles collapse into a single cluster between 3 T and 4 T.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| snapshots::build(evidence, false),
    },
    Entry {
        name: "fig-5",
        title: "Fig. 5: number of clusters",
        paper: "n_c/L² against t/T for λ/L = 0.01 to 10; how many runs is not said. With increasing λ a λ-independent limit is reached; in it clusters form until \
                ≈ 1.5 T and merge afterwards, all within ≈ 5 T. At λ/L = 0.01 n_c increases steadily.",
        campaigns: &[Campaign::Clustering],
        build: clusters::number,
    },
    Entry {
        name: "fig-6",
        title: "Fig. 6: mean cluster mass",
        paper: "S (Eq. 23) increases steadily and seems to follow an exponential law before it saturates when only a single cluster remains.",
        campaigns: &[Campaign::Clustering],
        build: clusters::mass,
    },
    Entry {
        name: "fig-7",
        title: "Fig. 7: boundary length at several thresholds",
        paper: "M1 at λ/L = 0.54 for 0.1 ≤ ρ_c/ρ_m ≤ 0.8: the behaviour does not depend on the threshold if it takes intermediate values; close \
                to ρ_m the signature of the crossover is no longer detectable.",
        campaigns: &[Campaign::Clustering],
        build: morphology::thresholds,
    },
    Entry {
        name: "fig-8",
        title: "Fig. 8: overdense area M0",
        paper: "At λ/L = 0.01 a steady increase; at the largest λ a maximum followed by a steady decrease. ρ_c = 0.14 ρ_m ≈ 4 ρ_h.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| morphology::functional(evidence, Functional::Area),
    },
    Entry {
        name: "fig-9",
        title: "Fig. 9: boundary length M1",
        paper: "At λ/L = 0.01 a steady increase; at the largest λ a maximum followed by a steady decrease.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| morphology::functional(evidence, Functional::Length),
    },
    Entry {
        name: "fig-10",
        title: "Fig. 10: Euler characteristic M2",
        paper: "No holes are expected at ρ_c = 4 ρ_h, so that M2 > 0 gives directly the number of clusters. At λ/L = 0.01 a steady increase; at the \
                largest λ a maximum followed by a steady decrease.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| morphology::functional(evidence, Functional::Euler),
    },
    Entry {
        name: "fig-11",
        title: "Fig. 11: shape factor",
        paper: "φ = M1²/(4πM0M2) tends to become time-independent at intermediate λ (self-similar growth); at the largest λ it has a maximum, decreases, \
                and increases again after the collapse to a single cluster at ≈ 6 T.",
        campaigns: &[Campaign::Clustering],
        build: |evidence| morphology::functional(evidence, Functional::Shape),
    },
    Entry {
        name: "fig-12",
        title: "Fig. 12: cold collapse of rings",
        paper: "Rings of R_i = 58, 95 and 135 R0 of a patch of 451 discs of radius 183 R0, λ/R = 1.48, in a box of 800 R0: Eq. 30 fits well over \
                0 < t < 0.9 T with (A0, R_f) = (1.15, 18), (1.16, 13), (1.16, 8) from the top; A0 depends but weakly on R_i.",
        campaigns: &[Campaign::Rings],
        build: collapse::rings::build,
    },
    Entry {
        name: "fig-13",
        title: "Fig. 13: cold collapse at several capillary lengths",
        paper: "The outermost ring at λ/R = 1, 1.48, 5.9: upon increasing λ the collapse time decreases, eventually leading to a collapse at T, \
                A0(λ → ∞) = 1.",
        campaigns: &[Campaign::Rings],
        build: collapse::lengths::build,
    },
    Entry {
        name: "fig-14",
        title: "Fig. 14: collapse of a random patch with thermal motion",
        paper: "Ten runs, shells of 7.5 R0: Eq. 30 fits over 0 < t < 0.9 T with (A0, R_f) = (1.16, 18), (1.16, 13), (1.14, 9) from the top; later R \
                approaches R_f more smoothly, and later than A0·T.",
        campaigns: &[Campaign::Disc],
        build: collapse::disc::build,
    },
    Entry {
        name: "forces",
        title: "Ours: force errors",
        paper: "The mesh guarantees the long-ranged potential without any cut-off, with a high accuracy down to distances of the grid spacing, R0.",
        campaigns: &[],
        build: forces::build,
    },
    Entry {
        name: "energy",
        title: "Ours: energy",
        paper: "Not in the paper.",
        campaigns: &[Campaign::Clustering, Campaign::Rings],
        build: energy::build,
    },
    Entry {
        name: "meshes",
        title: "Ours: the paper's mesh beside the split force",
        paper: "Not in the paper: all forces in it are the mesh's alone.",
        campaigns: &[Campaign::Clustering, Campaign::PaperMesh],
        build: meshes::build,
    },
];

/// The entry of a name.
#[must_use]
pub fn entry(name: &str) -> Option<&'static Entry> {
    static ALL: [Entry; 17] = CATALOGUE;
    ALL.iter().find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::PRESETS;
    use crate::reproduce::campaign::Size;
    use crate::reproduce::evidence::sweep;
    use std::collections::BTreeSet;

    #[test]
    fn every_figure_with_a_preset_is_there() {
        for preset in PRESETS.iter().filter(|preset| preset.name.starts_with("fig-")) {
            assert!(entry(preset.name).is_some(), "{}", preset.name);
        }
        let names: BTreeSet<_> = CATALOGUE.iter().map(|entry| entry.name).collect();
        assert_eq!(names.len(), CATALOGUE.len());
    }

    #[test]
    fn every_sweep_is_accepted_and_no_run_is_made_twice() {
        // The others have the same keys and take a second each to choose a scheme for.
        let mut hashes = BTreeSet::new();
        let mut count = 0;
        for campaign in Campaign::ALL {
            let sweep = sweep(campaign, Size::Tiny, None).unwrap();
            count += sweep.members().len();
            hashes.extend(sweep.members().iter().map(|member| member.hash.clone()));
        }
        assert_eq!(hashes.len(), count);
        assert_eq!(count, 4 + 2 + 2 + 14 + 2);
    }

    #[test]
    fn the_sweeps_of_the_paper_and_the_quick_ones_are_accepted() {
        for size in [Size::Full, Size::Quick] {
            for campaign in Campaign::ALL {
                let text = campaign.sweep(size, Some(1));
                // With the splitting given the rest is chosen fast.
                let text = text.replace("set = [\n", "set = [\n    \"force.splitting=0.1\",\n");
                let text = if campaign == Campaign::PaperMesh { campaign.sweep(size, Some(1)) } else { text };
                let sweep =
                    crate::ensemble::Sweep::from_text("sweep", &text, std::path::Path::new("")).unwrap();
                assert_eq!(sweep.members().len(), campaign.lengths(size).len().max(1));
            }
        }
    }

    #[test]
    fn more_seeds_keep_the_runs_there_are() {
        let hashes = |seeds| -> Vec<String> {
            let sweep = sweep(Campaign::Disc, Size::Tiny, Some(seeds)).unwrap();
            sweep.members().iter().map(|member| member.hash.clone()).collect()
        };
        assert_eq!(hashes(2), hashes(5)[..2]);
    }
}
