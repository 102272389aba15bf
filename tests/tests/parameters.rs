//! What is refused at the start: every parameter error and every way a run cannot be set up.

use meniscus_core::dynamics::{Clock, Disc, Dynamics, ForceError, InitError};
use meniscus_core::engine::Engine;
use meniscus_core::grid::Grid;
use meniscus_core::near_part::table_length;
use meniscus_core::parameters::{
    Assignment, Gradient, Influence, LARGEST_SEED, Method, ParameterError, Parameters,
};
use meniscus_core::repulsion::CUTOFF;
use meniscus_core::stages::Scalar;
use meniscus_core::torus::Position;
use meniscus_core::transform::AnySize;
use meniscus_tests::arrays::Arrays;
use meniscus_tests::schemes;
use meniscus_tests::states::{scattered, with_ids};

/// 2⁻⁴⁰
const SMALLEST: f64 = 1.0 / 1_099_511_627_776.0;

/// 1 − 2⁻³¹: a length less than half a box by one unit of position, over half the box.
const JUST_BELOW_ONE: f64 = 1.0 - 1.0 / 2_147_483_648.0;

/// Changes the parameters of the paper.
type Change = fn(&mut Parameters);

fn changed(change: Change) -> Parameters {
    let mut parameters = Parameters::PAPER;
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

/// The split force in a box of 64 R0.
const SPLIT: Parameters = Parameters {
    method: Method::P3m,
    influence: Influence::Optimal,
    splitting: 0.5,
    cutoff: 6.0,
    assignment: Assignment::Order4,
    ..Parameters::PAPER
};

#[test]
fn what_does_not_fit_the_split_force_is_refused() {
    let cases: [(ParameterError, &[Change]); 6] = [
        (
            ParameterError::Splitting,
            &[
                |p| p.splitting = 0.0,
                |p| p.splitting = -0.5,
                |p| p.splitting = 1e-5_f64.next_down(),
                |p| p.splitting = 8.0_f64.next_up(),
                |p| p.splitting = f64::INFINITY,
                |p| p.splitting = f64::NAN,
            ],
        ),
        (
            ParameterError::SplittingTooLarge,
            &[|p| p.splitting = 0.7_f64.next_up(), |p| p.splitting = 8.0, |p| p.grid = 32],
        ),
        (
            ParameterError::Cutoff,
            &[
                |p| p.cutoff = 1.0_f64.next_down(),
                |p| p.cutoff = 0.0,
                |p| p.cutoff = -6.0,
                |p| p.cutoff = f64::NEG_INFINITY,
                |p| p.cutoff = f64::NAN,
            ],
        ),
        (
            ParameterError::CutoffTooLarge,
            &[
                |p| p.cutoff = 32.0,
                |p| p.cutoff = (JUST_BELOW_ONE * 32.0).next_up(),
                |p| p.cutoff = f64::INFINITY,
                |p| {
                    p.side = 12.0;
                    p.cutoff = 6.0;
                },
            ],
        ),
        (
            ParameterError::Influence,
            &[
                |p| p.influence = Influence::Paper,
                |p| p.influence = Influence::Continuum,
                |p| p.method = Method::ParticleMesh,
            ],
        ),
        (
            ParameterError::Gradient,
            &[|p| p.gradient = Gradient::Difference2, |p| p.gradient = Gradient::Difference4],
        ),
    ];
    assert_eq!(SPLIT.validate(), Ok(()));
    for (error, changes) in cases {
        for &change in changes {
            let mut parameters = SPLIT;
            change(&mut parameters);
            assert_eq!(parameters.validate(), Err(error), "{parameters:?}");
        }
    }
}

#[test]
fn the_ends_of_every_range_of_the_split_force_are_accepted() {
    let changes: [Change; 8] = [
        |p| p.splitting = 1e-5,
        |p| p.splitting = 0.7,
        |p| {
            // The finest mesh.
            p.side = 8.0;
            p.splitting = 5.6;
            p.cutoff = JUST_BELOW_ONE * 4.0;
        },
        |p| p.cutoff = 1.0,
        |p| p.cutoff = JUST_BELOW_ONE * 32.0,
        |p| p.capillary_length = f64::INFINITY,
        |p| p.capillary_length = 0.01,
        |p| p.capillary_strength = 0.0,
    ];
    for change in changes {
        for assignment in Assignment::ALL {
            let mut parameters = Parameters { assignment, ..SPLIT };
            change(&mut parameters);
            assert_eq!(parameters.validate(), Ok(()), "{parameters:?}");
        }
    }
}

#[test]
fn the_mesh_alone_does_not_look_at_splitting_and_cut_off() {
    for value in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e9] {
        let parameters = Parameters { splitting: value, cutoff: value, ..Parameters::PAPER };
        assert_eq!(parameters.validate(), Ok(()));
        let mut engine = Box::new(Engine::<64, 4>::new());
        assert_eq!(engine.init(&parameters, with_ids(&scattered(1, 4))), Ok(()));
        assert!(engine.step().is_ok());
    }
}

#[test]
fn external_fields_out_of_range_are_refused_with_either_method() {
    let refused: [Change; 12] = [
        |p| p.fields.uniform_force = [f64::NAN, 0.0],
        |p| p.fields.uniform_force = [0.0, f64::INFINITY],
        |p| p.fields.uniform_force = [1e8_f64.next_up(), 0.0],
        |p| p.fields.uniform_force = [0.0, -1e8_f64.next_up()],
        |p| p.fields.trap_stiffness = f64::NAN,
        |p| p.fields.trap_stiffness = -f64::MIN_POSITIVE,
        |p| p.fields.trap_stiffness = f64::INFINITY,
        // 32 R0 from its centre, 10⁸ kBT/R0 and a little more; 10⁸ of the two together.
        |p| p.fields.trap_stiffness = 3.125e6_f64.next_up(),
        |p| {
            p.fields.trap_stiffness = 3.125e6;
            p.fields.uniform_force = [0.0, 0.001];
        },
        |p| {
            p.fields.trap_stiffness = 1.0;
            p.fields.trap_center = [-f64::MIN_POSITIVE, 0.0];
        },
        |p| {
            p.fields.trap_stiffness = 1.0;
            p.fields.trap_center = [0.0, 64.0_f64.next_up()];
        },
        |p| {
            p.fields.trap_stiffness = 1.0;
            p.fields.trap_center = [f64::NAN, 0.0];
        },
    ];
    let accepted: [Change; 6] = [
        // No trap, wherever it is.
        |p| p.fields.trap_center = [65.0, f64::NAN],
        |p| p.fields.uniform_force = [1e8, -1e8],
        |p| p.fields.trap_stiffness = 3.125e6,
        |p| p.fields.trap_stiffness = -0.0,
        |p| {
            p.fields.trap_stiffness = 1.0;
            p.fields.trap_center = [0.0, 64.0];
        },
        |p| {
            p.fields.trap_stiffness = 1.5625e6;
            p.fields.uniform_force = [5e7, -5e7];
        },
    ];
    for method in [Parameters::PAPER, SPLIT] {
        for change in refused {
            let mut parameters = method;
            change(&mut parameters);
            assert_eq!(parameters.validate(), Err(ParameterError::Fields), "{parameters:?}");
        }
        for change in accepted {
            let mut parameters = method;
            change(&mut parameters);
            assert_eq!(parameters.validate(), Ok(()), "{parameters:?}");
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
            let mut parameters = Parameters::PAPER;
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
    let mut parameters = Parameters { grid: 0, seed: u64::MAX, max_step: f64::NAN, ..Parameters::PAPER };
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
    let refused = engine.init(&Parameters::PAPER, [(0, PLACE)]);
    assert_eq!(refused, Err(InitError::GridMismatch));
}

#[test]
fn no_disc_is_refused() {
    const NOBODY: [Disc; 0] = [];
    let mut engine = Box::new(Engine::<64, 4>::new());
    assert_eq!(engine.init(&Parameters::PAPER, NOBODY), Err(InitError::NoParticles));
}

#[test]
fn more_discs_than_fit_are_refused() {
    let mut engine = Box::new(Engine::<64, 4>::new());
    let refused = engine.init(&Parameters::PAPER, with_ids(&scattered(1, 5)));
    assert_eq!(refused, Err(InitError::TooManyParticles { capacity: 4 }));
    assert_eq!(engine.init(&Parameters::PAPER, with_ids(&scattered(1, 4))), Ok(()));
    let mut none = Box::new(Engine::<64, 0>::new());
    let refused = none.init(&Parameters::PAPER, [(0, PLACE)]);
    assert_eq!(refused, Err(InitError::TooManyParticles { capacity: 0 }));
}

#[test]
fn no_memory_holds_more_discs_than_the_sum_of_forces_allows() {
    let largest = 1 << 22;
    let mut arrays = Arrays::new(16, 1, largest + 1);
    let parameters = Parameters { grid: 16, ..Parameters::PAPER };
    let discs = |count: usize| (0..count as u32).map(|id| (id, Position::from_bits(id << 10, id)));
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
        let refused = engine.init(&Parameters::PAPER, ids.iter().map(|&id| (id, PLACE)));
        assert_eq!(refused, Err(InitError::Id { id }), "{ids:?}");
    }
    let accepted = engine.init(&Parameters::PAPER, [3, 1, 0, 2].map(|id| (id, PLACE)));
    assert_eq!(accepted, Ok(()));
}

#[test]
fn arrays_that_do_not_fit_the_mesh_are_refused() {
    let parameters = Parameters { grid: 16, ..Parameters::PAPER };
    let start =
        |arrays: &mut Arrays| Dynamics::new(&parameters, Clock::START, [(0, PLACE)], &mut arrays.memory());
    let tables: [fn(&mut Arrays); 2] =
        [|arrays| arrays.influence.truncate(80), |arrays| arrays.gradient.truncate(15)];
    for (case, change) in tables.into_iter().enumerate() {
        let mut arrays = Arrays::new(16, 1, 4);
        change(&mut arrays);
        assert_eq!(start(&mut arrays).err(), Some(InitError::Memory), "case {case}");
    }
    // What the stages work in is theirs to check.
    let working: [fn(&mut Arrays); 5] = [
        |arrays| arrays.nodes.truncate(255),
        |arrays| arrays.nodes.push(0),
        |arrays| arrays.field.truncate(255),
        |arrays| arrays.field.push(meniscus_core::transform::Complex32::new(0.0, 0.0)),
        |arrays| arrays.lines.truncate(31),
    ];
    for (case, change) in working.into_iter().enumerate() {
        let mut arrays = Arrays::new(16, 1, 4);
        change(&mut arrays);
        let dynamics = start(&mut arrays).unwrap();
        let refused = dynamics.forces(&mut Scalar(AnySize), &mut arrays.memory());
        assert_eq!(refused, Err(ForceError::Memory), "case {case}");
    }
    assert!(start(&mut Arrays::new(16, 1, 4)).is_ok());
}

#[test]
fn a_table_too_short_for_the_cut_off_is_refused() {
    let parameters = Parameters { grid: 16, side: 16.0, ..SPLIT };
    let mut arrays = Arrays::new(16, 1, 4);
    arrays.near.truncate(table_length(6.0) - 1);
    let refused = Dynamics::new(&parameters, Clock::START, [(0, PLACE)], &mut arrays.memory());
    assert_eq!(refused.err(), Some(InitError::Memory));
    arrays.near.resize(table_length(6.0), [0.0; 4]);
    assert!(Dynamics::new(&parameters, Clock::START, [(0, PLACE)], &mut arrays.memory()).is_ok());
    // Neither the mesh alone nor discs without attraction need one.
    arrays.near.clear();
    for needless in [
        Parameters { capillary_strength: 0.0, ..parameters },
        Parameters { grid: 16, side: 16.0, ..Parameters::PAPER },
    ] {
        assert!(Dynamics::new(&needless, Clock::START, [(0, PLACE)], &mut arrays.memory()).is_ok());
    }
}

#[test]
fn the_shortest_array_limits_the_number_of_discs() {
    let parameters = Parameters { grid: 16, ..Parameters::PAPER };
    let changes: [fn(&mut Arrays); 12] = [
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
        |arrays| arrays.strengths.truncate(3),
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

#[test]
fn every_mesh_has_a_split_force() {
    for grid in [16, 64, 4096] {
        for spacing in [0.281, 1.0, 15.9] {
            let plain = Parameters { side: grid as f64 * spacing, grid, ..Parameters::PAPER };
            let split = plain.with_p3m();
            assert_eq!(split.validate(), Ok(()), "{split:?}");
            // Physics is tested with these numbers.
            assert_eq!(split, schemes::SPLIT.of(plain));
        }
    }
    let finest = Parameters { side: 16.0, grid: 128, ..Parameters::PAPER };
    assert_eq!(finest.with_p3m().validate(), Ok(()));
}
