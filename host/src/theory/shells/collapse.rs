//! Shells on their way inwards, those that have met as one.

use super::Shell;
use super::runge_kutta::dormand_prince;
use crate::theory::EvolutionError;
use crate::theory::attraction::Attraction;

/// Estimated error of a step, of the largest R² at the start.
const TOLERANCE: f64 = 1e-11;
/// By how much, of the largest R², one shell may have passed another before the two are joined.
const OVERLAP: f64 = 1e-8;
/// A step is shortened and lengthened by no more than these at a time.
const SHORTEN: f64 = 0.2;
const LENGTHEN: f64 = 4.0;

/// The state of a collapse.
#[derive(Clone, Debug)]
pub(super) struct Collapse<'a> {
    attraction: &'a Attraction,
    time: f64,
    /// The step to try next, R0²/D; infinite for none yet.
    step: f64,
    /// The largest R² at the start, R0².
    scale: f64,
    /// R² of the groups of joined shells from the inside outwards, R0².
    squares: Vec<f64>,
    /// Discs of each.
    discs: Vec<f64>,
    /// The group of each shell.
    groups: Vec<usize>,
}

impl<'a> Collapse<'a> {
    pub(super) fn new(shells: &[Shell], attraction: &'a Attraction) -> Self {
        let mut order: Vec<usize> = (0..shells.len()).collect();
        order.sort_by(|&one, &other| shells[one].radius.total_cmp(&shells[other].radius));
        let mut groups = vec![0; shells.len()];
        let (mut squares, mut discs) = (Vec::<f64>::new(), Vec::new());
        for index in order {
            let Shell { radius, discs: number } = shells[index];
            match squares.last() {
                Some(&square) if square == radius * radius => *discs.last_mut().unwrap_or(&mut 0.0) += number,
                _ => {
                    squares.push(radius * radius);
                    discs.push(number);
                }
            }
            groups[index] = squares.len() - 1;
        }
        let scale = squares.last().copied().unwrap_or(0.0);
        Self { attraction, time: 0.0, step: f64::INFINITY, scale, squares, discs, groups }
    }

    /// R0²/D
    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// The group that the shell `index` belongs to.
    pub(super) fn group_of(&self, index: usize) -> usize {
        self.groups[index]
    }

    /// The radius of the shell `index`, R0.
    pub(super) fn radius(&self, index: usize) -> f64 {
        self.squares[self.groups[index]].sqrt()
    }

    /// d(R²)/dt of each group, D.
    pub(super) fn rates(&self) -> Vec<f64> {
        let mut rates = Vec::new();
        self.attraction.rates(&self.squares, &self.discs, &mut rates);
        rates
    }

    /// Goes on to `until` (R0²/D), which is not before now.
    pub(super) fn advance_to(&mut self, until: f64) -> Result<(), EvolutionError> {
        while self.time < until && self.squares.iter().any(|&square| square > 0.0) {
            let left = until - self.time;
            let step = if self.step.is_finite() { self.step } else { self.first_step() }.min(left);
            if self.time + step <= self.time {
                return Err(EvolutionError::Stalled { time: self.time });
            }
            let rates =
                |squares: &[f64], into: &mut Vec<f64>| self.attraction.rates(squares, &self.discs, into);
            let (next, error) = dormand_prince(&self.squares, step, rates);
            let within = TOLERANCE * self.scale / error.max(f64::MIN_POSITIVE);
            let factor = (0.9 * libm::pow(within, 0.2)).clamp(SHORTEN, LENGTHEN);
            if error > TOLERANCE * self.scale {
                self.step = step * factor;
                continue;
            }
            if overlap(&next) > OVERLAP * self.scale {
                self.step = 0.5 * step;
                continue;
            }
            self.step = if step < left { step * factor } else { self.step.max(step * factor) };
            self.time = if step < left { self.time + step } else { until };
            self.squares = next.into_iter().map(|square| square.max(0.0)).collect();
            self.join();
        }
        self.time = until;
        Ok(())
    }

    /// A time in which squares change by a tenth of the largest, R0²/D.
    fn first_step(&self) -> f64 {
        let fastest = self.rates().into_iter().map(f64::abs).fold(0.0, f64::max);
        if fastest > 0.0 { 0.1 * self.scale / fastest } else { f64::INFINITY }
    }

    /// Joins neighbouring groups that have met, at the mean of their squares over discs: to first order in
    /// the overlap, that is where they had come together.
    fn join(&mut self) {
        let mut inner = 0;
        while inner + 1 < self.squares.len() {
            if self.squares[inner] < self.squares[inner + 1] || self.squares[inner + 1] == 0.0 {
                inner += 1;
                continue;
            }
            let (square, discs) = (self.squares.remove(inner + 1), self.discs.remove(inner + 1));
            let sum = self.discs[inner] + discs;
            self.squares[inner] = (self.discs[inner] * self.squares[inner] + discs * square) / sum;
            self.discs[inner] = sum;
            self.groups.iter_mut().filter(|group| **group > inner).for_each(|group| *group -= 1);
            // A joined group may reach the one within.
            inner = inner.saturating_sub(1);
        }
    }
}

/// By how much a square exceeds the next one, at most, R0²; those below 0 are 0.
fn overlap(squares: &[f64]) -> f64 {
    let excess = |pair: &[f64]| pair[0].max(0.0) - pair[1].max(0.0);
    squares.windows(2).map(excess).fold(0.0, f64::max)
}
