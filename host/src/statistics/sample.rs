//! Mean and standard error, one number after the other.

use super::Estimate;

/// Numbers summed in the order in which they come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    count: u64,
    sum: f64,
    /// Sum of the squared distances from the mean, by Welford's recurrence: nothing cancels.
    squares: f64,
}

impl Sample {
    /// Takes another number.
    pub fn add(&mut self, number: f64) {
        let before = self.mean().unwrap_or(number);
        self.count += 1;
        self.sum += number;
        self.squares += (number - before) * (number - self.sum / self.count as f64);
    }

    /// Their mean; None if there is none.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }

    /// Standard error of their mean, from their scatter; None if there are fewer than two.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        let count = self.count as f64;
        // Rounding may leave a square of less than nothing.
        (self.count > 1).then(|| (self.squares.max(0.0) / (count - 1.0) / count).sqrt())
    }

    /// Both, of one degree of freedom less than there are numbers; None if there are none.
    #[must_use]
    pub fn estimate(&self) -> Option<Estimate> {
        let value = self.mean()?;
        let several = |error| Estimate { value, error, degrees: self.count as f64 - 1.0 };
        Some(self.error().map_or(Estimate::single(value), several))
    }
}

impl FromIterator<f64> for Sample {
    fn from_iter<T: IntoIterator<Item = f64>>(numbers: T) -> Self {
        let mut sample = Self::default();
        numbers.into_iter().for_each(|number| sample.add(number));
        sample
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(numbers: &[f64]) -> Sample {
        numbers.iter().copied().collect()
    }

    #[test]
    fn known_samples_have_their_mean_and_error() {
        assert_eq!((sample(&[]).mean(), sample(&[]).error()), (None, None));
        assert_eq!((sample(&[3.0]).mean(), sample(&[3.0]).error()), (Some(3.0), None));
        assert_eq!((sample(&[1.0, 3.0]).mean(), sample(&[1.0, 3.0]).error()), (Some(2.0), Some(1.0)));
        // 2, 4, 4, 4, 5, 5, 7, 9: the sum of squared distances is 32.
        let eight = sample(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert_eq!(eight.mean(), Some(5.0));
        assert!((eight.error().unwrap() - (32.0_f64 / 7.0 / 8.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn an_estimate_knows_its_degrees_of_freedom() {
        assert_eq!(sample(&[]).estimate(), None);
        let one = sample(&[3.0]).estimate().unwrap();
        assert!(one.value == 3.0 && one.error.is_nan() && one.degrees == 0.0);
        let two = sample(&[1.0, 3.0]).estimate().unwrap();
        assert_eq!(two, Estimate { value: 2.0, error: 1.0, degrees: 1.0 });
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let offset = sample(&[1e9 + 1.0, 1e9 + 3.0, 1e9 + 5.0]);
        assert_eq!(offset.mean(), Some(1e9 + 3.0));
        assert!((offset.error().unwrap() - (4.0_f64 / 3.0).sqrt()).abs() < 1e-7);
        assert_eq!(sample(&[0.1; 10]).error().unwrap().max(1e-16), 1e-16);
    }
}
