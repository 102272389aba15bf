//! What an invariant accepts, and what it says when it does not hold.
//!
//! ```
//! use meniscus_core::property::{Discs, Invariant, Tolerance, forces};
//! use meniscus_core::torus::Torus;
//!
//! let discs = Discs::from_coordinates(Torus::new(64.0).unwrap(), &[[1.0, 2.0], [3.0, 4.0]]);
//! let pushes_all = |discs: &Discs| vec![[0.5, 0.0]; discs.len()];
//! let violation = forces::momentum(pushes_all, &discs, Tolerance::relative(1e-6)).unwrap_err();
//! assert_eq!(violation.invariant, Invariant::Momentum);
//! assert_eq!(violation.to_string(), "momentum: off by 1e0 kBT/R0, accepted 1e-6");
//! ```

use core::fmt;
use std::vec::Vec;

/// How far a kernel may be off: `relative` times the scale of the invariant, which each one states, plus `absolute`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Fraction of the scale of the invariant.
    pub relative: f64,
    /// In the unit of what is compared: kBT/R0 for forces, discs for masses.
    pub absolute: f64,
}

impl Tolerance {
    /// Nothing: for sums of integers and whatever else is equal bit for bit.
    pub const EXACT: Self = Self { relative: 0.0, absolute: 0.0 };

    /// A fraction of the scale of the invariant and no more.
    #[must_use]
    pub const fn relative(relative: f64) -> Self {
        Self { relative, absolute: 0.0 }
    }

    /// The same whatever the scale is: kBT/R0 for forces, discs for masses.
    #[must_use]
    pub const fn absolute(absolute: f64) -> Self {
        Self { relative: 0.0, absolute }
    }

    /// What is accepted at a scale.
    pub(super) fn at(self, scale: f64) -> f64 {
        self.relative * scale + self.absolute
    }
}

macro_rules! invariants {
    ($($(#[$attribute:meta])* $invariant:ident, $name:literal, $unit:literal;)*) => {
        /// What should hold, see the function of the same name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Invariant { $($(#[$attribute])* $invariant,)* }

        impl Invariant {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$invariant,)*];

            /// Its name in words.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$invariant => $name,)* }
            }

            /// The unit of what a [`Violation`] of it found.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$invariant => $unit,)* }
            }
        }
    };
}

invariants! {
    /// A kernel gives as many values as it is asked for; looked at by all functions that take a kernel of a state.
    Count, "number of values", "values";
    /// [`super::forces::momentum`]
    Momentum, "momentum", "kBT/R0";
    /// [`super::forces::self_force`]
    SelfForce, "self-force", "kBT/R0";
    /// [`super::forces::translation`] and [`super::forces::translation_by_cells`]
    Translation, "translation", "kBT/R0";
    /// [`super::forces::quarter_turns`]
    QuarterTurns, "quarter turns", "kBT/R0";
    /// [`super::forces::reflections`]
    Reflections, "reflections", "kBT/R0";
    /// [`super::forces::permutation`]
    Permutation, "permutation", "kBT/R0";
    /// [`super::forces::wrap`] and [`super::pairs::wrap`]
    Wrap, "wrap", "kBT/R0";
    /// [`super::forces::energy_consistency`]
    EnergyConsistency, "energy consistency", "kBT/R0";
    /// [`super::forces::opposite_strength`]
    OppositeStrength, "opposite strength", "kBT/R0";
    /// [`super::pairs::pair_symmetry`]
    PairSymmetry, "pair symmetry", "kBT/R0";
    /// [`super::pairs::centrality`]
    Centrality, "centrality", "kBT/R0";
    /// [`super::pairs::isotropy`]
    Isotropy, "isotropy", "kBT/R0";
    /// [`super::pairs::attraction`]
    Attraction, "attraction", "kBT/R0";
    /// [`super::pairs::far_field`]
    FarField, "far field", "kBT/R0";
    /// [`super::pairs::screening`]
    Screening, "screening", "kBT/R0";
    /// [`super::masses::total`]
    TotalMass, "total mass", "discs";
    /// [`super::masses::superposition`]
    Superposition, "superposition", "discs";
    /// [`super::masses::translation_by_cells`]
    MassTranslation, "translation of mass", "discs";
    /// [`super::masses::center_of_mass`]
    CenterOfMass, "center of mass", "cells";
}

/// An invariant that does not hold. [`fmt::Display`] tells it in one line of ASCII; being an error, it turns into
/// proptest's `TestCaseError` by `?`.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Which one.
    pub invariant: Invariant,
    /// How far off the worst value is, in [`Invariant::unit`]; not a number if a kernel gave none.
    pub found: f64,
    /// How far off it was allowed to be.
    pub allowed: f64,
    /// Ids of the discs at fault, or nodes of the mesh for masses; empty if it is all of them together.
    pub at: Vec<usize>,
}

/// How many ids a message names.
const NAMED: usize = 8;

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { invariant, found, allowed, at } = self;
        if *invariant == Invariant::Count {
            return write!(formatter, "{}: {found}, not {allowed}", invariant.name());
        }
        write!(
            formatter,
            "{}: off by {found:e} {}, accepted {allowed:e}",
            invariant.name(),
            invariant.unit()
        )?;
        for (index, id) in at.iter().take(NAMED).enumerate() {
            write!(formatter, "{} {id}", if index == 0 { "; at" } else { "," })?;
        }
        match at.len().saturating_sub(NAMED) {
            0 => Ok(()),
            more => write!(formatter, " and {more} more"),
        }
    }
}

impl core::error::Error for Violation {}

/// `Ok` if `found` is at most `allowed`, which no NaN is.
pub(super) fn check(
    invariant: Invariant,
    found: f64,
    allowed: f64,
    at: impl IntoIterator<Item = usize>,
) -> Result<(), Violation> {
    if found <= allowed {
        return Ok(());
    }
    Err(Violation { invariant, found, allowed, at: at.into_iter().collect() })
}

/// `Ok` if a kernel gave as many values as expected.
pub(super) fn check_count(found: usize, expected: usize) -> Result<(), Violation> {
    if found == expected {
        return Ok(());
    }
    let (found, allowed) = (found as f64, expected as f64);
    Err(Violation { invariant: Invariant::Count, found, allowed, at: Vec::new() })
}

/// `Ok` if no error exceeds `allowed`; otherwise all that do, with the largest of them.
pub(super) fn check_each(
    invariant: Invariant,
    errors: impl IntoIterator<Item = f64>,
    allowed: f64,
) -> Result<(), Violation> {
    let (mut worst, mut at) = (0.0_f64, Vec::new());
    for (index, error) in errors.into_iter().enumerate() {
        if !error.is_nan() && error <= allowed {
            continue;
        }
        // Once not a number, the worst remains so.
        if !worst.is_nan() && (error.is_nan() || error > worst) {
            worst = error;
        }
        at.push(index);
    }
    if at.is_empty() { Ok(()) } else { Err(Violation { invariant, found: worst, allowed, at }) }
}
