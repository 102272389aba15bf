//! One step of Dormand and Prince's Runge-Kutta method of order 5 with an error of order 4.
//!
//! In the house and not a library's, since shells that meet change the equations: every step is looked at before it is
//! accepted.

/// a_ij of the stages 2 to 7; the last row is the solution.
const STAGES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// The solution of order 5 less that of order 4, by stages.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// The state after `step`, and the largest modulus of the estimated error of a component.
///
/// `rates(state, into)` says how fast a state changes; it does not depend on time.
pub(super) fn dormand_prince(
    state: &[f64],
    step: f64,
    rates: impl Fn(&[f64], &mut Vec<f64>),
) -> (Vec<f64>, f64) {
    let mut slopes = vec![Vec::new(); 7];
    let mut next = state.to_vec();
    rates(&next, &mut slopes[0]);
    for (stage, weights) in STAGES.iter().enumerate() {
        for (component, value) in next.iter_mut().enumerate() {
            let slope: f64 =
                weights.iter().zip(&slopes).map(|(weight, slope)| weight * slope[component]).sum();
            *value = state[component] + step * slope;
        }
        rates(&next, &mut slopes[stage + 1]);
    }
    let error = |component: usize| {
        let sum: f64 = ERROR.iter().zip(&slopes).map(|(weight, slope)| weight * slope[component]).sum();
        (step * sum).abs()
    };
    let largest = (0..state.len()).map(error).fold(0.0, f64::max);
    (next, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turning phase: its radius and angle after one turn.
    fn error_of(steps: u32) -> f64 {
        let step = core::f64::consts::TAU / f64::from(steps);
        let mut state = vec![1.0, 0.0];
        for _ in 0..steps {
            state = dormand_prince(&state, step, |state, into| *into = vec![-state[1], state[0]]).0;
        }
        libm::hypot(state[0] - 1.0, state[1])
    }

    #[test]
    fn the_error_falls_with_the_fifth_power_of_the_step() {
        let order = libm::log2(error_of(40) / error_of(80));
        assert!((order - 5.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn the_estimated_error_falls_with_the_fifth_power_of_one_step() {
        let estimate = |step| dormand_prince(&[1.0], step, |state, into| *into = vec![-state[0]]).1;
        let order = libm::log2(estimate(0.2) / estimate(0.1));
        assert!((order - 5.0).abs() < 0.2, "{order}");
    }
}
