//! Charts: series of points and lines over two axes, said but not drawn.
//!
//! ```
//! use meniscus::figures::axis::Axis;
//! use meniscus::figures::chart::{Chart, Colour, Dash, Marker, Series};
//!
//! let mut chart = Chart::new("decay", Axis::linear("t", "T"), Axis::log("n_c / L^2", "R_0^{-2}"));
//! let measured = [(0.0, 1.0, 0.1), (1.0, 0.37, 0.05)];
//! chart.series.push(Series::points("measured", Colour::Category(0), Marker::Circle, measured));
//! let theory = (0..50).map(|n| f64::from(n) / 49.0).map(|t| (t, libm::exp(-t)));
//! chart.series.push(Series::line("theory", Colour::Black, Dash::Dashed, theory));
//! assert_eq!(chart.series[0].points[0].error, Some(0.1));
//! ```

use super::axis::Axis;

/// Series over a pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Stands above it, after its letter; may be empty.
    pub title: String,
    /// The axis from left to right.
    pub x: Axis,
    /// The axis from below to above.
    pub y: Axis,
    /// What is drawn, later series over earlier ones.
    pub series: Vec<Series>,
    /// Stands below it in small letters; may be empty.
    pub note: String,
}

impl Chart {
    /// A chart without series.
    #[must_use]
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self { title: title.to_owned(), x, y, series: Vec::new(), note: String::new() }
    }

    /// The chart with one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend says; a series without a label is not in the legend.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// How its points are drawn.
    pub style: Style,
    /// The points, in the order in which a line joins them. A line is broken at one that has no place.
    pub points: Vec<Point>,
}

impl Series {
    /// Markers with error bars.
    #[must_use]
    pub fn points<P: Into<Point>>(
        label: &str,
        colour: Colour,
        marker: Marker,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        Self::styled(label, colour, Style::Points(marker), points)
    }

    /// A line without markers or error bars.
    #[must_use]
    pub fn line<P: Into<Point>>(
        label: &str,
        colour: Colour,
        dash: Dash,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        Self::styled(label, colour, Style::Line(dash), points)
    }

    /// Markers with error bars, joined by a thin line.
    #[must_use]
    pub fn joined<P: Into<Point>>(
        label: &str,
        colour: Colour,
        marker: Marker,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        Self::styled(label, colour, Style::PointsAndLine(marker, Dash::Solid), points)
    }

    /// A line in a band as wide as the errors: for more points than markers can show.
    #[must_use]
    pub fn band<P: Into<Point>>(label: &str, colour: Colour, points: impl IntoIterator<Item = P>) -> Self {
        Self::styled(label, colour, Style::Band(Dash::Solid), points)
    }

    /// A series of any style.
    #[must_use]
    pub fn styled<P: Into<Point>>(
        label: &str,
        colour: Colour,
        style: Style,
        points: impl IntoIterator<Item = P>,
    ) -> Self {
        Self { label: label.to_owned(), colour, style, points: points.into_iter().map(Into::into).collect() }
    }
}

/// A point of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Along the axis from left to right.
    pub x: f64,
    /// Along the axis from below to above.
    pub y: f64,
    /// Standard error of `y`: half the length of its bar.
    pub error: Option<f64>,
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self { x, y, error: None }
    }
}

impl From<(f64, f64, f64)> for Point {
    fn from((x, y, error): (f64, f64, f64)) -> Self {
        Self { x, y, error: Some(error) }
    }
}

impl From<(f64, f64, Option<f64>)> for Point {
    fn from((x, y, error): (f64, f64, Option<f64>)) -> Self {
        Self { x, y, error }
    }
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Markers with error bars.
    Points(Marker),
    /// A line.
    Line(Dash),
    /// Markers with error bars, and a thin line.
    PointsAndLine(Marker, Dash),
    /// A line in a pale band of the errors.
    Band(Dash),
}

/// What a point looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the shapes' names say what they are")]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
    InvertedTriangle,
    Plus,
    OpenCircle,
    OpenSquare,
    OpenTriangle,
}

impl Marker {
    /// All of them, in the order in which they are best taken.
    pub const ALL: [Self; 10] = [
        Self::Circle,
        Self::Square,
        Self::Triangle,
        Self::Diamond,
        Self::Cross,
        Self::InvertedTriangle,
        Self::Plus,
        Self::OpenCircle,
        Self::OpenSquare,
        Self::OpenTriangle,
    ];

    /// The marker of a number, round and round.
    #[must_use]
    pub fn numbered(number: usize) -> Self {
        Self::ALL.get(number % Self::ALL.len()).copied().unwrap_or(Self::Circle)
    }
}

/// How a line is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the patterns' names say what they are")]
pub enum Dash {
    Solid,
    Dashed,
    Dotted,
    DashDotted,
}

impl Dash {
    /// All of them, in the order in which they are best taken.
    pub const ALL: [Self; 4] = [Self::Solid, Self::Dashed, Self::Dotted, Self::DashDotted];

    /// The pattern of a number, round and round.
    #[must_use]
    pub fn numbered(number: usize) -> Self {
        Self::ALL.get(number % Self::ALL.len()).copied().unwrap_or(Self::Solid)
    }
}

/// A colour by what it is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Colour {
    /// One of the eight of Okabe and Ito, round and round: for kinds that have no order.
    Category(usize),
    /// From dark (0) to bright (1) along viridis: for values that have an order.
    Ordered(f64),
    /// Black: for theory, or a single series.
    Black,
    /// Grey: for what stands behind.
    Grey,
}

impl Colour {
    /// The colour of place `number` among `count` ordered values.
    #[must_use]
    pub fn ordered(number: usize, count: usize) -> Self {
        Self::Ordered(number as f64 / (count.max(2) - 1) as f64)
    }
}
