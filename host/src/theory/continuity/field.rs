//! The field U of a density on the mesh: (κ² − ∇²)U = 2πV0·ρ, with ∇² of five points.

use super::transform::Transform;
use core::f64::consts::{PI, TAU};

/// The field of one box.
#[derive(Clone, Debug)]
pub(super) struct Field {
    transform: Transform,
    /// 2πV0/[n²(k² + κ²)] of the wave (l, m) as element l·n + m; 0 at k = 0.
    influence: Vec<f64>,
}

impl Field {
    /// A box of `side` (R0) with V0 = `strength` (kBT) and λ = `length` (R0), on `cells`² cells.
    ///
    /// k² = (4/h²)[sin²(k_x h/2) + sin²(k_y h/2)] is what five points make of −∇².
    pub(super) fn new(side: f64, cells: usize, strength: f64, length: f64) -> Self {
        let spacing = side / cells as f64;
        let squares: Vec<f64> = (0..cells)
            .map(|index| {
                let sine = libm::sin(PI * index as f64 / cells as f64);
                4.0 * sine * sine / (spacing * spacing)
            })
            .collect();
        let screening = 1.0 / (length * length);
        let scale = TAU * strength / (cells * cells) as f64;
        let along = |l: f64| squares.iter().map(move |m| scale / (l + m + screening));
        let mut influence: Vec<f64> = squares.iter().flat_map(|&l| along(l)).collect();
        influence[0] = 0.0;
        Self { transform: Transform::new(cells), influence }
    }

    /// U of each cell, kBT, with its mean left out, of a `density` (R0⁻²).
    pub(super) fn of(&self, density: &[f64]) -> Vec<f64> {
        let mut waves = self.transform.forward(density);
        waves.iter_mut().zip(&self.influence).for_each(|(wave, influence)| *wave *= influence);
        self.transform.inverse(waves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_solves_its_equation() {
        let (side, cells, strength) = (60.0, 12, 0.89);
        let density: Vec<f64> = (0..cells * cells).map(|cell| ((cell * cell) % 17) as f64 * 1e-3).collect();
        let mean = density.iter().sum::<f64>() / density.len() as f64;
        for length in [3.0, 100.0, f64::INFINITY] {
            let field = Field::new(side, cells, strength, length).of(&density);
            for cell in 0..cells * cells {
                let (x, y) = (cell % cells, cell / cells);
                let at = |x: usize, y: usize| field[(y % cells) * cells + x % cells];
                let neighbours = at(x + 1, y) + at(x + cells - 1, y) + at(x, y + 1) + at(x, y + cells - 1);
                let laplacian = (neighbours - 4.0 * field[cell]) / 25.0;
                let source = TAU * strength * (density[cell] - mean);
                assert!((field[cell] / (length * length) - laplacian - source).abs() < 1e-13, "{length}");
            }
        }
    }
}
