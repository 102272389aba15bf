//! The mesh solve made with RustFFT (through realfft): lines along y, a transposition, lines along x, and back twice.

use crate::batches::Work;
use crate::problem::{checked_nodes, mass, parameters};
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};
use std::error::Error;
use std::sync::Arc;

/// Masses on nodes, their spectrum (transposed: one line for each k_y), and the two components of the force.
pub struct Mesh {
    grid: usize,
    along_y: Arc<dyn RealToComplex<f32>>,
    back_along_y: Arc<dyn ComplexToReal<f32>>,
    along_x: Arc<dyn Fft<f32>>,
    back_along_x: Arc<dyn Fft<f32>>,
    influence: Vec<f32>,
    gradient: Vec<f32>,
    mass: Vec<f32>,
    rows: Vec<Complex32>,
    spectrum: Vec<Complex32>,
    product: Vec<Complex32>,
    force: [Vec<f32>; 2],
    line: Vec<f32>,
    scratch: Vec<Complex32>,
}

impl Mesh {
    pub fn new(grid: usize) -> Result<Self, Box<dyn Error>> {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        let (along_y, back_along_y) = (real.plan_fft_forward(grid), real.plan_fft_inverse(grid));
        let (along_x, back_along_x) = (complex.plan_fft_forward(grid), complex.plan_fft_inverse(grid));
        let scratch = [
            along_y.get_scratch_len(),
            back_along_y.get_scratch_len(),
            along_x.get_inplace_scratch_len(),
            back_along_x.get_inplace_scratch_len(),
        ];
        let zero = Complex32::new(0.0, 0.0);
        let modes = grid * (grid / 2 + 1);
        let mut mesh = Self {
            grid,
            along_y,
            back_along_y,
            along_x,
            back_along_x,
            influence: vec![0.0; influence_length(grid)],
            gradient: vec![0.0; grid],
            mass: (0..grid * grid).map(|index| mass(index) as f32).collect(),
            rows: vec![zero; modes],
            spectrum: vec![zero; modes],
            product: vec![zero; modes],
            force: [vec![0.0; grid * grid], vec![0.0; grid * grid]],
            line: vec![0.0; grid],
            scratch: vec![zero; scratch.into_iter().max().unwrap_or(0)],
        };
        fill_influence(&parameters(grid), &mut mesh.influence);
        // The table is for a solver that halves twice less.
        mesh.influence.iter_mut().for_each(|entry| *entry *= 2.0);
        fill_gradient(&parameters(grid), &mut mesh.gradient);
        Ok(mesh)
    }

    fn transform(&mut self) -> Result<(), Box<dyn Error>> {
        let half = self.grid / 2 + 1;
        for (row, line) in self.rows.chunks_exact_mut(half).zip(self.mass.chunks_exact(self.grid)) {
            self.line.copy_from_slice(line);
            self.along_y.process_with_scratch(&mut self.line, row, &mut self.scratch)?;
        }
        transpose::transpose(&self.rows, &mut self.spectrum, half, self.grid);
        self.along_x.process_with_scratch(&mut self.spectrum, &mut self.scratch);
        Ok(())
    }

    /// Multiplies with influence function and gradient along y if `axis` is 1, otherwise along x: F = i g S.
    fn multiply(&mut self, axis: usize) {
        let (grid, half) = (self.grid, self.grid / 2 + 1);
        let lines = self.product.chunks_exact_mut(grid).zip(self.spectrum.chunks_exact(grid));
        for (m, (product, spectrum)) in lines.enumerate() {
            let influence = &self.influence[m * half..(m + 1) * half];
            let along_y = self.gradient[m];
            let mirrored = influence.iter().chain(influence[1..half - 1].iter().rev());
            let modes = product.iter_mut().zip(spectrum).zip(mirrored.zip(&self.gradient));
            for ((product, value), (&influence, &along_x)) in modes {
                let factor = influence * if axis == 1 { along_y } else { along_x };
                *product = Complex32::new(-factor * value.im, factor * value.re);
            }
        }
    }

    fn transform_back(&mut self, axis: usize) -> Result<(), Box<dyn Error>> {
        let half = self.grid / 2 + 1;
        self.back_along_x.process_with_scratch(&mut self.product, &mut self.scratch);
        transpose::transpose(&self.product, &mut self.rows, self.grid, half);
        for (row, line) in self.rows.chunks_exact_mut(half).zip(self.force[axis].chunks_exact_mut(self.grid))
        {
            // Real up to rounding, and realfft insists.
            row[0].im = 0.0;
            row[half - 1].im = 0.0;
            self.back_along_y.process_with_scratch(row, line, &mut self.scratch)?;
        }
        Ok(())
    }
}

impl Work for Mesh {
    fn once(&mut self) -> Result<(), Box<dyn Error>> {
        self.transform()?;
        for axis in [0, 1] {
            self.multiply(axis);
            self.transform_back(axis)?;
        }
        Ok(())
    }

    fn values(&self) -> Vec<f32> {
        let [x, y] = &self.force;
        checked_nodes(self.grid).flat_map(|node| [x[node], y[node]]).collect()
    }
}
