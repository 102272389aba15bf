//! Growth of density modes by shells of wavenumbers, with Eq. 10 (Fig. 2).

use super::Named;
use super::curves::{curve, points, time_axis, times};
use super::groups::{Group, rounded};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series};
use crate::figures::{Figure, Panel};
use crate::files::FormatError;

/// The most shells that are drawn: the slowest waves.
const MOST_SHELLS: usize = 7;

/// The figure of `modes.csv`: a panel for each group.
pub(super) fn figures(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let panels = groups.iter().map(|group| chart(group).map(Panel::Chart)).collect::<Result<Vec<_>, _>>()?;
    let mut figure = Figure::new("Growth of density modes", panels);
    (figure.common_x, figure.common_y) = (true, true);
    Ok(vec![("modes".to_owned(), figure)])
}

fn chart(group: &Group) -> Result<Chart, FormatError> {
    let y = Axis::linear("⟨ln |ρ_k(t)|/|ρ_k(0)|⟩", "");
    let mut chart = Chart::new(&group.label, time_axis(std::slice::from_ref(group)), y);
    let mut shells = group.table.distinct("shell")?;
    shells.truncate(MOST_SHELLS);
    let instability = group.configuration.as_ref().and_then(crate::configuration::Configuration::instability);
    let (mut lines, mut extremes) = (Vec::new(), (f64::INFINITY, f64::NEG_INFINITY));
    for (number, shell) in shells.iter().enumerate() {
        let table = group.table.with("shell", shell)?;
        let wavenumber = table.numbers("wavenumber")?.into_iter().flatten().next();
        let times = times(&table)?;
        let points = points(&table, &times, "log_growth", 1.0)?;
        for point in points.iter().filter(|point| point.y.is_finite()) {
            extremes = (extremes.0.min(point.y), extremes.1.max(point.y));
        }
        let colour = Colour::ordered(number, shells.len());
        let label = match (wavenumber, &instability) {
            (Some(k), Some(instability)) => format!("k/K = {}", rounded(k / instability.jeans_wavenumber)),
            (Some(k), None) => format!("k = {} R_0^{{-1}}", rounded(k)),
            (None, _) => format!("shell {shell}"),
        };
        if let (Some(k), Some(instability)) = (wavenumber, &instability) {
            let rate = instability.growth_rate(k) * instability.jeans_time;
            lines.push((colour, rate, times.iter().flatten().copied().fold(0.0, f64::max)));
        }
        chart.series.push(curve(&label, colour, number, points));
    }
    for (number, (colour, rate, last)) in lines.into_iter().enumerate() {
        // Not far beyond what was measured, which saturates.
        let room = 0.3 * (extremes.1 - extremes.0);
        let end = if rate > 0.0 { (extremes.1 + room) / rate } else { (extremes.0 - room).min(0.0) / rate };
        let end = if end.is_finite() { end.clamp(0.0, last) } else { last };
        if number == 0 {
            chart.series.push(Series::line("Eq. 10", Colour::Black, Dash::Dashed, [(f64::NAN, f64::NAN)]));
        }
        chart.series.push(Series::line("", colour, Dash::Dashed, [(0.0, 0.0), (end, rate * end)]));
    }
    Ok(chart)
}
