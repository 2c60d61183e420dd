//! Records of a file in sequence, including those in chunks: topics and messages.
//!
//! A record has a kind, a length and its bytes. The library `mcap` is not used for two reasons. It
//! keeps every record in memory, such as camera images and large chunks. Its decompression needs
//! two C libraries.

use std::{
    fs::File,
    io::{BufReader, Read},
    sync::Arc,
};

use super::{
    chunk::{self, Chunk, ChunkHeader},
    fields::Fields,
    section::Section,
};
use crate::problems::legible;

/// Magic bytes at the start and the end of every file.
pub(super) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Kinds of records.
pub(super) const FOOTER: u8 = 2;
pub(super) const SCHEMA: u8 = 3;
pub(super) const CHANNEL: u8 = 4;
pub(super) const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;
const DATA_END: u8 = 15;

/// Bytes of a record's header: its kind and its length.
const HEADER: u64 = 9;

/// Bytes of a message's header: channel, number and two times.
const MESSAGE_HEADER: u64 = 22;

/// Largest record kept: some ten thousand joints, or a long message definition.
const LARGEST: u64 = 1 << 22;

/// Largest length of a compression name.
const LONGEST_PACKING: u32 = 64;

/// A record that has been read.
pub(super) enum Record {
    Schema,
    Channel,
    /// Channel and recording time (ns) of a message; its content only for requested channels.
    Message(u16, u64),
}

/// The remaining records of a file.
#[derive(Debug)]
pub(super) struct Records {
    file: Arc<File>,
    input: BufReader<Section>,
    position: u64,
    end: u64,
    chunk: Option<Chunk>,
}

impl Records {
    /// Records from `start` to `end`.
    pub(super) fn new(file: &Arc<File>, start: u64, end: u64) -> Self {
        Self {
            file: Arc::clone(file),
            input: Section::buffered(file, start, end),
            position: start,
            end,
            chunk: None,
        }
    }

    /// Number of bytes of the file read so far.
    pub(super) const fn position(&self) -> u64 {
        self.position
    }

    /// Reads the next schema, channel or message; `None` at the end.
    ///
    /// Its content is written to `content`, that of a message only if `wants` accepts its channel.
    ///
    /// # Errors
    /// A description of the defect and its position.
    pub(super) fn next(
        &mut self,
        content: &mut Vec<u8>,
        wants: &dyn Fn(u16) -> bool,
    ) -> Result<Option<Record>, String> {
        loop {
            let Some(chunk) = &mut self.chunk else {
                match self.outside(content, wants)? {
                    Outside::Record(record) => return Ok(Some(record)),
                    Outside::Other => continue,
                    Outside::End => return Ok(None),
                }
            };
            let place = chunk.place;
            let inside = if chunk.left() == 0 {
                let checked = chunk.check();
                self.chunk = None;
                checked.map(|()| None)
            } else {
                inside(chunk, content, wants)
            };
            let inside =
                inside.map_err(|why| format!("the chunk at byte {place} is broken: {why}"));
            if let Some(record) = inside? {
                return Ok(Some(record));
            }
        }
    }

    /// Reads the next record outside of chunks.
    fn outside(
        &mut self,
        content: &mut Vec<u8>,
        wants: &dyn Fn(u16) -> bool,
    ) -> Result<Outside, String> {
        if self.position == self.end {
            return Ok(Outside::End);
        }
        let place = self.position;
        let mut header = [0; HEADER as usize];
        self.read(&mut header)?;
        let (kind, length) = kind_and_length(header);
        if length > self.end - self.position {
            return Err(format!(
                "the record at byte {place} ends after the end of the file"
            ));
        }
        match kind {
            SCHEMA | CHANNEL => {
                self.keep(length, content)?;
                let record = if kind == SCHEMA {
                    Record::Schema
                } else {
                    Record::Channel
                };
                return Ok(Outside::Record(record));
            }
            MESSAGE if length >= MESSAGE_HEADER => {
                let mut header = [0; MESSAGE_HEADER as usize];
                self.read(&mut header)?;
                let (channel, time) = channel_and_time(&header);
                if wants(channel) {
                    self.keep(length - MESSAGE_HEADER, content)?;
                } else {
                    self.pass(length - MESSAGE_HEADER)?;
                }
                return Ok(Outside::Record(Record::Message(channel, time)));
            }
            MESSAGE => return Err(format!("the message at byte {place} is truncated")),
            CHUNK => {
                let chunk = self.begin(place, length);
                self.chunk = Some(
                    chunk.map_err(|why| format!("the chunk at byte {place} is broken: {why}"))?,
                );
            }
            DATA_END | FOOTER => return Ok(Outside::End),
            _ => self.pass(length)?,
        }
        Ok(Outside::Other)
    }

    /// Starts a chunk of `length` bytes, and skips it in the file.
    fn begin(&mut self, place: u64, length: u64) -> Result<Chunk, String> {
        let cut_off = || String::from("it is truncated");
        let end = self.position + length;
        let mut beginning = [0; chunk::BEGINNING];
        let mut word = [0; 4];
        let before = beginning.len() as u64 + 4;
        if length < before {
            return Err(cut_off());
        }
        self.read(&mut beginning)?;
        self.read(&mut word)?;
        let name = u32::from_le_bytes(word);
        if name > LONGEST_PACKING || u64::from(name) + 8 > length - before {
            return Err(cut_off());
        }
        let mut packing = vec![0; name as usize];
        self.read(&mut packing)?;
        let mut size = [0; 8];
        self.read(&mut size)?;
        let size = u64::from_le_bytes(size);
        let start = self.position;
        if size > end - start {
            return Err(cut_off());
        }
        let header = ChunkHeader::of(&beginning).ok_or_else(cut_off)?;
        self.pass(end - start)?;
        let input = Section::buffered(&self.file, start, start + size);
        let packing = legible(&String::from_utf8_lossy(&packing));
        Chunk::new(input, &packing, place, header)
    }

    fn read(&mut self, bytes: &mut [u8]) -> Result<(), String> {
        let read = self.input.read_exact(bytes);
        read.map_err(|_| format!("the record at byte {} is truncated", self.position))?;
        self.position += bytes.len() as u64;
        Ok(())
    }

    /// Reads the next bytes into `content`.
    fn keep(&mut self, length: u64, content: &mut Vec<u8>) -> Result<(), String> {
        content.resize(kept(length)?, 0);
        self.read(content)
    }

    /// Skips the next bytes, which are within the file.
    fn pass(&mut self, length: u64) -> Result<(), String> {
        let step = i64::try_from(length).map_err(|error| error.to_string())?;
        let passed = self.input.seek_relative(step);
        passed.map_err(|error| error.to_string())?;
        self.position += length;
        Ok(())
    }
}

/// A record outside of chunks.
enum Outside {
    Record(Record),
    Other,
    End,
}

/// Reads the next record of a chunk; `None` if its kind is not requested.
fn inside(
    chunk: &mut Chunk,
    content: &mut Vec<u8>,
    wants: &dyn Fn(u16) -> bool,
) -> Result<Option<Record>, String> {
    let mut header = [0; HEADER as usize];
    chunk.read(&mut header)?;
    let (kind, length) = kind_and_length(header);
    if length > chunk.left() {
        return Err(String::from("a record ends after its end"));
    }
    let mut keep = |chunk: &mut Chunk, length: u64| {
        content.resize(kept(length)?, 0);
        chunk.read(content)
    };
    match kind {
        SCHEMA => keep(chunk, length).map(|()| Some(Record::Schema)),
        CHANNEL => keep(chunk, length).map(|()| Some(Record::Channel)),
        MESSAGE if length >= MESSAGE_HEADER => {
            let mut header = [0; MESSAGE_HEADER as usize];
            chunk.read(&mut header)?;
            let (channel, time) = channel_and_time(&header);
            if wants(channel) {
                keep(chunk, length - MESSAGE_HEADER)?;
            } else {
                chunk.skip(length - MESSAGE_HEADER)?;
            }
            Ok(Some(Record::Message(channel, time)))
        }
        MESSAGE => Err(String::from("a message is truncated")),
        _ => chunk.skip(length).map(|()| None),
    }
}

fn kind_and_length(header: [u8; HEADER as usize]) -> (u8, u64) {
    let [kind, length @ ..] = header;
    (kind, u64::from_le_bytes(length))
}

/// Channel and recording time of a message.
fn channel_and_time(header: &[u8]) -> (u16, u64) {
    let mut fields = Fields(header);
    let channel = fields.short().unwrap_or_default();
    fields.word();
    (channel, fields.long().unwrap_or_default())
}

/// The length of a record that is kept.
fn kept(length: u64) -> Result<usize, String> {
    if length > LARGEST {
        return Err(format!("a record has {length} bytes, more than {LARGEST}"));
    }
    usize::try_from(length).map_err(|error| error.to_string())
}
