//! Checkpoint files put together by hand from the documented layout; no code is shared with what reads and writes them.
//!
//! ```
//! use meniscus_tests::checkpoints::{crc_32, file};
//!
//! // The check value of the catalogues of CRCs.
//! assert_eq!(crc_32(b"123456789"), 0xCBF4_3926);
//! assert_eq!(file(1, &[(*b"END.", b"")]).len(), 24 + 16);
//! ```

/// Length of the header, bytes.
pub const HEADER: usize = 24;

/// The CRC-32 of zip and PNG, bit by bit.
pub fn crc_32(bytes: &[u8]) -> u32 {
    let next = |remainder: u32| (remainder >> 1) ^ (0xEDB8_8320 * (remainder & 1));
    let add = |remainder: u32, &byte: &u8| (0..8).fold(remainder ^ u32::from(byte), |value, _| next(value));
    !bytes.iter().fold(u32::MAX, add)
}

/// A file of this version with these sections, tags and contents, whose lengths and checksums are right.
pub fn file(version: u32, sections: &[([u8; 4], &[u8])]) -> Vec<u8> {
    let mut bytes = vec![0; HEADER];
    bytes[..8].copy_from_slice(b"MENISCHK");
    bytes[8..12].copy_from_slice(&version.to_le_bytes());
    for (tag, contents) in sections {
        bytes.extend_from_slice(tag);
        bytes.extend_from_slice(&(contents.len() as u64).to_le_bytes());
        bytes.extend_from_slice(contents);
        bytes.extend_from_slice(&[0; 4]);
    }
    repair(&mut bytes);
    bytes
}

/// The sections of `bytes` from first to last byte, as far as their lengths are possible.
pub fn sections(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut sections = Vec::new();
    let mut begin = HEADER;
    while let Some(length) = bytes.get(begin + 4..).and_then(<[u8]>::first_chunk) {
        let end = u64::from_le_bytes(*length).saturating_add(begin as u64 + 16);
        if end > bytes.len() as u64 {
            break;
        }
        sections.push(begin..end as usize);
        begin = end as usize;
    }
    sections
}

/// Makes the header's length and every checksum right, as far as there are sections.
pub fn repair(bytes: &mut [u8]) {
    if bytes.len() < HEADER {
        return;
    }
    let length = bytes.len() as u64;
    bytes[12..20].copy_from_slice(&length.to_le_bytes());
    let mut check = crc_32(&bytes[..20]);
    bytes[20..HEADER].copy_from_slice(&check.to_le_bytes());
    for section in sections(bytes) {
        let place = section.end - 4;
        let covered = [&check.to_le_bytes(), &bytes[section.start..place]].concat();
        check = crc_32(&covered);
        bytes[place..section.end].copy_from_slice(&check.to_le_bytes());
    }
}
