//! From a checkpoint to bytes.

use super::{Checkpoint, FORMAT_VERSION, FRAME_LENGTH, HEADER_LENGTH, MAGIC, Section, checksum};
use std::convert::Infallible;
use std::io::{self, Write};

/// Crossings that are turned into bytes at a time.
const CROSSINGS_AT_A_TIME: usize = 1024;

impl Checkpoint {
    /// Length of the encoded checkpoint, bytes.
    #[must_use]
    pub fn encoded_length(&self) -> u64 {
        let contents: u64 = Section::ORDER.iter().map(|&section| self.length_of(section)).sum();
        contents + (HEADER_LENGTH + Section::ORDER.len() * FRAME_LENGTH) as u64
    }

    /// The bytes of the checkpoint.
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.encoded_length() as usize);
        let Ok(()) = self.write_parts(|part| {
            bytes.extend_from_slice(part);
            Ok::<_, Infallible>(())
        });
        bytes
    }

    /// Writes the bytes of the checkpoint, piece by piece, and flushes.
    ///
    /// # Errors
    /// What `output` says.
    pub fn write_to(&self, mut output: impl Write) -> io::Result<()> {
        self.write_parts(|part| output.write_all(part))?;
        output.flush()
    }

    /// Length of the contents of a section, bytes.
    fn length_of(&self, section: Section) -> u64 {
        let length = match section {
            Section::Configuration => self.configuration.len(),
            Section::State => self.state.len(),
            Section::Crossings => size_of_val(self.crossings.as_slice()),
            Section::Progress => self.progress.len(),
            Section::End => 0,
        };
        length as u64
    }

    /// Hands the bytes to `sink`, part after part.
    fn write_parts<E>(&self, mut sink: impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
        let mut header = Vec::with_capacity(HEADER_LENGTH);
        header.extend_from_slice(&MAGIC);
        header.extend_from_slice(&FORMAT_VERSION.to_le_bytes());
        header.extend_from_slice(&self.encoded_length().to_le_bytes());
        let mut check = checksum::of_header(&header);
        header.extend_from_slice(&check.to_le_bytes());
        sink(&header)?;
        for section in Section::ORDER {
            let (tag, length) = (section.tag(), self.length_of(section));
            let mut hasher = checksum::of_section(check, tag, length);
            sink(&tag)?;
            sink(&length.to_le_bytes())?;
            self.write_contents(section, |part| {
                hasher.update(part);
                sink(part)
            })?;
            check = hasher.finalize();
            sink(&check.to_le_bytes())?;
        }
        Ok(())
    }

    /// Hands the contents of a section to `sink`.
    fn write_contents<E>(
        &self,
        section: Section,
        mut sink: impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        match section {
            Section::Configuration => sink(self.configuration.as_bytes()),
            Section::State => sink(&self.state),
            Section::Crossings => self.crossings.chunks(CROSSINGS_AT_A_TIME).try_for_each(|chunk| {
                let bytes: Vec<u8> =
                    chunk.as_flattened().iter().flat_map(|count| count.to_le_bytes()).collect();
                sink(&bytes)
            }),
            Section::Progress => sink(self.progress.as_bytes()),
            Section::End => Ok(()),
        }
    }
}
