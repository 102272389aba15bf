//! Where the capillary sum is cut: splitting α, cut-off r_c and mesh that go together.
//!
//! The mesh decides: αh is fixed by the accuracy wanted, r_c by α. A finer mesh takes more time for waves and leaves
//! less for pairs.

use meniscus_core::parameters::GRID_RANGE;
use meniscus_core::repulsion::SMALLEST_DISTANCE;

/// αh, splitting times mesh spacing. With the ten nodes an axis of `far` the forces that energy differences give are off
/// by about 1e-7 rms.
const SPLITTING_OF_SPACING: f64 = 0.31;

/// α·r_c: the near part has fallen to exp(−α²r_c²) = 7e-10 of the bare force there.
const REACH: f64 = 4.6;

/// Fewest nodes a side: with half of them r_c would exceed L/2.
const FEWEST_NODES: usize = 32;

/// Time for a pair of the near part over the time for a node of the mesh.
const PAIR_OVER_NODE: f64 = 0.4;

/// Density of closely packed discs 2 R0 apart, 1/(2√3) R0⁻²: the most pairs are those of a single cluster.
const CLOSE_PACKING: f64 = 0.288_675_134_594_812_9;

/// A cut of the capillary sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Split {
    /// Nodes M a side.
    pub(super) nodes: usize,
    /// α, 1/R0.
    pub(super) splitting: f64,
    /// r_c, R0; below L/2.
    pub(super) cutoff: f64,
}

impl Split {
    /// That of a mesh of at least `nodes` nodes a side, brought into range.
    pub(super) fn of_mesh(side: f64, nodes: usize) -> Self {
        let nodes = nodes.clamp(FEWEST_NODES, GRID_RANGE.1).next_power_of_two();
        let splitting = SPLITTING_OF_SPACING * nodes as f64 / side;
        // The straight line below the smallest distance belongs to the near part, however fine the mesh.
        Self { nodes, splitting, cutoff: (REACH / splitting).max(SMALLEST_DISTANCE) }
    }

    /// The fastest for `particles` discs that form a single cluster, as they do in the end.
    pub(super) fn fastest(side: f64, particles: usize) -> Self {
        let mut fastest = Self::of_mesh(side, FEWEST_NODES);
        let mut finer = fastest;
        while finer.nodes < GRID_RANGE.1 {
            finer = Self::of_mesh(side, 2 * finer.nodes);
            if finer.time(particles) < fastest.time(particles) {
                fastest = finer;
            }
        }
        fastest
    }

    /// The time an energy takes, in that for a node.
    fn time(&self, particles: usize) -> f64 {
        let others = CLOSE_PACKING * core::f64::consts::PI * self.cutoff * self.cutoff;
        let pairs = 0.5 * particles as f64 * others.min(particles as f64);
        (self.nodes * self.nodes) as f64 + PAIR_OVER_NODE * pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_near_part_ends_within_half_a_box() {
        for side in [4.5, 37.0, 500.0, 65536.0] {
            for particles in [1, 2500, 1 << 19] {
                let split = Split::fastest(side, particles);
                assert!(split.cutoff < 0.5 * side, "{split:?}");
                assert!(split.nodes.is_power_of_two() && split.nodes <= 4096, "{split:?}");
            }
        }
    }

    #[test]
    fn few_discs_take_a_coarse_mesh() {
        assert_eq!(Split::fastest(65536.0, 10).nodes, FEWEST_NODES);
        assert_eq!(Split::fastest(500.0, 2500).nodes, 512);
    }

    #[test]
    fn nonsense_is_brought_into_range() {
        assert_eq!(Split::of_mesh(100.0, 0).nodes, 32);
        assert_eq!(Split::of_mesh(100.0, usize::MAX).nodes, 4096);
        assert_eq!(Split::fastest(f64::NAN, 100).nodes, 32);
    }
}
