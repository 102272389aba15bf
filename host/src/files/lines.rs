//! Lines of text, numbered, and never longer than a page: a file of anything at all can be read with
//! little memory.

use super::FormatError;
use std::io::{BufRead, Read, Seek, SeekFrom};

/// Longest line accepted, bytes.
const LONGEST: u64 = 1 << 16;

/// A place in a file at which a line begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Bytes before it.
    offset: u64,
    /// Lines before it.
    lines: u64,
}

/// The lines of an input.
pub(super) struct Lines<R> {
    input: R,
    buffer: Vec<u8>,
    place: Place,
}

impl<R: BufRead> Lines<R> {
    /// The lines of `input` from where it stands.
    pub(super) fn new(input: R) -> Self {
        Self { input, buffer: Vec::new(), place: Place { offset: 0, lines: 0 } }
    }

    /// Where the next line begins.
    pub(super) fn place(&self) -> Place {
        self.place
    }

    /// The number of the line read last, from 1.
    pub(super) fn number(&self) -> u64 {
        self.place.lines
    }

    /// The next line without its end and without blanks around it; none at the end of the input.
    pub(super) fn next(&mut self) -> Result<Option<&str>, FormatError> {
        self.buffer.clear();
        let mut limited = self.input.by_ref().take(LONGEST + 1);
        let length = limited.read_until(b'\n', &mut self.buffer).map_err(FormatError::Input)? as u64;
        if length == 0 {
            return Ok(None);
        }
        self.place = Place { offset: self.place.offset + length, lines: self.place.lines + 1 };
        let line = self.place.lines;
        if length > LONGEST {
            let expected = format!("at most {LONGEST} bytes in a line");
            return Err(FormatError::Line { line, found: "a longer line".to_owned(), expected });
        }
        let Ok(text) = std::str::from_utf8(&self.buffer) else {
            let found = "bytes that are no text".to_owned();
            return Err(FormatError::Line { line, found, expected: "UTF-8".to_owned() });
        };
        // Some programs begin a text file with a byte order mark.
        Ok(Some(text.trim_start_matches('\u{feff}').trim()))
    }
}

impl<R: BufRead + Seek> Lines<R> {
    /// Goes back to `place`, which an earlier call of [`place`](Self::place) gave.
    pub(super) fn go_back(&mut self, place: Place) -> Result<(), FormatError> {
        self.input.seek(SeekFrom::Start(place.offset)).map_err(FormatError::Input)?;
        self.place = place;
        Ok(())
    }
}
