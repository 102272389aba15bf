//! Waves of the periodic box, and the power of the density in them.
//!
//! A wave vector is k = 2π(l, m)/L with whole l and m. Shell n holds the waves whose |k|L/2π rounds to n. As the
//! density is real, ρ̂ of −k is the conjugate of ρ̂ of k: of each such pair one is kept.
//!
//! In: positions. Out: |ρ̂_k|² of ρ̂_k = Σ exp(−ik·r), a pure number, 1 for one disc and N² for N discs in phase.
//!
//! Per disc and axis there is one sine and one cosine; the phase factors of l > 1 are products of earlier ones, log₂ l
//! deep. They are summed over blocks of discs in an order that depends on nothing but the number of discs, so that
//! the same discs have the same powers to the last bit. What rounding leaves of a power that is zero is of the order
//! of (10⁻¹⁵ l N)².
//!
//! ```
//! use meniscus::observables::waves::Waves;
//! use meniscus::start::square_lattice;
//!
//! // 8 × 8 discs scatter in phase where l and m are multiples of 8, and nowhere else.
//! let waves = Waves::of_shells(8);
//! let powers = waves.powers(&square_lattice(64).unwrap());
//! for (&wave, &power) in waves.vectors().iter().zip(&powers) {
//!     let expected = if wave == (8, 0) || wave == (0, 8) { 4096.0 } else { 0.0 };
//!     assert!((power - expected).abs() < 1e-9);
//! }
//! ```

use core::f64::consts::TAU;
use core::ops::Range;

use meniscus_core::torus::{Fraction, Position, UNITS};

/// A wave vector: l and m of k = 2π(l, m)/L.
pub type Wave = (i32, i32);

/// Discs that are summed together.
const BLOCK: usize = 64;

/// Sums that run side by side over a block.
const LANES: usize = 4;

/// The waves of a shell.
#[derive(Clone, Debug, PartialEq)]
pub struct Shell {
    /// n, what |k|L/2π rounds to.
    pub number: u32,
    /// The mean of |k|L/2π over its waves.
    pub order: f64,
    /// Where its waves are among all.
    pub waves: Range<usize>,
}

/// Waves to look at, one of each pair ±k, shell after shell.
#[derive(Clone, Debug)]
pub struct Waves {
    /// Waves with l ≥ 0 and m ≥ 0; each stands for (l, m) and, where it is another, (l, −m).
    quadrant: Vec<[u32; 2]>,
    vectors: Vec<Wave>,
    shells: Vec<Shell>,
}

/// |k| of a wave in units of 2π/L.
#[must_use]
pub fn order((l, m): Wave) -> f64 {
    let (l, m) = (f64::from(l), f64::from(m));
    (l * l + m * m).sqrt()
}

impl Waves {
    /// All waves of the shells 1 to `shells`.
    #[must_use]
    pub fn of_shells(shells: u32) -> Self {
        Self::new((1..=shells).map(|shell| (shell, quadrant_of(shell))))
    }

    /// All waves with |k| below `limit`, in units of 2π/L.
    #[must_use]
    pub fn below(limit: f64) -> Self {
        let inside = |&[l, m]: &[u32; 2]| order((l as i32, m as i32)) < limit;
        // What rounds to more than ⌈limit⌉ is not below it. `as` makes 0 of what is negative or no number.
        let shells = 1..=libm::ceil(limit) as u32;
        Self::new(shells.map(|shell| (shell, quadrant_of(shell).into_iter().filter(inside).collect())))
    }

    /// Waves of `shells`, numbers from 1: all where there are at most `most`, else about `most` in directions spread
    /// evenly over each quadrant.
    ///
    /// From a shell with too many, those with l ≥ 0 and m ≥ 0 are put in the order of their angle and every so
    /// many-th is taken, together with its mirror image (l, −m): the same ones always.
    #[must_use]
    pub fn selected(shells: impl IntoIterator<Item = u32>, most: usize) -> Self {
        Self::new(shells.into_iter().map(|shell| (shell, thinned(quadrant_of(shell), most))))
    }

    fn new(shells: impl Iterator<Item = (u32, Vec<[u32; 2]>)>) -> Self {
        let mut waves = Self { quadrant: Vec::new(), vectors: Vec::new(), shells: Vec::new() };
        for (number, quadrant) in shells.filter(|(_, quadrant)| !quadrant.is_empty()) {
            let first = waves.vectors.len();
            for &[l, m] in &quadrant {
                waves.vectors.push((l as i32, m as i32));
                if mirrored([l, m]) {
                    waves.vectors.push((l as i32, -(m as i32)));
                }
            }
            waves.quadrant.extend(quadrant);
            let vectors = waves.vectors.get(first..).unwrap_or_default();
            let order = vectors.iter().map(|&wave| order(wave)).sum::<f64>() / vectors.len() as f64;
            waves.shells.push(Shell { number, order, waves: first..waves.vectors.len() });
        }
        waves
    }

    /// The wave vectors.
    #[must_use]
    pub fn vectors(&self) -> &[Wave] {
        &self.vectors
    }

    /// The shells, in rising order.
    #[must_use]
    pub fn shells(&self) -> &[Shell] {
        &self.shells
    }

    /// |ρ̂_k|² of discs at `positions` for each of [`vectors`](Self::vectors).
    #[must_use]
    pub fn powers(&self, positions: &[Position]) -> Vec<f64> {
        let most = |axis: usize| self.quadrant.iter().map(|wave| wave[axis]).max().unwrap_or(0) as usize;
        let mut along_x = Table::new(most(0));
        let mut along_y = Table::new(most(1));
        let mut sums = vec![Sums::default(); self.quadrant.len()];
        for block in positions.chunks(BLOCK) {
            along_x.fill(block, |position| position.x);
            along_y.fill(block, |position| position.y);
            for (sums, &[l, m]) in sums.iter_mut().zip(&self.quadrant) {
                if let (Some(x), Some(y)) = (along_x.get(l), along_y.get(m)) {
                    sums.add(x, y);
                }
            }
        }
        let mut powers = Vec::with_capacity(self.vectors.len());
        for (sums, &wave) in sums.iter().zip(&self.quadrant) {
            let [power, of_mirror_image] = sums.powers();
            powers.push(power);
            if mirrored(wave) {
                powers.push(of_mirror_image);
            }
        }
        powers
    }
}

/// Whether (l, −m) is neither (l, m) nor its opposite.
fn mirrored([l, m]: [u32; 2]) -> bool {
    l > 0 && m > 0
}

/// The waves with l ≥ 0 and m ≥ 0 of shell n: (n − ½)² < l² + m² < (n + ½)², among whole numbers
/// n² − n < l² + m² ≤ n² + n.
fn quadrant_of(shell: u32) -> Vec<[u32; 2]> {
    let n = u64::from(shell);
    let (within, outermost) = (n * n - n, n * n + n);
    (0..=n)
        .flat_map(|l| {
            let least = within.checked_sub(l * l).map_or(0, |left| left.isqrt() + 1);
            (least..=(outermost - l * l).isqrt()).map(move |m| [l as u32, m as u32])
        })
        .collect()
}

/// As many of `quadrant`, evenly spread over its angles, as stand for `most` waves.
fn thinned(mut quadrant: Vec<[u32; 2]>, most: usize) -> Vec<[u32; 2]> {
    let count: usize = quadrant.iter().map(|&wave| if mirrored(wave) { 2 } else { 1 }).sum();
    if count <= most {
        return quadrant;
    }
    // tan of the angle is m/l; of those in one direction the longer comes later.
    let steepness = |&[l, m]: &[u32; 2], &[other_l, other_m]: &[u32; 2]| {
        let turn = u64::from(m) * u64::from(other_l);
        turn.cmp(&(u64::from(other_m) * u64::from(l))).then((l + m).cmp(&(other_l + other_m)))
    };
    quadrant.sort_unstable_by(steepness);
    let kept = (most / 2).max(1);
    // The middle of each of as many equal parts.
    (0..kept).filter_map(|part| quadrant.get((2 * part + 1) * quadrant.len() / (2 * kept)).copied()).collect()
}

/// exp(−iφ) of the discs of a block.
#[derive(Clone)]
struct Phases {
    cosine: [[f64; LANES]; BLOCK / LANES],
    /// −sin φ
    sine: [[f64; LANES]; BLOCK / LANES],
}

impl Phases {
    const NONE: Self = Self { cosine: [[0.0; LANES]; BLOCK / LANES], sine: [[0.0; LANES]; BLOCK / LANES] };

    /// Makes these the products of two.
    fn set_product(&mut self, first: &Self, second: &Self) {
        for lanes in 0..BLOCK / LANES {
            for lane in 0..LANES {
                let (a, b) = (first.cosine[lanes][lane], first.sine[lanes][lane]);
                let (c, d) = (second.cosine[lanes][lane], second.sine[lanes][lane]);
                self.cosine[lanes][lane] = a * c - b * d;
                self.sine[lanes][lane] = a * d + b * c;
            }
        }
    }
}

/// exp(−i 2π l x/L) along one axis for l = 0, 1, …
struct Table(Vec<Phases>);

impl Table {
    fn new(most: usize) -> Self {
        Self(vec![Phases::NONE; most + 1])
    }

    fn get(&self, l: u32) -> Option<&Phases> {
        self.0.get(l as usize)
    }

    /// Those of a block of discs; where it has fewer than [`BLOCK`], zeros.
    fn fill(&mut self, block: &[Position], coordinate: impl Fn(&Position) -> Fraction) {
        let (mut zeroth, mut first) = (Phases::NONE, Phases::NONE);
        for (index, position) in block.iter().enumerate().take(BLOCK) {
            let turns = f64::from(coordinate(position).to_bits()) / UNITS;
            let (sine, cosine) = libm::sincos(TAU * turns);
            let (lanes, lane) = (index / LANES, index % LANES);
            zeroth.cosine[lanes][lane] = 1.0;
            first.cosine[lanes][lane] = cosine;
            first.sine[lanes][lane] = -sine;
        }
        for l in 0..self.0.len() {
            let (before, rest) = self.0.split_at_mut(l);
            let Some(phases) = rest.first_mut() else { return };
            match (l, before.get(l / 2), before.get(l - l / 2)) {
                (0, ..) => *phases = zeroth.clone(),
                (_, Some(one), Some(other)) => phases.set_product(one, other),
                _ => *phases = first.clone(),
            }
        }
    }
}

fn add_products(sums: &mut [f64; LANES], first: &[f64; LANES], second: &[f64; LANES]) {
    for (sum, (first, second)) in sums.iter_mut().zip(first.iter().zip(second)) {
        *sum += first * second;
    }
}

/// Sums over discs of the four products of the parts of two phase factors, from which ρ̂ of (l, m) and of (l, −m) follow.
#[derive(Clone, Copy, Default)]
struct Sums([f64; 4]);

impl Sums {
    fn add(&mut self, x: &Phases, y: &Phases) {
        let mut lanes = [[0.0; LANES]; 4];
        let [both_cosines, both_sines, cosine_sine, sine_cosine] = &mut lanes;
        for ((a, b), (c, d)) in (x.cosine.iter().zip(&x.sine)).zip(y.cosine.iter().zip(&y.sine)) {
            add_products(both_cosines, a, c);
            add_products(both_sines, b, d);
            add_products(cosine_sine, a, d);
            add_products(sine_cosine, b, c);
        }
        for (sum, [first, second, third, fourth]) in self.0.iter_mut().zip(lanes) {
            *sum += (first + second) + (third + fourth);
        }
    }

    /// |ρ̂|² of (l, m) and of (l, −m).
    fn powers(&self) -> [f64; 2] {
        let [cosines, sines, cosine_sine, sine_cosine] = self.0;
        let square = |real: f64, imaginary: f64| real * real + imaginary * imaginary;
        [
            square(cosines - sines, cosine_sine + sine_cosine),
            square(cosines + sines, sine_cosine - cosine_sine),
        ]
    }
}
