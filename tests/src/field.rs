//! The force field of discs on the mesh, probed where no disc is.
//!
//! One solution of the mesh so serves any number of pairs: the force on a probe is linear in the sources, and a
//! disc exerts none on itself.

use meniscus_core::assignment::{Crowded, deposit, gather};
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve};
use meniscus_core::parameters::{Assignment, Parameters};
use meniscus_core::torus::Position;
use meniscus_core::transform::{AnySize, Complex32};
use meniscus_core::units::force_from_units;

use crate::states::coordinates;

/// The capillary force field of some sources.
#[derive(Clone, Debug)]
pub struct MeshField {
    assignment: Assignment,
    grid: Grid,
    field: Vec<Complex32>,
}

impl MeshField {
    /// The field that discs at `sources` make on the mesh of `parameters`, which are valid.
    ///
    /// # Errors
    /// [`Crowded`] if a node would hold too many discs.
    pub fn new(parameters: &Parameters, sources: &[Position]) -> Result<Self, Crowded> {
        let Parameters { assignment, grid, .. } = *parameters;
        #[expect(clippy::expect_used, reason = "the parameters are valid by contract")]
        let mesh = Grid::new(grid).expect("valid parameters");
        let zero = Complex32::new(0.0, 0.0);
        let (mut nodes, mut field) = (vec![0; grid * grid], vec![zero; grid * grid]);
        let (mut influence, mut gradient) = (vec![0.0; influence_length(grid)], vec![0.0; grid]);
        fill_influence(parameters, &mut influence);
        fill_gradient(parameters, &mut gradient);
        let (x, y) = coordinates(sources);
        deposit(assignment, mesh, &x, &y, &mut nodes)?;
        let tables = Tables { influence: &influence, gradient: &gradient };
        solve(&AnySize, mesh, &tables, &nodes, &mut field, &mut vec![zero; 16 * grid]);
        Ok(Self { assignment, grid: mesh, field })
    }

    /// The forces (kBT/R0) on discs at `probes` due to the sources alone.
    pub fn at(&self, probes: &[Position]) -> Vec<[f64; 2]> {
        let (x, y) = coordinates(probes);
        let (mut force_x, mut force_y) = (vec![0; probes.len()], vec![0; probes.len()]);
        gather(self.assignment, self.grid, (&x, &y), &self.field, (&mut force_x, &mut force_y));
        let forces = force_x.into_iter().zip(force_y);
        forces.map(|(x, y)| [force_from_units(x), force_from_units(y)]).collect()
    }
}
