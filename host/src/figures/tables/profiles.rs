//! Pair distributions and structure factors at a few times.

use super::Named;
use super::curves::{points, some, time_key, times};
use super::groups::{Group, rounded};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series, Style};
use crate::figures::{Figure, Panel};
use crate::files::FormatError;

/// The most times that are drawn.
const MOST_TIMES: usize = 6;

/// The figure of `radial_distribution.csv`.
pub(super) fn radial_distribution(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let axes = (Axis::linear("r", "R_0"), Axis::linear("g(r)", ""));
    profiles("radial_distribution", "Pair distribution", groups, ("distance", "g"), axes)
}

/// The figure of `structure_factor.csv`.
pub(super) fn structure_factor(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let axes = (Axis::log("k", "R_0^{-1}"), Axis::log("S(k)", ""));
    profiles("structure_factor", "Structure factor", groups, ("wavenumber", "structure_factor"), axes)
}

/// A panel for each group, with a curve for each of a few times.
fn profiles(
    name: &str,
    title: &str,
    groups: &[Group],
    (key, column): (&str, &str),
    (x, y): (Axis, Axis),
) -> Result<Vec<Named>, FormatError> {
    let mut panels = Vec::with_capacity(groups.len());
    for group in groups {
        let mut chart = Chart::new(&group.label, x.clone(), y.clone());
        let moments = some(&group.table.distinct(time_key(&group.table))?, MOST_TIMES);
        for (number, moment) in moments.iter().enumerate() {
            let table = group.table.with(time_key(&group.table), moment)?;
            let time = times(&table)?.into_iter().flatten().next().unwrap_or(0.0);
            let jeans =
                table.column("time_over_jeans").is_some_and(|column| !table.cell(0, column).is_empty());
            let unit = if jeans { "T" } else { "R_0^2/D" };
            let label = format!("t = {} {unit}", rounded(time));
            let points = points(&table, &table.numbers(key)?, column, 1.0)?;
            let errors = points.iter().any(|point| point.error.is_some());
            let style = if errors { Style::Band(Dash::Solid) } else { Style::Line(Dash::Solid) };
            chart.series.push(Series::styled(&label, Colour::ordered(number, moments.len()), style, points));
        }
        panels.push(Panel::Chart(chart));
    }
    let mut figure = Figure::new(title, panels);
    figure.common_x = true;
    Ok(vec![(name.to_owned(), figure)])
}
