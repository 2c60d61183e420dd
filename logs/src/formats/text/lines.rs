//! Reads a text line by line, as long as each record is one line.
//!
//! If a quotation mark may hide a line end, or carriage returns end lines, the rest is left to a
//! CSV reader.

use std::{
    io::{Chain, Cursor, ErrorKind, Read, Result},
    ops::Range,
};

use memchr::{memchr, memchr2};

use super::BUFFER;
use crate::bytes::byte_source::Opened;

/// The unread rest of a file.
pub(super) type Rest = Chain<Cursor<Vec<u8>>, Opened>;

/// Lines of a file, read in large pieces.
#[derive(Debug)]
pub(super) struct Lines {
    input: Opened,
    buffer: Vec<u8>,
    /// Bytes read but not consumed.
    left: Range<usize>,
    /// Whether the file has been read to its end.
    is_whole: bool,
    /// Whether the remaining bytes contain quotation marks or carriage returns.
    has_marks: bool,
    /// Number of consumed lines, and their bytes.
    passed: usize,
    bytes: u64,
}

/// Next item.
pub(super) enum Next {
    /// A line without its end, as a range of the buffer.
    Line(Range<usize>),
    /// A line that needs a CSV reader.
    Unusual,
    End,
}

impl Lines {
    /// Lines of a file from its position, before which are `bytes` bytes and `lines` lines.
    pub(super) fn new(input: Opened, bytes: u64, lines: usize) -> Self {
        Self {
            input,
            buffer: vec![0; BUFFER],
            left: 0..0,
            is_whole: false,
            has_marks: false,
            passed: lines,
            bytes,
        }
    }

    /// Number of consumed lines.
    pub(super) const fn passed(&self) -> usize {
        self.passed
    }

    /// Number of consumed bytes.
    pub(super) const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Bytes of the line found last.
    pub(super) fn line(&self, line: Range<usize>) -> &[u8] {
        &self.buffer[line]
    }

    /// Reads the next line.
    pub(super) fn next(&mut self) -> Result<Next> {
        let Some((line, end)) = self.find()? else {
            return Ok(self.nothing());
        };
        if self.has_marks && has_marks(&self.buffer[line.clone()]) {
            return Ok(Next::Unusual);
        }
        self.pass(end);
        Ok(Next::Line(line))
    }

    /// Consumes a header line, possibly with quotation marks; `None` if it may span lines.
    pub(super) fn pass_header(&mut self) -> Result<Option<Range<usize>>> {
        let Some((line, end)) = self.find()? else {
            return Ok(None);
        };
        let own = &self.buffer[line.clone()];
        let marks = own.iter().filter(|byte| **byte == b'"').count();
        if marks % 2 == 1 || memchr(b'\r', own).is_some() {
            return Ok(None);
        }
        self.pass(end);
        Ok(Some(line))
    }

    /// The result if no line is found.
    fn nothing(&self) -> Next {
        if self.left.is_empty() {
            Next::End
        } else {
            Next::Unusual
        }
    }

    fn pass(&mut self, end: usize) {
        self.bytes += (end - self.left.start) as u64;
        self.left.start = end;
        self.passed += 1;
    }

    /// Next line and start of the following one; `None` at the end or for an overlong line.
    fn find(&mut self) -> Result<Option<(Range<usize>, usize)>> {
        let mut searched = 0;
        loop {
            let left = &self.buffer[self.left.clone()];
            let start = self.left.start;
            let (line, end) = match memchr(b'\n', &left[searched..]) {
                Some(at) => (start..start + searched + at, start + searched + at + 1),
                None if self.is_whole && left.is_empty() => return Ok(None),
                None if self.is_whole => (self.left.clone(), self.left.end),
                None if left.len() == self.buffer.len() => return Ok(None),
                None => {
                    searched = left.len();
                    self.fill()?;
                    continue;
                }
            };
            let has_return = self.has_marks && self.buffer[line.clone()].ends_with(b"\r");
            let line = line.start..line.end - usize::from(has_return);
            return Ok(Some((line, end)));
        }
    }

    /// Reads more bytes after the remaining ones.
    fn fill(&mut self) -> Result<()> {
        self.buffer.copy_within(self.left.clone(), 0);
        self.left = 0..self.left.len();
        let kept = &self.buffer[self.left.clone()];
        self.has_marks = self.has_marks && has_marks(kept);
        let count = loop {
            match self.input.read(&mut self.buffer[self.left.end..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                other => break other?,
            }
        };
        let new = &self.buffer[self.left.end..self.left.end + count];
        self.has_marks |= has_marks(new);
        self.left.end += count;
        self.is_whole = count == 0;
        Ok(())
    }

    /// The unread rest of the file.
    pub(super) fn rest(&self) -> Result<Rest> {
        let left = self.buffer[self.left.clone()].to_vec();
        let input = self.input.try_clone()?;
        Ok(Cursor::new(left).chain(input))
    }
}

/// Whether bytes contain quotation marks or carriage returns.
fn has_marks(bytes: &[u8]) -> bool {
    memchr2(b'"', b'\r', bytes).is_some()
}
