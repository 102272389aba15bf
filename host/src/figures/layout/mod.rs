//! Where the parts of a figure are.

mod cell;

use super::canvas::{self, Canvas, Lettering};
use super::chart::Chart;
use super::clip::Rectangle;
use super::legend::Entries;
use super::palette::BLACK;
use super::{Figure, FigureError, Legend, Panel, font, lettering};
use cell::{Cell, Room, cells};
use plotters::style::text_anchor::HPos;

/// Around all, pixels.
const MARGIN: f64 = 12.0;
/// Between panels, pixels.
const BETWEEN: f64 = 14.0;
/// Between panels and a legend, pixels.
const BEFORE_LEGEND: f64 = 16.0;
/// Size of the letters of the figure's title, pixels, and the height of its line.
const TITLE: (f64, f64) = (15.0, 30.0);
/// Size of the letters of headers and of titles of panels, pixels, and the height of their line.
const HEADER: (f64, f64) = (13.0, 24.0);
/// The largest width or height, pixels: a PNG of it has twice as many.
const MOST: f64 = 8000.0;

/// A figure whose parts have places.
pub(super) struct Layout<'a> {
    figure: &'a Figure,
    cells: Vec<Cell<'a>>,
    /// The legend of all panels.
    legend: Option<(Entries, Rectangle)>,
    /// Width and height, pixels.
    size: (f64, f64),
    /// Left of the row headers and above the column headers, pixels.
    origin: (f64, f64),
}

impl<'a> Layout<'a> {
    /// Finds places for all parts of a figure.
    pub(super) fn new(figure: &'a Figure) -> Result<Self, FigureError> {
        if !font::known() {
            return Err(FigureError::Font);
        }
        if figure.panels.is_empty() {
            return Err(FigureError::NoPanels { title: figure.title.clone() });
        }
        let mut layout =
            Self { figure, cells: cells(figure)?, legend: None, size: (0.0, 0.0), origin: (MARGIN, MARGIN) };
        layout.place_panels();
        layout.place_legend();
        layout.size = (libm::ceil(layout.size.0 + MARGIN), libm::ceil(layout.size.1 + MARGIN));
        let (width, height) = layout.size;
        if !(width <= MOST && height <= MOST) {
            return Err(FigureError::Size { title: figure.title.clone(), width, height, most: MOST });
        }
        Ok(layout)
    }

    /// Places the panels: in a column all areas begin at the same x, in a row at the same y.
    fn place_panels(&mut self) {
        let columns = self.figure.columns.max(1);
        let rooms: Vec<Room> = self.cells.iter().map(Cell::room).collect();
        let most = |panels: &mut dyn Iterator<Item = &Room>| {
            panels.fold(Room::default(), |one, other| one.or_more(*other))
        };
        if !self.figure.title.is_empty() {
            self.origin.1 += TITLE.1;
        }
        let headers = |texts: &[String]| if texts.is_empty() { 0.0 } else { HEADER.1 };
        let first = (
            self.origin.0 + headers(&self.figure.row_headers),
            self.origin.1 + headers(&self.figure.column_headers),
        );
        let mut top = first.1;
        let mut lowest = top;
        let mut rightmost = first.0;
        for (row, cells) in self.cells.chunks_mut(columns).enumerate() {
            let in_row = most(&mut rooms.iter().skip(row * columns).take(columns));
            let mut left = first.0;
            for (column, cell) in cells.iter_mut().enumerate() {
                let in_column = most(&mut rooms.iter().skip(column).step_by(columns));
                cell.area.left = left + in_column.left;
                cell.area.top = top + in_row.top;
                left = cell.area.right() + in_column.right + BETWEEN;
                rightmost = rightmost.max(left - BETWEEN);
                let (beside, top) = (cell.area.right() + cell.right() + BEFORE_LEGEND, cell.area.top);
                if let Some((_, place)) = &mut cell.legend {
                    (place.left, place.top) = (beside, top);
                }
            }
            lowest = top + in_row.top + in_row.height + in_row.bottom;
            top = lowest + BETWEEN;
        }
        self.size = (rightmost, lowest);
    }

    /// Places the legend of all panels beside or below them.
    fn place_legend(&mut self) {
        let entries = Entries::of(charts(self.figure));
        let own = self.cells.iter().any(|cell| cell.legend.is_some());
        if own || entries.is_empty() || self.figure.legend == Legend::None {
            return;
        }
        let Some(first) = self.cells.first() else { return };
        let (left, top) = (first.area.left, first.area.top);
        let beside = self.figure.legend == Legend::Right;
        let entries = if beside { entries } else { entries.spread(self.size.0 - left) };
        let (width, height) = entries.size();
        let place = match beside {
            true => Rectangle { left: self.size.0 + BEFORE_LEGEND, top, width, height },
            false => Rectangle { left, top: self.size.1 + BEFORE_LEGEND, width, height },
        };
        self.size = (self.size.0.max(place.right()), self.size.1.max(place.bottom()));
        self.legend = Some((entries, place));
    }

    /// Draws the figure.
    pub(super) fn svg(&self) -> Result<String, FigureError> {
        canvas::svg(self.size.0, self.size.1, |canvas| {
            self.draw_headers(canvas)?;
            for cell in &self.cells {
                cell.draw(canvas)?;
            }
            self.legend.iter().try_for_each(|(entries, place)| entries.draw(canvas, *place))
        })
    }

    fn draw_headers(&self, canvas: &mut Canvas<'_>) -> Result<(), FigureError> {
        let style = |em: f64| Lettering { ink: BLACK, em, side: HPos::Center, upright: false };
        let room = self.size.0 - 2.0 * MARGIN;
        let em = TITLE.0 * (room / lettering::width(&self.figure.title, TITLE.0).max(1.0)).min(1.0);
        canvas.text(&self.figure.title, (self.size.0 / 2.0, MARGIN + 0.6 * TITLE.1), style(em))?;
        let columns = self.figure.columns.max(1);
        for (cell, header) in self.cells.iter().zip(&self.figure.column_headers).take(columns) {
            let middle = cell.area.left + cell.area.width / 2.0;
            canvas.text(header, (middle, self.origin.1 + 0.6 * HEADER.1), style(HEADER.0))?;
        }
        for (cell, header) in self.cells.iter().step_by(columns).zip(&self.figure.row_headers) {
            let place = (self.origin.0 + 0.6 * HEADER.1, cell.area.top + cell.area.height / 2.0);
            canvas.text(header, place, Lettering { upright: true, ..style(HEADER.0) })?;
        }
        Ok(())
    }
}

fn charts(figure: &Figure) -> impl Iterator<Item = &Chart> {
    figure.panels.iter().filter_map(|panel| match panel {
        Panel::Chart(chart) => Some(chart),
        Panel::Discs(_) => None,
    })
}

#[cfg(test)]
mod tests;
