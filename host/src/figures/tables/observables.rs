//! What runs are followed by: clusters (Figs. 5 and 6), energies, and steps.

use super::Named;
use super::curves::{over_time, time_axis};
use super::groups::Group;
use crate::figures::axis::{Axis, Scale};
use crate::figures::chart::{Chart, Colour};
use crate::figures::{Figure, Legend, Panel};
use crate::files::FormatError;

/// A column and how it is drawn.
struct Quantity {
    column: &'static str,
    title: &'static str,
    label: &'static str,
    unit: &'static str,
    scale: Scale,
    /// The measure in which it is drawn.
    per: Per,
}

/// What a quantity is divided by, if the configuration is known.
#[derive(Clone, Copy, PartialEq)]
enum Per {
    Nothing,
    Area,
    Disc,
}

const fn quantity(column: &'static str, title: &'static str, label: &'static str) -> Quantity {
    Quantity { column, title, label, unit: "", scale: Scale::Linear, per: Per::Nothing }
}

/// The clusters' quantities.
fn clusters(known: bool) -> [Quantity; 4] {
    let count = Quantity { per: Per::Area, ..quantity("clusters", "number density", "n_c R_0^2 / L^2") };
    [
        if known { count } else { quantity("clusters", "number", "n_c") },
        quantity("mean_cluster_size", "mean size", "S"),
        quantity("mass_weighted_cluster_size", "mass-weighted mean size", "S_m"),
        quantity("largest_cluster", "largest", "s_{max}"),
    ]
}

/// The energies.
fn energies(known: bool) -> [Quantity; 2] {
    let energy = |column, title, label, label_per_disc| Quantity {
        per: Per::Disc,
        ..quantity(column, title, if known { label_per_disc } else { label })
    };
    [
        energy("capillary_energy", "capillary", "U_{cap} / k_BT", "U_{cap} / (N k_BT)"),
        energy("repulsive_energy", "repulsive", "U_{rep} / k_BT", "U_{rep} / (N k_BT)"),
    ]
}

/// What sets the lengths of steps.
fn steps() -> [Quantity; 2] {
    let log =
        |column, title, label, unit| Quantity { unit, scale: Scale::Log, ..quantity(column, title, label) };
    [log("dt", "step length", "Δt", "(R_0^2/D)"), log("max_force", "largest force", "max |F|", "(k_BT/R_0)")]
}

/// The figures of `observables.csv`.
pub(super) fn figures(groups: &[Group]) -> Result<Vec<Named>, FormatError> {
    let known = groups.iter().all(|group| group.configuration.is_some());
    Ok(vec![
        ("clusters".to_owned(), figure("Clusters", groups, &clusters(known), known)?),
        ("energies".to_owned(), figure("Energies", groups, &energies(known), known)?),
        ("steps".to_owned(), figure("Steps", groups, &steps(), known)?),
    ])
}

/// A figure with a chart for each quantity.
fn figure(
    title: &str,
    groups: &[Group],
    quantities: &[Quantity],
    known: bool,
) -> Result<Figure, FormatError> {
    let mut panels = Vec::with_capacity(quantities.len());
    for quantity in quantities {
        let y = Axis { scale: quantity.scale, ..Axis::linear(quantity.label, quantity.unit) };
        let mut chart = Chart::new(quantity.title, time_axis(groups), y);
        for group in groups {
            let factor = match (&group.configuration, quantity.per) {
                (Some(configuration), Per::Area) if known => {
                    1.0 / (configuration.system.side * configuration.system.side)
                }
                (Some(configuration), Per::Disc) if known => 1.0 / configuration.system.particles as f64,
                _ => 1.0,
            };
            let mut series = over_time(group, &group.table, quantity.column, factor, &group.label)?;
            if groups.len() == 1 {
                series.colour = Colour::Category(0);
            }
            chart.series.push(series);
        }
        panels.push(Panel::Chart(chart));
    }
    let mut figure = Figure::new(title, panels);
    figure.columns = 2;
    figure.legend = Legend::Right;
    Ok(figure)
}
