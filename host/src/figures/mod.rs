//! Figures: charts and pictures of discs in a grid, as SVG and PNG.
//!
//! A [`Figure`] says what is to be seen; [`Figure::svg`] lays it out and draws it, [`Figure::png`] makes
//! pixels of that. The legend stands outside of the plotting areas, text stays text (DejaVu Sans, which the
//! program carries), and the same figure gives the same SVG, byte for byte, everywhere.
//!
//! In texts, `_c` and `_{ab}` are set lower, `^2` and `^{-2}` higher, and `\_` and `\^` are the signs
//! themselves.
//!
//! ```
//! use meniscus::figures::axis::Axis;
//! use meniscus::figures::chart::{Chart, Colour, Marker, Series};
//! use meniscus::figures::{Figure, Panel};
//!
//! let points = [(0.0, 1.0, 0.1), (1.0, 4.0, 0.2)];
//! let chart = Chart::new("", Axis::linear("t", "T"), Axis::linear("n_c / L^2", "R_0^{-2}"))
//!     .with(Series::points("λ/L = 0.54", Colour::Category(0), Marker::Circle, points));
//! let figure = Figure::new("Clusters", [Panel::Chart(chart)]);
//! let folder = tempfile::tempdir().unwrap();
//! figure.write(&folder.path().join("clusters")).unwrap();
//! assert!(folder.path().join("clusters.svg").exists() && folder.path().join("clusters.png").exists());
//! ```

pub mod axis;
mod canvas;
pub mod chart;
mod clip;
mod discs;
mod error;
pub(crate) mod font;
mod layout;
mod legend;
mod lettering;
mod marks;
pub mod palette;
mod plotting;
mod raster;
pub mod tables;
#[cfg(test)]
mod tests;
pub(crate) mod ticks;

pub use discs::Discs;
pub use error::FigureError;
pub(crate) use raster::png;

use crate::files::atomic::write_atomically;
use chart::Chart;
use std::path::Path;

/// Charts and pictures in a grid, with one legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Stands above all; may be empty.
    pub title: String,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// How many panels are in a row; at least one.
    pub columns: usize,
    /// Stand above the columns; may be empty.
    pub column_headers: Vec<String>,
    /// Stand left of the rows; may be empty.
    pub row_headers: Vec<String>,
    /// Whether all charts have the same ends of x, so that only the lowest say them.
    pub common_x: bool,
    /// Whether all charts have the same ends of y, so that only the leftmost say them.
    pub common_y: bool,
    /// Whether panels are called (a), (b) ...
    pub lettered: bool,
    /// Where the legend stands.
    pub legend: Legend,
    /// Width of a panel's plotting area, pixels.
    pub panel_width: f64,
    /// Height of a chart's plotting area, pixels. A picture of discs is as high as it is wide.
    pub panel_height: f64,
}

/// A part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Panel {
    /// Series over axes.
    Chart(Chart),
    /// A box with its discs.
    Discs(Discs),
}

/// Where a legend stands, always outside of the plotting areas.
///
/// It is one for all panels, unless the same look means different things in them: then each has its own. Beside them, each
/// has its own also where no two panels have an entry in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// On the right.
    Right,
    /// Below.
    Below,
    /// Nowhere.
    None,
}

/// Pixels of a PNG along one pixel of the figure's measures: sharp on a page 17 cm wide.
pub const PNG_SCALE: u32 = 2;

impl Figure {
    /// A figure of panels side by side, in rows of up to three; more than one are lettered. A single panel
    /// is larger.
    #[must_use]
    pub fn new(title: &str, panels: impl IntoIterator<Item = Panel>) -> Self {
        let panels: Vec<Panel> = panels.into_iter().collect();
        let (single, columns) =
            (panels.len() == 1, if panels.len() == 4 { 2 } else { panels.len().clamp(1, 3) });
        let (panel_width, panel_height) = if single { (480.0, 340.0) } else { (320.0, 240.0) };
        Self {
            title: title.to_owned(),
            panels,
            columns,
            column_headers: Vec::new(),
            row_headers: Vec::new(),
            common_x: false,
            common_y: false,
            lettered: !single,
            legend: Legend::Right,
            panel_width,
            panel_height,
        }
    }

    /// A grid of pictures of discs, `columns.len()` in a row, with headers for columns and rows.
    #[must_use]
    pub fn disc_grid(title: &str, columns: &[String], rows: &[String], discs: Vec<Discs>) -> Self {
        Self {
            columns: columns.len().max(1),
            column_headers: columns.to_vec(),
            row_headers: rows.to_vec(),
            lettered: false,
            panel_width: 200.0,
            ..Self::new(title, discs.into_iter().map(Panel::Discs))
        }
    }

    /// The figure as SVG.
    ///
    /// # Errors
    /// [`FigureError`]: no panels, a range that cannot be, or a size beyond what is drawn.
    pub fn svg(&self) -> Result<String, FigureError> {
        layout::Layout::new(self)?.svg()
    }

    /// The figure as PNG, [`PNG_SCALE`] pixels for each of its measures.
    ///
    /// # Errors
    /// [`FigureError`], as [`Self::svg`].
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.svg()?)
    }

    /// Writes the figure to `stem` with the endings `.svg` and `.png`.
    ///
    /// # Errors
    /// [`FigureError`]; a file that could not be written is as it was.
    pub fn write(&self, stem: &Path) -> Result<(), FigureError> {
        let svg = self.svg()?;
        let png = raster::png(&svg)?;
        let ending = |ending: &str| {
            let mut path = stem.as_os_str().to_owned();
            path.push(ending);
            path
        };
        write_atomically(Path::new(&ending(".svg")), svg.as_bytes())?;
        Ok(write_atomically(Path::new(&ending(".png")), &png)?)
    }
}
