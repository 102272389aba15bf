//! Steps of the wide stages against those of the core: the same state after every step, at every width of lanes and in
//! any number of pieces.

#![expect(clippy::unwrap_used, reason = "a helper of a test fails the test by panicking")]

use meniscus_core::dynamics::Disc;
use meniscus_core::engine::Engine;
use meniscus_core::fields::Fields;
use meniscus_core::noise::{Purpose, StepKey};
use meniscus_core::parameters::{Assignment, Noise, Parameters};
use meniscus_core::torus::Position;
use meniscus_wide::division::Division;
use meniscus_wide::lanes::Level;
use meniscus_wide::stages::Wide;

type SmallEngine = Engine<64, 300>;

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
fn a_heap_of_discs_takes_no_memory_for_lists() {
    let parameters = Parameters { capillary_strength: 0.0, ..Parameters::PAPER };
    let place = |id: u32| (id, Position::from_bits(id % 3, id % 2));
    let mut expected = Box::new(Engine::<64, 3000>::new());
    let mut engine = Box::new(Engine::<64, 3000>::new());
    expected.init(&parameters, (0..3000).map(place)).unwrap();
    engine.init(&parameters, (0..3000).map(place)).unwrap();
    expected.compute_forces().unwrap();
    for pieces in [1, 3] {
        let mut wide = Wide::with(&parameters, Level::best(), Division { mesh: pieces, discs: pieces });
        let (dynamics, mut memory) = engine.parts();
        in_threads(pieces, || dynamics.forces(&mut wide, &mut memory)).unwrap();
        assert!((0..3000).all(|disc| engine.force(disc) == expected.force(disc)));
        assert!(engine.force(0).is_some_and(|force| force != (0, 0)));
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
