//! Moments and correlations of samples, in units of their standard errors.
//!
//! A z-score is the deviation from the expected value over the standard error that independent samples would have.

/// The sample mean.
pub fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}

/// The mean of a power of the samples about an expected mean of zero.
fn moment(samples: &[f64], power: impl Fn(f64) -> f64) -> f64 {
    samples.iter().map(|&sample| power(sample)).sum::<f64>() / samples.len() as f64
}

/// z-score of the mean of samples that should have mean zero and `variance`.
pub fn mean_score(samples: &[f64], variance: f64) -> f64 {
    mean(samples) / (variance / samples.len() as f64).sqrt()
}

/// z-score of the second moment of samples that should have mean zero, `variance` and `kurtosis`
/// ⟨x⁴⟩/⟨x²⟩² (9/5 if uniform, 3 if Gaussian).
pub fn variance_score(samples: &[f64], variance: f64, kurtosis: f64) -> f64 {
    let error = variance * ((kurtosis - 1.0) / samples.len() as f64).sqrt();
    (moment(samples, |x| x * x) - variance) / error
}

/// z-score of the fourth moment of Gaussian samples of mean zero and `variance`: expected 3σ⁴, and as
/// ⟨x⁸⟩ = 105σ⁸ its variance is 96σ⁸ a sample.
pub fn gaussian_fourth_moment_score(samples: &[f64], variance: f64) -> f64 {
    let square = variance * variance;
    (moment(samples, |x| x * x * x * x) - 3.0 * square) / (square * (96.0 / samples.len() as f64).sqrt())
}

/// z-score of the mean product of two series that should be independent, with mean zero and `variance` each.
///
/// # Panics
/// If the series differ in length.
pub fn correlation_score(first: &[f64], second: &[f64], variance: f64) -> f64 {
    assert_eq!(first.len(), second.len(), "only series of one length can be correlated");
    let product: f64 = first.iter().zip(second).map(|(a, b)| a * b).sum();
    product / (variance * (first.len() as f64).sqrt())
}

/// z-score of the correlation of a series with itself `lag` samples later.
pub fn lag_score(samples: &[f64], lag: usize, variance: f64) -> f64 {
    correlation_score(&samples[lag..], &samples[..samples.len() - lag], variance)
}

/// Mean of independent estimates and its standard error from their scatter.
pub fn mean_and_error(estimates: &[f64]) -> (f64, f64) {
    let centre = mean(estimates);
    let scatter = estimates.iter().map(|x| (x - centre) * (x - centre)).sum::<f64>();
    let count = estimates.len() as f64;
    (centre, (scatter / (count * (count - 1.0))).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_of_a_known_sample() {
        let samples = [1.0, -1.0, 1.0, 1.0];
        assert_eq!(mean(&samples), 0.5);
        assert_eq!(mean_score(&samples, 1.0), 1.0);
        assert_eq!(variance_score(&samples, 0.5, 5.0), 1.0);
        assert_eq!(correlation_score(&samples, &samples, 1.0), 2.0);
        assert_eq!(lag_score(&samples, 2, 1.0), 0.0);
        assert_eq!(mean_and_error(&[1.0, 3.0]), (2.0, 1.0));
    }

    #[test]
    fn a_wrong_variance_scores_high() {
        let samples: Vec<f64> = (0..10_000).map(|k| f64::from(k % 101) / 50.0 - 1.0).collect();
        assert!(variance_score(&samples, 0.34, 1.8).abs() < 5.0);
        assert!(variance_score(&samples, 0.30, 1.8) > 5.0);
    }
}
