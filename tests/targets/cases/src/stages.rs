//! The stages of a step one by one, each with the digest of what it hands on.

use crate::{Case, CaseError, print};
use core::fmt::Write;
use meniscus_core::assignment::{deposit, gather};
use meniscus_core::cells::for_each_pair;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::{Memory, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::grid::Grid;
use meniscus_core::mesh::{Tables, solve};
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::repulsion::Repulsion;
use meniscus_core::transform::{Complex32, FixedSize, LineTransform};
use sha2::{Digest as _, Sha256};

/// Prints the digest of every stage at the engine's present state. Only scratch memory is written to.
pub(crate) fn print_all<const M: usize, const N: usize>(
    case: &Case,
    engine: &mut Engine<M, N>,
    output: &mut impl Write,
) -> Result<(), CaseError> {
    let parameters = &case.parameters;
    let grid = Grid::new(M).ok_or(CaseError::Start)?;
    let count = engine.count();
    let (_, memory) = engine.parts();
    let Memory { ids, x, y, force_x, force_y, next, nodes, field, lines, influence, gradient, .. } = memory;
    let (Some(ids), Some(x), Some(y)) = (ids.get(..count), x.get(..count), y.get(..count)) else {
        return Err(CaseError::Start);
    };
    let tables = Tables { influence, gradient };

    deposit(parameters.assignment, grid, x, y, nodes).map_err(|_| CaseError::Step(StepError::Crowded))?;
    print(case, "deposit", &digest(nodes.iter().map(|mass| mass.to_le_bytes())), output)?;

    let tables_bits =
        tables.influence.iter().chain(tables.gradient).map(|value| value.to_bits().to_le_bytes());
    print(case, "tables", &digest(tables_bits), output)?;

    for (line, masses) in field.chunks_exact_mut(M).zip(nodes.chunks_exact(M)) {
        for (value, &mass) in line.iter_mut().zip(masses) {
            *value = Complex32::new(mass as f32, 0.0);
        }
        FixedSize::<M>.forward(line);
    }
    print(case, "spectrum", &digest_of_complex(field), output)?;

    solve(&FixedSize::<M>, grid, &tables, nodes, field, lines);
    print(case, "field", &digest_of_complex(field), output)?;

    gather(parameters.assignment, grid, (x, y), field, (force_x, force_y));
    let forces = force_x.iter().zip(force_y.iter()).take(count);
    print(case, "gather", &digest(forces.flat_map(|(x, y)| [x.to_le_bytes(), y.to_le_bytes()])), output)?;

    force_x.fill(0);
    force_y.fill(0);
    let repulsion = Repulsion::new(parameters.side);
    for_each_pair((x, y), repulsion.reach(), nodes, next, |first, second, separation| {
        let lower = ids.get(first) < ids.get(second);
        let (along_x, along_y) = repulsion.force(separation, lower).unwrap_or_default();
        for (disc, sign) in [(first, 1), (second, -1)] {
            if let (Some(x), Some(y)) = (force_x.get_mut(disc), force_y.get_mut(disc)) {
                *x += sign * along_x;
                *y += sign * along_y;
            }
        }
    });
    let forces = force_x.iter().zip(force_y.iter()).take(count);
    print(case, "pairs", &digest(forces.flat_map(|(x, y)| [x.to_le_bytes(), y.to_le_bytes()])), output)?;

    let kick =
        ThermalKick::new(parameters.noise, 1.0 / 1024.0, StepKey::new(parameters.seed, Purpose::Motion, 0));
    let kicks = ids.iter().flat_map(|&id| {
        let (x, y) = kick.displacement(id);
        // Without noise a component may be a zero of either sign.
        [(x + 0.0).to_bits().to_le_bytes(), (y + 0.0).to_bits().to_le_bytes()]
    });
    print(case, "noise", &digest(kicks), output)?;
    Ok(())
}

fn digest_of_complex(field: &[Complex32]) -> Digest {
    digest(
        field.iter().flat_map(|value| [value.re.to_bits().to_le_bytes(), value.im.to_bits().to_le_bytes()]),
    )
}

/// Length and SHA-256 of words.
fn digest<const B: usize>(words: impl Iterator<Item = [u8; B]>) -> Digest {
    let (mut hash, mut length) = (Sha256::new(), 0);
    for word in words {
        hash.update(word);
        length += B as u64;
    }
    Digest { length, sha256: hash.finalize().into() }
}
