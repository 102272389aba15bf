//! GSD files.

use meniscus::files::extended_xyz::FrameChoice;
use meniscus::files::gsd::GsdReader;
use meniscus_core::torus::Torus;
use std::io::Cursor;

/// Side of the box that files are read in if they are not to say one, R0.
const SIDE: f64 = 33.3;

/// Most frames that are looked at.
const MOST_FRAMES: u64 = 8;

/// The bytes of a file; every frame that is accepted is of one number of discs in a box, and the last is the last.
pub fn gsd(data: &[u8]) {
    let tori = [None, Torus::new(SIDE).ok()];
    for torus in tori {
        let Ok(mut reader) = GsdReader::open(Cursor::new(data), torus.as_ref()) else {
            continue;
        };
        assert!(torus.is_none_or(|torus| torus == reader.torus()));
        for number in 0..reader.frames().min(MOST_FRAMES) {
            let Ok(frame) = reader.frame(number) else {
                continue;
            };
            let count = frame.state.positions.len();
            // A position needs more than a byte.
            assert!(count <= data.len());
            assert!(frame.crossings.is_empty() || frame.crossings.len() == count);
            assert!(frame.state.strengths.as_ref().is_none_or(|strengths| strengths.len() == count));
            if number + 1 == reader.frames() {
                assert_eq!(reader.choose(FrameChoice::Last).ok(), Some(frame));
            }
        }
        assert!(reader.frame(reader.frames()).is_err());
    }
}
