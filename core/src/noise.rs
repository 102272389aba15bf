//! Random numbers as a pure function of (seed, purpose, step, particle).
//!
//! Once per step a PCG generator, seeded from a mix of seed and purpose and advanced to the step, gives
//! a 64-bit [`StepKey`]; particle `id` gets the id-th output of the SplitMix64 sequence that starts at
//! that key. Nothing depends on how many particles there are or on the order in which they are asked.
//!
//! ```
//! use meniscus_core::noise::{Purpose, StepKey};
//!
//! let key = StepKey::new(1, Purpose::Motion, 1000);
//! assert_eq!(key.bits(7), StepKey::new(1, Purpose::Motion, 1000).bits(7));
//! assert_ne!(key.bits(7), key.bits(8));
//! ```

use crate::parameters::Noise;
use rand_core::Rng;
use rand_pcg::Pcg32;

/// What random numbers are drawn for. Each purpose has a stream of its own; a number is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u64)]
pub enum Purpose {
    /// The thermal displacement of the Ermak step.
    Motion = 1,
    /// Initial positions.
    Start = 2,
}

/// The increment of SplitMix64, 2⁶⁴ divided by the golden ratio, odd.
pub const GOLDEN_GAMMA: u64 = 0x9E37_79B9_7F4A_7C15;

/// The multipliers of SplitMix64's output function.
pub const MULTIPLIERS: [u64; 2] = [0xBF58_476D_1CE4_E5B9, 0x94D0_49BB_1331_11EB];

/// The output function of SplitMix64: a bijection of 64 bits in which every input bit moves every output
/// bit with probability near one half.
const fn mix(bits: u64) -> u64 {
    let bits = (bits ^ (bits >> 30)).wrapping_mul(MULTIPLIERS[0]);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(MULTIPLIERS[1]);
    bits ^ (bits >> 31)
}

/// The key of one (seed, purpose, step), from which every particle's bits follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StepKey(u64);

impl StepKey {
    /// The key of `step` for `purpose` under `seed`.
    #[must_use]
    pub fn new(seed: u64, purpose: Purpose, step: u64) -> Self {
        let state = mix(seed.wrapping_add(GOLDEN_GAMMA));
        let stream = mix(state ^ (purpose as u64).wrapping_mul(GOLDEN_GAMMA));
        let mut generator = Pcg32::new(state, stream);
        // A key takes two 32-bit outputs.
        generator.advance(step.wrapping_mul(2));
        Self(generator.next_u64())
    }

    /// The key itself: the state that the SplitMix64 sequence starts from.
    #[must_use]
    pub const fn state(self) -> u64 {
        self.0
    }

    /// 64 random bits for the particle (or draw) `id`.
    #[must_use]
    pub const fn bits(self, id: u64) -> u64 {
        mix(self.0.wrapping_add(GOLDEN_GAMMA.wrapping_mul(id.wrapping_add(1))))
    }
}

/// 2⁻²⁴
const UNIT_24: f32 = 1.0 / 16_777_216.0;
/// 2⁻³²
const UNIT_32: f32 = 1.0 / 4_294_967_296.0;

/// A number uniform in (−1, 1) from the upper 24 of 32 bits: an odd multiple of 2⁻²⁴, so that the mean
/// over all of them is exactly 0.
fn symmetric(bits: u32) -> f32 {
    ((bits >> 8) as i32 * 2 + 1 - (1 << 24)) as f32 * UNIT_24
}

/// Two independent standard normal numbers from 64 bits (Box and Muller 1958).
///
/// The radius is √(−2 ln u) with u in (0, 1]: the logarithm of zero cannot occur.
fn normal_pair(bits: u64) -> (f32, f32) {
    let open = ((bits >> 32) as f32 + 1.0) * UNIT_32;
    let radius = libm::sqrtf(-2.0 * libm::logf(open));
    let angle = (bits as u32) as f32 * (UNIT_32 * core::f32::consts::TAU);
    let (sine, cosine) = libm::sincosf(angle);
    (radius * cosine, radius * sine)
}

/// The thermal displacement of a time step: which distribution, and how wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermalKick {
    noise: Noise,
    width: f32,
    key: StepKey,
}

impl ThermalKick {
    /// The kick of a step of length `step_length` (R0²/D), with the key of that step.
    ///
    /// Its width is √(6Δt) if uniform and √(2Δt) if Gaussian, R0: variance 2Δt per component (Eq. 17).
    #[must_use]
    pub fn new(noise: Noise, step_length: f32, key: StepKey) -> Self {
        let width = match noise {
            Noise::Uniform => libm::sqrtf(6.0 * step_length),
            Noise::Gaussian => libm::sqrtf(2.0 * step_length),
            Noise::None => 0.0,
        };
        Self { noise, width, key }
    }

    /// Which distribution.
    #[must_use]
    pub const fn noise(&self) -> Noise {
        self.noise
    }

    /// What a number uniform in (−1, 1) or a standard normal number is multiplied by, R0.
    #[must_use]
    pub const fn width(&self) -> f32 {
        self.width
    }

    /// The key of the step.
    #[must_use]
    pub const fn key(&self) -> StepKey {
        self.key
    }

    /// The displacement (x, y) of particle `id`, R0.
    #[must_use]
    pub fn displacement(&self, id: u32) -> (f32, f32) {
        let (x, y) = match self.noise {
            Noise::Uniform => {
                let bits = self.key.bits(u64::from(id));
                (symmetric((bits >> 32) as u32), symmetric(bits as u32))
            }
            Noise::Gaussian => normal_pair(self.key.bits(u64::from(id))),
            Noise::None => (0.0, 0.0),
        };
        (self.width * x, self.width * y)
    }
}
