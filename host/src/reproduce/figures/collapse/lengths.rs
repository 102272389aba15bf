//! Fig. 13: the outermost ring of a cold patch at several capillary lengths.

use super::theory::{Surroundings, lines, of_ring};
use super::{DELAY, add, delay, fitted, groups, radii, ring_label};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash};
use crate::figures::{Figure, Panel};
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Campaign;
use crate::reproduce::evidence::Evidence;
use crate::reproduce::figures::{Built, time_axis};
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::numbers::with_error;
use crate::reproduce::statistics::Curve;
use crate::statistics::Estimate;
use crate::theory::cold_collapse_radius;

/// R_f of the outermost ring in units of R_i, as that of Fig. 12's rings: 18/135, 13/96, 8/58.
const LAST_OVER_INITIAL: f64 = 18.0 / 135.0;

/// Fig. 13.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
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
        let [images, plane] = [Surroundings::Images, Surroundings::Nothing]
            .map(|around| of_ring(&run.configuration, outermost, around).unwrap_or_default());
        let found = delay(&curves, last);
        built.notes.extend(found.and_then(|found| of_theory(length, found, &images, &plane, last)));
        delays.push((length, found));
        theories.push(images);
    }
    chart.series.extend(lines(&theories, "mean-field shells", Colour::Black, Dash::Dashed));
    let caption = "Radius of the outermost ring: points measured, solid lines fits of Eq. 30 over 0 < t < 0.9 T with R_f = 0.13 R_i, drawn up to A0·T, dashed: shells in \
                   mean-field theory with periodic images.";
    built.draw("fig-13", caption, &Figure::new("", [Panel::Chart(chart)]))?;
    let value = |length: f64| delays.iter().find(|(found, _)| *found == length).and_then(|(_, delay)| *delay);
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
    let ideal: Curve =
        (0..90).map(f64::from).map(|row| (0.01 * row, cold_collapse_radius(1.0, 0.01 * row))).collect();
    if let Some(fit) = fitted(&ideal, LAST_OVER_INITIAL) {
        built.notes.push(format!(
            "A0(λ → ∞) = 1 is Eq. 13, in the open plane with R_f = 0; with R_f = 0.13 R_i held, the fit of Eq. 13 itself over \
             0 < t < 0.9 T has A0 = {:.3}. In the periodic box what neutralises λ → ∞ has 0.16 of the patch's density and slows the \
             collapse, so this box ends above that whatever the scheme.",
            fit.delay.value
        ));
    }
    Ok(built)
}

/// A0 beside that of the same fit to mean-field shells: where both are the same, what keeps A0 from 1 is in the theory.
fn of_theory(length: f64, found: Estimate, images: &Curve, plane: &Curve, last: f64) -> Option<String> {
    let [with_images, alone] = [fitted(images, last)?, fitted(plane, last)?].map(|fit| fit.delay.value);
    Some(format!(
        "{}: A0 = {}; the same fit to mean-field shells has {with_images:.3} with the box's images and {alone:.3} in the open plane.",
        ring_label(length),
        with_error(found),
    ))
}
