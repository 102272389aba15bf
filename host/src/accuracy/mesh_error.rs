//! What the mesh makes of the far part.

use super::System;
use core::f64::consts::PI;
use meniscus_core::parameters::Assignment;

/// Wave numbers are sampled on at most this many points an axis: the sum depends on M only where the mesh is smaller.
const MOST_POINTS: usize = 64;
/// Aliases of a wave number along an axis: itself and its neighbours. With αh ≤ 0.7 the next has a factor e⁻⁴⁵ or less.
const ALIASES: [f64; 3] = [0.0, -1.0, 1.0];
/// Aliases on either side that count in the sum of windows.
const WINDOW_ALIASES: i32 = 4;

/// The optimal far part's error for one mesh size and assignment, ready for any splitting.
///
/// Hockney and Eastwood's optimal influence function leaves, in the mean over all places of two discs relative to the
/// mesh, the square of the force error per disc (their eq. 8-23; for energies Deserno and Holm 1998, eq. 30)
///
/// ⟨f²⟩²·(N/L⁴)·Σ_k { Σ_m |R(k_m)|² − [D·Σ_m U²(k_m) R(k_m)]² / (|D|² [Σ_m U²(k_m)]²) }
///
/// over the wave numbers k of the mesh, with k_m = k + 2πm/h, the target R = k·2πV0·exp(−(k²+κ²)/4α²)/(k²+κ²), the
/// window U = [sinc(k_x h/2) sinc(k_y h/2)]^p and the spectral gradient D = k, a component of which is 0 at Nyquist. In
/// units of h the mean of the braces depends on αh, κh and p only, hardly on M. Aliases of a window are
/// that window times (k/k_m)^p for each axis, as the sines are the same.
pub(super) struct MeshError {
    /// One entry for each wave number from 0 to Nyquist.
    axis: Vec<AxisPoint>,
}

/// A wave number along an axis, and its aliases.
#[derive(Clone, Copy)]
struct AxisPoint {
    /// k_m·h of [`ALIASES`].
    wave_numbers: [f64; 3],
    /// U²(k_m)/U²(k) of [`ALIASES`], the first of which is 1.
    windows: [f64; 3],
    /// Σ U²(k_m)/U²(k) over all aliases but the wave number itself.
    other_windows: f64,
    /// exp(−(k_m h)²/(4 (αh)²)) of [`ALIASES`].
    decays: [f64; 3],
    /// How many wave numbers ±k the mesh has.
    copies: f64,
    is_nyquist: bool,
}

impl MeshError {
    /// For M = `grid` nodes a side.
    pub(super) fn new(grid: usize, assignment: Assignment) -> Self {
        let half = grid.clamp(2, MOST_POINTS) / 2;
        let point = |index: usize| {
            let wave_number = PI * index as f64 / half as f64;
            let window =
                |alias: f64| power(wave_number / (wave_number + 2.0 * PI * alias), 2 * assignment.order());
            AxisPoint {
                wave_numbers: ALIASES.map(|alias| wave_number + 2.0 * PI * alias),
                windows: ALIASES.map(|alias| if alias == 0.0 { 1.0 } else { window(alias) }),
                other_windows: (1..=WINDOW_ALIASES)
                    .map(f64::from)
                    .map(|alias| window(alias) + window(-alias))
                    .sum(),
                decays: [0.0; 3],
                copies: if index == 0 || index == half { 1.0 } else { 2.0 },
                is_nyquist: index == half,
            }
        };
        Self { axis: (0..=half).map(point).collect() }
    }

    /// The root mean square error, kBT/R0, for the mesh spacing h (R0) and the splitting α (1/R0).
    pub(super) fn evaluate(&mut self, system: &System, spacing: f64, splitting: f64) -> f64 {
        let splitting_of_spacing = splitting * spacing;
        let screening_of_spacing = system.screening() * spacing;
        for point in &mut self.axis {
            point.decays = point
                .wave_numbers
                .map(|k| libm::exp(-k * k / (4.0 * splitting_of_spacing * splitting_of_spacing)));
        }
        let ratio = 0.5 * system.screening() / splitting;
        let mean = self.mean(screening_of_spacing * screening_of_spacing);
        2.0 * PI * system.force_scale() * libm::exp(-ratio * ratio) * mean.sqrt()
    }

    /// The mean of the braces over the wave numbers of the mesh, in units of h and without 2πV0 and exp(−κ²/4α²).
    fn mean(&self, screening_squared: f64) -> f64 {
        let mut sum = 0.0;
        for (index, x) in self.axis.iter().enumerate() {
            for (other, y) in self.axis.iter().enumerate().take(index + 1) {
                let copies = if other == index { 1.0 } else { 2.0 };
                if index > 0 {
                    sum += copies * x.copies * y.copies * defect(x, y, screening_squared);
                }
            }
        }
        let points = 2.0 * (self.axis.len() - 1) as f64;
        sum / (points * points)
    }
}

/// The braces for one wave number.
///
/// At long waves the two terms nearly cancel, so it is formed of |R(k)|² − X² = (|R(k)| − X)(|R(k)| + X) and the rest.
fn defect(x: &AxisPoint, y: &AxisPoint, screening_squared: f64) -> f64 {
    let along = [
        if x.is_nyquist { 0.0 } else { x.wave_numbers[0] },
        if y.is_nyquist { 0.0 } else { y.wave_numbers[0] },
    ];
    let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
    let direction = if length > 0.0 { along.map(|component| component / length) } else { [0.0; 2] };
    let mut own = [0.0; 2];
    let (mut squares, mut seen) = (0.0, 0.0);
    for i in 0..ALIASES.len() {
        for j in 0..ALIASES.len() {
            let (kx, ky) = (x.wave_numbers[i], y.wave_numbers[j]);
            let magnitude = x.decays[i] * y.decays[j] / (kx * kx + ky * ky + screening_squared);
            let target = [kx * magnitude, ky * magnitude];
            if (i, j) == (0, 0) {
                own = target;
            } else {
                squares += target[0] * target[0] + target[1] * target[1];
                seen += x.windows[i] * y.windows[j] * (target[0] * direction[0] + target[1] * direction[1]);
            }
        }
    }
    let parallel = own[0] * direction[0] + own[1] * direction[1];
    let across = own[0] * direction[1] - own[1] * direction[0];
    let others = x.other_windows + y.other_windows + x.other_windows * y.other_windows;
    let lacking = (parallel * others - seen) / (1.0 + others);
    let unseen = if length > 0.0 { across * across } else { own[0] * own[0] + own[1] * own[1] };
    (lacking * (2.0 * parallel - lacking) + unseen + squares).max(0.0)
}

/// `base` to the power `exponent`, by multiplication.
fn power(base: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn system(capillary_length: f64) -> System {
        System {
            side: 1.0,
            particles: 1,
            capillary_strength: 1.0,
            capillary_length,
            mean_square_strength: 1.0,
        }
    }

    /// The formula as it is printed: aliases −2 to 2, windows with their sines, all wave numbers of M nodes.
    fn by_the_book(grid: i32, order: i32, splitting_of_spacing: f64, screening_of_spacing: f64) -> f64 {
        let window = |k: f64| {
            let sinc = if k == 0.0 { 1.0 } else { libm::sin(0.5 * k) / (0.5 * k) };
            libm::pow(sinc, 2.0 * f64::from(order))
        };
        let mut sum = 0.0;
        for l in -grid / 2..grid / 2 {
            for m in -grid / 2..grid / 2 {
                if (l, m) == (0, 0) {
                    continue;
                }
                let base = [l, m].map(|index| 2.0 * PI * f64::from(index) / f64::from(grid));
                let gradient = [0, 1].map(|axis| if [l, m][axis] == -grid / 2 { 0.0 } else { base[axis] });
                let (mut squares, mut windows, mut seen) = (0.0, 0.0, 0.0);
                for a in -2..=2 {
                    for b in -2..=2 {
                        let k = [base[0] + 2.0 * PI * f64::from(a), base[1] + 2.0 * PI * f64::from(b)];
                        let squared = k[0] * k[0] + k[1] * k[1];
                        let screened = squared + screening_of_spacing * screening_of_spacing;
                        let decay =
                            libm::exp(-screened / (4.0 * splitting_of_spacing * splitting_of_spacing));
                        let target = k.map(|component| 2.0 * PI * component * decay / screened);
                        let weight = window(k[0]) * window(k[1]);
                        squares += target[0] * target[0] + target[1] * target[1];
                        windows += weight;
                        seen += weight * (gradient[0] * target[0] + gradient[1] * target[1]);
                    }
                }
                let length = gradient[0] * gradient[0] + gradient[1] * gradient[1];
                let matched = if length > 0.0 { seen * seen / (length * windows * windows) } else { 0.0 };
                sum += squares - matched;
            }
        }
        (sum / f64::from(grid * grid)).sqrt()
    }

    #[test]
    fn it_is_the_formula_of_hockney_and_eastwood() {
        for (order, splitting_of_spacing, screening_of_spacing) in
            [(2, 0.8, 0.0), (3, 0.49, 0.01), (5, 0.33, 0.3), (7, 0.6, 0.0), (6, 1.0, 1.0)]
        {
            let expected = by_the_book(32, order, splitting_of_spacing, screening_of_spacing);
            let assignment = Assignment::ALL[order as usize - 2];
            let found = MeshError::new(32, assignment).evaluate(
                &system(1.0 / screening_of_spacing),
                1.0,
                splitting_of_spacing,
            );
            assert!((found / expected - 1.0).abs() < 1e-2, "{order}: {found} instead of {expected}");
        }
    }

    #[test]
    fn larger_meshes_are_sampled_well_enough() {
        for (order, splitting_of_spacing, screening_of_spacing) in [(2, 0.1, 0.0), (5, 0.49, 0.3)] {
            let expected = by_the_book(128, order, splitting_of_spacing, screening_of_spacing);
            let assignment = Assignment::ALL[order as usize - 2];
            let found = MeshError::new(128, assignment).evaluate(
                &system(1.0 / screening_of_spacing),
                1.0,
                splitting_of_spacing,
            );
            assert!((found / expected - 1.0).abs() < 3e-2, "{order}: {found} instead of {expected}");
        }
    }
}
