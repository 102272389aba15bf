//! The cheapest scheme for an accuracy.

use super::cost::{Cost, cost};
use super::near_error::NearError;
use super::refusal::{Refusal, Remedy};
use super::search::{Candidates, assignments, cutoffs, grids, rounded_down, rounded_up, splittings};
use super::{Scheme, System, estimate};
use meniscus_core::parameters::{Assignment, SMALLEST_CUTOFF, SPLITTING_RANGE};

/// The estimate of a chosen scheme is at most this times the accuracy asked for, so that the error, which
/// differs from state to state and from its estimate, exceeds the accuracy by little if at all.
pub const SAFETY: f64 = 0.8;

/// Smallest and largest accuracy that it makes sense to ask for: below, binary32 and the quanta of mass show; above, the
/// paper's mesh alone is as good.
pub const ACCURACY_RANGE: (f64, f64) = (1e-5, 1e-2);

/// Schemes that cost at most this times the cheapest are as good, and the simplest of them is taken: the one of
/// lowest order, and of the smallest mesh.
const TIE: f64 = 1.02;
/// Significant decimal digits of an accuracy that a refusal names.
const ACCURACY_DIGITS: i32 = 2;

/// The cut-off taken without attraction, R0: the cells then suit the repulsion as well.
const IDLE_CUTOFF: f64 = 4.0;
/// αh taken without attraction.
const IDLE_SPLITTING_OF_SPACING: f64 = 0.5;

/// What is fixed by hand; the rest is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// Nodes M along a side of the mesh, `mesh.grid`.
    pub grid: Option<usize>,
    /// Mass assignment, `mesh.assignment`.
    pub assignment: Option<Assignment>,
    /// Splitting α, 1/R0, `force.splitting`.
    pub splitting: Option<f64>,
    /// Cut-off r_c, R0, `force.cutoff`.
    pub cutoff: Option<f64>,
}

/// A scheme with its error and cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The scheme.
    pub scheme: Scheme,
    /// Its root mean square force error relative to the reference force, see [`estimate`].
    pub estimate: f64,
    /// Its cost.
    pub cost: Cost,
}

impl Choice {
    fn of(system: &System, scheme: Scheme) -> Self {
        Self { scheme, estimate: estimate(system, &scheme).relative(), cost: cost(system, &scheme) }
    }
}

/// The cheapest scheme with an error of at most `accuracy` × [`SAFETY`] of the reference force, by [`estimate`] and
/// [`cost`].
///
/// Grids are powers of two from 16 to 4096 with a spacing that [`meniscus_core::parameters`] accepts, orders 2 to 7;
/// splitting and cut-off come from ladders of 2 % and have four digits, αh ≤ 0.7 and r_c < L/2. What is given is kept
/// as it is, and only its accuracy checked. Of schemes within 2 % of the least cost the simplest is taken. Without
/// attraction every scheme is exact, and a small one is taken.
///
/// # Errors
/// [`Refusal`] if no scheme with the given parts is that accurate; it says what would be.
pub fn choose(system: &System, accuracy: f64, given: &Given) -> Result<Choice, Refusal> {
    if system.force_scale() == 0.0 {
        return Ok(Choice::of(system, idle(system, given)));
    }
    match cheapest(system, accuracy, given) {
        Some(choice) => Ok(choice),
        None => Err(refusal(system, accuracy, given)),
    }
}

/// The cheapest scheme, if there is any that is accurate enough.
fn cheapest(system: &System, accuracy: f64, given: &Given) -> Option<Choice> {
    if accuracy.is_nan() || accuracy <= 0.0 {
        return None;
    }
    let cutoffs = cutoffs(system, given);
    let mut near = NearError::new(system);
    let mut best = f64::INFINITY;
    let mut found: Vec<Choice> = Vec::new();
    for (grid, assignment) in meshes(system, given, cutoffs[0]) {
        let price = |cutoff: f64| {
            cost(system, &Scheme { grid, assignment, splitting: SPLITTING_RANGE.0, cutoff }).total()
        };
        // What costs more than the best can only lose.
        let affordable = cutoffs.partition_point(|cutoff| price(*cutoff) <= TIE * best);
        let splittings = splittings(system, given, grid);
        let mut candidates = Candidates::new(system, &mut near, grid, assignment, &splittings);
        if let Some(scheme) = candidates.within(accuracy * SAFETY, &cutoffs[..affordable]) {
            let choice = Choice::of(system, scheme);
            best = best.min(choice.cost.total());
            found.push(choice);
        }
    }
    found.retain(|choice| choice.cost.total() <= TIE * best);
    found.into_iter().min_by_key(|choice| (choice.scheme.assignment.order(), choice.scheme.grid))
}

/// Meshes and assignments a choice may take, those first that cost least with the smallest cut-off.
fn meshes(system: &System, given: &Given, cutoff: f64) -> Vec<(usize, Assignment)> {
    let mut meshes: Vec<(f64, usize, Assignment)> = Vec::new();
    for grid in grids(system, given) {
        for assignment in assignments(given) {
            let scheme = Scheme { grid, assignment, splitting: SPLITTING_RANGE.0, cutoff };
            meshes.push((cost(system, &scheme).total(), grid, assignment));
        }
    }
    meshes.sort_by(|a, b| a.0.total_cmp(&b.0));
    meshes.into_iter().map(|(_, grid, assignment)| (grid, assignment)).collect()
}

/// The most accurate scheme with the given parts, whatever it costs.
fn most_accurate(system: &System, given: &Given) -> Choice {
    let cutoffs = cutoffs(system, given);
    let grid = grids(system, given).into_iter().fold(0, usize::max);
    let splittings = splittings(system, given, grid);
    let mut near = NearError::new(system);
    let mut best: Option<(Scheme, f64)> = None;
    for assignment in assignments(given) {
        let (scheme, error) =
            Candidates::new(system, &mut near, grid, assignment, &splittings).least(&cutoffs);
        if best.is_none_or(|(_, least)| error < least) {
            best = Some((scheme, error));
        }
    }
    Choice::of(system, best.map_or_else(|| idle(system, given), |(scheme, _)| scheme))
}

/// The smallest accuracy of two digits that [`choose`] accepts, when `best` is the most accurate there is.
fn reachable(best: &Choice) -> f64 {
    // The margin is for the rounding of the product with `SAFETY`.
    rounded_up(best.estimate / SAFETY * (1.0 + 1e-9), ACCURACY_DIGITS)
}

/// Why `accuracy` is not to be had, and what is.
fn refusal(system: &System, accuracy: f64, given: &Given) -> Refusal {
    let free = Given::default();
    let best = most_accurate(system, given);
    let remedy = cheapest(system, accuracy, &free).map_or_else(
        || {
            let limit = reachable(&most_accurate(system, &free));
            match cheapest(system, limit, &free) {
                Some(choice) if limit <= ACCURACY_RANGE.1 => {
                    Remedy::Accuracy { accuracy: limit, choice: Box::new(choice) }
                }
                _ => Remedy::NoSplit,
            }
        },
        |choice| Remedy::Free(Box::new(choice)),
    );
    Refusal { accuracy, given: *given, reachable: reachable(&best), best: Box::new(best), remedy }
}

/// A small scheme for a system without attraction.
fn idle(system: &System, given: &Given) -> Scheme {
    let grid = grids(system, given)[0];
    let spacing = system.side / grid as f64;
    let splitting = (IDLE_SPLITTING_OF_SPACING / spacing).clamp(SPLITTING_RANGE.0, SPLITTING_RANGE.1);
    let largest = cutoffs(system, given).last().copied().unwrap_or(SMALLEST_CUTOFF);
    Scheme {
        grid,
        assignment: given.assignment.unwrap_or(Assignment::TriangularShapedCloud),
        splitting: given.splitting.unwrap_or_else(|| rounded_down(splitting, 4)),
        cutoff: given.cutoff.unwrap_or(IDLE_CUTOFF.min(largest)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meniscus_core::parameters::{GRID_RANGE, Influence, Method, Parameters};

    const TABLE_1: System = System {
        side: 500.0,
        particles: 2500,
        capillary_strength: 0.89,
        capillary_length: 270.0,
        mean_square_strength: 1.0,
    };

    /// Whether long tests are asked for.
    fn long_tests() -> bool {
        std::env::var_os("MENISCUS_LONG_TESTS").is_some_and(|value| value == "1")
    }

    /// A spread of boxes, densities and capillary lengths; a few of them unless long tests are asked for.
    fn systems() -> Vec<System> {
        if !long_tests() {
            let dense = System { side: 100.0, particles: 1000, ..TABLE_1 };
            return vec![
                System { side: 20.0, particles: 1, ..TABLE_1 },
                System { capillary_length: 1.0, ..dense },
                System { capillary_length: f64::INFINITY, ..dense },
            ];
        }
        let mut systems = Vec::new();
        for (side, particles) in [(20.0, 1), (100.0, 1000), (500.0, 250), (500.0, 2500), (5000.0, 500_000)] {
            for length_of_side in [0.01, 0.1, 0.54, 10.0, f64::INFINITY] {
                let capillary_length = length_of_side * side;
                if capillary_length > 0.9 {
                    systems.push(System { side, particles, capillary_length, ..TABLE_1 });
                }
            }
        }
        systems
    }

    fn is_valid(system: &System, scheme: &Scheme) -> bool {
        let parameters = Parameters {
            side: system.side,
            capillary_strength: system.capillary_strength,
            capillary_length: system.capillary_length,
            method: Method::P3m,
            influence: Influence::Optimal,
            splitting: scheme.splitting,
            cutoff: scheme.cutoff,
            grid: scheme.grid,
            assignment: scheme.assignment,
            ..Parameters::DEFAULT
        };
        parameters.validate() == Ok(())
    }

    #[test]
    fn choices_are_valid_accurate_and_dearer_the_more_accurate() {
        for system in systems() {
            let mut last = 0.0;
            for accuracy in [1e-2, 1e-3, 1e-4, 1e-5] {
                let choice = choose(&system, accuracy, &Given::default())
                    .unwrap_or_else(|refusal| panic!("{system:?}: {refusal}"));
                assert!(is_valid(&system, &choice.scheme), "{system:?}: {choice:?}");
                let found = estimate(&system, &choice.scheme).relative();
                assert!(found <= accuracy * SAFETY * (1.0 + 1e-12), "{system:?}: {choice:?}");
                assert!(choice.cost.total() * TIE >= last, "{system:?}, {accuracy}: {choice:?}");
                last = choice.cost.total();
            }
        }
    }

    #[test]
    fn table_1_gets_the_expected_scheme() {
        let choice = choose(&TABLE_1, 1e-3, &Given::default()).expect("easy");
        assert!([128, 256].contains(&choice.scheme.grid), "{choice:?}");
        assert!((4..=5).contains(&choice.scheme.assignment.order()), "{choice:?}");
        assert!(choice.scheme.cutoff > 7.0 && choice.scheme.cutoff < 20.0, "{choice:?}");
    }

    #[test]
    fn no_scheme_of_a_dense_scan_is_much_cheaper() {
        let choice = choose(&TABLE_1, 1e-3, &Given::default()).expect("easy");
        for grid in [128, 256] {
            for assignment in Assignment::ALL {
                for splitting_of_spacing in (6..=18).map(|step| 0.05 * f64::from(step)) {
                    for step in 0..14 {
                        let scheme = Scheme {
                            grid,
                            assignment,
                            splitting: splitting_of_spacing * grid as f64 / TABLE_1.side,
                            cutoff: 3.0 * libm::exp(0.2 * f64::from(step)),
                        };
                        if cost(&TABLE_1, &scheme).total() < 0.94 * choice.cost.total() {
                            let found = estimate(&TABLE_1, &scheme).relative();
                            assert!(found > 1e-3 * SAFETY, "{scheme:?} is cheaper than {choice:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_given_is_kept() {
        for given in [
            Given { grid: Some(256), ..Given::default() },
            Given { assignment: Some(Assignment::Order7), ..Given::default() },
            Given { splitting: Some(0.15), ..Given::default() },
            Given { cutoff: Some(17.25), ..Given::default() },
            Given { grid: Some(256), splitting: Some(0.17), ..Given::default() },
            Given { grid: Some(256), cutoff: Some(14.0), ..Given::default() },
            Given {
                grid: Some(256),
                assignment: Some(Assignment::Order5),
                splitting: Some(0.24),
                cutoff: Some(13.0),
            },
        ] {
            let choice = choose(&TABLE_1, 1e-3, &given).unwrap_or_else(|refusal| panic!("{refusal}"));
            let scheme = choice.scheme;
            assert!(given.grid.is_none_or(|grid| grid == scheme.grid), "{choice:?}");
            assert!(given.assignment.is_none_or(|assignment| assignment == scheme.assignment), "{choice:?}");
            assert!(given.splitting.is_none_or(|splitting| splitting == scheme.splitting), "{choice:?}");
            assert!(given.cutoff.is_none_or(|cutoff| cutoff == scheme.cutoff), "{choice:?}");
            assert!(is_valid(&TABLE_1, &scheme), "{choice:?}");
            assert!(choice.estimate <= 1e-3 * SAFETY, "{choice:?}");
        }
    }

    #[test]
    fn remedies_of_refusals_are_accepted() {
        let strong = System { side: 60.0, particles: 36, ..TABLE_1 };
        let weak = System { capillary_strength: 1e-5, ..strong };
        let free = Given::default();
        let all = Given {
            grid: Some(16),
            assignment: Some(Assignment::Order4),
            splitting: Some(0.2),
            cutoff: Some(8.0),
        };
        for (system, accuracy, given) in [
            (strong, 1e-4, all),
            (weak, 1e-4, free),
            (strong, 1e-5, Given { cutoff: Some(1.5), ..free }),
            (strong, 1e-3, Given { grid: Some(16), cutoff: Some(6.0), ..free }),
            (strong, 1e-4, Given { assignment: Some(Assignment::CloudInCell), cutoff: Some(2.0), ..free }),
            (strong, 1e-7, Given { grid: Some(64), splitting: Some(0.4), ..free }),
        ]
        .into_iter()
        .take(if long_tests() { usize::MAX } else { 2 })
        {
            let refusal = choose(&system, accuracy, &given).expect_err("out of reach");
            println!("{refusal}");
            assert!(refusal.best.estimate > accuracy * SAFETY, "{refusal:?}");
            let again = choose(&system, refusal.reachable, &given).expect("the accuracy named");
            assert!(again.cost.total() <= refusal.best.cost.total(), "{again:?} {refusal:?}");
            assert!(choose(&system, 0.9 * refusal.reachable, &given).is_err(), "{refusal:?}");
            match refusal.remedy {
                Remedy::Free(choice) => {
                    assert_eq!(choose(&system, accuracy, &Given::default()), Ok(*choice));
                }
                Remedy::Accuracy { accuracy, choice } => {
                    assert_eq!(choose(&system, accuracy, &Given::default()), Ok(*choice));
                }
                Remedy::NoSplit => panic!("{refusal}"),
            }
        }
    }

    #[test]
    fn a_force_below_its_quantum_is_refused() {
        let system = System { capillary_length: 0.05, ..TABLE_1 };
        let refusal = choose(&system, 1e-2, &Given::default()).expect_err("out of reach");
        assert_eq!(refusal.remedy, Remedy::NoSplit);
    }

    #[test]
    fn without_attraction_a_small_scheme_is_taken() {
        for system in [
            System { capillary_strength: 0.0, ..TABLE_1 },
            System { mean_square_strength: 0.0, ..TABLE_1 },
            System { capillary_strength: 0.0, side: 4.6, ..TABLE_1 },
        ] {
            let choice = choose(&system, 1e-5, &Given::default()).expect("exact");
            assert_eq!(choice.estimate, 0.0);
            assert!(is_valid(&system, &choice.scheme), "{choice:?}");
        }
    }

    #[test]
    fn nonsense_is_refused_and_does_not_panic() {
        // A small box has few meshes to try.
        let system = System { side: 8.0, particles: 3, ..TABLE_1 };
        let free = Given::default();
        for value in [0.0, f64::NAN, f64::INFINITY] {
            for given in [
                Given { splitting: Some(value), ..free },
                Given { cutoff: Some(value), ..free },
                Given { grid: Some(value as usize), ..free },
            ] {
                let _ = choose(&system, 1e-3, &given);
            }
            for system in [
                System { side: value, ..system },
                System { capillary_length: value, ..system },
                System { capillary_strength: value, ..system },
            ] {
                let _ = choose(&system, 1e-3, &Given { grid: Some(16), ..free });
            }
        }
        for accuracy in [0.0, -1.0, f64::NAN] {
            assert!(choose(&system, accuracy, &free).is_err());
        }
        let largest = Given { splitting: Some(1.0), grid: Some(GRID_RANGE.1), ..Given::default() };
        let _ = choose(&System { side: 65_536.0, ..TABLE_1 }, 1e-3, &largest);
    }
}
