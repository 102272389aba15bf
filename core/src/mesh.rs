//! The mesh solver: from node masses to the force field on the nodes.
//!
//! The order of operations is part of the contract; where things lie in memory is not. Columns x and
//! x + M/2 of the real mass are transformed together along y as one complex line, split by symmetry, and the
//! M/2+1 half-spectra transformed along x. Each mode is multiplied by the influence function and the
//! gradient, and one complex inverse transform, along x and then along y, gives F_x + i·F_y.
//!
//! The inverse is the forward transform of exchanged real and imaginary parts (see [`crate::transform`]): the
//! spectrum of F_y + i·F_x is written exchanged, and what comes out is F_x + i·F_y.
//!
//! ```
//! use meniscus_core::grid::Grid;
//! use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
//! use meniscus_core::mesh::{solve, Tables};
//! use meniscus_core::parameters::{Gradient, Parameters};
//! use meniscus_core::transform::{AnySize, Complex32};
//!
//! let gradient = Gradient::Difference2;
//! let parameters = Parameters { grid: 16, side: 16.0, gradient, ..Parameters::default() };
//! let mut influence = [0.0; influence_length(16)];
//! let mut gradient = [0.0; 16];
//! fill_influence(&parameters, &mut influence);
//! fill_gradient(&parameters, &mut gradient);
//! let mut nodes = [0; 256];
//! nodes[8 * 16 + 8] = 1 << 20;
//! let mut field = [Complex32::new(0.0, 0.0); 256];
//! let mut lines = [Complex32::new(0.0, 0.0); 32];
//! let tables = Tables { influence: &influence, gradient: &gradient };
//! solve(&AnySize, Grid::SMALLEST, &tables, &nodes, &mut field, &mut lines);
//! // A disc at the middle attracts from its left to the right.
//! assert!(field[4 * 16 + 8].re > 0.0);
//! ```

use crate::grid::Grid;
use crate::transform::{Complex32, LineTransform};

/// Working lines with which [`solve`] uses whole cache lines: 8 complex numbers, for row m and row −m.
pub const LINES: usize = 16;

/// What a spectrum is multiplied with, see [`crate::influence`].
#[derive(Clone, Copy, Debug)]
pub struct Tables<'a> {
    /// (M/2+1)² entries.
    pub influence: &'a [f32],
    /// M entries.
    pub gradient: &'a [f32],
}

/// Turns node masses (M × M, unit 2⁻²⁰ discs) into `field`, F_x + i·F_y on M × M nodes in kBT/R0.
///
/// `lines` is working memory of 2M elements or a multiple of that, best [`LINES`]·M; with less than
/// 2M nothing is done.
pub fn solve<T: LineTransform>(
    transform: &T,
    grid: Grid,
    tables: &Tables<'_>,
    nodes: &[u32],
    field: &mut [Complex32],
    lines: &mut [Complex32],
) {
    let columns = Columns { nodes, value: |mass| mass as f32 };
    solve_columns(transform, grid, tables, &columns, field, lines);
}

/// As [`solve`], for capillary strengths of either sign: the nodes hold two's complement, unit 2⁻²⁰.
pub fn solve_strengths<T: LineTransform>(
    transform: &T,
    grid: Grid,
    tables: &Tables<'_>,
    nodes: &[u32],
    field: &mut [Complex32],
    lines: &mut [Complex32],
) {
    let columns = Columns { nodes, value: |sum| sum as i32 as f32 };
    solve_columns(transform, grid, tables, &columns, field, lines);
}

fn solve_columns<T: LineTransform, V: Fn(u32) -> f32>(
    transform: &T,
    grid: Grid,
    tables: &Tables<'_>,
    columns: &Columns<'_, V>,
    field: &mut [Complex32],
    lines: &mut [Complex32],
) {
    let side = grid.nodes();
    let rows_at_once = lines.len() / (2 * side);
    // The compiler cannot see that these two conditions are one.
    let Some((upper, lower)) = lines.split_at_mut_checked(rows_at_once * side) else { return };
    if rows_at_once == 0 {
        return;
    }
    columns.transform(transform, side, field);
    let half = side / 2;
    for first in (0..=half).step_by(rows_at_once) {
        let rows = Rows { grid, first, count: rows_at_once.min(half + 1 - first) };
        rows.split_columns(field, upper);
        rows.to_force(transform, tables, upper, lower);
        rows.store(field, upper, lower);
    }
    for line in field.chunks_exact_mut(side) {
        transform.forward(line);
    }
}

/// The columns of the mesh, and what the 32 bits of a node stand for.
struct Columns<'a, V> {
    nodes: &'a [u32],
    value: V,
}

impl<V: Fn(u32) -> f32> Columns<'_, V> {
    /// Transforms columns x and x + M/2 along y as one complex line, into line x of `field`, x < M/2.
    fn transform<T: LineTransform>(&self, transform: &T, grid: usize, field: &mut [Complex32]) {
        let (left, right) = self.nodes.split_at(self.nodes.len() / 2);
        let columns = left.chunks_exact(grid).zip(right.chunks_exact(grid));
        for (line, (left, right)) in field.chunks_exact_mut(grid).zip(columns) {
            for (value, (&left, &right)) in line.iter_mut().zip(left.iter().zip(right)) {
                *value = Complex32::new((self.value)(left), (self.value)(right));
            }
            transform.forward(line);
        }
    }
}

/// Consecutive rows of the spectrum, k_y index `first` to `first + count` − 1, all in 0 … M/2.
///
/// Row m and its mirror −m of the result take the place of elements m and M − m of every line of the field.
struct Rows {
    grid: Grid,
    first: usize,
    count: usize,
}

impl Rows {
    /// The indices m.
    fn indices(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.count
    }

    /// Whether row m is its own mirror image: 0 and Nyquist.
    fn is_own_mirror(&self, index: usize) -> bool {
        index == 0 || index == self.grid.nodes() / 2
    }

    /// Separates the spectra of the two columns in each line: twice that of column x and of x + M/2.
    fn split_columns(&self, field: &[Complex32], upper: &mut [Complex32]) {
        let grid = self.grid.nodes();
        let half = grid / 2;
        for (x, line) in field.chunks_exact(grid).take(half).enumerate() {
            for (row, index) in upper.chunks_exact_mut(grid).zip(self.indices()) {
                let mirror = (grid - index) & (grid - 1);
                let (Some(z), Some(w)) = (line.get(index), line.get(mirror)) else { continue };
                let (left, right) = row.split_at_mut(half);
                if let (Some(left), Some(right)) = (left.get_mut(x), right.get_mut(x)) {
                    *left = Complex32::new(z.re + w.re, z.im - w.im);
                    *right = Complex32::new(z.im + w.im, w.re - z.re);
                }
            }
        }
    }

    /// Transforms each row along x, multiplies it with the tables and transforms the result back along x:
    /// row m into `upper`, row −m into `lower`.
    fn to_force<T: LineTransform>(
        &self,
        transform: &T,
        tables: &Tables<'_>,
        upper: &mut [Complex32],
        lower: &mut [Complex32],
    ) {
        let grid = self.grid.nodes();
        let rows = upper.chunks_exact_mut(grid).zip(lower.chunks_exact_mut(grid));
        for ((row, mirror), index) in rows.zip(self.indices()) {
            transform.forward(row);
            multiply(grid, tables, index, row, mirror);
            transform.forward(row);
            if !self.is_own_mirror(index) {
                transform.forward(mirror);
            }
        }
    }

    /// Puts the rows into their places in the field.
    fn store(&self, field: &mut [Complex32], upper: &[Complex32], lower: &[Complex32]) {
        let grid = self.grid.nodes();
        for (x, line) in field.chunks_exact_mut(grid).enumerate() {
            let rows = upper.chunks_exact(grid).zip(lower.chunks_exact(grid));
            for ((row, mirror), index) in rows.zip(self.indices()) {
                if let (Some(value), Some(&force)) = (line.get_mut(index), row.get(x)) {
                    *value = force;
                }
                if self.is_own_mirror(index) {
                    continue;
                }
                if let (Some(value), Some(&force)) = (line.get_mut(grid - index), mirror.get(x)) {
                    *value = force;
                }
            }
        }
    }
}

/// Multiplies row m of the spectrum with influence function and gradient.
///
/// With S = influence · ρ̂ and the gradient g, F̂ = i g S. What is to come out exchanged is written as
/// F̂_y + i·F̂_x, and that exchanged in turn is (g_y S_re − g_x S_im) − i (g_x S_re + g_y S_im); at −k, where S is
/// conjugate and g changes sign, it is −(g_y S_re + g_x S_im) + i (g_x S_re − g_y S_im).
fn multiply(grid: usize, tables: &Tables<'_>, index: usize, row: &mut [Complex32], mirror: &mut [Complex32]) {
    let half = grid / 2;
    let influence = tables.influence.get(index * (half + 1)..).unwrap_or(&[]);
    let along_y = tables.gradient.get(index).copied().unwrap_or(0.0);
    for (x, (value, &along_x)) in row.iter_mut().zip(tables.gradient).enumerate() {
        let frequency = if x > half { grid - x } else { x };
        let factor = influence.get(frequency).copied().unwrap_or(0.0);
        let (real, imaginary) = (factor * value.re, factor * value.im);
        let (x_real, x_imaginary) = (along_x * real, along_x * imaginary);
        let (y_real, y_imaginary) = (along_y * real, along_y * imaginary);
        *value = Complex32::new(y_real - x_imaginary, -x_real - y_imaginary);
        if let Some(opposite) = mirror.get_mut((grid - x) & (grid - 1)) {
            *opposite = Complex32::new(-y_real - x_imaginary, x_real - y_imaginary);
        }
    }
}
