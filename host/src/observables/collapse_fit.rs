//! The fit of a collapsing ring or shell, R(t) = R_f + (R_i − R_f)√(1 − t/(A0·T)) (Eq. 30), by least squares.
//!
//! In: times over Jeans' time T and radii in R0. Out: A0, a pure number, and R_i and R_f in R0, each with its standard
//! error: the square root of its variance in s²(JᵀJ)⁻¹, where J is the Jacobian of the model and s² the sum of squared
//! residuals over the number of samples less that of parameters. That holds for residuals that know nothing of each other;
//! those of one run do, so that the scatter over runs is the better error where there are several.
//!
//! Either radius can be held. A0 and R_f together hardly leave their mark on a collapse that has not ended: with R_f free
//! they come out smaller than the paper's, with large errors.
//!
//! The minimum is found by Levenberg and Marquardt's algorithm from several guesses of A0; the lowest counts.
//!
//! ```
//! use meniscus::observables::collapse_fit::{Conditions, fit};
//! use meniscus::theory::collapse_fit;
//!
//! let samples: Vec<(f64, f64)> =
//!     (0..90).map(|k| 0.01 * f64::from(k)).map(|t| (t, collapse_fit(135.0, 18.0, 1.15, t))).collect();
//! let conditions = Conditions { final_radius: Some(18.0), ..Conditions::default() };
//! let fitted = fit(&samples, &conditions).unwrap();
//! assert!((fitted.delay.value - 1.15).abs() < 1e-6);
//! assert!((fitted.initial_radius.value - 135.0).abs() < 1e-6);
//! assert_eq!((fitted.samples, fitted.final_radius.error), (89, 0.0));
//! ```

use crate::statistics::Estimate;
use crate::theory::collapse_fit;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, TerminationReason};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

/// Guesses of A0·T over the time of the last sample.
const GUESSES: [f64; 5] = [1.02, 1.2, 1.6, 3.0, 10.0];

/// A0·T over the time of the last sample beyond which a collapse is a straight line, or none.
const FARTHEST: f64 = 1e4;

/// What a fit is to hold, and how far it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// R_i in R0 if it is held.
    pub initial_radius: Option<f64>,
    /// R_f in R0 if it is held.
    pub final_radius: Option<f64>,
    /// Samples with 0 < t/T < `until` are fitted.
    pub until: f64,
}

/// Nothing held, up to 0.9 T.
impl Default for Conditions {
    fn default() -> Self {
        Self { initial_radius: None, final_radius: None, until: 0.9 }
    }
}

/// A fitted collapse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollapseFit {
    /// A0.
    pub delay: Estimate,
    /// R_i, R0; its error is 0 if it was held.
    pub initial_radius: Estimate,
    /// R_f, R0; its error is 0 if it was held.
    pub final_radius: Estimate,
    /// Root mean square of the residuals, R0.
    pub residual: f64,
    /// Number of samples fitted.
    pub samples: usize,
}

impl CollapseFit {
    /// The fitted radius at t/T = `time_over_jeans`, R0.
    #[must_use]
    pub fn radius(&self, time_over_jeans: f64) -> f64 {
        let Self { delay, initial_radius, final_radius, .. } = self;
        collapse_fit(initial_radius.value, final_radius.value, delay.value, time_over_jeans)
    }
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CollapseFitError {
    /// Fewer samples than it takes to know the parameters and their errors.
    #[error(
        "{found} samples with 0 < t/T < {until} do not determine {parameters} parameters and their errors: give at least \
         {needed}, or hold a radius"
    )]
    TooFew {
        /// Number of samples in the range.
        found: usize,
        /// Number of samples needed.
        needed: usize,
        /// Number of parameters that are not held.
        parameters: usize,
        /// End of the range, t/T.
        until: f64,
    },
    /// A time or radius that is no finite number.
    #[error("the sample t/T = {time}, R = {radius} R0 is not made of finite numbers: leave it out")]
    Sample {
        /// t/T
        time: f64,
        /// R0
        radius: f64,
    },
    /// A held radius that is none.
    #[error("a radius of {radius} R0 was to be held: hold one of 0 or more")]
    Held {
        /// The radius, R0.
        radius: f64,
    },
    /// The samples do not bend as a collapse does.
    #[error("the samples do not determine a collapse: give more of its end, or hold a radius")]
    Undetermined,
}

/// Fits Eq. 30 to `samples`, (t/T, R in R0) in any order, under `conditions`.
///
/// # Errors
/// A [`CollapseFitError`]. At least one more sample is needed than parameters are free.
pub fn fit(samples: &[(f64, f64)], conditions: &Conditions) -> Result<CollapseFit, CollapseFitError> {
    let until = conditions.until;
    let held = [conditions.initial_radius, conditions.final_radius];
    if let Some(&radius) = held.iter().flatten().find(|radius| !(**radius >= 0.0 && radius.is_finite())) {
        return Err(CollapseFitError::Held { radius });
    }
    if let Some(&(time, radius)) = samples.iter().find(|(time, radius)| !(time + radius).is_finite()) {
        return Err(CollapseFitError::Sample { time, radius });
    }
    let samples: Vec<(f64, f64)> =
        samples.iter().filter(|(time, _)| *time > 0.0 && *time < until).copied().collect();
    let parameters = 1 + held.iter().filter(|radius| radius.is_none()).count();
    let (found, needed) = (samples.len(), parameters + 1);
    if found < needed {
        return Err(CollapseFitError::TooFew { found, needed, parameters, until });
    }
    let last = samples.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    let best = GUESSES
        .iter()
        .filter_map(|guess| minimum(Problem::new(&samples, held, guess * last)))
        .filter(|(problem, _)| problem.delay() > 0.0 && problem.delay() < FARTHEST * last)
        .min_by(|(_, first), (_, second)| first.total_cmp(second));
    let (problem, squares) = best.ok_or(CollapseFitError::Undetermined)?;
    let errors = problem.errors(squares).ok_or(CollapseFitError::Undetermined)?;
    let mut estimates = problem.parameters.iter().zip(errors.iter());
    let mut next = |held: Option<f64>| match held {
        Some(value) => Some(Estimate::exact(value)),
        None => estimates.next().map(|(&value, &error)| Estimate::new(value, error)),
    };
    let (delay, initial, last) = (next(None), next(held[0]), next(held[1]));
    let (Some(delay), Some(initial_radius), Some(final_radius)) = (delay, initial, last) else {
        return Err(CollapseFitError::Undetermined);
    };
    let residual = (squares / found as f64).sqrt();
    Ok(CollapseFit { delay, initial_radius, final_radius, residual, samples: found })
}

/// The problem at the minimum near its guess and the sum of squared residuals there; None where none is found.
fn minimum(problem: Problem<'_>) -> Option<(Problem<'_>, f64)> {
    let (problem, report) = LevenbergMarquardt::new().with_patience(1000).minimize(problem);
    let ended = report.termination.was_successful()
        // Made-up samples may leave nothing but rounding.
        || matches!(report.termination, TerminationReason::NoImprovementPossible(_));
    // The report has half the sum.
    let squares = 2.0 * report.objective_function;
    (ended && squares.is_finite()).then_some((problem, squares))
}

/// Samples and the parameters to be fitted: A0, then R_i and R_f as far as they are free.
#[derive(Clone)]
struct Problem<'samples> {
    samples: &'samples [(f64, f64)],
    /// R_i and R_f
    held: [Option<f64>; 2],
    parameters: DVector<f64>,
}

impl<'samples> Problem<'samples> {
    fn new(samples: &'samples [(f64, f64)], held: [Option<f64>; 2], delay: f64) -> Self {
        let largest = samples.iter().map(|(_, radius)| *radius).fold(0.0, f64::max);
        let [initial, last] = held.map(|radius| radius.is_none());
        let guesses = [(true, delay), (initial, largest), (last, 0.1 * largest)];
        let free = guesses.into_iter().filter(|(free, _)| *free).map(|(_, guess)| guess);
        Self { samples, held, parameters: DVector::from_vec(free.collect()) }
    }

    fn delay(&self) -> f64 {
        self.parameters.iter().next().copied().unwrap_or(f64::NAN)
    }

    /// R_i and R_f.
    fn radii(&self) -> [f64; 2] {
        let mut free = self.parameters.iter().skip(1);
        self.held.map(|held| held.or_else(|| free.next().copied()).unwrap_or(f64::NAN))
    }

    /// The standard errors of the parameters where the squared residuals sum to `squares`.
    fn errors(&self, squares: f64) -> Option<DVector<f64>> {
        let jacobian = self.jacobian()?;
        let inverse = (jacobian.transpose() * &jacobian).try_inverse()?;
        let freedom = self.samples.len().checked_sub(self.parameters.len())?;
        let errors = (inverse.diagonal() * (squares / freedom as f64)).map(f64::sqrt);
        errors.iter().all(|error| error.is_finite()).then_some(errors)
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, parameters: &DVector<f64>) {
        self.parameters.copy_from(parameters);
    }

    fn params(&self) -> DVector<f64> {
        self.parameters.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let ([initial, last], delay) = (self.radii(), self.delay());
        let residual = |&(time, radius): &(f64, f64)| collapse_fit(initial, last, delay, time) - radius;
        Some(DVector::from_iterator(self.samples.len(), self.samples.iter().map(residual)))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let ([initial, last], delay) = (self.radii(), self.delay());
        let [initial_is_free, last_is_free] = self.held.map(|radius| radius.is_none());
        let derivatives = self.samples.iter().flat_map(|&(time, _)| {
            let root = (1.0 - time / delay).max(0.0).sqrt();
            // Where the collapse has ended, the radius no longer depends on when.
            let slope = if root > 0.0 { time / (2.0 * delay * delay * root) } else { 0.0 };
            [(true, (initial - last) * slope), (initial_is_free, root), (last_is_free, 1.0 - root)]
        });
        let free: Vec<f64> =
            derivatives.filter(|(free, _)| *free).map(|(_, derivative)| derivative).collect();
        Some(DMatrix::from_row_slice(self.samples.len(), self.parameters.len(), &free))
    }
}
