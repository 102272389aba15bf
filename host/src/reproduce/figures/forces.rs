//! Ours: how exact the force of a pair of discs is, by distance, for each way to sum it.

use super::Built;
use super::text::{LENGTH, STRENGTH};
use crate::bessel::scaled_k0_k1;
use crate::configuration::Configuration;
use crate::engine::Engine;
use crate::figures::axis::Axis;
use crate::figures::chart::{Chart, Colour, Marker, Series as Drawn};
use crate::figures::{Figure, Panel};
use crate::files::atomic::write_atomically;
use crate::files::table::{Table, TableText};
use crate::reproduce::ReproduceError;
use crate::reproduce::campaign::Size;
use crate::reproduce::evidence::Evidence;
use crate::reproduce::finding::{Criterion, Finding};
use crate::reproduce::statistics::Curve;
use crate::statistics::Estimate;
use core::f64::consts::TAU;
use meniscus_core::dynamics::Clock;
use meniscus_core::torus::Position;
use rayon::prelude::*;
use std::path::Path;

/// Side of the box, R0.
const SIDE: f64 = 500.0;

/// Images in reach of a disc: beyond, K₁ is below e⁻²².
const IMAGES: i32 = 12;

/// What the paper says of its mesh.
const HIGH: &str = "a high accuracy down to small distances of the order of the grid spacing";

/// Of ours it says nothing.
const OURS: &str = "(ours) ten times the error asked for of all forces";

/// A way to sum the force.
struct Way {
    label: &'static str,
    overrides: &'static [&'static str],
    marker: Marker,
    /// What the paper says of it.
    paper: &'static str,
    /// Largest rms error of a pair close to contact, of V0/d, that counts as that.
    accepted: f64,
}

/// The ways compared.
const WAYS: [Way; 5] = [
    Way {
        label: "mesh alone, CIC",
        overrides: &["force.method=pm", "mesh.assignment=cic"],
        marker: Marker::Circle,
        paper: HIGH,
        accepted: 0.02,
    },
    Way {
        label: "mesh alone, TSC",
        overrides: &["force.method=pm", "mesh.assignment=tsc"],
        marker: Marker::Square,
        paper: HIGH,
        accepted: 0.02,
    },
    Way {
        label: "split, error 10^{-3}",
        overrides: &["force.accuracy=1e-3"],
        marker: Marker::Triangle,
        paper: OURS,
        accepted: 1e-2,
    },
    Way {
        label: "split, error 10^{-4}",
        overrides: &["force.accuracy=1e-4"],
        marker: Marker::Diamond,
        paper: OURS,
        accepted: 1e-3,
    },
    Way {
        label: "split, error 10^{-5}",
        overrides: &["force.accuracy=1e-5"],
        marker: Marker::Cross,
        paper: OURS,
        accepted: 1e-4,
    },
];

/// Name of the table of errors, which are the same every time and take a while.
const TABLE: &str = "forces.csv";

/// A mesh soon made, for tests.
const COARSE: Way = Way {
    label: "coarse mesh",
    overrides: &["force.method=pm", "mesh.grid=32"],
    marker: Marker::Circle,
    paper: HIGH,
    accepted: 1.0,
};

/// Errors of the capillary force of two discs in the box of Table I, by distance.
///
/// # Errors
/// [`ReproduceError`].
pub fn build(evidence: &Evidence) -> Result<Built, ReproduceError> {
    let mut built = Built::default();
    let (distances, places) = if evidence.size == Size::Tiny { (2, 1) } else { (22, 12) };
    let ways = if evidence.size == Size::Tiny { &[COARSE][..] } else { &WAYS[..] };
    let path = evidence.directory.join(TABLE);
    let curves = match kept(&path, ways, distances) {
        Some(curves) => curves,
        None => {
            let curves: Result<Vec<Curve>, ReproduceError> =
                ways.par_iter().map(|way| errors(way, distances, places)).collect();
            let curves = curves?;
            keep(&path, ways, &curves)?;
            curves
        }
    };
    let mut chart = Chart::new("", Axis::log("d", "R_0"), Axis::log("rms error of the force / (V_0/d)", ""));
    for (index, (way, curve)) in ways.iter().zip(curves).enumerate() {
        let label = way.label.replace("10^{-", "1e-").replace('}', "");
        let quantity = format!("rms error of a pair's force at 2 to 4 R0, of V0/d: {label}");
        let finding = Finding::new(quantity, way.paper, Criterion::at_most(way.accepted).ours());
        built.findings.push(finding.measured(close(&curve)));
        chart.series.push(Drawn::joined(way.label, Colour::Category(index), way.marker, curve));
    }
    let caption = "Error of the capillary force of two discs at random places in the box of Table I against the exact sum over images.";
    built.draw("forces", caption, &Figure::new("", [Panel::Chart(chart)]))?;
    built.notes.push(
        "The error that an accuracy bounds is that of the whole force on a disc among 2500 at random, relative to its rms; that of one pair \
         relative to its own force is another number, and larger at large distances, where the pair's force is small."
            .to_owned(),
    );
    Ok(built)
}

/// The rms over distances from contact to twice that.
fn close(curve: &Curve) -> Option<Estimate> {
    let squares: Vec<f64> = (curve.iter().filter(|(distance, _)| (2.0..=4.0).contains(distance)))
        .map(|(_, error)| error * error)
        .collect();
    let value = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    (!squares.is_empty()).then_some(Estimate::exact(value))
}

/// The curves of an earlier report by the same version.
fn kept(path: &Path, ways: &[Way], distances: u32) -> Option<Vec<Curve>> {
    let table = Table::read(path).ok()?.with("version", env!("CARGO_PKG_VERSION")).ok()?;
    let curve = |way: &Way| -> Option<Curve> {
        let rows = table.with("way", way.label).ok()?;
        let numbers = rows.numbers("distance").ok()?.into_iter().zip(rows.numbers("error").ok()?);
        let curve: Curve = numbers.filter_map(|(distance, error)| Some((distance?, error?))).collect();
        (curve.len() == distances as usize).then_some(curve)
    };
    ways.iter().map(curve).collect()
}

/// Writes curves for a later report.
fn keep(path: &Path, ways: &[Way], curves: &[Curve]) -> Result<(), ReproduceError> {
    let mut text = TableText::new(["version", "way", "distance", "error"]);
    for (way, curve) in ways.iter().zip(curves) {
        for (distance, error) in curve {
            let cells = [env!("CARGO_PKG_VERSION"), way.label, &distance.to_string(), &error.to_string()];
            text.row(cells);
        }
    }
    Ok(write_atomically(path, &text.into_bytes())?)
}

/// Distance and rms error relative to V0/d.
fn errors(way: &Way, distances: u32, places: u64) -> Result<Curve, ReproduceError> {
    let overrides = way.overrides.iter().map(|&text| text.to_owned());
    let overrides: Vec<String> = overrides.chain(["system.repulsion=false".to_owned()]).collect();
    let parameters = Configuration::from_preset("table-1", &overrides)?.parameters();
    let mut curve = Curve::new();
    let mut random = SplitMix(1);
    for step in 0..distances {
        // 1 to 200 R0.
        let distance = libm::pow(200.0, f64::from(step) / f64::from(distances.max(2) - 1));
        let mut squares = 0.0;
        for place in 0..places {
            // Errors are largest along the axes: every direction has its share.
            let angle = TAU * (place as f64 + random.uniform()) / places as f64;
            let (sine, cosine) = libm::sincos(angle);
            let first = [SIDE * random.uniform(), SIDE * random.uniform()].map(fraction);
            let second = [
                first[0].wrapping_add(fraction(distance * cosine)),
                first[1].wrapping_add(fraction(distance * sine)),
            ];
            let discs = [first, second].map(|[x, y]| Position::from_bits(x, y));
            let mut engine = Engine::new(&parameters, Clock::START, &discs)?;
            let forces = engine.forces()?;
            let separation = [0, 1].map(|axis| length(second[axis].wrapping_sub(first[axis])));
            let exact = exact_force(separation);
            let found = forces.first().copied().unwrap_or_default();
            squares +=
                (found[0] - exact[0]) * (found[0] - exact[0]) + (found[1] - exact[1]) * (found[1] - exact[1]);
        }
        curve.push((distance, (squares / places as f64).sqrt() * distance / STRENGTH));
    }
    Ok(curve)
}

/// A length in R0 as a fraction of the box; a whole box more or less makes no difference.
fn fraction(length: f64) -> u32 {
    ((length / SIDE * 4_294_967_296.0) as i64) as u32
}

/// The nearest image of a difference, R0.
fn length(difference: u32) -> f64 {
    f64::from(difference.cast_signed()) / 4_294_967_296.0 * SIDE
}

/// The force on a disc by another at `separation` and all its images, kBT/R0.
fn exact_force(separation: [f64; 2]) -> [f64; 2] {
    let mut force = [0.0; 2];
    for column in -IMAGES..=IMAGES {
        for row in -IMAGES..=IMAGES {
            let [x, y] = [separation[0] + SIDE * f64::from(column), separation[1] + SIDE * f64::from(row)];
            let distance = libm::hypot(x, y);
            let argument = distance / LENGTH;
            let magnitude = STRENGTH / LENGTH * scaled_k0_k1(argument).1 * libm::exp(-argument);
            force[0] += magnitude * x / distance;
            force[1] += magnitude * y / distance;
        }
    }
    force
}

/// Places that are the same every time; of Steele, Lea and Flood (2014).
struct SplitMix(u64);

impl SplitMix {
    /// Evenly from 0 to 1.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^= mixed >> 31;
        (mixed >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_by_the_exact_force_is_that_of_the_open_plane() {
        let [x, y] = exact_force([2.0, 0.0]);
        assert!((x / (STRENGTH / 2.0) - 1.0).abs() < 1e-3 && y.abs() < 1e-12, "{x} {y}");
    }

    #[test]
    fn half_a_box_away_images_cancel() {
        let [x, y] = exact_force([250.0, 250.0]);
        assert!(x.abs() < 1e-9 && y.abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn fractions_wrap() {
        assert!((length(fraction(-3.0)) + 3.0).abs() < 1e-6);
        assert!((length(fraction(497.0)) + 3.0).abs() < 1e-6);
    }
}
