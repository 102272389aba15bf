//! The engine as one plain value: M × M mesh nodes and room for N discs, for a `static`.
//!
//! ```
//! use meniscus_core::engine::Engine;
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::torus::{Position, Torus};
//! use std::sync::Mutex;
//!
//! static ENGINE: Mutex<Engine<64, 256>> = Mutex::new(Engine::new());
//!
//! let torus = Torus::new(64.0).unwrap();
//! let at = |x, y| Position { x: torus.fraction(x).unwrap(), y: torus.fraction(y).unwrap() };
//! let mut engine = ENGINE.lock().unwrap();
//! engine.init(&Parameters::default(), [(0, at(10.0, 10.0)), (1, at(13.0, 10.0))]).unwrap();
//! for _ in 0..10 {
//!     engine.step().unwrap();
//! }
//! assert_eq!(engine.clock().step, 10);
//! println!("{}", engine.state().digest());
//! ```

use crate::digest::State;
use crate::dynamics::{Clock, Disc, Dynamics, ForceError, InitError, Memory, Step, StepError};
use crate::mesh::LINES;
use crate::near_part::{LARGEST_TABLE, Segment};
use crate::parameters::Parameters;
use crate::refresh::{HeldForce, HeldForces};
use crate::stages::Scalar;
use crate::torus::{Fraction, Position};
use crate::transform::{Complex32, FixedSize};

/// A run on an M × M mesh with room for N discs.
///
/// M is a power of two from 16 to 4096. All memory is inside; nothing is allocated.
///
/// The table of the near part has room for every cut-off, 4 KB; where these count, SEGMENTS may be less: a run with cut-off
/// r_c takes [`table_length`](crate::near_part::table_length)(r_c), one without a near part none. A run that takes more is
/// refused.
///
/// ```
/// use meniscus_core::engine::Engine;
/// use meniscus_core::near_part::table_length;
///
/// type Small = Engine<16, 32, { table_length(6.0) }>;
/// assert!(size_of::<Small>() < 9 * 1024);
/// ```
///
/// A run that holds mesh forces (`mesh_refresh` of the parameters) takes 40 bytes more for each disc; HELD says for how many there
/// is room, N or 0. A run that takes more is refused.
///
/// ```
/// use meniscus_core::dynamics::InitError;
/// use meniscus_core::engine::Engine;
/// use meniscus_core::near_part::LARGEST_TABLE;
/// use meniscus_core::parameters::Parameters;
/// use meniscus_core::torus::Position;
///
/// let parameters = Parameters { mesh_refresh: 0.3, ..Parameters::default() };
/// let discs = [(0, Position::from_bits(0, 0)), (1, Position::from_bits(1 << 29, 0))];
/// let mut engine = Engine::<64, 2>::new();
/// assert_eq!(engine.init(&parameters, discs), Err(InitError::NoRoomToHold));
/// let mut engine = Engine::<64, 2, LARGEST_TABLE, 2>::new();
/// engine.init(&parameters, discs).unwrap();
/// assert!(engine.step().unwrap().refreshed);
/// assert!(!engine.step().unwrap().refreshed);
/// assert!(engine.held(1).unwrap().force.0 < 0);
/// ```
#[derive(Debug)]
pub struct Engine<
    const M: usize,
    const N: usize,
    const SEGMENTS: usize = LARGEST_TABLE,
    const HELD: usize = 0,
> {
    dynamics: Dynamics,
    ids: [u32; N],
    slots: [u32; N],
    x: [Fraction; N],
    y: [Fraction; N],
    crossings_x: [i32; N],
    crossings_y: [i32; N],
    force_x: [i64; N],
    force_y: [i64; N],
    displacement_x: [i32; N],
    displacement_y: [i32; N],
    strengths: [i32; N],
    held_x: [i64; HELD],
    held_y: [i64; HELD],
    fresh_x: [i64; HELD],
    fresh_y: [i64; HELD],
    reference_x: [Fraction; HELD],
    reference_y: [Fraction; HELD],
    next: [u32; N],
    nodes: [[u32; M]; M],
    field: [[Complex32; M]; M],
    lines: [[Complex32; M]; LINES],
    influence: [[f32; M]; M],
    gradient: [f32; M],
    near: [Segment; SEGMENTS],
}

impl<const M: usize, const N: usize, const SEGMENTS: usize, const HELD: usize> Default
    for Engine<M, N, SEGMENTS, HELD>
{
    fn default() -> Self {
        Self::new()
    }
}

impl<const M: usize, const N: usize, const SEGMENTS: usize, const HELD: usize> Engine<M, N, SEGMENTS, HELD> {
    /// An engine without discs, all bits zero, so that a `static` of it takes no room in the program's file.
    #[must_use]
    pub const fn new() -> Self {
        const ZERO: Complex32 = Complex32 { re: 0.0, im: 0.0 };
        Self {
            dynamics: Dynamics::blank(),
            ids: [0; N],
            slots: [0; N],
            x: [Fraction::ZERO; N],
            y: [Fraction::ZERO; N],
            crossings_x: [0; N],
            crossings_y: [0; N],
            force_x: [0; N],
            force_y: [0; N],
            displacement_x: [0; N],
            displacement_y: [0; N],
            strengths: [0; N],
            held_x: [0; HELD],
            held_y: [0; HELD],
            fresh_x: [0; HELD],
            fresh_y: [0; HELD],
            reference_x: [Fraction::ZERO; HELD],
            reference_y: [Fraction::ZERO; HELD],
            next: [0; N],
            nodes: [[0; M]; M],
            field: [[ZERO; M]; M],
            lines: [[ZERO; M]; LINES],
            influence: [[0.0; M]; M],
            gradient: [0.0; M],
            near: [[0.0; 4]; SEGMENTS],
        }
    }

    /// Starts a run at step 0 and time 0 from discs given with their ids 0 … n−1 in any order, 1 ≤ n ≤ N: [`Disc`]s, or
    /// pairs of an id and a position for discs of strength 1.
    ///
    /// # Errors
    /// An [`InitError`]; the engine then has no discs.
    pub fn init(
        &mut self,
        parameters: &Parameters,
        discs: impl IntoIterator<Item: Into<Disc>>,
    ) -> Result<(), InitError> {
        self.init_at(parameters, Clock::START, discs)
    }

    /// Starts a run at `clock`: a state reached before goes on as if it had never stopped.
    ///
    /// # Errors
    /// An [`InitError`]; the engine then has no discs.
    pub fn init_at(
        &mut self,
        parameters: &Parameters,
        clock: Clock,
        discs: impl IntoIterator<Item: Into<Disc>>,
    ) -> Result<(), InitError> {
        self.dynamics = Dynamics::blank();
        parameters.validate().map_err(InitError::Parameters)?;
        if parameters.grid != M {
            return Err(InitError::GridMismatch);
        }
        let (dynamics, mut memory) = self.parts();
        *dynamics = Dynamics::new(parameters, clock, discs, &mut memory)?;
        Ok(())
    }

    /// Goes on with the mesh forces that were held in the state the run was started from, given in the order of ids.
    ///
    /// # Errors
    /// An [`InitError`]; the run then holds none, and computes them anew.
    pub fn hold(&mut self, held: impl IntoIterator<Item = HeldForce>) -> Result<(), InitError> {
        let (dynamics, mut memory) = self.parts();
        dynamics.hold(held, &mut memory)
    }

    /// Does one step and tells what happened.
    ///
    /// # Errors
    /// A [`StepError`]; the state is then as it was.
    pub fn step(&mut self) -> Result<Step, StepError> {
        let (dynamics, mut memory) = self.parts();
        dynamics.step(&mut Scalar(FixedSize::<M>), &mut memory)
    }

    /// Computes the forces at the present positions, for [`Engine::force`].
    ///
    /// # Errors
    /// A [`ForceError`].
    pub fn compute_forces(&mut self) -> Result<(), ForceError> {
        let (dynamics, mut memory) = self.parts();
        dynamics.forces(&mut Scalar(FixedSize::<M>), &mut memory)
    }

    /// Number of discs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.dynamics.count()
    }

    /// Steps done and time reached.
    #[must_use]
    pub fn clock(&self) -> Clock {
        self.dynamics.clock()
    }

    /// The state as its canonical bytes see it; gives the digest.
    #[must_use]
    pub fn state(&self) -> State<'_> {
        self.dynamics.state(&self.slots, (&self.x, &self.y), &self.strengths, self.held_forces())
    }

    /// Where disc `id` is.
    #[must_use]
    pub fn position(&self, id: u32) -> Option<Position> {
        let slot = self.slot(id)?;
        Some(Position { x: *self.x.get(slot)?, y: *self.y.get(slot)? })
    }

    /// The capillary strength of disc `id`, unit 2⁻²⁰.
    #[must_use]
    pub fn strength(&self, id: u32) -> Option<i32> {
        self.strengths.get(self.slot(id)?).copied()
    }

    /// How many borders disc `id` has crossed along x and y since the run was set up, + to the right and up.
    #[must_use]
    pub fn crossings(&self, id: u32) -> Option<(i32, i32)> {
        let slot = self.slot(id)?;
        Some((*self.crossings_x.get(slot)?, *self.crossings_y.get(slot)?))
    }

    /// The force on disc `id` when forces were last computed, by a step before it moved the discs or by
    /// [`Engine::compute_forces`]; unit 2⁻²⁴ kBT/R0.
    #[must_use]
    pub fn force(&self, id: u32) -> Option<(i64, i64)> {
        let slot = self.slot(id)?;
        Some((*self.force_x.get(slot)?, *self.force_y.get(slot)?))
    }

    /// The mesh force that is held of disc `id`, and since where it was; none if none is.
    #[must_use]
    pub fn held(&self, id: u32) -> Option<HeldForce> {
        self.held_forces().at(self.slot(id)?).filter(|_| self.dynamics.is_held())
    }

    fn held_forces(&self) -> HeldForces<'_> {
        HeldForces {
            reference_x: &self.reference_x,
            reference_y: &self.reference_y,
            force_x: &self.held_x,
            force_y: &self.held_y,
        }
    }

    fn slot(&self, id: u32) -> Option<usize> {
        let slots = self.slots.get(..self.count())?;
        slots.get(id as usize).map(|&slot| slot as usize)
    }

    /// The run and its memory, for those who compose the stages themselves: the ids, slots, coordinates, crossings and
    /// strengths are the state, influence, gradient and near part tables that `init` filled for all steps to come, the
    /// rest is scratch that the next step overwrites.
    pub fn parts(&mut self) -> (&mut Dynamics, Memory<'_>) {
        let memory = Memory {
            ids: &mut self.ids,
            slots: &mut self.slots,
            x: &mut self.x,
            y: &mut self.y,
            crossings_x: &mut self.crossings_x,
            crossings_y: &mut self.crossings_y,
            force_x: &mut self.force_x,
            force_y: &mut self.force_y,
            displacement_x: &mut self.displacement_x,
            displacement_y: &mut self.displacement_y,
            strengths: &mut self.strengths,
            held_x: &mut self.held_x,
            held_y: &mut self.held_y,
            fresh_x: &mut self.fresh_x,
            fresh_y: &mut self.fresh_y,
            reference_x: &mut self.reference_x,
            reference_y: &mut self.reference_y,
            next: &mut self.next,
            nodes: self.nodes.as_flattened_mut(),
            field: self.field.as_flattened_mut(),
            lines: self.lines.as_flattened_mut(),
            influence: self.influence.as_flattened_mut(),
            gradient: &mut self.gradient,
            near: &mut self.near,
        };
        (&mut self.dynamics, memory)
    }
}
