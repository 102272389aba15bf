//! The stages of a step one by one, each with the digest of what it hands on.

use crate::{Case, CaseError, print};
use core::fmt::Write;
use meniscus_core::assignment::{deposit, deposit_strengths, gather, gather_strengths};
use meniscus_core::cells::for_each_pair;
use meniscus_core::digest::Digest;
use meniscus_core::dynamics::{Memory, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::fields::FieldForce;
use meniscus_core::grid::Grid;
use meniscus_core::mesh::{Tables, solve, solve_strengths};
use meniscus_core::near_part::table_length;
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::pair_force::{PairForce, near_cutoff, product_of_strengths};
use meniscus_core::parameters::Parameters;
use meniscus_core::transform::{Complex32, FixedSize, LineTransform};
use sha2::{Digest as _, Sha256};

/// Prints the digest of every stage at the engine's present state. Only scratch memory is written to.
pub(crate) fn print_all<const M: usize, const N: usize, const SEGMENTS: usize, const HELD: usize>(
    case: &Case,
    engine: &mut Engine<M, N, SEGMENTS, HELD>,
    output: &mut impl Write,
) -> Result<(), CaseError> {
    let parameters = &case.parameters;
    let (assignment, equal) = (parameters.assignment, case.has_equal_strengths());
    let grid = Grid::new(M).ok_or(CaseError::Start)?;
    let count = engine.count();
    let (_, memory) = engine.parts();
    let Memory { ids, x, y, force_x, force_y, strengths, next, nodes, field, lines, .. } = memory;
    let (Some(ids), Some(x), Some(y)) = (ids.get(..count), x.get(..count), y.get(..count)) else {
        return Err(CaseError::Start);
    };
    let (Some(strengths), Some(force_x), Some(force_y)) =
        (strengths.get(..count), force_x.get_mut(..count), force_y.get_mut(..count))
    else {
        return Err(CaseError::Start);
    };
    let tables = Tables { influence: memory.influence, gradient: memory.gradient };

    let deposited = if equal {
        deposit(assignment, grid, x, y, nodes)
    } else {
        deposit_strengths(assignment, grid, (x, y), strengths, nodes)
    };
    deposited.map_err(|_| CaseError::Step(StepError::Crowded))?;
    print(case, "deposit", &digest(nodes.iter().map(|mass| mass.to_le_bytes())), output)?;

    let tables_bits =
        tables.influence.iter().chain(tables.gradient).map(|value| value.to_bits().to_le_bytes());
    print(case, "tables", &digest(tables_bits), output)?;

    for (line, masses) in field.chunks_exact_mut(M).zip(nodes.chunks_exact(M)) {
        for (value, &mass) in line.iter_mut().zip(masses) {
            let mass = if equal { mass as f32 } else { mass as i32 as f32 };
            *value = Complex32::new(mass, 0.0);
        }
        FixedSize::<M>.forward(line);
    }
    print(case, "spectrum", &digest_of_complex(field), output)?;

    if equal {
        solve(&FixedSize::<M>, grid, &tables, nodes, field, lines);
    } else {
        solve_strengths(&FixedSize::<M>, grid, &tables, nodes, field, lines);
    }
    print(case, "field", &digest_of_complex(field), output)?;

    if equal {
        gather(assignment, grid, (x, y), field, (force_x, force_y));
    } else {
        gather_strengths(assignment, grid, (x, y), strengths, field, (force_x, force_y));
    }
    print(case, "gather", &digest_of_forces(force_x, force_y), output)?;

    let table = memory.near.get(..table_length(near_cutoff(parameters))).ok_or(CaseError::Start)?;
    if !table.is_empty() {
        let coefficients = table.iter().flatten().map(|value| value.to_bits().to_le_bytes());
        print(case, "near", &digest(coefficients), output)?;
    }

    force_x.fill(0);
    force_y.fill(0);
    // Repulsion also where the case does without.
    let pairs = PairForce::new(&Parameters { repulsion: true, ..*parameters });
    let strength = |disc: usize| strengths.get(disc).copied().unwrap_or(0);
    for_each_pair((x, y), pairs.reach(), nodes, next, |first, second, separation| {
        let lower = ids.get(first) < ids.get(second);
        let product = product_of_strengths(strength(first), strength(second));
        let (along_x, along_y) = pairs.of(separation, lower, product, table).unwrap_or_default();
        for (disc, sign) in [(first, 1), (second, -1)] {
            if let (Some(x), Some(y)) = (force_x.get_mut(disc), force_y.get_mut(disc)) {
                *x += sign * along_x;
                *y += sign * along_y;
            }
        }
    });
    print(case, "pairs", &digest_of_forces(force_x, force_y), output)?;

    let fields = FieldForce::new(&parameters.fields, parameters.side);
    if !fields.is_zero() {
        for ((&x, &y), (force_x, force_y)) in x.iter().zip(y).zip(force_x.iter_mut().zip(force_y.iter_mut()))
        {
            (*force_x, *force_y) = fields.at(x, y);
        }
        print(case, "fields", &digest_of_forces(force_x, force_y), output)?;
    }

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

fn digest_of_forces(force_x: &[i64], force_y: &[i64]) -> Digest {
    digest(force_x.iter().zip(force_y).flat_map(|(x, y)| [x.to_le_bytes(), y.to_le_bytes()]))
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
