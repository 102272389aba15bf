//! What flows between neighbouring cells, and how their densities change by it.

use crate::theory::Pressure;

/// How the cells fill and empty.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    /// dρ/dt of each cell, D·R0⁻⁴.
    pub rates: Vec<f64>,
    /// The largest outflow of a cell relative to its content, D/R0².
    pub largest_loss: f64,
}

/// dρ/dt of `cells`² cells with the given `density` (R0⁻²) in the `potential` W = U − μ_ex (kBT), `per_area` = 1/h² (R0⁻²).
pub(super) fn rates(
    pressure: Pressure,
    cells: usize,
    per_area: f64,
    density: &[f64],
    potential: &[f64],
) -> Flow {
    let mut rates = vec![0.0; density.len()];
    let mut losses = vec![0.0; density.len()];
    let mut exchange = |[before, first, second, after]: [usize; 4]| {
        let drop = potential[second] - potential[first];
        let [forward, backward] = match pressure {
            Pressure::None => upwind([before, first, second, after].map(|cell| density[cell]), drop),
            Pressure::IdealGas | Pressure::HardDiscs { .. } => {
                let [forward, backward] = bernoulli_of_both_signs(drop);
                [forward * density[first], backward * density[second]]
            }
        };
        rates[first] += per_area * (backward - forward);
        rates[second] += per_area * (forward - backward);
        losses[first] += forward;
        losses[second] += backward;
    };
    for line in 0..cells {
        let mut four = [cells - 2, cells - 1, 0, 1];
        for next in 2..cells + 2 {
            exchange(four.map(|x| line * cells + x));
            exchange(four.map(|y| y * cells + line));
            four = [four[1], four[2], four[3], next % cells];
        }
    }
    let relative =
        |(loss, &density): (f64, &f64)| if density > 0.0 { per_area * loss / density } else { 0.0 };
    let largest_loss = losses.into_iter().zip(density).map(relative).fold(0.0, f64::max);
    Flow { rates, largest_loss }
}

/// B(−x) and B(x) of B(x) = x/(eˣ − 1), 1 at x = 0; by B(−x) = B(x) + x one exponential makes both.
fn bernoulli_of_both_signs(x: f64) -> [f64; 2] {
    let modulus = x.abs();
    let lesser = if modulus == 0.0 { 1.0 } else { modulus / libm::expm1(modulus) };
    if x >= 0.0 { [lesser + modulus, lesser] } else { [lesser, lesser + modulus] }
}

/// h² times the flow between the middle two of four cells, either way, when U is higher by `drop` in the second:
/// ρΔU with ρ extrapolated from where it comes from.
fn upwind([before, first, second, after]: [f64; 4], drop: f64) -> [f64; 2] {
    if drop >= 0.0 {
        [drop * (first + 0.5 * limited_slope(first - before, second - first)), 0.0]
    } else {
        [0.0, -drop * (second - 0.5 * limited_slope(second - first, after - second))]
    }
}

/// Van Leer's slope: the harmonic mean of two differences, 0 at an extremum. At most twice the smaller, so that what is
/// extrapolated over half a cell is positive and at most twice the cell's density.
fn limited_slope(before: f64, after: f64) -> f64 {
    let product = before * after;
    if product > 0.0 { 2.0 * product / (before + after) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between 0 and 1 without a pattern.
    fn scattered(count: usize) -> Vec<f64> {
        (0..count).map(|index| (index as f64 * 0.618_033_988_749_894_8).fract()).collect()
    }

    #[test]
    fn the_barometric_density_does_not_flow() {
        let potential: Vec<f64> = scattered(64).iter().map(|value| 20.0 * value).collect();
        let density: Vec<f64> = potential.iter().map(|&potential| libm::exp(potential - 10.0)).collect();
        let flow = rates(Pressure::IdealGas, 8, 1.0, &density, &potential);
        for (rate, density) in flow.rates.iter().zip(&density) {
            assert!(rate.abs() < 1e-13 * flow.largest_loss * density, "{rate}");
        }
    }

    #[test]
    fn what_leaves_a_cell_enters_another() {
        let (density, potential) =
            (scattered(49), scattered(50)[1..].iter().map(|v| 9.0 * v).collect::<Vec<_>>());
        for pressure in [Pressure::None, Pressure::IdealGas, Pressure::HardDiscs { radius: 0.1 }] {
            let flow = rates(pressure, 7, 0.25, &density, &potential);
            let moduli: f64 = flow.rates.iter().map(|rate| rate.abs()).sum();
            assert!(flow.rates.iter().sum::<f64>().abs() < 1e-14 * moduli, "{pressure:?}");
        }
    }

    #[test]
    fn no_cell_loses_more_than_it_is_said_to() {
        let (density, potential) =
            (scattered(49), scattered(50)[1..].iter().map(|v| 9.0 * v).collect::<Vec<_>>());
        for pressure in [Pressure::None, Pressure::IdealGas] {
            let flow = rates(pressure, 7, 0.25, &density, &potential);
            let step = 1.0 / flow.largest_loss;
            for (density, rate) in density.iter().zip(&flow.rates) {
                assert!(density + step * rate >= -1e-15, "{pressure:?}");
            }
        }
    }

    #[test]
    fn diffusion_alone_is_the_laplacian() {
        let mut density = vec![0.0; 25];
        density[12] = 1.0;
        let flow = rates(Pressure::IdealGas, 5, 4.0, &density, &[0.0; 25]);
        assert_eq!(flow.rates[12], -16.0);
        assert_eq!([7, 11, 13, 17].map(|cell| flow.rates[cell]), [4.0; 4]);
        assert_eq!(flow.rates[6], 0.0);
    }
}
