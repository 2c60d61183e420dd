//! A section of a file as a reader of its own, for records in chunks and chunks in the file.

use std::{
    fs::File,
    io::{BufReader, Read, Result, Seek, SeekFrom},
    sync::Arc,
};

/// Buffer size in bytes.
const BUFFER: usize = 1 << 16;

/// Bytes of a file, from a position to an end.
#[derive(Debug)]
pub(super) struct Section {
    file: Arc<File>,
    position: u64,
    end: u64,
}

impl Section {
    /// A buffered reader of the bytes from `start` to `end`.
    pub(super) fn buffered(file: &Arc<File>, start: u64, end: u64) -> BufReader<Self> {
        let section = Self {
            file: Arc::clone(file),
            position: start,
            end,
        };
        BufReader::with_capacity(BUFFER, section)
    }
}

impl Read for Section {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let left = self.end.saturating_sub(self.position);
        let most = usize::try_from(left).map_or(buffer.len(), |left| left.min(buffer.len()));
        // Sections share the file and thus its read position.
        let mut file = &*self.file;
        file.seek(SeekFrom::Start(self.position))?;
        let count = file.read(&mut buffer[..most])?;
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for Section {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let position = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::Current(step) => self.position.checked_add_signed(step),
            SeekFrom::End(step) => self.end.checked_add_signed(step),
        };
        self.position = position.ok_or(std::io::ErrorKind::InvalidInput)?;
        Ok(self.position)
    }
}
