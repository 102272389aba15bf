//! What a scheme costs.

use super::{Scheme, System};
use core::f64::consts::PI;

/// Mesh solve, ns per node and per binary logarithm of M: 4.0 ms at M = 512.
const MESH: f64 = 1.7;
/// Deposit or gather, ns per disc whatever the order.
const VISIT: f64 = 20.0;
/// Deposit or gather, ns per node of a disc.
const NODE: f64 = 1.5;
/// A pair within the cut-off, ns.
const PAIR: f64 = 9.0;
/// A pair the cell list looks at, ns.
const LOOK: f64 = 2.0;
/// Pairs looked at over pairs within the cut-off: 25 cells of side r_c/2 over a disc of radius r_c.
const LOOKS: f64 = 6.25 / PI;
/// Density of a collapsed state, R0⁻²: discs 2.1 R0 apart on a hexagonal lattice.
const COLLAPSED_DENSITY: f64 = 0.2618;

/// Time per step of a nominal machine, ns, by stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Transforms and influence function.
    pub mesh: f64,
    /// Deposit and gather.
    pub assignment: f64,
    /// Near part, the mean of a uniform and a collapsed state.
    pub pairs: f64,
}

impl Cost {
    /// All stages together, ns.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.mesh + self.assignment + self.pairs
    }
}

/// What a step costs on a nominal machine, one core of a server of 2026 that runs the core as it is.
///
/// Mesh 1.7·M² log₂ M ns; deposit and gather 2·N·(20 + 1.5 p²) ns for order p; near part 9 ns for each pair
/// within the cut-off and 2 ns for each the cell list looks at, 6.25/π times as many. Pairs are the mean of two states: spread
/// evenly, and collapsed to one round patch in which discs are 2.1 R0 apart.
#[must_use]
pub fn cost(system: &System, scheme: &Scheme) -> Cost {
    let nodes = scheme.grid as f64 * scheme.grid as f64;
    let order = scheme.assignment.order() as f64;
    let discs = system.particles as f64;
    let all = 0.5 * discs * (discs - 1.0).max(0.0);
    let uniform = all * (PI * scheme.cutoff * scheme.cutoff / (system.side * system.side)).min(1.0);
    let patch = (discs / (PI * COLLAPSED_DENSITY.max(system.density()))).sqrt();
    let collapsed = all * closer_in_patch(scheme.cutoff / patch);
    Cost {
        mesh: MESH * nodes * libm::log2(scheme.grid as f64),
        assignment: 2.0 * discs * (VISIT + NODE * order * order),
        pairs: 0.5 * (pair_time(uniform, all) + pair_time(collapsed, all)),
    }
}

/// ns for so many pairs within the cut-off of so many there are.
fn pair_time(within: f64, all: f64) -> f64 {
    PAIR * within + LOOK * (LOOKS * within).min(all)
}

/// The share of pairs closer than `distance` radii in a disc evenly filled with points (disc line picking): s² for small
/// s, less for the pairs that the edge has not got, and 1 from s = 2 on.
fn closer_in_patch(distance: f64) -> f64 {
    if distance >= 2.0 {
        return 1.0;
    }
    let s = distance.max(0.0);
    let squared = s * s;
    let edge = s / PI * (1.0 + 0.5 * squared) * (1.0 - 0.25 * squared).sqrt();
    (1.0 + 2.0 / PI * (squared - 1.0) * libm::acos(0.5 * s) - edge).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use meniscus_core::parameters::Assignment;

    const SYSTEM: System = System {
        side: 500.0,
        particles: 2500,
        capillary_strength: 0.89,
        capillary_length: 270.0,
        mean_square_strength: 1.0,
    };
    const SCHEME: Scheme = Scheme { grid: 512, assignment: Assignment::Order5, splitting: 0.2, cutoff: 10.0 };

    #[test]
    fn the_mesh_costs_what_was_measured() {
        assert!((cost(&SYSTEM, &SCHEME).mesh / 4.0e6 - 1.0).abs() < 0.01);
    }

    #[test]
    fn pairs_in_a_patch_are_those_of_a_lattice_of_points() {
        let mut points = Vec::new();
        for i in -15..=15 {
            for j in -15..=15 {
                let (x, y) = (f64::from(i) / 15.0, f64::from(j) / 15.0);
                if x * x + y * y < 1.0 {
                    points.push((x, y));
                }
            }
        }
        for distance in [0.25, 0.7, 1.1, 1.7] {
            let is_closer = |a: &(f64, f64), b: &(f64, f64)| {
                (a.0 - b.0) * (a.0 - b.0) + (a.1 - b.1) * (a.1 - b.1) < distance * distance
            };
            let closer: usize =
                points.iter().map(|a| points.iter().filter(|b| is_closer(a, b)).count()).sum();
            let share = closer as f64 / (points.len() * points.len()) as f64;
            let expected = closer_in_patch(distance);
            assert!((share / expected - 1.0).abs() < 0.04, "{distance}: {share} and {expected}");
        }
        assert_eq!(closer_in_patch(2.0), 1.0);
        assert!((closer_in_patch(1e-3) / 1e-6 - 1.0).abs() < 1e-2);
    }

    #[test]
    fn pairs_are_never_more_than_there_are() {
        let small = System { side: 30.0, ..SYSTEM };
        let wide = cost(&small, &Scheme { cutoff: 1e3, ..SCHEME });
        assert!((wide.pairs - (PAIR + LOOK) * 2500.0 * 2499.0 / 2.0).abs() < 1.0);
        assert_eq!(cost(&System { particles: 1, ..SYSTEM }, &SCHEME).pairs, 0.0);
    }
}
