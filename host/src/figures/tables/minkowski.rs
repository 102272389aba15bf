//! Minkowski functionals of the dense regions (Figs. 7 to 11).

use super::Named;
use super::curves::{curve, over_time, time_axis};
use super::groups::{Group, rounded};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour};
use crate::figures::{Figure, Panel};
use crate::files::FormatError;

/// Names of the columns' beginnings, and what figures and their titles are called.
const METHODS: [(&str, &str, &str); 2] = [
    ("", "minkowski", "Minkowski functionals, by contours"),
    ("pixel_", "minkowski_pixels", "Minkowski functionals, by pixels"),
];

/// The figures of `minkowski.csv`: by contours, and by pixels as in the paper. An ensemble with several thresholds has
/// one for each of them.
pub(super) fn figures(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let mut thresholds: Vec<&str> = Vec::new();
    for group in groups {
        for threshold in group.table.distinct("threshold")? {
            if !thresholds.contains(&threshold) {
                thresholds.push(threshold);
            }
        }
    }
    let mut figures = Vec::new();
    for (beginning, name, title) in METHODS {
        if groups.len() == 1 {
            figures.push((name.to_owned(), figure(groups, &thresholds, beginning, title)?));
            continue;
        }
        for threshold in &thresholds {
            let name = if thresholds.len() == 1 { name.to_owned() } else { format!("{name}_{threshold}") };
            let title = format!("{title}, ρ_c = {} ρ_m", number(threshold));
            figures.push((name, figure(groups, &[threshold], beginning, &title)?));
        }
    }
    Ok(figures)
}

/// A threshold in few digits.
fn number(threshold: &str) -> String {
    threshold.parse().map_or_else(|_| threshold.to_owned(), rounded)
}

fn figure(
    groups: &[Group],
    thresholds: &[&str],
    beginning: &str,
    title: &str,
) -> Result<Figure, FormatError> {
    let known = groups.iter().all(|group| group.configuration.is_some());
    let area = if known { Axis::linear("M_0 / L^2", "") } else { Axis::linear("M_0", "R_0^2") };
    let length = if known { Axis::linear("M_1 R_0 / L^2", "") } else { Axis::linear("M_1", "R_0") };
    let euler = if known { Axis::linear("M_2 R_0^2 / L^2", "") } else { Axis::linear("M_2", "") };
    let quantities = [
        ("area", "area", area, known),
        ("length", "boundary length", length, known),
        ("euler", "Euler characteristic", euler, known),
        ("shape", "shape", Axis::linear("ϕ = M_1^2 / (4π M_0 M_2)", ""), false),
    ];
    let mut panels = Vec::new();
    for (column, title, y, per_area) in quantities {
        let mut chart = Chart::new(title, time_axis(groups), y);
        for group in groups {
            let side = group.configuration.as_ref().map_or(1.0, |configuration| configuration.system.side);
            let factor = if per_area { 1.0 / (side * side) } else { 1.0 };
            for (number, threshold) in thresholds.iter().enumerate() {
                let table = group.table.with("threshold", threshold)?;
                let mut series =
                    over_time(group, &table, &format!("{beginning}{column}"), factor, &group.label)?;
                if groups.len() == 1 {
                    let label = format!("ρ_c = {} ρ_m", self::number(threshold));
                    let colour = Colour::ordered(number, thresholds.len());
                    series = curve(&label, colour, number, series.points);
                }
                chart.series.push(series);
            }
        }
        panels.push(Panel::Chart(chart));
    }
    Ok(Figure::new(title, panels))
}
