//! Ours: Table I with the paper's mesh alone, beside the same with the split force.

use super::clusters::{WINDOW, integral, quotient};
use super::{Built, drawn, time_axis};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Style};
use crate::figures::{Figure, Legend, Panel};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, REACHES, THRESHOLD, side};
use crate::reproduce::evidence::{Evidence, FinishedRun, curves};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::statistics::{Curve, Curves, average, maximum};

/// A number read off a curve.
type Read<'a> = &'a dyn Fn(&Curve) -> Option<f64>;

/// n_c, S and the largest cluster by both.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let area = side(evidence.size) * side(evidence.size);
    let sets = [
        ("split force (P³M), error 10^{-3}", evidence.reach(&REACHES[4]), Colour::Category(0)),
        ("mesh alone, as the paper", evidence.of(Campaign::PaperMesh), Colour::Category(1)),
    ];
    let charts = [
        ("clusters", Axis::linear("n_c / L^2", "10^{-3} R_0^{-2}"), 1e-3 * area),
        ("mean_cluster_size", Axis::log("S", ""), 1.0),
        ("largest_cluster", Axis::linear("largest cluster", "discs"), 1.0),
    ];
    let mut panels = Vec::new();
    for (column, axis, unit) in charts {
        let mut chart = Chart::new("", time_axis(), axis);
        for (index, (label, runs, colour)) in sets.iter().enumerate() {
            if let Some(found) = some(runs, Series::Observables, column, None)? {
                let found = if column == "mean_cluster_size" { found.without_zeros() } else { found };
                chart.series.push(drawn(label, *colour, Style::Band(Dash::numbered(index)), &found, unit));
            }
        }
        panels.push(Panel::Chart(chart));
    }
    let caption = "Table I (λ/L = 0.54) by the split force and by the paper's mesh of spacing 0.98 R0 with triangular shaped clouds.";
    let figure = Figure { legend: Legend::Below, ..Figure::new("", panels) };
    built.draw("meshes", caption, &figure)?;
    let [split, mesh] = [&sets[0].1, &sets[1].1];
    let both = |series, column, key| -> Result<[Option<Curves>; 2], ReproduceError> {
        Ok([some(mesh, series, column, key)?, some(split, series, column, key)?])
    };
    let clusters = both(Series::Observables, "clusters", None)?;
    let largest = both(Series::Observables, "largest_cluster", None)?;
    let lengths = both(Series::Minkowski, "pixel_length", Some(("threshold", THRESHOLD)))?;
    let peak = |curve: &Curve| maximum(curve, WINDOW);
    let findings: [(&str, &[_; 2], Read<'_>); 5] = [
        ("clusters over 0 to 5 T", &clusters, &|curve| integral(curve, 5.0)),
        ("most clusters", &clusters, &|curve| peak(curve).map(|(_, height)| height)),
        ("time of the most clusters", &clusters, &|curve| peak(curve).map(|(time, _)| time)),
        ("share of discs in the largest cluster at 5 T", &largest, &|curve| average(curve, 4.9, 5.1)),
        ("largest M1", &lengths, &|curve| peak(curve).map(|(_, height)| height)),
    ];
    for (what, [of_mesh, of_split], read) in findings {
        let quantity = format!("{what}, mesh alone over split force");
        let paper = "(ours) mesh alone and split force agree";
        let same = Criterion::equals(1.0, 0.05).with_errors(2.0, 0.05).ours();
        built.findings.push(Finding::new(quantity, paper, same).measured(quotient(of_mesh, of_split, read)));
    }
    built
        .notes
        .push("Quotients are of the runs whose seeds both have: they begin with the same discs.".to_owned());
    Ok(built)
}

fn some(
    runs: &[&FinishedRun],
    series: Series,
    column: &str,
    key: Option<(&str, f64)>,
) -> Result<Option<Curves>, ReproduceError> {
    if runs.is_empty() { Ok(None) } else { curves(runs, series, column, key).map(Some) }
}
