//! What each figure of the paper is made of: finished runs in, drawings and findings out.
//!
//! A builder takes what [`Evidence`] there is. Where runs are missing, curves and findings are.

pub mod clusters;
pub mod collapse;
pub mod energy;
pub mod forces;
pub mod meshes;
pub mod modes;
pub mod morphology;
pub mod snapshots;
pub mod text;

use super::campaign::{REACHES, Reach};
use super::evidence::{Evidence, FinishedRun, curves};
use super::finding::Finding;
use super::statistics::Curves;
use super::{Picture, ReproduceError};
use crate::figures::axis::Axis;
use crate::figures::chart::{Colour, Dash, Marker, Series as Drawn, Style};
use crate::figures::{Figure, FigureError, Panel};
use crate::observables::series::Series;

/// What a builder makes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Built {
    /// The figures.
    pub pictures: Vec<Picture>,
    /// The comparisons.
    pub findings: Vec<Finding>,
    /// What else is to be said.
    pub notes: Vec<String>,
}

impl Built {
    /// Adds a figure, unless nothing is to be seen in it.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn draw(&mut self, stem: &str, caption: &str, figure: &Figure) -> Result<(), FigureError> {
        let is_seen = |panel: &Panel| match panel {
            Panel::Chart(chart) => chart.series.iter().any(|series| !series.points.is_empty()),
            Panel::Discs(_) => true,
        };
        if figure.panels.iter().any(is_seen) {
            let svg = figure.svg()?;
            self.pictures.push(Picture { stem: stem.to_owned(), caption: caption.to_owned(), svg });
        }
        Ok(())
    }
}

/// The axis of times.
pub(super) fn time_axis() -> Axis {
    Axis::linear("t", "T")
}

/// A capillary length of Figs. 3 to 11 with its look.
pub(super) struct Look {
    pub reach: Reach,
    pub colour: Colour,
    pub style: Style,
}

/// The capillary lengths that the paper shows as short-ranged, or as long-ranged.
pub(super) fn looks(short: bool) -> Vec<Look> {
    let reaches: Vec<Reach> = REACHES.into_iter().filter(|reach| reach.short == short).collect();
    let count = reaches.len();
    let look = |(index, reach)| Look {
        reach,
        colour: Colour::ordered(index, count),
        style: Style::Band(Dash::numbered(index)),
    };
    reaches.into_iter().enumerate().map(look).collect()
}

/// Curves as a series with error bands, every value divided by `unit`.
pub(super) fn drawn(label: &str, colour: Colour, style: Style, curves: &Curves, unit: f64) -> Drawn {
    let points = curves.means().into_iter().map(|(time, mean)| {
        let error = mean.error / unit;
        (time, mean.value / unit, error.is_finite().then_some(error))
    });
    Drawn::styled(label, colour, style, points)
}

/// A column of Figs. 5 to 11 at a capillary length; None without finished runs.
pub(super) fn of_reach(
    evidence: &Evidence,
    reach: &Reach,
    series: Series,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Option<Curves>, ReproduceError> {
    let runs = evidence.reach(reach);
    if runs.is_empty() { Ok(None) } else { curves(&runs, series, column, key).map(Some) }
}

/// The number of discs of the first of `runs`; 1 if there is none.
pub(super) fn discs(runs: &[&FinishedRun]) -> f64 {
    runs.first().map_or(1.0, |run| run.configuration.system.particles as f64)
}

/// A marker for what comes n-th.
pub(super) fn marker(number: usize) -> Marker {
    Marker::numbered(number)
}
