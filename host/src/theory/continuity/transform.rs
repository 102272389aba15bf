//! The transform of a real function on the n × n cells, and back.

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlannerScalar};
use std::fmt;
use std::sync::Arc;

/// The transforms of lines of one length. The scalar ones have one order of operations on every processor.
#[derive(Clone)]
pub(super) struct Transform {
    cells: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for Transform {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Transform").field("cells", &self.cells).finish_non_exhaustive()
    }
}

impl Transform {
    pub(super) fn new(cells: usize) -> Self {
        let mut planner = FftPlannerScalar::new();
        Self { cells, forward: planner.plan_fft_forward(cells), inverse: planner.plan_fft_inverse(cells) }
    }

    /// Σ f exp(−ik·r), with the order along x as the slow index: wave (l, m) is element l·n + m.
    pub(super) fn forward(&self, values: &[f64]) -> Vec<Complex<f64>> {
        let mut waves: Vec<_> = values.iter().map(|&value| Complex::new(value, 0.0)).collect();
        self.both_axes(&*self.forward, &mut waves);
        waves
    }

    /// The real part of Σ f̂ exp(ik·r).
    pub(super) fn inverse(&self, mut waves: Vec<Complex<f64>>) -> Vec<f64> {
        self.both_axes(&*self.inverse, &mut waves);
        waves.into_iter().map(|value| value.re).collect()
    }

    fn both_axes(&self, transform: &dyn Fft<f64>, values: &mut [Complex<f64>]) {
        transform.process(values);
        self.transpose(values);
        transform.process(values);
    }

    fn transpose(&self, values: &mut [Complex<f64>]) {
        for row in 0..self.cells {
            for column in row + 1..self.cells {
                values.swap(row * self.cells + column, column * self.cells + row);
            }
        }
    }
}

/// The order, −n/2 ≤ l < n/2, of element `index` of a transform of `cells`.
pub(super) fn order(index: usize, cells: usize) -> f64 {
    if 2 * index < cells { index as f64 } else { index as f64 - cells as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    #[test]
    fn a_wave_is_where_it_is_said_to_be() {
        let cells = 6;
        let phase = |x: usize, y: usize| TAU * (2 * x + y) as f64 / cells as f64;
        let values: Vec<f64> =
            (0..cells * cells).map(|cell| libm::cos(phase(cell % cells, cell / cells))).collect();
        let waves = Transform::new(cells).forward(&values);
        for (index, wave) in waves.iter().enumerate() {
            let (l, m) = (order(index / cells, cells), order(index % cells, cells));
            let expected = if (l, m) == (2.0, 1.0) || (l, m) == (-2.0, -1.0) { 18.0 } else { 0.0 };
            assert!((wave.re - expected).abs() < 1e-12 && wave.im.abs() < 1e-12, "({l}, {m}): {wave}");
        }
        let back = Transform::new(cells).inverse(waves);
        assert!(back.iter().zip(&values).all(|(back, value)| (back / 36.0 - value).abs() < 1e-14));
    }
}
