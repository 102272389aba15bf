//! Figs. 12 to 14: radii of rings and shells of a collapsing patch, with fits of Eq. 30 and the mean-field theory.

use super::{Built, marker, time_axis};
use crate::configuration::{Configuration, Start};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series as Drawn};
use crate::figures::{Discs, Figure, Panel};
use crate::observables::collapse_fit::{CollapseFit, Conditions, fit};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::{Campaign, PATCH_RADIUS};
use crate::reproduce::evidence::{Evidence, FinishedRun, curves};
use crate::reproduce::finding::{Criterion, Finding, with_error};
use crate::reproduce::statistics::{Curve, Curves};
use crate::simulation::torus;
use crate::start;
use crate::statistics::Estimate;
use crate::theory::cold_collapse_radius;
use crate::theory::shells::{Shell, Shells};

/// A ring of Figs. 12 and 14: R_i as printed, A0 and R_f of the paper's fit (R0).
struct Printed {
    initial: f64,
    delay: f64,
    last: f64,
}

const fn printed(initial: f64, delay: f64, last: f64) -> Printed {
    Printed { initial, delay, last }
}

/// Fig. 12, from the top.
const RINGS: [Printed; 3] = [printed(135.0, 1.15, 18.0), printed(95.0, 1.16, 13.0), printed(58.0, 1.16, 8.0)];

/// Fig. 14, from the top.
const SHELLS: [Printed; 3] =
    [printed(135.0, 1.16, 18.0), printed(95.0, 1.16, 13.0), printed(58.0, 1.14, 9.0)];

/// How well A0 is known from the paper: its last digit, and what is not known of its data.
const DELAY: f64 = 0.01;

/// λ of Figs. 12 and 14, R0.
const LENGTH: f64 = 270.0;

/// R_f of the outermost ring in units of R_i, as that of Fig. 12's rings: 18/135, 13/96, 8/58.
const LAST_OVER_INITIAL: f64 = 18.0 / 135.0;

/// Every how many rows a marker is drawn.
const THINNED: usize = 4;

/// How a capillary length of Fig. 13 is called.
#[must_use]
pub fn ring_label(length: f64) -> String {
    if !length.is_finite() {
        return "λ → ∞".to_owned();
    }
    format!("λ/R = {}", (100.0 * length / PATCH_RADIUS).round() / 100.0)
}

/// A group of discs: its number and R_i.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Group {
    number: f64,
    initial: f64,
}

/// The groups of a run, from the inside.
fn groups(run: &FinishedRun) -> Result<Vec<Group>, ReproduceError> {
    let numbers = run.column(Series::Radii, "group", None)?;
    let radii = run.column(Series::Radii, "initial_radius", None)?;
    let first = numbers.first().map_or(0.0, |(time, _)| *time);
    let rows = numbers.into_iter().zip(radii).take_while(|((time, _), _)| *time == first);
    Ok(rows
        .filter_map(|((_, number), (_, radius))| Some(Group { number: number?, initial: radius? }))
        .collect())
}

/// The group whose R_i is closest to one printed.
fn closest(groups: &[Group], initial: f64) -> Option<Group> {
    groups.iter().copied().min_by(|a, b| (a.initial - initial).abs().total_cmp(&(b.initial - initial).abs()))
}

fn radii(runs: &[&FinishedRun], group: Group) -> Result<Curves, ReproduceError> {
    curves(runs, Series::Radii, "radius", Some(("group", group.number)))
}

/// The fit of Eq. 30 to a mean curve with R_f held; R_i is where it begins.
fn fitted(curve: &Curve, last: f64) -> Option<CollapseFit> {
    let initial = curve.first()?.1;
    let conditions =
        Conditions { initial_radius: Some(initial), final_radius: Some(last), ..Conditions::default() };
    fit(curve, &conditions).ok()
}

/// A0 of a cold run, which is the same whatever its seed: the error is that of the fit.
fn delay(curves: &Curves, last: f64) -> Option<Estimate> {
    fitted(&mean(curves), last).map(|fit| fit.delay)
}

/// A0 of random runs: the error is the jackknife's over runs, as they differ by far more than the fit does not fit.
fn delay_over_runs(curves: &Curves, last: f64) -> Option<Estimate> {
    curves.jackknife(|curve| fitted(curve, last).map(|fit| fit.delay.value))
}

fn mean(curves: &Curves) -> Curve {
    curves.means().into_iter().map(|(time, mean)| (time, mean.value)).collect()
}

/// Measured points, the fit as a line over what was fitted.
fn add(chart: &mut Chart, label: &str, colour: Colour, number: usize, curves: &Curves, last: f64) {
    let points = curves
        .means()
        .into_iter()
        .step_by(THINNED)
        .map(|(time, mean)| (time, mean.value, Some(mean.error).filter(|error| error.is_finite())));
    chart.series.push(Drawn::points(label, colour, marker(number), points));
    if let Some(fit) = fitted(&mean(curves), last) {
        let end = fit.delay.value;
        let line = (0..=200).map(|step| end * f64::from(step) / 200.0).map(|time| (time, fit.radius(time)));
        chart.series.push(Drawn::line("", colour, Dash::Solid, line));
    }
}

/// Fig. 12.
///
/// # Errors
/// [`ReproduceError`].
pub fn rings(evidence: &Evidence) -> Result<Built, ReproduceError> {
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
    if let Some(run) = runs.first() {
        for (index, ring) in RINGS.iter().enumerate() {
            if let Some(group) = closest(&groups, ring.initial) {
                let label = if index == 0 { "mean-field shells" } else { "" };
                chart.series.push(theory(run, group, label, Colour::Black, Dash::Dashed));
                let label = if index == 0 { "Eq. 13" } else { "" };
                let eq13 = (0..=100)
                    .map(|step| 0.01 * f64::from(step))
                    .map(|time| (time, cold_collapse_radius(group.initial, time)));
                chart.series.push(Drawn::line(label, Colour::Grey, Dash::Dotted, eq13));
            }
        }
    }
    let mut panels = vec![Panel::Chart(chart)];
    if let Some(run) = runs.first() {
        panels.extend(patch(run)?);
    }
    let caption = "Radii of rings in cold collapse, λ/R = 1.48: points measured, solid lines fits of Eq. 30 over 0 < t < 0.9 T with \
                   the paper's R_f, dashed: shells in mean-field theory with periodic images, dotted: Eq. 13.";
    let mut figure = Figure::new("", panels);
    figure.panel_height = figure.panel_width;
    built.draw("fig-12", caption, &figure)?;
    built.findings.extend(shells_finding(&runs, &groups)?);
    Ok(built)
}

/// The patch at its start.
fn patch(run: &FinishedRun) -> Result<Option<Panel>, ReproduceError> {
    let torus = torus(&run.configuration)?;
    let Start::Rings { rings, spacing, per_ring } = run.configuration.start else { return Ok(None) };
    let Ok(positions) = start::rings(&torus, rings, per_ring, spacing) else { return Ok(None) };
    Ok(Some(Panel::Discs(Discs { torus, positions, clustered: Vec::new(), caption: "t = 0".to_owned() })))
}

/// The shells of a configuration's rings, with images.
fn shells(configuration: &Configuration) -> Option<Shells> {
    let Start::Rings { rings, spacing, per_ring } = configuration.start else { return None };
    let ring = |number: u32| Shell {
        radius: spacing * f64::from(number),
        discs: f64::from((number * per_ring).max(1)),
    };
    let all: Vec<Shell> = (0..=rings).map(ring).collect();
    let system = &configuration.system;
    Shells::new(&all, system.capillary_strength, system.capillary_length)
        .ok()?
        .periodic(system.side)
        .ok()
        .map(Shells::of_discs)
}

/// R(t) of a ring in theory, up to when it has shrunk to nothing.
fn theory(run: &FinishedRun, group: Group, label: &str, colour: Colour, dash: Dash) -> Drawn {
    let curve = theory_curve(run, group).unwrap_or_default();
    let end = curve.iter().position(|(_, radius)| *radius <= 0.0).map_or(curve.len(), |place| place + 1);
    Drawn::line(label, colour, dash, curve.into_iter().take(end))
}

fn theory_curve(run: &FinishedRun, group: Group) -> Option<Curve> {
    let jeans = run.configuration.jeans_time()?;
    let times: Vec<f64> = (0..=150).map(|step| 0.01 * f64::from(step)).collect();
    let shells = shells(&run.configuration)?;
    let units: Vec<f64> = times.iter().map(|time| time * jeans).collect();
    let radii = shells.radii_at(&units).ok()?;
    let ring = group.number as usize;
    Some(times.into_iter().zip(radii).filter_map(|(time, radii)| Some((time, *radii.get(ring)?))).collect())
}

/// How far theory and measurement are apart before discs touch.
fn shells_finding(runs: &[&FinishedRun], groups: &[Group]) -> Result<Vec<Finding>, ReproduceError> {
    let mut findings = Vec::new();
    for ring in &RINGS {
        let Some(group) = closest(groups, ring.initial) else { continue };
        let Some(run) = runs.first() else { continue };
        let measured = mean(&radii(runs, group)?);
        let deviation = theory_curve(run, group).and_then(|theory| {
            let before = measured.iter().filter(|(time, _)| *time <= 0.8);
            let difference = before.filter_map(|(time, radius)| {
                let close = theory.iter().min_by(|a, b| (a.0 - time).abs().total_cmp(&(b.0 - time).abs()))?;
                // Rows come up to a step after their time.
                Some((radius - close.1).abs() / group.initial)
            });
            // Nothing compared is no agreement.
            difference.reduce(f64::max).map(Estimate::exact)
        });
        let quantity =
            format!("largest |R − R of mean-field shells| / R_i up to 0.8 T, ring {}", group.number);
        let paper = "(ours) the theory holds until discs touch";
        findings.push(Finding::new(quantity, paper, Criterion::at_most(0.01).ours()).measured(deviation));
    }
    Ok(findings)
}

/// Fig. 13.
///
/// # Errors
/// [`ReproduceError`].
pub fn lengths(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let mut chart = Chart::new("", time_axis(), Axis::linear("R", "R_0"));
    let (mut delays, mut theories) = (Vec::new(), Vec::new());
    let lengths = Campaign::Rings.lengths(evidence.size);
    for (index, &length) in lengths.iter().enumerate() {
        let runs = evidence.with_length(Campaign::Rings, length);
        let Some(run) = runs.first() else { continue };
        let Some(&outermost) = groups(run)?.last() else { continue };
        let curves = radii(&runs, outermost)?;
        let last = LAST_OVER_INITIAL * outermost.initial;
        let colour = Colour::ordered(index, lengths.len());
        add(&mut chart, &ring_label(length), colour, index, &curves, last);
        let label = if theories.is_empty() { "mean-field shells" } else { "" };
        theories.push(theory(run, outermost, label, Colour::Black, Dash::Dashed));
        delays.push((length, delay(&curves, last), collapse_time(run, outermost)));
    }
    chart.series.extend(theories);
    let caption = "Radius of the outermost ring: points measured, solid lines fits of Eq. 30 over 0 < t < 0.9 T, dashed: shells in \
                   mean-field theory with periodic images.";
    built.draw("fig-13", caption, &Figure::new("", [Panel::Chart(chart)]))?;
    let value =
        |length: f64| delays.iter().find(|(found, ..)| *found == length).and_then(|(_, delay, _)| *delay);
    for pair in lengths.windows(2) {
        let [shorter, longer] = pair else { continue };
        let difference = value(*shorter).zip(value(*longer)).map(|(first, second)| first.less(second));
        let quantity = format!("A0 at {} less that at {}", ring_label(*shorter), ring_label(*longer));
        let paper = "upon increasing λ the collapse time decreases";
        let criterion = Criterion::at_least(0.0).with_errors(2.0, 0.005);
        built.findings.push(Finding::new(quantity, paper, criterion).measured(difference));
    }
    let newtonian = f64::INFINITY;
    built.findings.push(
        Finding::new(
            "A0 at λ → ∞ of the outermost ring, R_f = 0.13 R_i held",
            "A0(λ → ∞) = 1",
            Criterion::equals(1.0, DELAY).ours(),
        )
        .measured(value(newtonian)),
    );
    for (length, found, theory) in &delays {
        if let (Some(found), Some(theory)) = (found, theory) {
            built.notes.push(format!(
                "{}: A0 = {}; in mean-field theory, with images, the outermost shell has come down to R_f after {theory:.3} T.",
                ring_label(*length),
                with_error(*found),
            ));
        }
    }
    built.notes.push(
        "A0(λ → ∞) = 1 is Eq. 13 in the open plane with R_f = 0. In the periodic box the neutralising background, 0.16 of the patch's \
         density, slows the collapse: mean-field shells with images end later than T for every λ (above). So A0 = 1 cannot be reached in this \
         box, whatever the scheme; the paper extrapolates or means the open plane."
            .to_owned(),
    );
    Ok(built)
}

/// When the outermost shell of theory has come down to R_f, T.
fn collapse_time(run: &FinishedRun, group: Group) -> Option<f64> {
    let curve = theory_curve(run, group)?;
    curve.iter().find(|(_, radius)| *radius <= LAST_OVER_INITIAL * group.initial).map(|(time, _)| *time)
}

/// Fig. 14.
///
/// # Errors
/// [`ReproduceError`].
pub fn disc(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let runs = evidence.of(Campaign::Disc);
    let mut built = Built::default();
    let mut chart = Chart::new("", time_axis(), Axis::linear("R", "R_0"));
    let groups = runs.first().map_or(Ok(Vec::new()), |run| groups(run))?;
    for (index, shell) in SHELLS.iter().enumerate() {
        let Printed { initial, delay: expected, last } = *shell;
        let finding = |what: &str| {
            let criterion = Criterion::equals(expected, DELAY).with_errors(2.0, 0.02).ours();
            Finding::new(what, format!("{expected} with R_f = {last}"), criterion)
        };
        let Some(group) = closest(&groups, initial) else {
            built.findings.push(finding(&format!("A0, R_i = {initial} R0")));
            continue;
        };
        let curves = radii(&runs, group)?;
        let label = format!("R_i = {:.0} R_0", group.initial);
        add(&mut chart, &label, Colour::Category(index), index, &curves, last);
        let what = format!("A0 of the shell about {:.2} R0, R_f = {last} R0 held", group.initial);
        built.findings.push(finding(&what).measured(delay_over_runs(&curves, last)));
        let late = curves.jackknife(|curve| {
            let fit = fitted(curve, last)?;
            let (_, radius) = curve.iter().find(|(time, _)| *time >= fit.delay.value)?;
            Some((radius - last) / last)
        });
        let what = format!("(R − R_f)/R_f at t = A0·T, shell about {:.2} R0", group.initial);
        let paper = "approaches R_f more smoothly and later than A0·T";
        built.findings.push(
            Finding::new(what, paper, Criterion::at_least(0.2).with_errors(2.0, 0.1).ours()).measured(late),
        );
    }
    let caption = "Mean radii of shells 7.5 R0 wide of a random patch with thermal motion: points measured, lines fits of Eq. 30 over \
                   0 < t < 0.9 T with the paper's R_f.";
    built.draw("fig-14", caption, &Figure::new("", [Panel::Chart(chart)]))?;
    built.notes.push(
        "In a random patch the number of discs n within a shell, whose pull it follows, scatters by about √n from run to run: ten \
         runs leave A0 uncertain by some 0.02 at R_i = 131 R0 (n ≈ 230) and 0.05 at 56 R0 (n ≈ 43), the paper's ten as well."
            .to_owned(),
    );
    Ok(built)
}
