//! The lines, bands, markers and error bars of a series.

use super::{Plot, extent, has_place};
use crate::figures::FigureError;
use crate::figures::canvas::{Canvas, Pen, Place};
use crate::figures::chart::{Point, Series, Style};
use crate::figures::clip::{Rectangle, dashed, thinned};
use crate::figures::marks::{self, BAR, CAP, LINE, PALE, THIN_LINE};
use crate::figures::palette;

impl Plot<'_> {
    /// The places of the points of a series, in the runs that a line joins.
    fn runs(&self, area: &Rectangle, series: &Series) -> Vec<Vec<(Place, Point)>> {
        let runs = series.points.split(|point| !has_place(self.chart, point));
        let placed = |point: &Point| (self.place(area, point.x, point.y), *point);
        runs.filter(|run| !run.is_empty()).map(|run| run.iter().map(placed).collect()).collect()
    }

    pub(super) fn draw_series(
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
}
