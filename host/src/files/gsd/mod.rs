//! Trajectories as GSD files with the schema of HOOMD, which gsd, freud, MDAnalysis and OVITO open.
//!
//! A frame has these chunks; those marked 0 are in frame 0 only, or again when the number of discs changes:
//!
//! | Chunk | Numbers | What |
//! |---|---|---|
//! | `configuration/step` | u64 | steps made |
//! | `configuration/dimensions` | u8 | 0: 2 |
//! | `configuration/box` | f32 × 6 | 0: L, L, 0, 0, 0, 0, R0 |
//! | `particles/N` | u32 | 0: number of discs n |
//! | `particles/types` | u8 × 64 | 0: `disc` |
//! | `particles/typeid` | u32, n | 0: 0 for all |
//! | `particles/diameter` | f32, n | 0: 2 R0 for all |
//! | `particles/position` | f32 × 3, n | x − L/2, y − L/2, 0 in R0, at least −L/2 and less than L/2 |
//! | `particles/image` | i32 × 3, n | how often a disc went around the box along x and y; 0 |
//! | `log/time`, `log/dt` | f64 | time, and length of the next step, R0²/D |
//! | `log/time_over_jeans` | f64 | time in Jeans' times, where there is one |
//! | `log/max_force` | f64 | largest force, kBT/R0, if known |
//! | `log/clusters`, `log/largest_cluster` | u32 | number of clusters n_c, and discs in the largest |
//! | `log/mean_cluster_size`, `log/mass_weighted_cluster_size` | f64 | mean numbers of discs of a cluster |
//! | `log/particles/clustered` | u8, n | whether a disc belongs to a cluster, 1 or 0 |
//! | `log/particles/strength` | f64, n | capillary strengths, unless all are 1 |
//! | `log/meniscus/box` | f64 | L exactly |
//! | `log/meniscus/time` | u64 | time exactly, unit 2⁻⁴⁰ R0²/D |
//! | `log/particles/position_bits` | u32 × 2, n | positions exactly, unit L·2⁻³² |
//!
//! Discs are in the order of their ids. Every frame is on the disk when it has been appended, since the bytes depend on
//! when they go there.
//!
//! Read are frames of this program, exactly, and of others: two-dimensional, in a square box with discs in it. Their
//! positions become the nearest fractions of the box. Held mesh forces are not in these files.
//!
//! ```
//! use meniscus::files::extended_xyz::FrameChoice;
//! use meniscus::files::gsd;
//! use meniscus::files::trajectory::{Format, Frame, Trajectory};
//! use meniscus_core::torus::{Position, Torus};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("trajectory.gsd");
//! let torus = Torus::new(33.3).unwrap();
//! let positions = [Position::from_bits(1, u32::MAX)];
//! let mut trajectory = Trajectory::create(&path, Format::Gsd, &torus).unwrap();
//! trajectory.append(&Frame { step: 7, time: 123, positions: &positions, ..Frame::default() }).unwrap();
//!
//! let state = gsd::read(&path, &torus, FrameChoice::Last).unwrap();
//! assert_eq!((state.step, state.time, state.positions), (7, 123, positions.to_vec()));
//! ```

mod container;
mod read;
mod write;

pub use read::GsdReader;
pub(super) use write::GsdTrajectory;

use super::extended_xyz::FrameChoice;
use super::state::State;
use super::{FileError, read_with};
use meniscus_core::torus::{Fraction, Torus, UNITS};
use std::path::Path;

/// Names of the chunks that are read again.
mod name {
    pub(super) const STEP: &str = "configuration/step";
    pub(super) const DIMENSIONS: &str = "configuration/dimensions";
    pub(super) const BOX: &str = "configuration/box";
    pub(super) const COUNT: &str = "particles/N";
    pub(super) const POSITION: &str = "particles/position";
    pub(super) const IMAGE: &str = "particles/image";
    pub(super) const TIME_OVER_JEANS: &str = "log/time_over_jeans";
    pub(super) const TIME_STEP: &str = "log/dt";
    pub(super) const LARGEST_FORCE: &str = "log/max_force";
    pub(super) const STRENGTH: &str = "log/particles/strength";
    pub(super) const EXACT_SIDE: &str = "log/meniscus/box";
    pub(super) const EXACT_TIME: &str = "log/meniscus/time";
    pub(super) const EXACT_POSITION: &str = "log/particles/position_bits";
}

/// Reads a frame of the file at `path`, in the box `torus`.
///
/// # Errors
/// [`FileError::Read`] for a file that is not whole, a frame that is not there, another box, a third dimension, a
/// position outside the box.
pub fn read(path: &Path, torus: &Torus, choice: FrameChoice) -> Result<State, FileError> {
    read_with(path, |input| Ok(GsdReader::open(input, Some(torus))?.choose(choice)?.state))
}

/// A coordinate in a box of single precision as the file has it: from −`side`/2 and less than `side`/2, R0.
fn centred(side: f32, fraction: Fraction) -> f32 {
    // The middle of the box is 0: half a box less.
    let units = (fraction.to_bits() ^ (1 << 31)) as i32;
    let coordinate = (f64::from(units) * (f64::from(side) / UNITS)) as f32;
    let edge = side / 2.0;
    if coordinate < edge { coordinate } else { edge.next_down() }
}
