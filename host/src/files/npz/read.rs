//! Reading an archive as this program writes it.

use super::{
    Array, BOX, EXACT_POSITIONS, EXACT_TIME, IMAGES, LARGEST_FORCE, STEP, STRENGTHS, TIME_OVER_JEANS,
    TIME_STEP, skip_header,
};
use crate::files::FormatError;
use crate::files::error::quoted;
use crate::files::state::State;
use crate::files::trajectory::Recorded;
use crate::strengths;
use meniscus_core::parameters::LARGEST_PARTICLE_COUNT;
use meniscus_core::torus::{Position, Torus};
use std::io::{Read, Seek, SeekFrom};
use zip::ZipArchive;
/// The frames of an archive.
pub(in crate::files) struct NpzReader<R> {
    archive: ZipArchive<R>,
    torus: Torus,
    frames: u64,
    count: u64,
}

impl<R: Read + Seek> NpzReader<R> {
    /// Opens the archive in `input`, whose box has to be `torus` if there is one.
    pub(in crate::files) fn open(input: R, torus: Option<&Torus>) -> Result<Self, FormatError> {
        let mut archive = ZipArchive::new(input).map_err(|error| damaged(&error.to_string()))?;
        let (frames, count) = shape(&mut archive)?;
        if count > LARGEST_PARTICLE_COUNT as u64 {
            return Err(wrong(format!("{count} discs"), format!("at most {LARGEST_PARTICLE_COUNT}")));
        }
        let side = f64::from_le_bytes(one(&data(&mut archive, &BOX, 1, 0, 0)?));
        let torus = match torus {
            Some(torus) if torus.side() == side => *torus,
            Some(torus) => {
                return Err(wrong(
                    format!("a box of side {side}"),
                    format!("the box of side {}", torus.side()),
                ));
            }
            None => Torus::new(side).map_err(|_| {
                wrong(format!("a box of side {side}"), "a side that a box can have, R0".to_owned())
            })?,
        };
        Ok(Self { archive, torus, frames, count })
    }

    /// The box.
    pub(in crate::files) fn torus(&self) -> Torus {
        self.torus
    }

    /// The number of discs.
    pub(in crate::files) fn count(&self) -> u64 {
        self.count
    }

    /// The number of frames.
    pub(in crate::files) fn frames(&self) -> u64 {
        self.frames
    }

    /// The frame of this number, from 0.
    pub(in crate::files) fn frame(&mut self, frame: u64) -> Result<Recorded, FormatError> {
        let mut data = |array| data(&mut self.archive, array, self.frames, self.count, frame);
        let known = |bytes: Vec<u8>| Some(f64::from_le_bytes(one(&bytes))).filter(|number| !number.is_nan());
        let (step, time) = (data(&STEP)?, data(&EXACT_TIME)?);
        let (bits, images, strengths) = (data(&EXACT_POSITIONS)?, data(&IMAGES)?, data(&STRENGTHS)?);
        let (time_over_jeans, largest_force) = (known(data(&TIME_OVER_JEANS)?), known(data(&LARGEST_FORCE)?));
        let time_step = f64::from_le_bytes(one(&data(&TIME_STEP)?));
        let pairs = |bytes: &[u8]| -> Vec<[[u8; 4]; 2]> { bytes.as_chunks().0.as_chunks().0.to_vec() };
        let position = |pair: [[u8; 4]; 2]| {
            let [x, y] = pair.map(u32::from_le_bytes);
            Position::from_bits(x, y)
        };
        let strength = |bytes: &[u8; 8]| {
            let number = f64::from_le_bytes(*bytes);
            strengths::from_number(number).ok_or_else(|| {
                wrong(format!("a strength of {number}"), "strengths that the core accepts".to_owned())
            })
        };
        let strengths: Vec<i32> = strengths.as_chunks().0.iter().map(strength).collect::<Result<_, _>>()?;
        let state = State {
            step: u64::from_le_bytes(one(&step)),
            time: u64::from_le_bytes(one(&time)),
            positions: pairs(&bits).into_iter().map(position).collect(),
            strengths: (!strengths::all_one(&strengths)).then_some(strengths),
            held: None,
        };
        let crossings = pairs(&images).into_iter().map(|pair| pair.map(i32::from_le_bytes)).collect();
        Ok(Recorded { state, time_over_jeans, time_step, largest_force, crossings })
    }
}

/// The numbers of frames and discs.
fn shape<R: Read + Seek>(archive: &mut ZipArchive<R>) -> Result<(u64, u64), FormatError> {
    let name = EXACT_POSITIONS.file_name();
    let Ok(mut file) = archive.by_name(&name) else {
        return Err(wrong(
            format!("no array {}", EXACT_POSITIONS.name),
            "an archive of this program".to_owned(),
        ));
    };
    let text = skip_header(&mut file).map_err(FormatError::Input)?;
    let numbers: Option<Vec<u64>> = text
        .split_once("'shape': (")
        .and_then(|(_, rest)| rest.split_once(')'))
        .and_then(|(shape, _)| shape.split(',').map(|number| number.trim().parse().ok()).collect());
    match numbers.as_deref() {
        Some(&[frames, count, 2]) => Ok((frames, count)),
        _ => Err(wrong(quoted(text.trim()), "position_bits of frames, discs and 2 columns".to_owned())),
    }
}

/// The bytes of a frame in an array, which has to be as this program writes it.
fn data<R: Read + Seek>(
    archive: &mut ZipArchive<R>,
    array: &Array,
    frames: u64,
    count: u64,
    frame: u64,
) -> Result<Vec<u8>, FormatError> {
    let refused = |error: &dyn std::fmt::Display| damaged(&format!("array {}: {error}", array.name));
    let mut file = archive.by_name_seek(&array.file_name()).map_err(|error| refused(&error))?;
    let header = array.header(frames, count);
    let mut found = Vec::new();
    file.by_ref().take(header.len() as u64).read_to_end(&mut found).map_err(|error| refused(&error))?;
    if found != header {
        return Err(refused(&"another shape or kind of numbers"));
    }
    let length = array.bytes_of_frame(count);
    let begin = length.checked_mul(frame).and_then(|begin| begin.checked_add(header.len() as u64));
    let begin = begin.ok_or_else(|| refused(&"too many frames"))?;
    file.seek(SeekFrom::Start(begin)).map_err(|error| refused(&error))?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(|error| refused(&error))?;
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(refused(&"cut off")) }
}

/// The bytes of a number; `bytes` has them.
fn one(bytes: &[u8]) -> [u8; 8] {
    bytes.first_chunk().copied().unwrap_or_default()
}

fn damaged(what: &str) -> FormatError {
    wrong(what.to_owned(), "a whole .npz file, not compressed".to_owned())
}

fn wrong(found: String, expected: String) -> FormatError {
    FormatError::Whole { found, expected }
}
