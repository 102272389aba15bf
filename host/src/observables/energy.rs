//! The potential energy of a state: what the capillary attraction and the repulsion at contact hold.
//!
//! In: the system, positions, capillary strengths. Out: [`Energies`] in kBT, computed in binary64 from the positions
//! alone and not with the forces of a run, so that it is the same whatever summed those.
//!
//! **Capillary**: −V0 Σ f_i f_j K₀(d/λ) over all pairs of discs and all periodic images of one of the two (Eq. 1), with
//! the strengths f of the discs, all 1 unless given. What a disc has with its own images never changes and is left out.
//! For finite λ this is the sum itself; its mean over the positions of a pair, −f_i f_j 2πV0λ²/L², is in it and is by
//! far the largest part once λ exceeds L. For λ = ∞ (and a λ whose square is no number) the sum has no value: a
//! neutralising background is put in, which makes the mean over the positions of a pair zero.
//!
//! External fields are not in it. The last digits of the capillary energy may differ between platforms, whose sines go into
//! the transform; no state depends on them.
//!
//! **Repulsive**: 4[(2/d)¹² − (2/d)⁶ + 1/4] of every pair closer than d_c = 2·2^(1/6) R0 (Eq. 15).
//!
//! Closer than [`SMALLEST_DISTANCE`] both go on as the straight lines whose slopes are their forces there, as forces no
//! longer grow below it.
//!
//! The capillary sum is cut as Ewald did (see `near` and `far`): what is short-ranged is summed over pairs, what is
//! smooth over the waves of a mesh. Where it is cut decides the time it takes, not the energy: about 10 ms for 2500
//! discs. Differences of energy give back the forces to 1e-6 rms and better.
//!
//! ```
//! use meniscus::configuration::System;
//! use meniscus::observables::energy::PotentialEnergy;
//! use meniscus_core::torus::Position;
//!
//! let system = System {
//!     particles: 2,
//!     side: 64.0,
//!     capillary_strength: 0.89,
//!     capillary_length: 5.0,
//!     repulsion: true,
//! };
//! // Two discs in contact, 2 R0 apart, across the border.
//! let positions = [Position::from_bits(0, 0), Position::from_bits((1_u32 << 27).wrapping_neg(), 0)];
//! let energies = PotentialEnergy::new(&system).of(&positions, None);
//! let bessel_k0_of_two_fifths = 1.114_529;
//! assert!((energies.capillary + 0.89 * bessel_k0_of_two_fifths).abs() < 1e-4);
//! assert!((energies.repulsive - 1.0).abs() < 1e-12);
//! ```

mod far;
mod near;
mod split;

use core::f64::consts::TAU;

use crate::configuration::System;
use far::FarPart;
use meniscus_core::assignment::DISC;
use meniscus_core::cells::for_each_pair;
use meniscus_core::repulsion::{CUTOFF, SMALLEST_DISTANCE};
use meniscus_core::torus::{Fraction, Position, UNITS};
use near::NearPart;
use split::Split;

/// The potential energy of a state, kBT.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Of the capillary attraction.
    pub capillary: f64,
    /// Of the repulsion at contact; 0 if it is switched off.
    pub repulsive: f64,
}

/// What the energy of a system's states is computed with, set up once.
#[derive(Clone, Debug)]
pub struct PotentialEnergy {
    side: f64,
    repulsion: bool,
    /// None without attraction.
    capillary: Option<Capillary>,
}

impl PotentialEnergy {
    /// That of `system`; its number of discs only decides what is fastest.
    #[must_use]
    pub fn new(system: &System) -> Self {
        Self::with_split(system, Split::fastest(system.side, system.particles))
    }

    /// The same by a mesh of at least `nodes` nodes a side, a power of two from 32 to 4096. The mesh decides where the
    /// sum is cut, and no energy depends on that but by its error.
    #[must_use]
    pub fn with_mesh(system: &System, nodes: usize) -> Self {
        Self::with_split(system, Split::of_mesh(system.side, nodes))
    }

    /// Nodes a side of the mesh that [`PotentialEnergy::new`] takes, which is what takes memory; 0 if it takes none.
    #[must_use]
    pub fn mesh_nodes(system: &System) -> usize {
        let attracting = system.capillary_strength != 0.0;
        if attracting { Split::fastest(system.side, system.particles).nodes } else { 0 }
    }

    fn with_split(system: &System, split: Split) -> Self {
        let attracting = system.capillary_strength != 0.0;
        Self {
            side: system.side,
            repulsion: system.repulsion,
            capillary: attracting.then(|| Capillary::new(system, split)),
        }
    }

    /// The energy of discs at `positions`, an id being a place in the slice.
    ///
    /// `strengths` are the capillary strengths f of the discs by id, of either sign, unit 2⁻²⁰ ([`DISC`] for 1); a disc
    /// without one has 1.
    #[must_use]
    pub fn of(&self, positions: &[Position], strengths: Option<&[i32]>) -> Energies {
        let discs = Discs::new(self.side, positions, strengths);
        Energies {
            capillary: self.capillary.as_ref().map_or(0.0, |capillary| capillary.energy(&discs)),
            repulsive: if self.repulsion { repulsive_energy(&discs) } else { 0.0 },
        }
    }
}

/// The discs of a state.
struct Discs {
    /// L, R0.
    side: f64,
    x: Vec<Fraction>,
    y: Vec<Fraction>,
    /// f.
    strengths: Vec<f64>,
}

impl Discs {
    /// Memory for cells a disc: fine ones, so that a dense cluster does not fill a few.
    const CELLS_PER_DISC: usize = 8;
    /// Memory for cells if there are few discs.
    const FEWEST_CELLS: usize = 1024;

    fn new(side: f64, positions: &[Position], strengths: Option<&[i32]>) -> Self {
        let given = |id: usize| strengths.and_then(|strengths| strengths.get(id));
        let strength = |id: usize| given(id).map_or(1.0, |&strength| f64::from(strength) / f64::from(DISC));
        let (x, y) = positions.iter().map(|position| (position.x, position.y)).unzip();
        Self { side, x, y, strengths: (0..positions.len()).map(strength).collect() }
    }

    /// The sum of `term(f_i f_j, d²)` (d² in R0²) over the pairs whose nearest images are closer than `distance` (R0),
    /// and some that are not.
    fn sum_over_pairs(&self, distance: f64, term: impl Fn(f64, f64) -> f64) -> f64 {
        const LARGEST_REACH: f64 = i32::MAX as f64;
        let reach = libm::ceil(distance / self.side * UNITS).min(LARGEST_REACH) as u32;
        let unit = self.side / UNITS;
        let count = self.x.len();
        let mut heads = vec![0; (Self::CELLS_PER_DISC * count).max(Self::FEWEST_CELLS)];
        let mut next = vec![0; count];
        let mut sum = 0.0;
        for_each_pair((&self.x, &self.y), reach, &mut heads, &mut next, |first, second, separation| {
            let (x, y) = (f64::from(separation.x) * unit, f64::from(separation.y) * unit);
            sum += term(self.strengths[first] * self.strengths[second], x * x + y * y);
        });
        sum
    }
}

/// The capillary energy, in parts whose sum is free of the splitting α.
#[derive(Clone, Debug)]
struct Capillary {
    /// V0, kBT.
    strength: f64,
    near: NearPart,
    far: FarPart,
    /// What no wave but k = 0 holds: −energy/V0 of any pair of strengths 1.
    uniform: f64,
}

impl Capillary {
    fn new(system: &System, split: Split) -> Self {
        let System { side, capillary_strength: strength, capillary_length, .. } = *system;
        let screening_square = 1.0 / (capillary_length * capillary_length);
        let splitting_square = split.splitting * split.splitting;
        let screened = screening_square / (4.0 * splitting_square);
        // The far part of k = 0 for finite λ; else what makes the mean of the near part zero.
        let uniform = if screening_square > 0.0 {
            libm::exp(-screened) / screening_square
        } else {
            -0.25 / splitting_square
        };
        Self {
            strength,
            near: NearPart::new(split.splitting, screened, split.cutoff),
            far: FarPart::new(side, screening_square, split.splitting, split.nodes),
            uniform: TAU / (side * side) * uniform,
        }
    }

    fn energy(&self, discs: &Discs) -> f64 {
        let sum: f64 = discs.strengths.iter().sum();
        let squares: f64 = discs.strengths.iter().map(|strength| strength * strength).sum();
        let near = discs
            .sum_over_pairs(self.near.cutoff(), |strengths, square| strengths * self.near.potential(square));
        let far = self.far.sum_over_pairs(discs, squares);
        // A product with 0 discs or 1 is 0; +0 rather than −0.
        0.0 - self.strength * (near + far + 0.5 * (sum * sum - squares) * self.uniform)
    }
}

/// Energy of the repulsion, kBT (Eq. 15).
fn repulsive_energy(discs: &Discs) -> f64 {
    discs.sum_over_pairs(CUTOFF, |_, square| repulsive_pair_energy(square))
}

/// Energy of the repulsion of two discs whose squared distance is `square` (R0²), kBT.
fn repulsive_pair_energy(square: f64) -> f64 {
    if square >= CUTOFF * CUTOFF {
        return 0.0;
    }
    let held = square.max(SMALLEST_DISTANCE * SMALLEST_DISTANCE);
    let inverse = 4.0 / held;
    let sixth = inverse * inverse * inverse;
    let energy = 4.0 * (sixth * sixth - sixth + 0.25);
    if square == held {
        return energy;
    }
    let force = 24.0 * sixth * (2.0 * sixth - 1.0) / SMALLEST_DISTANCE;
    energy + force * (SMALLEST_DISTANCE - square.sqrt())
}
