//! The checksums of header and sections.

use crc32fast::Hasher;

/// The checksum of the header, of which `bytes` are all before it.
pub(super) fn of_header(bytes: &[u8]) -> u32 {
    crc32fast::hash(bytes)
}

/// The checksum of a section without its contents, which follow; `previous` is the checksum before.
pub(super) fn of_section(previous: u32, tag: [u8; 4], length: u64) -> Hasher {
    let mut hasher = Hasher::new();
    hasher.update(&previous.to_le_bytes());
    hasher.update(&tag);
    hasher.update(&length.to_le_bytes());
    hasher
}
