//! Ours: the potential energy in time. Cold discs run downhill in it: Σ v·F = Σ F² > 0.

use super::{Built, drawn, looks, time_axis};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series as Drawn};
use crate::figures::{Figure, Panel};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, REACHES};
use crate::reproduce::evidence::{Evidence, FinishedRun, curves_of};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::statistics::{Curves, Row, average};
use crate::statistics::Estimate;

/// Energy per disc in time, and how far that of cold rings ever rises.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let axis = || Axis::linear("[E(t) − E(0)] / N", "k_BT");
    let mut panels = Vec::new();
    for (short, title) in [(true, "short-ranged"), (false, "long-ranged")] {
        let mut chart = Chart::new(title, time_axis(), axis());
        for look in looks(short) {
            if let Some(curves) = change(&evidence.reach(&look.reach))? {
                chart.series.push(drawn(
                    &look.reach.label(evidence.size),
                    look.colour,
                    look.style,
                    &curves,
                    1.0,
                ));
            }
        }
        panels.push(Panel::Chart(chart));
    }
    let rings = evidence.of(Campaign::Rings);
    let mut chart = Chart::new("cold rings", time_axis(), axis());
    for (index, run) in rings.iter().enumerate() {
        let points = points(run)?;
        let first = points.first().map_or(0.0, |point| point.1);
        let colour = Colour::ordered(index, rings.len());
        let label = super::collapse::ring_label(run.length());
        let since_start = points.iter().map(|(time, energy)| (*time, energy - first));
        chart.series.push(Drawn::line(&label, colour, Dash::numbered(index), since_start));
        let quantity =
            format!("largest rise of the energy between rows up to 0.9 T over its whole fall, {label}");
        let criterion = Criterion::at_most(1e-6).ours();
        let finding = Finding::new(quantity, "(ours) cold discs run downhill", criterion);
        built.findings.push(finding.measured(rise(&points)));
    }
    panels.push(Panel::Chart(chart));
    built.notes.push(
        "Once discs touch, steps of up to R0/4 overshoot now and then, and the energy of a cold cluster jitters by some 1e-3 of what it has \
         fallen; this is Euler's method, and the paper's."
            .to_owned(),
    );
    let caption = "Potential energy per disc, capillary and repulsive, since the start.";
    built.draw("energy", caption, &Figure { columns: 2, ..Figure::new("", panels) })?;
    for reach in &REACHES {
        let fallen = change(&evidence.reach(reach))?
            .and_then(|curves| curves.jackknife(|curve| average(curve, 4.9, 5.1)));
        let quantity = format!("change of the energy per disc by 5 T, {} (kBT)", reach.label(evidence.size));
        let paper = "(ours) attraction wins";
        let criterion = Criterion::at_most(0.0).with_errors(2.0, 0.1).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(fallen));
    }
    Ok(built)
}

/// Energy per disc since time zero.
fn change(runs: &[&FinishedRun]) -> Result<Option<Curves>, ReproduceError> {
    if runs.is_empty() {
        return Ok(None);
    }
    let since_start = |run: &FinishedRun| {
        let mut rows = energies(run)?;
        let start = rows.iter().find(|row| row.bin == 0).and_then(|row| row.value);
        let Some(first) = start else { return Ok(Vec::new()) };
        rows.iter_mut().for_each(|row| row.value = row.value.map(|energy| energy - first));
        Ok(rows)
    };
    curves_of(runs, since_start).map(Some)
}

/// Energy per disc, kBT.
fn energies(run: &FinishedRun) -> Result<Vec<Row>, ReproduceError> {
    let count = run.configuration.system.particles as f64;
    let capillary = run.rows(Series::Observables, "capillary_energy", None)?;
    let repulsive = run.rows(Series::Observables, "repulsive_energy", None)?;
    // Of one table, row by row.
    let both = capillary.into_iter().zip(repulsive);
    Ok(both
        .filter_map(|(first, second)| {
            Some(Row { value: Some((first.value? + second.value?) / count), ..first })
        })
        .collect())
}

/// Time and energy per disc, kBT.
fn points(run: &FinishedRun) -> Result<Vec<(f64, f64)>, ReproduceError> {
    Ok(energies(run)?.into_iter().filter_map(|row| Some((row.time, row.value?))).collect())
}

/// The largest rise between two rows before discs touch, of the whole fall.
fn rise(points: &[(f64, f64)]) -> Option<Estimate> {
    let (first, last) = (points.first()?.1, points.last()?.1);
    let before = points.iter().take_while(|(time, _)| *time <= 0.9).count();
    let steps = points.get(..before)?.windows(2).filter_map(|pair| Some(pair.last()?.1 - pair.first()?.1));
    let largest = steps.fold(0.0, f64::max);
    (first > last).then(|| Estimate::exact(largest / (first - last)))
}
