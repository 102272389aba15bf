//! The number density of discs on a periodic grid, smoothed by triangular-shaped clouds (Figs. 7 to 11).
//!
//! In: the box, positions and a spacing (R0), or values from elsewhere. Out: values on n × n nodes, R0⁻² for discs. Node
//! (x, y) is element `x·n + y` and lies at (x, y)·h with h = L/n; the cell of a node is the square of side h centred
//! on it.
//!
//! A disc is spread over 3 × 3 nodes with the weights of order 3 (TSC), as the paper does for the capillary force on a
//! finer grid. The weights are integers, of unit 2⁻⁹⁶ discs, that sum to exactly one disc: nothing is lost, and the
//! order of the discs does not show.
//!
//! ```
//! use meniscus::observables::density::Density;
//! use meniscus_core::torus::{Position, Torus};
//!
//! let torus = Torus::new(100.0).unwrap();
//! let discs = [Position::from_bits(1 << 31, 1 << 30), Position::from_bits(u32::MAX, 7)];
//! let density = Density::new(&torus, &discs, 5.3).unwrap();
//! assert_eq!(density.grid(), 19);
//! let cell = density.spacing() * density.spacing();
//! assert!((density.values().iter().sum::<f64>() * cell - 2.0).abs() < 1e-12);
//! ```

use meniscus_core::torus::{Fraction, Position, Torus, UNITS};

/// The density of a close packing of discs of radius R0, ρ_m = 1/(2√3), R0⁻².
pub const CLOSE_PACKING: f64 = 0.288_675_134_594_812_9;

/// The fewest nodes along a side: as many as a disc is spread over.
pub const SMALLEST_GRID: usize = 3;

/// The most nodes along a side: enough for the largest box at the paper's spacing, 5.3 R0.
pub const LARGEST_GRID: usize = 16384;

/// Why there is no density.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DensityError {
    /// The spacing is not a positive number.
    #[error("spacing of the density's grid is {0}; it has to be a positive number of R0")]
    Spacing(f64),
    /// The spacing asks for more than [`LARGEST_GRID`] nodes along a side.
    #[error(
        "spacing of the density's grid is {spacing} R0 in a box of {side} R0; at most {LARGEST_GRID} nodes fit along \
         a side: take a larger spacing"
    )]
    TooFine {
        /// The spacing, R0.
        spacing: f64,
        /// The side of the box, R0.
        side: f64,
    },
    /// The number of values is not the square of a number from [`SMALLEST_GRID`] to [`LARGEST_GRID`].
    #[error("{0} values of a density; n*n values are needed, n from {SMALLEST_GRID} to {LARGEST_GRID}")]
    Values(usize),
    /// A value is not finite.
    #[error("value {0} of a density is not finite")]
    NotFinite(usize),
}

/// A field on the nodes of a periodic grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    side: f64,
    grid: usize,
    values: Vec<f64>,
}

impl Density {
    /// The number density of discs at `positions`, R0⁻², on n × n nodes with n = max(3, round(L/`spacing`)).
    ///
    /// # Errors
    /// [`DensityError::Spacing`] unless `spacing` (R0) is finite and positive, [`DensityError::TooFine`] if n would
    /// exceed [`LARGEST_GRID`].
    pub fn new(torus: &Torus, positions: &[Position], spacing: f64) -> Result<Self, DensityError> {
        let side = torus.side();
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(DensityError::Spacing(spacing));
        }
        let nodes = libm::round(side / spacing);
        if nodes > LARGEST_GRID as f64 {
            return Err(DensityError::TooFine { spacing, side });
        }
        let grid = (nodes as usize).max(SMALLEST_GRID);
        let cell = (side / grid as f64) * (side / grid as f64);
        let values = deposit(grid, positions).into_iter().map(|mass| mass as f64 * (SHARE * SHARE) / cell);
        Ok(Self { side, grid, values: values.collect() })
    }

    /// A field with the given values, of any unit, node (x, y) being element `x·n + y`.
    ///
    /// # Errors
    /// [`DensityError::Values`] unless there are n² values with n from [`SMALLEST_GRID`] to [`LARGEST_GRID`];
    /// [`DensityError::NotFinite`].
    pub fn from_values(torus: &Torus, values: Vec<f64>) -> Result<Self, DensityError> {
        let grid = values.len().isqrt();
        if grid * grid != values.len() || !(SMALLEST_GRID..=LARGEST_GRID).contains(&grid) {
            return Err(DensityError::Values(values.len()));
        }
        if let Some(node) = values.iter().position(|value| !value.is_finite()) {
            return Err(DensityError::NotFinite(node));
        }
        Ok(Self { side: torus.side(), grid, values })
    }

    /// The number of nodes along a side, n.
    #[must_use]
    pub fn grid(&self) -> usize {
        self.grid
    }

    /// The distance h = L/n of neighbouring nodes, R0.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.side / self.grid as f64
    }

    /// The values, R0⁻² for discs; node (x, y) is element `x·n + y`.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values at the corners of each square between four nodes, anticlockwise from the node with the lowest
    /// coordinates; the squares in the order of those nodes.
    pub fn squares(&self) -> impl Iterator<Item = [f64; 4]> + '_ {
        let grid = self.grid;
        let value = move |x: usize, y: usize| self.values[x % grid * grid + y % grid];
        let square = move |x, y| [value(x, y), value(x + 1, y), value(x + 1, y + 1), value(x, y + 1)];
        (0..grid).flat_map(move |x| (0..grid).map(move |y| square(x, y)))
    }
}

/// Unit of a disc's share along one axis, discs.
const SHARE: f64 = 1.0 / (1_u64 << 48) as f64;

/// Half a cell, of which there are 2³² units.
const HALF: i128 = 1 << 31;

/// The discs on each of `grid` × `grid` nodes, unit 2⁻⁹⁶ discs, of which 2³² discs are the most that fit.
fn deposit(grid: usize, positions: &[Position]) -> Vec<u128> {
    let mut nodes = vec![0_u128; grid * grid];
    for position in positions {
        let (columns, rows) = (shares(position.x, grid), shares(position.y, grid));
        for (x, along_x) in columns {
            for (y, along_y) in rows {
                nodes[x * grid + y] += along_x * along_y;
            }
        }
    }
    nodes
}

/// The nodes along one axis that a disc at `coordinate` is spread over, and its shares, unit 2⁻⁴⁸: with d the distance
/// from the nearest node in cells, (1/2 ∓ d)²/2 for its neighbours and what is left, 3/4 − d², for itself.
fn shares(coordinate: Fraction, grid: usize) -> [(usize, u128); 3] {
    let units = i128::from(coordinate.to_bits()) * grid as i128 + HALF;
    let nearest = (units >> 32) as usize % grid;
    let distance = (units & (UNITS as i128 - 1)) - HALF;
    // From unit 2⁻⁶⁵, rounded.
    let share = |reach: i128| ((reach * reach + (1 << 16)) >> 17) as u128;
    let (before, after) = (share(HALF - distance), share(HALF + distance));
    [
        ((nearest + grid - 1) % grid, before),
        (nearest, (1 << 48) - before - after),
        ((nearest + 1) % grid, after),
    ]
}
