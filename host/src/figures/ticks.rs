//! Where axes have ticks, and what stands at them.

use super::axis::{Axis, Scale};
use super::lettering::MINUS;

/// The ticks of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ticks {
    /// Values, and what stands at them.
    pub(super) labelled: Vec<(f64, String)>,
    /// Values between them.
    pub(super) small: Vec<f64>,
    /// The power of ten by which all labels are to be multiplied, if not 1; stands at the end of the axis.
    pub(super) factor: String,
}

/// Decades from which on only powers of ten are labelled.
const MANY_DECADES: f64 = 1.7;

/// Decades below which an axis has the ticks of equal differences.
const FEW_DECADES: f64 = 0.5;

/// How far beyond an end a tick may lie by rounding, of the distance of ticks.
const SLACK: f64 = 1e-6;

impl Ticks {
    /// About `wanted` ticks between the ends of an axis.
    pub(super) fn new(axis: &Axis, (from, to): (f64, f64), wanted: f64) -> Self {
        let decades = if axis.scale == Scale::Log { libm::log10(to) - libm::log10(from) } else { 0.0 };
        if decades > MANY_DECADES {
            Self::powers(from, to, wanted)
        } else if decades > FEW_DECADES {
            Self::multiples(from, to)
        } else {
            Self::differences(from, to, wanted)
        }
    }

    /// Multiples of 1, 2, 5 times a power of ten.
    fn differences(from: f64, to: f64, wanted: f64) -> Self {
        let step = step((to - from) / wanted);
        if !step.is_normal() {
            return Self::default();
        }
        let largest = libm::floor(libm::log10(from.abs().max(to.abs())));
        let power = if (-2.0..5.0).contains(&largest) { 0 } else { largest as i32 };
        let digits = (f64::from(power) - libm::floor(libm::log10(step) + SLACK)).clamp(0.0, 15.0) as usize;
        let unit = libm::pow(10.0, f64::from(power));
        let label = |number: f64| format!("{:.digits$}", number * step / unit + 0.0).replace('-', MINUS);
        // Parts of a step as round as the step.
        let parts = if digits_of(step) == 2 { 4.0 } else { 5.0 };
        let between = numbers(from / step * parts, to / step * parts).filter(|number| number % parts != 0.0);
        Self {
            labelled: numbers(from / step, to / step).map(|number| (number * step, label(number))).collect(),
            small: between.map(|number| number * step / parts).collect(),
            factor: if power == 0 { String::new() } else { format!("×{}", ten(power)) },
        }
    }

    /// Powers of ten, as many of them labelled as there is room for.
    fn powers(from: f64, to: f64, wanted: f64) -> Self {
        let ends = (libm::log10(from), libm::log10(to));
        let stride = libm::ceil((ends.1 - ends.0) / (wanted + 1.0)).max(1.0) as i32;
        let exponents = || numbers(ends.0, ends.1).map(|exponent| exponent as i32);
        let labelled = exponents().filter(|exponent| exponent.rem_euclid(stride) == 0);
        let small: Vec<f64> = match stride {
            1 => numbers(ends.0 - 1.0, ends.1)
                .flat_map(|exponent| (2..10).map(move |digit| f64::from(digit) * libm::pow(10.0, exponent)))
                .filter(|value| (from..=to).contains(value))
                .collect(),
            _ => exponents()
                .filter(|power| power.rem_euclid(stride) != 0)
                .map(|power| libm::pow(10.0, f64::from(power)))
                .collect(),
        };
        Self {
            labelled: labelled.map(|power| (libm::pow(10.0, f64::from(power)), ten(power))).collect(),
            small,
            factor: String::new(),
        }
    }

    /// 1, 2 and 5 times powers of ten labelled, the other multiples small.
    fn multiples(from: f64, to: f64) -> Self {
        let mut ticks = Self::default();
        let first = libm::floor(libm::log10(from)) as i32;
        let plain = from >= 1e-3 && to < 1e5;
        for power in first..=first + 2 {
            for digit in 1..10 {
                let value = f64::from(digit) * libm::pow(10.0, f64::from(power));
                if !(from * (1.0 - SLACK)..=to * (1.0 + SLACK)).contains(&value) {
                } else if [1, 2, 5].contains(&digit) {
                    ticks.labelled.push((value, multiple(digit, power, plain)));
                } else {
                    ticks.small.push(value);
                }
            }
        }
        ticks
    }
}

/// Whole numbers from `from` to `to`.
fn numbers(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let (first, last) = (libm::ceil(from - SLACK), libm::floor(to + SLACK));
    let count = (last - first).clamp(-1.0, 1000.0) as i32;
    (0..=count).map(move |number| first + f64::from(number))
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
pub(crate) fn step(least: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(least)));
    [1.0, 2.0, 5.0].iter().map(|factor| factor * decade).find(|step| *step >= least).unwrap_or(10.0 * decade)
}

/// The first digit of 1, 2 or 5 times a power of ten.
fn digits_of(step: f64) -> i32 {
    libm::round(step / libm::pow(10.0, libm::floor(libm::log10(step) + SLACK))) as i32
}

/// A power of ten.
fn ten(power: i32) -> String {
    format!("10^{{{}}}", power.to_string().replace('-', MINUS))
}

/// A digit times a power of ten, which is written out if the axis is `plain`.
fn multiple(digit: i32, power: i32, plain: bool) -> String {
    match power {
        0.. if plain => format!("{digit}{}", "0".repeat(power as usize)),
        _ if plain => format!("0.{}{digit}", "0".repeat((-1 - power) as usize)),
        _ if digit == 1 => ten(power),
        _ => format!("{digit}×{}", ten(power)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, from: f64, to: f64) -> Vec<String> {
        Ticks::new(axis, (from, to), 5.0).labelled.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_few_and_round() {
        let linear = Axis::linear("", "");
        assert_eq!(labels(&linear, 0.0, 5.0), ["0", "1", "2", "3", "4", "5"]);
        assert_eq!(labels(&linear, -0.1, 0.1), ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
        assert_eq!(labels(&linear, 0.0, 3e-4), ["0", "1", "2", "3"]);
        assert_eq!(Ticks::new(&linear, (0.0, 3e-4), 5.0).factor, "×10^{−4}");
        assert!(labels(&linear, 1.0, 1.0 + f64::EPSILON).len() < 10);
        assert!(labels(&linear, 0.0, 5e-324).is_empty());
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten() {
        let log = Axis::log("", "");
        assert_eq!(labels(&log, 0.01, 100.0), ["10^{−2}", "10^{−1}", "10^{0}", "10^{1}", "10^{2}"]);
        assert_eq!(
            labels(&log, 1e-12, 1e12),
            ["10^{−12}", "10^{−8}", "10^{−4}", "10^{0}", "10^{4}", "10^{8}", "10^{12}"]
        );
        assert_eq!(labels(&log, 0.09, 2.1), ["0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(labels(&log, 1.0, 2.0), ["1.0", "1.2", "1.4", "1.6", "1.8", "2.0"]);
    }
}
