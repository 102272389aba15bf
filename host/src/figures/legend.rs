//! Legends: which series they show, and how they are laid out.

use super::FigureError;
use super::canvas::{Canvas, Lettering};
use super::chart::{Chart, Series};
use super::clip::Rectangle;
use super::lettering;
use super::marks::{self, SAMPLE};
use super::palette::BLACK;
use plotters::style::text_anchor::HPos;

/// Size of a legend's letters, pixels.
const EM: f64 = 12.0;
/// From the middle of a row to that of the next, pixels.
const ROW: f64 = 19.0;
/// Between a sample and its text, pixels.
const GAP: f64 = 8.0;
/// Between entries side by side, pixels.
const BETWEEN: f64 = 22.0;

/// The entries of a legend, in columns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entries {
    series: Vec<Series>,
    columns: usize,
}

/// What tells a series from others.
fn looks_alike(one: &Series, other: &Series) -> bool {
    one.colour == other.colour && one.style == other.style
}

impl Entries {
    /// What the legend of `charts` shows: every labelled series once.
    pub(super) fn of<'a>(charts: impl Iterator<Item = &'a Chart>) -> Self {
        let mut series: Vec<Series> = Vec::new();
        for one in charts.flat_map(|chart| &chart.series).filter(|one| !one.label.is_empty()) {
            if !series.iter().any(|known| known.label == one.label && looks_alike(known, one)) {
                series.push(Series { points: Vec::new(), ..one.clone() });
            }
        }
        Self { series, columns: 1 }
    }

    /// Whether every look means one thing, and every label has one look.
    pub(super) fn clear(&self) -> bool {
        self.series.iter().enumerate().all(|(number, one)| {
            let mut others = self.series.iter().skip(number + 1);
            others.all(|other| one.label != other.label && !looks_alike(one, other))
        })
    }

    pub(super) fn len(&self) -> usize {
        self.series.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.series.is_empty()
    }

    /// In as many columns as fit into `width` pixels.
    pub(super) fn spread(mut self, width: f64) -> Self {
        let most = self.series.len().max(1);
        self.columns =
            (1..=most).rev().find(|columns| *columns as f64 * self.column() - BETWEEN <= width).unwrap_or(1);
        self
    }

    /// Width and height, pixels.
    pub(super) fn size(&self) -> (f64, f64) {
        if self.is_empty() {
            return (0.0, 0.0);
        }
        let rows = self.series.len().div_ceil(self.columns);
        (self.columns as f64 * self.column() - BETWEEN, rows as f64 * ROW)
    }

    /// Width of a column and the room after it, pixels.
    fn column(&self) -> f64 {
        let widest = self.series.iter().map(|series| lettering::width(&series.label, EM)).fold(0.0, f64::max);
        SAMPLE + GAP + widest + BETWEEN
    }

    /// Draws the legend into its box, row by row.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, area: Rectangle) -> Result<(), FigureError> {
        for (number, series) in self.series.iter().enumerate() {
            let (row, column) = (number / self.columns, number % self.columns);
            let left = area.left + column as f64 * self.column();
            let middle = area.top + (row as f64 + 0.5) * ROW;
            marks::sample(canvas, series, (left, middle))?;
            let style = Lettering { ink: BLACK, em: EM, side: HPos::Left, upright: false };
            canvas.text(&series.label, (left + SAMPLE + GAP, middle + 0.36 * EM), style)?;
        }
        Ok(())
    }
}
