//! The same quantity in several runs, bin by bin of time.

use crate::statistics::{Estimate, Sample, jackknife};
use std::collections::BTreeMap;

/// A mean curve: time and value.
pub type Curve = Vec<(f64, f64)>;

/// What a run has in one bin of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Which bin: rows of the same one belong together, whenever within it each run came to make a step.
    pub bin: u64,
    /// When, T.
    pub time: f64,
    /// The value, if there is one.
    pub value: Option<f64>,
}

/// A quantity in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The seed, which no other run of the quantity has.
    pub seed: u64,
    /// Its rows, one a bin.
    pub rows: Vec<Row>,
}

/// The same quantity in several runs, bin by bin.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Mean time of each bin, T.
    times: BTreeMap<u64, f64>,
    /// Seed and the value in each bin.
    runs: Vec<(u64, BTreeMap<u64, f64>)>,
}

impl Curves {
    /// Of `runs`, whose rows belong together by their bins: one that a run lacks is missing there and nowhere else.
    #[must_use]
    pub fn new(runs: &[Run]) -> Self {
        let mut times: BTreeMap<u64, Sample> = BTreeMap::new();
        for row in runs.iter().flat_map(|run| &run.rows) {
            times.entry(row.bin).or_default().add(row.time);
        }
        let values = |run: &Run| run.rows.iter().filter_map(|row| Some((row.bin, row.value?))).collect();
        Self {
            times: times.into_iter().filter_map(|(bin, times)| Some((bin, times.mean()?))).collect(),
            runs: runs.iter().map(|run| (run.seed, values(run))).collect(),
        }
    }

    /// The same, zeros counting as missing: a mean over clusters is 0 where there is none.
    #[must_use]
    pub fn without_zeros(mut self) -> Self {
        for (_, values) in &mut self.runs {
            values.retain(|_, value| *value != 0.0);
        }
        self
    }

    /// Mean and standard error over runs per bin in which any run has a value.
    #[must_use]
    pub fn means(&self) -> Vec<(f64, Estimate)> {
        let all: Vec<u64> = self.seeds().collect();
        self.samples(&all).filter_map(|(time, sample)| Some((time, sample.estimate()?))).collect()
    }

    /// What `read` makes of the mean curve, with the error of leaving out one run at a time, of one degree of freedom less
    /// than there are runs: unknown of a single one. None if nothing is read of the whole or of a part.
    #[must_use]
    pub fn jackknife(&self, read: impl Fn(&Curve) -> Option<f64>) -> Option<Estimate> {
        Self::jackknife_of([self], |[curve]| read(curve))
    }

    /// As [`Curves::jackknife`] of several quantities, of the same runs or of others that share their seeds: from the runs
    /// whose seeds all quantities have, those of a seed being left out together. So the error knows how what they share,
    /// as their start, shifts all of them at once. None without such a seed.
    #[must_use]
    pub fn jackknife_of<const COUNT: usize>(
        quantities: [&Self; COUNT],
        read: impl Fn(&[Curve; COUNT]) -> Option<f64>,
    ) -> Option<Estimate> {
        let shared = |seed: &u64| quantities.iter().all(|curves| curves.seeds().any(|other| other == *seed));
        let seeds: Vec<u64> = quantities.first()?.seeds().filter(shared).collect();
        jackknife(seeds.len(), |left_out| {
            let kept = seeds.iter().enumerate().filter(|(index, _)| Some(*index) != left_out);
            let kept: Vec<u64> = kept.map(|(_, seed)| *seed).collect();
            read(&quantities.map(|curves| curves.mean_of(&kept)))
        })
    }

    fn seeds(&self) -> impl Iterator<Item = u64> {
        self.runs.iter().map(|(seed, _)| *seed)
    }

    /// The mean curve of the runs with these seeds.
    fn mean_of(&self, seeds: &[u64]) -> Curve {
        self.samples(seeds).filter_map(|(time, sample)| Some((time, sample.mean()?))).collect()
    }

    /// Time and values per bin of the runs with these seeds.
    fn samples(&self, seeds: &[u64]) -> impl Iterator<Item = (f64, Sample)> {
        self.times.iter().map(move |(bin, time)| {
            let kept = self.runs.iter().filter(|(seed, _)| seeds.contains(seed));
            (*time, kept.filter_map(|(_, values)| values.get(bin).copied()).collect())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs with these seeds, in bins 0, 1, 2 and so on at the times 0, 1, 2.
    fn curves(runs: &[(u64, &[Option<f64>])]) -> Curves {
        let row = |(bin, value): (u64, &Option<f64>)| Row { bin, time: bin as f64, value: *value };
        let run = |(seed, values): &(u64, &[Option<f64>])| Run {
            seed: *seed,
            rows: (0..).zip(*values).map(row).collect(),
        };
        Curves::new(&runs.iter().map(run).collect::<Vec<_>>())
    }

    /// One value of each seed.
    fn values(runs: &[(u64, f64)]) -> Curves {
        let runs = runs.iter().map(|(seed, value)| Run {
            seed: *seed,
            rows: vec![Row { bin: 0, time: 0.0, value: Some(*value) }],
        });
        Curves::new(&runs.collect::<Vec<_>>())
    }

    fn first(curve: &Curve) -> Option<f64> {
        curve.first().map(|point| point.1)
    }

    /// The quotient of two quantities.
    fn quotient([above, below]: &[Curve; 2]) -> Option<f64> {
        Some(first(above)? / first(below)?)
    }

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let runs = [(1, 1.0), (2, 2.0), (3, 4.0), (4, 9.0)];
        let jackknife = values(&runs).jackknife(first).unwrap();
        let direct = runs.iter().map(|(_, value)| *value).collect::<Sample>().estimate().unwrap();
        assert!((jackknife.value - direct.value).abs() < 1e-12);
        assert!((jackknife.error - direct.error).abs() < 1e-12);
        assert_eq!((jackknife.degrees, direct.degrees), (3.0, 3.0));
    }

    #[test]
    fn of_a_single_run_no_error_is_known() {
        let one = values(&[(1, 3.0)]).jackknife(first).unwrap();
        assert!(one.value == 3.0 && one.error.is_nan() && one.degrees == 0.0);
        assert_eq!(values(&[]).jackknife(first), None);
    }

    #[test]
    fn bins_without_a_value_are_left_out() {
        let curves = curves(&[(1, &[Some(1.0), None]), (2, &[Some(3.0), None, Some(2.0)])]);
        let means = curves.means();
        assert_eq!(means.len(), 2);
        assert_eq!((means[0].1.value, means[1].0), (2.0, 2.0));
        let zeros = [(1, &[Some(0.0), Some(2.0)][..]), (2, &[Some(3.0), Some(0.0)])];
        let means = super::tests::curves(&zeros).without_zeros().means();
        assert_eq!((means[0].1.value, means[1].1.value), (3.0, 2.0));
    }

    #[test]
    fn a_row_that_is_missing_shifts_no_other() {
        let rows = |bins: &[u64]| {
            let row = |bin: &u64| Row { bin: *bin, time: *bin as f64, value: Some(10.0 * *bin as f64) };
            bins.iter().map(row).collect()
        };
        let runs = [Run { seed: 1, rows: rows(&[0, 1, 2, 3]) }, Run { seed: 2, rows: rows(&[0, 2, 3]) }];
        for (time, mean) in Curves::new(&runs).means() {
            assert_eq!(mean.value, 10.0 * time);
        }
    }

    /// What both have from their start, 1 to 9, is far more than what they differ by.
    #[test]
    fn runs_that_share_their_seeds_are_left_out_together() {
        let below = [(1, 1.0), (2, 4.0), (3, 5.0), (4, 9.0)];
        let twice = below.map(|(seed, value)| (seed, 2.0 * value));
        let paired = Curves::jackknife_of([&values(&twice), &values(&below)], quotient).unwrap();
        assert!((paired.value - 2.0).abs() < 1e-12 && paired.error < 1e-12, "{paired}");
        // In whatever order they come.
        let mut shuffled = twice;
        shuffled.reverse();
        assert_eq!(Curves::jackknife_of([&values(&shuffled), &values(&below)], quotient), Some(paired));
        // Had they other seeds, the quotient would be uncertain by this.
        let relative = values(&below).jackknife(first).map(|mean| mean.error / mean.value).unwrap();
        assert!(2.0 * relative * core::f64::consts::SQRT_2 > 0.9);
    }

    /// (x̄ − ȳ) of pairs has the standard error of the mean of their differences.
    #[test]
    fn the_error_of_a_difference_is_that_of_paired_values() {
        let [first_runs, second_runs] =
            [[(1, 3.0), (2, 5.0), (3, 10.0)], [(3, 8.5), (1, 2.0), (2, 4.5)]].map(|runs| values(&runs));
        let difference = |[one, other]: &[Curve; 2]| Some(first(one)? - first(other)?);
        let found = Curves::jackknife_of([&first_runs, &second_runs], difference).unwrap();
        let expected = [1.0, 0.5, 1.5].into_iter().collect::<Sample>().estimate().unwrap();
        assert!((found.value - expected.value).abs() < 1e-12 && (found.error - expected.error).abs() < 1e-12);
        assert_eq!(found.degrees, 2.0);
    }

    #[test]
    fn runs_whose_seeds_others_lack_do_not_count() {
        let above = values(&[(1, 2.0), (2, 4.0), (7, 1000.0)]);
        let below = values(&[(2, 2.0), (1, 1.0), (9, -5.0)]);
        let found = Curves::jackknife_of([&above, &below], quotient).unwrap();
        assert_eq!((found.value, found.degrees), (2.0, 1.0));
        assert_eq!(Curves::jackknife_of([&above, &values(&[(3, 1.0)])], quotient), None);
    }
}
