//! Patches against closed forms, against shells without pressure, and against the density on a mesh.

use super::*;
use crate::bessel::scaled_i0_i1;
use crate::theory::continuity::{Continuity, top_hat};
use crate::theory::jeans_time;
use crate::theory::shells::{Shell, Shells};
use core::f64::consts::PI;

const NEWTONIAN: f64 = f64::INFINITY;

/// d⟨R²⟩/dt = 4 − V0·N for an ideal gas in the open plane: the virial of its pressure and of its attraction.
#[test]
fn an_ideal_gas_keeps_to_the_virial_theorem() {
    for (strength, discs) in [(0.02, 100.0), (0.1, 100.0)] {
        let shells = 200;
        let mut patch = Patch::top_hat(discs, 30.0, shells, strength, NEWTONIAN, Pressure::IdealGas).unwrap();
        let mean = |patch: &Patch| patch.squares.iter().sum::<f64>() / shells as f64;
        let before = mean(&patch);
        patch.advance_to(20.0).unwrap();
        let found = (mean(&patch) - before) / 20.0;
        // The innermost shell has but half of its pressure.
        let expected = 4.0 - 2.0 / shells as f64 - strength * discs;
        assert!((found - expected).abs() < 1e-3, "{strength}: {found}, not {expected}");
    }
}

/// Without attraction each disc of an ideal gas diffuses by itself: a ring of radius R has the mean of Rice's distribution,
/// σ√(π/2)·e^(−x)[(1 + 2x)I₀(x) + 2xI₁(x)] with x = R²/4σ² and σ² = 2t.
#[test]
fn discs_that_are_followed_diffuse() {
    let time: f64 = 9.0;
    let rice = |radius: f64| {
        let variance = 2.0 * time;
        let x = 0.25 * radius * radius / variance;
        let (i0, i1) = scaled_i0_i1(x);
        (0.5 * PI * variance).sqrt() * ((1.0 + 2.0 * x) * i0 + 2.0 * x * i1)
    };
    let patch = Patch::top_hat(300.0, 30.0, 400, 0.0, NEWTONIAN, Pressure::IdealGas).unwrap();
    let mut patch = patch.following(&[(4.5, 5.5), (14.5, 15.5), (25.5, 26.5)]);
    let before = patch.mean_radii();
    patch.advance_to(time).unwrap();
    for ((radius, before), middle) in patch.mean_radii().into_iter().zip(before).zip([5.0, 15.0, 26.0]) {
        assert!((before - middle).abs() < 0.03, "{before}");
        assert!((radius / rice(middle) - 1.0).abs() < 3e-3, "{radius}, not {}", rice(middle));
    }
}

/// Discs one by one, for λ → ∞ in the open plane: n are within disc n, so that R² falls by 2V0·n a unit of time.
#[test]
fn discs_are_pulled_by_those_within() {
    let radii: Vec<f64> = (0..40).map(|disc| 10.0 + 2.0 * f64::from(disc)).collect();
    let (strength, time) = (0.89, 1.0);
    let patch = Patch::of_shells(&radii, 1.0, strength, NEWTONIAN, Pressure::None).unwrap();
    let mut patch = patch.of_discs();
    patch.advance_to(time).unwrap();
    for ((disc, before), after) in (0..).map(f64::from).zip(&radii).zip(patch.radii()) {
        let expected = (before * before - 2.0 * strength * disc * time).sqrt();
        assert!((after - expected).abs() < 1e-6, "{disc}: {after}, not {expected}");
    }
}

/// Until its shells meet, a patch without pressure is shells.
#[test]
fn without_pressure_a_patch_is_shells() {
    let (discs, radius, count) = (451.0, 183.0, 60);
    let share = discs / count as f64;
    let shell =
        |shell: usize| Shell { radius: radius * ((shell as f64 + 0.5) / count as f64).sqrt(), discs: share };
    let shells: Vec<Shell> = (0..count).map(shell).collect();
    let shells = Shells::new(&shells, 0.89, 270.0).unwrap().periodic(800.0).unwrap();
    let patch = Patch::top_hat(discs, radius, count, 0.89, 270.0, Pressure::None).unwrap();
    let mut patch = patch.periodic(800.0).unwrap();
    let time = 0.8 * jeans_time(0.89, discs / (PI * radius * radius));
    patch.advance_to(time).unwrap();
    for (found, expected) in patch.radii().iter().zip(&shells.radii_at(&[time]).unwrap()[0]) {
        assert!((found - expected).abs() < 0.01, "{found}, not {expected}");
    }
    assert!(matches!(patch.advance_to(10.0 * time), Err(EvolutionError::Stalled { .. })));
}

/// A patch that is a few lengths of Jeans wide, as meshes of which one has half the spacing of the other tell together: their
/// errors are of second order where the field changes by about kBT from cell to cell.
#[test]
fn a_patch_is_the_density_on_a_mesh() {
    let (side, discs, radius, strength, length) = (96.0, 16.0, 20.0, 0.89, 30.0);
    let density = discs / (PI * radius * radius);
    let time = 0.3 * jeans_time(strength, density);
    for pressure in [Pressure::IdealGas, Pressure::discs()] {
        let on_mesh = |cells: usize| {
            let start = top_hat(side, cells, density, radius);
            let mut mesh = Continuity::new(side, cells, strength, length, pressure, &start).unwrap();
            mesh.advance_to(time).unwrap();
            mean_radius_on_mesh(&mesh, side, cells)
        };
        let expected = (4.0 * on_mesh(48) - on_mesh(24)) / 3.0;
        let patch = Patch::top_hat(discs, radius, 50, strength, length, pressure).unwrap();
        let mut patch = patch.periodic(side).unwrap();
        patch.advance_to(time).unwrap();
        let found = mean_radius(&patch);
        assert!((found / expected - 1.0).abs() < 2e-3, "{pressure:?}: {found}, not {expected}");
    }
}

fn mean_radius(patch: &Patch) -> f64 {
    let radii = patch.radii();
    radii.iter().sum::<f64>() / radii.len() as f64
}

fn mean_radius_on_mesh(mesh: &Continuity, side: f64, cells: usize) -> f64 {
    let from_middle = |cell: usize| side * (cell as f64 / cells as f64 - 0.5);
    let radius = |index: usize| libm::hypot(from_middle(index % cells), from_middle(index / cells));
    let sum: f64 = mesh.density().iter().enumerate().map(|(index, density)| density * radius(index)).sum();
    sum / mesh.density().iter().sum::<f64>()
}

/// In the open plane at rest ⟨p/ρ⟩ = V0·N/4, and the pressure in the middle carries all above it.
#[test]
fn hard_discs_come_to_rest() {
    let patch = Patch::top_hat(60.0, 40.0, 60, 0.89, NEWTONIAN, Pressure::discs()).unwrap();
    let mut patch = patch.following(&[(10.0, 20.0), (30.0, 40.0)]);
    let jeans = jeans_time(0.89, 60.0 / (PI * 1600.0));
    patch.advance_to(2.0 * jeans).unwrap();
    let squares = patch.squares.clone();
    let densities = squares.windows(2).map(|pair| patch.discs[0] / (PI * (pair[1] - pair[0])));
    let virial = densities.map(|density| Pressure::discs().pressure(density) / density).sum::<f64>() / 60.0;
    assert!((virial / (0.25 * 0.89 * 60.0) - 1.0).abs() < 0.03, "{virial}");
    // Packed discs keep their places for long.
    let radii = patch.mean_radii();
    patch.advance_to(2.2 * jeans).unwrap();
    for (now, before) in patch.mean_radii().iter().zip(&radii) {
        assert!((now / before - 1.0).abs() < 0.02, "{now}, {before}");
    }
}

#[test]
fn more_shells_change_little() {
    let radii = |shells: usize| {
        let patch = Patch::top_hat(451.0, 183.0, shells, 0.89, 270.0, Pressure::discs()).unwrap();
        let mut patch = patch.periodic(800.0).unwrap().following(&[(52.5, 60.0), (127.5, 135.0)]);
        patch.advance_to(60.0).unwrap();
        patch.mean_radii()
    };
    let (few, many) = (radii(50), radii(100));
    for (few, many) in few.iter().zip(&many) {
        assert!((few / many - 1.0).abs() < 0.02, "{few}, {many}");
    }
}

/// Shells of another patch, laid out by hand.
#[test]
fn shells_are_followed_where_they_are() {
    let radii: [f64; 5] = [1.0, 5.0, 6.0, 8.0, 9.0];
    let patch = Patch::of_shells(&radii, 1.0, 0.0, NEWTONIAN, Pressure::IdealGas).unwrap();
    // Borders are halfway in R²: 13, 30.5, 50, 72.5 and 89.5.
    let border = |square: f64| square.sqrt();
    let ranges = [(border(13.0), border(30.5)), (border(50.0), border(72.5) + 20.0), (0.0, border(6.5))];
    let followed = patch.following(&ranges);
    let found = followed.mean_radii();
    for (found, expected) in found.iter().zip([5.0, 8.5, 1.0]) {
        assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    }
    assert!((followed.groups[2][0] - 0.5).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused() {
    let new = |radii: &[f64], discs, strength| {
        Patch::of_shells(radii, discs, strength, 270.0, Pressure::discs()).unwrap_err()
    };
    let sound = [2.0, 4.0, 6.0, 8.0];
    assert_eq!(new(&sound[..3], 1.0, 0.89), PatchError::Shells { shells: 3 });
    assert_eq!(new(&[], 1.0, 0.89), PatchError::Shells { shells: 0 });
    assert_eq!(new(&sound, -1.0, 0.89), PatchError::Discs { discs: -1.0 });
    assert_eq!(new(&[2.0, 4.0, 3.0, 8.0], 1.0, 0.89), PatchError::Radius { index: 2, radius: 3.0 });
    assert_eq!(new(&sound, 12.0, 0.89), PatchError::Radius { index: 0, radius: 2.0 });
    assert_eq!(new(&sound, 1.0, -1.0), AttractionError::Strength { strength: -1.0 }.into());
    let nothing = Patch::top_hat(9.0, f64::NAN, 10, 0.89, 270.0, Pressure::discs());
    assert!(matches!(nothing, Err(PatchError::Radius { index: 0, .. })));
    let patch = Patch::top_hat(9.0, 10.0, 10, 0.89, 270.0, Pressure::discs()).unwrap();
    assert!(matches!(patch.clone().periodic(19.9), Err(AttractionError::Side { .. })));
    let mut later = patch;
    later.advance_to(1.0).unwrap();
    assert_eq!(later.advance_to(0.5), Err(EvolutionError::Time { asked: 0.5, time: 1.0 }));
}
