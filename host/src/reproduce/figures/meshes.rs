//! Ours: Table I with the paper's mesh alone, beside the same with the split force.

use super::clusters::{WINDOW, integral, quotient};
use super::{Built, drawn, time_axis};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Style};
use crate::figures::{Figure, Panel};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, REACHES, THRESHOLD, side};
use crate::reproduce::evidence::{Evidence, FinishedRun, curves};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::statistics::{Curves, maximum};

/// n_c, S and φ by both.
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
    built.draw("meshes", caption, &Figure::new("", panels))?;
    let [split, mesh] = [&sets[0].1, &sets[1].1];
    let clusters = [split, mesh].map(|runs| some(runs, Series::Observables, "clusters", None));
    let [of_split, of_mesh] = clusters;
    let (of_split, of_mesh) = (of_split?, of_mesh?);
    let same = || Criterion::equals(1.0, 0.05).with_errors(2.0, 0.05).ours();
    let paper = "(ours) mesh alone and split force agree";
    built.findings.push(
        Finding::new("clusters over 0 to 5 T, mesh alone over split force", paper, same())
            .measured(quotient(&of_mesh, &of_split, |curve| integral(curve, 5.0))),
    );
    built.findings.push(
        Finding::new("most clusters, mesh alone over split force", paper, same()).measured(quotient(
            &of_mesh,
            &of_split,
            |curve| maximum(curve, WINDOW).map(|peak| peak.1),
        )),
    );
    built.findings.push(
        Finding::new("time of the most clusters, mesh alone over split force", paper, same())
            .measured(quotient(&of_mesh, &of_split, |curve| maximum(curve, WINDOW).map(|peak| peak.0))),
    );
    let lengths = [split, mesh]
        .map(|runs| some(runs, Series::Minkowski, "pixel_length", Some(("threshold", THRESHOLD))));
    let [of_split, of_mesh] = lengths;
    let (of_split, of_mesh) = (of_split?, of_mesh?);
    built.findings.push(
        Finding::new("largest M1, mesh alone over split force", paper, same()).measured(quotient(
            &of_mesh,
            &of_split,
            |curve| maximum(curve, WINDOW).map(|peak| peak.1),
        )),
    );
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
