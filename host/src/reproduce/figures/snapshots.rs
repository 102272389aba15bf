//! Figs. 3 and 4: where the discs are after 1, 3 and 5 T, those in clusters red.

use super::{Built, discs, looks, of_reach};
use crate::figures::{Discs, Figure};
use crate::files::trajectory::Recorded;
use crate::observables::clusters::Clusters;
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, Reach};
use crate::reproduce::evidence::{Evidence, FinishedRun};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::statistics::{average, reaches};
use crate::simulation::torus;
use crate::statistics::Estimate;

/// Times of the figures, T.
const TIMES: [f64; 3] = [1.0, 3.0, 5.0];

/// λ/L of Fig. 3; Fig. 5 has one more.
const SHORT: [f64; 3] = [0.02, 0.05, 0.1];

/// The share of discs at which a cluster is larger than all others together.
const HALF: f64 = 0.5;

/// The share of discs that is "almost all" and "basically all".
const ALMOST_ALL: f64 = 0.9;

/// Fig. 3, or Fig. 4.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence, short: bool) -> Result<Built, ReproduceError> {
    let (name, range) = if short { ("fig-3", "short-ranged") } else { ("fig-4", "long-ranged") };
    let mut built = Built::default();
    let reaches: Vec<Reach> = looks(short)
        .into_iter()
        .map(|look| look.reach)
        .filter(|reach| !short || SHORT.contains(&reach.paper))
        .collect();
    let (mut rows, mut pictures, mut seeds) = (Vec::new(), Vec::new(), Vec::new());
    for reach in &reaches {
        let frames = first_frames(&evidence.reach(reach))?;
        if let Some((run, frames)) = frames {
            rows.push(reach.label(evidence.size));
            seeds.push(run.configuration.seed.to_string());
            for frame in frames {
                pictures.push(panel(run, frame)?);
            }
        }
    }
    let columns = TIMES.map(|time| format!("t = {time} T"));
    if !pictures.is_empty() {
        let figure = Figure::disc_grid("", &columns, &rows, pictures);
        let caption = format!(
            "Discs at T, 3 T and 5 T, {range} attraction; red: discs in clusters. Seeds of the runs, from the top: {}.",
            seeds.join(", ")
        );
        built.draw(name, &caption, &figure)?;
    }
    built.findings = if short { slow(evidence, &reaches)? } else { fast(evidence, &reaches)? };
    if !short {
        built.notes.push(
            "What lasts longest is the merging of the last few clusters, and it scatters most from run to run. Whether it is a matter of \
             how forces are summed is told in the last section: how large the largest cluster is with the paper's mesh."
                .to_owned(),
        );
    }
    Ok(built)
}

/// The first run and its frames at the times of the figures, if it has them all.
fn first_frames<'a>(
    runs: &[&'a FinishedRun],
) -> Result<Option<(&'a FinishedRun, Vec<Recorded>)>, ReproduceError> {
    let Some(&run) = runs.first() else { return Ok(None) };
    let frames: Vec<Recorded> = TIMES
        .iter()
        .map(|&time| run.frame(time))
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .flatten()
        .collect();
    Ok((frames.len() == TIMES.len()).then_some((run, frames)))
}

fn panel(run: &FinishedRun, frame: Recorded) -> Result<Discs, ReproduceError> {
    let torus = torus(&run.configuration)?;
    let positions = frame.state.positions;
    let clusters = Clusters::find(&torus, &positions);
    let clustered = (0..positions.len()).map(|id| clusters.clustered(id)).collect();
    Ok(Discs { torus, positions, clustered, caption: String::new() })
}

/// Short-ranged: far from a single cluster at 5 T.
fn slow(evidence: &Evidence, reaches: &[Reach]) -> Result<Vec<Finding>, ReproduceError> {
    let mut findings = Vec::new();
    for reach in reaches {
        let share = largest_share(evidence, reach, |curve| average(curve, 4.9, 5.1))?;
        let criterion = Criterion::at_most(0.5).with_errors(2.0, 0.1).ours();
        let quantity =
            format!("share of discs in the largest cluster at 5 T, {}", reach.label(evidence.size));
        findings.push(
            Finding::new(quantity, "evolution much slower than T: many clusters at 5 T", criterion)
                .measured(share),
        );
    }
    Ok(findings)
}

/// Long-ranged: a single cluster at 5 T, for λ/L = 10 between 3 T and 4 T.
fn fast(evidence: &Evidence, reaches_of_figure: &[Reach]) -> Result<Vec<Finding>, ReproduceError> {
    let mut findings = Vec::new();
    for reach in reaches_of_figure {
        let share = largest_share(evidence, reach, |curve| average(curve, 4.9, 5.1))?;
        let criterion = Criterion::at_least(ALMOST_ALL).with_errors(2.0, 0.1).ours();
        let quantity =
            format!("share of discs in the largest cluster at 5 T, {}", reach.label(evidence.size));
        findings.push(
            Finding::new(quantity, "a single cluster with basically all colloids at 5 T", criterion)
                .measured(share),
        );
    }
    if let Some(longest) = reaches_of_figure.last() {
        let paper = "almost all particles collapse into a single cluster between 3 T and 4 T";
        for (part, words) in [(HALF, "half"), (ALMOST_ALL, "90 %")] {
            let time = largest_share(evidence, longest, |curve| reaches(curve, part))?;
            let quantity = format!(
                "time at which the largest cluster has {words} of the discs, {} (T)",
                longest.label(evidence.size)
            );
            findings.push(Finding::new(quantity, paper, Criterion::between(3.0, 4.0).ours()).measured(time));
        }
    }
    Ok(findings)
}

/// Something read off the share of discs in the largest cluster in time.
fn largest_share(
    evidence: &Evidence,
    reach: &Reach,
    read: impl Fn(&[(f64, f64)]) -> Option<f64>,
) -> Result<Option<Estimate>, ReproduceError> {
    let count = discs(&evidence.of(Campaign::Clustering));
    let curves = of_reach(evidence, reach, Series::Observables, "largest_cluster", None)?;
    let shares = |curve: &Vec<(f64, f64)>| -> Vec<(f64, f64)> {
        curve.iter().map(|(time, size)| (*time, size / count)).collect()
    };
    Ok(curves.and_then(|curves| curves.jackknife(|curve| read(&shares(curve)))))
}
