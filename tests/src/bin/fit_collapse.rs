//! Fits Eq. 30 for `tests/observables/run`, which compares the outcome with SciPy's.
//!
//! usage: `fit_collapse UNTIL R_i|free R_f|free < samples`, a sample a line: t/T and R (R0). Prints A0, R_i and R_f, each
//! with its error, and the residual.

use meniscus::observables::collapse_fit::{CollapseFit, Conditions, fit};
use std::error::Error;
use std::io::Write;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let mut word = || words.next().ok_or("usage: fit_collapse UNTIL R_i|free R_f|free");
    let radius = |word: String| if word == "free" { Ok(None) } else { word.parse().map(Some) };
    let until = word()?.parse()?;
    let conditions = Conditions { initial_radius: radius(word()?)?, final_radius: radius(word()?)?, until };
    let mut samples: Vec<(f64, f64)> = Vec::new();
    for line in std::io::stdin().lines() {
        let line = line?;
        let (time, radius) = line.split_once(' ').ok_or("a sample is two numbers")?;
        samples.push((time.parse()?, radius.parse()?));
    }
    let CollapseFit { delay, initial_radius, final_radius, residual, .. } = fit(&samples, &conditions)?;
    let mut out = std::io::stdout();
    for estimate in [delay, initial_radius, final_radius] {
        write!(out, "{} {} ", estimate.value, estimate.error)?;
    }
    writeln!(out, "{residual}")?;
    Ok(())
}
