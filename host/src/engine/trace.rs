//! What the stages of one step hand on, value by value, so that two engines can be compared stage by stage.
//!
//! Values are held in an order that does not depend on how discs are stored: by node (x·M + y) for the mesh, by id for
//! the discs. Looking changes nothing.
//!
//! ```
//! use meniscus::engine::{Engine, Kind, Machinery, Stage, Trace};
//! use meniscus_core::dynamics::Clock;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::torus::Position;
//!
//! let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 27, 0))];
//! let traces = [Kind::Host, Kind::Core].map(|kind| {
//!     let machinery = Machinery { kind, threads: 1 };
//!     let mut engine = Engine::with_machinery(machinery, &Parameters::default(), Clock::START, discs)?;
//!     let mut trace = Trace::default();
//!     engine.traced_step(&mut trace)?;
//!     Ok::<Trace, meniscus::engine::EngineError>(trace)
//! });
//! let [host, core] = traces;
//! assert_eq!(host?.first_difference(&core?), None);
//! assert_eq!(Stage::PairForce.to_string(), "pair force");
//! # Ok::<(), meniscus::engine::EngineError>(())
//! ```

use meniscus_core::assignment::Crowded;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::Step;
use meniscus_core::ermak::{Displacement, HalfBox};
use meniscus_core::forces::{Coupling, Forces};
use meniscus_core::memory::Memory;
use meniscus_core::stages::{Scalar, Stages};
use meniscus_core::transform::{Complex32, LineTransform};
use sha2::{Digest as _, Sha256};
use std::fmt;

/// What a step hands on, in the order in which it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Sums of mass (or strength) on the nodes, unit 2⁻²⁰. Not there in a step that finds the force of the mesh held.
    Masses,
    /// Bits of the field on the nodes, binary32, kBT/R0. Not there in a step that finds the force of the mesh held.
    Field,
    /// The force of the mesh on each disc, computed anew or held, unit 2⁻²⁴ kBT/R0.
    MeshForce,
    /// What pairs add to it.
    PairForce,
    /// What external fields add to it.
    ExternalForce,
    /// The force on each disc.
    TotalForce,
    /// The largest modulus of a force, rounded up.
    LargestForce,
    /// Δt, unit 2⁻⁴⁰ R0²/D.
    TimeStep,
    /// The displacement of each disc, unit L·2⁻³².
    Displacement,
    /// Where each disc is after the step, unit L·2⁻³².
    Positions,
}

impl Stage {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Masses,
        Self::Field,
        Self::MeshForce,
        Self::PairForce,
        Self::ExternalForce,
        Self::TotalForce,
        Self::LargestForce,
        Self::TimeStep,
        Self::Displacement,
        Self::Positions,
    ];

    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Masses => ("masses", "2^-20 discs"),
            Self::Field => ("field", "bits of binary32, kBT/R0"),
            Self::MeshForce => ("mesh force", "2^-24 kBT/R0"),
            Self::PairForce => ("pair force", "2^-24 kBT/R0"),
            Self::ExternalForce => ("external force", "2^-24 kBT/R0"),
            Self::TotalForce => ("total force", "2^-24 kBT/R0"),
            Self::LargestForce => ("largest force", "2^-24 kBT/R0"),
            Self::TimeStep => ("time step", "2^-40 R0^2/D"),
            Self::Displacement => ("displacement", "L*2^-32"),
            Self::Positions => ("positions", "L*2^-32"),
        }
    }

    /// How many values each place has: two components, or one number.
    const fn components(self) -> usize {
        match self {
            Self::Masses | Self::LargestForce | Self::TimeStep => 1,
            _ => 2,
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.words().0)
    }
}

/// The first value in which two traces differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageDifference {
    /// The stage.
    pub stage: Stage,
    /// Place of the value among those of its stage: two components a disc (by id) or node (x·M + y) but for masses, which
    /// have one; a single number has place 0.
    pub index: usize,
    /// The value of either trace; None where it has none.
    pub values: [Option<i64>; 2],
}

impl fmt::Display for StageDifference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stage, index, values } = *self;
        let place = index / stage.components();
        let axis = if index % 2 == 0 { "x" } else { "y" };
        match stage {
            Stage::Masses => write!(formatter, "{stage}: node {place}")?,
            Stage::Field => write!(formatter, "{stage}: node {place} along {axis}")?,
            Stage::LargestForce | Stage::TimeStep => write!(formatter, "{stage}")?,
            _ => write!(formatter, "{stage}: disc {place} along {axis}")?,
        }
        let said = |value: Option<i64>| match value {
            Some(bits) if stage == Stage::Field => format!("{bits:#010x}"),
            Some(value) => value.to_string(),
            None => "nothing".to_owned(),
        };
        write!(formatter, ": {} and {} ({})", said(values[0]), said(values[1]), stage.words().1)
    }
}

/// All that the stages of one step handed on; a stage that was not called has no values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    values: [Vec<i64>; Stage::ALL.len()],
}

impl Trace {
    /// What a stage handed on.
    #[must_use]
    pub fn of(&self, stage: Stage) -> &[i64] {
        &self.values[stage as usize]
    }

    /// The first value that differs, in the order of stages.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<StageDifference> {
        Stage::ALL.into_iter().find_map(|stage| {
            let (one, other) = (self.of(stage), other.of(stage));
            if one == other {
                return None;
            }
            let index = one.iter().zip(other).take_while(|(one, other)| one == other).count();
            Some(StageDifference {
                stage,
                index,
                values: [one.get(index).copied(), other.get(index).copied()],
            })
        })
    }

    /// Length and SHA-256 of what each stage handed on, as little-endian 64-bit integers, of those that were called.
    pub fn digests(&self) -> impl Iterator<Item = (Stage, Digest)> {
        let called = Stage::ALL.into_iter().filter(|&stage| !self.of(stage).is_empty());
        called.map(|stage| {
            let mut hash = Sha256::new();
            self.of(stage).iter().for_each(|value| hash.update(value.to_le_bytes()));
            (stage, Digest { length: 8 * self.of(stage).len() as u64, sha256: hash.finalize().into() })
        })
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.values.iter_mut().for_each(Vec::clear);
    }

    /// Notes what a step says of itself.
    pub fn note_step(&mut self, step: &Step) {
        self.set(Stage::TimeStep, [step.length as i64]);
    }

    fn set(&mut self, stage: Stage, values: impl IntoIterator<Item = i64>) {
        let place = &mut self.values[stage as usize];
        place.clear();
        place.extend(values);
    }

    /// Takes the two components of each disc, in the order of ids.
    fn set_discs(&mut self, stage: Stage, slots: &[u32], components: impl Fn(usize) -> [i64; 2]) {
        self.set(stage, slots.iter().flat_map(|&slot| components(slot as usize)));
    }
}

/// Stages whose field can be looked at after they have solved for it.
pub trait ShowsField: Stages {
    /// The field on the nodes, element x·M + y, with `grid` = M.
    fn field<'a>(&'a self, grid: usize, memory: &'a Memory<'_>) -> Box<dyn Iterator<Item = Complex32> + 'a>;
}

impl<T: LineTransform> ShowsField for Scalar<T> {
    fn field<'a>(&'a self, _: usize, memory: &'a Memory<'_>) -> Box<dyn Iterator<Item = Complex32> + 'a> {
        Box::new(memory.field.iter().copied())
    }
}

/// Stages that note what they hand on.
#[derive(Debug)]
pub struct Traced<'a, S> {
    stages: &'a mut S,
    trace: &'a mut Trace,
}

impl<'a, S: ShowsField> Traced<'a, S> {
    /// Wraps stages for one step; `trace` is cleared.
    pub fn new(stages: &'a mut S, trace: &'a mut Trace) -> Self {
        trace.clear();
        Self { stages, trace }
    }

    fn note_forces(&mut self, stage: Stage, memory: &Memory<'_>) {
        let Memory { slots, force_x, force_y, .. } = memory;
        self.trace.set_discs(stage, slots, |slot| [force_x[slot], force_y[slot]]);
    }

    /// Notes the force of the mesh where it is held, before anything is added to it.
    fn note_held(&mut self, memory: &Memory<'_>) {
        if self.trace.of(Stage::MeshForce).is_empty() {
            self.note_forces(Stage::MeshForce, memory);
        }
    }

    /// Notes what `add` adds to the forces.
    fn note_added(
        &mut self,
        stage: Stage,
        memory: &mut Memory<'_>,
        add: impl FnOnce(&mut S, &mut Memory<'_>),
    ) {
        self.note_held(memory);
        let before = [memory.force_x.to_vec(), memory.force_y.to_vec()];
        add(self.stages, memory);
        let Memory { slots, force_x, force_y, .. } = memory;
        let added = |slot: usize| {
            [force_x[slot].wrapping_sub(before[0][slot]), force_y[slot].wrapping_sub(before[1][slot])]
        };
        self.trace.set_discs(stage, slots, added);
    }
}

impl<S: ShowsField> Stages for Traced<'_, S> {
    fn fits(&self, forces: &Forces, memory: &Memory<'_>) -> bool {
        self.stages.fits(forces, memory)
    }

    fn arrange(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.stages.arrange(forces, memory);
    }

    fn mesh(&mut self, forces: &Forces, memory: &mut Memory<'_>) -> Result<(), Crowded> {
        self.stages.mesh(forces, memory)?;
        if forces.coupling() != Coupling::None {
            let signed = forces.coupling() == Coupling::Unequal;
            let mass = |mass: u32| if signed { i64::from(mass as i32) } else { i64::from(mass) };
            self.trace.set(Stage::Masses, memory.nodes.iter().map(|&node| mass(node)));
            // Zeros of either sign are one number.
            let bits = |value: f32| i64::from((value + 0.0).to_bits());
            let field = self.stages.field(forces.grid().nodes(), memory);
            self.trace.set(Stage::Field, field.flat_map(|value| [bits(value.re), bits(value.im)]));
        }
        self.note_forces(Stage::MeshForce, memory);
        Ok(())
    }

    fn add_pairs(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.note_added(Stage::PairForce, memory, |stages, memory| stages.add_pairs(forces, memory));
    }

    fn add_fields(&mut self, forces: &Forces, memory: &mut Memory<'_>) {
        self.note_added(Stage::ExternalForce, memory, |stages, memory| stages.add_fields(forces, memory));
    }

    fn largest_force(&mut self, memory: &mut Memory<'_>) -> u64 {
        self.note_held(memory);
        self.note_forces(Stage::TotalForce, memory);
        let largest_force = self.stages.largest_force(memory);
        self.trace.set(Stage::LargestForce, [largest_force as i64]);
        largest_force
    }

    fn displacements(&mut self, displacement: &Displacement, memory: &mut Memory<'_>) -> Result<(), HalfBox> {
        self.stages.displacements(displacement, memory)?;
        let Memory { slots, displacement_x: x, displacement_y: y, .. } = memory;
        self.trace.set_discs(Stage::Displacement, slots, |slot| [i64::from(x[slot]), i64::from(y[slot])]);
        Ok(())
    }

    fn displace(&mut self, memory: &mut Memory<'_>) {
        self.stages.displace(memory);
        let Memory { slots, x, y, .. } = memory;
        let bits = |slot: usize| [i64::from(x[slot].to_bits()), i64::from(y[slot].to_bits())];
        self.trace.set_discs(Stage::Positions, slots, bits);
    }
}
