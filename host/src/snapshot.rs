//! Pictures of a state, drawn like Figs. 3 and 4: the box with its discs at true size, those of clusters
//! in another colour.
//!
//! In: the box, positions, which discs belong to clusters. Out: a PNG file. A disc across the border is
//! seen on both sides. In a box so large that a disc is smaller than a pixel of the picture, it is drawn as
//! one.
//!
//! ```
//! use meniscus::observables::clusters::Clusters;
//! use meniscus::{snapshot, start};
//! use meniscus_core::torus::Torus;
//!
//! let folder = tempfile::tempdir().unwrap();
//! let torus = Torus::new(100.0).unwrap();
//! let positions = start::random(&torus, 500, 1).unwrap();
//! let clusters = Clusters::find(&torus, &positions);
//! let path = folder.path().join("start.png");
//! snapshot::draw(&path, &torus, &positions, &|id| clusters.clustered(id), "t = 0    N = 500").unwrap();
//! assert!(std::fs::read(&path).unwrap().starts_with(b"\x89PNG"));
//! ```

use crate::figures::{font, palette, ticks};
use crate::files::FileError;
use crate::files::atomic::write_atomically;
use image::{ImageFormat, Rgb, RgbImage};
use meniscus_core::torus::{Position, Torus};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::io::Cursor;
use std::ops::Range;
use std::path::Path;

/// Width of the whole picture, pixels.
pub const WIDTH: u32 = 1088;
/// Height of the whole picture, pixels.
pub const HEIGHT: u32 = 1064;

/// Dots along a side of a pixel. All is drawn in dots; a pixel has the mean colour of its dots, so that
/// edges are smooth.
const DOTS: u32 = 4;
/// Memory that a picture takes while it is drawn, bytes: three of each dot.
pub(crate) const MEMORY: u32 = 3 * WIDTH * DOTS * HEIGHT * DOTS;
/// Left border of the box, dots.
const LEFT: i32 = 142 * DOTS as i32;
/// Upper border of the box, dots.
const TOP: i32 = 64 * DOTS as i32;
/// Side of the box, dots.
const SIDE: i32 = 900 * DOTS as i32;
/// Right border of the box, dots.
const RIGHT: i32 = LEFT + SIDE;
/// Lower border of the box, dots.
const BOTTOM: i32 = TOP + SIDE;
/// Middle of the caption's line, dots from above.
const CAPTION_LINE: i32 = 32 * DOTS as i32;
/// Middle of the tick labels of x, dots from the box.
const LABEL_LINE: i32 = 32 * DOTS as i32;
/// Right end of the tick labels of y, dots from the box.
const LABEL_END: i32 = 18 * DOTS as i32;
/// Widest tick label of y that leaves room for the title, dots.
const LABEL_ROOM: i32 = 80 * DOTS as i32;
/// Middle of the titles of the axes, dots from the edge of the picture.
const TITLE_LINE: i32 = 26 * DOTS as i32;
/// Thickness of the frame and of ticks, dots.
const LINE: i32 = 2 * DOTS as i32;
/// Length of a tick, dots.
const TICK: i32 = 8 * DOTS as i32;
/// Height of letters from the deepest to the highest, dots.
const LETTERS: f64 = 34.0 * DOTS as f64;
/// Smallest radius of a disc, dots: half a pixel.
const SMALLEST_RADIUS: f64 = 0.5 * DOTS as f64;
/// Most intervals between ticks along a side.
const MOST_INTERVALS: f64 = 6.0;

/// Discs in no cluster, frame and letters.
const BLACK_INK: Rgb<u8> = palette::BLACK.rgb();
/// Discs in clusters.
const RED_INK: Rgb<u8> = palette::RED.rgb();
/// Where nothing is.
const PAPER: Rgb<u8> = palette::PAPER.rgb();

/// By how much of their height plotters puts letters of DejaVu Sans above the place asked for: its middle of
/// a line is not the middle of a digit.
const RAISED: f64 = 0.216;

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum SnapshotError {
    /// The font in the program is not usable.
    #[error("the built-in font cannot be used")]
    Font,
    /// A text could not be drawn.
    #[error("the picture cannot be drawn: {0}")]
    Drawing(String),
    /// The picture could not be made a PNG.
    #[error("the picture cannot be encoded: {0}")]
    Encoding(#[from] image::ImageError),
    /// The file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// Draws discs at `positions` to a PNG file at `path`, [`WIDTH`] × [`HEIGHT`] pixels.
///
/// Discs for whose id `clustered` is true are red, the others black. `caption` stands above the box,
/// smaller if it is long. Axes are in R0.
///
/// # Errors
/// [`SnapshotError`]; the file is then as it was.
pub fn draw(
    path: &Path,
    torus: &Torus,
    positions: &[Position],
    clustered: &dyn Fn(usize) -> bool,
    caption: &str,
) -> Result<(), SnapshotError> {
    let mut dots = RgbImage::from_pixel(WIDTH * DOTS, HEIGHT * DOTS, PAPER);
    // Plain discs first, so that those of clusters are seen whole.
    for (ink, of_cluster) in [(BLACK_INK, false), (RED_INK, true)] {
        let discs = positions.iter().enumerate().filter(|(id, _)| clustered(*id) == of_cluster);
        discs.for_each(|(_, position)| draw_disc(&mut dots, torus, *position, ink));
    }
    draw_frame(&mut dots);
    draw_ticks(&mut dots, torus.side());
    draw_texts(&mut dots, torus.side(), caption)?;
    let mut png = Cursor::new(Vec::new());
    shrunk(&dots).write_to(&mut png, ImageFormat::Png)?;
    Ok(write_atomically(path, png.get_ref())?)
}

/// Fills the dots of the box whose middle is within R0 of `position`, or of one of its images.
fn draw_disc(dots: &mut RgbImage, torus: &Torus, position: Position, ink: Rgb<u8>) {
    let dots_per_length = f64::from(SIDE) / torus.side();
    // A disc as large as the box covers it.
    let radius = dots_per_length.clamp(SMALLEST_RADIUS, f64::from(SIDE));
    let column = torus.coordinate(position.x) * dots_per_length;
    // Rows are counted from above.
    let row = f64::from(SIDE) - torus.coordinate(position.y) * dots_per_length;
    let across = |centre: f64| (centre - radius) as i32 - 1..(centre + radius) as i32 + 2;
    for y in across(row) {
        for x in across(column) {
            let (along_x, along_y) = (f64::from(x) + 0.5 - column, f64::from(y) + 0.5 - row);
            if along_x * along_x + along_y * along_y <= radius * radius {
                let place = (LEFT + x.rem_euclid(SIDE), TOP + y.rem_euclid(SIDE));
                dots.put_pixel(place.0 as u32, place.1 as u32, ink);
            }
        }
    }
}

/// Draws the border of the box around its discs.
fn draw_frame(dots: &mut RgbImage) {
    let (columns, rows) = (LEFT - LINE..RIGHT + LINE, TOP - LINE..BOTTOM + LINE);
    fill(dots, columns.clone(), TOP - LINE..TOP);
    fill(dots, columns, BOTTOM..BOTTOM + LINE);
    fill(dots, LEFT - LINE..LEFT, rows.clone());
    fill(dots, RIGHT..RIGHT + LINE, rows);
}

/// Draws the ticks of both axes.
fn draw_ticks(dots: &mut RgbImage, side: f64) {
    for (_, along) in ticks(side) {
        let across = |middle: i32| middle - LINE / 2..middle + LINE / 2;
        fill(dots, across(LEFT + along), BOTTOM..BOTTOM + LINE + TICK);
        fill(dots, LEFT - LINE - TICK..LEFT, across(BOTTOM - along));
    }
}

/// Fills a rectangle with black.
fn fill(dots: &mut RgbImage, columns: Range<i32>, rows: Range<i32>) {
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        dots.put_pixel(x as u32, y as u32, BLACK_INK);
    }
}

/// Labels of the ticks of an axis, and how far along the axis they stand, dots.
fn ticks(side: f64) -> impl Iterator<Item = (String, i32)> {
    let step = ticks::step(side / MOST_INTERVALS);
    let digits = (-libm::floor(libm::log10(step))).max(0.0) as usize;
    (0..=(side / step) as i32).map(move |number| {
        let value = f64::from(number) * step;
        (format!("{value:.digits$}"), (value / side * f64::from(SIDE)) as i32)
    })
}

/// Writes the caption, the labels of the ticks, and the titles of the axes.
fn draw_texts(dots: &mut RgbImage, side: f64, caption: &str) -> Result<(), SnapshotError> {
    if !font::known() {
        return Err(SnapshotError::Font);
    }
    let size = dots.dimensions();
    let area = BitMapBackend::with_buffer(dots, size).into_drawing_area();
    let widest = ticks(side).map(|(label, _)| label).max_by_key(String::len).unwrap_or_default();
    let level = fitting_font(&widest, LABEL_ROOM)?;
    for (label, along) in ticks(side) {
        write(&area, &label, &level, HPos::Center, (LEFT + along, BOTTOM + LABEL_LINE))?;
        write(&area, &label, &level, HPos::Right, (LEFT - LABEL_END, BOTTOM - along))?;
    }
    let middle = SIDE / 2;
    let level = (font::FAMILY, LETTERS).into_font();
    write(&area, "x / R₀", &level, HPos::Center, (LEFT + middle, size.1 as i32 - TITLE_LINE))?;
    let upright = level.transform(FontTransform::Rotate270);
    write(&area, "y / R₀", &upright, HPos::Center, (TITLE_LINE, TOP + middle))?;
    write(&area, caption, &fitting_font(caption, SIDE)?, HPos::Center, (LEFT + middle, CAPTION_LINE))?;
    area.present().map_err(drawing)
}

/// The font in the size of letters, or smaller so that `words` are no wider than `room` dots.
fn fitting_font(words: &str, room: i32) -> Result<FontDesc<'static>, SnapshotError> {
    let (width, _) = (font::FAMILY, LETTERS).into_font().box_size(words).map_err(drawing)?;
    let smaller = (f64::from(room) / f64::from(width.max(1))).min(1.0);
    Ok((font::FAMILY, LETTERS * smaller).into_font())
}

/// Writes `words` so that the middle of their digits is at the height of `place`.
fn write(
    area: &DrawingArea<BitMapBackend<'_>, Shift>,
    words: &str,
    font: &FontDesc<'_>,
    side: HPos,
    (x, y): (i32, i32),
) -> Result<(), SnapshotError> {
    let lowered = (RAISED * font.get_size()) as i32;
    let place = match font.get_transform() {
        FontTransform::None => (x, y + lowered),
        _ => (x + lowered, y),
    };
    let style = TextStyle::from(font.clone()).color(&BLACK).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(words, place, style)).map_err(drawing)
}

fn drawing(error: impl std::fmt::Display) -> SnapshotError {
    SnapshotError::Drawing(error.to_string())
}

/// The picture whose pixels are the means of squares of dots.
fn shrunk(dots: &RgbImage) -> RgbImage {
    let row_length = 3 * (WIDTH * DOTS) as usize;
    let mut picture = RgbImage::from_pixel(WIDTH, HEIGHT, PAPER);
    for (pixels, rows) in picture.rows_mut().zip(dots.chunks_exact(row_length * DOTS as usize)) {
        for (number, pixel) in pixels.enumerate() {
            let start = number * ROW_OF_PIXEL;
            let square =
                || rows.chunks_exact(row_length).filter_map(|row| row.get(start..start + ROW_OF_PIXEL));
            // Most of a picture is empty, and told by comparing whole rows of dots.
            if square().any(|row| row != EMPTY_ROW) {
                *pixel = mean(square().flat_map(|row| row.chunks_exact(3)));
            }
        }
    }
    picture
}

/// Bytes of a row of dots of one pixel.
const ROW_OF_PIXEL: usize = 3 * DOTS as usize;

/// Such a row where nothing is drawn.
const EMPTY_ROW: [u8; ROW_OF_PIXEL] = [255; ROW_OF_PIXEL];

/// The mean colour of the dots of a pixel.
fn mean<'a>(dots: impl Iterator<Item = &'a [u8]>) -> Rgb<u8> {
    let mut sums = [0_u32; 3];
    for dot in dots {
        sums.iter_mut().zip(dot).for_each(|(sum, part)| *sum += u32::from(*part));
    }
    Rgb(sums.map(|sum| (sum / (DOTS * DOTS)) as u8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_across_the_border_is_seen_whole_and_at_true_size() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let torus = Torus::new(100.0).unwrap();
        let positions = [Position::from_bits(1 << 31, 1 << 31), Position::from_bits(0, 1 << 30)];
        draw(&path, &torus, &positions, &|id| id == 1, "t = 0").unwrap();
        let picture = image::open(&path).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (WIDTH, HEIGHT));

        let red: Vec<(u32, u32)> = picture
            .enumerate_pixels()
            .filter(|(_, _, pixel)| **pixel == RED_INK)
            .map(|(x, y, _)| (x, y))
            .collect();
        // 9 pixels are 1 R0; those at the rim are mixed with white.
        let area = core::f64::consts::PI * 81.0;
        assert!((area - 70.0..area).contains(&(red.len() as f64)), "{} of {area} pixels", red.len());
        let columns: Vec<u32> = red.iter().map(|place| place.0).collect();
        assert_eq!(columns.iter().min(), Some(&(LEFT as u32 / DOTS)));
        assert_eq!(columns.iter().max(), Some(&(RIGHT as u32 / DOTS - 1)));
        // A quarter of the box from below.
        let row = (BOTTOM - SIDE / 4) as u32 / DOTS;
        assert!(red.iter().all(|place| place.1.abs_diff(row) <= 9));
    }

    #[test]
    fn ticks_are_few_and_round() {
        for (side, step) in [(500.0, 100.0), (620.0, 200.0), (800.0, 200.0), (65536.0, 20000.0), (2.5, 0.5)] {
            assert_eq!(ticks::step(side / MOST_INTERVALS), step);
        }
        let labels: Vec<String> = ticks(2.5).map(|(label, _)| label).collect();
        assert_eq!(labels, ["0.0", "0.5", "1.0", "1.5", "2.0", "2.5"]);
    }
}
