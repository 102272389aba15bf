//! The modes of a density, by shells of wavenumbers, as those of discs are observed.

use super::transform::{Transform, order};
use rustfft::num_complex::Complex;

/// ρ̂_k = ∫ ρ exp(−ik·r) for the waves k = 2π(l, m)/L of a box: of discs it is the sum over them.
///
/// The waves of a shell s are those with |k|L/2π rounded to s.
///
/// ```
/// use meniscus::theory::continuity::{Spectrum, sinusoid};
///
/// let [before, later] = [0.1, 0.2].map(|height| Spectrum::new(100.0, 16, &sinusoid(16, 0.01, height, [3, 0])));
/// // The wave is twice as high; in the first shell there is none.
/// let growth = later.log_growth(&before, 4);
/// assert!((growth[2].unwrap() - 2.0_f64.ln()).abs() < 1e-12);
/// assert_eq!(growth[0], None);
/// ```
#[derive(Clone, Debug)]
pub struct Spectrum {
    cells: usize,
    /// Wave (l, m) is element l·n + m.
    waves: Vec<Complex<f64>>,
}

impl Spectrum {
    /// Of the `density` (R0⁻²) of `cells`² cells in a box of `side` (R0).
    ///
    /// Cells beyond the length of `density` are empty, and what is beyond the cells is left out.
    #[must_use]
    pub fn new(side: f64, cells: usize, density: &[f64]) -> Self {
        let area = (side / cells as f64) * (side / cells as f64);
        let mut numbers: Vec<f64> = density.iter().map(|density| area * density).collect();
        numbers.resize(cells * cells, 0.0);
        Self { cells, waves: Transform::new(cells).forward(&numbers) }
    }

    /// The mean ln(|ρ̂_k|/|ρ̂_k(0)|) of the shells 1 to `shells` since `initial`, over waves that are there both times: below
    /// 1e-12 of the number of discs is rounding. None for shells without such a wave, or if the meshes differ.
    #[must_use]
    pub fn log_growth(&self, initial: &Self, shells: usize) -> Vec<Option<f64>> {
        let least = 1e-12 * self.waves.first().map_or(0.0, |discs| discs.norm());
        let growth = |index: usize| {
            let (later, before) = (self.waves[index].norm(), initial.waves.get(index)?.norm());
            let there = later > least && before > least && self.cells == initial.cells;
            there.then(|| libm::log(later / before))
        };
        self.means(shells, growth)
    }

    /// Means of `value` of element `index` by shells, over the waves for which there is one.
    fn means(&self, shells: usize, value: impl Fn(usize) -> Option<f64>) -> Vec<Option<f64>> {
        let most = shells.min((self.cells / 2).saturating_sub(1));
        let mut sums = vec![(0.0, 0_u32); most + 1];
        for index in 0..self.waves.len() {
            let (l, m) = (order(index / self.cells, self.cells), order(index % self.cells, self.cells));
            let shell = libm::round(libm::hypot(l, m)) as usize;
            if let (Some((sum, count)), Some(value)) = (sums.get_mut(shell), value(index)) {
                *sum += value;
                *count += 1;
            }
        }
        sums.into_iter().skip(1).map(|(sum, count)| (count > 0).then(|| sum / f64::from(count))).collect()
    }
}
