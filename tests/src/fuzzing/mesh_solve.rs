//! The mesh solver.

use super::bytes::Bytes;
use meniscus_core::assignment::{DISC, LARGEST_NODE_MASS};
use meniscus_core::grid::Grid;
use meniscus_core::influence::{fill_gradient, fill_influence, influence_length};
use meniscus_core::mesh::{Tables, solve, solve_strengths};
use meniscus_core::parameters::{
    Assignment, Gradient, Influence, LARGEST_CAPILLARY_STRENGTH, LARGEST_SPLITTING_OF_SPACING, Method,
    Parameters, SMALLEST_CAPILLARY_LENGTH, SPACING_RANGE,
};
use meniscus_core::transform::{AnySize, Complex32, FixedSize, LineTransform};

const M: usize = 16;

/// Bound of the relative error of a field of this mesh, in the norm of sums of squares: four passes of transforms with
/// eight roundings of 2⁻²⁴ each, and a few more for the tables.
const FIELD: f64 = 40.0 / 16_777_216.0;

/// Node masses; then: the field is finite, read as strengths too, the forces on all masses cancel, the memory at hand and the kind of
/// transform do not change a bit, and half the masses have exactly half the field.
pub fn mesh_solve(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (finest, coarsest) = SPACING_RANGE;
    let side = M as f64 * bytes.number(finest, coarsest);
    let parameters = Parameters {
        grid: M,
        side,
        capillary_strength: bytes.number(0.0, LARGEST_CAPILLARY_STRENGTH),
        capillary_length: bytes.number(SMALLEST_CAPILLARY_LENGTH, 1e6),
        influence: bytes.choice([Influence::Paper, Influence::Continuum, Influence::Optimal]),
        gradient: bytes.choice([Gradient::Spectral, Gradient::Difference2, Gradient::Difference4]),
        ..Parameters::PAPER
    };
    let parameters = if parameters.influence == Influence::Optimal {
        Parameters {
            method: Method::P3m,
            gradient: Gradient::Spectral,
            assignment: bytes.choice(Assignment::ALL),
            splitting: bytes.number(0.1, LARGEST_SPLITTING_OF_SPACING) * M as f64 / side,
            cutoff: 1.0,
            ..parameters
        }
    } else {
        parameters
    };
    if parameters.validate().is_err() {
        return;
    }
    let limit = LARGEST_NODE_MASS * DISC;
    let mut nodes = [0; M * M];
    while !bytes.is_empty() {
        let (node, shift) = (usize::from(bytes.byte()), bytes.byte() % 32);
        nodes[node] = (bytes.bits_32() >> shift).min(limit);
    }
    let (mut influence, mut gradient) = ([0.0; influence_length(M)], [0.0; M]);
    fill_influence(&parameters, &mut influence);
    fill_gradient(&parameters, &mut gradient);
    let tables = Tables { influence: &influence, gradient: &gradient };

    let field = field_of(&FixedSize::<M>, 1, &tables, &nodes);
    assert!(field.iter().all(|force| force.re.is_finite() && force.im.is_finite()), "{parameters:?}");
    assert_eq!(bits(&field), bits(&field_of(&AnySize, 8, &tables, &nodes)));
    check_net_force(&tables, &nodes, &field);
    check_strengths(&tables, &nodes, &field);
    check_halves(&tables, &nodes);
}

fn field_of<T: LineTransform>(
    transform: &T,
    rows: usize,
    tables: &Tables<'_>,
    nodes: &[u32],
) -> Vec<Complex32> {
    let junk = Complex32::new(f32::NAN, f32::INFINITY);
    let (mut field, mut lines) = (vec![junk; M * M], vec![junk; 2 * M * rows]);
    solve(transform, Grid::SMALLEST, tables, nodes, &mut field, &mut lines);
    field
}

fn bits(field: &[Complex32]) -> Vec<(u32, u32)> {
    field.iter().map(|force| (force.re.to_bits(), force.im.to_bits())).collect()
}

/// Masses below 2³¹ are strengths too; strengths of the other sign make the opposite field, as near as the exchange of
/// −0 and 0 lets it.
fn check_strengths(tables: &Tables<'_>, nodes: &[u32], field: &[Complex32]) {
    let field_of = |nodes: &[u32]| {
        let zero = Complex32::new(0.0, 0.0);
        let (mut field, mut lines) = (vec![zero; M * M], vec![zero; 2 * M]);
        solve_strengths(&AnySize, Grid::SMALLEST, tables, nodes, &mut field, &mut lines);
        field
    };
    if nodes.iter().all(|&mass| mass < 1 << 31) {
        assert_eq!(bits(&field_of(nodes)), bits(field));
    }
    let signed: Vec<u32> = nodes.iter().map(|&mass| (mass as i32 >> 1) as u32).collect();
    let opposite: Vec<u32> = signed.iter().map(|strength| strength.wrapping_neg()).collect();
    for (force, opposite) in field_of(&signed).iter().zip(field_of(&opposite)) {
        assert!(force.re.is_finite() && force.im.is_finite());
        assert!(force.re == -opposite.re && force.im == -opposite.im, "{force} and {opposite}");
    }
}

/// Newton's third law. By Cauchy's inequality what is left is at most the norm of the masses times that of the
/// field's error, which is at most [`FIELD`] times the norm of the masses times the largest factor of a mode, both
/// transforms together making M² of it and the split of columns 2. Where factors are nearly subnormal, a few units of
/// 2⁻¹⁴⁹ more in each mode.
fn check_net_force(tables: &Tables<'_>, nodes: &[u32], field: &[Complex32]) {
    const SUBNORMAL: f64 = 4.0 * f32::from_bits(1) as f64;
    let steepest = f64::from(tables.gradient.iter().copied().fold(0.0, f32::max));
    let factor = f64::from(tables.influence.iter().copied().fold(0.0, f32::max)) * steepest;
    let mass: f64 = nodes.iter().map(|&mass| f64::from(mass)).sum();
    let squares: f64 = nodes.iter().map(|&mass| f64::from(mass) * f64::from(mass)).sum();
    let modes = (M * M) as f64;
    let tolerance = modes * (FIELD * 2.0 * factor * squares + SUBNORMAL * (1.0 + steepest) * mass);
    let net = |component: fn(&Complex32) -> f32| {
        let forces =
            nodes.iter().zip(field).map(|(&mass, force)| f64::from(mass) * f64::from(component(force)));
        forces.sum::<f64>()
    };
    let (x, y) = (net(|force| force.re), net(|force| force.im));
    assert!(x.abs().max(y.abs()) <= tolerance, "net force ({x}, {y}) beyond {tolerance}");
}

/// Powers of two scale binary32 exactly as long as nothing is subnormal.
fn check_halves(tables: &Tables<'_>, nodes: &[u32]) {
    let smallest = tables.influence.iter().skip(1).copied().fold(f32::MAX, f32::min);
    if smallest < 1e-20 {
        return;
    }
    let even: Vec<u32> = nodes.iter().map(|mass| mass & !1).collect();
    let half: Vec<u32> = even.iter().map(|mass| mass / 2).collect();
    let whole = field_of(&AnySize, 1, tables, &even);
    let half = field_of(&AnySize, 1, tables, &half);
    let doubled: Vec<Complex32> = half.iter().map(|force| force * 2.0).collect();
    assert_eq!(bits(&whole), bits(&doubled));
}
