//! A panel with the room that it needs around it, its letter and its legend.

use super::{BEFORE_LEGEND, HEADER, charts};
use crate::figures::canvas::{Canvas, Lettering};
use crate::figures::chart::Chart;
use crate::figures::clip::Rectangle;
use crate::figures::legend::Entries;
use crate::figures::palette::BLACK;
use crate::figures::plotting::{self, Ends, Plot};
use crate::figures::{Discs, Figure, FigureError, Legend, Panel};
use plotters::style::text_anchor::HPos;

/// Room above a panel without a title, pixels.
const BARE: f64 = 8.0;

/// A panel with its place.
pub(super) struct Cell<'a> {
    /// The plotting area, or the box of discs.
    pub(super) area: Rectangle,
    content: Content<'a>,
    /// Letter and title.
    title: String,
    /// Its own legend.
    pub(super) legend: Option<(Entries, Rectangle)>,
}

enum Content<'a> {
    Plot(Box<Plot<'a>>),
    Discs(&'a Discs),
}

/// The room that a panel needs around its area, pixels.
#[derive(Clone, Copy, Default)]
pub(super) struct Room {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
    /// That of the area itself.
    pub(super) height: f64,
}

impl Room {
    /// As much as either needs.
    pub(super) fn or_more(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            right: self.right.max(other.right),
            top: self.top.max(other.top),
            bottom: self.bottom.max(other.bottom),
            height: self.height.max(other.height),
        }
    }
}

/// The panels of a figure, without places.
pub(super) fn cells(figure: &Figure) -> Result<Vec<Cell<'_>>, FigureError> {
    let all: Vec<&Chart> = charts(figure).collect();
    let common = (
        if figure.common_x { plotting::ends_of_x(&all)? } else { None },
        if figure.common_y { plotting::ends_of_y(&all)? } else { None },
    );
    let own_legends = own_legends(figure.legend, &all);
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

/// Whether charts have a legend each: where one look means two things, and beside them also where no two have an entry in
/// common.
fn own_legends(legend: Legend, charts: &[&Chart]) -> bool {
    let all = Entries::of(charts.iter().copied());
    let counts = charts.iter().map(|chart| Entries::of(core::iter::once(*chart)).len());
    match legend {
        Legend::None => false,
        Legend::Below => !all.clear(),
        Legend::Right => !all.clear() || counts.sum::<usize>() == all.len(),
    }
}

/// (a), (b) ... (z), (aa) ...
pub(super) fn lettered(number: usize) -> String {
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
    pub(super) fn right(&self) -> f64 {
        match &self.content {
            Content::Plot(plot) => plot.right(),
            Content::Discs(_) => 0.0,
        }
    }

    pub(super) fn room(&self) -> Room {
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

    pub(super) fn draw(&self, canvas: &mut Canvas<'_>) -> Result<(), FigureError> {
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
