//! Fig. 2: growth of the unstable modes beside Eq. 10.

use super::{Built, time_axis};
use crate::configuration::Configuration;
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Dash, Marker, Series as Drawn};
use crate::figures::{Figure, Panel};
use crate::observables::density::Density;
use crate::observables::modes::growth::{Growth, growth_ratio};
use crate::observables::series::Series;
use crate::observables::waves::Waves;
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Campaign;
use crate::reproduce::evidence::{Evidence, FinishedRun, curves};
use crate::reproduce::finding::{Criterion, Finding};
use crate::simulation::torus;
use crate::start;
use crate::statistics::Estimate;
use crate::theory::continuity::Continuity;
use crate::theory::{Instability, Pressure};

/// Shells of which the growth is drawn, at most.
const DRAWN: usize = 8;

/// By how much each is shifted up.
const SHIFT: f64 = 1.0;

/// Rows that are drawn: each so many-th.
const THINNED: usize = 3;

/// Up to where waves are long, k/K: beyond, pressure, noise and what clusters are about to do to it matter.
const LONG: f64 = 0.2;

/// Width of the cells of the mean-field solution, R0, at least: enough for k < K_c = 0.24/R0.
const CELL: f64 = 4.0;

/// Times at which the mean-field solution is drawn.
const DRAWN_TIMES: u32 = 15;

/// What is known of a shell of waves in one run.
struct ShellOfRun {
    shell: f64,
    wavenumber: f64,
    /// Time (t/T) and mean power.
    powers: Vec<(f64, f64)>,
}

/// Fig. 2.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let runs = evidence.of(Campaign::Modes);
    let mut built = Built::default();
    let theory = runs.first().and_then(|run| run.configuration.instability());
    let mut all = Vec::new();
    for run in &runs {
        all.push(shells(run)?);
    }
    let mut panels = Vec::new();
    if let (Some(run), Some(theory), Some(first)) = (runs.first(), theory, all.first()) {
        panels.push(Panel::Chart(growth_chart(&runs, first, &theory, &run.configuration)?));
        panels.push(Panel::Chart(rate_chart(&runs, &all, &theory)));
    }
    let caption = "(a) Growth of the modes by shells of wavenumbers, each shifted up by 1: points measured, solid lines Eq. 10, dashed lines \
                   Eq. 10 with thermal noise, dotted lines the mean-field density (Eq. 6, nonlinear) from the start of one run. (b) Growth rate over that of Eq. 10 by wavenumber, noise taken into account.";
    let mut figure = Figure::new("", panels);
    figure.panel_height = 360.0;
    built.draw("fig-2", caption, &figure)?;
    let long = |time: f64| theory.and_then(|theory| ratio(&runs, &all, &theory, time, 0.0..LONG));
    for time in [0.5, 1.0] {
        let quantity = format!("growth rate over Eq. 10, k < 0.2 K, 0 to {time} T");
        let criterion = Criterion::equals(1.0, 0.01).with_errors(3.0, 0.02).ours();
        built.findings.push(Finding::new(quantity, "very good agreement", criterion).measured(long(time)));
    }
    let criterion = Criterion::equals(1.0, 0.05).with_errors(3.0, 0.02).ours();
    built.findings.push(
        Finding::new(
            "growth rate over Eq. 10, k < 0.2 K, 0 to 1.5 T",
            "very good agreement up to ≈ 1.5 T",
            criterion,
        )
        .measured(long(1.5)),
    );
    for (from, to) in [(0.2, 0.4), (0.4, 0.6), (0.6, 0.8)] {
        let quantity = format!("growth rate over Eq. 10, {from} K < k < {to} K, 0 to 1 T");
        let criterion = Criterion::equals(1.0, 0.1).with_errors(3.0, 0.03).ours();
        let measured = theory.and_then(|theory| ratio(&runs, &all, &theory, 1.0, from..to));
        built.findings.push(
            Finding::new(quantity, "very good agreement; modes with k < K_c are shown", criterion)
                .measured(measured),
        );
    }
    built.notes.push(
        "A rate is the one of which ⟨|ρ̂_k(t)|²⟩ = |ρ̂_k(0)|² exp(2t/τ) + N k² τ [exp(2t/τ) − 1] is true of the measured powers: thermal motion \
         adds the second term, without which noise would count as growth. Errors: jackknife over runs and shells, of the degrees of freedom of the runs alone."
            .to_owned(),
    );
    built.notes.push(
        "Agreement is asked for within 1 % for k < 0.2 K up to T, within 5 % up to 1.5 T, and within 10 % for shorter waves: the paper says \
         \"very good\" of a logarithmic plot."
            .to_owned(),
    );
    Ok(built)
}

/// The shells of a run's table, in rising order.
fn shells(run: &FinishedRun) -> Result<Vec<ShellOfRun>, ReproduceError> {
    let numbers = run.column(Series::Modes, "shell", None)?;
    let wavenumbers = run.column(Series::Modes, "wavenumber", None)?;
    let powers = run.column(Series::Modes, "power", None)?;
    let mut shells: Vec<ShellOfRun> = Vec::new();
    let rows = numbers.into_iter().zip(wavenumbers).zip(powers);
    for (((time, shell), (_, wavenumber)), (_, power)) in rows {
        let (Some(shell), Some(wavenumber), Some(power)) = (shell, wavenumber, power) else { continue };
        match shells.iter_mut().find(|found| found.shell == shell) {
            Some(found) => found.powers.push((time, power)),
            None => shells.push(ShellOfRun { shell, wavenumber, powers: vec![(time, power)] }),
        }
    }
    Ok(shells)
}

/// ln |ρ̂(t)|/|ρ̂(0)| in time, by shells below K_c.
fn growth_chart(
    runs: &[&FinishedRun],
    shells: &[ShellOfRun],
    theory: &Instability,
    configuration: &Configuration,
) -> Result<Chart, ReproduceError> {
    let critical = theory.critical_wavenumber().unwrap_or(f64::INFINITY);
    let unstable: Vec<&ShellOfRun> = shells.iter().filter(|shell| shell.wavenumber < critical).collect();
    let every = unstable.len().div_ceil(DRAWN).max(1);
    let chosen: Vec<&&ShellOfRun> = unstable.iter().skip(every / 2).step_by(every).collect();
    let mut chart = Chart::new("", time_axis(), Axis::linear("ln |ρ_k(t)| / |ρ_k(0)|", ""));
    let until = configuration.time.until;
    let mean_field = mean_field(configuration).unwrap_or_default();
    let mut lines = Vec::new();
    for (index, shell) in chosen.iter().enumerate() {
        let shift = SHIFT * (chosen.len() - 1 - index) as f64;
        let colour = Colour::ordered(index, chosen.len());
        let measured = curves(runs, Series::Modes, "log_growth", Some(("shell", shell.shell)))?.means();
        let points = measured.into_iter().step_by(THINNED).map(|(time, mean)| {
            (time, mean.value + shift, Some(mean.error).filter(|error| error.is_finite()))
        });
        let label = format!("k = {:.2} K", shell.wavenumber / theory.jeans_wavenumber);
        chart.series.push(Drawn::points(&label, colour, Marker::numbered(index), points));
        let rate = theory.growth_rate(shell.wavenumber) * theory.jeans_time;
        let label = |text: &'static str| if index == 0 { text } else { "" };
        let line = [0.0, until].map(|time| (time, shift + rate * time));
        lines.push(Drawn::line(label("Eq. 10"), Colour::Black, Dash::Solid, line));
        let noisy = (0..=60)
            .map(|step| until * f64::from(step) / 60.0)
            .map(|time| (time, shift + noisy_growth(shell.wavenumber, theory, time)));
        lines.push(Drawn::line(label("Eq. 10 and noise"), Colour::Grey, Dash::Dashed, noisy));
        let solved = mean_field.iter().filter_map(|(time, growth)| {
            Some((*time, shift + growth.get((shell.shell as usize).checked_sub(1)?).copied().flatten()?))
        });
        lines.push(Drawn::line(label("Eq. 6, one start"), colour, Dash::Dotted, solved));
    }
    chart.series.extend(lines);
    Ok(chart)
}

/// Time and ln |ρ̂(t)|/|ρ̂(0)| by shells, from 1, of the mean-field density that begins where the discs of a run do.
fn mean_field(configuration: &Configuration) -> Option<Vec<(f64, Vec<Option<f64>>)>> {
    let torus = torus(configuration).ok()?;
    let system = &configuration.system;
    let positions = start::random(&torus, system.particles, configuration.seed).ok()?;
    let mut cells = 16;
    while cells < 128 && system.side > 2.0 * CELL * cells as f64 {
        cells *= 2;
    }
    let density = Density::new(&torus, &positions, system.side / cells as f64).ok()?;
    let mut solution = Continuity::new(
        system.side,
        density.grid(),
        system.capillary_strength,
        system.capillary_length,
        Pressure::IdealGas,
        density.values(),
    )
    .ok()?;
    let before = solution.spectrum();
    let shells = cells / 2 - 1;
    let jeans = configuration.jeans_time()?;
    let mut drawn = vec![(0.0, vec![Some(0.0); shells])];
    for step in 1..=DRAWN_TIMES {
        let time = configuration.time.until * f64::from(step) / f64::from(DRAWN_TIMES);
        if solution.advance_to(time * jeans).is_err() {
            break;
        }
        drawn.push((time, solution.spectrum().log_growth(&before, shells)));
    }
    Some(drawn)
}

/// The mean of ln |ρ̂_k(t)|/|ρ̂_k(0)| where discs at random begin with |ρ̂_k|² = N and noise adds to the growth:
/// ½ ln(e^{2t/τ} + k²τ[e^{2t/τ} − 1]), as both amplitudes are normally distributed.
fn noisy_growth(wavenumber: f64, theory: &Instability, time_over_jeans: f64) -> f64 {
    let rate = theory.growth_rate(wavenumber);
    let twice = 2.0 * rate * time_over_jeans * theory.jeans_time;
    let gain = libm::expm1(twice);
    let noise = if rate == 0.0 { 0.0 } else { wavenumber * wavenumber / rate };
    0.5 * libm::log(1.0 + gain * (1.0 + noise))
}

/// Growth rates over that of theory by wavenumber, at three times.
fn rate_chart(runs: &[&FinishedRun], all: &[Vec<ShellOfRun>], theory: &Instability) -> Chart {
    let mut chart = Chart::new(
        "",
        Axis::linear("k / K", "").range(0.0, 1.0),
        Axis::linear("rate / rate of Eq. 10", "").range(0.5, 1.5),
    );
    chart.series.push(Drawn::line("", Colour::Grey, Dash::Dotted, [(0.0, 1.0), (1.0, 1.0)]));
    for (index, time) in [0.5, 1.0, 1.5].into_iter().enumerate() {
        let points = (0..9).filter_map(|bin| {
            let (from, to) = (0.1 * f64::from(bin), 0.1 * f64::from(bin + 1));
            let measured = ratio(runs, all, theory, time, from..to)?;
            // Beside each other.
            Some((0.5 * (from + to) + 0.015 * (index as f64 - 1.0), measured.value, measured.error))
        });
        let label = format!("0 to {time} T");
        chart.series.push(Drawn::points(&label, Colour::Category(index), Marker::numbered(index), points));
    }
    chart
}

/// The growth rate up to a time (t/T) over that of theory, of all shells with k/K in `range`.
fn ratio(
    runs: &[&FinishedRun],
    all: &[Vec<ShellOfRun>],
    theory: &Instability,
    time: f64,
    range: core::ops::Range<f64>,
) -> Option<Estimate> {
    let mut modes = Vec::new();
    for (run, shells) in runs.iter().zip(all) {
        let count = run.configuration.system.particles as f64;
        for shell in
            shells.iter().filter(|shell| range.contains(&(shell.wavenumber / theory.jeans_wavenumber)))
        {
            let first = shell.powers.first()?;
            let later = shell.powers.iter().find(|(row, _)| *row >= time - 1e-9)?;
            let waves = number_of_waves(shell.shell as u32);
            let elapsed = (later.0 - first.0) * theory.jeans_time;
            modes.push(Growth {
                initial_power: waves * first.1,
                later_power: waves * later.1,
                thermal_power: waves * 2.0 * count * shell.wavenumber * shell.wavenumber * elapsed,
                exponent: elapsed * theory.growth_rate(shell.wavenumber),
            });
        }
    }
    // The shells of a run may not be as independent of each other as runs are: no surer than these.
    growth_ratio(&modes).map(|ratio| ratio.of_degrees(runs.len() as f64 - 1.0))
}

/// How many waves a shell has.
fn number_of_waves(shell: u32) -> f64 {
    Waves::of_shells(shell).shells().last().map_or(0.0, |last| last.waves.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_hardly_touches_long_waves_and_keeps_short_ones_from_decay() {
        let theory = Instability::of_ideal_gas(0.89, 0.01, 270.0).unwrap();
        let [long, short] = [0.1, 0.99].map(|ratio| ratio * theory.jeans_wavenumber);
        let rate = theory.growth_rate(long) * theory.jeans_time;
        assert!((noisy_growth(long, &theory, 1.0) / rate - 1.0).abs() < 0.02);
        assert!(noisy_growth(short, &theory, 1.0) > 5.0 * theory.growth_rate(short) * theory.jeans_time);
    }

    #[test]
    fn shells_have_the_waves_of_half_a_ring() {
        assert_eq!(number_of_waves(1), 4.0);
        assert!((number_of_waves(20) / (20.0 * core::f64::consts::PI) - 1.0).abs() < 0.15);
    }
}
