//! Figs. 5 and 6: how many clusters there are, and how large they are on average.

use super::{Built, discs, drawn, looks, of_reach, time_axis};
use crate::figures::axis::Axis;
use crate::figures::chart::Chart;
use crate::figures::{Figure, Panel};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, REACHES, Reach};
use crate::reproduce::evidence::Evidence;
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::with_error;
use crate::reproduce::statistics::{Curve, Curves, average, line, maximum};
use crate::statistics::Estimate;

/// Over which times the position of a maximum is averaged, T.
pub(super) const WINDOW: f64 = 0.4;

/// How late an end still counts as early for the law of growth of S: a share of all discs.
const SATURATED: f64 = 0.1;

/// Until when clusters form and merge in the long-ranged limit, T.
const COLLAPSED: f64 = 5.0;

/// Fig. 5.
///
/// # Errors
/// [`ReproduceError`].
pub fn number(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let side = crate::reproduce::campaign::side(evidence.size);
    let mut panels = Vec::new();
    for (short, title) in [(true, "short-ranged"), (false, "long-ranged")] {
        let axis = Axis::linear("n_c / L^2", "10^{-3} R_0^{-2}");
        let mut chart = Chart::new(title, time_axis(), axis);
        for look in looks(short) {
            if let Some(curves) = of_reach(evidence, &look.reach, Series::Observables, "clusters", None)? {
                let label = look.reach.label(evidence.size);
                chart.series.push(drawn(&label, look.colour, look.style, &curves, 1e-3 * side * side));
            }
        }
        panels.push(Panel::Chart(chart));
    }
    let caption = "Number of clusters per area; bands: one standard error over runs.";
    built.draw("fig-5", caption, &Figure::new("", panels))?;
    let count = |reach: &Reach| of_reach(evidence, reach, Series::Observables, "clusters", None);
    for reach in REACHES.iter().filter(|reach| !reach.short) {
        let time = count(reach)?
            .and_then(|curves| curves.jackknife(|curve| maximum(curve, WINDOW).map(|peak| peak.0)));
        let quantity = format!("time of the most clusters, {} (T)", reach.label(evidence.size));
        let criterion = Criterion::equals(1.5, 0.25).ours();
        built.findings.push(Finding::new(quantity, "≈ 1.5", criterion).measured(time));
    }
    let longest = count(&REACHES[6])?;
    let over_longest = |reach: &Reach| -> Result<Option<Estimate>, ReproduceError> {
        Ok(quotient(&count(reach)?, &longest, |curve| integral(curve, COLLAPSED)))
    };
    let criterion = Criterion::equals(1.0, 0.05).with_errors(2.0, 0.05).ours();
    built.findings.push(
        Finding::new(
            "clusters over 0 to 5 T, λ/L = 3 over λ/L = 10",
            "a λ-independent limit as λ increases",
            criterion,
        )
        .measured(over_longest(&REACHES[5])?),
    );
    // The paper does not say that this one is long enough for the limit.
    if let Some(ratio) = over_longest(&REACHES[4])? {
        built.notes.push(format!("Clusters over 0 to 5 T, λ/L = 0.54 over λ/L = 10: {}.", with_error(ratio)));
    }
    let shortest = count(&REACHES[0])?;
    let growth = shortest.and_then(|curves| {
        curves.jackknife(|curve| Some(average(curve, 6.0, 7.1)? / average(curve, 3.0, 4.0)?))
    });
    let quantity =
        format!("clusters at 6 to 7 T over those at 3 to 4 T, {}", REACHES[0].label(evidence.size));
    let criterion = Criterion::at_least(1.0).with_errors(2.0, 0.05);
    built.findings.push(Finding::new(quantity, "steady increase of n_c", criterion).measured(growth));
    built.notes.push(
        "The time of a maximum is the vertex of a parabola fitted within 0.4 T of the largest mean over 0.4 T.".to_owned(),
    );
    Ok(built)
}

/// Fig. 6.
///
/// # Errors
/// [`ReproduceError`].
pub fn mass(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let averages =
        [("mean_cluster_size", "S, number average"), ("mass_weighted_cluster_size", "S, mass average")];
    let mut panels = Vec::new();
    for (column, label) in averages {
        for (short, title) in [(true, "short-ranged"), (false, "long-ranged")] {
            let mut chart = Chart::new(title, time_axis(), Axis::log(label, ""));
            for look in looks(short) {
                if let Some(curves) = of_reach(evidence, &look.reach, Series::Observables, column, None)? {
                    let label = look.reach.label(evidence.size);
                    let curves = curves.without_zeros();
                    chart.series.push(drawn(&label, look.colour, look.style, &curves, 1.0));
                }
            }
            panels.push(Panel::Chart(chart));
        }
    }
    let caption = "Mean cluster mass: (a, b) number average, Eq. 23; (c, d) mass average, Σs²n_c/Σs n_c, which is not in the paper.";
    built.draw("fig-6", caption, &Figure::new("", panels))?;
    let all = discs(&evidence.of(Campaign::Clustering));
    for reach in REACHES.iter().filter(|reach| !reach.short) {
        let label = reach.label(evidence.size);
        let Some(curves) = of_reach(evidence, reach, Series::Observables, "mean_cluster_size", None)? else {
            built.findings.push(exponential(&label));
            continue;
        };
        let fit = |which: usize| {
            move |curve: &Curve| line(&early(curve, all)).and_then(|found| found.get(which).copied())
        };
        built.findings.push(exponential(&label).measured(curves.jackknife(fit(2))));
        let end = curves.jackknife(|curve| average(curve, 6.0, 7.1).map(|size| size / all));
        let quantity = format!("S/N at 6 to 7 T, {label}");
        let paper = "saturates when only a single cluster remains, to which most particles are bound";
        let criterion = Criterion::at_least(0.9).with_errors(2.0, 0.05).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(end));
        if let Some(rate) = curves.jackknife(fit(0)) {
            let rate = with_error(rate);
            built.notes.push(format!("{label}: S grows as exp(kt/T) with k = {rate}."));
        }
    }
    built.notes.push(
        "The law of growth is a line through ln S between the time of 0.75 T, before which there are hardly clusters, and that at \
         which S reaches a tenth of all discs; its coefficient of determination r² is in the table. "
            .to_owned()
            + "By definition S ≥ 4: a cluster is a core with its neighbours.",
    );
    Ok(built)
}

fn exponential(label: &str) -> Finding {
    let quantity = format!("r² of ln S against t before saturation, {label}");
    Finding::new(
        quantity,
        "seems to follow an exponential law",
        Criterion::at_least(0.97).with_errors(2.0, 0.01).ours(),
    )
}

/// Time and ln S from when there are clusters until a tenth of all discs is reached.
fn early(curve: &[(f64, f64)], all: f64) -> Curve {
    let later = curve.iter().filter(|(time, _)| *time >= 0.75);
    let below = later.take_while(|(_, size)| *size < SATURATED * all);
    below.filter(|(_, size)| *size > 0.0).map(|(time, size)| (*time, libm::log(*size))).collect()
}

/// ∫ dt up to a time.
pub(super) fn integral(curve: &[(f64, f64)], until: f64) -> Option<f64> {
    let inside: Vec<&(f64, f64)> = curve.iter().filter(|(time, _)| *time <= until).collect();
    let pieces = inside.windows(2).map(|pair| match pair {
        [(earlier, first), (later, second)] => 0.5 * (later - earlier) * (first + second),
        _ => 0.0,
    });
    (inside.len() > 1).then(|| pieces.sum())
}

/// The quotient of what is read off two sets of runs, from the seeds that both have.
///
/// Where the discs start hangs on seed, number and box alone, so runs of one seed at two capillary lengths, or by two ways
/// to sum the force, begin with the same discs: they are not independent, and are left out together.
pub(super) fn quotient(
    above: &Option<Curves>,
    below: &Option<Curves>,
    read: impl Fn(&Curve) -> Option<f64>,
) -> Option<Estimate> {
    let sets = [above.as_ref()?, below.as_ref()?];
    Curves::jackknife_of(sets, |[above, below]| Some(read(above)? / read(below)?))
}
