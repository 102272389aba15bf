//! The jackknife: the error of whatever is read off several measurements.

use super::Estimate;

/// What `read` makes of all of `count` independent measurements, given None, with the standard error that tells from
/// leaving out each in turn, given its number: √((n − 1)/n Σ(xᵢ − x̄)²), of n − 1 degrees of freedom.
///
/// None without measurements, or if nothing can be read of them all or of all but one. Of a single one the error is not
/// known.
#[must_use]
pub fn jackknife(count: usize, read: impl Fn(Option<usize>) -> Option<f64>) -> Option<Estimate> {
    if count == 0 {
        return None;
    }
    let value = read(None)?;
    if count == 1 {
        return Some(Estimate::single(value));
    }
    let parts: Vec<f64> = (0..count).map(|left_out| read(Some(left_out))).collect::<Option<_>>()?;
    let count = count as f64;
    let middle = parts.iter().sum::<f64>() / count;
    let scatter: f64 = parts.iter().map(|part| (part - middle) * (part - middle)).sum();
    Some(Estimate { value, error: (scatter * (count - 1.0) / count).sqrt(), degrees: count - 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum_without(values: &[f64], left_out: Option<usize>) -> f64 {
        values.iter().enumerate().filter(|(index, _)| Some(*index) != left_out).map(|(_, value)| value).sum()
    }

    #[test]
    fn the_error_of_a_square_is_that_of_the_mean_times_twice_it() {
        let values: Vec<f64> = (0..100).map(|k| 10.0 + 0.01 * f64::from(k)).collect();
        let square = |left_out: Option<usize>| {
            let mean = sum_without(&values, left_out) / (100.0 - f64::from(u8::from(left_out.is_some())));
            Some(mean * mean)
        };
        let estimate = jackknife(100, square).unwrap();
        // Evenly spaced: variance (n² − 1)/12 · spacing² · n/(n − 1), error of the mean its root over √n.
        let error = 0.01 * (9999.0_f64 / 12.0 / 99.0).sqrt();
        assert!((estimate.error / (2.0 * 10.495 * error) - 1.0).abs() < 1e-3, "{estimate}");
        assert_eq!(estimate.degrees, 99.0);
    }

    #[test]
    fn what_cannot_be_read_has_no_estimate() {
        let values = [1.0, 2.0, 3.0];
        let reached = |left_out| Some(sum_without(&values, left_out)).filter(|sum| *sum > 3.5);
        assert_eq!(jackknife(3, reached), None, "not without the last");
        assert_eq!(jackknife(0, |_| Some(1.0)), None);
        let one = jackknife(1, |_| Some(1.0)).unwrap();
        assert!(one.error.is_nan() && one.degrees == 0.0);
    }
}
