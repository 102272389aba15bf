//! Radii of groups of discs that belong together since time zero (Figs. 12 to 14).
//!
//! A group is a ring of [`start::rings`](crate::start::rings), or all discs that were at time zero in one of the shells
//! of equal width about the middle of the patch. The middle is that of the box, (L/2, L/2), where
//! [`start`](crate::start) puts patches; it is not the centre of mass.
//!
//! In: the box and positions, R0. Out: for each group the mean distance of its discs from the middle, by nearest images
//! (a patch that collapses stays within half a box), and the standard deviation of these distances, R0.
//!
//! ```
//! use meniscus::observables::radii::Groups;
//! use meniscus::start;
//! use meniscus_core::torus::Torus;
//!
//! let torus = Torus::new(800.0).unwrap();
//! let positions = start::rings(&torus, 9, 10, 19.29).unwrap();
//! let radii = Groups::rings(9, 10, 19.29).radii(&torus, &positions);
//! assert_eq!(radii.len(), 10, "the central disc and 9 rings");
//! assert_eq!(radii[7].group, 7);
//! assert!((radii[7].radius - 135.03).abs() < 1e-6);
//! assert!(radii[7].spread < 1e-6);
//! ```

use meniscus_core::torus::{Fraction, Position, Torus, minimum_image};

/// The middle of the box along an axis.
const MIDDLE: Fraction = Fraction::from_bits(1 << 31);

/// A group of discs.
#[derive(Clone, Debug, PartialEq)]
struct Group {
    number: u32,
    initial_radius: f64,
    members: Vec<u32>,
}

/// Where a group of discs is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupRadius {
    /// The number of the ring, 0 for the disc in the middle, or of the shell, 0 for the innermost.
    pub group: u32,
    /// The radius of the ring as laid out, or the mean of the borders of the shell, R0: what all runs of a kind have in
    /// common, and not the mean radius of the discs at time zero.
    pub initial_radius: f64,
    /// The mean distance of the group's discs from the middle, R0.
    pub radius: f64,
    /// The standard deviation of these distances, R0; 0 for a single disc.
    pub spread: f64,
}

/// Discs in groups, as they were at time zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups(Vec<Group>);

/// Why groups are refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GroupsError {
    /// Shells without a width.
    #[error("shells {width} R0 wide were asked for: take a width from 1e-3 R0 on")]
    Width {
        /// The width asked for, R0.
        width: f64,
    },
}

impl Groups {
    /// The disc in the middle and `rings` rings of `per_ring`·n discs, `spacing` (R0) apart, with the ids of
    /// [`start::rings`](crate::start::rings).
    #[must_use]
    pub fn rings(rings: u32, per_ring: u32, spacing: f64) -> Self {
        let mut first = 0_u32;
        let groups = (0..=rings).map(|number| {
            let count = if number == 0 { 1 } else { per_ring.saturating_mul(number) };
            let members = first..first.saturating_add(count);
            first = members.end;
            Group { number, initial_radius: spacing * f64::from(number), members: members.collect() }
        });
        Self(groups.collect())
    }

    /// Shells of `width` (R0) about the middle of the box, shell n holding the discs that were at time zero at
    /// n·`width` or farther and nearer than (n + 1)·`width`. Shells without discs are no groups.
    ///
    /// # Errors
    /// [`GroupsError::Width`] for a width below 10⁻³ R0.
    pub fn shells(torus: &Torus, initial: &[Position], width: f64) -> Result<Self, GroupsError> {
        if !(width >= 1e-3 && width.is_finite()) {
            return Err(GroupsError::Width { width });
        }
        let mut shells = std::collections::BTreeMap::<u32, Vec<u32>>::new();
        for (position, id) in initial.iter().zip(0..) {
            let shell = libm::floor(from_middle(torus, position) / width) as u32;
            shells.entry(shell).or_default().push(id);
        }
        let group = |(number, members)| {
            let initial_radius = width * (f64::from(number) + 0.5);
            Group { number, initial_radius, members }
        };
        Ok(Self(shells.into_iter().map(group).collect()))
    }

    /// Mean radius and spread of each group, from the inside outwards, with discs at `positions`.
    ///
    /// Ids that `positions` lack are passed over, and groups of which none is left.
    #[must_use]
    pub fn radii(&self, torus: &Torus, positions: &[Position]) -> Vec<GroupRadius> {
        let radius = |group: &Group| {
            let distances: Vec<f64> = (group.members.iter())
                .filter_map(|id| positions.get(*id as usize))
                .map(|position| from_middle(torus, position))
                .collect();
            let count = distances.len() as f64;
            let mean = distances.iter().sum::<f64>() / count;
            let squares = distances.iter().map(|distance| (distance - mean) * (distance - mean));
            let spread = (squares.sum::<f64>() / count).sqrt();
            let Group { number: group, initial_radius, .. } = *group;
            (!distances.is_empty()).then_some(GroupRadius { group, initial_radius, radius: mean, spread })
        };
        self.0.iter().filter_map(radius).collect()
    }
}

/// The distance of the nearest image from the middle of the box, R0.
fn from_middle(torus: &Torus, position: &Position) -> f64 {
    let along = |coordinate| torus.length(minimum_image(coordinate, MIDDLE));
    libm::hypot(along(position.x), along(position.y))
}
