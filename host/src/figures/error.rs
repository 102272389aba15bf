//! Why a figure could not be made.

use crate::files::FileError;

/// Why a figure could not be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The font in the program is not usable.
    #[error("the built-in font cannot be used")]
    Font,
    /// There is nothing to draw.
    #[error("the figure {title:?} has no panels: give it at least one")]
    NoPanels {
        /// The figure's title.
        title: String,
    },
    /// A range of an axis that cannot be drawn.
    #[error(
        "the axis {label:?} has the range {from} to {to}: it needs two finite numbers, the smaller first, above zero if it is logarithmic"
    )]
    Range {
        /// The axis' label.
        label: String,
        /// Where the range begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// More pixels than a picture may have.
    #[error(
        "the figure {title:?} would be {width} x {height} pixels large, at most {most} a side are drawn: make its panels fewer or smaller"
    )]
    Size {
        /// The figure's title.
        title: String,
        /// Its width, pixels.
        width: f64,
        /// Its height, pixels.
        height: f64,
        /// The most of either.
        most: f64,
    },
    /// The drawing library refused.
    #[error("the figure cannot be drawn: {0}")]
    Drawing(String),
    /// The SVG could not be made a picture of pixels.
    #[error("the figure cannot be made a PNG: {0}")]
    Raster(String),
    /// The file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
}
