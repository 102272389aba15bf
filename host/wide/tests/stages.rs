//! Steps of the wide stages against those of the core: the same state after every step, at every width of lanes and in
//! any number of pieces.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_core::dynamics::{Disc, ForceError, StepError};
use meniscus_core::engine::Engine;
use meniscus_core::fields::Fields;
use meniscus_core::near_part::LARGEST_TABLE;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::torus::Position;
use meniscus_wide::division::Division;
use meniscus_wide::lanes::Level;
use meniscus_wide::stages::Wide;

type SmallEngine = Engine<64, 300>;
type HoldingEngine = Engine<64, 300, LARGEST_TABLE, 300>;

/// Numbers of pieces and steps: all of them in a release build on x86-64, or if the long tests are asked for.
fn extent() -> (&'static [usize], usize) {
    let is_long = cfg!(all(target_arch = "x86_64", not(debug_assertions)))
        || std::env::var_os("MENISCUS_LONG_TESTS").is_some_and(|value| value == "1");
    if is_long { (&[1, 2, 3, 4, 7, 16], 20) } else { (&[1, 3], 4) }
}

/// Discs at random, some of them in a cluster across the seams, ids from the last to the first.
fn discs(count: usize, strengths: &[i32]) -> Vec<Disc> {
    let key = StepKey::new(7, Purpose::Start, 0);
    let position = |id: u64| {
        let bits = key.bits(id);
        let (x, y) = ((bits >> 32) as u32, bits as u32);
        if id.is_multiple_of(3) {
            Position::from_bits((x >> 3).wrapping_sub(1 << 28), (y >> 3).wrapping_sub(1 << 28))
        } else {
            Position::from_bits(x, y)
        }
    };
    let disc = |id: usize| Disc {
        id: id as u32,
        position: position(id as u64),
        strength: strengths[id % strengths.len()],
    };
    (0..count).rev().map(disc).collect()
}

fn cases() -> Vec<(Parameters, Vec<Disc>)> {
    let one = [1 << 20];
    let mixed = [1 << 20, -(1 << 19), 0, 3 << 19];
    let paper = Parameters::PAPER;
    let split = paper.with_p3m();
    let fields = Fields { uniform_force: [1.0, -2.0], trap_stiffness: 0.01, trap_center: [20.0, 30.0] };
    vec![
        (paper, discs(250, &one)),
        (split, discs(300, &one)),
        (split, discs(1, &one)),
        (split, discs(17, &mixed)),
        (Parameters { noise: Noise::Gaussian, ..split }, discs(299, &mixed)),
        (
            Parameters { assignment: Assignment::CloudInCell, noise: Noise::None, fields, ..paper },
            discs(100, &mixed),
        ),
        (Parameters { repulsion: false, capillary_strength: 5.0, ..split }, discs(200, &one)),
        (Parameters { capillary_strength: 0.0, ..paper }, discs(200, &one)),
        (Parameters { cutoff: 31.9, assignment: Assignment::Order7, ..split }, discs(150, &one)),
    ]
}

#[test]
fn a_heap_of_discs_takes_no_memory_for_lists_until_it_drifts_apart() {
    const COUNT: u32 = 2400;
    let (all_pieces, steps) = extent();
    let parameters = Parameters::PAPER;
    // In one column of cells, near the next.
    let place = |id: u32| (id, Position::from_bits((5 << 25) + id % 3, (1 << 30) + id % 2));
    let mut expected = Box::new(Engine::<64, { COUNT as usize }>::new());
    expected.init(&parameters, (0..COUNT).map(place)).unwrap();
    let steps: Vec<_> =
        (0..steps / 2).map(|_| (expected.step().unwrap(), expected.state().digest())).collect();
    for &pieces in all_pieces.iter().rev().step_by(2) {
        let mut engine = Box::new(Engine::<64, { COUNT as usize }>::new());
        engine.init(&parameters, (0..COUNT).map(place)).unwrap();
        let mut wide = Wide::with(&parameters, Level::best(), Division { mesh: pieces, discs: pieces });
        let mut were_heaps = Vec::new();
        for (number, expected) in steps.iter().enumerate() {
            let (dynamics, mut memory) = engine.parts();
            let step = in_threads(pieces, || dynamics.step(&mut wide, &mut memory)).unwrap();
            assert_eq!((step, engine.state().digest()), *expected, "{pieces} pieces, step {number}");
            were_heaps.push(wide.is_heap());
        }
        assert!(were_heaps[0] && !were_heaps[1..].contains(&true), "{were_heaps:?}, {pieces} pieces");
    }
}

/// Does something in so many threads; where there are none, in this one.
fn in_threads<R: Send>(count: usize, task: impl FnOnce() -> R + Send) -> R {
    if cfg!(target_family = "wasm") {
        return task();
    }
    rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(task)
}

#[test]
fn every_state_is_the_cores() {
    let (all_pieces, steps) = extent();
    for (number, (parameters, discs)) in cases().into_iter().enumerate() {
        let mut expected = Box::new(SmallEngine::new());
        let mut digests = Vec::new();
        expected.init(&parameters, discs.iter().copied()).unwrap();
        for _ in 0..steps {
            expected.step().unwrap();
            digests.push(expected.state().digest());
        }
        for level in Level::available() {
            for &pieces in all_pieces {
                let division = Division { mesh: pieces, discs: pieces };
                let mut wide = Wide::with(&parameters, level, division);
                let mut engine = Box::new(SmallEngine::new());
                engine.init(&parameters, discs.iter().copied()).unwrap();
                for (step, digest) in digests.iter().enumerate() {
                    let (dynamics, mut memory) = engine.parts();
                    in_threads(pieces, || dynamics.step(&mut wide, &mut memory)).unwrap();
                    let found = engine.state().digest();
                    assert_eq!(
                        found,
                        *digest,
                        "case {number}, {}, {pieces} pieces, step {step}",
                        level.name()
                    );
                }
                for disc in 0..discs.len() as u32 {
                    assert_eq!(engine.crossings(disc), expected.crossings(disc));
                    assert_eq!(engine.force(disc), expected.force(disc));
                }
            }
        }
    }
}

#[test]
fn held_mesh_forces_are_the_cores() {
    let (all_pieces, _) = extent();
    let split = Parameters::PAPER.with_p3m();
    let mixed = [1 << 20, -(1 << 19), 0, 3 << 19];
    let cases = [
        (Parameters { mesh_refresh: 0.7, ..split }, discs(300, &[1 << 20])),
        (Parameters { mesh_refresh: 1.0, ..Parameters::PAPER }, discs(250, &mixed)),
    ];
    for (number, (parameters, discs)) in cases.into_iter().enumerate() {
        let mut expected = Box::new(HoldingEngine::new());
        expected.init(&parameters, discs.iter().copied()).unwrap();
        let steps: Vec<_> = (0..12).map(|_| (expected.step().unwrap(), expected.state().digest())).collect();
        let refreshed = steps.iter().filter(|(step, _)| step.refreshed).count();
        assert!(refreshed > 1 && refreshed < steps.len(), "case {number}: {refreshed} times");
        for level in Level::available() {
            for &pieces in all_pieces {
                let mut wide = Wide::with(&parameters, level, Division { mesh: pieces, discs: pieces });
                let mut engine = Box::new(HoldingEngine::new());
                engine.init(&parameters, discs.iter().copied()).unwrap();
                let mut reordered = 0;
                for (count, expected) in steps.iter().enumerate() {
                    let (dynamics, mut memory) = engine.parts();
                    let order = memory.ids.to_vec();
                    let step = in_threads(pieces, || dynamics.step(&mut wide, &mut memory)).unwrap();
                    reordered += u32::from(!step.refreshed && order != memory.ids);
                    let found = (step, engine.state().digest());
                    let name = level.name();
                    assert_eq!(found, *expected, "case {number}, {name}, {pieces} pieces, step {count}");
                }
                for disc in 0..discs.len() as u32 {
                    assert_eq!(engine.held(disc), expected.held(disc));
                }
                assert!(reordered > 0, "case {number}: never stored in another order while forces were held");
            }
        }
    }
}

/// Whether stages for `parameters` do the steps of a run of `others`; if not, that they leave it alone.
fn fit<const M: usize>(parameters: &Parameters, others: &Parameters) -> bool {
    let mut engine = Box::new(Engine::<M, 300>::new());
    engine.init(others, discs(300, &[1 << 20])).unwrap();
    let before = engine.state().digest();
    let mut wide = Wide::with(parameters, Level::best(), Division { mesh: 1, discs: 1 });
    let (dynamics, mut memory) = engine.parts();
    match dynamics.step(&mut wide, &mut memory) {
        Ok(_) => true,
        Err(error) => {
            assert_eq!(error, StepError::Memory);
            assert_eq!(dynamics.forces(&mut wide, &mut memory), Err(ForceError::Memory));
            assert_eq!(engine.state().digest(), before);
            false
        }
    }
}

#[test]
fn stages_of_other_parameters_are_refused() {
    let paper = Parameters::PAPER;
    let split = paper.with_p3m();
    assert!(fit::<64>(&paper, &paper) && fit::<64>(&split, &split));
    // What the stages are told at every call.
    let told = Parameters { seed: 5, noise: Noise::None, assignment: Assignment::Order4, ..split };
    assert!(fit::<64>(&split, &told) && fit::<64>(&told, &split));
    for (what, other) in [
        ("mesh", Parameters { grid: 128, ..split }),
        ("pair force: side", Parameters { side: 65.0, ..split }),
        ("pair force: strength", Parameters { capillary_strength: 2.0 * split.capillary_strength, ..split }),
        ("pair force: repulsion", Parameters { repulsion: false, ..split }),
        ("pair force: cut-off", Parameters { cutoff: 0.9 * split.cutoff, ..split }),
        ("pair force: none near", Parameters { cutoff: split.cutoff, ..paper }),
        ("table: splitting", Parameters { splitting: 0.9 * split.splitting, ..split }),
        ("table: capillary length", Parameters { capillary_length: 20.0, ..split }),
    ] {
        let refused = if other.grid == 64 {
            !fit::<64>(&split, &other) && !fit::<64>(&other, &split)
        } else {
            !fit::<128>(&split, &other) && !fit::<64>(&other, &split)
        };
        assert!(refused, "{what}");
    }
}
