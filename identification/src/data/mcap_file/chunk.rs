//! Chunks: records that are packed together, unpacked while they are read, whatever their size.

use std::{
    fmt,
    io::{BufReader, Read},
};

use crc32fast::Hasher;
use lz4_flex::frame::FrameDecoder as Lz4;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

use super::{fields::Fields, section::Section};

/// Bytes before a chunk's packing is named: two times, its size and its checksum.
pub(super) const BEGINNING: usize = 28;

/// What a chunk says of itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Said {
    /// Bytes of its records when they are unpacked.
    size: u64,
    /// Their checksum; none where it was not computed.
    sum: Option<u32>,
}

impl Said {
    /// Reads it from the chunk's first bytes.
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

/// The records of a chunk that have not been read.
pub(super) struct Chunk {
    input: Unpacking,
    /// Where it stands in the file, for messages.
    pub(super) place: u64,
    said: Said,
    /// Bytes that have been read.
    position: u64,
    sum: Hasher,
}

/// How the bytes of a chunk are unpacked.
enum Unpacking {
    None(BufReader<Section>),
    Lz4(Box<Lz4<BufReader<Section>>>),
    Zstandard(Box<StreamingDecoder<BufReader<Section>, FrameDecoder>>),
}

impl fmt::Debug for Chunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "chunk at byte {}, {:?}", self.place, self.said)
    }
}

impl Chunk {
    /// Begins a chunk whose records are `input`, packed as `packing` says.
    ///
    /// # Errors
    /// A packing that is not read, or bytes that are not packed so.
    pub(super) fn new(
        input: BufReader<Section>,
        packing: &str,
        (place, said): (u64, Said),
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
            other => return Err(format!("it is packed by `{other}`, which is not read")),
        };
        Ok(Self {
            input,
            place,
            said,
            position: 0,
            sum: Hasher::new(),
        })
    }

    /// Bytes that have not been read.
    pub(super) const fn left(&self) -> u64 {
        self.said.size - self.position
    }

    /// Reads as many bytes as `bytes` has.
    ///
    /// # Errors
    /// Fewer bytes than the chunk says, or such that can't be unpacked.
    pub(super) fn read(&mut self, bytes: &mut [u8]) -> Result<(), String> {
        let count = bytes.len() as u64;
        if count > self.left() {
            return Err(String::from("a record ends behind its end"));
        }
        let read = match &mut self.input {
            Unpacking::None(input) => input.read_exact(bytes),
            Unpacking::Lz4(input) => input.read_exact(bytes),
            Unpacking::Zstandard(input) => input.read_exact(bytes),
        };
        read.map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => String::from("it has fewer bytes than it says"),
            _ => format!("it can't be unpacked: {error}"),
        })?;
        self.position += count;
        if self.said.sum.is_some() {
            self.sum.update(bytes);
        }
        Ok(())
    }

    /// Passes over some bytes, which count in the checksum like all others.
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

    /// Checks the sum of all bytes, when they have been read.
    ///
    /// # Errors
    /// Another sum than the chunk says.
    pub(super) fn check(&self) -> Result<(), String> {
        match self.said.sum {
            Some(sum) if sum != self.sum.clone().finalize() => Err(String::from(
                "its checksum is another one: some bytes were changed",
            )),
            _ => Ok(()),
        }
    }
}
