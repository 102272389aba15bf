//! Trajectories: every bit comes back, a file that goes on has the bytes of an uninterrupted one, what is damaged is
//! refused, and formats turn into one another.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use hoomd_gsd::file_layer::{GsdFile, Mode};
use hoomd_gsd::hoomd::{Dimensions, HoomdGsdFile};
use meniscus::files::extended_xyz::FrameChoice;
use meniscus::files::gsd::{self, GsdReader};
use meniscus::files::trajectory::{Extent, Format, Frame, Recorded, Trajectory, TrajectoryReader};
use meniscus::files::{FileError, read_positions, state::State};
use meniscus::observables::clusters::Clusters;
use meniscus::strengths::ONE;
use meniscus_core::torus::{LARGEST_SIDE, Position, SMALLEST_SIDE, Torus};
use meniscus_tests::long_tests;
use meniscus_tests::program::Program;
use proptest::prelude::*;
use std::fs;
use std::io::Cursor;
use std::path::Path;

const FORMATS: [Format; 4] = [Format::Gsd, Format::ExtendedXyz, Format::LammpsDump, Format::Npz];

fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

/// A frame with everything in it, different from that of every other number.
fn recorded(number: u64, count: u32) -> Recorded {
    let bits = |id: u32, factor: u32| (id + 7 * number as u32 + 1).wrapping_mul(factor);
    let positions: Vec<Position> =
        (0..count).map(|id| Position::from_bits(bits(id, 0x9E37_79B9), bits(id, 0x85EB_CA6B))).collect();
    let crossings = (0..count as i32).map(|id| [id - number as i32, 3 * id]).collect();
    let strengths = (0..count as i32).map(|id| ONE - 5 * id).collect();
    // Text has the time in binary64.
    let state =
        State { step: 3 * number, time: number << 40, positions, strengths: Some(strengths), held: None };
    let time_over_jeans = Some(number as f64 / 3.0);
    Recorded { state, time_over_jeans, time_step: 1e-3, largest_force: Some(17.25), crossings }
}

fn append(trajectory: &mut Trajectory, torus: &Torus, recorded: &Recorded) {
    let clusters = Clusters::find(torus, &recorded.state.positions);
    trajectory.append(&recorded.frame(Some(&clusters))).unwrap();
}

/// A file of `frames` frames, and what it was after each.
fn grown(path: &Path, format: Format, torus: &Torus, frames: u64, count: u32) -> Vec<Extent> {
    let mut trajectory = Trajectory::create(path, format, torus).unwrap();
    let mut extents = vec![trajectory.sync().unwrap()];
    for number in 0..frames {
        append(&mut trajectory, torus, &recorded(number, count));
        extents.push(trajectory.sync().unwrap());
    }
    extents
}

/// Goes on after `extent` up to `frames` frames, and gives the bytes.
fn gone_on(
    path: &Path,
    format: Format,
    torus: &Torus,
    extent: Extent,
    frames: u64,
    count: u32,
) -> Result<Vec<u8>, FileError> {
    let mut trajectory = Trajectory::resume(path, format, torus, extent)?;
    for number in extent.frames..frames {
        append(&mut trajectory, torus, &recorded(number, count));
    }
    drop(trajectory);
    Ok(fs::read(path).unwrap())
}

#[test]
fn a_file_that_goes_on_has_the_bytes_of_an_uninterrupted_one() {
    // The index of a GSD file becomes too short, and moves, in frames 7 and 15 or thereabouts.
    let (frames, count, torus) = (18, 3, torus(33.3));
    for format in FORMATS {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format.file_name());
        let extents = grown(&path, format, &torus, frames, count);
        let whole = fs::read(&path).unwrap();
        assert_eq!(extents.last().unwrap().bytes, whole.len() as u64);
        for extent in &extents {
            // Frames after the checkpoint are whole.
            fs::write(&path, &whole).unwrap();
            assert!(
                gone_on(&path, format, &torus, *extent, frames, count).unwrap() == whole,
                "{format:?} {extent:?}"
            );
        }
        // There is nothing after the checkpoint: the file as it was then.
        for number in 0..=frames {
            let path = folder.path().join(format!("{number}-{}", format.file_name()));
            let extents = grown(&path, format, &torus, number, count);
            let extent = *extents.last().unwrap();
            assert!(
                gone_on(&path, format, &torus, extent, frames, count).unwrap() == whole,
                "{format:?} {extent:?}"
            );
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), frames as usize + 2, "nothing else is left");
    }
}

#[test]
fn what_is_torn_or_foreign_after_the_checkpoint_is_dropped() {
    let torus = torus(33.3);
    for format in [Format::Gsd, Format::ExtendedXyz, Format::LammpsDump] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format.file_name());
        let (frames, count) = (if long_tests() { 10 } else { 2 }, 1);
        let extents = grown(&path, format, &torus, frames, count);
        let whole = fs::read(&path).unwrap();
        for kept in extents.iter().rev().take(if long_tests() { 4 } else { 2 }) {
            let step = if long_tests() || format != Format::Gsd { 1 } else { 5 };
            for length in (kept.bytes as usize..=whole.len()).step_by(step) {
                fs::write(&path, &whole[..length]).unwrap();
                let again = gone_on(&path, format, &torus, *kept, frames, count).unwrap();
                assert!(again == whole, "{format:?} {kept:?} {length}");
            }
            let garbage: Vec<u8> = (0..100_u8).map(|byte| byte.wrapping_mul(151)).collect();
            fs::write(&path, [&whole[..kept.bytes as usize], &garbage].concat()).unwrap();
            assert!(gone_on(&path, format, &torus, *kept, frames, count).unwrap() == whole, "{format:?}");
        }
    }
}

#[test]
fn the_index_of_a_cut_gsd_file_is_found_where_it_was() {
    let (frames, count, torus) = (18, 1, torus(33.3));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trajectory.gsd");
    let extents = grown(&path, Format::Gsd, &torus, frames, count);
    let whole = fs::read(&path).unwrap();
    let jumps = extents.windows(2).filter(|pair| pair[1].bytes - pair[0].bytes > 4096).count();
    assert!(jumps >= 2, "the index moves: {extents:?}");
    for extent in &extents {
        // The header tells of the last index, which is cut away.
        fs::write(&path, &whole[..extent.bytes as usize]).unwrap();
        assert!(gone_on(&path, Format::Gsd, &torus, *extent, frames, count).unwrap() == whole, "{extent:?}");
    }
}

#[test]
fn a_file_with_less_than_the_checkpoint_says_is_refused() {
    let torus = torus(33.3);
    for format in FORMATS {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format.file_name());
        let extent = *grown(&path, format, &torus, 2, 3).last().unwrap();
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() - 1]).unwrap();
        let error = Trajectory::resume(&path, format, &torus, extent).unwrap_err().to_string();
        assert!(error.contains(&format.file_name()) && error.lines().count() == 1, "{error}");
        assert_eq!(fs::read(&path).unwrap().len(), whole.len() - 1, "it is left as it was");
        fs::remove_file(&path).unwrap();
        let error = Trajectory::resume(&path, format, &torus, extent).unwrap_err().to_string();
        assert!(error.contains(&format.file_name()), "{error}");
        fs::write(&path, "").unwrap();
        let error = Trajectory::create(&path, format, &torus).unwrap_err().to_string();
        assert!(error.contains("exists"), "{error}");
    }
}

/// All frames of a file.
fn read_all(path: &Path) -> Result<Vec<Recorded>, FileError> {
    let mut reader = TrajectoryReader::open(path, None)?;
    let mut frames = Vec::new();
    while let Some(frame) = reader.read_frame()? {
        frames.push(frame);
    }
    Ok(frames)
}

#[test]
fn every_bit_comes_back() {
    let torus = torus(33.3);
    for format in FORMATS {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format.file_name());
        grown(&path, format, &torus, 3, 5);
        let mut expected: Vec<Recorded> = (0..3).map(|number| recorded(number, 5)).collect();
        for frame in &mut expected {
            // What the formats do not hold.
            if format == Format::ExtendedXyz {
                (frame.largest_force, frame.crossings) = (None, Vec::new());
            } else if format == Format::LammpsDump {
                (frame.time_over_jeans, frame.largest_force, frame.time_step, frame.state.time) =
                    (None, None, 0.0, 0);
            }
        }
        assert_eq!(read_all(&path).unwrap(), expected, "{format:?}");
        let last = expected.pop().unwrap();
        assert_eq!(read_positions(&path, &torus).unwrap(), last.state, "{format:?}");
        assert_eq!(TrajectoryReader::open(&path, None).unwrap().read_last().unwrap(), Some(last));
        let error = read_positions(&path, &self::torus(33.4)).unwrap_err().to_string();
        assert!(error.contains("33.3") && error.contains("33.4"), "{error}");
    }
}

fn any_side() -> impl Strategy<Value = f64> {
    prop_oneof![1e-3..LARGEST_SIDE, Just(500.0), Just(33.3), Just(LARGEST_SIDE), Just(SMALLEST_SIDE)]
}

fn any_bits() -> impl Strategy<Value = u32> {
    let near = |place: u32| (0..200_u32).prop_map(move |more| place.wrapping_add(more).wrapping_sub(100));
    prop_oneof![any::<u32>(), near(0), near(1 << 31)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Read by the library: in the box, never at its upper edge, and where the bits say within single precision.
    #[test]
    fn gsd_positions_are_in_the_box(
        side in any_side(), bits in prop::collection::vec((any_bits(), any_bits()), 1..40), time in any::<u64>(),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gsd");
        let torus = torus(side);
        let positions: Vec<Position> = bits.iter().map(|&(x, y)| Position::from_bits(x, y)).collect();
        let mut trajectory = Trajectory::create(&path, Format::Gsd, &torus).unwrap();
        trajectory.append(&Frame { step: 7, time, positions: &positions, ..Frame::default() }).unwrap();

        let file = GsdFile::open(&path, Mode::Read).unwrap();
        let box_of_file: Vec<f32> = file.iter_scalars(0, "configuration/box").unwrap().collect();
        let length = box_of_file[0];
        prop_assert_eq!(&box_of_file, &[side as f32, side as f32, 0.0, 0.0, 0.0, 0.0]);
        let read = file.iter_arrays::<f32, 3>(0, "particles/position").unwrap();
        for ([x, y, z], position) in read.zip(&positions) {
            prop_assert_eq!(z, 0.0);
            for (single, fraction) in [(x, position.x), (y, position.y)] {
                prop_assert!(single >= -length / 2.0 && single < length / 2.0, "{} in {}", single, length);
                let exact = torus.coordinate(fraction) - side / 2.0;
                // Half a unit of the last place of the coordinate, one of the box.
                prop_assert!((f64::from(single) - exact).abs() <= 1.2e-7 * side, "{single} {exact}");
            }
        }
        let exact: Vec<[u32; 2]> = file.iter_arrays(0, "log/particles/position_bits").unwrap().collect();
        prop_assert!(exact.iter().zip(&bits).all(|(&[x, y], &bits)| (x, y) == bits));
        let state = gsd::read(&path, &torus, FrameChoice::Last).unwrap();
        prop_assert_eq!(state, State { step: 7, time, ..State::at_start(positions) });
    }
}

/// A file as another program writes it.
fn foreign(path: &Path, dimensions: Dimensions, lengths: [f64; 6], positions: &[[f64; 3]]) {
    let mut file = HoomdGsdFile::create(path).unwrap();
    let frame = file.append_frame(9).unwrap().configuration_box(lengths).unwrap();
    let frame = frame.configuration_dimensions(dimensions).unwrap();
    frame.particles_position(positions.iter().map(|position| (*position).into())).unwrap().end().unwrap();
    // What does not change is not said again.
    file.append_frame(10).unwrap().end().unwrap();
}

#[test]
fn gsd_files_of_others_are_read_if_they_are_flat_and_square() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("foreign.gsd");
    let square = |side: f64| [side, side, 0.0, 0.0, 0.0, 0.0];
    let places = [[0.0, 0.0, 0.0], [-4.0, 4.0, 0.0], [1.5, -2.25, 0.0]];
    foreign(&path, Dimensions::Two, square(8.0), &places);
    let torus = torus(8.0);
    let state = gsd::read(&path, &torus, FrameChoice::Last).unwrap();
    let at = |x, y| Position { x: torus.fraction(x).unwrap(), y: torus.fraction(y).unwrap() };
    let expected = vec![at(4.0, 4.0), at(0.0, 0.0), at(5.5, 1.75)];
    assert_eq!(state, State { step: 10, ..State::at_start(expected) });
    assert_eq!(gsd::read(&path, &torus, FrameChoice::Number(0)).unwrap().step, 9);

    let refused = |dimensions, lengths, positions: &[[f64; 3]], part: &str| {
        foreign(&path, dimensions, lengths, positions);
        let error = gsd::read(&path, &torus, FrameChoice::Last).unwrap_err().to_string();
        assert!(
            error.contains("foreign.gsd") && error.contains(part) && error.lines().count() == 1,
            "{error}"
        );
    };
    refused(Dimensions::Three, square(8.0), &places, "3 dimensions");
    refused(Dimensions::Two, square(9.0), &places, "a box of side 9, expected the box of side 8");
    refused(Dimensions::Two, [8.0, 9.0, 0.0, 0.0, 0.0, 0.0], &places, "a square box");
    refused(Dimensions::Two, [8.0, 8.0, 0.0, 0.5, 0.0, 0.0], &places, "a square box");
    refused(Dimensions::Two, square(8.0), &[[0.0, 4.1, 0.0]], "disc 0 at 4.1");
    refused(Dimensions::Two, square(8.0), &[[f64::NAN, 0.0, 0.0]], "disc 0 at NaN");
    refused(Dimensions::Two, square(f64::INFINITY), &places, "box");
}

#[test]
fn a_gsd_file_whose_positions_were_changed_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gsd");
    let torus = torus(33.3);
    grown(&path, Format::Gsd, &torus, 1, 3);
    let mut bytes = fs::read(&path).unwrap();
    let recorded = recorded(0, 3);
    // The exact bits of a disc.
    let bits: Vec<u8> = recorded.state.positions[1].x.to_bits().to_ne_bytes().to_vec();
    let place = bytes.windows(4).rposition(|window| window == bits).unwrap();
    bytes[place + 3] ^= 1;
    fs::write(&path, bytes).unwrap();
    let error = gsd::read(&path, &torus, FrameChoice::Last).unwrap_err().to_string();
    assert!(error.contains("disc 1") && error.contains("position_bits"), "{error}");
}

/// Reads all frames; what matters is that it ends.
fn survive(bytes: &[u8], torus: Option<&Torus>) -> bool {
    let Ok(mut reader) = GsdReader::open(Cursor::new(bytes), torus) else { return false };
    (0..reader.frames().min(4)).all(|number| reader.frame(number).is_ok())
}

#[test]
fn damaged_gsd_files_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gsd");
    let torus = torus(33.3);
    grown(&path, Format::Gsd, &torus, 2, 3);
    let whole = fs::read(&path).unwrap();
    assert!(survive(&whole, None));
    for length in 0..whole.len() {
        assert!(!survive(&whole[..length], None), "cut after {length} bytes");
    }
    for place in 0..whole.len() {
        for mask in [1, 0x80, 0xFF] {
            let mut bytes = whole.clone();
            bytes[place] ^= mask;
            survive(&bytes, Some(&torus));
        }
    }
    for junk in [&b""[..], b"GSD", &[0; 256], &[0xFF; 5000]] {
        assert!(!survive(junk, None));
    }
}

#[test]
fn a_gsd_file_that_claims_much_is_refused_before_anything_is_allocated() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gsd");
    grown(&path, Format::Gsd, &torus(33.3), 1, 3);
    let whole = fs::read(&path).unwrap();
    // Everywhere in header and index; a chunk or an index of 2⁶³ of anything is not in the file.
    for place in (8..256 + 40 * 32).step_by(8) {
        for number in [u64::MAX, 1 << 63, 1 << 40, 1 << 32] {
            let mut bytes = whole.clone();
            bytes[place..place + 8].copy_from_slice(&number.to_ne_bytes());
            survive(&bytes, None);
        }
    }
    // N = 2³² − 1.
    let mut file = GsdFile::create(&path, "a", "hoomd", (1, 4)).unwrap();
    file.write_scalars("configuration/dimensions", [2_u8]).unwrap();
    file.write_scalars("configuration/box", [8.0_f32, 8.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
    file.write_scalars("particles/N", [u32::MAX]).unwrap();
    file.end_frame().unwrap();
    drop(file);
    let error = read_positions(&path, &torus(8.0)).unwrap_err().to_string();
    assert!(error.contains("4294967295 discs"), "{error}");
}

/// 40 discs that collapse, for a few hundred steps.
const SMALL: &str = "version = 1\nseed = 7\n\
    [system]\nparticles = 40\nbox = 33.3\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 16\n\
    [time]\nuntil = 0.3\n\
    [output]\nobservables = 0.1\ntrajectory = 0.1\nsnapshots = 0\n";

fn program() -> Program {
    Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))
}

#[test]
fn a_run_in_one_format_converted_is_the_run_in_the_other() {
    let program = program();
    program.write("small.toml", SMALL);
    let folder = program.folder();
    for (word, _) in Format::WORDS {
        let set = format!("output.trajectory_format={word}");
        program.succeed(&["run", "small.toml", "--out", word, "--set", &set]);
    }
    let bytes = |name: &str| fs::read(folder.join(name)).unwrap();
    let digest = program.succeed(&["digest", "gsd"]);
    for (from, to) in [
        ("gsd/trajectory.gsd", "xyz/trajectory.xyz"),
        ("gsd/trajectory.gsd", "lammps/trajectory.lammpstrj"),
        ("gsd/trajectory.gsd", "npz/trajectory.npz"),
        ("gsd/trajectory.gsd", "gsd/trajectory.gsd"),
        ("npz/trajectory.npz", "gsd/trajectory.gsd"),
        ("npz/trajectory.npz", "xyz/trajectory.xyz"),
        ("xyz/trajectory.xyz", "xyz/trajectory.xyz"),
        ("lammps/trajectory.lammpstrj", "lammps/trajectory.lammpstrj"),
        ("gsd/final.csv", "npz/final.csv"),
        ("gsd/trajectory.gsd", "gsd/final.csv"),
        ("gsd/trajectory.gsd", "gsd/final.state"),
        ("xyz/trajectory.xyz", "xyz/final.state"),
        ("lammps/trajectory.lammpstrj", "lammps/final.csv"),
    ] {
        let name = format!("converted-{}", to.replace('/', "-"));
        let _ = fs::remove_file(folder.join(&name));
        program.succeed(&["convert", from, &name]);
        assert!(bytes(&name) == bytes(to), "{from} to {to}");
    }
    for name in ["gsd/trajectory.gsd", "xyz/trajectory.xyz", "npz/trajectory.npz"] {
        assert_eq!(program.succeed(&["digest", name]), digest);
    }

    // A frame in the middle is as good as a stop there.
    let said = program.succeed(&["convert", "gsd/trajectory.gsd", "middle.gsd", "--frame", "1"]);
    assert_eq!(said, "middle.gsd: 1 frame\n");
    let go_on = ["--set", "start.kind=file", "--set", "start.path=middle.gsd"];
    program.succeed(&[&["run", "small.toml", "--out", "rest"], &go_on[..]].concat());
    assert_eq!(program.succeed(&["digest", "rest"]), digest);
    let forces = |file: &str| program.succeed(&["forces", "small.toml", "--positions", file]);
    assert_eq!(forces("gsd/trajectory.gsd"), forces("gsd/final.csv"));
}

#[test]
fn mistakes_in_a_conversion_are_told_in_one_line() {
    let program = program();
    let folder = program.folder();
    let at = |name: &str| folder.join(name);
    grown(&at("a.gsd"), Format::Gsd, &torus(33.3), 2, 3);
    fs::write(at("a.csv"), "x,y\n1,2\n").unwrap();
    fs::write(at("torn.gsd"), &fs::read(at("a.gsd")).unwrap()[..5700]).unwrap();
    fs::write(at("junk.npz"), [7; 5000]).unwrap();
    fs::write(at("junk.gsd"), [7; 5000]).unwrap();
    fs::write(at("junk.lammpstrj"), "ITEM: ATOMS\nITEM").unwrap();
    fs::write(at("empty.xyz"), "").unwrap();
    fs::write(at("there.xyz"), "mine").unwrap();
    program.refuse(&["convert", "a.gsd", "there.xyz"], &["there.xyz: this file exists: name another file"]);
    assert_eq!(fs::read(at("there.xyz")).unwrap(), b"mine");
    for (arguments, part) in [
        (&["a.gsd", "b.pdf"][..], "b.pdf: no known ending for positions: use .csv"),
        (&["a.pdf", "b.gsd"], "a.pdf: no known ending"),
        (&["missing.gsd", "b.gsd"], "missing.gsd: cannot be read"),
        (&["a.csv", "b.gsd"], "a.csv: the file does not say how large the box is: give its side, --box L"),
        (&["a.csv", "b.gsd", "--box", "0"], "--box 0"),
        (&["a.csv", "b.gsd", "--box", "1.5"], "a.csv: line 2, column y: found `2`"),
        (
            &["a.gsd", "b.gsd", "--box", "33.4"],
            "a.gsd: found a box of side 33.3, expected the box of side 33.4",
        ),
        (&["a.gsd", "b.xyz", "--frame", "2"], "a.gsd: found 2 frames, expected more than 2"),
        (&["empty.xyz", "b.gsd"], "empty.xyz: found 0 frames, expected at least 1"),
        (
            &["torn.gsd", "b.gsd"],
            "torn.gsd: found a chunk that is not in the file, expected a whole GSD file",
        ),
        (&["junk.gsd", "b.gsd"], "junk.gsd: found bytes of another kind, expected a GSD file"),
        (&["junk.npz", "b.gsd"], "junk.npz: found "),
        (
            &["junk.lammpstrj", "b.gsd"],
            "junk.lammpstrj: line 1: found `ATOMS`, expected columns named x and y",
        ),
    ] {
        program.refuse(&[&["convert"], arguments].concat(), &[part]);
        assert!(!at("b.gsd").exists() && !at("b.xyz").exists(), "nothing half-made is left: {arguments:?}");
    }
    assert_eq!(program.succeed(&["convert", "a.csv", "b.gsd", "--box", "8"]), "b.gsd: 1 frame\n");
    program.refuse(&["digest", "torn.gsd"], &["torn.gsd"]);
}
