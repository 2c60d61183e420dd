//! Chunks: compressed records, unpacked while they are read, of any size.

use std::{
    fmt,
    io::{BufReader, Read},
};

use crc32fast::Hasher;
use lz4_flex::frame::FrameDecoder as Lz4;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

use super::{fields::Fields, section::Section};

/// Bytes of a chunk before the name of its compression: two times, size and checksum.
pub(super) const BEGINNING: usize = 28;

/// Header of a chunk.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChunkHeader {
    /// Unpacked size of its records.
    size: u64,
    /// Checksum of its records; `None` if it was not computed.
    sum: Option<u32>,
}

impl ChunkHeader {
    /// Reads the header from the chunk's first bytes.
    pub(super) fn of(beginning: &[u8; BEGINNING]) -> Option<Self> {
        let mut fields = Fields(&beginning[16..]);
        let size = fields.long()?;
        let sum = fields.word()?;
        Some(Self {
            size,
            sum: (sum != 0).then_some(sum),
        })
    }
}

/// The remaining records of a chunk.
pub(super) struct Chunk {
    input: Unpacking,
    /// Position in the file, for messages.
    pub(super) place: u64,
    header: ChunkHeader,
    /// Number of bytes read.
    position: u64,
    sum: Hasher,
}

/// Decompression of a chunk.
enum Unpacking {
    None(BufReader<Section>),
    Lz4(Box<Lz4<BufReader<Section>>>),
    Zstandard(Box<StreamingDecoder<BufReader<Section>, FrameDecoder>>),
}

impl fmt::Debug for Chunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "chunk at byte {}, {:?}", self.place, self.header)
    }
}

impl Chunk {
    /// Starts a chunk whose records are `input`, with the compression `packing`.
    ///
    /// # Errors
    /// An unsupported compression, or bytes that are not compressed so.
    pub(super) fn new(
        input: BufReader<Section>,
        packing: &str,
        place: u64,
        header: ChunkHeader,
    ) -> Result<Self, String> {
        let input = match packing {
            "" => Unpacking::None(input),
            "lz4" => Unpacking::Lz4(Box::new(Lz4::new(input))),
            "zstd" => {
                let unpacking = StreamingDecoder::new(input);
                let unpacking =
                    unpacking.map_err(|error| format!("it can't be unpacked: {error}"))?;
                Unpacking::Zstandard(Box::new(unpacking))
            }
            other => {
                return Err(format!(
                    "it is compressed by `{other}`, which is not supported"
                ));
            }
        };
        Ok(Self {
            input,
            place,
            header,
            position: 0,
            sum: Hasher::new(),
        })
    }

    /// Number of unread bytes.
    pub(super) const fn left(&self) -> u64 {
        self.header.size - self.position
    }

    /// Fills `bytes`.
    ///
    /// # Errors
    /// Fewer bytes than stated, or bytes that cannot be unpacked.
    pub(super) fn read(&mut self, bytes: &mut [u8]) -> Result<(), String> {
        let count = bytes.len() as u64;
        if count > self.left() {
            return Err(String::from("a record ends after its end"));
        }
        let read = match &mut self.input {
            Unpacking::None(input) => input.read_exact(bytes),
            Unpacking::Lz4(input) => input.read_exact(bytes),
            Unpacking::Zstandard(input) => input.read_exact(bytes),
        };
        read.map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => String::from("it has fewer bytes than declared"),
            _ => format!("it can't be unpacked: {error}"),
        })?;
        self.position += count;
        if self.header.sum.is_some() {
            self.sum.update(bytes);
        }
        Ok(())
    }

    /// Skips some bytes, which still count in the checksum.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(super) fn skip(&mut self, mut count: u64) -> Result<(), String> {
        let mut passed = [0; 4096];
        while count > 0 {
            let now = usize::try_from(count).map_or(passed.len(), |count| count.min(passed.len()));
            self.read(&mut passed[..now])?;
            count -= now as u64;
        }
        Ok(())
    }

    /// Checks the checksum after all bytes have been read.
    ///
    /// # Errors
    /// A wrong checksum.
    pub(super) fn check(&self) -> Result<(), String> {
        match self.header.sum {
            Some(sum) if sum != self.sum.clone().finalize() => Err(String::from(
                "its checksum does not match: some bytes were changed",
            )),
            _ => Ok(()),
        }
    }
}
