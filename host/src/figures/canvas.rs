//! What figures are drawn on: plotters' SVG, in tenths of pixels, as its coordinates are whole numbers.

use super::FigureError;
use super::font;
use super::lettering::{self, Height};
use super::palette::{Ink, PAPER};
use plotters::prelude::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, FontTransform, RGBAColor, ShapeStyle, TextStyle};

/// Steps of coordinates along a pixel.
const STEPS: f64 = 10.0;

/// plotters asks for letters so much larger than it writes into an SVG.
const SIZE_PER_EM: f64 = 1.24;

/// How much lower plotters puts the line of letters than asked, of their size, when their end is at the
/// place (half of what counts as the height of an x, which is half an em in most viewers).
const SUNK: f64 = -0.25;

/// A place, pixels from the left and from above.
pub(super) type Place = (f64, f64);

/// An SVG that is being drawn.
pub(super) struct Canvas<'a> {
    backend: SVGBackend<'a>,
    pictures: String,
}

/// What a line is drawn with.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub(super) ink: Ink,
    /// Thickness, pixels.
    pub(super) thickness: f64,
}

/// How a text is set.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    pub(super) ink: Ink,
    /// Size of letters, pixels.
    pub(super) em: f64,
    /// Which end of the text is at the place.
    pub(super) side: HPos,
    /// Whether it runs from below to above.
    pub(super) upright: bool,
}

/// Draws an SVG of `width` × `height` pixels.
pub(super) fn svg(
    width: f64,
    height: f64,
    draw: impl FnOnce(&mut Canvas<'_>) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let mut text = String::new();
    let size = ((width * STEPS) as u32, (height * STEPS) as u32);
    let pictures = {
        let mut canvas =
            Canvas { backend: SVGBackend::with_string(&mut text, size), pictures: String::new() };
        canvas.polygon(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], PAPER, 1.0)?;
        draw(&mut canvas)?;
        canvas.backend.present().map_err(drawing)?;
        std::mem::take(&mut canvas.pictures)
    };
    // The measures are pixels again, and corners of lines have no spikes.
    let measures = format!("<svg width=\"{}\" height=\"{}\" ", size.0, size.1);
    let pixels = format!("<svg width=\"{width}\" height=\"{height}\" stroke-linejoin=\"round\" ");
    let text = text.replacen(&measures, &pixels, 1);
    let body = text.trim_end().trim_end_matches("</svg>");
    Ok(format!("{body}{pictures}</svg>\n"))
}

impl Canvas<'_> {
    /// A line through places.
    pub(super) fn line(&mut self, places: &[Place], pen: Pen) -> Result<(), FigureError> {
        let mut path: Vec<(i32, i32)> = places.iter().map(|place| steps(*place)).collect();
        path.dedup();
        if path.len() < 2 {
            return Ok(());
        }
        self.backend.draw_path(path, &stroke(pen)).map_err(drawing)
    }

    /// A filled area, `opacity` from 0 to 1.
    pub(super) fn polygon(&mut self, corners: &[Place], ink: Ink, opacity: f64) -> Result<(), FigureError> {
        let style = ShapeStyle { color: colour(ink, opacity), filled: true, stroke_width: 0 };
        self.backend.fill_polygon(corners.iter().map(|place| steps(*place)), &style).map_err(drawing)
    }

    /// A filled circle.
    pub(super) fn disc(&mut self, middle: Place, radius: f64, ink: Ink) -> Result<(), FigureError> {
        let style = ShapeStyle { color: colour(ink, 1.0), filled: true, stroke_width: 0 };
        let radius = (radius * STEPS) as u32;
        self.backend.draw_circle(steps(middle), radius, &style, true).map_err(drawing)
    }

    /// A circle.
    pub(super) fn ring(&mut self, middle: Place, radius: f64, pen: Pen) -> Result<(), FigureError> {
        let radius = (radius * STEPS) as u32;
        self.backend.draw_circle(steps(middle), radius, &stroke(pen), false).map_err(drawing)
    }

    /// The border of a rectangle between two corners.
    pub(super) fn frame(
        &mut self,
        (left, top): Place,
        (right, bottom): Place,
        pen: Pen,
    ) -> Result<(), FigureError> {
        // Half a line further, so that the first corner is closed.
        let start = left - pen.thickness / 2.0;
        self.line(&[(start, top), (right, top), (right, bottom), (left, bottom), (left, top)], pen)
    }

    /// A text whose letters stand on the line through `place`.
    pub(super) fn text(&mut self, text: &str, place: Place, lettering: Lettering) -> Result<(), FigureError> {
        let parts = lettering::parts(text);
        if let [(letters, Height::Line)] = parts.as_slice() {
            return self.letters(letters, place, lettering);
        }
        let (parts, width) = lettering::placed(text, lettering.em);
        let begin = match lettering.side {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        for (letters, height, start) in parts.into_iter().filter(|(letters, ..)| !letters.is_empty()) {
            let (along, rise) = (begin + start, height.rise() * lettering.em);
            let at = match lettering.upright {
                true => (place.0 - rise, place.1 - along),
                false => (place.0 + along, place.1 - rise),
            };
            let em = lettering.em * height.size();
            self.letters(&letters, at, Lettering { em, side: HPos::Left, ..lettering })?;
        }
        Ok(())
    }

    /// Letters of one size on one line.
    fn letters(&mut self, letters: &str, place: Place, lettering: Lettering) -> Result<(), FigureError> {
        let lowered = -SUNK * lettering.em;
        let (place, transform) = match lettering.upright {
            true => ((place.0 + lowered, place.1), FontTransform::Rotate270),
            false => ((place.0, place.1 + lowered), FontTransform::None),
        };
        let size = lettering.em * STEPS * SIZE_PER_EM;
        let font =
            FontDesc::new(FontFamily::Name(font::FAMILY), size, FontStyle::Normal).transform(transform);
        let ink = colour(lettering.ink, 1.0);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(lettering.side, VPos::Bottom));
        self.backend.draw_text(letters, &style, steps(place)).map_err(drawing)
    }

    /// An SVG element between `corner` and `size` pixels from there, in measures of its own, `side` wide;
    /// what is outside of it is not seen. It lies over all that is drawn otherwise.
    pub(super) fn picture(&mut self, corner: Place, size: f64, side: f64, elements: &str) {
        let (x, y) = steps(corner);
        let size = (size * STEPS) as i32;
        self.pictures.push_str(&format!(
            "<svg x=\"{x}\" y=\"{y}\" width=\"{size}\" height=\"{size}\" viewBox=\"0 0 {side} {side}\">\n{elements}</svg>\n"
        ));
    }
}

/// A place in steps.
fn steps(place: Place) -> (i32, i32) {
    (libm::round(place.0 * STEPS) as i32, libm::round(place.1 * STEPS) as i32)
}

fn stroke(pen: Pen) -> ShapeStyle {
    ShapeStyle { color: colour(pen.ink, 1.0), filled: false, stroke_width: (pen.thickness * STEPS) as u32 }
}

fn colour(ink: Ink, opacity: f64) -> RGBAColor {
    RGBAColor(ink.0, ink.1, ink.2, opacity)
}

fn drawing(error: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(error.to_string())
}
