//! Checkpoints: what is written comes back, every damage is found, and the older generation is then used.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use meniscus::checkpoint::{Checkpoint, CheckpointError, FORMAT_VERSION, Section, store};
use meniscus::files::state::State;
use meniscus_core::refresh::HeldForce;
use meniscus_core::torus::Position;
use meniscus_tests::checkpoints::{HEADER, file, repair, sections};
use meniscus_tests::long_tests;
use meniscus_tests::reference::RandomNumbers;
use meniscus_tests::states::scattered;
use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::iter;
use std::ops::Range;
use std::path::Path;

/// A checkpoint of `count` discs with strengths and held forces, every number of it different.
fn checkpoint(step: u64, count: usize) -> Checkpoint {
    let mut random = RandomNumbers::new(step);
    let positions = scattered(step, count);
    let held = |&reference: &Position| HeldForce { reference, force: (-3, 7 << 20) };
    let state = State {
        step,
        time: step << 30,
        strengths: Some((1..).take(count).map(|strength| -strength).collect()),
        held: Some(positions.iter().map(held).collect()),
        positions,
    };
    let mut crossing = || random.bits() as i32;
    Checkpoint {
        configuration: format!("version = 1\nseed = {step}\n# \u{3bb} and L in R\u{2080}\n"),
        state: state.to_bytes(),
        crossings: (0..count).map(|_| [crossing(), crossing()]).collect(),
        progress: format!("rows = {step}\nframes = 3\n"),
    }
}

/// The contents of a checkpoint as they stand in a file.
fn contents(checkpoint: &Checkpoint) -> [([u8; 4], Vec<u8>); 5] {
    let crossings = checkpoint.crossings.iter().flatten().flat_map(|count| count.to_le_bytes());
    [
        (*b"CONF", checkpoint.configuration.clone().into_bytes()),
        (*b"STAT", checkpoint.state.clone()),
        (*b"CROS", crossings.collect()),
        (*b"PROG", checkpoint.progress.clone().into_bytes()),
        (*b"END.", Vec::new()),
    ]
}

/// The file of these sections.
fn file_of(version: u32, sections: &[([u8; 4], Vec<u8>)]) -> Vec<u8> {
    let sections: Vec<([u8; 4], &[u8])> =
        sections.iter().map(|(tag, contents)| (*tag, contents.as_slice())).collect();
    file(version, &sections)
}

/// Why bytes are refused, which must be said in one line of ASCII.
#[track_caller]
fn refusal(bytes: &[u8]) -> String {
    let message = Checkpoint::decode(bytes).unwrap_err().to_string();
    assert!(message.is_ascii() && !message.contains('\n') && message.len() > 20, "{message}");
    message
}

#[test]
fn the_bytes_are_those_documented() {
    for count in [0, 1, 5, 3000] {
        let checkpoint = checkpoint(9, count);
        let bytes = checkpoint.encode();
        assert_eq!(bytes, file_of(FORMAT_VERSION, &contents(&checkpoint)));
        assert_eq!(checkpoint.encoded_length(), bytes.len() as u64);
        let mut written = Vec::new();
        checkpoint.write_to(&mut written).unwrap();
        assert_eq!(written, bytes);
        assert_eq!(Checkpoint::decode(&bytes).unwrap(), checkpoint);
        assert_eq!(checkpoint.step(), 9);
    }
}

#[test]
fn every_flipped_bit_is_found() {
    let mut bytes = checkpoint(5, 4).encode();
    for place in 0..bytes.len() {
        for bit in 0..8 {
            bytes[place] ^= 1 << bit;
            refusal(&bytes);
            bytes[place] ^= 1 << bit;
        }
    }
    assert!(Checkpoint::decode(&bytes).is_ok());
}

#[test]
fn every_byte_of_another_value_is_found() {
    let mut bytes = checkpoint(5, 2).encode();
    for place in 0..bytes.len() {
        for change in 1..=u8::MAX {
            bytes[place] ^= change;
            assert!(Checkpoint::decode(&bytes).is_err(), "byte {place} ^ {change}");
            bytes[place] ^= change;
        }
    }
}

#[test]
fn every_cut_and_every_addition_is_found() {
    let bytes = checkpoint(5, 40).encode();
    for length in 0..bytes.len() {
        let message = refusal(&bytes[..length]);
        assert!(
            message.starts_with(&format!("the checkpoint is cut off: found {length} bytes")),
            "{message}"
        );
        let mut repaired = bytes[..length].to_vec();
        repair(&mut repaired);
        refusal(&repaired);
    }
    for more in [&[0][..], b"END.", &bytes] {
        let mut longer = [&bytes[..], more].concat();
        let message = refusal(&longer);
        assert!(message.starts_with("the checkpoint is followed by other bytes: found"), "{message}");
        repair(&mut longer);
        refusal(&longer);
    }
}

#[test]
fn sections_exchanged_doubled_or_missing_are_found() {
    let checkpoint = checkpoint(5, 3);
    let bytes = checkpoint.encode();
    let parts = sections(&bytes);
    let whole: Vec<usize> = (0..parts.len()).collect();
    let contents = contents(&checkpoint);
    // As they are in the file, with only the header made right; and written anew with right checksums.
    let refused = |order: &[usize]| {
        let places = order.iter().flat_map(|&index| bytes[parts[index].clone()].to_vec());
        let mut spliced: Vec<u8> = bytes[..HEADER].iter().copied().chain(places).collect();
        refusal(&spliced);
        let length = spliced.len() as u64;
        spliced[12..20].copy_from_slice(&length.to_le_bytes());
        refusal(&spliced);
        let sections: Vec<_> = order.iter().map(|&index| contents[index].clone()).collect();
        refusal(&file_of(FORMAT_VERSION, &sections));
    };
    for index in 0..whole.len() {
        refused(&[&whole[..index], &whole[index + 1..]].concat());
        refused(&[&whole[..=index], &whole[index..]].concat());
        for other in 0..index {
            let mut order = whole.clone();
            order.swap(index, other);
            refused(&order);
        }
    }
}

#[test]
fn a_section_of_another_checkpoint_does_not_fit() {
    let [bytes, other] = [checkpoint(5, 3), checkpoint(6, 3)].map(|checkpoint| checkpoint.encode());
    for section in &sections(&bytes)[..4] {
        let mut mixed = bytes.clone();
        mixed[section.clone()].copy_from_slice(&other[section.clone()]);
        let message = refusal(&mixed);
        assert!(message.contains("is damaged: found checksum"), "{message}");
    }
}

#[test]
fn another_version_is_named_with_what_to_do() {
    let sections = contents(&checkpoint(5, 3));
    for version in [0, 2, u32::MAX] {
        assert_eq!(
            refusal(&file_of(version, &sections)),
            format!(
                "the checkpoint has format version {version}, this program reads 1: resume with the program that wrote it"
            )
        );
    }
    let mut unknown = sections.to_vec();
    unknown.insert(3, (*b"MOON", vec![1, 2, 3]));
    let message = refusal(&file_of(FORMAT_VERSION, &unknown));
    assert!(message.contains("found a section `MOON`, expected progress (PROG)"), "{message}");
    assert!(message.contains("format version 1 has it") && message.contains("the program that wrote it"));
}

#[test]
fn contents_that_make_no_sense_are_refused_in_spite_of_their_checksums() {
    let checkpoint = checkpoint(5, 3);
    let refused = |index: usize, bytes: &[u8], expected: &str| {
        let mut sections = contents(&checkpoint);
        sections[index].1 = bytes.to_vec();
        let message = refusal(&file_of(FORMAT_VERSION, &sections));
        assert!(message.contains(expected), "{message}");
    };
    refused(0, b"\xFF", "the configuration (CONF): found bytes that are no UTF-8");
    refused(3, b"a\xC3", "the progress (PROG): found bytes that are no UTF-8");
    refused(1, b"", "the state (STAT): not a state file");
    refused(1, &checkpoint.state[1..], "the state (STAT): not a state file");
    refused(1, &checkpoint.state[..50], "the state (STAT): the state is cut off: 50 bytes of 56");
    refused(2, &[0; 16], "the crossings (CROS): found 16 bytes, expected 24");
    refused(2, &[0; 25], "the crossings (CROS): found 25 bytes, expected 24");
    refused(4, &[0], "the end mark (END.) from byte");
}

#[test]
fn lengths_beyond_the_file_are_refused_without_asking_for_memory() {
    let bytes = checkpoint(5, 3).encode();
    for section in sections(&bytes) {
        for length in [u64::MAX, u64::MAX - 16, 1 << 60, 1 << 40, bytes.len() as u64] {
            let mut longer = bytes.clone();
            longer[section.start + 4..section.start + 12].copy_from_slice(&length.to_le_bytes());
            repair(&mut longer);
            let message = refusal(&longer);
            assert!(message.contains(&format!("found a length of {length} bytes, at most")), "{message}");
        }
    }
    // An input that ends before its length says so.
    let short = Checkpoint::read_from(&bytes[..60], bytes.len() as u64);
    assert!(matches!(short, Err(CheckpointError::Truncated { found: 60, .. })), "{short:?}");
}

/// A checkpoint file that is flipped bit by bit and looked at in its directory.
struct Flipped {
    folder: tempfile::TempDir,
    file: File,
    /// The header and the sections, with their bytes.
    regions: Vec<(String, Range<usize>)>,
    length: usize,
}

impl Flipped {
    /// One of `count` discs at step 2, with an older one of a few at step 1.
    fn new(count: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        store::store(folder.path(), &checkpoint(1, 10)).unwrap();
        store::store(folder.path(), &checkpoint(2, count)).unwrap();
        let path = folder.path().join(store::CURRENT);
        let bytes = fs::read(&path).unwrap();
        let names = Section::ORDER.map(|section| format!("{section:?}"));
        Self {
            file: OpenOptions::new().read(true).write(true).open(path).unwrap(),
            regions: iter::once(("Header".to_owned(), 0..HEADER))
                .chain(names.into_iter().zip(sections(&bytes)))
                .collect(),
            length: bytes.len(),
            folder,
        }
    }

    /// Flips one bit of a byte, back if it was flipped.
    fn flip(&mut self, place: usize, bit: u32) {
        let mut byte = [0];
        let place = SeekFrom::Start(place as u64);
        self.file.seek(place).unwrap();
        self.file.read_exact(&mut byte).unwrap();
        self.file.seek(place).unwrap();
        self.file.write_all(&[byte[0] ^ (1 << bit)]).unwrap();
    }

    /// Whether the damage is found, the older checkpoint used, and both said.
    fn found(&self) -> bool {
        let Ok(latest) = store::latest(self.folder.path()) else { return false };
        let warnings: Vec<String> = latest.warnings().collect();
        let named = |name: &str| self.folder.path().join(name).display().to_string();
        let (begin, end) = (named(store::CURRENT), named(store::PREVIOUS));
        latest.checkpoint.step() == 1
            && latest.path == self.folder.path().join(store::PREVIOUS)
            && warnings.len() == 1
            && warnings[0].starts_with(&format!("{begin}: "))
            && warnings[0].ends_with(&format!("; {end} (step 1) is used instead"))
    }
}

#[test]
fn random_flips_of_a_large_checkpoint_are_found_and_the_older_one_used() {
    let (count, flips) = if long_tests() { (20_000, 100_000) } else { (2_000, 2_000) };
    let mut flipped = Flipped::new(count);
    let mut random = RandomNumbers::new(17);
    let mut below = |most: usize| ((u128::from(random.bits()) * most as u128) >> 64) as usize;
    let mut table = vec![[0, 0]; flipped.regions.len()];
    for index in 0..flips {
        // Every other one anywhere, the rest evenly among sections, most of which are short.
        let place = if index % 2 == 0 {
            below(flipped.length)
        } else {
            let range = flipped.regions[below(flipped.regions.len())].1.clone();
            range.start + below(range.len())
        };
        let bit = below(8) as u32;
        flipped.flip(place, bit);
        let found = flipped.found();
        flipped.flip(place, bit);
        let region = flipped.regions.iter().position(|(_, range)| range.contains(&place)).unwrap();
        table[region][usize::from(found)] += 1;
    }
    println!("{} bytes, {count} discs\n| Section | Bytes | Flips | Detected | Undetected |", flipped.length);
    println!("|---|---|---|---|---|");
    for ((region, range), [undetected, detected]) in flipped.regions.iter().zip(&table) {
        println!("| {region} | {} | {} | {detected} | {undetected} |", range.len(), detected + undetected);
    }
    let [undetected, detected] = [0, 1].map(|found| table.iter().map(|row| row[found]).sum::<usize>());
    println!("| all | {} | {flips} | {detected} | {undetected} |", flipped.length);
    assert_eq!((detected, undetected), (flips, 0));
    assert_eq!(store::latest(flipped.folder.path()).unwrap().checkpoint.step(), 2);
}

/// A directory with these files.
fn directory(files: &[(&str, &[u8])]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    folder
}

/// The message of a directory without a usable checkpoint, its path left out.
fn nothing_left(folder: &Path) -> String {
    let message = store::latest(folder).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message.replace(&folder.display().to_string(), "DIR")
}

#[test]
fn a_directory_without_a_usable_checkpoint_says_why() {
    assert_eq!(
        nothing_left(directory(&[("final.csv", b"")]).path()),
        "DIR: found no checkpoint and no checkpoint.previous, expected the directory of a run that wrote one: begin \
         the run anew"
    );
    let damaged = directory(&[(store::CURRENT, b"MENISCHK"), (store::PREVIOUS, b"x")]);
    assert_eq!(
        nothing_left(damaged.path()),
        "DIR/checkpoint: the checkpoint is cut off: found 8 bytes, expected 24; DIR/checkpoint.previous: not a \
         checkpoint: it does not begin with MENISCHK: no checkpoint is left: begin the run anew in another directory"
    );
}

#[test]
fn a_run_that_a_newer_program_took_on_is_not_set_back() {
    let newer = file_of(2, &contents(&checkpoint(2, 3)));
    let older = checkpoint(1, 3).encode();
    let folder = directory(&[(store::CURRENT, &newer), (store::PREVIOUS, &older)]);
    assert_eq!(
        nothing_left(folder.path()),
        "DIR/checkpoint: the checkpoint has format version 2, this program reads 1: resume with the program that \
         wrote it"
    );
}

#[test]
fn a_damaged_checkpoint_does_not_displace_a_whole_one() {
    let folder = directory(&[(store::CURRENT, b"junk"), (store::PREVIOUS, &checkpoint(1, 3).encode())]);
    store::store(folder.path(), &checkpoint(2, 3)).unwrap();
    fs::remove_file(folder.path().join(store::CURRENT)).unwrap();
    let latest = store::latest(folder.path()).unwrap();
    assert_eq!((latest.checkpoint, latest.refused.len()), (checkpoint(1, 3), 0));
}

#[test]
fn what_cannot_be_stored_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let error = store::store(&folder.path().join("gone"), &checkpoint(1, 3)).unwrap_err().to_string();
    assert!(error.contains("gone/checkpoint: cannot be written: "), "{error}");

    store::store(folder.path(), &checkpoint(1, 3)).unwrap();
    // A directory in the way of the partial file, as nothing else that keeps even the superuser out.
    fs::create_dir_all(folder.path().join(store::PARTIAL).join("inside")).unwrap();
    assert!(store::store(folder.path(), &checkpoint(2, 3)).is_err());
    assert!(store::remove_partial(folder.path()).is_err());
    assert_eq!(store::latest(folder.path()).unwrap().checkpoint, checkpoint(1, 3));

    fs::remove_dir_all(folder.path().join(store::PARTIAL)).unwrap();
    fs::write(folder.path().join(store::PARTIAL), "half").unwrap();
    store::remove_partial(folder.path()).unwrap();
    store::remove_partial(folder.path()).unwrap();
    assert!(!folder.path().join(store::PARTIAL).exists());
}
