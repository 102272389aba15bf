//! Files of positions.

use meniscus::files::extended_xyz::{self, FrameChoice};
use meniscus::files::trajectory::Frame;
use meniscus::files::{csv, state::State};
use meniscus::strengths::all_one;
use meniscus_core::torus::Torus;
use std::io::Cursor;

/// Sides of the boxes that files are read in, R0: one whose coordinates have few digits and one whose have many.
const SIDES: [f64; 2] = [8.0, 33.3];

/// The bytes of a file of every format, one after the other; what is accepted has the same bits when written and read
/// again, in its own format and in the others.
pub fn positions(data: &[u8]) {
    if let Ok(state) = State::from_bytes(data) {
        assert_eq!(state.to_bytes(), data);
        check_texts(&State { time: state.time & !0xFFF, held: None, ..state });
    }
    for torus in SIDES.iter().filter_map(|&side| Torus::new(side).ok()) {
        if let Ok(state) = csv::parse(data, &torus) {
            check_texts(&state);
        }
        for choice in [FrameChoice::Last, FrameChoice::Number(0), FrameChoice::Number(1)] {
            if let Ok(state) = extended_xyz::parse(Cursor::new(data), &torus, choice) {
                check_texts(&state);
            }
        }
    }
}

/// Writes and reads `state`, whose time is a multiple of as many units as binary64 tells apart. The bytes of a
/// state may be without discs, text may not. Strengths that are all 1 are not written. Text holds no held forces.
fn check_texts(state: &State) {
    let told = state.strengths.clone().filter(|strengths| !all_one(strengths));
    let told = State { strengths: told, ..state.clone() };
    assert_eq!(State::from_bytes(&state.to_bytes()).as_ref(), Ok(&told));
    let State { step, time, positions, strengths, .. } = state;
    let strengths = strengths.as_deref().unwrap_or_default();
    if positions.is_empty() {
        return;
    }
    for torus in SIDES.iter().filter_map(|&side| Torus::new(side).ok()) {
        let text = csv::format(&torus, positions, strengths);
        let again = csv::parse(text.as_bytes(), &torus);
        assert_eq!(again.ok(), Some(State { step: 0, time: 0, ..told.clone() }), "{text}");

        let (step, time) = (*step, *time);
        let frame = Frame { step, time, time_step: 0.001, positions, strengths, ..Frame::default() };
        let mut text = Vec::new();
        assert!(extended_xyz::write_frame(&mut text, &torus, &frame).is_ok());
        let again = extended_xyz::parse(Cursor::new(&text), &torus, FrameChoice::Last);
        assert_eq!(again.ok().as_ref(), Some(&told), "{}", String::from_utf8_lossy(&text));
    }
}
