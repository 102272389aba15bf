//! What is refused at the start: every parameter error and every way a run cannot be set up.

use meniscus_core::dynamics::{Clock, Disc, Dynamics, InitError};
use meniscus_core::engine::Engine;
use meniscus_core::grid::Grid;
use meniscus_core::parameters::{LARGEST_SEED, ParameterError, Parameters};
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::torus::Position;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::states::{scattered, with_ids};

/// 2⁻⁴⁰
const SMALLEST: f64 = 1.0 / 1_099_511_627_776.0;

/// Changes the default parameters.
type Change = fn(&mut Parameters);

fn changed(change: Change) -> Parameters {
    let mut parameters = Parameters::default();
    change(&mut parameters);
    parameters
}

#[test]
fn every_number_out_of_range_is_refused() {
    let cases: [(ParameterError, &[Change]); 11] = [
        (ParameterError::Side, &[|p| p.side = 0.0, |p| p.side = -0.0, |p| p.side = -64.0]),
        (ParameterError::SideTooLarge, &[|p| p.side = 65536.0_f64.next_up(), |p| p.side = f64::MAX]),
        (
            ParameterError::SideTooSmall,
            &[|p| p.side = 2.0 * CUTOFF, |p| p.side = 1.0, |p| p.side = f64::MIN_POSITIVE],
        ),
        (
            ParameterError::CapillaryStrength,
            &[|p| p.capillary_strength = -f64::MIN_POSITIVE, |p| p.capillary_strength = 1000.0_f64.next_up()],
        ),
        (
            ParameterError::CapillaryLength,
            &[
                |p| p.capillary_length = 0.01_f64.next_down(),
                |p| p.capillary_length = 0.0,
                |p| p.capillary_length = -270.0,
            ],
        ),
        (
            ParameterError::Grid,
            &[
                |p| p.grid = 0,
                |p| p.grid = 1,
                |p| p.grid = 8,
                |p| p.grid = 15,
                |p| p.grid = 63,
                |p| p.grid = 96,
                |p| p.grid = 8192,
                |p| p.grid = usize::MAX,
                |p| p.grid = 1 << (usize::BITS - 1),
            ],
        ),
        (
            ParameterError::GridTooCoarse,
            &[
                |p| p.side = 1024.0_f64.next_up(),
                |p| {
                    p.grid = 2048;
                    p.side = 65536.0;
                },
            ],
        ),
        (
            ParameterError::GridTooFine,
            &[
                |p| p.side = 8.0_f64.next_down(),
                |p| {
                    p.grid = 4096;
                    p.side = 500.0;
                },
            ],
        ),
        (
            ParameterError::MaxStep,
            &[
                |p| p.max_step = 0.0,
                |p| p.max_step = -0.001,
                |p| p.max_step = SMALLEST.next_down(),
                |p| p.max_step = 1.0_f64.next_up(),
            ],
        ),
        (
            ParameterError::MaxDisplacement,
            &[
                |p| p.max_displacement = 0.0,
                |p| p.max_displacement = -0.25,
                |p| p.max_displacement = SMALLEST.next_down(),
                |p| p.max_displacement = 0.5_f64.next_up(),
            ],
        ),
        (ParameterError::Seed, &[|p| p.seed = 1 << 63, |p| p.seed = u64::MAX]),
    ];
    for (error, changes) in cases {
        for &change in changes {
            let parameters = changed(change);
            assert_eq!(parameters.validate(), Err(error), "{parameters:?}");
            let mut engine = Box::new(Engine::<64, 4>::new());
            let refused = engine.init(&parameters, with_ids(&scattered(1, 4)));
            assert_eq!(refused, Err(InitError::Parameters(error)), "{parameters:?}");
        }
    }
}

#[test]
fn a_grid_is_a_power_of_two_from_16_to_4096() {
    let grids: Vec<Grid> = (0..10_000).filter_map(Grid::new).collect();
    let nodes: Vec<usize> = grids.iter().map(|grid| grid.nodes()).collect();
    assert_eq!(nodes, [16, 32, 64, 128, 256, 512, 1024, 2048, 4096]);
    assert!(grids.iter().all(|grid| 1 << grid.exponent() == grid.nodes()));
    assert!(grids.iter().all(|grid| grid.wrap(grid.nodes() + 3) == 3 && grid.wrap(grid.nodes() - 1) != 0));
}

/// Sets one of the numbers of [`Parameters`].
type Field = fn(&mut Parameters) -> &mut f64;

const FIELDS: [(Field, ParameterError); 5] = [
    (|p| &mut p.side, ParameterError::Side),
    (|p| &mut p.capillary_strength, ParameterError::CapillaryStrength),
    (|p| &mut p.capillary_length, ParameterError::CapillaryLength),
    (|p| &mut p.max_step, ParameterError::MaxStep),
    (|p| &mut p.max_displacement, ParameterError::MaxDisplacement),
];

#[test]
fn what_is_not_a_number_is_refused_everywhere() {
    for (field, error) in FIELDS {
        for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut parameters = Parameters::default();
            *field(&mut parameters) = value;
            let allowed = error == ParameterError::CapillaryLength && value == f64::INFINITY;
            assert_eq!(parameters.validate(), if allowed { Ok(()) } else { Err(error) }, "{parameters:?}");
        }
    }
}

#[test]
fn the_ends_of_every_range_are_accepted() {
    let changes: [Change; 14] = [
        |p| p.side = 65536.0 / 64.0,
        |p| {
            p.grid = 4096;
            p.side = 65536.0;
        },
        |p| {
            p.grid = 16;
            p.side = (2.0 * CUTOFF).next_up();
        },
        |p| p.side = 8.0,
        |p| p.capillary_strength = 0.0,
        |p| p.capillary_strength = -0.0,
        |p| p.capillary_strength = 1000.0,
        |p| p.capillary_length = 0.01,
        |p| p.capillary_length = f64::INFINITY,
        |p| p.max_step = SMALLEST,
        |p| p.max_step = 1.0,
        |p| p.max_displacement = SMALLEST,
        |p| p.max_displacement = 0.5,
        |p| p.seed = LARGEST_SEED,
    ];
    for change in changes {
        let parameters = changed(change);
        assert_eq!(parameters.validate(), Ok(()), "{parameters:?}");
    }
}

#[test]
fn the_first_error_in_the_order_of_the_fields_is_told() {
    let mut parameters = Parameters { grid: 0, seed: u64::MAX, max_step: f64::NAN, ..Parameters::default() };
    assert_eq!(parameters.validate(), Err(ParameterError::Grid));
    parameters.grid = 64;
    assert_eq!(parameters.validate(), Err(ParameterError::MaxStep));
    parameters.max_step = 0.001;
    assert_eq!(parameters.validate(), Err(ParameterError::Seed));
}

const PLACE: Position = Position::from_bits(1, 2);

#[test]
fn a_mesh_other_than_the_engines_is_refused() {
    let mut engine = Box::new(Engine::<32, 4>::new());
    let refused = engine.init(&Parameters::default(), [(0, PLACE)]);
    assert_eq!(refused, Err(InitError::GridMismatch));
}

#[test]
fn no_disc_is_refused() {
    const NOBODY: [Disc; 0] = [];
    let mut engine = Box::new(Engine::<64, 4>::new());
    assert_eq!(engine.init(&Parameters::default(), NOBODY), Err(InitError::NoParticles));
}

#[test]
fn more_discs_than_fit_are_refused() {
    let mut engine = Box::new(Engine::<64, 4>::new());
    let refused = engine.init(&Parameters::default(), with_ids(&scattered(1, 5)));
    assert_eq!(refused, Err(InitError::TooManyParticles { capacity: 4 }));
    assert_eq!(engine.init(&Parameters::default(), with_ids(&scattered(1, 4))), Ok(()));
    let mut none = Box::new(Engine::<64, 0>::new());
    let refused = none.init(&Parameters::default(), [(0, PLACE)]);
    assert_eq!(refused, Err(InitError::TooManyParticles { capacity: 0 }));
}

#[test]
fn no_memory_holds_more_discs_than_the_sum_of_forces_allows() {
    let largest = 1 << 19;
    let mut arrays = Arrays::new(16, 1, largest + 1);
    let parameters = Parameters { grid: 16, ..Parameters::default() };
    let discs = |count: usize| (0..count as u32).map(|id| (id, Position::from_bits(id << 12, id)));
    let refused = Dynamics::new(&parameters, Clock::START, discs(largest + 1), &mut arrays.memory());
    assert_eq!(refused.err(), Some(InitError::TooManyParticles { capacity: largest }));
    let accepted = Dynamics::new(&parameters, Clock::START, discs(largest), &mut arrays.memory());
    assert_eq!(accepted.map(|dynamics| dynamics.count()).ok(), Some(largest));
}

#[test]
fn ids_that_are_no_permutation_are_refused() {
    let mut engine = Box::new(Engine::<64, 4>::new());
    let cases: [(&[u32], u32); 6] = [
        (&[1], 1),
        (&[0, 0], 0),
        (&[0, 1, 1], 1),
        (&[0, 1, 3], 3),
        (&[2, 1, 2], 2),
        (&[0, 1, 2, u32::MAX], u32::MAX),
    ];
    for (ids, id) in cases {
        let refused = engine.init(&Parameters::default(), ids.iter().map(|&id| (id, PLACE)));
        assert_eq!(refused, Err(InitError::Id { id }), "{ids:?}");
    }
    let accepted = engine.init(&Parameters::default(), [3, 1, 0, 2].map(|id| (id, PLACE)));
    assert_eq!(accepted, Ok(()));
}

#[test]
fn arrays_that_do_not_fit_the_mesh_are_refused() {
    let parameters = Parameters { grid: 16, ..Parameters::default() };
    let changes: [fn(&mut Arrays); 7] = [
        |arrays| arrays.nodes.truncate(255),
        |arrays| arrays.nodes.push(0),
        |arrays| arrays.field.truncate(255),
        |arrays| arrays.field.push(meniscus_core::transform::Complex32::new(0.0, 0.0)),
        |arrays| arrays.lines.truncate(31),
        |arrays| arrays.influence.truncate(80),
        |arrays| arrays.gradient.truncate(15),
    ];
    for (case, change) in changes.into_iter().enumerate() {
        let mut arrays = Arrays::new(16, 1, 4);
        change(&mut arrays);
        let refused = Dynamics::new(&parameters, Clock::START, [(0, PLACE)], &mut arrays.memory());
        assert_eq!(refused.err(), Some(InitError::Memory), "case {case}");
    }
    let mut arrays = Arrays::new(16, 1, 4);
    assert!(Dynamics::new(&parameters, Clock::START, [(0, PLACE)], &mut arrays.memory()).is_ok());
}

#[test]
fn the_shortest_array_limits_the_number_of_discs() {
    let parameters = Parameters { grid: 16, ..Parameters::default() };
    let changes: [fn(&mut Arrays); 11] = [
        |arrays| arrays.ids.truncate(3),
        |arrays| arrays.slots.truncate(3),
        |arrays| arrays.x.truncate(3),
        |arrays| arrays.y.truncate(3),
        |arrays| arrays.crossings_x.truncate(3),
        |arrays| arrays.crossings_y.truncate(3),
        |arrays| arrays.force_x.truncate(3),
        |arrays| arrays.force_y.truncate(3),
        |arrays| arrays.displacement_x.truncate(3),
        |arrays| arrays.displacement_y.truncate(3),
        |arrays| arrays.next.truncate(3),
    ];
    for (case, change) in changes.into_iter().enumerate() {
        let mut arrays = Arrays::new(16, 1, 4);
        change(&mut arrays);
        let discs = with_ids(&scattered(1, 4));
        let refused = Dynamics::new(&parameters, Clock::START, discs, &mut arrays.memory());
        assert_eq!(refused.err(), Some(InitError::TooManyParticles { capacity: 3 }), "case {case}");
    }
}
