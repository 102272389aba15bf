//! Fig. 12: three rings of a cold patch.

use super::theory::{Surroundings, lines, of_ring};
use super::{
    DELAY, Printed, add, closest, delay, fitted, groups, largest_deviation, mean, picture, printed, radii,
};
use crate::configuration::Start;
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash};
use crate::figures::{Figure, Panel};
use crate::observables::collapse_fit::{Conditions, fit};
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Campaign;
use crate::reproduce::evidence::{Evidence, FinishedRun};
use crate::reproduce::figures::{Built, time_axis};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::with_error;
use crate::reproduce::statistics::Curve;
use crate::simulation::torus;
use crate::start;
use crate::statistics::Estimate;
use crate::theory::cold_collapse_radius;

/// From the top.
const RINGS: [Printed; 3] = [printed(135.0, 1.15, 18.0), printed(95.0, 1.16, 13.0), printed(58.0, 1.16, 8.0)];

/// λ, R0.
const LENGTH: f64 = 270.0;

/// Fig. 12.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let runs = evidence.with_length(Campaign::Rings, LENGTH);
    let mut built = Built::default();
    let mut chart = Chart::new("", time_axis(), Axis::linear("R", "R_0"));
    let groups = runs.first().map_or(Ok(Vec::new()), |run| groups(run))?;
    for (index, ring) in RINGS.iter().enumerate() {
        let Printed { initial, delay: expected, last } = *ring;
        let finding = |what: &str| {
            Finding::new(
                what,
                format!("{expected} with R_f = {last}"),
                Criterion::equals(expected, DELAY).ours(),
            )
        };
        let Some(group) = closest(&groups, initial) else {
            built.findings.push(finding(&format!("A0, R_i = {initial} R0")));
            continue;
        };
        let curves = radii(&runs, group)?;
        let label = format!("ring {}, R_i = {:.0} R_0", group.number, group.initial);
        add(&mut chart, &label, Colour::Category(index), index, &curves, last);
        let what =
            format!("A0 of ring {} (R_i = {:.1} R0), R_f = {last} R0 held", group.number, group.initial);
        built.findings.push(finding(&what).measured(delay(&curves, last)));
        let free =
            fit(&mean(&curves), &Conditions { initial_radius: Some(group.initial), ..Conditions::default() });
        if let Ok(free) = free {
            built.notes.push(format!(
                "Ring {}: with R_f free, A0 = {} and R_f = {} R0; with it held the residual is {:.2} R0 rms.",
                group.number,
                with_error(free.delay),
                with_error(free.final_radius),
                fitted(&mean(&curves), last).map_or(f64::NAN, |fit| fit.residual),
            ));
        }
    }
    let mut panels = Vec::new();
    if let Some(run) = runs.first() {
        let shown = RINGS.iter().filter_map(|ring| closest(&groups, ring.initial));
        let (mut shells, mut eq13) = (Vec::new(), Vec::new());
        for group in shown {
            let theory = of_ring(&run.configuration, group, Surroundings::Images).unwrap_or_default();
            let times = (0..=100).map(|step| 0.01 * f64::from(step));
            eq13.push(times.map(|time| (time, cold_collapse_radius(group.initial, time))).collect::<Curve>());
            let measured = mean(&radii(&runs, group)?);
            let deviation = largest_deviation(&measured, &theory, group.initial).map(Estimate::exact);
            let quantity =
                format!("largest |R − R of mean-field shells| / R_i up to 0.8 T, ring {}", group.number);
            let paper = "(ours) the theory holds until discs touch";
            built
                .findings
                .push(Finding::new(quantity, paper, Criterion::at_most(0.01).ours()).measured(deviation));
            shells.push(theory);
        }
        chart.series.extend(lines(&shells, "mean-field shells", Colour::Black, Dash::Dashed));
        chart.series.extend(lines(&eq13, "Eq. 13", Colour::Grey, Dash::Dotted));
        panels.extend(patch(run)?);
    }
    panels.insert(0, Panel::Chart(chart));
    let caption = "(a) Radii of rings in cold collapse, λ/R = 1.48: points measured, solid lines fits of Eq. 30 over 0 < t < 0.9 T with \
                   the paper's R_f, drawn up to A0·T, dashed: shells in mean-field theory with periodic images, dotted: Eq. 13. (b) The \
                   middle of the box at t = 0.";
    let mut figure = Figure::new("", panels);
    figure.panel_height = figure.panel_width;
    built.draw("fig-12", caption, &figure)?;
    Ok(built)
}

/// The patch at its start.
fn patch(run: &FinishedRun) -> Result<Option<Panel>, ReproduceError> {
    let Start::Rings { rings, spacing, per_ring } = run.configuration.start else { return Ok(None) };
    let Ok(positions) = start::rings(&torus(&run.configuration)?, rings, per_ring, spacing) else {
        return Ok(None);
    };
    let radius = spacing * f64::from(rings);
    picture(&run.configuration, &positions, radius, "t = 0").map(Some)
}
