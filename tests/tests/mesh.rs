//! The mesh force: its field, its net force, its self-force, its symmetries.

use core::f64::consts::PI;
use meniscus_core::dynamics::{Clock, Dynamics};
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve};
use meniscus_core::parameters::{
    Assignment, Gradient, Influence, LARGEST_SPLITTING_OF_SPACING, Method, Noise, Parameters,
};
use meniscus_core::stages::Scalar;
use meniscus_core::torus::Position;
use meniscus_core::transform::{AnySize, Complex32, FixedSize, LineTransform};
use meniscus_core::units::force_from_units;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::long_tests;
use meniscus_tests::reference::{rms, rms_difference};
use meniscus_tests::states::{crowded, lattice, scattered, shuffled, with_ids};
use meniscus_tests::tolerances::{
    FEW_ALIASES, FORCE_QUANTUM, LINEARITY, MESH_FIELD, MESH_NET_FORCE, SELF_FORCE, SYMMETRY,
};

/// The attraction alone, in a box whose mesh spacing is near 1.
const ATTRACTION: Parameters = Parameters {
    side: 30.0,
    capillary_length: 20.0,
    repulsion: false,
    grid: 32,
    noise: Noise::None,
    ..Parameters::DEFAULT
};

/// The far part of a split force on the same mesh.
const FAR_PART: Parameters = Parameters {
    method: Method::P3m,
    influence: Influence::Optimal,
    splitting: 0.5,
    cutoff: 6.0,
    ..ATTRACTION
};

/// Every assignment of the paper's method with every influence function and every gradient, and the higher orders.
fn all_schemes() -> impl Iterator<Item = Parameters> {
    let higher =
        Assignment::ALL.into_iter().skip(2).map(|assignment| Parameters { assignment, ..ATTRACTION });
    low_orders().chain(higher)
}

/// The paper's method and the split one, all orders.
fn both_methods() -> impl Iterator<Item = Parameters> {
    all_schemes().chain(Assignment::ALL.map(|assignment| Parameters { assignment, ..FAR_PART }))
}

/// Every influence function and every gradient with the two lowest orders.
fn low_orders() -> impl Iterator<Item = Parameters> {
    let assignments = [Assignment::CloudInCell, Assignment::TriangularShapedCloud];
    let influences = [Influence::Paper, Influence::Continuum];
    let gradients = [Gradient::Spectral, Gradient::Difference2, Gradient::Difference4];
    assignments.into_iter().flat_map(move |assignment| {
        influences.into_iter().flat_map(move |influence| {
            gradients.map(|gradient| Parameters { assignment, influence, gradient, ..ATTRACTION })
        })
    })
}

/// Forces by id, unit 2⁻²⁴ kBT/R0.
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn quantised_forces(parameters: &Parameters, discs: &[(u32, Position)]) -> Vec<(i64, i64)> {
    let mut arrays = Arrays::new(parameters.grid, 8, discs.len());
    let discs = discs.iter().copied();
    let dynamics = Dynamics::new(parameters, Clock::START, discs, &mut arrays.memory()).unwrap();
    dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory()).unwrap();
    arrays.slots.iter().map(|&slot| (arrays.force_x[slot as usize], arrays.force_y[slot as usize])).collect()
}

/// Forces by id, kBT/R0.
fn forces(parameters: &Parameters, discs: &[Position]) -> Vec<[f64; 2]> {
    let forces = quantised_forces(parameters, &with_ids(discs));
    forces.into_iter().map(|(x, y)| [force_from_units(x), force_from_units(y)]).collect()
}

fn modulus(force: [f64; 2]) -> f64 {
    libm::hypot(force[0], force[1])
}

/// Node masses of a few scattered discs, unit 2⁻²⁰ discs, without the assignment's smoothing.
fn masses(grid: usize) -> Vec<u32> {
    let mut nodes = vec![0; grid * grid];
    for disc in scattered(1, grid) {
        let node = (disc.x.to_bits() as usize % grid) * grid + disc.y.to_bits() as usize % grid;
        nodes[node] += disc.x.to_bits() >> 11;
    }
    nodes
}

#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
fn field<T: LineTransform>(
    transform: &T,
    parameters: &Parameters,
    rows: usize,
    nodes: &[u32],
) -> Vec<Complex32> {
    let grid = parameters.grid;
    let (mut influence, mut gradient) = (vec![0.0; influence_length(grid)], vec![0.0; grid]);
    fill_influence(parameters, &mut influence);
    fill_gradient(parameters, &mut gradient);
    let tables = Tables { influence: &influence, gradient: &gradient };
    let junk = Complex32::new(7.0, 7.0);
    let (mut field, mut lines) = (vec![junk; grid * grid], vec![junk; 2 * grid * rows]);
    solve(transform, Grid::new(grid).unwrap(), &tables, nodes, &mut field, &mut lines);
    field
}

/// Hockney and Eastwood's optimal influence function for a mesh wave (l, m), R0²: the one that makes the mean square
/// error of the force least when the target is exp(−(k²+κ²)/4α²)/(k²+κ²), by sums over aliases k + 2π(p, q)/h.
///
/// With W the transform of the assignment's window, Σ W² (D·k_pq) φ(k_pq) / (|D|² (Σ W²)²), where D is the gradient of
/// the mesh: k, but zero along an axis where k is Nyquist's.
fn optimal_influence(parameters: &Parameters, (l, m): (i32, i32)) -> f64 {
    let (grid, side) = (parameters.grid as i32, parameters.side);
    let wave_number = |frequency: i32| 2.0 * PI * f64::from(frequency) / side;
    let kappa = 1.0 / parameters.capillary_length;
    let window_squared = |frequency: i32| {
        let half_phase = PI * f64::from(frequency) / f64::from(grid);
        let sinc = if frequency == 0 { 1.0 } else { libm::sin(half_phase) / half_phase };
        libm::pow(sinc * sinc, parameters.assignment.order() as f64)
    };
    let slope = |frequency: i32| if frequency == -grid / 2 { 0.0 } else { wave_number(frequency) };
    let [along_x, along_y] = [slope(l), slope(m)];
    let aliases = |frequency: i32, reach: i32| (-reach..=reach).map(move |p| frequency + p * grid);
    // Of the target little is left at the first alias and nothing at the fourth.
    let mut numerator = 0.0;
    for l in aliases(l, 4) {
        for m in aliases(m, 4) {
            let (kx, ky) = (wave_number(l), wave_number(m));
            let squared = kx * kx + ky * ky + kappa * kappa;
            let target = libm::exp(-squared / (4.0 * parameters.splitting * parameters.splitting)) / squared;
            numerator += window_squared(l) * window_squared(m) * (along_x * kx + along_y * ky) * target;
        }
    }
    let sum = |frequency: i32| aliases(frequency, 200).map(window_squared).sum::<f64>();
    let denominator = sum(l) * sum(m);
    let slope_squared = along_x * along_x + along_y * along_y;
    if slope_squared == 0.0 { 0.0 } else { numerator / (slope_squared * denominator * denominator) }
}

/// F = Σ_k i k̃ · 2πV0 ρ̂/(k̃² + κ²) exp(ikr) by direct sums in binary64, from Eqs. 18 to 21 as corrected.
fn direct_field(parameters: &Parameters, nodes: &[u32]) -> Vec<[f64; 2]> {
    let (grid, side) = (parameters.grid as i32, parameters.side);
    let h = side / f64::from(grid);
    let phase = |index: i32| 2.0 * PI * f64::from(index.rem_euclid(grid)) / f64::from(grid);
    let squared = |k: f64| match parameters.influence {
        Influence::Paper => 4.0 / (h * h) * libm::pow(libm::sin(k * h / 2.0), 2.0),
        Influence::Continuum | Influence::Optimal => k * k,
    };
    let slope = |frequency: i32, k: f64| match parameters.gradient {
        _ if frequency == -grid / 2 => 0.0,
        Gradient::Spectral => k,
        Gradient::Difference2 => libm::sin(k * h) / h,
        Gradient::Difference4 => 4.0 / 3.0 * libm::sin(k * h) / h - libm::sin(2.0 * k * h) / (6.0 * h),
    };
    let mut field = vec![[0.0; 2]; nodes.len()];
    for l in -grid / 2..grid / 2 {
        for m in -grid / 2..grid / 2 {
            if (l, m) == (0, 0) {
                continue;
            }
            let (kx, ky) = (2.0 * PI * f64::from(l) / side, 2.0 * PI * f64::from(m) / side);
            let (mut real, mut imaginary) = (0.0, 0.0);
            for (element, &mass) in nodes.iter().enumerate().filter(|&(_, &mass)| mass > 0) {
                let angle = phase(l * (element as i32 / grid) + m * (element as i32 % grid));
                real += f64::from(mass) * libm::cos(angle);
                imaginary -= f64::from(mass) * libm::sin(angle);
            }
            let kappa = 1.0 / parameters.capillary_length;
            let influence = match parameters.influence {
                Influence::Optimal => optimal_influence(parameters, (l, m)),
                _ => 1.0 / (squared(kx) + squared(ky) + kappa * kappa),
            };
            let factor = 2.0 * PI * parameters.capillary_strength / (side * side) / 1_048_576.0 * influence;
            for (element, force) in field.iter_mut().enumerate() {
                let angle = phase(l * (element as i32 / grid) + m * (element as i32 % grid));
                // The real part of i·ρ̂·exp(ikr).
                let wave = -factor * (imaginary * libm::cos(angle) + real * libm::sin(angle));
                force[0] += slope(l, kx) * wave;
                force[1] += slope(m, ky) * wave;
            }
        }
    }
    field
}

fn wide(field: &[Complex32]) -> Vec<[f64; 2]> {
    field.iter().map(|force| [f64::from(force.re), f64::from(force.im)]).collect()
}

#[test]
fn the_field_is_that_of_a_direct_fourier_sum() {
    let nodes = masses(16);
    let mut worst: f64 = 0.0;
    let far_parts = Assignment::ALL.map(|assignment| Parameters { assignment, cutoff: 5.0, ..FAR_PART });
    for scheme in low_orders().take(6).chain(far_parts) {
        let parameters = Parameters { grid: 16, side: 14.0, ..scheme };
        let exact = direct_field(&parameters, &nodes);
        let error = rms_difference(&wide(&field(&AnySize, &parameters, 8, &nodes)), &exact) / rms(&exact);
        let split_by_linear_weights =
            parameters.method == Method::P3m && parameters.assignment == Assignment::CloudInCell;
        let allowed = if split_by_linear_weights { FEW_ALIASES } else { MESH_FIELD };
        worst = worst.max(error / allowed);
        assert!(error <= allowed, "{error:e}: {parameters:?}");
    }
    println!("mesh field against a direct sum: {worst:.2} of what is accepted");
}

#[test]
fn layout_and_size_of_working_memory_change_no_bit() {
    for grid in [16, 32, 64] {
        let nodes = masses(grid);
        let parameters = Parameters { grid, ..ATTRACTION };
        let expected = field(&AnySize, &parameters, 1, &nodes);
        for rows in [2, 3, 8, 17, grid / 2 + 1, grid] {
            assert_eq!(field(&AnySize, &parameters, rows, &nodes), expected, "{rows} rows of {grid}");
        }
    }
}

#[test]
fn a_size_known_at_compile_time_changes_no_bit() {
    let parameters = Parameters { grid: 64, ..ATTRACTION };
    let nodes = masses(64);
    assert_eq!(field(&FixedSize::<64>, &parameters, 8, &nodes), field(&AnySize, &parameters, 8, &nodes));
}

#[test]
fn mesh_forces_sum_to_zero_within_rounding() {
    let mut worst: f64 = 0.0;
    for scheme in both_methods() {
        for discs in [scattered(1, 200), crowded(2, 200, 0.2), crowded(3, 2, 0.1)] {
            let forces = forces(&scheme, &discs);
            let total: f64 = forces.iter().map(|&force| modulus(force)).sum();
            let net = modulus([forces.iter().map(|f| f[0]).sum(), forces.iter().map(|f| f[1]).sum()]);
            worst = worst.max(net / total);
            assert!(net <= MESH_NET_FORCE * total, "{:e}: {scheme:?}", net / total);
        }
    }
    println!("net mesh force: {worst:.2e} of the sum of the moduli");
}

#[test]
fn a_lone_disc_does_not_pull_itself() {
    let mut worst: f64 = 0.0;
    for scheme in both_methods() {
        for (grid, side, count) in [(16, 16.0, 30), (32, 30.0, 10), (64, 500.0, 2)] {
            let spacing = side / grid as f64;
            let (splitting, cutoff) = (0.5 / spacing, 6.0 * spacing);
            let parameters = Parameters { grid, side, splitting, cutoff, ..scheme };
            let scale = parameters.capillary_strength / (side / grid as f64);
            for disc in scattered(7, count) {
                let pull = modulus(forces(&parameters, &[disc])[0]) / scale;
                worst = worst.max(pull);
                assert!(pull <= SELF_FORCE, "{pull:e} V0/h: {parameters:?}");
            }
        }
    }
    println!("self-force: {worst:.2e} V0/h");
}

#[test]
fn two_discs_attract_each_other() {
    // Off the axes and nodes of the mesh, where the spectral gradient rings.
    let discs = [Position::from_bits(1 << 30, 1 << 30), Position::from_bits(0x6E6E_0000, 0x5252_0000)];
    let (dx, dy) = (30.0 * f64::from(0x2E6E) / 65536.0, 30.0 * f64::from(0x1252) / 65536.0);
    let distance = libm::hypot(dx, dy);
    for scheme in both_methods() {
        let forces = forces(&scheme, &discs);
        for (force, sign) in forces.iter().zip([1.0, -1.0]) {
            // V0·K1(d/λ)/λ ≈ V0/d, less the pull of the images; a mesh is off by some per cent.
            let pull = sign * (force[0] * dx + force[1] * dy) / distance;
            let share = pull / (scheme.capillary_strength / distance);
            assert!(share > 0.6 && share < 1.2, "{share} of V0/d: {scheme:?}");
        }
    }
}

/// rms difference over rms of the forces on `moved` discs and the forces `expected` of them.
fn relative_error(parameters: &Parameters, moved: &[Position], expected: &[[f64; 2]]) -> f64 {
    rms_difference(&forces(parameters, moved), expected) / rms(expected)
}

#[test]
fn mesh_forces_turn_with_the_discs() {
    let mut worst: f64 = 0.0;
    for scheme in both_methods() {
        let discs = scattered(4, 150);
        let expected: Vec<_> = forces(&scheme, &discs).into_iter().map(|[x, y]| [-y, x]).collect();
        let turned: Vec<_> = discs
            .iter()
            .map(|disc| Position::from_bits(disc.y.to_bits().wrapping_neg(), disc.x.to_bits()))
            .collect();
        let error = relative_error(&scheme, &turned, &expected);
        worst = worst.max(error);
        assert!(error <= SYMMETRY, "{error:e}: {scheme:?}");
    }
    println!("turned by 90 degrees: {worst:.2e}");
}

#[test]
fn mesh_forces_are_mirrored_with_the_discs() {
    let mut worst: f64 = 0.0;
    for scheme in both_methods() {
        let discs = scattered(5, 150);
        let original = forces(&scheme, &discs);
        let mirrored: Vec<_> = discs
            .iter()
            .map(|disc| Position::from_bits(disc.x.to_bits().wrapping_neg(), disc.y.to_bits()))
            .collect();
        let exchanged: Vec<_> = discs.iter().map(|disc| Position { x: disc.y, y: disc.x }).collect();
        let of_mirrored: Vec<_> = original.iter().map(|&[x, y]| [-x, y]).collect();
        let of_exchanged: Vec<_> = original.iter().map(|&[x, y]| [y, x]).collect();
        for (discs, expected) in [(&mirrored, &of_mirrored), (&exchanged, &of_exchanged)] {
            let error = relative_error(&scheme, discs, expected);
            worst = worst.max(error);
            assert!(error <= SYMMETRY, "{error:e}: {scheme:?}");
        }
    }
    println!("mirrored: {worst:.2e}");
}

#[test]
fn mesh_forces_do_not_see_a_shift_by_whole_cells() {
    let mut worst: f64 = 0.0;
    for scheme in both_methods() {
        let discs = scattered(6, 150);
        let expected = forces(&scheme, &discs);
        for (columns, rows) in [(1_u32, 0_u32), (0, 1), (7, 19), (16, 16), (31, 31)] {
            let shift = |bits: u32, cells: u32| bits.wrapping_add(cells << 27);
            let shifted: Vec<_> = discs
                .iter()
                .map(|p| Position::from_bits(shift(p.x.to_bits(), columns), shift(p.y.to_bits(), rows)))
                .collect();
            let error = relative_error(&scheme, &shifted, &expected);
            worst = worst.max(error);
            assert!(error <= SYMMETRY, "{error:e}: {scheme:?}");
        }
    }
    println!("shifted by whole cells: {worst:.2e}");
}

#[test]
fn forces_double_with_v0_to_a_quantum() {
    let discs = with_ids(&scattered(8, 150));
    for scheme in all_schemes() {
        let single = quantised_forces(&scheme, &discs);
        let strength = 2.0 * scheme.capillary_strength;
        let double = quantised_forces(&Parameters { capillary_strength: strength, ..scheme }, &discs);
        // A power of two scales every number of the graph exactly; only quantising differs.
        for ((x, y), (x_double, y_double)) in single.into_iter().zip(double) {
            assert!((2 * x - x_double).abs() <= 1 && (2 * y - y_double).abs() <= 1);
        }
    }
}

#[test]
fn forces_are_linear_in_v0() {
    let discs = scattered(9, 150);
    for scheme in all_schemes() {
        let unit = forces(&scheme, &discs);
        let largest = unit.iter().map(|&force| modulus(force)).fold(0.0, f64::max);
        for factor in [1e-3, 0.3, 3.0, 1000.0] {
            let strength = factor * scheme.capillary_strength;
            let scaled = forces(&Parameters { capillary_strength: strength, ..scheme }, &discs);
            let bound = factor * (LINEARITY * largest + FORCE_QUANTUM) + FORCE_QUANTUM;
            for (unit, scaled) in unit.iter().zip(scaled) {
                let off = modulus([factor * unit[0] - scaled[0], factor * unit[1] - scaled[1]]);
                assert!(off <= bound, "{off:e} at factor {factor}: {scheme:?}");
            }
        }
    }
}

#[test]
fn mesh_forces_do_not_depend_on_storage_order() {
    let discs = with_ids(&crowded(10, 300, 0.4));
    for scheme in both_methods() {
        assert_eq!(quantised_forces(&scheme, &shuffled(11, &discs)), quantised_forces(&scheme, &discs));
    }
}

#[test]
fn a_lattice_in_step_with_the_mesh_feels_no_force() {
    for scheme in both_methods() {
        let forces = forces(&scheme, &lattice(8));
        let scale = scheme.capillary_strength / (scheme.side / scheme.grid as f64);
        let largest = forces.into_iter().map(modulus).fold(0.0, f64::max);
        assert!(largest <= SELF_FORCE * scale, "{largest:e}: {scheme:?}");
    }
}

#[test]
fn an_infinite_capillary_length_is_the_limit_of_a_long_one() {
    let discs = scattered(12, 100);
    let at = |capillary_length: f64| forces(&Parameters { capillary_length, ..ATTRACTION }, &discs);
    let unscreened = at(f64::INFINITY);
    assert!(rms_difference(&at(1e9), &unscreened) <= SYMMETRY * rms(&unscreened));
    assert!(rms_difference(&at(20.0), &unscreened) > 0.001 * rms(&unscreened));
}

#[test]
fn the_bound_of_the_mesh_force_holds() {
    // units.rs counts on 4 V0/h per disc: here all mass is in one node, seen from every node.
    for scheme in all_schemes() {
        for grid in [16, 32, 64] {
            for capillary_length in [0.01, 1.0, 270.0, f64::INFINITY] {
                let parameters = Parameters { grid, capillary_length, side: 16.0, ..scheme };
                let mut nodes = vec![0; grid * grid];
                nodes[grid + 1] = 1 << 20;
                let scale = parameters.capillary_strength / (parameters.side / grid as f64);
                let largest = wide(&field(&AnySize, &parameters, 8, &nodes))
                    .into_iter()
                    .map(|[x, y]| x.abs().max(y.abs()))
                    .fold(0.0, f64::max);
                assert!(largest <= 4.0 * scale, "{} V0/h: {parameters:?}", largest / scale);
            }
        }
    }
}

#[test]
fn the_modes_of_every_mesh_add_up_to_what_units_count_on() {
    // Σ |influence · gradient| over all modes bounds the field of one disc's mass wherever it lies.
    let largest = if long_tests() { 12 } else { 9 };
    let far_parts = Assignment::ALL.map(|assignment| Parameters { assignment, ..FAR_PART });
    // What units.rs counts on: 4 V0/h for the paper's method and 5.5 V0/h for the split one.
    let bounded = low_orders().take(6).map(|scheme| (scheme, 4.0));
    for (scheme, limit) in bounded.chain(far_parts.map(|scheme| (scheme, 5.5))) {
        for exponent in 4..=largest {
            let grid = 1_usize << exponent;
            for spacing in [0.125, 1.0, 16.0] {
                let (side, capillary_length) = (spacing * grid as f64, f64::INFINITY);
                let (splitting, cutoff) =
                    (LARGEST_SPLITTING_OF_SPACING / spacing, f64::max(1.0, 4.0 * spacing));
                let parameters = Parameters { grid, side, capillary_length, splitting, cutoff, ..scheme };
                if parameters.validate().is_err() {
                    continue;
                }
                let (mut influence, mut gradient) = (vec![0.0; influence_length(grid)], vec![0.0; grid]);
                fill_influence(&parameters, &mut influence);
                fill_gradient(&parameters, &mut gradient);
                let half = grid / 2;
                let mut sum = 0.0;
                for (row, entries) in influence.chunks_exact(half + 1).enumerate() {
                    let rows = if row == 0 || row == half { 1.0 } else { 2.0 };
                    for (&entry, &slope) in entries.iter().zip(&gradient) {
                        // Frequencies ±l; the table holds half of what a mode is multiplied with, per 2⁻²⁰.
                        sum += 2.0 * rows * 2.0 * f64::from(entry) * f64::from(slope.abs()) * 1_048_576.0;
                    }
                }
                let bound = sum * spacing / parameters.capillary_strength;
                assert!(bound < limit, "{bound} V0/h: {parameters:?}");
            }
        }
    }
}
