//! Writing: the chunks of a frame, in one order, through the library.

use super::super::trajectory::{Extent, Frame};
use super::super::{FileError, FormatError};
use super::container::{Chunk, Container, kind};
use super::{centred, name};
use crate::strengths;
use hoomd_gsd::file_layer::{GsdFile, Mode, Type};
use meniscus_core::torus::Torus;
use meniscus_core::units::time_from_units;
use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// What the header says who wrote the file.
const APPLICATION: &str = "Meniscus";
/// The schema, and its version.
const SCHEMA: (&str, (u16, u16)) = ("hoomd", (1, 4));
/// The only type of particles, as the file has it.
const TYPE: &[u8; 4] = b"disc";
/// Length of the name of a type, bytes.
const TYPE_LENGTH: usize = 64;
/// Diameter of a disc, R0.
const DIAMETER: f32 = 2.0;

/// The entry of the first chunk of every file, the step of frame 0: behind the header, an index of 128 entries and
/// 1024 bytes of names.
fn first_entry() -> [u8; 32] {
    let mut entry = [0; 32];
    entry[8..16].copy_from_slice(&1_u64.to_ne_bytes());
    entry[16..24].copy_from_slice(&(256 + 128 * 32 + 1024_u64).to_ne_bytes());
    entry[24..28].copy_from_slice(&1_u32.to_ne_bytes());
    entry[30] = kind::U64;
    entry
}

/// An open GSD file to which frames are appended.
#[derive(Debug)]
pub(in super::super) struct GsdTrajectory {
    path: PathBuf,
    torus: Torus,
    /// None after a failure, when what the library would write on is not what the file has.
    file: Option<GsdFile>,
    frames: u64,
    /// Number of discs in frame 0.
    count: usize,
}

impl GsdTrajectory {
    pub(in super::super) fn create(path: &Path, torus: &Torus) -> Result<Self, FileError> {
        let file = GsdFile::create_new(path, APPLICATION, SCHEMA.0, SCHEMA.1);
        let file = file.map_err(|error| failed(path, &error))?;
        Ok(Self { path: path.to_owned(), torus: *torus, file: Some(file), frames: 0, count: 0 })
    }

    /// The first frames go, chunk by chunk as they were written, to a new file that takes the place of the old one. The
    /// library makes the same file of the same chunks.
    pub(in super::super) fn resume(path: &Path, torus: &Torus, extent: Extent) -> Result<Self, FileError> {
        let refused = |problem| FileError::Read { path: path.to_owned(), problem };
        let old = File::open(path).map_err(|error| refused(FormatError::Input(error)))?;
        let length = old.metadata().map_err(|error| refused(FormatError::Input(error)))?.len();
        let less = |found: u64, expected: u64, what: &str| FileError::Extent {
            path: path.to_owned(),
            found: format!("{found} {what}"),
            expected: format!("{expected} {what}"),
        };
        if length < extent.bytes {
            return Err(less(length, extent.bytes, "bytes"));
        }
        if length == extent.bytes
            && let Some(trajectory) = Self::go_on(path, torus, extent)
        {
            return Ok(trajectory);
        }
        let temporary = super::super::atomic::temporary_beside(path).map_err(|error| failed(path, &error))?;
        let file = GsdFile::create(temporary.path(), APPLICATION, SCHEMA.0, SCHEMA.1);
        let mut file = file.map_err(|error| failed(path, &error))?;
        let mut count = 0;
        if extent.frames > 0 {
            let old = BufReader::new(old);
            let mut old =
                Container::beginning(old, extent.frames, extent.bytes, first_entry()).map_err(refused)?;
            if old.frames() != extent.frames {
                return Err(less(old.frames(), extent.frames, "frames"));
            }
            count = count_of(&mut old).map_err(refused)?;
            for frame in 0..extent.frames {
                let written: Vec<(String, Chunk)> =
                    old.written(frame).into_iter().map(|(name, chunk)| (name.to_owned(), chunk)).collect();
                for (name, chunk) in written {
                    let bytes = old.bytes(&chunk).map_err(refused)?;
                    copy(&mut file, &name, &chunk, &bytes).map_err(|error| failed(path, &*error))?;
                }
                end_frame(&mut file).map_err(|error| failed(path, &*error))?;
            }
        }
        let written = length_of(temporary.path()).map_err(|error| failed(path, &error))?;
        if written != extent.bytes {
            return Err(less(written, extent.bytes, "bytes"));
        }
        super::super::atomic::take_place(temporary, path).map_err(|error| failed(path, &error))?;
        Ok(Self { path: path.to_owned(), torus: *torus, file: Some(file), frames: extent.frames, count })
    }

    /// Opens a file that has nothing after `extent`; None if there is anything unusual about it.
    fn go_on(path: &Path, torus: &Torus, extent: Extent) -> Option<Self> {
        let mut old = Container::open(BufReader::new(File::open(path).ok()?)).ok()?;
        if old.frames() != extent.frames {
            return None;
        }
        let count = if extent.frames > 0 { count_of(&mut old).ok()? } else { 0 };
        let file = GsdFile::open(path, Mode::Write).ok()?;
        Some(Self { path: path.to_owned(), torus: *torus, file: Some(file), frames: extent.frames, count })
    }

    pub(in super::super) fn append(&mut self, frame: &Frame<'_>) -> Result<(), FileError> {
        let constants = self.frames == 0 || self.count != frame.positions.len();
        let Some(mut file) = self.file.take() else {
            let error = std::io::Error::other("an earlier frame could not be written");
            return Err(failed(&self.path, &error));
        };
        let result = write(&mut file, &self.torus, frame, constants).and_then(|()| end_frame(&mut file));
        if let Err(error) = result {
            // Dropped, the library would write once more, where it thinks that the file ends.
            std::mem::forget(file);
            return Err(failed(&self.path, &*error));
        }
        self.file = Some(file);
        if self.frames == 0 {
            self.count = frame.positions.len();
        }
        self.frames += 1;
        Ok(())
    }

    pub(in super::super) fn sync(&mut self) -> Result<Extent, FileError> {
        // Every frame is on the disk.
        let bytes = length_of(&self.path).map_err(|error| failed(&self.path, &error))?;
        Ok(Extent { frames: self.frames, bytes })
    }
}

/// Any error of the library.
type Problem = Box<dyn Error>;

/// Writes the chunks of a frame, with those that are the same in all frames if `constants`.
fn write(file: &mut GsdFile, torus: &Torus, frame: &Frame<'_>, constants: bool) -> Result<(), Problem> {
    let side = torus.side() as f32;
    let count = frame.positions.len();
    file.write_scalars(name::STEP, [frame.step])?;
    if constants {
        file.write_scalars(name::DIMENSIONS, [2_u8])?;
        file.write_scalars(name::BOX, [side, side, 0.0, 0.0, 0.0, 0.0])?;
        file.write_scalars(name::COUNT, [count as u32])?;
        let mut kind = [0; TYPE_LENGTH];
        kind[..TYPE.len()].copy_from_slice(TYPE);
        file.write_arrays("particles/types", [kind])?;
        file.write_scalars("particles/typeid", std::iter::repeat_n(0_u32, count))?;
        file.write_scalars("particles/diameter", std::iter::repeat_n(DIAMETER, count))?;
    }
    let positions = frame.positions.iter();
    file.write_arrays(
        name::POSITION,
        positions.map(|position| [centred(side, position.x), centred(side, position.y), 0.0]),
    )?;
    let image = |id: usize| frame.crossings.get(id).map_or([0; 3], |&[x, y]| [x, y, 0]);
    file.write_arrays(name::IMAGE, (0..count).map(image))?;
    file.write_scalars("log/time", [time_from_units(frame.time)])?;
    if let Some(time) = frame.time_over_jeans {
        file.write_scalars(name::TIME_OVER_JEANS, [time])?;
    }
    file.write_scalars(name::TIME_STEP, [frame.time_step])?;
    if let Some(force) = frame.largest_force {
        file.write_scalars(name::LARGEST_FORCE, [force])?;
    }
    if let Some(clusters) = frame.clustered {
        file.write_scalars("log/clusters", [clusters.count() as u32])?;
        file.write_scalars("log/largest_cluster", [clusters.largest()])?;
        file.write_scalars("log/mean_cluster_size", [clusters.number_average()])?;
        file.write_scalars("log/mass_weighted_cluster_size", [clusters.mass_average()])?;
        let clustered = (0..count).map(|id| u8::from(clusters.clustered(id)));
        file.write_scalars("log/particles/clustered", clustered)?;
    }
    if !strengths::all_one(frame.strengths) {
        let numbers = frame.strengths.iter().map(|&strength| strengths::to_number(strength));
        file.write_scalars(name::STRENGTH, numbers)?;
    }
    file.write_scalars(name::EXACT_SIDE, [torus.side()])?;
    file.write_scalars(name::EXACT_TIME, [frame.time])?;
    let bits = frame.positions.iter().map(|position| [position.x.to_bits(), position.y.to_bits()]);
    file.write_arrays(name::EXACT_POSITION, bits)?;
    Ok(())
}

/// Ends a frame and hands it to the disk. How often that is done decides where the library puts a longer index, so it
/// is done after every frame.
fn end_frame(file: &mut GsdFile) -> Result<(), Problem> {
    file.end_frame()?;
    file.sync_all()?;
    Ok(())
}

/// Writes a chunk of another file that this program wrote.
fn copy(file: &mut GsdFile, name: &str, chunk: &Chunk, bytes: &[u8]) -> Result<(), Problem> {
    match (chunk.kind, chunk.columns) {
        (kind::U8, 1) => scalars(file, name, bytes, u8::from_ne_bytes),
        (kind::U8, 64) => arrays::<u8, 1, TYPE_LENGTH>(file, name, bytes, u8::from_ne_bytes),
        (kind::U32, 1) => scalars(file, name, bytes, u32::from_ne_bytes),
        (kind::U32, 2) => arrays::<u32, 4, 2>(file, name, bytes, u32::from_ne_bytes),
        (kind::U64, 1) => scalars(file, name, bytes, u64::from_ne_bytes),
        (kind::I32, 3) => arrays::<i32, 4, 3>(file, name, bytes, i32::from_ne_bytes),
        (kind::F32, 1) => scalars(file, name, bytes, f32::from_ne_bytes),
        (kind::F32, 3) => arrays::<f32, 4, 3>(file, name, bytes, f32::from_ne_bytes),
        (kind::F64, 1) => scalars(file, name, bytes, f64::from_ne_bytes),
        _ => Err(format!("the chunk {name} is none that this program writes").into()),
    }
}

fn scalars<T: Type, const LENGTH: usize>(
    file: &mut GsdFile,
    name: &str,
    bytes: &[u8],
    number: impl Fn([u8; LENGTH]) -> T,
) -> Result<(), Problem> {
    file.write_scalars(name, bytes.as_chunks().0.iter().map(|bytes| number(*bytes)))?;
    Ok(())
}

fn arrays<T: Type + Copy + Default, const LENGTH: usize, const COLUMNS: usize>(
    file: &mut GsdFile,
    name: &str,
    bytes: &[u8],
    number: impl Fn([u8; LENGTH]) -> T,
) -> Result<(), Problem> {
    let (numbers, _) = bytes.as_chunks::<LENGTH>();
    let (rows, _) = numbers.as_chunks::<COLUMNS>();
    file.write_arrays(name, rows.iter().map(|row| row.map(&number)))?;
    Ok(())
}

/// The number of discs that frame 0 says.
fn count_of(container: &mut Container<BufReader<File>>) -> Result<usize, FormatError> {
    let Some(chunk) = container.find(0, name::COUNT) else { return Ok(0) };
    let bytes = container.bytes(&chunk)?;
    Ok(bytes.first_chunk().map_or(0, |bytes| u32::from_ne_bytes(*bytes) as usize))
}

fn length_of(path: &Path) -> std::io::Result<u64> {
    Ok(std::fs::metadata(path)?.len())
}

/// The library's error as what the system said.
fn failed(path: &Path, error: &(dyn Error + 'static)) -> FileError {
    let mut deepest = error;
    while let Some(source) = deepest.source() {
        deepest = source;
    }
    let problem = match deepest.downcast_ref::<std::io::Error>() {
        Some(error) => match error.raw_os_error() {
            Some(code) => std::io::Error::from_raw_os_error(code),
            None => std::io::Error::new(error.kind(), error.to_string()),
        },
        None => std::io::Error::other(deepest.to_string()),
    };
    FileError::Write { path: path.to_owned(), problem }
}
