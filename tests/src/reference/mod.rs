//! Independent references in double precision.
//!
//! Everything here is written from the equations of the model alone and shares no code with the engine:
//! [`bessel`] gives K₀ and K₁, [`images`] sums them over the periodic images, [`ewald`] reaches the same
//! forces without any Bessel function, [`near_part`] is what its short-ranged part is made of, and [`wca`] is the contact repulsion in closed form.
//!
//! Lengths are in disc radii R₀, energies in k_B T, forces in k_B T/R₀. Positions are `[x, y]` in a square
//! periodic box; any real numbers are accepted and taken modulo the side.

pub mod bessel;
pub mod ewald;
pub mod images;
pub mod near_part;
pub mod wca;

/// The image of a separation (R₀) nearest to zero in a periodic box of the given `side` (R₀).
pub fn minimum_image(separation: f64, side: f64) -> f64 {
    separation - side * (separation / side).round()
}

/// Root mean square of the lengths of the vectors, in their own unit; zero for none.
pub fn rms(vectors: &[[f64; 2]]) -> f64 {
    if vectors.is_empty() {
        return 0.0;
    }
    let squares: f64 = vectors.iter().map(|v| v[0] * v[0] + v[1] * v[1]).sum();
    (squares / vectors.len() as f64).sqrt()
}

/// Root mean square of the lengths of `a[i] − b[i]`, in their own unit.
///
/// # Panics
/// If the two slices differ in length.
pub fn rms_difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    assert_eq!(a.len(), b.len(), "two sets of vectors can only be compared one to one");
    let differences: Vec<[f64; 2]> = a.iter().zip(b).map(|(p, q)| [p[0] - q[0], p[1] - q[1]]).collect();
    rms(&differences)
}

/// A deterministic stream of random numbers for test positions: SplitMix64 of Steele, Lea and Flood (2014).
#[derive(Clone, Debug)]
pub struct RandomNumbers {
    state: u64,
}

impl RandomNumbers {
    /// The stream of this seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A uniform number in [0, 1), a multiple of 2⁻⁵³.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// `count` independent uniform positions (R₀) in a box of the given `side` (R₀).
    pub fn positions(&mut self, count: usize, side: f64) -> Vec<[f64; 2]> {
        (0..count).map(|_| [side * self.uniform(), side * self.uniform()]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_numbers_are_those_published_for_splitmix64() {
        let mut random = RandomNumbers::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn rms_of_three_four_five() {
        assert_eq!(rms(&[[3.0, 4.0], [-3.0, -4.0]]), 5.0);
        assert_eq!(rms_difference(&[[4.0, 4.0]], &[[1.0, 0.0]]), 5.0);
    }

    #[test]
    fn minimum_image_is_within_half_a_box() {
        assert_eq!(minimum_image(9.0, 10.0), -1.0);
        assert_eq!(minimum_image(-23.0, 10.0), -3.0);
        assert_eq!(minimum_image(4.0, 10.0), 4.0);
    }
}
