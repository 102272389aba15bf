//! Fig. 14: shells of a random patch with thermal motion.

use super::theory::{lines, of_even_patch, of_start};
use super::{COMPARED, DELAY, Group, Printed, add, closest, fitted, groups, mean, picture, printed, radii};
use crate::configuration::Start;
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Series as Drawn};
use crate::figures::{Figure, Legend, Panel};
use crate::files::read_positions;
use crate::observables::collapse_fit::Conditions;
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Campaign;
use crate::reproduce::evidence::{Evidence, FinishedRun, curves_of};
use crate::reproduce::figures::{Built, time_axis};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::plain;
use crate::reproduce::statistics::{Curve, Curves, Row, Run, interpolated};
use crate::simulation::torus;
use crate::start;
use crate::statistics::Estimate;
use crate::theory::Pressure;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// From the top.
static SHELLS: [Printed; 3] =
    [printed(135.0, 1.16, 18.0), printed(95.0, 1.16, 13.0), printed(58.0, 1.14, 9.0)];

/// A mean radius this close to theory, of R_i, agrees with it.
const CLOSE: f64 = 0.03;

/// A shell of the figure: as printed, the group closest to it, and what was measured of that.
struct Measured {
    printed: &'static Printed,
    group: Group,
    curves: Curves,
}

/// Fig. 14.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let runs = evidence.of(Campaign::Disc);
    let mut built = Built::default();
    let mut chart = Chart::new("", time_axis(), Axis::linear("R", "R_0"));
    let groups = runs.first().map_or(Ok(Vec::new()), |run| groups(run))?;
    let mut shown = Vec::new();
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
        let what = format!(
            "A0 of the shell about {:.2} R0, R_f = {last} R0 held; the error with that of the paper's ten runs, taken as ours",
            group.initial
        );
        let measured = curves.jackknife(|curve| delay(curve, last));
        let beside =
            measured.map(|found| Estimate { error: core::f64::consts::SQRT_2 * found.error, ..found });
        built.findings.push(finding(&what).measured(beside));
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
        shown.push(Measured { printed: shell, group, curves });
    }
    let mut panels = Vec::new();
    if let Some(run) = runs.first() {
        chart.series.extend(compare(&runs, &shown, &mut built)?);
        panels = patch(run)?;
    }
    panels.insert(0, Panel::Chart(chart));
    let seed = runs.first().map_or(0, |run| run.configuration.seed);
    let caption = format!(
        "(a) Mean radii of shells 7.5 R0 wide of a random patch with thermal motion: points measured, solid lines fits of Eq. 30 over \
         0 < t < 0.9 T with the paper's R_f, drawn up to A0·T, dashed: mean-field theory (Eq. 6) of round patches \
         that begin as those of the runs, with periodic images, the pressure of hard discs and thermal motion, dotted: of an even patch \
         without pressure and thermal motion. (b), (c) The middle of the box at the \
         beginning and at the end of the run with seed {seed}."
    );
    let mut figure = Figure::new("", panels);
    figure.panel_height = figure.panel_width;
    figure.legend = Legend::Below;
    built.draw("fig-14", &caption, &figure)?;
    built.notes.push(
        "In a random patch the number of discs n within a shell, whose pull it follows, scatters by about √n from run to run: ten \
         runs leave A0 uncertain by some 0.02 at R_i = 131 R0 (n ≈ 230) and 0.05 at 56 R0 (n ≈ 43), the paper's ten as well."
            .to_owned(),
    );
    Ok(built)
}

/// Adds the mean-field theory, and how far what was measured is from it.
///
/// The number of discs within a shell, which decides how fast it falls, scatters from run to run: each run is compared
/// with the theory of its own start.
fn compare(
    runs: &[&FinishedRun],
    shown: &[Measured],
    built: &mut Built,
) -> Result<Vec<Drawn>, ReproduceError> {
    let Some(first) = runs.first() else { return Ok(Vec::new()) };
    let groups: Vec<Group> = shown.iter().map(|shell| shell.group).collect();
    let of_even = |pressure| of_even_patch(&first.configuration, &groups, pressure).unwrap_or_default();
    let of_run = |run: &&FinishedRun| (run.configuration.seed, of_start(&run.configuration, &groups));
    let starts: BTreeMap<u64, Option<Vec<Curve>>> = runs.par_iter().map(of_run).collect();
    let even = of_even(Pressure::discs());
    let mut means = Vec::new();
    for (index, shell) in shown.iter().enumerate() {
        let Group { number, initial } = shell.group;
        let theory = |seed: u64| starts.get(&seed)?.as_ref()?.get(index);
        let differences = curves_of(runs, |run| {
            let theory = theory(run.configuration.seed).map_or(&[][..], Vec::as_slice);
            let mut rows = run.rows(Series::Radii, "radius", Some(("group", number)))?;
            for row in &mut rows {
                let expected = interpolated(theory, row.time);
                row.value = row.value.zip(expected).map(|(radius, expected)| (radius - expected) / initial);
            }
            Ok(rows)
        })?;
        let largest = differences.jackknife(|curve| farthest(curve, COMPARED));
        let quantity = format!(
            "largest |mean of R − R of mean-field theory from the same start| / R_i up to {COMPARED} T, shell about {initial:.2} R0"
        );
        let criterion = Criterion::at_most(CLOSE).with_errors(2.0, 0.015).ours();
        let paper = "(ours) mean-field theory holds until discs touch";
        built.findings.push(Finding::new(quantity, paper, criterion).measured(largest));
        let theories = starts.keys().filter_map(|&seed| Some(Run { seed, rows: rows(theory(seed)?) }));
        let theories = Curves::new(&theories.collect::<Vec<_>>());
        let leaves = differences.means().into_iter().find(|(_, mean)| mean.value.abs() > CLOSE);
        let leaves = leaves.map(|(time, _)| time);
        // Where theory fails within the range of the fit it has nothing to tell of A0.
        let holds = leaves.is_none_or(|time| time > Conditions::default().until);
        built.findings.push(beside_theory(shell, &theories, holds));
        let mean = mean(&theories);
        built.notes.push(in_words(shell, leaves, &mean, even.get(index)));
        means.push(mean);
    }
    if let Some(note) = pressure_in_words(&even, &of_even(Pressure::IdealGas)) {
        built.notes.push(note);
    }
    let mut drawn = lines(&of_even(Pressure::None), "mean field, cold", Colour::Grey, Dash::Dotted);
    drawn.extend(lines(&means, "mean field, hard discs", Colour::Black, Dash::Dashed));
    Ok(drawn)
}

/// The largest modulus of a curve up to a time.
fn farthest(curve: &[(f64, f64)], until: f64) -> Option<f64> {
    // Nothing compared is no agreement.
    curve.iter().filter(|(time, _)| *time <= until).map(|(_, value)| value.abs()).reduce(f64::max)
}

/// A0 beside that of the theory of the same starts, in which the scatter of the starts is left out; nothing of it where
/// theory fails within the range of the fit.
fn beside_theory(shell: &Measured, theories: &Curves, holds: bool) -> Finding {
    let last = shell.printed.last;
    let difference = Curves::jackknife_of([&shell.curves, theories], |[measured, theory]| {
        Some(delay(measured, last)? - delay(theory, last)?)
    });
    let quantity = format!(
        "A0 of the shell about {:.2} R0, R_f = {last} R0 held, less that of mean-field theory from the same starts",
        shell.group.initial
    );
    let criterion = Criterion::equals(0.0, DELAY).with_errors(2.0, 0.02).ours();
    let paper = "(ours) thermal motion and single discs change A0 but little";
    Finding::new(quantity, paper, criterion).measured(difference.filter(|_| holds))
}

/// A curve as the rows of a run.
fn rows(curve: &Curve) -> Vec<Row> {
    let row = |(bin, &(time, value)): (u64, &(f64, f64))| Row { bin, time, value: Some(value) };
    (0..).zip(curve).map(row).collect()
}

/// A0 of a curve, R_f (R0) being held.
fn delay(curve: &Curve, last: f64) -> Option<f64> {
    fitted(curve, last).map(|fit| fit.delay.value)
}

/// How far a shell is from the theory of the same starts, where both end, and what the same fit makes of the theory.
fn in_words(shell: &Measured, leaves: Option<f64>, theory: &Curve, even: Option<&Curve>) -> String {
    let last = shell.printed.last;
    let until = leaves.map_or_else(|| "to the end".to_owned(), |time| format!("up to {} T", plain(time)));
    let end = |curve: &Curve| curve.last().map_or_else(|| "–".to_owned(), |last| format!("{:.1} R0", last.1));
    let delay =
        |curve: &Curve| delay(curve, last).map_or_else(|| "–".to_owned(), |delay| format!("{delay:.3}"));
    format!(
        "Shell about {:.2} R0: on average over runs R is within {} % of R_i of mean-field theory from the same start {until}. \
         Fitted in the same way, with R_f = {last} R0, that theory has A0 = {}, and an even patch {}. R ends at {}, in theory at {}.",
        shell.group.initial,
        plain(100.0 * CLOSE),
        delay(theory),
        even.map_or_else(|| "–".to_owned(), delay),
        end(&mean(&shell.curves)),
        end(theory),
    )
}

/// What the equation of state matters.
fn pressure_in_words(discs: &[Curve], gas: &[Curve]) -> Option<String> {
    let difference = |(discs, gas): (&Curve, &Curve)| {
        Some((interpolated(gas, COMPARED)? - interpolated(discs, COMPARED)?).abs())
    };
    let largest = discs.iter().zip(gas).filter_map(difference).reduce(f64::max)?;
    let end = gas.first()?.last()?.0;
    Some(format!(
        "Up to {COMPARED} T the pressure hardly matters: that of an ideal gas makes a difference of {} R0 at most. Under it the even patch \
         would fall into a point after {} T, so that it is not drawn. At rest the discs of Eq. 15 are pressed closer than 2 R0, where \
         the fluid of hard discs gives way less: its outer shell ends further out. R is measured from the middle of the box, and the centre of \
         mass of a random patch lies 183 R0/√(2·451) = 6 R0 (rms) from there, which adds to R of the inner ones.",
        plain(largest),
        plain(end),
    ))
}

/// The patch of a run at its beginning and at its end.
fn patch(run: &FinishedRun) -> Result<Vec<Panel>, ReproduceError> {
    let Start::Disc { radius } = run.configuration.start else { return Ok(Vec::new()) };
    let torus = torus(&run.configuration)?;
    let configuration = &run.configuration;
    let mut panels = Vec::new();
    if let Ok(positions) = start::disc(&torus, configuration.system.particles, radius, configuration.seed) {
        panels.push(picture(configuration, &positions, radius, "t = 0")?);
    }
    let last = read_positions(&run.directory.join("final.state"), &torus)?;
    let caption = format!("t = {} T", configuration.time.until);
    panels.push(picture(configuration, &last.positions, radius, &caption)?);
    Ok(panels)
}
