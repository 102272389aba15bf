//! What an engine costs: its size, and nothing in the program's file.

use meniscus_core::engine::Engine;
use meniscus_core::near_part::{LARGEST_TABLE, table_length};
use meniscus_core::parameters::Parameters;
use meniscus_tests::states::{scattered, with_ids};
use std::sync::Mutex;

/// 64 MiB of mesh and 112 MiB of discs: more than this program has in code and debugging symbols.
type Large = Engine<2048, 2_097_152>;

static LARGE: Mutex<Large> = Mutex::new(Large::new());

#[test]
fn an_engine_of_64_nodes_and_256_discs_fits_96_kibibytes() {
    assert!(size_of::<Engine<64, 256>>() <= 96 * 1024, "{} bytes", size_of::<Engine<64, 256>>());
}

#[test]
fn an_engine_of_16_nodes_and_32_discs_with_a_near_part_fits_9_kibibytes() {
    assert!(size_of::<Engine<16, 32, { table_length(6.0) }>>() <= 9 * 1024);
}

#[test]
fn an_engine_is_its_arrays_and_little_else() {
    // Per disc 10 words of 32 bits and 2 of 64; per node mass, field and influence; 16 lines; the gradient; four
    // coefficients a segment.
    let arrays = |grid: usize, discs: usize, segments: usize| {
        discs * 56 + grid * grid * 16 + 16 * grid * 8 + grid * 4 + segments * 16
    };
    assert!(size_of::<Engine<64, 256>>() - arrays(64, 256, LARGEST_TABLE) < 256);
    assert!(size_of::<Engine<16, 2>>() - arrays(16, 2, LARGEST_TABLE) < 256);
    assert!(size_of::<Engine<16, 2, 0>>() - arrays(16, 2, 0) < 256);
}

#[test]
fn a_static_engine_takes_no_room_in_the_programs_file() {
    // Used, so that it cannot be left out.
    let parameters = Parameters { grid: 2048, side: 256.0, capillary_strength: 0.0, ..Parameters::PAPER };
    let mut engine = LARGE.lock().unwrap();
    engine.init(&parameters, with_ids(&scattered(1, 100))).unwrap();
    assert!(engine.step().is_ok());
    let program = std::env::current_exe().unwrap();
    let length = std::fs::metadata(program).unwrap().len();
    assert!(length < size_of::<Large>() as u64, "the program has {length} bytes");
}

#[test]
fn an_engine_has_nothing_until_it_is_started() {
    // A disc, a clock, a digest: nothing there.
    let engine = Box::new(Engine::<16, 4>::default());
    assert_eq!((engine.count(), engine.clock().step, engine.clock().time), (0, 0, 0));
    assert_eq!(engine.state().digest().length, 32);
}
