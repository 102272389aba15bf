//! The largest force, displacements and the move in lanes have the bits of the core's, at every level and in any number
//! of pieces.

use meniscus_core::ermak::{self, Displacement, HalfBox};
use meniscus_core::noise::{Purpose, StepKey, ThermalKick};
use meniscus_core::parameters::Noise;
use meniscus_core::torus::Fraction;
use meniscus_wide::lanes::Level;
use meniscus_wide::motion::Motion;

const COUNTS: [usize; 6] = [0, 1, 3, 16, 17, 2500];
const NOISES: [Noise; 3] = [Noise::Uniform, Noise::Gaussian, Noise::None];

/// 64 random bits for each number.
fn random(number: usize) -> u64 {
    StepKey::new(9, Purpose::Start, 0).bits(number as u64)
}

/// All levels, in some pieces.
fn motions() -> impl Iterator<Item = Motion> {
    let pieces = [1, 2, 3, 4, 7, 16];
    Level::available().flat_map(move |level| pieces.map(|pieces| Motion { level, pieces }))
}

/// Integers of all magnitudes up to 2^`bits`.
fn integers(count: usize, offset: usize, bits: u32) -> Vec<i64> {
    let integer = |disc: usize| {
        let random = random(disc + offset);
        random as i64 >> (64 - bits + (random.rotate_left(20) % u64::from(bits)) as u32)
    };
    (0..count).map(integer).collect()
}

#[test]
fn the_largest_force_is_the_cores() {
    let mut cases = vec![(vec![i64::MIN, 5], vec![i64::MIN, -5]), (vec![i64::MAX; 40], vec![1; 40])];
    for count in COUNTS {
        cases.push((vec![0; count], vec![0; count]));
        cases.push((vec![1 << 30; count], vec![-3; count]));
        for bits in [4, 20, 31, 40, 52, 63] {
            cases.push((integers(count, 0, bits), integers(count, 10_000, bits)));
        }
        // All but the same.
        let close =
            |offset: usize| (0..count).map(|disc| (1 << 40) + (random(disc + offset) >> 48) as i64).collect();
        cases.push((close(0), close(10_000)));
    }
    for (x, y) in cases {
        let expected = ermak::largest_force(&x, &y);
        for motion in motions() {
            assert_eq!(motion.largest_force(&x, &y), expected, "{motion:?}");
        }
    }
}

fn expected(
    step: &Displacement,
    ids: &[u32],
    (x, y): (&[i64], &[i64]),
) -> Result<(Vec<i32>, Vec<i32>), HalfBox> {
    ids.iter().zip(x.iter().zip(y)).map(|(&id, (&x, &y))| step.of(id, (x, y))).collect()
}

fn check(step: &Displacement, ids: &[u32], (x, y): (&[i64], &[i64])) -> bool {
    let expected = expected(step, ids, (x, y));
    for motion in motions() {
        let (mut along_x, mut along_y) = (vec![7; ids.len()], vec![7; ids.len()]);
        let found = motion.displacements(step, ids, (x, y), (&mut along_x, &mut along_y));
        assert_eq!(found.map(|()| (along_x, along_y)), expected, "{motion:?} {step:?}");
    }
    expected.is_ok()
}

#[test]
fn displacements_are_the_cores() {
    for noise in NOISES {
        for (step_length, units) in [(1e-3, 8.6e6), (1.0, 65536.0), (1e-12, 2.8e14), (0.3, 1.0)] {
            let kick = ThermalKick::new(noise, step_length, StepKey::new(1, Purpose::Motion, 7));
            let step = Displacement { step_length, units, kick };
            for count in COUNTS {
                let mut ids: Vec<u32> = (0..count as u32).collect();
                ids.sort_unstable_by_key(|&id| random(id as usize));
                for bits in [4, 24, 31, 34, 44, 52, 64] {
                    let (x, y) = (integers(count, 0, bits), integers(count, 10_000, bits));
                    let _ = check(&step, &ids, (&x, &y));
                }
                assert!(step_length < 1e-3 || check(&step, &ids, (&vec![0; count], &vec![0; count])));
            }
            // Ids no run has.
            check(&step, &[u32::MAX, 1 << 31, 0, 5, 6, 7], (&[0; 6], &[1 << 20; 6]));
        }
    }
}

#[test]
fn half_a_box_is_refused_where_the_core_refuses_it() {
    let kick = ThermalKick::new(Noise::None, 1.0, StepKey::new(1, Purpose::Motion, 0));
    let step = Displacement { step_length: 1.0, units: 1.0, kick };
    // 2³¹ units of position, and the number of binary32 before it.
    for (force, fits) in [(1 << 55, false), ((1 << 55) - (1 << 31), true)] {
        for sign in [1, -1] {
            for count in COUNTS {
                for disc in [0, count / 2, count.saturating_sub(1)].into_iter().filter(|&disc| disc < count) {
                    let (mut x, zeros) = (vec![0; count], vec![0; count]);
                    x[disc] = sign * force;
                    let ids: Vec<u32> = (0..count as u32).collect();
                    assert_eq!(check(&step, &ids, (&x, &zeros)), fits);
                    assert_eq!(check(&step, &ids, (&zeros, &x)), fits);
                }
            }
        }
    }
}

#[test]
fn discs_are_moved_as_the_core_moves_them() {
    let extremes = [0, 1, -1, i32::MAX, i32::MIN + 1, 1 << 30];
    for count in COUNTS {
        let units: Vec<i32> =
            (0..count).map(|disc| extremes.get(disc % 9).copied().unwrap_or(random(disc) as i32)).collect();
        let place = |disc: usize| [0, 1, u32::MAX, 1 << 31].get(disc % 7).copied();
        let start: Vec<Fraction> = (0..count)
            .map(|disc| Fraction::from_bits(place(disc).unwrap_or(random(disc + 10_000) as u32)))
            .collect();
        let counted: Vec<i32> = (0..count).map(|disc| random(disc + 20_000) as i32).collect();
        let (mut expected, mut expected_crossings) = (start.clone(), counted.clone());
        for ((coordinate, crossings), &units) in expected.iter_mut().zip(&mut expected_crossings).zip(&units)
        {
            ermak::displace(coordinate, crossings, units);
        }
        for motion in motions() {
            let (mut coordinates, mut crossings) = (start.clone(), counted.clone());
            motion.displace(&mut coordinates, &mut crossings, &units);
            assert_eq!(
                (coordinates, crossings),
                (expected.clone(), expected_crossings.clone()),
                "{motion:?}"
            );
        }
    }
}
