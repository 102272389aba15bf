//! A chart in its plotting area: axes, ticks and series.

use super::FigureError;
use super::axis::Axis;
use super::canvas::{Canvas, Lettering, Pen, Place};
use super::chart::{Chart, Point, Series, Style};
use super::clip::{Rectangle, dashed, thinned};
use super::lettering;
use super::marks::{self, BAR, CAP, LINE, PALE, THIN_LINE};
use super::palette::{self, BLACK, GREY};
use super::ticks::Ticks;
use plotters::style::text_anchor::HPos;

/// Size of the letters at ticks, pixels.
const EM: f64 = 12.0;
/// Size of the letters of titles of axes, pixels.
const TITLE_EM: f64 = 13.0;
/// Size of the letters of notes, pixels.
const NOTE_EM: f64 = 10.0;
/// Height of a line of notes, pixels.
const NOTE_LINE: f64 = 14.0;
/// Between the plotting area and the labels of its ticks, pixels.
const GAP: f64 = 6.0;
/// Room for the title of an axis, pixels.
const TITLE_ROOM: f64 = 24.0;
/// Thickness of the frame, pixels.
const FRAME: f64 = 1.2;
/// Length of labelled ticks and of small ones, pixels.
const TICKS: (f64, f64) = (6.0, 3.0);
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

    /// The places of the points of a series, in the runs that a line joins.
    fn runs(&self, area: &Rectangle, series: &Series) -> Vec<Vec<(Place, Point)>> {
        let runs = series.points.split(|point| !has_place(self.chart, point));
        let placed = |point: &Point| (self.place(area, point.x, point.y), *point);
        runs.filter(|run| !run.is_empty()).map(|run| run.iter().map(placed).collect()).collect()
    }

    fn draw_series(
        &self,
        canvas: &mut Canvas<'_>,
        area: &Rectangle,
        series: &Series,
    ) -> Result<(), FigureError> {
        let ink = palette::ink(series.colour);
        let runs = self.runs(area, series);
        let line = match series.style {
            Style::Points(_) => None,
            Style::Line(dash) | Style::Band(dash) => Some((dash, LINE)),
            Style::PointsAndLine(_, dash) => Some((dash, THIN_LINE)),
        };
        if matches!(series.style, Style::Band(_)) {
            runs.iter().try_for_each(|run| self.draw_band(canvas, area, run, ink))?;
        }
        if let Some((dash, thickness)) = line {
            for run in &runs {
                let places: Vec<Place> = run.iter().map(|(place, _)| *place).collect();
                for part in area.parts(&thinned(&places)) {
                    for stroke in dashed(&part, dash) {
                        canvas.line(&stroke, Pen { ink, thickness })?;
                    }
                }
            }
        }
        if let Style::Points(marker) | Style::PointsAndLine(marker, _) = series.style {
            for (place, point) in runs.iter().flatten().filter(|(place, _)| area.contains(*place)) {
                self.draw_error(canvas, area, point, ink)?;
                marks::mark(canvas, marker, *place, ink)?;
            }
        }
        Ok(())
    }

    /// An end of an error bar: its place, inside of the plotting area, and whether it is there in truth.
    fn end(&self, area: &Rectangle, x: f64, y: f64) -> (Place, bool) {
        let (across, down) = self.place(area, x, y);
        let there = self.chart.y.holds(y) && area.contains((across, down));
        // What has no place on a logarithmic axis is below all that has.
        let down = if self.chart.y.holds(y) { down.clamp(area.top, area.bottom()) } else { area.bottom() };
        ((across, down), there)
    }

    fn draw_error(
        &self,
        canvas: &mut Canvas<'_>,
        area: &Rectangle,
        point: &Point,
        ink: palette::Ink,
    ) -> Result<(), FigureError> {
        if !point.error.is_some_and(|error| error.is_finite() && error > 0.0) {
            return Ok(());
        }
        let pen = Pen { ink, thickness: BAR };
        let [low, _, high] = extent(point);
        // One line: a cap if the end is there, down or up the bar, the other cap.
        let mut path = Vec::with_capacity(6);
        for (number, y) in [low, high].into_iter().enumerate() {
            let ((x, y), there) = self.end(area, point.x, y);
            let cap = if there { CAP } else { 0.0 };
            let cap = [((x - cap).max(area.left), y), ((x + cap).min(area.right()), y)];
            path.extend(if number == 0 { [cap[0], cap[1], (x, y)] } else { [(x, y), cap[0], cap[1]] });
        }
        canvas.line(&path, pen)
    }

    /// Fills what is between the ends of error bars, trapezium by trapezium inside of the plotting area.
    fn draw_band(
        &self,
        canvas: &mut Canvas<'_>,
        area: &Rectangle,
        run: &[(Place, Point)],
        ink: palette::Ink,
    ) -> Result<(), FigureError> {
        let inside = |place: &Place| (area.left..=area.right()).contains(&place.0);
        let side = |end: usize| -> Vec<Place> {
            let values = run.iter().filter(|(place, _)| inside(place));
            let ends = values
                .map(|(_, point)| extent(point).get(end).copied().map(|y| self.end(area, point.x, y).0));
            ends.flatten().collect()
        };
        let (low, high) = (thinned(&side(0)), thinned(&side(2)));
        if low.len() < 2 {
            return Ok(());
        }
        let border: Vec<Place> = low.into_iter().chain(high.into_iter().rev()).collect();
        canvas.polygon(&border, ink, PALE)
    }

    /// Ticks on all four sides, to the inside.
    fn draw_ticks(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let pen = Pen { ink: BLACK, thickness: 1.0 };
        let both = |ticks: &Ticks| {
            let labelled = ticks.labelled.iter().map(|(value, _)| (*value, TICKS.0));
            labelled.chain(ticks.small.iter().map(|value| (*value, TICKS.1))).collect::<Vec<_>>()
        };
        for (value, length) in both(&self.ticks.0) {
            let (x, _) = self.place(area, value, self.ends.1.0);
            canvas.line(&[(x, area.bottom()), (x, area.bottom() - length)], pen)?;
            canvas.line(&[(x, area.top), (x, area.top + length)], pen)?;
        }
        for (value, length) in both(&self.ticks.1) {
            let (_, y) = self.place(area, self.ends.0.0, value);
            canvas.line(&[(area.left, y), (area.left + length, y)], pen)?;
            canvas.line(&[(area.right(), y), (area.right() - length, y)], pen)?;
        }
        Ok(())
    }

    /// What stands at the ticks, and the titles of the axes.
    fn draw_labels(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let style = |em: f64, side: HPos| Lettering { ink: BLACK, em, side, upright: false };
        if self.said.0 {
            let line = area.bottom() + GAP + EM;
            for (value, label) in &self.ticks.0.labelled {
                let (x, _) = self.place(area, *value, self.ends.1.0);
                canvas.text(label, (x, line), style(EM, HPos::Center))?;
            }
            let line = line + TITLE_ROOM - GAP;
            let title = self.chart.x.title();
            canvas.text(&title, (area.left + area.width / 2.0, line), style(TITLE_EM, HPos::Center))?;
            let factor = &self.ticks.0.factor;
            if !factor.is_empty() {
                canvas.text(factor, (area.right(), line), style(EM, HPos::Right))?;
            }
        }
        if self.said.1 {
            for (value, label) in &self.ticks.1.labelled {
                let (_, y) = self.place(area, self.ends.0.0, *value);
                canvas.text(label, (area.left - GAP, y + 0.36 * EM), style(EM, HPos::Right))?;
            }
            let upright = Lettering { upright: true, ..style(TITLE_EM, HPos::Center) };
            let place = (area.left - self.left() + TITLE_EM, area.top + area.height / 2.0);
            canvas.text(&self.chart.y.title(), place, upright)?;
            if self.crowned() {
                let place = (area.left - GAP, area.top - 5.0);
                canvas.text(&self.ticks.1.factor, place, style(EM, HPos::Left))?;
            }
        }
        Ok(())
    }

    fn draw_notes(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let below = area.bottom() + self.bottom() - NOTE_LINE * self.notes.len() as f64;
        for (number, note) in self.notes.iter().enumerate() {
            let line = below + NOTE_LINE * (number as f64 + 0.75);
            let style = Lettering { ink: GREY, em: NOTE_EM, side: HPos::Left, upright: false };
            canvas.text(note, (area.left, line), style)?;
        }
        Ok(())
    }
}

/// What stands below a chart: its note, and what of it cannot be seen.
fn notes(chart: &Chart) -> Vec<String> {
    let all = || chart.series.iter().flat_map(|series| &series.points);
    let finite = |point: &&Point| point.x.is_finite() && point.y.is_finite();
    let lost = all().filter(finite).filter(|point| !has_place(chart, point)).count();
    let mut notes = Vec::new();
    if !chart.note.is_empty() {
        notes.push(chart.note.clone());
    }
    if drawn(chart).next().is_none() {
        notes.push("no data".to_owned());
    }
    match lost {
        0 => {}
        1 => notes.push("1 point at or below zero has no place on a logarithmic axis".to_owned()),
        _ => notes.push(format!("{lost} points at or below zero have no place on a logarithmic axis")),
    }
    notes
}

/// A note in lines that fit `width` pixels.
fn wrapped(note: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in note.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| lettering::width(line, NOTE_EM) <= width) {
            Some(line) => {
                lines.pop();
                lines.push(line);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}
