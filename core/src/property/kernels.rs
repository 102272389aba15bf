//! The core's own kernels, with memory of their own: what the invariants hold for, and what a kernel of your own may be
//! compared with.
//!
//! ```
//! use meniscus_core::parameters::Parameters;
//! use meniscus_core::property::{Discs, kernels};
//! use meniscus_core::torus::Torus;
//!
//! let mut kernel = kernels::forces(&Parameters { grid: 16, ..Parameters::DEFAULT }).unwrap();
//! let torus = Torus::new(64.0).unwrap();
//! let forces = kernel(&Discs::from_coordinates(torus, &[[10.0, 10.0], [20.0, 10.0]]));
//! assert!(forces[0][0] > 0.0 && forces[1][0] < 0.0);
//! // A box of another side has no forces by these parameters.
//! assert!(kernel(&Discs::from_coordinates(Torus::new(65.0).unwrap(), &[[10.0, 10.0]])).is_empty());
//! ```

use super::discs::Discs;
use super::forces::ForceKernel;
use super::masses::MassKernel;
use super::pairs::PairKernel;
use crate::assignment::deposit_strengths;
use crate::cells::Separation;
use crate::dynamics::{Clock, Disc, Dynamics, Memory};
use crate::grid::Grid;
use crate::influence::influence_length;
use crate::mesh::LINES;
use crate::near_part::{Segment, fill_table, table_length};
use crate::pair_force::{PairForce, near_cutoff};
use crate::parameters::{Assignment, ParameterError, Parameters};
use crate::stages::Scalar;
use crate::torus::{Fraction, Torus};
use crate::transform::{AnySize, Complex32};
use crate::units::force_from_units;
use std::vec;
use std::vec::Vec;

/// The forces that `parameters` switch on, by [`Dynamics`].
///
/// The kernel gives no force where the core refuses: in another box than that of the parameters, where a node of the mesh
/// is crowded, where V0·f² exceeds [`crate::parameters::LARGEST_CAPILLARY_STRENGTH`] for the strength f of a disc, or for
/// more discs than the core takes.
///
/// # Errors
/// A [`ParameterError`].
pub fn forces(parameters: &Parameters) -> Result<impl ForceKernel + use<>, ParameterError> {
    parameters.validate()?;
    let parameters = *parameters;
    let mut run: Option<Run> = None;
    Ok(move |discs: &Discs| {
        if discs.side() != parameters.side {
            return Vec::new();
        }
        if run.as_ref().is_none_or(|run| run.strengths != discs.strengths()) {
            run = Run::new(&parameters, discs);
        }
        run.as_mut().and_then(|run| run.forces(discs)).unwrap_or_default()
    })
}

/// The masses on the nodes by [`crate::assignment::deposit_strengths`]; none if a node is crowded.
pub fn masses(assignment: Assignment, grid: Grid) -> impl MassKernel + Fn(&Discs) -> Vec<i64> {
    move |discs: &Discs| {
        let mut nodes = vec![0; grid.nodes() * grid.nodes()];
        let (x, y): (Vec<_>, Vec<_>) =
            discs.positions().iter().map(|position| (position.x, position.y)).unzip();
        match deposit_strengths(assignment, grid, (&x, &y), discs.strengths(), &mut nodes) {
            Ok(()) => nodes.into_iter().map(|mass| i64::from(mass as i32)).collect(),
            Err(_) => Vec::new(),
        }
    }
}

/// The force of a pair of discs of strength 1 that the core adds to that of the mesh, by [`PairForce`]: repulsion at
/// contact and near part, as far as `parameters` switch them on.
///
/// # Errors
/// A [`ParameterError`].
pub fn pair(
    parameters: &Parameters,
) -> Result<impl PairKernel + Fn([f64; 2]) -> [f64; 2] + use<>, ParameterError> {
    parameters.validate()?;
    let torus = Torus::new(parameters.side).map_err(|_| ParameterError::Side)?;
    let force = PairForce::new(parameters);
    let mut table = vec![[0.0; 4]; table_length(near_cutoff(parameters))];
    fill_table(parameters.splitting, parameters.capillary_length, &mut table);
    Ok(move |separation: [f64; 2]| {
        // From the other disc to this one.
        let [x, y] = separation.map(|component| torus.wrapped_fraction(-component).to_bits() as i32);
        let units = force.of(Separation { x, y }, true, PairForce::EQUAL, &table);
        units.map_or([0.0; 2], |(x, y)| [x, y].map(force_from_units))
    })
}

/// A run and its memory, for discs of certain strengths.
struct Run {
    dynamics: Dynamics,
    /// As given; the run has its own.
    strengths: Vec<i32>,
    by_u32: [Vec<u32>; 3],
    coordinates: [Vec<Fraction>; 2],
    by_i32: [Vec<i32>; 5],
    forces: [Vec<i64>; 2],
    nodes: Vec<u32>,
    field: Vec<Complex32>,
    lines: Vec<Complex32>,
    influence: Vec<f32>,
    gradient: Vec<f32>,
    near: Vec<Segment>,
}

impl Run {
    fn new(parameters: &Parameters, discs: &Discs) -> Option<Self> {
        let (count, grid) = (discs.len(), parameters.grid);
        let zero = Complex32::new(0.0, 0.0);
        let mut run = Self {
            dynamics: Dynamics::blank(),
            strengths: discs.strengths().into(),
            by_u32: [(); 3].map(|()| vec![0; count]),
            coordinates: [(); 2].map(|()| vec![Fraction::ZERO; count]),
            by_i32: [(); 5].map(|()| vec![0; count]),
            forces: [(); 2].map(|()| vec![0; count]),
            nodes: vec![0; grid * grid],
            field: vec![zero; grid * grid],
            lines: vec![zero; LINES * grid],
            influence: vec![0.0; influence_length(grid)],
            gradient: vec![0.0; grid],
            near: vec![[0.0; 4]; table_length(near_cutoff(parameters))],
        };
        let discs = discs.positions().iter().zip(discs.strengths());
        let places = (0..).zip(discs).map(|(id, (&position, &strength))| Disc { id, position, strength });
        run.dynamics = Dynamics::new(parameters, Clock::START, places, &mut run.memory()).ok()?;
        Some(run)
    }

    fn memory(&mut self) -> Memory<'_> {
        let [ids, slots, next] = &mut self.by_u32;
        let [x, y] = &mut self.coordinates;
        let [crossings_x, crossings_y, displacement_x, displacement_y, strengths] = &mut self.by_i32;
        let [force_x, force_y] = &mut self.forces;
        Memory {
            ids,
            slots,
            x,
            y,
            crossings_x,
            crossings_y,
            force_x,
            force_y,
            displacement_x,
            displacement_y,
            strengths,
            next,
            nodes: &mut self.nodes,
            field: &mut self.field,
            lines: &mut self.lines,
            influence: &mut self.influence,
            gradient: &mut self.gradient,
            near: &mut self.near,
            ..Memory::default()
        }
    }

    fn forces(&mut self, discs: &Discs) -> Option<Vec<[f64; 2]>> {
        let [x, y] = &mut self.coordinates;
        for ((x, y), position) in x.iter_mut().zip(y).zip(discs.positions()) {
            (*x, *y) = (position.x, position.y);
        }
        let dynamics = self.dynamics;
        dynamics.forces(&mut Scalar(AnySize), &mut self.memory()).ok()?;
        let [x, y] = &self.forces;
        Some(x.iter().zip(y).map(|(&x, &y)| [force_from_units(x), force_from_units(y)]).collect())
    }
}
