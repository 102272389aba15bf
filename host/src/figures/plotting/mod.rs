//! A chart in its plotting area: axes, ticks and series.

mod axes;
mod notes;
mod series;

use super::FigureError;
use super::axis::Axis;
use super::canvas::{Canvas, Pen, Place};
use super::chart::{Chart, Point};
use super::clip::Rectangle;
use super::lettering;
use super::palette::BLACK;
use super::ticks::Ticks;
use notes::{notes, wrapped};

/// Size of the letters at ticks, pixels.
const EM: f64 = 12.0;
/// Height of a line of notes, pixels.
const NOTE_LINE: f64 = 14.0;
/// Between the plotting area and the labels of its ticks, pixels.
const GAP: f64 = 6.0;
/// Room for the title of an axis, pixels.
const TITLE_ROOM: f64 = 24.0;
/// Thickness of the frame, pixels.
const FRAME: f64 = 1.2;
/// Distance of ticks that is wanted, of x and y, pixels.
const DISTANCES: (f64, f64) = (58.0, 42.0);

/// Where what is far outside of the plotting area is taken to be, widths or heights from it.
const FARTHEST: f64 = 1e4;

/// From where to where an axis goes.
pub(super) type Ends = (f64, f64);

/// A chart whose axes are fixed.
pub(super) struct Plot<'a> {
    chart: &'a Chart,
    ends: (Ends, Ends),
    ticks: (Ticks, Ticks),
    /// Lines of notes.
    notes: Vec<String>,
    /// Whether the ticks of x, and those of y, have labels and the axis a title.
    said: (bool, bool),
}

/// The ends of x that hold all points of `charts`; the scale is that of the first.
pub(super) fn ends_of_x(charts: &[&Chart]) -> Result<Option<Ends>, FigureError> {
    let xs = || charts.iter().flat_map(|chart| drawn(chart)).map(|point| point.x);
    charts.first().map(|chart| chart.x.ends(xs())).transpose()
}

/// The ends of y that hold all points of `charts` and their error bars.
pub(super) fn ends_of_y(charts: &[&Chart]) -> Result<Option<Ends>, FigureError> {
    let ys = || charts.iter().flat_map(|chart| drawn(chart)).flat_map(|point| extent(&point));
    charts.first().map(|chart| chart.y.ends(ys())).transpose()
}

/// The points of a chart that have a place on its axes, those outside of their ranges too.
fn drawn(chart: &Chart) -> impl Iterator<Item = Point> {
    let all = chart.series.iter().flat_map(|series| &series.points);
    all.filter(|point| has_place(chart, point)).copied()
}

fn has_place(chart: &Chart, point: &Point) -> bool {
    chart.x.holds(point.x) && chart.y.holds(point.y)
}

/// A value and the ends of its error bar.
fn extent(point: &Point) -> [f64; 3] {
    let error = point.error.filter(|error| error.is_finite()).unwrap_or(0.0);
    [point.y - error, point.y, point.y + error]
}

impl<'a> Plot<'a> {
    /// A chart in a plotting area of that size, with the given ends of its axes or its own.
    pub(super) fn new(
        chart: &'a Chart,
        size: (f64, f64),
        common: (Option<Ends>, Option<Ends>),
        said: (bool, bool),
    ) -> Result<Self, FigureError> {
        let own = [chart];
        let x = common.0.map_or_else(|| ends_of_x(&own), |ends| Ok(Some(ends)))?.unwrap_or((0.0, 1.0));
        let y = common.1.map_or_else(|| ends_of_y(&own), |ends| Ok(Some(ends)))?.unwrap_or((0.0, 1.0));
        let ticks =
            (Ticks::new(&chart.x, x, size.0 / DISTANCES.0), Ticks::new(&chart.y, y, size.1 / DISTANCES.1));
        let notes = notes(chart).iter().flat_map(|note| wrapped(note, size.0)).collect();
        Ok(Self { chart, ends: (x, y), ticks, notes, said })
    }

    /// Room left of the plotting area, pixels.
    pub(super) fn left(&self) -> f64 {
        if !self.said.1 {
            return GAP;
        }
        let labels = self.ticks.1.labelled.iter().map(|(_, label)| lettering::width(label, EM));
        GAP + labels.fold(0.0, f64::max) + TITLE_ROOM
    }

    /// Room below the plotting area, pixels.
    pub(super) fn bottom(&self) -> f64 {
        let said = if self.said.0 { GAP + EM + TITLE_ROOM } else { GAP };
        said + NOTE_LINE * self.notes.len() as f64
    }

    /// Room right of the plotting area for what stands at the last tick, pixels.
    pub(super) fn right(&self) -> f64 {
        let last = self.ticks.0.labelled.last().filter(|_| self.said.0);
        last.map_or(GAP, |(_, label)| GAP + lettering::width(label, EM) / 2.0)
    }

    /// Whether something stands above the axis of y.
    pub(super) fn crowned(&self) -> bool {
        self.said.1 && !self.ticks.1.factor.is_empty()
    }

    /// Draws all into the plotting area.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        self.draw_ticks(canvas, area)?;
        for series in &self.chart.series {
            self.draw_series(canvas, area, series)?;
        }
        let pen = Pen { ink: BLACK, thickness: FRAME };
        canvas.frame((area.left, area.top), (area.right(), area.bottom()), pen)?;
        self.draw_labels(canvas, area)?;
        self.draw_notes(canvas, area)
    }

    /// Where a value of x and one of y are.
    fn place(&self, area: &Rectangle, x: f64, y: f64) -> Place {
        let part = |axis: &Axis, (from, to): Ends, value: f64| {
            let (from, to, at) = (axis.place(from), axis.place(to), axis.place(value));
            ((at - from) / (to - from)).clamp(-FARTHEST, FARTHEST)
        };
        let across = part(&self.chart.x, self.ends.0, x);
        let up = part(&self.chart.y, self.ends.1, y);
        (area.left + across * area.width, area.bottom() - up * area.height)
    }
}
