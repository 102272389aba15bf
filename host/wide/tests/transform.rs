//! The wide transforms have microfft's bits, at every size and width, for whatever numbers.

use meniscus_core::grid::Grid;
use meniscus_core::transform::{AnySize, Complex32, LineTransform};
use meniscus_wide::lanes::{Level, Sixteen};
use meniscus_wide::transform::Transform;

const SIZES: [usize; 9] = [16, 32, 64, 128, 256, 512, 1024, 2048, 4096];

/// A SplitMix64 sequence.
struct Sequence(u64);

impl Sequence {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in −1 to 1.
    fn number(&mut self) -> f32 {
        (self.bits() as i32) as f32 / 2_147_483_648.0
    }
}

/// Kinds of numbers that lines are made of.
const KINDS: [fn(&mut Sequence) -> f32; 7] = [
    // Ordinary ones,
    |sequence| sequence.number(),
    // whole ones with many zeros, as node masses are,
    |sequence| if sequence.bits() % 4 == 0 { (sequence.bits() as u32 >> 8) as f32 } else { 0.0 },
    // zeros of both signs and ones, so that many sums vanish,
    |sequence| [0.0, -0.0, 1.0, -1.0][sequence.bits() as usize % 4],
    // zeros alone,
    |sequence| [0.0, -0.0][sequence.bits() as usize % 2],
    // subnormal ones,
    |sequence| f32::from_bits(sequence.bits() as u32 & 0x807F_FFFF),
    // ones so large that sums become infinite and differences of those no number,
    |sequence| sequence.number() * 3.0e38,
    // any bits at all.
    |sequence| f32::from_bits(sequence.bits() as u32),
];

/// The bits, the same for all that is not a number.
fn bits(value: f32) -> u32 {
    if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() }
}

fn bits_of_line(line: &[Complex32]) -> Vec<[u32; 2]> {
    line.iter().map(|value| [bits(value.re), bits(value.im)]).collect()
}

fn random_line(points: usize, kind: fn(&mut Sequence) -> f32, sequence: &mut Sequence) -> Vec<Complex32> {
    (0..points).map(|_| Complex32::new(kind(sequence), kind(sequence))).collect()
}

fn transformed(line: &[Complex32]) -> Vec<[u32; 2]> {
    let mut line = line.to_vec();
    AnySize.forward(&mut line);
    bits_of_line(&line)
}

#[test]
fn sixteen_lines_side_by_side_are_those_of_microfft() {
    let mut sequence = Sequence(1);
    for points in SIZES {
        let lines: Vec<_> =
            (0..16).map(|lane| random_line(points, KINDS[lane % KINDS.len()], &mut sequence)).collect();
        let expected: Vec<_> = lines.iter().map(|line| transformed(line)).collect();
        for level in Level::available() {
            let mut blocks = vec![Sixteen::ZERO; points];
            for (lane, line) in lines.iter().enumerate() {
                for (block, value) in blocks.iter_mut().zip(line) {
                    block.re_mut()[lane] = value.re;
                    block.im_mut()[lane] = value.im;
                }
            }
            Transform::new(Grid::new(points).unwrap(), level).forward(&mut blocks);
            for (lane, expected) in expected.iter().enumerate() {
                let found: Vec<_> =
                    blocks.iter().map(|block| [bits(block.re()[lane]), bits(block.im()[lane])]).collect();
                assert!(found == *expected, "{points} points, line {lane}, {}", level.name());
            }
        }
    }
}

#[test]
fn a_line_with_lanes_along_it_is_that_of_microfft() {
    let mut sequence = Sequence(2);
    for points in SIZES {
        for kind in KINDS {
            let line = random_line(points, kind, &mut sequence);
            let expected = transformed(&line);
            for level in Level::available() {
                let mut blocks = vec![Sixteen::ZERO; points / 16];
                for (block, values) in blocks.iter_mut().zip(line.chunks_exact(16)) {
                    for (lane, value) in values.iter().enumerate() {
                        block.re_mut()[lane] = value.re;
                        block.im_mut()[lane] = value.im;
                    }
                }
                let done = Transform::new(Grid::new(points).unwrap(), level).forward_along(&mut blocks);
                assert_eq!(done, points >= 256);
                if done {
                    let found: Vec<_> = blocks
                        .iter()
                        .flat_map(|block| block.re().iter().zip(block.im()))
                        .map(|(&re, &im)| [bits(re), bits(im)])
                        .collect();
                    assert!(found == expected, "{points} points, {}", level.name());
                }
            }
        }
    }
}

#[test]
fn a_slice_too_short_is_left_alone() {
    let mut transform = Transform::new(Grid::new(256).unwrap(), Level::best());
    let one = Sixteen([1.0; 32]);
    let mut blocks = vec![one; 255];
    transform.forward(&mut blocks);
    assert!(blocks.iter().all(|block| *block == one));
    assert!(!transform.forward_along(&mut blocks[..15]));
    assert!(blocks.iter().all(|block| *block == one));
}
