//! Markers, error bars and samples of series.

use super::FigureError;
use super::canvas::{Canvas, Pen, Place};
use super::chart::{Marker, Series, Style};
use super::clip::dashed;
use super::palette::{self, Ink};

/// Half of a marker's height, pixels.
pub(super) const RADIUS: f64 = 3.4;
/// Thickness of lines alone, pixels.
pub(super) const LINE: f64 = 1.7;
/// Thickness of lines that join markers, pixels.
pub(super) const THIN_LINE: f64 = 1.0;
/// Thickness of error bars and of open markers, pixels.
pub(super) const BAR: f64 = 1.1;
/// Half of the length of an error bar's caps, pixels.
pub(super) const CAP: f64 = 2.6;
/// Opacity of bands.
pub(super) const PALE: f64 = 0.25;
/// Length of the sample of a line in a legend, pixels.
pub(super) const SAMPLE: f64 = 30.0;

/// Draws a marker.
pub(super) fn mark(
    canvas: &mut Canvas<'_>,
    marker: Marker,
    (x, y): Place,
    ink: Ink,
) -> Result<(), FigureError> {
    let pen = Pen { ink, thickness: BAR + 0.3 };
    let at = |along: f64, down: f64| (x + along * RADIUS, y + down * RADIUS);
    let square = [at(-0.9, -0.9), at(0.9, -0.9), at(0.9, 0.9), at(-0.9, 0.9)];
    let triangle = [at(0.0, -1.2), at(1.1, 0.8), at(-1.1, 0.8)];
    match marker {
        Marker::Circle => canvas.disc((x, y), RADIUS, ink),
        Marker::Square => canvas.polygon(&square, ink, 1.0),
        Marker::Triangle => canvas.polygon(&triangle, ink, 1.0),
        Marker::InvertedTriangle => canvas.polygon(&[at(0.0, 1.2), at(1.1, -0.8), at(-1.1, -0.8)], ink, 1.0),
        Marker::Diamond => {
            canvas.polygon(&[at(0.0, -1.3), at(1.1, 0.0), at(0.0, 1.3), at(-1.1, 0.0)], ink, 1.0)
        }
        Marker::Cross => {
            canvas.line(&[at(-0.9, -0.9), at(0.9, 0.9)], pen)?;
            canvas.line(&[at(-0.9, 0.9), at(0.9, -0.9)], pen)
        }
        Marker::Plus => {
            canvas.line(&[at(-1.1, 0.0), at(1.1, 0.0)], pen)?;
            canvas.line(&[at(0.0, -1.1), at(0.0, 1.1)], pen)
        }
        Marker::OpenCircle => {
            canvas.disc((x, y), RADIUS, palette::PAPER)?;
            canvas.ring((x, y), RADIUS - 0.3, pen)
        }
        Marker::OpenSquare => open(canvas, &square, pen),
        Marker::OpenTriangle => open(canvas, &triangle, pen),
    }
}

/// Draws the border of a marker that is white inside.
fn open(canvas: &mut Canvas<'_>, corners: &[Place], pen: Pen) -> Result<(), FigureError> {
    canvas.polygon(corners, palette::PAPER, 1.0)?;
    let closed: Vec<Place> = corners.iter().chain(corners.iter().take(2)).copied().collect();
    canvas.line(&closed, pen)
}

/// Draws what the series looks like, from `from` to the right.
pub(super) fn sample(canvas: &mut Canvas<'_>, series: &Series, from: Place) -> Result<(), FigureError> {
    let ink = palette::ink(series.colour);
    let to = (from.0 + SAMPLE, from.1);
    let (marker, line) = match series.style {
        Style::Points(marker) => (Some(marker), None),
        Style::Line(dash) | Style::Band(dash) => (None, Some((dash, LINE))),
        Style::PointsAndLine(marker, dash) => (Some(marker), Some((dash, THIN_LINE))),
    };
    if matches!(series.style, Style::Band(_)) {
        let (top, bottom) = (from.1 - 4.5, from.1 + 4.5);
        canvas.polygon(&[(from.0, top), (to.0, top), (to.0, bottom), (from.0, bottom)], ink, PALE)?;
    }
    if let Some((dash, thickness)) = line {
        for stroke in dashed(&[from, to], dash) {
            canvas.line(&stroke, Pen { ink, thickness })?;
        }
    }
    marker.map_or(Ok(()), |marker| mark(canvas, marker, (from.0 + SAMPLE / 2.0, from.1), ink))
}
