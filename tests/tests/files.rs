//! Files: the bits come back, what is wrong is named, and nothing makes a reader panic.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use meniscus::files::extended_xyz::{self, FrameChoice};
use meniscus::files::state::{State, StateError};
use meniscus::files::trajectory::Frame;
use meniscus::files::{FileError, atomic, csv, read_positions};
use meniscus::observables::clusters::Clusters;
use meniscus::start;
use meniscus::strengths::{ONE, all_one};
use meniscus_core::parameters::{LARGEST_PARTICLE_COUNT, LARGEST_STRENGTH};
use meniscus_core::torus::{Position, SMALLEST_SIDE, Torus};
use proptest::prelude::*;
use std::io::Cursor;

fn torus(side: f64) -> Torus {
    Torus::new(side).unwrap()
}

fn any_torus() -> impl Strategy<Value = Torus> {
    prop_oneof![1e-3..65536.0_f64, Just(500.0), Just(65536.0), Just(SMALLEST_SIDE)].prop_map(torus)
}

fn any_positions() -> impl Strategy<Value = Vec<Position>> {
    let bits = || prop_oneof![any::<u32>(), Just(0), Just(u32::MAX), 0..10_u32];
    prop::collection::vec((bits(), bits()).prop_map(|(x, y)| Position::from_bits(x, y)), 0..50)
}

fn frame(positions: &[Position]) -> Frame<'_> {
    Frame { time_step: 0.001, positions, ..Frame::default() }
}

fn frames(torus: &Torus, all: &[Frame<'_>]) -> Vec<u8> {
    let mut text = Vec::new();
    all.iter().for_each(|frame| extended_xyz::write_frame(&mut text, torus, frame).unwrap());
    text
}

fn xyz(torus: &Torus, text: &str) -> Result<State, String> {
    extended_xyz::parse(Cursor::new(text), torus, FrameChoice::Last).map_err(|error| error.to_string())
}

fn table(torus: &Torus, text: &str) -> Result<Vec<Position>, String> {
    csv::parse(text.as_bytes(), torus).map(|state| state.positions).map_err(|error| error.to_string())
}

/// Discs with strengths of which not all are 1.
fn any_discs() -> impl Strategy<Value = (Vec<Position>, Vec<i32>)> {
    let largest = LARGEST_STRENGTH as i32 * ONE;
    let strength = prop_oneof![-largest..=largest, Just(ONE), Just(0), Just(-ONE), Just(largest)];
    (any_positions(), prop::collection::vec(strength, 50))
        .prop_map(|(positions, mut strengths)| {
            strengths.truncate(positions.len());
            (positions, strengths)
        })
        .prop_filter("not all are 1", |(_, strengths)| !all_one(strengths))
}

proptest! {
    #[test]
    fn csv_gives_the_same_bits_again(torus in any_torus(), positions in any_positions()) {
        let text = csv::format(&torus, &positions, &[]);
        prop_assert_eq!(csv::parse(text.as_bytes(), &torus).unwrap(), State::at_start(positions));
    }

    #[test]
    fn strengths_come_back_with_the_same_bits(
        torus in any_torus(), (positions, strengths) in any_discs(), step in any::<u64>(), with_clusters in any::<bool>(),
    ) {
        let state = State { step, time: 1 << 40, positions, strengths: Some(strengths.clone()), ..State::default() };
        let bytes = state.to_bytes();
        prop_assert_eq!(bytes.len(), 32 + 8 * strengths.len() + 12 + 4 * strengths.len());
        prop_assert_eq!(State::from_bytes(&bytes).unwrap(), state.clone());
        let table = csv::format(&torus, &state.positions, &strengths);
        let read = csv::parse(table.as_bytes(), &torus).unwrap();
        prop_assert_eq!((&read.positions, &read.strengths), (&state.positions, &state.strengths));
        let clusters = Clusters::find(&torus, &state.positions);
        let clustered = with_clusters.then_some(&clusters);
        let frame = Frame { step, time: 1 << 40, strengths: &strengths, clustered, ..frame(&state.positions) };
        let text = frames(&torus, &[frame]);
        prop_assert_eq!(extended_xyz::parse(Cursor::new(text), &torus, FrameChoice::Last).unwrap(), state);
    }

    #[test]
    fn a_damaged_state_with_strengths_is_read_or_refused(
        (positions, strengths) in any_discs(), place in any::<prop::sample::Index>(), byte in any::<u8>(),
    ) {
        let state = State { step: 3, time: 4, positions, strengths: Some(strengths), ..State::default() };
        let whole = state.to_bytes();
        let place = place.index(whole.len());
        // Without its section a state is whole.
        let without = 32 + 8 * state.positions.len();
        prop_assert_eq!(State::from_bytes(&whole[..place]).is_err(), place != without);
        let mut bytes = whole.clone();
        bytes.push(byte);
        let end = whole.len() as u64;
        let refused = if byte == b'H' && !state.positions.is_empty() {
            // Held forces may follow.
            let expected = end + 12 + 24 * state.positions.len() as u64;
            StateError::Truncated { found: end + 1, expected }
        } else {
            StateError::Trailing { expected: end }
        };
        prop_assert_eq!(State::from_bytes(&bytes), Err(refused));
        bytes.pop();
        bytes[place] = byte;
        if let Ok(read) = State::from_bytes(&bytes) {
            prop_assert_eq!(read.to_bytes(), bytes);
        }
    }

    #[test]
    fn csv_rows_may_come_in_any_order(positions in any_positions(), turn in any::<prop::sample::Index>()) {
        let torus = torus(500.0);
        let text = csv::format(&torus, &positions, &[]);
        let (names, rows) = text.split_once('\n').unwrap();
        let mut rows: Vec<&str> = rows.lines().collect();
        if !rows.is_empty() {
            let turn = turn.index(rows.len());
            rows.rotate_left(turn);
        }
        rows.reverse();
        let text = format!("{names}\n{}", rows.join("\n"));
        prop_assert_eq!(csv::parse(text.as_bytes(), &torus).unwrap().positions, positions);
    }

    #[test]
    fn extended_xyz_gives_the_same_bits_again(
        torus in any_torus(),
        positions in any_positions(),
        step in any::<u64>(),
        time in 0..1_u64 << 53,
        time_over_jeans in prop::option::of(0.0..1e6_f64),
        with_clusters in any::<bool>(),
    ) {
        let clusters = Clusters::find(&torus, &positions);
        let clustered = with_clusters.then_some(&clusters);
        let frame = Frame { step, time, time_over_jeans, clustered, ..frame(&positions) };
        let text = frames(&torus, &[frame]);
        let state = extended_xyz::parse(Cursor::new(text), &torus, FrameChoice::Last).unwrap();
        prop_assert_eq!(state, State { positions, step, time, ..State::default() });
    }

    #[test]
    fn states_give_the_same_bytes_again(positions in any_positions(), step in any::<u64>(), time in any::<u64>()) {
        let state = State { step, time, positions, ..State::default() };
        let bytes = state.to_bytes();
        prop_assert_eq!(bytes.len(), 32 + 8 * state.positions.len());
        prop_assert_eq!(State::from_bytes(&bytes).unwrap(), state);
    }

    #[test]
    fn states_of_another_length_are_refused(positions in any_positions(), length in 0..500_usize) {
        let mut bytes = State { step: 1, time: 2, positions, ..State::default() }.to_bytes();
        let expected = bytes.len();
        prop_assume!(length != expected);
        bytes.resize(length, 0);
        let error = State::from_bytes(&bytes).unwrap_err();
        match error {
            StateError::Truncated { found, .. } => prop_assert_eq!(found, length as u64),
            StateError::Trailing { expected: said } => prop_assert_eq!(said, expected as u64),
            StateError::Magic => prop_assert_eq!(length, 0),
            _ => prop_assert!(false, "version and number of discs were right: {error}"),
        }
    }

    #[test]
    fn a_state_of_too_many_discs_is_refused_by_its_header(count in LARGEST_PARTICLE_COUNT as u32 + 1..) {
        let mut bytes = State { step: 1, time: 2, ..State::default() }.to_bytes();
        bytes[12..16].copy_from_slice(&count.to_le_bytes());
        prop_assert_eq!(State::from_bytes(&bytes), Err(StateError::Count { found: count }));
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        readers_survive(&bytes);
    }

    #[test]
    fn nearly_right_text_is_read_or_refused(text in "([xyid,#\"\n 0-9.:=TRISe-]|Lattice|Properties|pos|inf|NaN|\n2\n){0,60}") {
        readers_survive(text.as_bytes());
        readers_survive(format!("x,y,id\n{text}").as_bytes());
        readers_survive(format!("2\n{text}").as_bytes());
    }

    #[test]
    fn a_damaged_file_is_read_or_refused(
        positions in any_positions(), place in any::<prop::sample::Index>(), byte in any::<u8>(),
    ) {
        let torus = torus(500.0);
        let state = State { step: 3, time: 4, ..State::at_start(positions.clone()) };
        let whole = [
            csv::format(&torus, &positions, &[]).into_bytes(),
            frames(&torus, &[frame(&positions), frame(&positions)]),
            state.to_bytes(),
        ];
        for mut bytes in whole {
            let place = place.index(bytes.len());
            bytes[place] = byte;
            readers_survive(&bytes);
            readers_survive(&bytes[..place]);
        }
    }
}

/// Hands the bytes to all readers, whatever they say.
fn readers_survive(bytes: &[u8]) {
    let torus = torus(500.0);
    let _ = csv::parse(bytes, &torus);
    let _ = extended_xyz::parse(Cursor::new(bytes), &torus, FrameChoice::Last);
    let _ = extended_xyz::parse(Cursor::new(bytes), &torus, FrameChoice::Number(1));
    let _ = State::from_bytes(bytes);
}

#[test]
fn csv_accepts_comments_other_columns_and_foreign_line_ends() {
    let torus = torus(8.0);
    let expected = [Position::from_bits(1 << 29, 1 << 30), Position::from_bits(1 << 31, 3 << 30)];
    for text in [
        "x,y\n1,2\n4,6\n",
        "x,y\r\n1,2\r\n4,6",
        "\u{feff}x,y\n1,2\n4,6\n",
        "# a\n\n y , x \n# b\n 2 , 1 \n\n6,4\n",
        "\"x\",\"y\"\n\"1\",\"2\"\n4.0e0,6\n",
        "fx,id,y,name,x\n0,1,6,\"a, b\",4\n7,0,2,,1\n",
    ] {
        assert_eq!(table(&torus, text).as_deref(), Ok(&expected[..]), "{text:?}");
    }
}

#[test]
fn csv_says_where_and_what_is_wrong() {
    let torus = torus(8.0);
    for (text, message) in [
        ("", "found no line with the names of the columns, expected id,x,y or x,y in the first line"),
        ("1,2\n", "line 1: found no column x, expected columns named x and y, and perhaps id"),
        ("x,y,x\n", "line 1: found two columns x, expected one"),
        ("x,y\n1,2\n3\n", "line 3: found 1 values, expected at least 2, as the columns named"),
        (
            "x,y\n1,5,2,5\n",
            "line 2: found 4 values, expected 2, as the columns named (decimals have a point)",
        ),
        ("x,y\n1,a\n", "line 2, column y: found `a`, expected a number of R0 in [0, 8)"),
        ("x,y\n-0.1,1\n", "line 2, column x: found `-0.1`, expected a number of R0 in [0, 8)"),
        ("x,y\n8,1\n", "line 2, column x: found `8`, expected a number of R0 in [0, 8)"),
        ("x,y\nNaN,1\n", "line 2, column x: found `NaN`, expected a number of R0 in [0, 8)"),
        ("x,y\n1,inf\n", "line 2, column y: found `inf`, expected a number of R0 in [0, 8)"),
        ("x,y,id\n1,1,-1\n", "line 2, column id: found `-1`, expected a whole number from 0 to 4194303"),
        ("x,y,id\n1,1,0\n2,2,1\n3,3,0\n", "line 4, column id: found 0 a second time, expected each id once"),
        (
            "x,y,id\n1,1,0\n2,2,2\n",
            "found 2 rows without id 1, expected each id from 0 to 1 once, or no column id",
        ),
    ] {
        assert_eq!(table(&torus, text), Err(message.to_owned()), "{text:?}");
    }
}

#[test]
fn strengths_are_read_from_a_column_and_rounded_to_their_unit() {
    let torus = torus(8.0);
    let from_table = |text: &str| csv::parse(text.as_bytes(), &torus).unwrap().strengths;
    let from_frame = |text: &str| xyz(&torus, text).unwrap().strengths;
    // 0.1 is 104857.6 units.
    let expected = Some(vec![-ONE, 104_858, 1000 * ONE]);
    assert_eq!(from_table("strength,x,y,id\n1000,1,1,2\n-1,1,1,0\n0.1,1,1,1\n"), expected);
    let properties = "Properties=id:I:1:strength:R:1:pos:R:3";
    assert_eq!(from_frame(&format!("3\n{properties}\n2 1e3 1 1 0\n0 -1 1 1 0\n1 0.1 1 1 0\n")), expected);
    // Ones are said, and that is not the same as nothing.
    assert_eq!(from_table("x,y,strength\n1,1,1\n"), Some(vec![ONE]));
    assert_eq!(from_table("x,y\n1,1\n"), None);
    // A column of vectors is something else.
    assert_eq!(from_frame("1\nProperties=pos:R:3:strength:R:2\n1 1 1 7 7\n"), None);
    assert_eq!(csv::format(&torus, &[Position::from_bits(0, 0)], &[ONE]), "id,x,y\n0,0,0\n");
    assert_eq!(
        csv::format(&torus, &[Position::from_bits(0, 0)], &[-ONE / 4]),
        "id,x,y,strength\n0,0,0,-0.25\n"
    );
}

#[test]
fn strengths_that_are_none_are_refused() {
    let torus = torus(8.0);
    for value in ["", "one", "nan", "inf", "1000.1", "-1e4"] {
        let message = table(&torus, &format!("x,y,strength\n1,1,{value}\n")).unwrap_err();
        let expected =
            format!("line 2, column strength: found `{value}`, expected a number from -1000 to 1000");
        assert_eq!(message, expected);
    }
    let frame = "1\nProperties=pos:R:3:strength:R:1\n1 1 0 x\n";
    assert_eq!(
        xyz(&torus, frame).unwrap_err(),
        "line 3, column strength: found `x`, expected a number from -1000 to 1000"
    );
    let good = State { strengths: Some(vec![ONE, 2]), ..State::at_start(vec![Position::from_bits(3, 4); 2]) };
    let good = good.to_bytes();
    let with = |place: usize, bytes: &[u8]| {
        let mut changed = good.clone();
        changed[place..place + bytes.len()].copy_from_slice(bytes);
        State::from_bytes(&changed)
    };
    assert_eq!(with(48, b"STRE").unwrap().strengths, Some(vec![ONE, 2]));
    assert_eq!(with(48, b"STRO"), Err(StateError::Trailing { expected: 48 }));
    assert_eq!(with(52, &[9]), Err(StateError::Strengths { found: 9, expected: 8 }));
    assert_eq!(with(64, &ONE.to_le_bytes()), Err(StateError::Ones));
    let beyond = 1000 * ONE + 1;
    assert_eq!(with(64, &beyond.to_le_bytes()), Err(StateError::Strength { id: 1, strength: beyond }));
    assert!(matches!(with(64, &i32::MIN.to_le_bytes()), Err(StateError::Strength { id: 1, .. })));
}

#[test]
fn lines_without_end_are_refused_early() {
    let torus = torus(8.0);
    let longer = |start: &str| format!("{start}{}", "1".repeat(1 << 20));
    for start in ["", "x,y\n", "x,y\n\""] {
        assert!(table(&torus, &longer(start)).unwrap_err().contains("at most 65536 bytes"), "{start:?}");
    }
    for start in ["", "3\n", "1\n\n"] {
        assert!(xyz(&torus, &longer(start)).unwrap_err().contains("at most 65536 bytes"), "{start:?}");
    }
}

#[test]
fn extended_xyz_reads_the_frame_asked_for() {
    let torus = torus(500.0);
    let states: Vec<Vec<Position>> = (1..=3).map(|seed| start::random(&torus, 5, seed).unwrap()).collect();
    let all: Vec<Frame<'_>> =
        (0_u64..).zip(&states).map(|(step, positions)| Frame { step, ..frame(positions) }).collect();
    let text = frames(&torus, &all);
    let read = |choice| extended_xyz::parse(Cursor::new(&text), &torus, choice);
    for (number, positions) in (0_u64..).zip(&states) {
        let state = read(FrameChoice::Number(number)).unwrap();
        assert_eq!((state.step, &state.positions), (number, positions));
    }
    assert_eq!(read(FrameChoice::Last).unwrap().positions, states[2]);
    let error = read(FrameChoice::Number(3)).unwrap_err();
    assert_eq!(error.to_string(), "found 3 frames, expected more than 3");
}

#[test]
fn extended_xyz_reads_foreign_frames() {
    let torus = torus(8.0);
    let expected = vec![Position::from_bits(1 << 29, 1 << 30), Position::from_bits(1 << 31, 3 << 30)];
    for (text, step) in [
        ("2\n\nAr 1 2 0\nAr 4 6 0\n", 0),
        ("2\nProperties=id:I:1:pos:R:2:mass:R:1 step=7\n1 4 6 1\n0 1 2 1\n\n\n", 7),
        (
            "2\nstep=7 Lattice=\"8.0 0 0 0 8 0 0 0 5e0\" a=\"b c=d\" flag e={1 2} Properties=v:R:3:pos:R:3\n9 9 9 1 2 3\n9 9 9 4 6 3",
            7,
        ),
    ] {
        let state = xyz(&torus, text).unwrap();
        assert_eq!((state.positions, state.step), (expected.clone(), step), "{text:?}");
    }
}

#[test]
fn extended_xyz_says_where_and_what_is_wrong() {
    let torus = torus(8.0);
    for (text, message) in [
        ("", "found 0 frames, expected at least one"),
        ("\n\n", "found 0 frames, expected at least one"),
        ("x,y\n", "line 1: found `x,y`, expected the number of discs of a frame"),
        (
            "2\n\nX 1 1 0\n",
            "line 3: found the end after 1 of 2 discs, expected whole frames: cut the last one away",
        ),
        ("1", "line 1: found the end after 0 of 1 discs, expected whole frames: cut the last one away"),
        (
            "1\nLattice=\"9 0 0 0 9 0 0 0 1\"\nX 1 1 0\n",
            "line 2: found Lattice=`9 0 0 0 9 0 0 0 1`, expected the box \"8 0 0 0 8 0 0 0 1\"",
        ),
        (
            "1\nLattice=\"8 1 0 0 8 0 0 0 1\"\nX 1 1 0\n",
            "line 2: found Lattice=`8 1 0 0 8 0 0 0 1`, expected the box \"8 0 0 0 8 0 0 0 1\"",
        ),
        (
            "1\nProperties=species:S:1\nX\n",
            "line 2: found Properties=`species:S:1`, expected name:type:count with pos:R:3",
        ),
        ("1\nstep=-1\nX 1 1 0\n", "line 2: found step=`-1`, expected a whole number"),
        ("1\ntime=-1\nX 1 1 0\n", "line 2: found time=`-1`, expected a time from 0, R0^2/D"),
        ("1\n\nX 1\n", "line 3: found `X 1`, expected at least 3 values, as Properties says"),
        ("1\n\nX 1 8 0\n", "line 3, column y: found `8`, expected a number of R0 in [0, 8)"),
        (
            "1\nProperties=pos:R:3:id:I:1\n1 1 0 1\n",
            "found 1 rows without id 0, expected each id from 0 to 0 once, or no column id",
        ),
    ] {
        assert_eq!(xyz(&torus, text), Err(message.to_owned()), "{text:?}");
    }
}

#[test]
fn state_bytes_are_laid_out_as_documented() {
    let positions = vec![Position::from_bits(0x0403_0201, 0x0807_0605), Position::from_bits(1, 2)];
    let bytes = State { step: 0x11, time: 0x22, ..State::at_start(positions) }.to_bytes();
    let expected: Vec<u8> = [
        &b"MENISCUS"[..],
        &[1, 0, 0, 0, 2, 0, 0, 0],
        &[0x11, 0, 0, 0, 0, 0, 0, 0],
        &[0x22, 0, 0, 0, 0, 0, 0, 0],
        &[1, 2, 3, 4, 1, 0, 0, 0],
        &[5, 6, 7, 8, 2, 0, 0, 0],
    ]
    .concat();
    assert_eq!(bytes, expected);
}

#[test]
fn what_is_no_state_is_told_apart() {
    let good = State { step: 1, time: 2, ..State::at_start(vec![Position::from_bits(3, 4)]) }.to_bytes();
    let changed = |place: usize, byte: u8| {
        let mut bytes = good.clone();
        bytes[place] = byte;
        State::from_bytes(&bytes)
    };
    assert_eq!(changed(0, b'm'), Err(StateError::Magic));
    assert_eq!(changed(8, 2), Err(StateError::Version { found: 2 }));
    assert_eq!(changed(12, 2), Err(StateError::Truncated { found: 40, expected: 48 }));
    assert_eq!(changed(12, 0), Err(StateError::Trailing { expected: 32 }));
    assert_eq!(State::from_bytes(&good[..31]), Err(StateError::Truncated { found: 31, expected: 32 }));
    assert_eq!(State::from_bytes(b""), Err(StateError::Magic));
    // Discs that are not there ask for no memory.
    assert_eq!(changed(14, 7), Err(StateError::Truncated { found: 40, expected: 32 + 8 * 0x0007_0001 }));
    assert_eq!(changed(15, 255), Err(StateError::Count { found: 0xFF00_0001 }));
}

#[test]
fn the_ending_tells_the_format() {
    let folder = tempfile::tempdir().unwrap();
    let torus = torus(500.0);
    let positions = start::random(&torus, 10, 1).unwrap();
    let at = |name: &str| folder.path().join(name);
    let state = State { step: 5, time: 6, ..State::at_start(positions.clone()) };
    csv::write(&at("a.csv"), &torus, &positions, &[]).unwrap();
    state.write(&at("a.state")).unwrap();
    let text = frames(&torus, &[Frame { step: 5, time: 6, ..frame(&positions) }]);
    atomic::write_atomically(&at("a.xyz"), &text).unwrap();
    atomic::write_atomically(&at("a.extxyz"), &text).unwrap();

    let timed = State { step: 5, time: 6, ..State::at_start(positions.clone()) };
    assert_eq!(read_positions(&at("a.csv"), &torus).unwrap(), State { step: 0, time: 0, ..timed.clone() });
    for name in ["a.state", "a.xyz", "a.extxyz"] {
        assert_eq!(read_positions(&at(name), &torus).unwrap(), timed, "{name}");
    }
    for name in ["a.txt", "a", ".csv"] {
        assert!(matches!(read_positions(&at(name), &torus), Err(FileError::Ending { .. })), "{name}");
    }
}

#[test]
fn messages_name_the_file_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let torus = torus(500.0);
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("bad.csv"), "x,y\n1,\"a\tb\n\"\n").unwrap();
    std::fs::write(at("bad.state"), "x,y\n").unwrap();
    std::fs::write(at("latin.xyz"), [b'1', b'\n', 0xE9, b'\n']).unwrap();
    std::fs::create_dir(at("folder.csv")).unwrap();
    for name in ["bad.csv", "bad.state", "latin.xyz", "folder.csv", "missing.csv", "missing.state"] {
        let message = read_positions(&at(name), &torus).unwrap_err().to_string();
        assert!(message.contains(name) && message.lines().count() == 1, "{message}");
    }
}

#[test]
fn a_long_state_file_is_read_no_further_than_it_should_be() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.state");
    let mut bytes = State { step: 1, time: 2, ..State::at_start(vec![Position::from_bits(3, 4)]) }.to_bytes();
    bytes.resize(1 << 20, 7);
    std::fs::write(&path, bytes).unwrap();
    let message = State::read(&path).unwrap_err().to_string();
    assert!(message.ends_with("the state is followed by other bytes: it ends after 40"), "{message}");
}

#[test]
fn a_file_that_cannot_be_written_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.json");
    atomic::write_atomically(&path, b"first").unwrap();
    atomic::write_atomically(&path, b"second").unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"second");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left behind");

    let missing = folder.path().join("missing").join("run.json");
    let error = atomic::write_atomically(&missing, b"x").unwrap_err();
    assert!(matches!(error, FileError::Write { .. }) && error.to_string().contains("run.json"));
    // A folder is in the way.
    std::fs::create_dir(folder.path().join("taken")).unwrap();
    assert!(atomic::write_atomically(&folder.path().join("taken"), b"x").is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "nothing else is left behind");
}
