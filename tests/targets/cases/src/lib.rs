//! Named golden cases of the core: one program text for every target.
//!
//! [`run`] does one case in memory that the caller owns and prints a line for every stage of the first step and for the
//! last state: `CASE STAGE LENGTH SHA-256`. The stages come in the order of a datum's way, so the first line that
//! differs from the golden file names the stage to look at.
#![no_std]
#![forbid(unsafe_code)]

mod stages;

use core::fmt::{self, Write};
use meniscus_core::digest::{Digest, FORMAT_VERSION, MAGIC};
use meniscus_core::dynamics::{Clock, InitError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::parameters::{Assignment, Gradient, Influence, Noise, Parameters};
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
    /// Steps to do.
    pub steps: u64,
}

/// 30 discs in a box of 16 R0: contacts, and wraps across the border.
const CROWD: &[u8] = include_bytes!("../starts/crowd.state");
/// 200 discs in a box of 64 R0 after two Jeans' times: clusters, contacts, wraps.
const CLUSTERS: &[u8] = include_bytes!("../starts/clusters.state");
/// 500 discs in a box of 200 R0 after one Jeans' time.
const COLLAPSE: &[u8] = include_bytes!("../starts/collapse.state");
/// 600 discs at random in a box of 500 R0.
const RANDOM: &[u8] = include_bytes!("../starts/random.state");

/// Room for discs in the engines that the cases need: (M, N) for M = 16, 64, 128 and 512.
pub const ROOM: [(usize, usize); 4] = [(16, 32), (64, 200), (128, 500), (512, 600)];

const SMALL: Parameters = Parameters {
    side: 16.0,
    capillary_strength: 5.0,
    capillary_length: 8.0,
    grid: 16,
    ..Parameters::DEFAULT
};
const MIDDLE: Parameters =
    Parameters { side: 64.0, grid: 64, capillary_strength: 20.0, capillary_length: 40.0, ..SMALL };
const LARGE: Parameters = Parameters { side: 200.0, grid: 128, capillary_length: f64::INFINITY, ..SMALL };
const TABLE_1: Parameters =
    Parameters { side: 500.0, grid: 512, capillary_strength: 0.89, capillary_length: 270.0, ..SMALL };

/// Every case, small ones first.
pub const CASES: [Case; 11] = [
    Case { name: "16-tsc-paper-spectral-uniform", parameters: SMALL, start: CROWD, steps: 300 },
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
        steps: 300,
    },
    Case { name: "64-tsc-paper-spectral-uniform", parameters: MIDDLE, start: CLUSTERS, steps: 300 },
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
        steps: 300,
    },
    Case { name: "128-tsc-paper-spectral-uniform", parameters: LARGE, start: COLLAPSE, steps: 20 },
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
        steps: 20,
    },
    Case { name: "512-tsc-paper-spectral-uniform", parameters: TABLE_1, start: RANDOM, steps: 3 },
];

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
pub fn run<const M: usize, const N: usize>(
    case: &Case,
    engine: &mut Engine<M, N>,
    output: &mut impl Write,
) -> Result<(), CaseError> {
    let discs = discs(case.start).ok_or(CaseError::Start)?;
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
