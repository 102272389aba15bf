//! Axes of charts: what they say, how values lie on them, and from where to where they go.
//!
//! ```
//! use meniscus::figures::axis::{Axis, Scale};
//!
//! let axis = Axis::log("λ", "L");
//! assert_eq!((axis.title().as_str(), axis.scale), ("λ / L", Scale::Log));
//! assert_eq!(Axis::linear("ϕ", "").title(), "ϕ");
//! ```

use super::FigureError;

/// How values lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal lengths are equal differences.
    Linear,
    /// Equal lengths are equal ratios: only values above zero have a place.
    Log,
}

/// An axis of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What is drawn along it; `_c` and `_{ab}` are set lower, `^2` and `^{-2}` higher.
    pub label: String,
    /// In what it is measured, in the same notation; empty for pure numbers.
    pub unit: String,
    /// How values lie along it.
    pub scale: Scale,
    /// Its ends; without them it holds all points and their error bars, and a margin.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// An axis of equal differences that holds all points.
    #[must_use]
    pub fn linear(label: &str, unit: &str) -> Self {
        Self { label: label.to_owned(), unit: unit.to_owned(), scale: Scale::Linear, range: None }
    }

    /// An axis of equal ratios that holds all points above zero.
    #[must_use]
    pub fn log(label: &str, unit: &str) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label, unit) }
    }

    /// The same axis from `from` to `to`; what lies outside is not drawn.
    #[must_use]
    pub fn range(self, from: f64, to: f64) -> Self {
        Self { range: Some((from, to)), ..self }
    }

    /// What stands beside the axis: the label, and the unit after a stroke.
    #[must_use]
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} / {}", self.label, self.unit) }
    }

    /// Whether `value` has a place on an axis of this scale: numbers near the largest of f64 have none.
    pub(super) fn holds(&self, value: f64) -> bool {
        value.abs() <= LARGEST && (self.scale == Scale::Linear || value > 0.0)
    }

    /// The ends for `values`, those without a place left out.
    pub(super) fn ends(&self, values: impl Iterator<Item = f64>) -> Result<(f64, f64), FigureError> {
        if let Some((from, to)) = self.range {
            let sound = from < to && (to - from).is_finite() && self.holds(from) && self.holds(to);
            let refused = || FigureError::Range { label: self.label.clone(), from, to };
            return if sound { Ok((from, to)) } else { Err(refused()) };
        }
        let places = values.filter(|value| self.holds(*value)).map(|value| self.place(value));
        let (least, most) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let (low, high) = self.widened(least, most);
        Ok((self.value(low), self.value(high)))
    }

    /// Where a value lies, in its own measure or in decades.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => libm::log10(value),
        }
    }

    /// The value at a place.
    fn value(&self, place: f64) -> f64 {
        match self.scale {
            Scale::Linear => place,
            // Powers of ten that numbers in f64 can have.
            Scale::Log => libm::pow(10.0, place.clamp(-300.0, 300.0)),
        }
    }

    /// Places with a margin, and with an extent where there is none.
    fn widened(&self, least: f64, most: f64) -> (f64, f64) {
        if least > most {
            return (0.0, 1.0);
        }
        let largest = least.abs().max(most.abs());
        // An extent that f64 resolves by too few steps to be labelled counts as none.
        let margin = match most / 2.0 - least / 2.0 > LEAST_EXTENT * largest {
            true => MARGIN * (most - least),
            false if self.scale == Scale::Log => 0.5,
            false if largest > 0.0 => 0.1 * largest,
            false => 1.0,
        };
        (least - margin, most + margin)
    }
}

/// Room beyond the outermost points, of the extent.
const MARGIN: f64 = 0.04;

/// Half of the smallest extent, of the largest value, that is drawn as one.
const LEAST_EXTENT: f64 = 1e-9;

/// The largest value that has a place.
const LARGEST: f64 = 1e300;
