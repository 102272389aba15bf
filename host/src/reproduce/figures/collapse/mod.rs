//! Figs. 12 to 14: radii of rings and shells of a collapsing patch, with fits of Eq. 30 and the mean-field theory.
//!
//! - [`rings`]: Fig. 12, three rings of a cold patch
//! - [`lengths`]: Fig. 13, the outermost ring at several capillary lengths
//! - [`disc`]: Fig. 14, shells of a random patch with thermal motion

pub mod disc;
pub mod lengths;
pub mod rings;
mod theory;

use super::marker;
use crate::configuration::Configuration;
use crate::figures::chart::{Chart, Colour, Dash, Series as Drawn};
use crate::figures::{Discs, Panel};
use crate::observables::collapse_fit::{CollapseFit, Conditions, fit};
use crate::observables::series::Series;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::PATCH_RADIUS;
use crate::reproduce::evidence::{FinishedRun, curves};
use crate::reproduce::statistics::{Curve, Curves, interpolated};
use crate::simulation::torus;
use crate::statistics::Estimate;
use meniscus_core::torus::{Position, Torus};

/// A ring of Figs. 12 and 14: R_i as printed, A0 and R_f of the paper's fit (R0).
struct Printed {
    initial: f64,
    delay: f64,
    last: f64,
}

const fn printed(initial: f64, delay: f64, last: f64) -> Printed {
    Printed { initial, delay, last }
}

/// How well A0 is known from the paper: its last digit, and what is not known of its data.
const DELAY: f64 = 0.01;

/// Every how many rows a marker is drawn.
const THINNED: usize = 4;

/// Up to when mean-field theory is compared with what was measured, t/T: discs do not touch yet.
const COMPARED: f64 = 0.8;

/// Half of the side of a picture of a patch, of the patch's radius.
const PICTURED: f64 = 1.1;

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

fn mean(curves: &Curves) -> Curve {
    curves.means().into_iter().map(|(time, mean)| (time, mean.value)).collect()
}

/// Measured points, the fit as a line up to A0·T.
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

/// The largest distance of a measured curve from that of theory up to [`COMPARED`], of R_i. None if nothing is compared.
fn largest_deviation(measured: &Curve, theory: &Curve, initial: f64) -> Option<f64> {
    let compared = measured.iter().filter(|(time, _)| *time <= COMPARED);
    let deviation =
        |&(time, radius): &(f64, f64)| Some((radius - interpolated(theory, time)?).abs() / initial);
    // Nothing compared is no agreement.
    compared.filter_map(deviation).reduce(f64::max)
}

/// The middle of a box with the discs of a patch that begins with `radius` (R0); the whole box if that is not larger.
fn picture(
    configuration: &Configuration,
    positions: &[Position],
    radius: f64,
    caption: &str,
) -> Result<Panel, ReproduceError> {
    let whole = torus(configuration)?;
    let side = (2.0 * PICTURED * radius).min(whole.side());
    let torus = Torus::new(side).unwrap_or(whole);
    let border = 0.5 * (whole.side() - torus.side());
    let inside = |position: &Position| {
        let along = |fraction| torus.fraction(whole.coordinate(fraction) - border).ok();
        Some(Position { x: along(position.x)?, y: along(position.y)? })
    };
    let positions = positions.iter().filter_map(inside).collect();
    Ok(Panel::Discs(Discs { torus, positions, clustered: Vec::new(), caption: caption.to_owned() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::start;

    #[test]
    fn a_picture_shows_the_middle_of_the_box() {
        let overrides = ["force.splitting=0.1".to_owned()];
        let configuration = Configuration::from_preset("fig-14", &overrides).unwrap();
        let positions = start::disc(&torus(&configuration).unwrap(), 451, 183.0, 1).unwrap();
        let shown = |radius: f64| match picture(&configuration, &positions, radius, "").unwrap() {
            Panel::Discs(discs) => (discs.torus.side(), discs.positions),
            Panel::Chart(_) => panic!("a picture of discs was asked for"),
        };
        let (side, patch) = shown(183.0);
        assert!((side - 402.6).abs() < 1e-9);
        assert_eq!(patch.len(), 451);
        // Half the radius has a quarter of the discs in its square's circle, and more in its corners.
        assert!((110..200).contains(&shown(91.5).1.len()));
        assert_eq!(shown(500.0).0, 800.0);
    }

    #[test]
    fn the_largest_deviation_is_that_before_discs_touch() {
        let theory = vec![(0.0, 100.0), (2.0, 0.0)];
        let measured = vec![(0.0, 100.0), (0.5, 77.0), (0.9, 20.0)];
        assert_eq!(largest_deviation(&measured, &theory, 100.0), Some(0.02));
        assert_eq!(largest_deviation(&Vec::new(), &theory, 100.0), None);
    }
}
