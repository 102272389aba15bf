//! Clusters of discs (Figs. 3 to 6).
//!
//! Two discs are neighbours when they are closer than 3.25 R0. A disc with at least three neighbours is
//! a core. The clusters are the connected components of those pairs of neighbours of which at least one
//! is a core: a disc at the rim that has fewer than three neighbours belongs to the cluster of the core
//! next to it, and joins two clusters when it is next to cores of both. So a cluster has at least four
//! discs.
//!
//! In: the box and positions. Out: for each disc the cluster it belongs to, and how many discs each
//! cluster has. Distances are compared as integers, so the answer is the same everywhere.
//!
//! ```
//! use meniscus::observables::clusters::Clusters;
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(100.0).unwrap();
//! let at = |x, y| Position { x: torus.fraction(x).unwrap(), y: torus.fraction(y).unwrap() };
//! // A disc between three others, and one far away.
//! let positions = [at(10.0, 10.0), at(13.0, 10.0), at(7.0, 10.0), at(10.0, 13.0), at(60.0, 60.0)];
//! let clusters = Clusters::find(&torus, &positions);
//! assert_eq!(clusters.sizes(), &[4]);
//! assert!(clusters.clustered(3) && !clusters.clustered(4));
//! ```

use super::neighbours::Neighbours;
use meniscus_core::torus::{Position, Torus};

/// Distance under which two discs are neighbours, R0.
pub const NEIGHBOUR_DISTANCE: f64 = 3.25;

/// Number of neighbours from which on a disc is a core.
pub const CORE_NEIGHBOURS: usize = 3;

/// The clusters of a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clusters {
    labels: Vec<Option<u32>>,
    sizes: Vec<u32>,
}

impl Clusters {
    /// The clusters of discs at `positions`, an id being a place in the slice.
    #[must_use]
    pub fn find(torus: &Torus, positions: &[Position]) -> Self {
        let neighbours = Neighbours::new(torus, positions, NEIGHBOUR_DISTANCE);
        // A disc is near itself, hence one more.
        let cores: Vec<bool> =
            positions.iter().map(|position| neighbours.near(*position).count() > CORE_NEIGHBOURS).collect();
        let mut components = Components::new(positions.len());
        for (id, position) in positions.iter().enumerate() {
            if cores.get(id) == Some(&true) {
                for other in neighbours.near(*position) {
                    components.join(id, other.id as usize);
                }
            }
        }
        Self::labelled(&mut components, positions.len())
    }

    /// Numbers the components of more than one disc in the order of their lowest ids.
    fn labelled(components: &mut Components, count: usize) -> Self {
        let roots: Vec<usize> = (0..count).map(|id| components.root(id)).collect();
        let mut members = vec![0_u32; count];
        for root in &roots {
            members[*root] += 1;
        }
        let mut sizes = Vec::new();
        let mut labels: Vec<Option<u32>> = Vec::with_capacity(count);
        for (id, root) in roots.iter().enumerate() {
            let label = if members[*root] == 1 {
                None
            } else if *root == id {
                sizes.push(members[id]);
                Some(sizes.len() as u32 - 1)
            } else {
                labels[*root]
            };
            labels.push(label);
        }
        Self { labels, sizes }
    }

    /// The number of clusters, n_c.
    #[must_use]
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// The number of discs in each cluster, by label.
    #[must_use]
    pub fn sizes(&self) -> &[u32] {
        &self.sizes
    }

    /// The label of the cluster that disc `id` belongs to, 0 ≤ label < [`count`](Self::count).
    ///
    /// Clusters are numbered in the order of their lowest ids. None for a disc in no cluster and for an
    /// id that does not exist.
    #[must_use]
    pub fn label(&self, id: usize) -> Option<u32> {
        self.labels.get(id).copied().flatten()
    }

    /// Whether disc `id` belongs to a cluster.
    #[must_use]
    pub fn clustered(&self, id: usize) -> bool {
        self.label(id).is_some()
    }

    /// The number of discs in clusters, Σs.
    #[must_use]
    pub fn clustered_discs(&self) -> u64 {
        self.sizes.iter().map(|size| u64::from(*size)).sum()
    }

    /// The mean number of discs of a cluster, S = Σs/n_c (Eq. 23); 0 without clusters.
    #[must_use]
    pub fn number_average(&self) -> f64 {
        ratio(self.clustered_discs(), self.sizes.len() as u64)
    }

    /// The mean number of discs in the cluster of a clustered disc, Σs²/Σs; 0 without clusters.
    #[must_use]
    pub fn mass_average(&self) -> f64 {
        ratio(self.sizes.iter().map(|size| u64::from(*size) * u64::from(*size)).sum(), self.clustered_discs())
    }

    /// The number of discs in the largest cluster; 0 without clusters.
    #[must_use]
    pub fn largest(&self) -> u32 {
        self.sizes.iter().copied().max().unwrap_or(0)
    }
}

/// A quotient that is 0 where there is nothing to divide.
fn ratio(numerator: u64, denominator: u64) -> f64 {
    if denominator == 0 { 0.0 } else { numerator as f64 / denominator as f64 }
}

/// Connected components of discs: a forest in which the root of a tree is its lowest id.
struct Components {
    parents: Vec<usize>,
}

impl Components {
    fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// The lowest id of the component of `id`. Halves the path to it on the way.
    fn root(&mut self, mut id: usize) -> usize {
        while self.parents[id] != id {
            self.parents[id] = self.parents[self.parents[id]];
            id = self.parents[id];
        }
        id
    }

    fn join(&mut self, first: usize, second: usize) {
        let (first, second) = (self.root(first), self.root(second));
        self.parents[first.max(second)] = first.min(second);
    }
}
