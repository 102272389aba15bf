//! Files of positions.

use meniscus::files::extended_xyz::{self, Frame, FrameChoice};
use meniscus::files::{csv, state::State};
use meniscus_core::torus::Torus;
use std::io::Cursor;

/// Sides of the boxes that files are read in, R0: one whose coordinates have few digits and one whose have many.
const SIDES: [f64; 2] = [8.0, 33.3];

/// The bytes of a file of every format, one after the other; what is accepted has the same bits when written and read
/// again, in its own format and in the others.
pub fn positions(data: &[u8]) {
    if let Ok(state) = State::from_bytes(data) {
        assert_eq!(state.to_bytes(), data);
        let State { step, time, positions } = state;
        check_texts(&State { step, time: time & !0xFFF, positions });
    }
    for torus in SIDES.iter().filter_map(|&side| Torus::new(side).ok()) {
        if let Ok(positions) = csv::parse(data, &torus) {
            check_texts(&State { positions, ..State::default() });
        }
        for choice in [FrameChoice::Last, FrameChoice::Number(0), FrameChoice::Number(1)] {
            if let Ok(state) = extended_xyz::parse(Cursor::new(data), &torus, choice) {
                check_texts(&state);
            }
        }
    }
}

/// Writes and reads `state`, whose time is a multiple of as many units as binary64 tells apart. The bytes of a
/// state may be without discs, text may not.
fn check_texts(state: &State) {
    let &State { step, time, ref positions } = state;
    let bytes = State { step, time, positions: positions.clone() }.to_bytes();
    assert_eq!(State::from_bytes(&bytes).as_ref().map(|state| &state.positions), Ok(positions));
    if positions.is_empty() {
        return;
    }
    for torus in SIDES.iter().filter_map(|&side| Torus::new(side).ok()) {
        let text = csv::format(&torus, positions);
        assert_eq!(csv::parse(text.as_bytes(), &torus).ok().as_ref(), Some(positions), "{text}");

        let frame = Frame { step, time, time_over_jeans: None, time_step: 0.001, positions, clustered: None };
        let mut text = Vec::new();
        assert!(extended_xyz::write_frame(&mut text, &torus, &frame).is_ok());
        let again = extended_xyz::parse(Cursor::new(&text), &torus, FrameChoice::Last);
        assert_eq!(again.ok().as_ref(), Some(state), "{}", String::from_utf8_lossy(&text));
    }
}
