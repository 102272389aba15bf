//! The split (P³M) force against Ewald sums in binary64, and its errors against their estimates.
//!
//! An error is the root mean square over discs of the difference of two forces. Relative errors are relative to
//! [`reference_force`], the root mean square force of a random start, which a state of the same discs has but for chance.
//!
//! With `MENISCUS_LONG_TESTS=1` the whole sweep of capillary lengths, densities, numbers of discs and accuracies is done;
//! `MENISCUS_ACCURACY_TABLE=FILE` writes it as a table in Markdown.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use core::f64::consts::TAU;
use core::fmt::Write;

use meniscus::accuracy::{Given, Scheme, System, choose, estimate, reference_force};
use meniscus::engine::Engine;
use meniscus_core::assignment::DISC;
use meniscus_core::dynamics::{Clock, Disc};
use meniscus_core::near_part::{evaluate, fill_table, table_length};
use meniscus_core::parameters::{
    Assignment, Influence, Method, Noise, Parameters, SMALLEST_CAPILLARY_LENGTH,
};
use meniscus_core::torus::Position;
use meniscus_tests::figures::assert_within;
use meniscus_tests::long_tests;
use meniscus_tests::reference::ewald::Ewald;
use meniscus_tests::reference::images::ImageSum;
use meniscus_tests::reference::near_part::near_force;
use meniscus_tests::reference::{RandomNumbers, rms, rms_difference};
use meniscus_tests::states::{at, hexagonal_cluster, in_radii, separated};
use meniscus_tests::tolerances::{
    CHOSEN_ERROR, CLUSTER_ABSOLUTE_ERROR, CLUSTER_ERROR, ESTIMATE_ERROR, NEAR_TABLE, SPLIT_ERROR, SPLIT_PAIR,
    Within,
};

/// 2⁻²⁰, the unit of strength.
const STRENGTH_UNIT: f64 = 1.0 / 1_048_576.0;

/// Table I: 2500 discs, V0 = 0.89 kBT and λ = 270 R0 in a box of 500 R0.
const TABLE_1: System = System {
    side: 500.0,
    particles: 2500,
    capillary_strength: 0.89,
    capillary_length: 270.0,
    mean_square_strength: 1.0,
};

/// Attraction alone.
fn parameters(system: &System, scheme: &Scheme) -> Parameters {
    Parameters {
        side: system.side,
        capillary_strength: system.capillary_strength,
        capillary_length: system.capillary_length,
        repulsion: false,
        method: Method::P3m,
        splitting: scheme.splitting,
        cutoff: scheme.cutoff,
        grid: scheme.grid,
        assignment: scheme.assignment,
        influence: Influence::Optimal,
        noise: Noise::None,
        ..Parameters::default()
    }
}

/// The exact forces.
fn ewald(system: &System) -> Ewald {
    Ewald::new(system.side, system.capillary_strength, system.capillary_length)
}

/// Some discs, and the exact forces on a sample of them.
struct State {
    discs: Vec<Disc>,
    sample: Vec<usize>,
    exact: Vec<[f64; 2]>,
}

impl State {
    /// Discs of equal strength, about `sampled` of them looked at.
    fn equal(system: &System, ewald: &Ewald, positions: &[Position], sampled: usize) -> Self {
        Self::new(system, ewald, positions, &vec![DISC as i32; positions.len()], sampled)
    }

    fn new(
        system: &System,
        ewald: &Ewald,
        positions: &[Position],
        strengths: &[i32],
        sampled: usize,
    ) -> Self {
        let (side, count) = (system.side, positions.len());
        let disc = |(id, (&position, &strength))| Disc { id, position, strength };
        let discs = (0..).zip(positions.iter().zip(strengths)).map(disc).collect();
        let sample: Vec<usize> = (0..count).step_by((count / sampled).max(1)).collect();
        let strengths: Vec<f64> = strengths.iter().map(|&f| f64::from(f) * STRENGTH_UNIT).collect();
        let exact = ewald.forces_on(&sample, &in_radii(positions, side), &strengths);
        Self { discs, sample, exact }
    }

    /// The system's discs at random without overlap, once for each seed 1, 2, 3 …
    fn random(system: &System, seeds: u64, sampled: usize) -> Vec<Self> {
        let ewald = ewald(system);
        let state = |seed| {
            let positions = separated(seed, system.particles, system.side, 2.0);
            assert_eq!(positions.len(), system.particles, "too dense");
            Self::equal(system, &ewald, &positions, sampled)
        };
        (1..=seeds).map(state).collect()
    }

    fn found(&self, system: &System, scheme: &Scheme) -> Vec<[f64; 2]> {
        let parameters = parameters(system, scheme);
        let forces = Engine::with_ids(&parameters, Clock::START, self.discs.iter().copied());
        let forces = forces.unwrap().forces().unwrap();
        self.sample.iter().map(|&disc| forces[disc]).collect()
    }
}

/// rms error of a scheme over all states together, kBT/R0.
fn error(system: &System, scheme: &Scheme, states: &[State]) -> f64 {
    let found: Vec<[f64; 2]> = states.iter().flat_map(|state| state.found(system, scheme)).collect();
    let exact: Vec<[f64; 2]> = states.iter().flat_map(|state| state.exact.clone()).collect();
    rms_difference(&found, &exact)
}

/// The same relative to the reference force.
fn relative_error(system: &System, scheme: &Scheme, states: &[State]) -> f64 {
    error(system, scheme, states) / reference_force(system)
}

/// A scheme by order, mesh, αh and r_c (R0).
fn scheme(system: &System, order: usize, grid: usize, splitting_of_spacing: f64, cutoff: f64) -> Scheme {
    let splitting = splitting_of_spacing * grid as f64 / system.side;
    Scheme { grid, assignment: Assignment::ALL[order - 2], splitting, cutoff }
}

#[test]
fn schemes_given_by_hand_have_the_errors_of_the_table() {
    let states = State::random(&TABLE_1, 1, if long_tests() { 2500 } else { 800 });
    for ((order, grid, splitting_of_spacing, cutoff), accepted) in SPLIT_ERROR {
        let scheme = scheme(&TABLE_1, order, grid, splitting_of_spacing, cutoff);
        assert_within(relative_error(&TABLE_1, &scheme, &states), accepted, &format!("{scheme:?}"));
    }
}

#[test]
fn every_order_is_as_exact_as_estimated_at_any_capillary_length() {
    for capillary_length in [25.0, 270.0, 5000.0, f64::INFINITY] {
        let system = System { side: 200.0, particles: 400, capillary_length, ..TABLE_1 };
        let states = State::random(&system, 3, 400);
        for order in 2..=7 {
            // A cut-off at which the mesh decides: the near part ends at exp(−4.5²).
            let scheme = scheme(&system, order, 64, 0.5, 28.0);
            let estimate = estimate(&system, &scheme);
            assert!(estimate.near < 0.5 * estimate.mesh, "{estimate:?}");
            let ratio = error(&system, &scheme, &states) / estimate.total();
            assert_within(ratio, ESTIMATE_ERROR, &format!("lambda = {capillary_length}, order {order}"));
        }
    }
}

#[test]
fn the_cutoff_errs_as_estimated() {
    for capillary_length in [25.0, 270.0, f64::INFINITY] {
        let system = System { side: 200.0, particles: 400, capillary_length, ..TABLE_1 };
        let states = State::random(&system, 3, 400);
        for cutoff in [15.0, 20.0, 25.0] {
            let scheme = Scheme { grid: 128, assignment: Assignment::Order7, splitting: 0.1, cutoff };
            let estimate = estimate(&system, &scheme);
            assert!(estimate.mesh < 0.1 * estimate.near, "{estimate:?}");
            let ratio = error(&system, &scheme, &states) / estimate.total();
            assert_within(ratio, ESTIMATE_ERROR, &format!("lambda = {capillary_length}, r_c = {cutoff}"));
        }
    }
}

#[test]
fn a_pair_feels_the_closed_form_whatever_the_splitting() {
    let side = 100.0;
    let mut random = RandomNumbers::new(4);
    for capillary_length in [5.0, 25.0, 54.0] {
        let system = System { side, particles: 2, capillary_length, ..TABLE_1 };
        let images = ImageSum::new(side, TABLE_1.capillary_strength, capillary_length);
        // αr_c is 5 and more, αh 0.3 and less.
        let schemes = [(0.25, 20.0), (0.16, 32.0), (0.11, 49.0)].map(|(splitting, cutoff)| Scheme {
            grid: 128,
            assignment: Assignment::Order7,
            splitting,
            cutoff,
        });
        for distance in [0.9, 1.2, 2.0, 5.0, 11.0, 19.9, 20.1, 31.0, 40.0, 50.0] {
            let (sine, cosine) = libm::sincos(TAU * random.uniform());
            let first = at(side, side * random.uniform(), side * random.uniform()).unwrap();
            let shift = |along: f64| (along / side * 4_294_967_296.0) as i64 as u32;
            let second = Position::from_bits(
                first.x.to_bits().wrapping_add(shift(distance * cosine)),
                first.y.to_bits().wrapping_add(shift(distance * sine)),
            );
            let [a, b] = [in_radii(&[first], side)[0], in_radii(&[second], side)[0]];
            let exact = images.pair_force(b[0] - a[0], b[1] - a[1]);
            let forces = schemes.map(|scheme| {
                let parameters = parameters(&system, &scheme);
                Engine::new(&parameters, Clock::START, &[first, second]).unwrap().forces().unwrap()
            });
            // Of V0/R0 at most: images and rounding do not fall with the force itself.
            let allowed = SPLIT_PAIR * TABLE_1.capillary_strength * (1.0 / distance + 1.0 / side);
            for (scheme, forces) in schemes.iter().zip(&forces) {
                let off = rms_difference(&[forces[0]], &[exact]);
                assert!(off <= allowed, "{off:e} of {allowed:e} at {distance}, {scheme:?}");
                let net = rms(&[[forces[0][0] + forces[1][0], forces[0][1] + forces[1][1]]]);
                assert!(net <= allowed, "{net:e} net at {distance}, {scheme:?}");
            }
        }
    }
}

#[test]
fn forces_of_unequal_strengths_have_the_error_estimated() {
    let mut random = RandomNumbers::new(8);
    let positions = separated(8, 400, 200.0, 2.0);
    // Uniform from −1.5 to 1.5.
    let strengths: Vec<i32> =
        positions.iter().map(|_| ((3.0 * random.uniform() - 1.5) / STRENGTH_UNIT) as i32).collect();
    let squares: f64 = strengths.iter().map(|&f| f64::from(f) * STRENGTH_UNIT).map(|f| f * f).sum();
    let mean_square_strength = squares / positions.len() as f64;
    let system = System { side: 200.0, particles: 400, mean_square_strength, ..TABLE_1 };
    let states = [State::new(&system, &ewald(&system), &positions, &strengths, 400)];
    for order in [3, 5, 7] {
        let scheme = scheme(&system, order, 64, 0.45, 25.0);
        let ratio = error(&system, &scheme, &states) / estimate(&system, &scheme).total();
        assert_within(ratio, ESTIMATE_ERROR, &format!("order {order}"));
    }
}

/// What a choice for an accuracy does in some states: the scheme, and measured and estimated relative error.
fn chosen(system: &System, accuracy: f64, states: &[State]) -> Option<(Scheme, f64, f64)> {
    let choice = choose(system, accuracy, &Given::default()).ok()?;
    Some((choice.scheme, relative_error(system, &choice.scheme, states), choice.estimate))
}

#[test]
fn the_accuracy_asked_for_is_the_accuracy_had() {
    for capillary_length in [25.0, 270.0, 5000.0] {
        let system = System { capillary_length, ..TABLE_1 };
        let states = State::random(&system, 1, if long_tests() { 2500 } else { 300 });
        for accuracy in [1e-3, 1e-4, 1e-5] {
            if !long_tests() && capillary_length != 270.0 && accuracy != 1e-4 {
                continue;
            }
            let (scheme, measured, _) = chosen(&system, accuracy, &states).unwrap();
            let what = format!("lambda = {capillary_length}, {scheme:?}");
            assert_within(measured / accuracy, Within(0.3, CHOSEN_ERROR), &what);
        }
    }
}

/// 25 clusters of 100 discs, each turned in its own way.
fn clusters() -> Vec<Position> {
    let shifted = |cluster: u32| {
        // Fifths of the box, not in step with any mesh.
        let (x, y) = (858_993_459 * (cluster % 5), 858_993_459 * (cluster / 5));
        let discs = hexagonal_cluster(u64::from(cluster), 100, TABLE_1.side, 2.1, 0.06);
        discs.into_iter().map(move |disc| {
            Position::from_bits(disc.x.to_bits().wrapping_add(x), disc.y.to_bits().wrapping_add(y))
        })
    };
    (0..25).flat_map(shifted).collect()
}

#[test]
fn clusters_have_the_accuracy_asked_for() {
    let ewald = ewald(&TABLE_1);
    let one = hexagonal_cluster(1, 2500, TABLE_1.side, 2.1, 0.06);
    for (name, positions) in [("one cluster", one), ("25 clusters", clusters())] {
        let states = [State::equal(&TABLE_1, &ewald, &positions, 300)];
        let force = rms(&states[0].exact) / reference_force(&TABLE_1);
        for accuracy in if long_tests() { vec![1e-3, 1e-4, 1e-5] } else { vec![1e-3, 1e-5] } {
            let (scheme, measured, _) = chosen(&TABLE_1, accuracy, &states).unwrap();
            let what = format!("{name}, {scheme:?}");
            assert_within(measured / force / accuracy, CLUSTER_ERROR, &format!("{what}, of the force"));
            assert_within(measured / accuracy, CLUSTER_ABSOLUTE_ERROR, &format!("{what}, of the reference"));
        }
    }
}

#[test]
fn a_layer_in_order_has_the_error_of_one_in_disorder_at_most() {
    // A square lattice, each disc up to 1.5 R0 from its place: forces cancel, a tenth of the reference is left.
    let (rows, mut random) = (50_u32, RandomNumbers::new(5));
    let coordinate = |place: u32, random: &mut RandomNumbers| {
        ((f64::from(place) + 0.3 * random.uniform()) / f64::from(rows) * 4_294_967_296.0) as u32
    };
    let positions: Vec<Position> = (0..rows * rows)
        .map(|disc| {
            let x = coordinate(disc / rows, &mut random);
            Position::from_bits(x, coordinate(disc % rows, &mut random))
        })
        .collect();
    let states = [State::equal(&TABLE_1, &ewald(&TABLE_1), &positions, 300)];
    assert!(rms(&states[0].exact) < 0.2 * reference_force(&TABLE_1));
    let (scheme, measured, _) = chosen(&TABLE_1, 1e-4, &states).unwrap();
    assert_within(measured / 1e-4, Within(0.2, CHOSEN_ERROR), &format!("{scheme:?}"));
}

/// One line of the sweep.
struct Line {
    system: System,
    accuracy: f64,
    /// Scheme, measured and estimated relative error; none if refused.
    outcome: Option<(Scheme, f64, f64)>,
}

impl Line {
    const HEAD: &str = "| λ/L | ρ R0² | N | accuracy | M | order | α R0 | r_c/R0 | estimated | measured | measured/estimated |\n\
                        |---|---|---|---|---|---|---|---|---|---|---|\n";

    fn markdown(&self) -> String {
        let System { side, particles, capillary_length, .. } = self.system;
        let density = particles as f64 / (side * side);
        let ratio = (1e4 * capillary_length / side).round() / 1e4;
        let mut line = format!("| {ratio} | {density:.3} | {particles} | {:e} |", self.accuracy);
        match &self.outcome {
            Some((scheme, measured, estimate)) => {
                let Scheme { grid, assignment, splitting, cutoff } = scheme;
                write!(
                    line,
                    " {grid} | {} | {splitting} | {cutoff} | {estimate:.2e} | {measured:.2e} | {:.2} |",
                    assignment.order(),
                    measured / estimate
                )
            }
            None => write!(line, " refused | | | | | | |"),
        }
        .unwrap();
        line
    }
}

/// What is chosen for, and had in, random states: λ/L × densities (R0⁻²) × numbers of discs × accuracies.
#[expect(clippy::print_stdout, reason = "--nocapture shows the table as it grows")]
fn sweep(ratios: &[f64], densities: &[f64], counts: &[usize], accuracies: &[f64]) -> Vec<Line> {
    let mut lines = Vec::new();
    for &particles in counts {
        for &density in densities {
            for &ratio in ratios {
                let side = (particles as f64 / density).sqrt();
                let capillary_length = ratio * side;
                if capillary_length < SMALLEST_CAPILLARY_LENGTH {
                    continue;
                }
                let system = System { side, particles, capillary_length, ..TABLE_1 };
                // A state of few discs says little: its few pairs near contact decide.
                let seeds = (2000 / particles as u64).clamp(1, if long_tests() { 20 } else { 5 });
                let states = State::random(&system, seeds, 300);
                for &accuracy in accuracies {
                    let line = Line { system, accuracy, outcome: chosen(&system, accuracy, &states) };
                    println!("{}", line.markdown());
                    lines.push(line);
                }
            }
        }
    }
    lines
}

#[test]
fn errors_of_random_states_are_those_estimated() {
    let lines = if long_tests() {
        let ratios = [0.01, 0.03, 0.1, 0.54, 1.0, 3.0, 10.0, f64::INFINITY];
        sweep(&ratios, &[0.001, 0.01, 0.1], &[100, 1000, 10_000, 100_000], &[1e-2, 1e-3, 1e-4, 1e-5])
    } else {
        sweep(&[0.1, f64::INFINITY], &[0.01], &[100, 1000], &[1e-2, 1e-4])
    };
    if let Some(file) = std::env::var_os("MENISCUS_ACCURACY_TABLE") {
        let rows: String = lines.iter().map(|line| line.markdown() + "\n").collect();
        std::fs::write(file, Line::HEAD.to_string() + &rows).unwrap();
    }
    let mut accepted = 0;
    for line in &lines {
        if let Some((_, measured, estimate)) = line.outcome {
            accepted += 1;
            let Within(least, most) = ESTIMATE_ERROR;
            let ratio = measured / estimate;
            assert!(ratio >= least && ratio <= most, "{}", line.markdown());
            assert!(measured <= CHOSEN_ERROR * line.accuracy, "{}", line.markdown());
        }
    }
    assert!(2 * accepted > lines.len(), "{accepted} of {} accepted", lines.len());
}

#[test]
fn the_table_of_the_near_part_holds_its_integral() {
    let mut random = RandomNumbers::new(9);
    for (splitting, capillary_length, cutoff) in [
        (0.25, 270.0, 12.0),
        (0.1, f64::INFINITY, 40.0),
        (0.5, 0.3, 6.0),
        (0.02, 5.0, 200.0),
        (2.0, 50.0, 3.0),
        (1e-3, 300.0, 4000.0),
    ] {
        let mut table = vec![[0.0; 4]; table_length(cutoff)];
        fill_table(splitting, capillary_length, &mut table);
        for _ in 0..if long_tests() { 20_000 } else { 600 } {
            // From 0.9 R0 to the cut-off, evenly spread in the logarithm.
            let distance = 0.9 * libm::pow(cutoff / 0.9, random.uniform());
            let found = f64::from(evaluate(&table, (distance * distance) as f32));
            let exact = distance * near_force(distance, 1.0, capillary_length, splitting);
            assert!((found - exact).abs() <= NEAR_TABLE, "{found} not {exact} at {distance}, {splitting}");
        }
    }
}

#[test]
fn the_near_part_ends_at_the_cutoff() {
    // The far part does not jump there.
    let system = System { side: 64.0, particles: 2, ..TABLE_1 };
    let scheme = Scheme { grid: 64, assignment: Assignment::Order5, splitting: 0.2, cutoff: 6.0 };
    let parameters = parameters(&system, &scheme);
    let force = |distance: f64| {
        let discs = [at(64.0, 7.3, 5.9).unwrap(), at(64.0, 7.3 + distance, 5.9).unwrap()];
        Engine::new(&parameters, Clock::START, &discs).unwrap().forces().unwrap()[0][0]
    };
    let jump = force(6.0 - 1e-4) - force(6.0 + 1e-4);
    let near = near_force(6.0, 0.89, 270.0, 0.2);
    assert!((jump / near - 1.0).abs() < 1e-3, "{jump} instead of {near}");
}
