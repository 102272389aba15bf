//! Where the parts of a figure are.

use super::canvas::{self, Canvas, Lettering};
use super::chart::Chart;
use super::clip::Rectangle;
use super::legend::Entries;
use super::palette::BLACK;
use super::plotting::{self, Ends, Plot};
use super::{Figure, FigureError, Legend, Panel, font, lettering};
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
/// Room above a panel without a title, pixels.
const BARE: f64 = 8.0;
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

/// A panel with its place.
struct Cell<'a> {
    /// The plotting area, or the box of discs.
    area: Rectangle,
    content: Content<'a>,
    /// Letter and title.
    title: String,
    /// Its own legend.
    legend: Option<(Entries, Rectangle)>,
}

enum Content<'a> {
    Plot(Box<Plot<'a>>),
    Discs(&'a super::Discs),
}

/// The room that a panel needs around its area, pixels.
#[derive(Clone, Copy, Default)]
struct Room {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    height: f64,
}

impl Room {
    fn or_more(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            right: self.right.max(other.right),
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
            height: self.height.max(other.height),
        }
    }
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

/// The panels of a figure, without places.
fn cells(figure: &Figure) -> Result<Vec<Cell<'_>>, FigureError> {
    let all: Vec<&Chart> = charts(figure).collect();
    let common = (
        if figure.common_x { plotting::ends_of_x(&all)? } else { None },
        if figure.common_y { plotting::ends_of_y(&all)? } else { None },
    );
    let own_legends = figure.legend != Legend::None && !Entries::of(all.iter().copied()).clear();
    let columns = figure.columns.max(1);
    let mut cells = Vec::with_capacity(figure.panels.len());
    for (number, panel) in figure.panels.iter().enumerate() {
        let lowest = number + columns >= figure.panels.len();
        let said = (lowest || !figure.common_x, number % columns == 0 || !figure.common_y);
        let letter = if figure.lettered { lettered(number) } else { String::new() };
        cells.push(Cell::new(figure, panel, common, said, own_legends, &letter)?);
    }
    Ok(cells)
}

/// (a), (b) ... (z), (aa) ...
fn lettered(number: usize) -> String {
    let letter = |place: usize| char::from(b'a' + (place % 26) as u8);
    match number.checked_sub(26) {
        None => format!("({})", letter(number)),
        Some(more) => format!("({}{})", letter(more / 26), letter(more)),
    }
}

impl<'a> Cell<'a> {
    fn new(
        figure: &Figure,
        panel: &'a Panel,
        common: (Option<Ends>, Option<Ends>),
        said: (bool, bool),
        own_legend: bool,
        letter: &str,
    ) -> Result<Self, FigureError> {
        let (width, mut height) = (figure.panel_width, figure.panel_height);
        let mut legend = None;
        let (content, title) = match panel {
            Panel::Chart(chart) => {
                let entries = Entries::of(std::iter::once(chart));
                if own_legend && !entries.is_empty() {
                    let (width, height) = entries.size();
                    legend = Some((entries, Rectangle { left: 0.0, top: 0.0, width, height }));
                }
                let plot = Plot::new(chart, (width, height), common, said)?;
                (Content::Plot(Box::new(plot)), &chart.title)
            }
            Panel::Discs(discs) => {
                height = width;
                (Content::Discs(discs), &discs.caption)
            }
        };
        let title = format!("{letter} {title}").trim().to_owned();
        Ok(Self { area: Rectangle { left: 0.0, top: 0.0, width, height }, content, title, legend })
    }

    /// Room right of the area that its own labels need, pixels.
    fn right(&self) -> f64 {
        match &self.content {
            Content::Plot(plot) => plot.right(),
            Content::Discs(_) => 0.0,
        }
    }

    fn room(&self) -> Room {
        let legend = self.legend.as_ref().map_or(0.0, |(_, place)| BEFORE_LEGEND + place.width);
        let bare = match &self.content {
            Content::Plot(plot) if plot.crowned() => HEADER.1,
            Content::Plot(_) => BARE,
            Content::Discs(_) => 0.0,
        };
        // A legend may be higher than its panel.
        let legend_height = self.legend.as_ref().map_or(0.0, |(_, place)| place.height);
        let top = if self.title.is_empty() { bare } else { HEADER.1 };
        let height = self.area.height;
        match &self.content {
            Content::Plot(plot) => Room {
                left: plot.left(),
                right: plot.right() + legend,
                top,
                bottom: plot.bottom().max(legend_height - height),
                height,
            },
            Content::Discs(_) => Room { left: 0.0, right: 0.0, top, bottom: 0.0, height },
        }
    }

    fn draw(&self, canvas: &mut Canvas<'_>) -> Result<(), FigureError> {
        let area = &self.area;
        match &self.content {
            Content::Plot(plot) => plot.draw(canvas, area)?,
            Content::Discs(discs) => discs.draw(canvas, (area.left, area.top), area.width)?,
        }
        self.legend.iter().try_for_each(|(entries, place)| entries.draw(canvas, *place))?;
        self.draw_title(canvas)
    }

    fn draw_title(&self, canvas: &mut Canvas<'_>) -> Result<(), FigureError> {
        if self.title.is_empty() {
            return Ok(());
        }
        // A factor stands where the title would begin.
        let shift = match &self.content {
            Content::Plot(plot) if plot.crowned() => 44.0,
            _ => 0.0,
        };
        let place = (self.area.left + shift, self.area.top - 7.0);
        canvas.text(
            &self.title,
            place,
            Lettering { ink: BLACK, em: HEADER.0, side: HPos::Left, upright: false },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::axis::Axis;
    use super::super::chart::{Colour, Marker, Series};
    use super::*;
    use roxmltree::Document;

    /// Two panels with different series under one legend.
    fn figure(legend: Legend) -> Figure {
        let series = |number: usize| {
            let points = (0..20).map(|x| (f64::from(x), libm::sin(f64::from(x)) * (number + 1) as f64, 0.3));
            Series::points(
                &format!("a long label, number {number}"),
                Colour::Category(number),
                Marker::Circle,
                points,
            )
        };
        let chart = |first: usize| {
            let axes = (Axis::linear("t", "T"), Axis::linear("n_c / L^2", "R_0^{-2}"));
            Panel::Chart(Chart::new("", axes.0, axes.1).with(series(first)).with(series(first + 1)))
        };
        Figure { legend, ..Figure::new("title", [chart(0), chart(1), chart(3)]) }
    }

    /// The middles of all circles, pixels.
    fn circles(svg: &str) -> Vec<(f64, f64)> {
        let document = Document::parse(svg).unwrap();
        let nodes = document.descendants().filter(|node| node.has_tag_name("circle"));
        let number = |text: Option<&str>| text.unwrap().parse::<f64>().unwrap() / 10.0;
        nodes.map(|node| (number(node.attribute("cx")), number(node.attribute("cy")))).collect()
    }

    fn apart(one: &Rectangle, other: &Rectangle) -> bool {
        one.right() <= other.left
            || other.right() <= one.left
            || one.bottom() <= other.top
            || other.bottom() <= one.top
    }

    #[test]
    fn all_points_are_in_their_areas_and_legends_are_not() {
        for legend in [Legend::Right, Legend::Below] {
            let figure = figure(legend);
            let layout = Layout::new(&figure).unwrap();
            let (entries, place) = layout.legend.as_ref().unwrap();
            assert!(entries.clear());
            let page = Rectangle { left: 0.0, top: 0.0, width: layout.size.0, height: layout.size.1 };
            for (number, cell) in layout.cells.iter().enumerate() {
                assert!(apart(&cell.area, place), "{legend:?}: {place:?} covers {:?}", cell.area);
                assert!(layout.cells.iter().skip(number + 1).all(|other| apart(&cell.area, &other.area)));
            }
            for place in layout.cells.iter().map(|cell| &cell.area).chain([place]) {
                assert!(
                    page.contains((place.left, place.top)) && page.contains((place.right(), place.bottom()))
                );
            }
            let circles = circles(&layout.svg().unwrap());
            let inside = |area: &Rectangle| circles.iter().filter(|circle| area.contains(**circle)).count();
            assert!(layout.cells.iter().all(|cell| inside(&cell.area) == 40));
            // Numbers 0, 1, 2, 3, 4, and nothing elsewhere.
            assert_eq!((inside(place), circles.len()), (5, 125));
        }
    }

    #[test]
    fn panels_have_their_own_legends_where_one_look_means_two_things() {
        let mut figure = figure(Legend::Right);
        if let Some(Panel::Chart(chart)) = figure.panels.last_mut() {
            chart.series[0].colour = Colour::Category(0);
        }
        let layout = Layout::new(&figure).unwrap();
        assert!(layout.legend.is_none());
        let places: Vec<&Rectangle> =
            layout.cells.iter().map(|cell| &cell.legend.as_ref().unwrap().1).collect();
        for place in &places {
            assert!(layout.cells.iter().all(|cell| apart(&cell.area, place)), "{place:?}");
        }
        assert!(layout.cells.iter().all(|cell| cell.area.right() <= layout.size.0));
    }

    #[test]
    fn letters_go_on_after_z() {
        assert_eq!([0, 25, 26, 53].map(lettered), ["(a)", "(z)", "(aa)", "(bb)"]);
    }
}
