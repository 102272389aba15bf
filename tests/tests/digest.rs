//! The canonical bytes and their digest, against a layout and a hash written here from their definitions.

use meniscus_core::digest::State;
use meniscus_core::engine::Engine;
use meniscus_core::parameters::Parameters;
use meniscus_core::torus::{Fraction, Position};
use meniscus_tests::states::{coordinates, scattered, shuffled, with_ids};
use proptest::prelude::*;

/// The bytes of a state with positions in the order of ids.
fn bytes_by_hand(step: u64, time: u64, discs: &[Position]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut push = |value: u64, length: usize| {
        (0..length).for_each(|place| bytes.push((value >> (8 * place) & 0xFF) as u8));
    };
    // "MENISCUS" read as a little-endian number.
    push(0x5355_4353_494E_454D, 8);
    push(1, 4);
    push(discs.len() as u64, 4);
    push(step, 8);
    push(time, 8);
    discs.iter().for_each(|disc| push(u64::from(disc.x.to_bits()), 4));
    discs.iter().for_each(|disc| push(u64::from(disc.y.to_bits()), 4));
    bytes
}

fn bytes_of(state: &State<'_>) -> Vec<u8> {
    let mut bytes = Vec::new();
    state.write(|piece| bytes.extend_from_slice(piece));
    bytes
}

/// The first 32 bits of the fractional part of `root` of each of the first primes (FIPS 180-4, sections 4.2.2 and
/// 5.3.3), by bisection in integers: `power` 2 or 3 is the root's degree.
fn fractional_roots(count: usize, power: u32) -> Vec<u32> {
    let primes = (2_u128..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0));
    let root = |prime: u128| {
        // Largest r with r^power ≤ prime · 2^(32·power): below 2^(9+32).
        let target = prime << (32 * power);
        let (mut low, mut high) = (0_u128, 1 << 37);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if (0..power).fold(1, |product, _| product * middle) <= target {
                low = middle
            } else {
                high = middle
            }
        }
        low as u32
    };
    primes.take(count).map(root).collect()
}

/// SHA-256 of a byte string in hexadecimal digits (FIPS 180-4, section 6.2).
fn sha256(message: &[u8]) -> String {
    let constants = fractional_roots(64, 3);
    let mut hash = fractional_roots(8, 2);
    let mut padded = message.to_vec();
    padded.push(0x80);
    while padded.len() % 64 != 56 {
        padded.push(0);
    }
    padded.extend_from_slice(&(message.len() as u64 * 8).to_be_bytes());
    for block in padded.chunks_exact(64) {
        let mut schedule: Vec<u32> = block
            .chunks_exact(4)
            .map(|b| b.iter().fold(0, |word, &byte| word << 8 | u32::from(byte)))
            .collect();
        for t in 16..64 {
            let (early, late) = (schedule[t - 15], schedule[t - 2]);
            let sigma_0 = early.rotate_right(7) ^ early.rotate_right(18) ^ (early >> 3);
            let sigma_1 = late.rotate_right(17) ^ late.rotate_right(19) ^ (late >> 10);
            let word =
                sigma_1.wrapping_add(schedule[t - 7]).wrapping_add(sigma_0).wrapping_add(schedule[t - 16]);
            schedule.push(word);
        }
        let mut v = hash.clone();
        for (&word, &constant) in schedule.iter().zip(&constants) {
            let sum_1 = v[4].rotate_right(6) ^ v[4].rotate_right(11) ^ v[4].rotate_right(25);
            let choice = (v[4] & v[5]) ^ (!v[4] & v[6]);
            let first =
                [sum_1, choice, constant, word].iter().fold(v[7], |sum, &term| sum.wrapping_add(term));
            let sum_0 = v[0].rotate_right(2) ^ v[0].rotate_right(13) ^ v[0].rotate_right(22);
            let majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
            v.rotate_right(1);
            v[0] = first.wrapping_add(sum_0).wrapping_add(majority);
            v[4] = v[4].wrapping_add(first);
        }
        hash.iter_mut().zip(v).for_each(|(hash, word)| *hash = hash.wrapping_add(word));
    }
    hash.iter().map(|word| format!("{word:08x}")).collect()
}

#[test]
fn the_hash_written_here_is_sha256() {
    // Test vectors of FIPS 180-2, appendix B.
    assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    assert_eq!(
        sha256(b"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"
    );
}

#[test]
fn the_digest_of_a_known_state_is_known() {
    // By sha256sum of the bytes: magic, version 1, 3 discs, step 7, time 2⁴¹, the x, the y.
    let x = [0x0102_0304, 0, 0xFFFF_FFFF].map(Fraction::from_bits);
    let y = [5, 0x8000_0000, 0xDEAD_BEEF].map(Fraction::from_bits);
    let state = State { step: 7, time: 1 << 41, slots: &[0, 1, 2], x: &x, y: &y, ..State::default() };
    let digest = state.digest();
    assert_eq!(digest.length, 56);
    assert_eq!(digest.to_string(), "8fd0b15ec9682412ca1265889c880e30e597a74a47794231ea9f8db66ba1df6d");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_canonical_bytes_are_as_defined_for_any_storage_order(
        seed in any::<u64>(),
        order in any::<u64>(),
        count in 0_usize..50,
        step in any::<u64>(),
        time in any::<u64>(),
    ) {
        let discs = scattered(seed, count);
        let stored = shuffled(order, &with_ids(&discs));
        let (x, y) = coordinates(&stored.iter().map(|&(_, disc)| disc).collect::<Vec<_>>());
        let mut slots = vec![0; count];
        for (slot, &(id, _)) in (0..).zip(&stored) {
            slots[id as usize] = slot;
        }
        let state = State { step, time, slots: &slots, x: &x, y: &y, ..State::default() };
        let expected = bytes_by_hand(step, time, &discs);
        prop_assert_eq!(bytes_of(&state), expected.clone());
        let digest = state.digest();
        prop_assert_eq!(digest.length, expected.len() as u64);
        prop_assert_eq!(digest.to_string(), sha256(&expected));
        let by_field = state.digest_by_field();
        prop_assert_eq!((by_field.step, by_field.time, by_field.state), (step, time, digest));
        let section = |range: core::ops::Range<usize>| sha256(&expected[range]);
        prop_assert_eq!(by_field.x.to_string(), section(32..32 + 4 * count));
        prop_assert_eq!(by_field.y.to_string(), section(32 + 4 * count..32 + 8 * count));
        prop_assert_eq!((by_field.x.length, by_field.y.length), (4 * count as u64, 4 * count as u64));
    }

    #[test]
    fn every_bit_of_the_state_changes_the_digest(place in 0_usize..32 * 8, bit in 0_u32..32, late in 0_u32..64) {
        let discs = scattered(1, 128);
        let (mut x, mut y) = coordinates(&discs);
        let slots: Vec<u32> = (0..128).collect();
        let digest = State { step: 5, time: 9, slots: &slots, x: &x, y: &y, ..State::default() }.digest();
        let later = State { step: 5 ^ 1 << late, time: 9, slots: &slots, x: &x, y: &y, ..State::default() }.digest();
        prop_assert_ne!(later, digest);
        let later = State { step: 5, time: 9 ^ 1 << late, slots: &slots, x: &x, y: &y, ..State::default() }.digest();
        prop_assert_ne!(later, digest);
        let changed = if place < 128 { &mut x[place] } else { &mut y[place - 128] };
        *changed = Fraction::from_bits(changed.to_bits() ^ 1 << bit);
        let moved = State { step: 5, time: 9, slots: &slots, x: &x, y: &y, ..State::default() }.digest();
        prop_assert_ne!(moved, digest);
    }
}

#[test]
fn the_engines_state_is_its_clock_and_positions() {
    let discs = scattered(3, 20);
    let mut engine = Box::new(Engine::<64, 32>::new());
    engine.init(&Parameters::default(), shuffled(1, &with_ids(&discs))).unwrap();
    assert_eq!(bytes_of(&engine.state()), bytes_by_hand(0, 0, &discs));
    for _ in 0..3 {
        engine.step().unwrap();
    }
    let positions: Vec<Position> = (0..20).map(|id| engine.position(id).unwrap()).collect();
    assert_eq!(bytes_of(&engine.state()), bytes_by_hand(3, engine.clock().time, &positions));
}
