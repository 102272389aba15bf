//! Densities to start from. Any other serves as well, for example that of discs on the mesh.

use core::f64::consts::TAU;

/// Points a side by which the fraction of a cell inside a circle is found.
const POINTS: usize = 16;

/// `mean`·(1 + `amplitude`·cos k·r) (R0⁻²) at the centres of `cells`² cells, k = 2π`wave`/L.
///
/// ```
/// let density = meniscus::theory::continuity::sinusoid(4, 0.01, 0.5, [1, 0]);
/// assert!((density[0] - 0.015).abs() < 1e-15 && (density[2] - 0.005).abs() < 1e-15);
/// ```
#[must_use]
pub fn sinusoid(cells: usize, mean: f64, amplitude: f64, wave: [i32; 2]) -> Vec<f64> {
    let turns =
        |x: usize, y: usize| (f64::from(wave[0]) * x as f64 + f64::from(wave[1]) * y as f64) / cells as f64;
    let value = |cell: usize| 1.0 + amplitude * libm::cos(TAU * turns(cell % cells, cell / cells));
    (0..cells * cells).map(|cell| mean * value(cell)).collect()
}

/// A patch of `density` (R0⁻²) within `radius` (R0) of the middle of a box of `side` (R0), and nothing outside (Eq. 12): mean
/// densities of `cells`² cells.
///
/// ```
/// let density = meniscus::theory::continuity::top_hat(800.0, 32, 450.0 / 105_209.0, 183.0);
/// let discs: f64 = density.iter().sum::<f64>() * 25.0 * 25.0;
/// assert!((discs - 450.0).abs() < 0.5);
/// ```
#[must_use]
pub fn top_hat(side: f64, cells: usize, density: f64, radius: f64) -> Vec<f64> {
    let spacing = side / cells as f64;
    // From the middle of the box, in a cell centred at x·h; a cell reaches over the border at x = 0.
    let from_middle = |cell: usize, point: usize| {
        let within = (point as f64 + 0.5) / POINTS as f64 - 0.5;
        spacing * (cell as f64 + within) - 0.5 * side
    };
    let inside = |cell: usize| {
        let (x, y) = (cell % cells, cell / cells);
        let points = (0..POINTS * POINTS).filter(|point| {
            libm::hypot(from_middle(x, point % POINTS), from_middle(y, point / POINTS)) < radius
        });
        points.count() as f64 / (POINTS * POINTS) as f64
    };
    (0..cells * cells).map(|cell| density * inside(cell)).collect()
}
