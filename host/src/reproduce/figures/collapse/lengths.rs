//! Fig. 13: the outermost ring of a cold patch at several capillary lengths.

use super::theory::{lines, of_ring};
use super::{DELAY, add, delay, groups, radii, ring_label};
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash};
use crate::figures::{Figure, Panel};
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Campaign;
use crate::reproduce::evidence::Evidence;
use crate::reproduce::figures::{Built, time_axis};
use crate::reproduce::finding::{Criterion, Finding, with_error};
use crate::reproduce::statistics::Curve;

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
        let theory = of_ring(&run.configuration, outermost).unwrap_or_default();
        delays.push((length, delay(&curves, last), collapse_time(&theory, last)));
        theories.push(theory);
    }
    chart.series.extend(lines(&theories, "mean-field shells", Colour::Black, Dash::Dashed));
    let caption = "Radius of the outermost ring: points measured, solid lines fits of Eq. 30 over 0 < t < 0.9 T with R_f = 0.13 R_i, drawn up to A0·T, dashed: shells in \
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

/// When a shell of theory has come down to R_f (R0), T.
fn collapse_time(theory: &Curve, last: f64) -> Option<f64> {
    theory.iter().find(|(_, radius)| *radius <= last).map(|(time, _)| *time)
}
