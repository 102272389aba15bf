//! Named golden cases of the core: one program text for every target.
//!
//! [`run`] does one case in memory that the caller owns and prints a line for every stage of the first step and for the
//! last state: `CASE STAGE LENGTH SHA-256`. The stages come in the order of a datum's way, so the first line that
//! differs from the golden file names the stage to look at.
#![no_std]
#![forbid(unsafe_code)]

mod stages;

use core::fmt::{self, Write};
use meniscus_core::assignment::DISC;
use meniscus_core::digest::{Digest, FORMAT_VERSION, MAGIC};
use meniscus_core::dynamics::{Clock, Disc, InitError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::fields::Fields;
use meniscus_core::near_part::{LARGEST_TABLE, table_length};
use meniscus_core::pair_force::near_cutoff;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Method, Noise, Parameters};
use meniscus_core::torus::Position;

/// A run: from where, with what, for how many steps.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What the case is called in the golden file.
    pub name: &'static str,
    /// Everything about it; `parameters.grid` says which engine it needs.
    pub parameters: Parameters,
    /// Canonical bytes of the first state.
    pub start: &'static [u8],
    /// Capillary strengths, unit 2⁻²⁰, of the discs in the order of their ids, over and over.
    pub strengths: &'static [i32],
    /// Steps to do.
    pub steps: u64,
}

impl Case {
    /// Whether all discs have strength 1.
    #[must_use]
    pub fn has_equal_strengths(&self) -> bool {
        self.strengths == EQUAL
    }
}

/// 30 discs in a box of 16 R0: contacts, and wraps across the border.
const CROWD: &[u8] = include_bytes!("../starts/crowd.state");
/// 200 discs in a box of 64 R0 after two Jeans' times: clusters, contacts, wraps.
const CLUSTERS: &[u8] = include_bytes!("../starts/clusters.state");
/// 500 discs in a box of 200 R0 after one Jeans' time.
const COLLAPSE: &[u8] = include_bytes!("../starts/collapse.state");
/// 600 discs at random in a box of 500 R0.
const RANDOM: &[u8] = include_bytes!("../starts/random.state");

/// All discs alike.
const EQUAL: &[i32] = &[DISC as i32];
/// Discs that raise the interface, that sink it, and one that leaves it alone.
const MIXED: &[i32] = &[DISC as i32, -(DISC as i32), 1_500_000, -314_159, 0, 3 * DISC as i32 / 4, -1];

/// Room for discs in the engines that the cases need: (M, N) for M = 16, 64, 128 and 512.
pub const ROOM: [(usize, usize); 4] = [(16, 32), (64, 200), (128, 500), (512, 600)];

/// An engine for the cases of 64 nodes, with room to hold mesh forces.
pub type Engine64 = Engine<{ ROOM[1].0 }, { ROOM[1].1 }, LARGEST_TABLE, { ROOM[1].1 }>;

const SMALL: Parameters =
    Parameters { side: 16.0, capillary_strength: 5.0, capillary_length: 8.0, grid: 16, ..Parameters::PAPER };
const MIDDLE: Parameters =
    Parameters { side: 64.0, grid: 64, capillary_strength: 20.0, capillary_length: 40.0, ..SMALL };
const LARGE: Parameters = Parameters { side: 200.0, grid: 128, capillary_length: f64::INFINITY, ..SMALL };
const TABLE_1: Parameters =
    Parameters { side: 500.0, grid: 512, capillary_strength: 0.89, capillary_length: 270.0, ..SMALL };

/// `parameters` with the split force.
const fn split(parameters: Parameters, assignment: Assignment, splitting: f64, cutoff: f64) -> Parameters {
    let (method, influence) = (Method::P3m, Influence::Optimal);
    Parameters { method, influence, assignment, splitting, cutoff, ..parameters }
}

/// A trap at a corner and a uniform force.
const fn trapped(parameters: Parameters) -> Parameters {
    let fields = Fields { uniform_force: [-2.0, 0.3], trap_stiffness: 0.7, trap_center: [0.0, 12.1] };
    Parameters { fields, ..parameters }
}

/// Every case, small ones first.
pub const CASES: [Case; 22] = [
    Case {
        name: "16-tsc-paper-spectral-uniform",
        parameters: SMALL,
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-cic-paper-difference-2-gaussian",
        parameters: Parameters {
            assignment: Assignment::CloudInCell,
            gradient: Gradient::Difference2,
            noise: Noise::Gaussian,
            seed: 2,
            ..SMALL
        },
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-tsc-continuum-difference-4-none",
        parameters: Parameters {
            influence: Influence::Continuum,
            gradient: Gradient::Difference4,
            noise: Noise::None,
            ..SMALL
        },
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-free-gaussian",
        parameters: Parameters {
            capillary_strength: 0.0,
            repulsion: false,
            noise: Noise::Gaussian,
            seed: (1 << 63) - 1,
            ..SMALL
        },
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-tsc-paper-spectral-uniform-strengths-trap",
        parameters: trapped(SMALL),
        start: CROWD,
        strengths: MIXED,
        steps: 300,
    },
    Case {
        name: "16-order-2-split-none",
        parameters: Parameters { noise: Noise::None, ..split(SMALL, Assignment::CloudInCell, 0.3, 6.5) },
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-order-4-split-uniform",
        parameters: split(SMALL, Assignment::Order4, 0.5, 6.0),
        start: CROWD,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "16-order-5-split-gaussian-strengths-trap",
        parameters: Parameters {
            capillary_length: f64::INFINITY,
            noise: Noise::Gaussian,
            seed: 5,
            ..trapped(split(SMALL, Assignment::Order5, 0.6, 4.0))
        },
        start: CROWD,
        strengths: MIXED,
        steps: 300,
    },
    Case {
        name: "16-order-6-split-uniform-strengths",
        parameters: Parameters { seed: 6, ..split(SMALL, Assignment::Order6, 0.7, 2.0) },
        start: CROWD,
        strengths: MIXED,
        steps: 300,
    },
    Case {
        name: "64-tsc-paper-spectral-uniform",
        parameters: MIDDLE,
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "64-cic-continuum-spectral-gaussian",
        parameters: Parameters {
            assignment: Assignment::CloudInCell,
            influence: Influence::Continuum,
            noise: Noise::Gaussian,
            seed: 3,
            ..MIDDLE
        },
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "64-cic-paper-difference-4-none",
        parameters: Parameters {
            assignment: Assignment::CloudInCell,
            gradient: Gradient::Difference4,
            noise: Noise::None,
            ..MIDDLE
        },
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "64-tsc-continuum-difference-2-uniform",
        parameters: Parameters {
            influence: Influence::Continuum,
            gradient: Gradient::Difference2,
            seed: 4,
            ..MIDDLE
        },
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 300,
    },
    Case {
        name: "64-order-3-split-gaussian-trap",
        parameters: Parameters {
            noise: Noise::Gaussian,
            seed: 7,
            ..trapped(split(MIDDLE, Assignment::TriangularShapedCloud, 0.45, 7.0))
        },
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 100,
    },
    Case {
        name: "64-order-4-split-uniform",
        parameters: split(MIDDLE, Assignment::Order4, 0.5, 6.0),
        start: CLUSTERS,
        strengths: EQUAL,
        steps: 100,
    },
    Case {
        name: "64-order-7-split-uniform-strengths",
        parameters: Parameters {
            capillary_length: f64::INFINITY,
            seed: 8,
            ..split(MIDDLE, Assignment::Order7, 0.65, 5.0)
        },
        start: CLUSTERS,
        strengths: MIXED,
        steps: 100,
    },
    Case {
        name: "64-order-5-split-uniform-strengths-held",
        parameters: Parameters { mesh_refresh: 0.3, seed: 9, ..split(MIDDLE, Assignment::Order5, 0.55, 6.5) },
        start: CLUSTERS,
        strengths: MIXED,
        steps: 100,
    },
    Case {
        name: "128-tsc-paper-spectral-uniform",
        parameters: LARGE,
        start: COLLAPSE,
        strengths: EQUAL,
        steps: 20,
    },
    Case {
        name: "128-cic-continuum-difference-4-gaussian",
        parameters: Parameters {
            assignment: Assignment::CloudInCell,
            influence: Influence::Continuum,
            gradient: Gradient::Difference4,
            noise: Noise::Gaussian,
            ..LARGE
        },
        start: COLLAPSE,
        strengths: EQUAL,
        steps: 20,
    },
    Case {
        name: "128-order-5-split-uniform-strengths",
        parameters: split(LARGE, Assignment::Order5, 0.4, 9.0),
        start: COLLAPSE,
        strengths: MIXED,
        steps: 20,
    },
    Case {
        name: "512-tsc-paper-spectral-uniform",
        parameters: TABLE_1,
        start: RANDOM,
        strengths: EQUAL,
        steps: 3,
    },
    Case {
        name: "512-order-7-split-uniform",
        parameters: split(TABLE_1, Assignment::Order7, 0.6, 5.5),
        start: RANDOM,
        strengths: EQUAL,
        steps: 3,
    },
];

/// Segments of the near part's table that the cases on a mesh of `grid` nodes a side need at most: where memory is short,
/// an engine has no more.
#[must_use]
pub const fn longest_table(grid: usize) -> usize {
    let (mut longest, mut place) = (0, 0);
    while place < CASES.len() {
        let parameters = &CASES[place].parameters;
        let length = table_length(near_cutoff(parameters));
        if parameters.grid == grid && length > longest {
            longest = length;
        }
        place += 1;
    }
    longest
}

/// Why a case could not be run.
#[derive(Clone, Copy, Debug)]
pub enum CaseError {
    /// The stored start is not a state of this version.
    Start,
    /// The engine refused the case.
    Init(InitError),
    /// A step was refused.
    Step(StepError),
    /// The output could not be written.
    Output,
}

impl From<fmt::Error> for CaseError {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

/// Does `case` in `engine` and prints a line for each stage and for the last state.
///
/// # Errors
/// A [`CaseError`].
pub fn run<const M: usize, const N: usize, const SEGMENTS: usize, const HELD: usize>(
    case: &Case,
    engine: &mut Engine<M, N, SEGMENTS, HELD>,
    output: &mut impl Write,
) -> Result<(), CaseError> {
    let strengths = case.strengths.iter().cycle();
    let positions = discs(case.start).ok_or(CaseError::Start)?.zip(strengths);
    let discs = positions.map(|((id, position), &strength)| Disc { id, position, strength });
    engine.init_at(&case.parameters, Clock::START, discs).map_err(CaseError::Init)?;
    stages::print_all(case, engine, output)?;
    for step in 0..case.steps {
        engine.step().map_err(CaseError::Step)?;
        if step == 0 {
            print(case, "step", &engine.state().digest(), output)?;
        }
    }
    print(case, "last", &engine.state().digest(), output)?;
    Ok(())
}

/// One line of output.
fn print(case: &Case, stage: &str, digest: &Digest, output: &mut impl Write) -> fmt::Result {
    writeln!(output, "{} {stage} {} {digest}", case.name, digest.length)
}

/// The discs of a state's canonical bytes, with their ids; `None` if these are no such bytes.
pub fn discs(bytes: &'static [u8]) -> Option<impl Iterator<Item = (u32, Position)>> {
    const HEADER: usize = 32;
    let number =
        |at: usize| -> Option<u32> { bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes) };
    if bytes.get(..8)? != MAGIC || number(8)? != FORMAT_VERSION {
        return None;
    }
    let count = number(12)? as usize;
    if bytes.len() != HEADER + 8 * count {
        return None;
    }
    let (x, y) = bytes.get(HEADER..)?.split_at(4 * count);
    let bits = |word: &[u8]| word.try_into().map_or(0, u32::from_le_bytes);
    let positions = x.chunks_exact(4).zip(y.chunks_exact(4));
    Some((0..).zip(positions.map(move |(x, y)| Position::from_bits(bits(x), bits(y)))))
}
