//! Campaigns: the runs that figures are made of, as sweeps of `meniscus ensemble`.
//!
//! Figs. 3 to 11 show the same runs, and so do Figs. 12 and 13. Each campaign has a full size, the paper's, and a quick
//! one that keeps the density, and with it Jeans' time and wavenumber.
//!
//! ```
//! use meniscus::reproduce::campaign::{Campaign, Size};
//!
//! let sweep = Campaign::Disc.sweep(Size::Full, None);
//! assert!(sweep.contains("preset = \"fig-14\"") && sweep.contains("seeds = 10"));
//! ```

use core::fmt::Write;

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// The paper's numbers of discs, boxes, times and, where it says them, runs.
    Full,
    /// Smaller boxes, fewer runs, and steps up to twice as long where discs touch: minutes instead of hours.
    Quick,
    /// A few discs for a few steps: nothing to be learned of physics, for tests.
    Tiny,
}

/// Runs that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Campaign {
    /// Cold rings at several capillary lengths (Figs. 12 and 13).
    Rings,
    /// A random patch with thermal motion (Fig. 14).
    Disc,
    /// A random monolayer in its linear regime (Fig. 2).
    Modes,
    /// A random monolayer at seven capillary lengths (Figs. 3 to 11).
    Clustering,
    /// Table I with the paper's mesh alone.
    PaperMesh,
}

/// A capillary length of Figs. 3 to 11.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// λ/L as the paper calls it.
    pub paper: f64,
    /// Whether the paper shows it as short-ranged (a), not as long-ranged (b).
    pub short: bool,
}

const fn reach(paper: f64, short: bool) -> Reach {
    Reach { paper, short }
}

/// The capillary lengths of Figs. 3 to 11.
pub const REACHES: [Reach; 7] = [
    reach(0.01, true),
    reach(0.02, true),
    reach(0.05, true),
    reach(0.1, true),
    reach(0.54, false),
    reach(3.0, false),
    reach(10.0, false),
];

/// Side of the paper's box, R0.
const PAPER_SIDE: f64 = 500.0;

/// Radius of the patch of Figs. 12 to 14, R0.
pub const PATCH_RADIUS: f64 = 183.0;

/// λ/R of Fig. 13, and λ → ∞.
pub const RING_REACHES: [f64; 4] = [1.0, 270.0 / PATCH_RADIUS, 5.9, f64::INFINITY];

/// Thresholds of the density of Fig. 7, of ρ_m; Figs. 8 to 11 have [`THRESHOLD`].
pub const THRESHOLDS: [f64; 7] = [0.1, 0.14, 0.2, 0.3, 0.4, 0.6, 0.8];

/// Threshold of the density of Figs. 8 to 11, of ρ_m.
pub const THRESHOLD: f64 = 0.14;

/// A product that is not quite what its decimals say.
fn rounded(product: f64) -> f64 {
    (product * 1e6).round() / 1e6
}

impl Reach {
    /// λ in R0. In a smaller box a short λ stays what it is, as λK decides; a long one keeps λ/L, as nothing else is left
    /// that could.
    #[must_use]
    pub fn length(&self, size: Size) -> f64 {
        let side = if self.short { PAPER_SIDE } else { side(size) };
        rounded(self.paper * side)
    }

    /// How legends call it.
    #[must_use]
    pub fn label(&self, size: Size) -> String {
        match (self.short, size) {
            (true, Size::Quick | Size::Tiny) => format!("λ = {} R_0 ({})", self.length(size), self.paper),
            _ => format!("λ/L = {}", self.paper),
        }
    }
}

/// Side of the box of Figs. 3 to 11, R0.
#[must_use]
pub fn side(size: Size) -> f64 {
    match size {
        Size::Full => PAPER_SIDE,
        Size::Quick => 250.0,
        Size::Tiny => 50.0,
    }
}

impl Campaign {
    /// All of them, those that are done soonest first.
    pub const ALL: [Self; 5] = [Self::Rings, Self::Disc, Self::Modes, Self::Clustering, Self::PaperMesh];

    /// Its name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rings => "rings",
            Self::Disc => "disc",
            Self::Modes => "modes",
            Self::Clustering => "clustering",
            Self::PaperMesh => "paper-mesh",
        }
    }

    /// The preset it starts from.
    #[must_use]
    pub const fn preset(self) -> &'static str {
        match self {
            Self::Rings => "fig-13",
            Self::Disc => "fig-14",
            Self::Modes => "fig-2",
            Self::Clustering | Self::PaperMesh => "fig-7",
        }
    }

    /// How many runs differ in nothing but the seed; of Figs. 3 to 11 the paper does not say. Cold rings are the same for
    /// every seed.
    #[must_use]
    pub const fn seeds(self, size: Size) -> u32 {
        match (self, size) {
            (Self::Rings, _) => 1,
            (_, Size::Tiny) => 2,
            (Self::Modes, Size::Full) => 20,
            (Self::Modes, Size::Quick) => 8,
            (Self::Disc | Self::Clustering, Size::Full) => 10,
            (Self::Disc, Size::Quick) => 4,
            (Self::Clustering | Self::PaperMesh, _) => 3,
        }
    }

    /// What it changes in the preset, each `key=value`.
    #[must_use]
    pub fn overrides(self, size: Size) -> Vec<String> {
        let mut overrides: Vec<String> = self.own(size).iter().map(|&text| text.to_owned()).collect();
        if matches!(self, Self::Clustering | Self::PaperMesh) {
            let thresholds: Vec<String> = THRESHOLDS.iter().map(f64::to_string).collect();
            overrides.push(format!("output.minkowski_thresholds=[{}]", thresholds.join(", ")));
            if size != Size::Full {
                overrides.push(format!("system.box={}", side(size)));
            }
        }
        if self == Self::PaperMesh {
            let long = REACHES[4].length(size);
            overrides.extend(["force.method=pm".to_owned(), format!("system.capillary_length={long}")]);
        }
        overrides
    }

    /// What it changes without calculating.
    fn own(self, size: Size) -> Vec<&'static str> {
        let tables: &[&str] = match (self, size) {
            (Self::Rings | Self::Disc | Self::Modes, _) => &["output.trajectory=0"],
            (_, Size::Tiny) => {
                &["output.observables=0.01", "output.minkowski=0.01", "output.trajectory=0.01"]
            }
            _ => &["output.observables=0.05", "output.minkowski=0.05", "output.trajectory=1"],
        };
        let steps: &[&str] = match (self, size) {
            (_, Size::Full) => &[],
            (Self::Rings, Size::Quick) => &["time.until=1.35", "motion.max_step=0.004"],
            (Self::Disc, Size::Quick) => &["time.until=1.6", "motion.max_step=0.002"],
            (_, Size::Quick) => &["motion.max_step=0.002"],
            (_, Size::Tiny) => &["time.until=0.05", "motion.max_step=0.02"],
        };
        let system: &[&str] = match (self, size) {
            (_, Size::Full) | (Self::Rings | Self::Disc | Self::Modes, Size::Quick) => &[],
            (Self::Clustering | Self::PaperMesh, Size::Quick) => &["system.particles=625"],
            (Self::Rings, Size::Tiny) => {
                &["system.particles=13", "start.rings=2", "start.per_ring=4", "system.box=160"]
            }
            (Self::Disc, Size::Tiny) => &["system.particles=20", "start.radius=40", "system.box=160"],
            (Self::Modes, Size::Tiny) => &["system.particles=40", "system.box=63"],
            (Self::Clustering | Self::PaperMesh, Size::Tiny) => &["system.particles=25"],
        };
        // The accuracy's choice of a mesh takes longer than such a run.
        let mesh: &[&str] = match (self, size) {
            (_, Size::Full | Size::Quick) => &[],
            (Self::Rings | Self::Disc, Size::Tiny) => &["force.method=pm", "mesh.grid=64"],
            (Self::Modes | Self::Clustering, Size::Tiny) => &["force.method=pm", "mesh.grid=32"],
            (Self::PaperMesh, Size::Tiny) => &["mesh.grid=16"],
        };
        [system, steps, mesh, tables, &["output.snapshots=0"]].concat()
    }

    /// The capillary lengths it goes through, R0; none if the preset's is all.
    #[must_use]
    pub fn lengths(self, size: Size) -> Vec<f64> {
        match self {
            Self::Clustering => REACHES.iter().map(|reach| reach.length(size)).collect(),
            Self::Rings => RING_REACHES.map(|reach| rounded(reach * PATCH_RADIUS)).to_vec(),
            Self::Modes | Self::Disc | Self::PaperMesh => Vec::new(),
        }
    }

    /// The sweep as `meniscus ensemble` reads it; with `seeds` instead of its own number of them, unless there is but
    /// one.
    #[must_use]
    pub fn sweep(self, size: Size, seeds: Option<u32>) -> String {
        let own = self.seeds(size);
        let seeds = if own == 1 { own } else { seeds.unwrap_or(own) };
        let overrides: Vec<String> =
            self.overrides(size).iter().map(|text| format!("    \"{text}\",\n")).collect();
        let mut text = format!(
            "version = 1\npreset = \"{}\"\nset = [\n{}]\nseeds = {seeds}\n",
            self.preset(),
            overrides.concat()
        );
        let lengths: Vec<String> = self.lengths(size).iter().map(f64::to_string).collect();
        if !lengths.is_empty() {
            // Writing to memory cannot fail.
            let _ = write!(text, "\n[sweep]\n\"system.capillary_length\" = [{}]\n", lengths.join(", "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_those_of_the_paper() {
        let full: Vec<f64> = REACHES.iter().map(|reach| reach.length(Size::Full)).collect();
        assert_eq!(full, [5.0, 10.0, 25.0, 50.0, 270.0, 1500.0, 5000.0]);
        let quick: Vec<f64> = REACHES.iter().map(|reach| reach.length(Size::Quick)).collect();
        assert_eq!(quick, [5.0, 10.0, 25.0, 50.0, 135.0, 750.0, 2500.0]);
        assert_eq!(Campaign::Rings.lengths(Size::Full), [183.0, 270.0, 1079.7, f64::INFINITY]);
    }

    #[test]
    fn the_full_numbers_of_runs_are_the_papers() {
        let seeds = |campaign: Campaign| campaign.seeds(Size::Full);
        assert_eq!(
            (seeds(Campaign::Modes), seeds(Campaign::Clustering), seeds(Campaign::Disc)),
            (20, 10, 10)
        );
        assert!(Campaign::Modes.sweep(Size::Quick, Some(3)).contains("seeds = 3\n"));
        assert!(Campaign::Rings.sweep(Size::Quick, Some(3)).contains("seeds = 1\n"));
    }
}
