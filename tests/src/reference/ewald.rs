//! The capillary force in the periodic box as an Ewald sum, for any capillary length, infinity included.
//!
//! The pair energy −V₀K₀(κr) = −(V₀/2) ∫₀^∞ (dt/t) exp(−κ²t − r²/4t) is cut at t* = 1/(4α²). The part below
//! t* is short-ranged and is summed over pairs; the part above it is smooth and is summed over the wave
//! vectors k = 2π(l, m)/L of the box, where it reads −(2πV₀/L²) Σ exp(−(k²+κ²)/4α²)/(k²+κ²) cos(k·r).
//!
//! k = 0 exerts no force and is left out. Energies are therefore those in a neutralising background: the
//! mean of the pair energy over the box is zero. The sum over images of −V₀K₀ is lower by 2πV₀λ²/L² per pair.
//!
//! Discs of unequal capillary strengths f_i, of either sign, interact with f_i·f_j times that; where no strengths are
//! given they are 1.
//!
//! No Bessel function appears here, so that the agreement with [`images`](super::images) means something.

use core::f64::consts::TAU;

use super::minimum_image;
use super::near_part::NearPart;

/// The cut-off is this many 1/α, and the largest wave number twice as many α: both parts leave out about
/// e⁻³⁶ ≈ 2e-16 of the bare force.
const REACH: f64 = 6.0;

/// The default splitting αL, at which pairs and waves cost about the same for 2500 discs.
const SPLITTING_OF_BOX: f64 = 16.0;

/// Discs whose phases are held at the same time.
const PHASES_AT_ONCE: usize = 1024;

/// The Ewald sum of one box.
///
/// Made for λ from 0.01 L to infinity and separations from 1e-3 R₀; accurate to about 1e-14 of the force, or
/// 1e-15 of V₀/L where the force is fainter than 0.1 V₀/L. Discs at the same place exert no near force.
#[derive(Clone, Debug)]
pub struct Ewald {
    side: f64,
    capillary_strength: f64,
    near: NearPart,
    rows: Vec<WaveRow>,
    near_energy_offset: f64,
}

impl Ewald {
    /// A box of this `side` (R₀), with V₀ = `capillary_strength` (k_B T) and λ = `capillary_length` (R₀),
    /// which may be infinite.
    pub fn new(side: f64, capillary_strength: f64, capillary_length: f64) -> Self {
        Self::with_splitting(side, capillary_strength, capillary_length, SPLITTING_OF_BOX / side)
    }

    /// The same sum, cut at t* = 1/(4α²) with α = `splitting` (1/R₀). No force depends on α.
    ///
    /// # Panics
    /// If α < 12/L: the near part would then reach beyond half a box.
    pub fn with_splitting(side: f64, capillary_strength: f64, capillary_length: f64, splitting: f64) -> Self {
        assert!(splitting * side >= 2.0 * REACH, "the near part must end within half a box");
        let screening = 1.0 / capillary_length;
        let screened = 0.25 * screening * screening / (splitting * splitting);
        Self {
            side,
            capillary_strength,
            near: NearPart::new(splitting, screened, REACH / splitting),
            rows: wave_rows(side, capillary_strength, screening, splitting),
            near_energy_offset: near_energy_offset(side, capillary_strength, splitting, screened),
        }
    }

    /// Force (k_B T/R₀) on a disc at the origin due to a disc at (`dx`, `dy`) (R₀) and all its images.
    pub fn pair_force(&self, dx: f64, dy: f64) -> [f64; 2] {
        let [near_x, near_y] = self.near_force(dx, dy);
        let single = Phases::new([dx, dy], self.side, self.orders());
        // The density of a single disc at the origin is 1 for every wave; the force on the disc at the
        // origin is the opposite of the force on the other.
        let weights: Vec<Vec<[f64; 2]>> =
            self.rows.iter().map(|row| row.weights.iter().map(|weight| [*weight, 0.0]).collect()).collect();
        let [far_x, far_y] = self.far_force(&single, &weights);
        [near_x - far_x, near_y - far_y]
    }

    /// Energy (k_B T) of a disc at the origin with a disc at (`dx`, `dy`) (R₀) and all its images; its mean
    /// over the box is zero.
    pub fn pair_energy(&self, dx: f64, dy: f64) -> f64 {
        let phases = Phases::new([dx, dy], self.side, self.orders());
        let mut sum = 0.0;
        for row in &self.rows {
            for (order, weight) in row.weights.iter().enumerate() {
                sum += weight * phases.wave(order, row)[0];
            }
        }
        self.near_energy(dx, dy) + self.near_energy_offset - sum
    }

    /// Forces (k_B T/R₀) on discs at `positions` (R₀), each due to all the others and all their images.
    /// A disc's own images exert no force on it, by symmetry.
    pub fn forces(&self, positions: &[[f64; 2]]) -> Vec<[f64; 2]> {
        self.forces_of(positions, &vec![1.0; positions.len()])
    }

    /// The same for discs of capillary `strengths`.
    ///
    /// # Panics
    /// If there are not as many strengths as positions.
    pub fn forces_of(&self, positions: &[[f64; 2]], strengths: &[f64]) -> Vec<[f64; 2]> {
        let mut forces = self.far_forces(0..positions.len(), positions, strengths);
        for i in 0..positions.len() {
            for j in i + 1..positions.len() {
                let product = strengths[i] * strengths[j];
                let [x, y] =
                    self.near_force(positions[j][0] - positions[i][0], positions[j][1] - positions[i][1]);
                forces[i][0] += product * x;
                forces[i][1] += product * y;
                forces[j][0] -= product * x;
                forces[j][1] -= product * y;
            }
        }
        forces
    }

    /// The same forces, but only on the discs whose indices are in `sample`, in the order of the sample: some seconds
    /// for 200 of 10⁵ discs.
    ///
    /// # Panics
    /// If there are not as many strengths as positions, or a sampled index is none of them.
    pub fn forces_on(&self, sample: &[usize], positions: &[[f64; 2]], strengths: &[f64]) -> Vec<[f64; 2]> {
        let mut forces = self.far_forces(sample.iter().copied(), positions, strengths);
        for (force, &i) in forces.iter_mut().zip(sample) {
            for (j, position) in positions.iter().enumerate().filter(|&(j, _)| j != i) {
                let [x, y] = self.near_force(position[0] - positions[i][0], position[1] - positions[i][1]);
                force[0] += strengths[i] * strengths[j] * x;
                force[1] += strengths[i] * strengths[j] * y;
            }
        }
        forces
    }

    /// Far parts of the forces on the discs of a sample due to all.
    fn far_forces(
        &self,
        sample: impl Iterator<Item = usize>,
        positions: &[[f64; 2]],
        strengths: &[f64],
    ) -> Vec<[f64; 2]> {
        let response = self.response(&self.density(positions, strengths));
        let orders = self.orders();
        let force = |i: usize| {
            let phases = Phases::new(positions[i], self.side, orders);
            self.far_force(&phases, &response).map(|component| strengths[i] * component)
        };
        sample.map(force).collect()
    }

    /// Sum of [`pair_energy`](Self::pair_energy) (k_B T) over all pairs of discs at `positions` (R₀); the
    /// energy of a disc with its own images, which never changes, is not in it.
    pub fn energy(&self, positions: &[[f64; 2]]) -> f64 {
        self.energy_of(positions, &vec![1.0; positions.len()])
    }

    /// The same for discs of capillary `strengths`.
    ///
    /// # Panics
    /// If there are not as many strengths as positions.
    pub fn energy_of(&self, positions: &[[f64; 2]], strengths: &[f64]) -> f64 {
        // A sum per disc first: in one long sum the many faint pairs would all be rounded away.
        let mut near = 0.0;
        for (i, first) in positions.iter().enumerate() {
            let partners = positions.iter().zip(strengths).skip(i + 1);
            let energies = partners.map(|(p, f)| f * self.near_energy(p[0] - first[0], p[1] - first[1]));
            near += strengths[i] * energies.sum::<f64>();
        }
        let total: f64 = strengths.iter().sum();
        let squares: f64 = strengths.iter().map(|strength| strength * strength).sum();
        let pairs = 0.5 * (total * total - squares);
        near + pairs * self.near_energy_offset + self.far_energy(positions, strengths)
    }

    /// −Σ over pairs of the far part, from |ρ̂|² = Σ f² + 2 Σ over pairs of f_i f_j cos(k·r).
    fn far_energy(&self, positions: &[[f64; 2]], strengths: &[f64]) -> f64 {
        let density = self.density(positions, strengths);
        let squares: f64 = strengths.iter().map(|strength| strength * strength).sum();
        let mut energy = 0.0;
        for (row, sums) in self.rows.iter().zip(&density) {
            for (weight, sum) in row.weights.iter().zip(sums) {
                energy -= 0.5 * weight * (sum[0] * sum[0] + sum[1] * sum[1] - squares);
            }
        }
        energy
    }

    /// Near part of the force on a disc at the origin: (V₀/r²) g(r²) towards the nearest image.
    fn near_force(&self, dx: f64, dy: f64) -> [f64; 2] {
        let x = minimum_image(dx, self.side);
        let y = minimum_image(dy, self.side);
        let square = x * x + y * y;
        if square >= self.near.cutoff_square() || square == 0.0 {
            return [0.0; 2];
        }
        let per_length = self.capillary_strength * self.near.force_times_distance(square) / square;
        [per_length * x, per_length * y]
    }

    /// Near part of the energy of a pair, as it is: its mean over the box is not zero.
    fn near_energy(&self, dx: f64, dy: f64) -> f64 {
        let x = minimum_image(dx, self.side);
        let y = minimum_image(dy, self.side);
        let square = x * x + y * y;
        if square >= self.near.cutoff_square() {
            return 0.0;
        }
        -self.capillary_strength * self.near.potential(square)
    }

    /// Largest order of the waves along an axis.
    fn orders(&self) -> usize {
        self.rows.iter().map(|row| row.magnitude).max().unwrap_or(0)
    }

    /// ρ̂ = Σ f exp(ik·r) over the discs, for every wave of every row.
    fn density(&self, positions: &[[f64; 2]], strengths: &[f64]) -> Vec<Vec<[f64; 2]>> {
        assert_eq!(positions.len(), strengths.len(), "every disc has one strength");
        let orders = self.orders();
        let mut density: Vec<Vec<[f64; 2]>> =
            self.rows.iter().map(|row| vec![[0.0; 2]; row.weights.len()]).collect();
        // Some discs at a time: the phases of all would need much memory.
        for (positions, strengths) in positions.chunks(PHASES_AT_ONCE).zip(strengths.chunks(PHASES_AT_ONCE)) {
            let phases: Vec<Phases> =
                positions.iter().map(|position| Phases::new(*position, self.side, orders)).collect();
            for (row, sums) in self.rows.iter().zip(&mut density) {
                for (disc, strength) in phases.iter().zip(strengths) {
                    let [cosine, sine] = disc.along_y(row).map(|part| strength * part);
                    for (sum, phase) in sums.iter_mut().zip(&disc.x) {
                        sum[0] += phase[0] * cosine - phase[1] * sine;
                        sum[1] += phase[0] * sine + phase[1] * cosine;
                    }
                }
            }
        }
        density
    }

    /// Weight times conjugate density, by which the waves act on a disc.
    fn response(&self, density: &[Vec<[f64; 2]>]) -> Vec<Vec<[f64; 2]>> {
        let respond = |(row, sums): (&WaveRow, &Vec<[f64; 2]>)| {
            row.weights.iter().zip(sums).map(|(weight, sum)| [weight * sum[0], -weight * sum[1]]).collect()
        };
        self.rows.iter().zip(density).map(respond).collect()
    }

    /// Far part of the force on a disc: −Σ k Im(exp(ik·r)·response).
    ///
    /// Along a row only k_x changes, so that two complex sums over the row, with and without the factor l,
    /// serve both components.
    fn far_force(&self, disc: &Phases, response: &[Vec<[f64; 2]>]) -> [f64; 2] {
        let unit = TAU / self.side;
        let mut force = [0.0; 2];
        for (row, values) in self.rows.iter().zip(response) {
            let [cosine, sine] = disc.along_y(row);
            let mut sum = [0.0; 2];
            let mut sum_of_slopes = [0.0; 2];
            let mut order = 0.0;
            for (value, phase) in values.iter().zip(&disc.x) {
                let real = value[0] * phase[0] - value[1] * phase[1];
                let imaginary = value[0] * phase[1] + value[1] * phase[0];
                sum[0] += real;
                sum[1] += imaginary;
                sum_of_slopes[0] += order * real;
                sum_of_slopes[1] += order * imaginary;
                order += 1.0;
            }
            force[0] -= unit * (sum_of_slopes[0] * sine + sum_of_slopes[1] * cosine);
            force[1] -= unit * row.order * (sum[0] * sine + sum[1] * cosine);
        }
        force
    }
}

/// What has to be added to the near energy of a pair for its mean over the box to be zero:
/// (2πV₀/L²)(1 − exp(−κ²/4α²))/κ².
fn near_energy_offset(side: f64, capillary_strength: f64, splitting: f64, screened: f64) -> f64 {
    let fraction = if screened == 0.0 { 1.0 } else { -libm::expm1(-screened) / screened };
    TAU * capillary_strength / (side * side) * fraction / (4.0 * splitting * splitting)
}

/// The waves of one k_y: l = 0, 1, … along x, one of each pair ±k.
#[derive(Clone, Debug)]
struct WaveRow {
    /// m, with its sign.
    order: f64,
    /// |m|.
    magnitude: usize,
    /// (4πV₀/L²) exp(−(k²+κ²)/4α²)/(k²+κ²) for each l: twice the weight of a wave, for −k is left out.
    weights: Vec<f64>,
}

/// All rows of waves up to k = 2 [`REACH`] α.
fn wave_rows(side: f64, capillary_strength: f64, screening: f64, splitting: f64) -> Vec<WaveRow> {
    let unit = TAU / side;
    let reach = 2.0 * REACH * splitting / unit;
    let last = reach as i32;
    let weight = |l: i32, m: i32| {
        // For l = 0 the wave −k lies in the row −m, and k = 0 exerts no force.
        if l == 0 && m <= 0 {
            return 0.0;
        }
        let wave_square = unit * unit * f64::from(l * l + m * m) + screening * screening;
        let damping = libm::exp(-0.25 * wave_square / (splitting * splitting));
        2.0 * TAU * capillary_strength / (side * side) * damping / wave_square
    };
    let row = |m: i32| {
        let longest = (reach * reach - f64::from(m * m)).max(0.0).sqrt() as i32;
        WaveRow {
            order: f64::from(m),
            magnitude: m.unsigned_abs() as usize,
            weights: (0..=longest).map(|l| weight(l, m)).collect(),
        }
    };
    (-last..=last).map(row).collect()
}

/// exp(2πi n x/L) and exp(2πi n y/L) of a disc for n = 0, 1, …, as [cosine, sine].
struct Phases {
    x: Vec<[f64; 2]>,
    y: Vec<[f64; 2]>,
}

impl Phases {
    fn new(position: [f64; 2], side: f64, orders: usize) -> Self {
        let along = |coordinate: f64| {
            let turn = coordinate / side;
            let phase = |order: usize| {
                let turns = order as f64 * turn;
                let (sine, cosine) = libm::sincos(TAU * (turns - turns.round()));
                [cosine, sine]
            };
            (0..=orders).map(phase).collect()
        };
        Self { x: along(position[0]), y: along(position[1]) }
    }

    /// exp(ik_y y) of a row of waves.
    fn along_y(&self, row: &WaveRow) -> [f64; 2] {
        let [cosine, sine] = self.y[row.magnitude];
        [cosine, if row.order < 0.0 { -sine } else { sine }]
    }

    /// exp(ik·r) of wave `order` of a row.
    fn wave(&self, order: usize, row: &WaveRow) -> [f64; 2] {
        let [cosine, sine] = self.along_y(row);
        let phase = self.x[order];
        [phase[0] * cosine - phase[1] * sine, phase[0] * sine + phase[1] * cosine]
    }
}

#[cfg(test)]
mod tests {
    use super::super::images::ImageSum;
    use super::super::{RandomNumbers, rms, rms_difference};
    use super::*;

    const SIDE: f64 = 500.0;
    const STRENGTH: f64 = 0.89;

    /// Separations (R₀) from deep overlap to half a box, near the corner, and beyond the border.
    const SEPARATIONS: [[f64; 2]; 10] = [
        [0.01, 0.0],
        [0.5, 0.0],
        [2.0, 0.0],
        [1.2, -1.6],
        [0.0, -17.3],
        [30.0, 17.0],
        [-120.0, 3.0],
        [251.0, 100.0],
        [249.0, 249.5],
        [499.0, 499.0],
    ];

    /// Whether a force is right to `tolerance` of itself, or, where next to nothing is left of it, to the
    /// rounding of the waves it is summed from.
    fn agrees(force: [f64; 2], exact: [f64; 2], tolerance: f64) -> bool {
        let rounding = 1e-15 * STRENGTH / SIDE;
        rms_difference(&[force], &[exact]) <= tolerance * rms(&[exact]) + rounding
    }

    /// The force without screening in closed form. The energy in a neutralising background is
    /// V₀[ln|θ₁(πz/L)| − πy²/L²] with z = x + iy and the nome q = e^−π of the square, so that its gradient
    /// is that of θ₁'/θ₁(u) = cot u + 4 Σ q²ⁿ/(1 − q²ⁿ) sin 2nu (Abramowitz & Stegun 16.29.1).
    fn unscreened_force(dx: f64, dy: f64) -> [f64; 2] {
        let y = minimum_image(dy, SIDE);
        let [a, b] = [dx, y].map(|coordinate| 0.5 * TAU * coordinate / SIDE);
        let size = 2.0 * (libm::sin(a) * libm::sin(a) + libm::sinh(b) * libm::sinh(b));
        let mut real = libm::sin(2.0 * a) / size;
        let mut imaginary = -libm::sinh(2.0 * b) / size;
        for n in 1..16 {
            let twice = 2.0 * f64::from(n);
            let nome = libm::exp(-0.5 * TAU * twice);
            let factor = 4.0 * nome / (1.0 - nome);
            real += factor * libm::sin(twice * a) * libm::cosh(twice * b);
            imaginary += factor * libm::cos(twice * a) * libm::sinh(twice * b);
        }
        let unit = STRENGTH * 0.5 * TAU / SIDE;
        [unit * real, -unit * imaginary - STRENGTH * TAU * y / (SIDE * SIDE)]
    }

    #[test]
    fn agrees_with_the_sum_over_images() {
        for ratio in [0.01, 0.02, 0.05, 0.1, 0.54] {
            let ewald = Ewald::new(SIDE, STRENGTH, ratio * SIDE);
            let images = ImageSum::new(SIDE, STRENGTH, ratio * SIDE);
            for [x, y] in SEPARATIONS {
                let [force, exact] = [ewald.pair_force(x, y), images.pair_force(x, y)];
                assert!(agrees(force, exact, 1e-10), "{ratio} ({x}, {y}): {force:?} {exact:?}");
            }
        }
    }

    #[test]
    fn agrees_with_the_sum_over_images_when_the_screening_is_weak() {
        let ewald = Ewald::new(SIDE, STRENGTH, 3.0 * SIDE);
        let images = ImageSum::new(SIDE, STRENGTH, 3.0 * SIDE);
        assert!(agrees(ewald.pair_force(90.0, 210.0), images.pair_force(90.0, 210.0), 1e-10));
    }

    #[test]
    fn energy_is_that_of_the_images_but_for_its_mean() {
        for ratio in [0.01, 0.1, 0.54] {
            let ewald = Ewald::new(SIDE, STRENGTH, ratio * SIDE);
            let images = ImageSum::new(SIDE, STRENGTH, ratio * SIDE);
            for [x, y] in SEPARATIONS {
                let energy = ewald.pair_energy(x, y) - TAU * STRENGTH * ratio * ratio;
                assert!((energy - images.pair_energy(x, y)).abs() < 1e-13, "{ratio} ({x}, {y})");
            }
        }
    }

    #[test]
    fn agrees_with_theta_functions_without_screening() {
        let ewald = Ewald::new(SIDE, STRENGTH, f64::INFINITY);
        for [x, y] in SEPARATIONS {
            let [force, exact] = [ewald.pair_force(x, y), unscreened_force(x, y)];
            assert!(agrees(force, exact, 1e-11), "({x}, {y}): {force:?} {exact:?}");
        }
    }

    #[test]
    fn forces_do_not_depend_on_the_splitting() {
        for ratio in [0.01, 0.1, 0.54, 10.0, f64::INFINITY] {
            let ewald = Ewald::new(SIDE, STRENGTH, ratio * SIDE);
            for splitting in [12.0, 25.0] {
                let other = Ewald::with_splitting(SIDE, STRENGTH, ratio * SIDE, splitting / SIDE);
                for [x, y] in SEPARATIONS {
                    assert!(
                        agrees(other.pair_force(x, y), ewald.pair_force(x, y), 1e-11),
                        "{ratio} ({x}, {y})"
                    );
                }
            }
        }
    }

    #[test]
    fn forces_and_energy_are_sums_over_pairs() {
        let positions = RandomNumbers::new(1).positions(12, SIDE);
        let ewald = Ewald::new(SIDE, STRENGTH, 270.0);
        let mut sums = vec![[0.0; 2]; positions.len()];
        let mut energy = 0.0;
        for (i, first) in positions.iter().enumerate() {
            for (j, second) in positions.iter().enumerate().filter(|(j, _)| *j != i) {
                let [dx, dy] = [second[0] - first[0], second[1] - first[1]];
                let force = ewald.pair_force(dx, dy);
                sums[i][0] += force[0];
                sums[i][1] += force[1];
                energy += if j > i { ewald.pair_energy(dx, dy) } else { 0.0 };
            }
        }
        assert!(rms_difference(&ewald.forces(&positions), &sums) < 1e-13 * rms(&sums));
        assert!((ewald.energy(&positions) - energy).abs() < 1e-12);
    }

    #[test]
    fn strengths_multiply_the_forces_and_energies_of_pairs() {
        let positions = RandomNumbers::new(3).positions(9, SIDE);
        let strengths = [1.0, -1.0, 0.0, 0.5, 2.0, -0.25, 1.0, -3.0, 1e-3];
        let ewald = Ewald::new(SIDE, STRENGTH, 270.0);
        let mut sums = vec![[0.0; 2]; positions.len()];
        let mut energy = 0.0;
        for (i, first) in positions.iter().enumerate() {
            for (j, second) in positions.iter().enumerate().filter(|(j, _)| *j != i) {
                let [dx, dy] = [second[0] - first[0], second[1] - first[1]];
                let product = strengths[i] * strengths[j];
                let force = ewald.pair_force(dx, dy);
                sums[i][0] += product * force[0];
                sums[i][1] += product * force[1];
                energy += if j > i { product * ewald.pair_energy(dx, dy) } else { 0.0 };
            }
        }
        assert!(rms_difference(&ewald.forces_of(&positions, &strengths), &sums) < 1e-13 * rms(&sums));
        assert!((ewald.energy_of(&positions, &strengths) - energy).abs() < 1e-12);
    }

    #[test]
    fn forces_on_a_sample_are_those_on_its_discs() {
        let mut random = RandomNumbers::new(4);
        // More than are taken at once.
        let positions = random.positions(PHASES_AT_ONCE + 100, SIDE);
        let strengths: Vec<f64> = positions.iter().map(|_| 2.0 * random.uniform() - 1.0).collect();
        let ewald = Ewald::new(SIDE, STRENGTH, 25.0);
        let all = ewald.forces_of(&positions, &strengths);
        let sample = [1100, 3, 700];
        let expected = sample.map(|index: usize| all[index]);
        assert!(
            rms_difference(&ewald.forces_on(&sample, &positions, &strengths), &expected)
                < 1e-13 * rms(&expected)
        );
    }

    #[test]
    fn forces_are_the_slopes_of_the_energy() {
        let mut random = RandomNumbers::new(6);
        let positions = random.positions(20, SIDE);
        let strengths: Vec<f64> = positions.iter().map(|_| 2.0 * random.uniform() - 1.0).collect();
        for length in [25.0, 270.0, f64::INFINITY] {
            let ewald = Ewald::new(SIDE, STRENGTH, length);
            let forces = ewald.forces_of(&positions, &strengths);
            for (disc, axis) in [(0, 0), (7, 1)] {
                let moved = |by: f64| {
                    let mut moved = positions.clone();
                    moved[disc][axis] += by;
                    ewald.energy_of(&moved, &strengths)
                };
                let slope = (moved(1e-3) - moved(-1e-3)) / 2e-3;
                assert!((forces[disc][axis] + slope).abs() < 1e-6 * rms(&forces), "{length} {disc}");
            }
        }
    }

    #[test]
    fn pair_force_is_antisymmetric_and_has_the_symmetry_of_the_square() {
        let ewald = Ewald::new(SIDE, STRENGTH, 270.0);
        for [x, y] in SEPARATIONS {
            let [force_x, force_y] = ewald.pair_force(x, y);
            assert!(agrees(ewald.pair_force(-x, -y), [-force_x, -force_y], 1e-14));
            assert!(agrees(ewald.pair_force(x, -y), [force_x, -force_y], 1e-13));
            assert!(agrees(ewald.pair_force(y, x), [force_y, force_x], 1e-13));
            assert!(agrees(ewald.pair_force(x + SIDE, y - 2.0 * SIDE), [force_x, force_y], 1e-11));
        }
    }

    #[test]
    fn discs_of_a_full_box_feel_no_total_force_under_any_splitting() {
        let positions = RandomNumbers::new(2).positions(2500, SIDE);
        let ewald = Ewald::new(SIDE, STRENGTH, 270.0);
        let other = Ewald::with_splitting(SIDE, STRENGTH, 270.0, 25.0 / SIDE);
        let forces = ewald.forces(&positions);
        for axis in 0..2 {
            let total: f64 = forces.iter().map(|force| force[axis]).sum();
            assert!(total.abs() < 1e-11 * rms(&forces), "{total:e}");
        }
        assert!(rms_difference(&other.forces(&positions), &forces) < 1e-13 * rms(&forces));
        let energy = ewald.energy(&positions);
        assert!((other.energy(&positions) / energy - 1.0).abs() < 1e-11);
    }
}
