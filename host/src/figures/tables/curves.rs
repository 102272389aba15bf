//! Curves out of the columns of tables.

use super::groups::Group;
use crate::figures::axis::Axis;
use crate::figures::chart::{Colour, Dash, Marker, Point, Series, Style};
use crate::files::FormatError;
use crate::files::table::Table;

/// The most points that have markers.
const MOST_MARKERS: usize = 45;

/// The column that numbers the times of a table, and tells rows of one time from those of others.
pub(super) fn time_key(table: &Table) -> &'static str {
    if table.column("bin").is_some() { "bin" } else { "step" }
}

/// Whether times are in Jeans' times: some systems have none.
fn over_jeans(table: &Table) -> bool {
    let Some(column) = table.column("time_over_jeans") else { return false };
    (0..table.len()).any(|row| !table.cell(row, column).is_empty())
}

/// The times of the rows.
pub(super) fn times(table: &Table) -> Result<Vec<Option<f64>>, FormatError> {
    table.numbers(if over_jeans(table) { "time_over_jeans" } else { "time" })
}

/// The axis of times.
pub(super) fn time_axis(groups: &[Group]) -> Axis {
    let jeans = groups.iter().all(|group| over_jeans(&group.table));
    Axis::linear("t", if jeans { "T" } else { "(R_0^2/D)" })
}

/// The numbers of a column times `factor` over `abscissas`, with their errors if the table has them. A point without a
/// value breaks a line.
pub(super) fn points(
    table: &Table,
    abscissas: &[Option<f64>],
    column: &str,
    factor: f64,
) -> Result<Vec<Point>, FormatError> {
    let values = table.numbers(column)?;
    let error_column = format!("{column}_error");
    let errors = match table.column(&error_column) {
        Some(_) => table.numbers(&error_column)?,
        None => vec![None; values.len()],
    };
    let point = |((x, y), error): ((&Option<f64>, Option<f64>), Option<f64>)| Point {
        x: x.unwrap_or(f64::NAN),
        y: y.map_or(f64::NAN, |y| y * factor),
        error: error.map(|error| error * factor.abs()),
    };
    Ok(abscissas.iter().zip(values).zip(errors).map(point).collect())
}

/// A curve of measured points: markers if there are few, else a line, in a band if there are errors.
pub(super) fn curve(label: &str, colour: Colour, number: usize, points: Vec<Point>) -> Series {
    let style = if points.len() <= MOST_MARKERS {
        Style::PointsAndLine(Marker::numbered(number), Dash::Solid)
    } else if points.iter().any(|point| point.error.is_some()) {
        Style::Band(Dash::numbered(number / 8))
    } else {
        Style::Line(Dash::Solid)
    };
    Series::styled(label, colour, style, points)
}

/// A column over time.
pub(super) fn over_time(
    group: &Group,
    table: &Table,
    column: &str,
    factor: f64,
    label: &str,
) -> Result<Series, FormatError> {
    let points = points(table, &times(table)?, column, factor)?;
    Ok(curve(label, group.colour, group.number, points))
}

/// At most `most` of the texts, evenly from the first to the last.
pub(super) fn some<'a>(all: &[&'a str], most: usize) -> Vec<&'a str> {
    let count = all.len().min(most);
    let place = |number: usize| number * (all.len() - 1) / (count - 1).max(1);
    (0..count).filter_map(|number| all.get(place(number)).copied()).collect()
}
