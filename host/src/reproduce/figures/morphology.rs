//! Figs. 7 to 11: Minkowski functionals of the regions denser than a threshold, and their shape factor.
//!
//! What is plotted and compared is the count of pixels, as in the paper, whose perimeters are too long by up to 4/π and
//! whose shape factor of a large disc is 16/π² ≈ 1.6; a second row of panels has the contours, whose shape factor of a
//! disc is 1.

use super::clusters::WINDOW;
use super::{Built, drawn, looks, of_reach, time_axis};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Style};
use crate::figures::{Figure, Panel};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{REACHES, Reach, THRESHOLD, THRESHOLDS, side};
use crate::reproduce::evidence::Evidence;
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::with_error;
use crate::reproduce::statistics::{Curve, Curves, average, line, maximum};
use crate::statistics::Estimate;

/// The capillary length of Fig. 7, that of Table I.
const TABLE_1: Reach = REACHES[4];

/// A functional of Figs. 8 to 11.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functional {
    /// M0, Fig. 8.
    Area,
    /// M1, Fig. 9.
    Length,
    /// M2, Fig. 10.
    Euler,
    /// φ, Fig. 11.
    Shape,
}

impl Functional {
    /// Column by pixels and by contours, label, unit, power of L that it is divided by.
    const fn facts(self) -> ([&'static str; 2], &'static str, &'static str, f64) {
        match self {
            Self::Area => (["pixel_area", "area"], "M_0 / L^2", "", 1.0),
            Self::Length => (["pixel_length", "length"], "M_1 / L^2", "R_0^{-1}", 1.0),
            Self::Euler => (["pixel_euler", "euler"], "M_2 / L^2", "10^{-3} R_0^{-2}", 1e-3),
            Self::Shape => (["pixel_shape", "shape"], "ϕ", "", 0.0),
        }
    }

    fn figure(self) -> &'static str {
        match self {
            Self::Area => "fig-8",
            Self::Length => "fig-9",
            Self::Euler => "fig-10",
            Self::Shape => "fig-11",
        }
    }

    /// How findings call it.
    fn name(self) -> &'static str {
        match self {
            Self::Area => "M0",
            Self::Length => "M1",
            Self::Euler => "M2",
            Self::Shape => "φ",
        }
    }
}

fn at_threshold(
    evidence: &Evidence,
    reach: &Reach,
    column: &str,
    threshold: f64,
) -> Result<Option<Curves>, ReproduceError> {
    of_reach(evidence, reach, Series::Minkowski, column, Some(("threshold", threshold)))
}

/// Fig. 7.
///
/// # Errors
/// [`ReproduceError`].
pub fn thresholds(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let area = side(evidence.size) * side(evidence.size);
    let mut panels = Vec::new();
    for (column, title) in [("pixel_length", "pixels"), ("length", "contours")] {
        let mut chart = Chart::new(title, time_axis(), Axis::linear("M_1 / L^2", "R_0^{-1}"));
        for (index, &threshold) in THRESHOLDS.iter().enumerate() {
            if let Some(curves) = at_threshold(evidence, &TABLE_1, column, threshold)? {
                let colour = Colour::ordered(index, THRESHOLDS.len());
                let style = Style::Band(Dash::numbered(index));
                chart.series.push(drawn(&format!("ρ_c/ρ_m = {threshold}"), colour, style, &curves, area));
            }
        }
        panels.push(Panel::Chart(chart));
    }
    let caption = "Boundary length per area of the regions denser than ρ_c, λ/L = 0.54: pixels as in the paper, and contours.";
    built.draw("fig-7", caption, &Figure::new("", panels))?;
    let drop = |threshold: f64| -> Result<Option<Estimate>, ReproduceError> {
        let curves = at_threshold(evidence, &TABLE_1, "pixel_length", threshold)?;
        Ok(curves.and_then(|curves| curves.jackknife(loss)))
    };
    for threshold in [0.14, 0.2, 0.3, 0.4] {
        let quantity = format!("M1 at 6.5 to 7 T over its maximum, ρ_c = {threshold} ρ_m");
        let paper = "a maximum and a decrease: the crossover is visible at intermediate thresholds";
        let criterion = Criterion::at_most(0.7).with_errors(2.0, 0.1).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(drop(threshold)?));
    }
    let quantity = "M1 at 6.5 to 7 T over its maximum, ρ_c = 0.8 ρ_m";
    let paper = "close to ρ_m the signature of the crossover is no longer detectable";
    let criterion = Criterion::at_least(0.8).with_errors(2.0, 0.1).ours();
    built.findings.push(Finding::new(quantity, paper, criterion).measured(drop(0.8)?));
    Ok(built)
}

/// The end of a curve over its maximum.
fn loss(curve: &Curve) -> Option<f64> {
    Some(average(curve, 6.5, 7.1)? / maximum(curve, WINDOW)?.1)
}

/// Figs. 8 to 11.
///
/// # Errors
/// [`ReproduceError`].
pub fn functional(evidence: &Evidence, functional: Functional) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let (columns, label, unit, power) = functional.facts();
    let area = if power > 0.0 { power * side(evidence.size) * side(evidence.size) } else { 1.0 };
    let mut panels = Vec::new();
    for (column, way) in columns.into_iter().zip(["pixels", "contours"]) {
        for (short, range) in [(true, "short-ranged"), (false, "long-ranged")] {
            let mut chart = Chart::new(&format!("{range}, {way}"), time_axis(), Axis::linear(label, unit));
            for look in looks(short) {
                if let Some(curves) = at_threshold(evidence, &look.reach, column, THRESHOLD)? {
                    let label = look.reach.label(evidence.size);
                    chart.series.push(drawn(&label, look.colour, look.style, &curves, area));
                }
            }
            panels.push(Panel::Chart(chart));
        }
    }
    let name = functional.name();
    let caption = format!(
        "{name} of the regions denser than 0.14 ρ_m: (a, b) pixels as in the paper, (c, d) contours."
    );
    built.draw(functional.figure(), &caption, &Figure::new("", panels))?;
    let column = columns[0];
    match functional {
        Functional::Shape => shape_findings(&mut built, evidence)?,
        Functional::Euler => {
            maxima(&mut built, evidence, functional, column)?;
            numbers_of_regions(&mut built, evidence)?;
        }
        Functional::Area | Functional::Length => maxima(&mut built, evidence, functional, column)?,
    }
    Ok(built)
}

/// Long-ranged: a maximum and a decrease; the shortest range: increase to the end.
fn maxima(
    built: &mut Built,
    evidence: &Evidence,
    functional: Functional,
    column: &str,
) -> Result<(), ReproduceError> {
    let name = functional.name();
    for reach in REACHES.iter().filter(|reach| !reach.short) {
        let label = reach.label(evidence.size);
        let curves = at_threshold(evidence, reach, column, THRESHOLD)?;
        let peak = curves
            .as_ref()
            .and_then(|curves| curves.jackknife(|curve| maximum(curve, WINDOW).map(|peak| peak.0)));
        let quantity = format!("time of the maximum of {name}, {label} (T)");
        let paper = "crossover at a time of the order of T";
        let criterion = Criterion::between(0.5, 2.0).with_errors(2.0, 0.2).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(peak));
        let quantity = format!("{name} at 6.5 to 7 T over its maximum, {label}");
        let criterion = Criterion::at_most(0.7).with_errors(2.0, 0.1).ours();
        let finding = Finding::new(quantity, "a maximum followed by a steady decrease", criterion);
        built.findings.push(finding.measured(curves.and_then(|curves| curves.jackknife(loss))));
    }
    let shortest = &REACHES[0];
    let growth = at_threshold(evidence, shortest, column, THRESHOLD)?.and_then(|curves| {
        curves.jackknife(|curve| Some(average(curve, 6.0, 7.1)? / average(curve, 3.0, 4.0)?))
    });
    let quantity = format!("{name} at 6 to 7 T over that at 3 to 4 T, {}", shortest.label(evidence.size));
    let criterion = Criterion::at_least(1.0).with_errors(2.0, 0.05);
    built.findings.push(Finding::new(quantity, "steady increase", criterion).measured(growth));
    Ok(())
}

/// Without holes M2 is the number of dense regions, and positive.
fn numbers_of_regions(built: &mut Built, evidence: &Evidence) -> Result<(), ReproduceError> {
    for reach in REACHES.iter().filter(|reach| !reach.short) {
        let label = reach.label(evidence.size);
        let euler = at_threshold(evidence, reach, "pixel_euler", THRESHOLD)?;
        let least = euler.as_ref().and_then(|curves| {
            curves.jackknife(|curve| {
                let later = curve.iter().filter(|(time, _)| *time >= 0.25).map(|(_, value)| *value);
                Some(later.fold(f64::INFINITY, f64::min)).filter(|least| least.is_finite())
            })
        });
        let quantity = format!("least M2 after 0.25 T, {label}");
        let paper = "no holes: M2 > 0 is the number of dense regions";
        built.findings.push(
            Finding::new(quantity, paper, Criterion::at_least(0.0).with_errors(2.0, 2.0)).measured(least),
        );
        let count = of_reach(evidence, reach, Series::Observables, "clusters", None)?;
        let ratio = euler.as_ref().zip(count.as_ref()).and_then(|(euler, count)| {
            Curves::jackknife_of([euler, count], |[euler, count]| {
                Some(average(euler, 1.25, 1.75)? / average(count, 1.25, 1.75)?)
            })
        });
        if let Some(ratio) = ratio {
            built.notes.push(format!(
                "{label}: at 1.25 to 1.75 T, M2 is {} times n_c of Fig. 5: two or three discs are dense enough for a region, but \
                 no cluster.",
                with_error(ratio)
            ));
        }
    }
    Ok(())
}

/// A plateau of φ at intermediate ranges; at long ones a maximum, a minimum at the collapse to one cluster, an increase.
fn shape_findings(built: &mut Built, evidence: &Evidence) -> Result<(), ReproduceError> {
    for reach in REACHES.iter().filter(|reach| reach.paper == 0.05 || reach.paper == 0.1) {
        let curves = at_threshold(evidence, reach, "pixel_shape", THRESHOLD)?;
        let slope = curves.and_then(|curves| curves.jackknife(late_slope));
        let quantity = format!("slope of ln φ over 4 to 7 T, {} (1/T)", reach.label(evidence.size));
        let paper = "φ tends to become time-independent: self-similar growth";
        let criterion = Criterion::equals(0.0, 0.03).with_errors(2.0, 0.015).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(slope));
    }
    for reach in REACHES.iter().filter(|reach| !reach.short) {
        let label = reach.label(evidence.size);
        let shape = at_threshold(evidence, reach, "pixel_shape", THRESHOLD)?;
        let fall = shape.as_ref().and_then(|curves| {
            curves.jackknife(|curve| {
                let early: Curve = curve.iter().filter(|(time, _)| *time <= 2.5).copied().collect();
                Some(average(curve, 2.75, 3.5)? / maximum(&early, WINDOW)?.1)
            })
        });
        let quantity = format!("φ at 2.75 to 3.5 T over its maximum before, {label}");
        let criterion = Criterion::at_most(0.95).with_errors(2.0, 0.025).ours();
        built
            .findings
            .push(Finding::new(quantity, "a maximum followed by a decrease", criterion).measured(fall));
        let rise = shape.and_then(|curves| {
            curves.jackknife(|curve| Some(average(curve, 6.0, 7.1)? / average(curve, 2.75, 3.5)?))
        });
        let quantity = format!("φ at 6 to 7 T over that at 2.75 to 3.5 T, {label}");
        let paper = "increase after the collapse to a single cluster: towards a circular shape";
        let criterion = Criterion::at_least(1.05).with_errors(2.0, 0.025).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(rise));
        let count = of_reach(evidence, reach, Series::Observables, "clusters", None)?;
        let single = count.and_then(|curves| curves.jackknife(single_cluster));
        let quantity = format!("time at which there are 1.5 clusters on average, {label} (T)");
        let paper = "collapsed to a single cluster at ≈ 6 T; completed at ≈ 5 T";
        let criterion = Criterion::between(4.5, 6.5).with_errors(2.0, 0.5).ours();
        built.findings.push(Finding::new(quantity, paper, criterion).measured(single));
    }
    built.notes.push(
        "A large disc has φ = 16/π² ≈ 1.62 by pixels, which count its perimeter along the grid, and φ = 1 by contours. The paper \
         counts pixels (its Ref. 36) and says φ = 1 for a circle."
            .to_owned(),
    );
    Ok(())
}

fn late_slope(curve: &Curve) -> Option<f64> {
    let late = curve.iter().filter(|(time, value)| *time >= 4.0 && *value > 0.0);
    line(&late.map(|(time, value)| (*time, libm::log(*value))).collect::<Vec<_>>()).map(|[slope, ..]| slope)
}

/// When the mean number of clusters has come down to 1.5 after its maximum.
fn single_cluster(curve: &Curve) -> Option<f64> {
    let (peak, _) = maximum(curve, WINDOW)?;
    curve.iter().find(|(time, count)| *time > peak && *count <= 1.5).map(|(time, _)| *time)
}
