//! Radii of collapsing rings or shells, with the closed form of cold collapse (Eq. 13; Figs. 12 to 14).

use super::Named;
use super::curves::{curve, points, some, time_axis, times};
use super::groups::{Group, rounded};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series};
use crate::figures::{Figure, Panel};
use crate::files::FormatError;
use crate::theory::cold_collapse_radius;

/// The most rings or shells that are drawn: all of Fig. 12.
const MOST_RINGS: usize = 9;

/// Points of a line of theory: the root at its end is steep.
const LINE_POINTS: u32 = 200;

/// The figure of `radii.csv`: a panel for each group of runs.
pub(super) fn figures(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let panels = groups.iter().map(|group| chart(group).map(Panel::Chart)).collect::<Result<Vec<_>, _>>()?;
    let mut figure = Figure::new("Collapse", panels);
    (figure.common_x, figure.common_y) = (true, true);
    Ok(vec![("radii".to_owned(), figure)])
}

fn chart(group: &Group) -> Result<Chart, FormatError> {
    let x = time_axis(std::slice::from_ref(group));
    // Eq. 13 is in Jeans' times.
    let theory = x.unit == "T";
    let mut chart = Chart::new(&group.label, x, Axis::linear("R(t)", "R_0"));
    let rings = some(&group.table.distinct("group")?, MOST_RINGS);
    for (number, ring) in rings.iter().enumerate() {
        let table = group.table.with("group", ring)?;
        let times = times(&table)?;
        let points = points(&table, &times, "radius", 1.0)?;
        let Some(initial) = table.numbers("initial_radius")?.into_iter().flatten().next() else { continue };
        let colour = Colour::ordered(number, rings.len());
        chart.series.push(curve(&format!("R(0) = {} R_0", rounded(initial)), colour, number, points));
        if theory {
            let last = times.iter().flatten().copied().fold(0.0, f64::max).min(1.0);
            let line = (0..=LINE_POINTS).map(|point| {
                let time = last * f64::from(point) / f64::from(LINE_POINTS);
                (time, cold_collapse_radius(initial, time))
            });
            chart.series.push(Series::line("", colour, Dash::Dashed, line));
        }
    }
    if theory && !chart.series.is_empty() {
        chart.series.push(Series::line("Eq. 13, λ → ∞", Colour::Black, Dash::Dashed, [(f64::NAN, f64::NAN)]));
    }
    Ok(chart)
}
