//! The table of keys: every key of a configuration, what it accepts, its unit and what it means.
//!
//! Reading, messages and writing all follow [`KEYS`].
//!
//! ```
//! use meniscus::configuration::keys::{KEYS, nearest_key};
//!
//! assert!(KEYS.iter().any(|key| key.name == "mesh.grid"));
//! assert_eq!(nearest_key("mesh.gird"), Some("mesh.grid"));
//! assert_eq!(nearest_key("grid"), Some("mesh.grid"));
//! ```

use std::fmt;

use meniscus_core::fields::LARGEST_FIELD_FORCE;
use meniscus_core::parameters::{
    DISPLACEMENT_RANGE, GRID_RANGE, LARGEST_CAPILLARY_STRENGTH, LARGEST_PARTICLE_COUNT, LARGEST_SEED,
    LARGEST_STRENGTH, MESH_REFRESH_RANGE, SMALLEST_CAPILLARY_LENGTH, SMALLEST_CUTOFF, SPLITTING_RANGE,
    STEP_RANGE,
};
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::torus::LARGEST_SIDE;

use super::names::{self, words};
use super::{ACCURACY_RANGE, VERSION};
use crate::files::trajectory::Format;

/// What a key accepts. `Display` says it in words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A whole number in a range, ends included.
    Whole {
        /// Least accepted.
        least: u64,
        /// Most accepted.
        most: u64,
    },
    /// A power of two in a range, ends included.
    PowerOfTwo {
        /// Least accepted.
        least: u64,
        /// Most accepted.
        most: u64,
    },
    /// A number in a range.
    Real {
        /// Lower end.
        least: f64,
        /// Whether the lower end itself is accepted.
        closed: bool,
        /// Upper end, accepted unless infinite.
        most: f64,
        /// Whether infinity is accepted.
        infinite: bool,
    },
    /// Two numbers in a range, ends included: an array of the components along x and y.
    Pair {
        /// Least accepted.
        least: f64,
        /// Most accepted.
        most: f64,
    },
    /// One or more numbers in a range, ends included: an array.
    Numbers {
        /// Least accepted.
        least: f64,
        /// Most accepted.
        most: f64,
    },
    /// `true` or `false`.
    Boolean,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// The path of a file.
    Path,
}

/// One key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Dotted name.
    pub name: &'static str,
    /// What it accepts.
    pub kind: Kind,
    /// Unit in words; empty if none.
    pub unit: &'static str,
    /// Default in words; empty if the key is required where it is allowed.
    pub default: &'static str,
    /// What it means, in one line.
    pub help: &'static str,
}

impl Key {
    /// The key in its table, without the table's name.
    #[must_use]
    pub fn leaf(&self) -> &'static str {
        self.name.rsplit_once('.').map_or(self.name, |(_, leaf)| leaf)
    }

    /// The table it is in; empty for none.
    #[must_use]
    pub fn table(&self) -> &'static str {
        self.name.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// What it accepts with its unit, in words.
    #[must_use]
    pub fn accepted(&self) -> String {
        match self.unit {
            "" => self.kind.to_string(),
            unit => format!("{}, in {unit}", self.kind),
        }
    }
}

/// One table of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Table {
    /// Its name.
    pub name: &'static str,
    /// What it holds, in one line.
    pub help: &'static str,
}

/// The tables, in the order of writing.
pub const TABLES: &[Table] = &[
    Table { name: "system", help: "The discs, their box and their attraction, in disc radii R0 and kBT." },
    Table { name: "physical", help: "The discs, their box and their attraction, in SI." },
    Table { name: "force", help: "How the capillary force is summed." },
    Table { name: "mesh", help: "The mesh of the capillary force." },
    Table {
        name: "field",
        help: "External fields, which act on every disc alike; in R0 and kBT, with physical too.",
    },
    Table { name: "motion", help: "Thermal motion and the step rule." },
    Table { name: "start", help: "Where the discs are at time zero; lengths in R0." },
    Table { name: "time", help: "When the run ends." },
    Table { name: "output", help: "Intervals of what is written; 0 for none." },
];

/// Any finite number from 0 up.
const FROM_ZERO: Kind = Kind::Real { least: 0.0, closed: true, most: f64::INFINITY, infinite: false };
/// Any finite number above 0.
const ABOVE_ZERO: Kind = Kind::Real { least: 0.0, closed: false, most: f64::INFINITY, infinite: false };
/// Thresholds of dense regions, in units of the density of closest packing.
const THRESHOLD_RANGE: (f64, f64) = (0.001, 10.0);
/// Most shells of modes: waves grow as its square, 1.6 million.
const LARGEST_SHELL_COUNT: u64 = 1024;
/// A number of discs.
const COUNT: Kind = Kind::Whole { least: 1, most: LARGEST_PARTICLE_COUNT as u64 };
/// A capillary strength in kBT.
const STRENGTH: Kind =
    Kind::Real { least: 0.0, closed: true, most: LARGEST_CAPILLARY_STRENGTH, infinite: false };
/// Capillary strengths of discs.
const STRENGTHS: Kind = Kind::Numbers { least: -LARGEST_STRENGTH, most: LARGEST_STRENGTH };
/// What they mean.
const STRENGTHS_HELP: &str =
    "Strengths f of the discs, repeated over their ids: a pair attracts with V0*f_i*f_j";
/// Default of strengths in words.
const STRENGTHS_DEFAULT: &str = "[1], or those of the start's file";
/// The unit of times in words.
const TIMES: &str = "Jeans' times T, or R0^2/D if V0 or all strengths are 0";

const METHOD_WORDS: &[&str] = &names::method_words();
const ASSIGNMENT_WORDS: &[&str] = &words(&names::ASSIGNMENTS);
const INFLUENCE_WORDS: &[&str] = &words(&names::INFLUENCES);
const GRADIENT_WORDS: &[&str] = &words(&names::GRADIENTS);
const NOISE_WORDS: &[&str] = &words(&names::NOISES);
const LATTICE_WORDS: &[&str] = &words(&names::LATTICES);
const START_WORDS: &[&str] = &names::start_words();

/// Every key, in the order of writing.
pub const KEYS: &[Key] = &[
    Key {
        name: "version",
        kind: Kind::Whole { least: VERSION as u64, most: VERSION as u64 },
        unit: "",
        default: "",
        help: "Version of this format",
    },
    Key {
        name: "seed",
        kind: Kind::Whole { least: 0, most: LARGEST_SEED },
        unit: "",
        default: "1",
        help: "Seed of the start and of the noise",
    },
    Key { name: "system.particles", kind: COUNT, unit: "", default: "", help: "Number N of discs" },
    Key {
        name: "system.box",
        kind: Kind::Real { least: 2.0 * CUTOFF, closed: false, most: LARGEST_SIDE, infinite: false },
        unit: "R0",
        default: "",
        help: "Side L of the square periodic box",
    },
    Key {
        name: "system.capillary_strength",
        kind: STRENGTH,
        unit: "kBT",
        default: "",
        help: "Strength V0 of the capillary attraction, 0 for none",
    },
    Key {
        name: "system.capillary_length",
        kind: Kind::Real {
            least: SMALLEST_CAPILLARY_LENGTH,
            closed: true,
            most: f64::INFINITY,
            infinite: true,
        },
        unit: "R0",
        default: "inf if V0 = 0, else required",
        help: "Capillary length lambda, the range of the attraction",
    },
    Key {
        name: "system.strengths",
        kind: STRENGTHS,
        unit: "",
        default: STRENGTHS_DEFAULT,
        help: STRENGTHS_HELP,
    },
    Key {
        name: "system.repulsion",
        kind: Kind::Boolean,
        unit: "",
        default: "true",
        help: "Whether discs repel each other at contact",
    },
    Key { name: "physical.particles", kind: COUNT, unit: "", default: "", help: "Number N of discs" },
    Key { name: "physical.radius", kind: ABOVE_ZERO, unit: "m", default: "", help: "Disc radius R0" },
    Key {
        name: "physical.box",
        kind: ABOVE_ZERO,
        unit: "m",
        default: "",
        help: "Side L of the square periodic box",
    },
    Key {
        name: "physical.capillary_length",
        kind: Kind::Real { least: 0.0, closed: false, most: f64::INFINITY, infinite: true },
        unit: "m",
        default: "inf if V0 = 0, else required",
        help: "Capillary length lambda, the range of the attraction",
    },
    Key {
        name: "physical.capillary_strength",
        kind: STRENGTH,
        unit: "kBT",
        default: "from force and surface_tension",
        help: "Strength V0 of the capillary attraction, 0 for none",
    },
    Key {
        name: "physical.force",
        kind: Kind::Real { least: f64::NEG_INFINITY, closed: false, most: f64::INFINITY, infinite: false },
        unit: "N",
        default: "none: capillary_strength is given instead",
        help: "Vertical force f on each disc; V0 = f^2/(2 pi gamma)",
    },
    Key {
        name: "physical.surface_tension",
        kind: ABOVE_ZERO,
        unit: "N/m",
        default: "none: capillary_strength is given instead",
        help: "Surface tension gamma of the interface",
    },
    Key {
        name: "physical.strengths",
        kind: STRENGTHS,
        unit: "",
        default: STRENGTHS_DEFAULT,
        help: STRENGTHS_HELP,
    },
    Key { name: "physical.temperature", kind: ABOVE_ZERO, unit: "K", default: "", help: "Temperature" },
    Key {
        name: "physical.mobility",
        kind: ABOVE_ZERO,
        unit: "s/kg",
        default: "",
        help: "Mobility Gamma of a disc; D = kBT*Gamma",
    },
    Key {
        name: "physical.repulsion",
        kind: Kind::Boolean,
        unit: "",
        default: "true",
        help: "Whether discs repel each other at contact",
    },
    Key {
        name: "force.method",
        kind: Kind::Choice(METHOD_WORDS),
        unit: "",
        default: "\"p3m\"",
        help: "Method of summation: mesh and near pairs to a given accuracy, or the mesh alone, as in the paper",
    },
    Key {
        name: "force.accuracy",
        kind: Kind::Real { least: ACCURACY_RANGE.0, closed: true, most: ACCURACY_RANGE.1, infinite: false },
        unit: "",
        default: "0.001",
        help: "Largest estimated error of p3m, rms, relative to the rms force of discs at random",
    },
    Key {
        name: "force.splitting",
        kind: Kind::Real { least: SPLITTING_RANGE.0, closed: true, most: SPLITTING_RANGE.1, infinite: false },
        unit: "1/R0",
        default: "chosen for the accuracy",
        help: "Splitting alpha of p3m: the larger, the more is left to the mesh",
    },
    Key {
        name: "force.cutoff",
        kind: Kind::Real { least: SMALLEST_CUTOFF, closed: true, most: f64::INFINITY, infinite: false },
        unit: "R0",
        default: "chosen for the accuracy",
        help: "Cut-off of the near part of p3m, below half the box",
    },
    Key {
        name: "force.mesh_refresh",
        kind: Kind::Real { least: 0.0, closed: true, most: MESH_REFRESH_RANGE.1, infinite: false },
        unit: "R0",
        default: "0",
        help: "How far a disc moves before the force of the mesh is computed anew, also if the state at the start holds it and other \
               keys have changed, from 2^-20 R0 and below a quarter of the box; 0 for every step",
    },
    Key {
        name: "mesh.grid",
        kind: Kind::PowerOfTwo { least: GRID_RANGE.0 as u64, most: GRID_RANGE.1 as u64 },
        unit: "",
        default: "with p3m chosen for the accuracy, with pm the smallest that gives a spacing of at most 1 R0",
        help: "Nodes along a side",
    },
    Key {
        name: "mesh.assignment",
        kind: Kind::Choice(ASSIGNMENT_WORDS),
        unit: "",
        default: "with p3m chosen for the accuracy, with pm \"tsc\"",
        help: "Mass assignment: cloud in cell (4 nodes), triangular shaped cloud (9), or a B-spline of higher order",
    },
    Key {
        name: "mesh.influence",
        kind: Kind::Choice(INFLUENCE_WORDS),
        unit: "",
        default: "\"optimal\" with p3m, \"paper\" with pm",
        help: "Influence function: with pm the paper's (five-point Laplacian) or the continuum's, with p3m the optimal",
    },
    Key {
        name: "mesh.gradient",
        kind: Kind::Choice(GRADIENT_WORDS),
        unit: "",
        default: "\"spectral\"",
        help: "Gradient: spectral, or with pm a central difference of 2 or 4 points",
    },
    Key {
        name: "field.uniform_force",
        kind: Kind::Pair { least: -LARGEST_FIELD_FORCE, most: LARGEST_FIELD_FORCE },
        unit: "kBT/R0",
        default: "[0, 0]",
        help: "Uniform force along x and y",
    },
    Key {
        name: "field.trap_stiffness",
        kind: FROM_ZERO,
        unit: "kBT/R0^2",
        default: "0",
        help: "Stiffness k of a harmonic trap, 0 for none: the force is -k times the distance from its centre",
    },
    Key {
        name: "field.trap_center",
        kind: Kind::Pair { least: 0.0, most: LARGEST_SIDE },
        unit: "R0",
        default: "the middle of the box",
        help: "Centre of the trap",
    },
    Key {
        name: "motion.noise",
        kind: Kind::Choice(NOISE_WORDS),
        unit: "",
        default: "\"uniform\"",
        help: "Thermal displacement, variance 2*dt per component; none is temperature zero",
    },
    Key {
        name: "motion.max_step",
        kind: Kind::Real { least: STEP_RANGE.0, closed: true, most: STEP_RANGE.1, infinite: false },
        unit: "R0^2/D",
        default: "0.001",
        help: "Ceiling of the time step",
    },
    Key {
        name: "motion.max_displacement",
        kind: Kind::Real {
            least: DISPLACEMENT_RANGE.0,
            closed: true,
            most: DISPLACEMENT_RANGE.1,
            infinite: false,
        },
        unit: "R0",
        default: "0.25",
        help: "Largest displacement by force in a step",
    },
    Key {
        name: "start.kind",
        kind: Kind::Choice(START_WORDS),
        unit: "",
        default: "\"random\"",
        help: "How the discs are placed",
    },
    Key {
        name: "start.radius",
        kind: ABOVE_ZERO,
        unit: "R0",
        default: "",
        help: "Radius of the disc in which the centres lie",
    },
    Key { name: "start.rings", kind: COUNT, unit: "", default: "", help: "Number of rings" },
    Key {
        name: "start.spacing",
        kind: ABOVE_ZERO,
        unit: "R0",
        default: "",
        help: "Distance between rings: ring n has the radius n*spacing",
    },
    Key {
        name: "start.per_ring",
        kind: COUNT,
        unit: "",
        default: "",
        help: "Discs in the innermost ring: ring n has n*per_ring",
    },
    Key {
        name: "start.lattice",
        kind: Kind::Choice(LATTICE_WORDS),
        unit: "",
        default: "\"square\"",
        help: "Lattice that fills the box",
    },
    Key {
        name: "start.path",
        kind: Kind::Path,
        unit: "",
        default: "",
        help: "File of positions, relative to the working directory",
    },
    Key {
        name: "start.density",
        kind: ABOVE_ZERO,
        unit: "R0^-2",
        default: "that of the box, N/L^2",
        help: "Mean density that defines Jeans' time",
    },
    Key {
        name: "time.until",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "5 T, or 10 R0^2/D if there is no T",
        help: "End of the run",
    },
    Key {
        name: "output.observables",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0.01",
        help: "Interval of the rows of observables.csv",
    },
    Key {
        name: "output.trajectory",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0.1",
        help: "Interval of the frames of the trajectory",
    },
    Key {
        name: "output.trajectory_format",
        kind: Kind::Choice(&words(&Format::WORDS)),
        unit: "",
        default: "gsd",
        help: "Format of the trajectory: trajectory.gsd, .xyz, .lammpstrj or .npz",
    },
    Key {
        name: "output.snapshots",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "1",
        help: "Interval of the snapshots (pictures)",
    },
    Key {
        name: "output.minkowski",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0",
        help: "Interval of the Minkowski functionals of dense regions in minkowski.csv",
    },
    Key {
        name: "output.minkowski_spacing",
        kind: ABOVE_ZERO,
        unit: "R0",
        default: "5.3",
        help: "Spacing of the grid of the density that they are those of: 4 to 8192 cells along the box",
    },
    Key {
        name: "output.minkowski_thresholds",
        kind: Kind::Numbers { least: THRESHOLD_RANGE.0, most: THRESHOLD_RANGE.1 },
        unit: "1/(2 sqrt(3)) R0^-2",
        default: "[0.14]",
        help: "Densities from which on a region is dense, increasing, over that of closest packing",
    },
    Key {
        name: "output.modes",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0",
        help: "Interval of the density modes by shells of wavenumbers in modes.csv",
    },
    Key {
        name: "output.modes_shells",
        kind: Kind::Whole { least: 1, most: LARGEST_SHELL_COUNT },
        unit: "",
        default: "those below the critical wavenumber, 8 to 64",
        help: "Number of shells, of width 2 pi/L around multiples of 2 pi/L",
    },
    Key {
        name: "output.radial_distribution",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0",
        help: "Interval of the pair distribution g(r) in radial_distribution.csv",
    },
    Key {
        name: "output.structure_factor",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0",
        help: "Interval of the static structure factor S(k) in structure_factor.csv",
    },
    Key {
        name: "output.radii",
        kind: FROM_ZERO,
        unit: TIMES,
        default: "0",
        help: "Interval of the mean radii of the rings or shells of a patch in radii.csv",
    },
    Key {
        name: "output.radii_width",
        kind: ABOVE_ZERO,
        unit: "R0",
        default: "7.5",
        help: "Width of shells of discs by their radius at the start, at least 1e-3; a start in rings goes by its rings",
    },
    Key {
        name: "output.checkpoint_steps",
        kind: Kind::Whole { least: 0, most: i64::MAX as u64 },
        unit: "",
        default: "0",
        help: "Steps between checkpoints, from which `meniscus resume` goes on; 0 for none",
    },
    Key {
        name: "output.checkpoint_minutes",
        kind: FROM_ZERO,
        unit: "minutes of wall time",
        default: "10",
        help: "Time between checkpoints; 0 for none but at the start and at the end",
    },
];

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Whole { least, most } if least == most => write!(formatter, "{least}"),
            Self::Whole { least, most } => write!(formatter, "a whole number from {least} to {most}"),
            Self::PowerOfTwo { least, most } => write!(formatter, "a power of two from {least} to {most}"),
            Self::Real { least, closed, most, infinite } => {
                match (least.is_finite(), closed, most.is_finite()) {
                    (false, _, _) => formatter.write_str("a finite number")?,
                    (true, true, true) => {
                        write!(formatter, "a number from {} to {}", plain(least), plain(most))?;
                    }
                    (true, true, false) => write!(formatter, "a number of at least {}", plain(least))?,
                    (true, false, true) => {
                        write!(formatter, "a number above {} and at most {}", plain(least), plain(most))?;
                    }
                    (true, false, false) => write!(formatter, "a number above {}", plain(least))?,
                }
                if infinite { formatter.write_str(" or inf") } else { Ok(()) }
            }
            Self::Pair { least, most } => {
                write!(formatter, "[x, y], two numbers from {} to {}", plain(least), plain(most))
            }
            Self::Numbers { least, most } => {
                write!(formatter, "an array of numbers from {} to {}", plain(least), plain(most))
            }
            Self::Boolean => formatter.write_str("true or false"),
            Self::Choice(words) => {
                for (index, word) in words.iter().enumerate() {
                    let separator = match index {
                        0 => "",
                        _ if index + 1 == words.len() => " or ",
                        _ => ", ",
                    };
                    write!(formatter, "{separator}\"{word}\"")?;
                }
                Ok(())
            }
            Self::Path => formatter.write_str("the path of a file, in quotes"),
        }
    }
}

/// The number with the fewest digits that read back to it, whole numbers without a point.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// The key of that dotted name.
#[must_use]
pub fn key(name: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.name == name)
}

/// The known key nearest to an unknown one, if any is near: one with the same last part, or one that
/// few changes of letters make.
#[must_use]
pub fn nearest_key(unknown: &str) -> Option<&'static str> {
    let leaf = unknown.rsplit_once('.').map_or(unknown, |(_, leaf)| leaf);
    let namesakes = KEYS.iter().filter(|key| key.leaf() == leaf).map(|key| key.name);
    nearest(unknown, namesakes, usize::MAX)
        .or_else(|| nearest(unknown, KEYS.iter().map(|key| key.name), tolerance(unknown)))
        .or_else(|| {
            KEYS.iter().find(|key| nearest(leaf, [key.leaf()], tolerance(leaf)).is_some()).map(|key| key.name)
        })
}

/// The known table nearest to an unknown one, if any is near.
#[must_use]
pub fn nearest_table(unknown: &str) -> Option<&'static str> {
    nearest(unknown, TABLES.iter().map(|table| table.name), tolerance(unknown))
}

/// The most similar of `known` if at most `tolerance` changes of letters away.
pub(crate) fn nearest(
    unknown: &str,
    known: impl IntoIterator<Item = &'static str>,
    tolerance: usize,
) -> Option<&'static str> {
    /// Longer names are nobody's slip, and distances to them are slow.
    const LONGEST: usize = 80;
    if unknown.len() > LONGEST {
        return None;
    }
    known
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(unknown, name), name))
        .filter(|(distance, _)| *distance <= tolerance)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// How many changes of letters a slip may be: a third of the name.
pub(crate) fn tolerance(name: &str) -> usize {
    name.len().div_ceil(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_in_a_known_table() {
        for (index, key) in KEYS.iter().enumerate() {
            assert!(KEYS[..index].iter().all(|other| other.name != key.name), "{}", key.name);
            let table = key.table();
            assert!(table.is_empty() || TABLES.iter().any(|known| known.name == table), "{}", key.name);
            assert!(!key.help.is_empty() && !key.help.ends_with('.'), "{}", key.name);
        }
    }

    #[test]
    fn ranges_are_said_in_words() {
        let accepted = |name| key(name).map(Key::accepted).unwrap();
        assert_eq!(accepted("version"), "1");
        assert_eq!(accepted("system.particles"), "a whole number from 1 to 4194304");
        assert_eq!(accepted("system.capillary_strength"), "a number from 0 to 1000, in kBT");
        assert_eq!(accepted("system.capillary_length"), "a number of at least 0.01 or inf, in R0");
        assert_eq!(accepted("physical.force"), "a finite number, in N");
        assert_eq!(accepted("physical.radius"), "a number above 0, in m");
        assert_eq!(accepted("mesh.gradient"), "\"spectral\", \"difference-2\" or \"difference-4\"");
        assert_eq!(accepted("system.repulsion"), "true or false");
    }

    #[test]
    fn slips_are_recognised() {
        assert_eq!(nearest_key("system.partcles"), Some("system.particles"));
        assert_eq!(nearest_key("physical.particels"), Some("physical.particles"));
        assert_eq!(nearest_key("system.grid"), Some("mesh.grid"));
        assert_eq!(nearest_key("until"), Some("time.until"));
        assert_eq!(nearest_key("quite.another.thing"), None);
        assert_eq!(nearest_key(&"x".repeat(10_000)), None);
        assert_eq!(nearest_table("sytem"), Some("system"));
    }
}
