//! A text line by line, as long as a line is a line: where a quotation mark may hide the end of one, or returns
//! end lines by themselves, the rest is left to a reader that knows these.

use std::{
    io::{Chain, Cursor, ErrorKind, Read, Result},
    ops::Range,
};

use memchr::{memchr, memchr2};

use super::BUFFER;
use crate::data::medium::Opened;

/// What has not been passed yet.
pub(super) type Rest = Chain<Cursor<Vec<u8>>, Opened>;

/// The lines of a file, read in large pieces.
#[derive(Debug)]
pub(super) struct Lines {
    input: Opened,
    buffer: Vec<u8>,
    /// What has been read and not passed.
    left: Range<usize>,
    /// Whether the file has been read to its end.
    is_whole: bool,
    /// Whether quotation marks or returns have been seen in what is left.
    has_marks: bool,
    /// Lines that have been passed, and their bytes.
    passed: usize,
    bytes: u64,
}

/// What comes next.
pub(super) enum Next {
    /// A line without its end, by its place in the buffer.
    Line(Range<usize>),
    /// One that has to be read with more care.
    Unusual,
    End,
}

impl Lines {
    /// The lines of a file from its position on, which is number `bytes` of it.
    pub(super) fn new(input: Opened, bytes: u64) -> Self {
        Self {
            input,
            buffer: vec![0; BUFFER],
            left: 0..0,
            is_whole: false,
            has_marks: false,
            passed: 0,
            bytes,
        }
    }

    /// Number of lines that have been passed.
    pub(super) const fn passed(&self) -> usize {
        self.passed
    }

    /// Bytes that have been passed.
    pub(super) const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The bytes of a line that has been found last.
    pub(super) fn line(&self, line: Range<usize>) -> &[u8] {
        &self.buffer[line]
    }

    /// Goes to the next line.
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

    /// Passes the next line, though quotation marks may stand in it; `false` where it may go on behind its end.
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

    /// What there is where no line is found.
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

    /// The next line and where the one behind it starts; none at the end, and where it is longer than the buffer.
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

    /// Reads on behind what is left.
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

    /// The lines that have been passed, their bytes, and the rest of the file.
    pub(super) fn rest(&self) -> Result<(usize, u64, Rest)> {
        let left = self.buffer[self.left.clone()].to_vec();
        let input = self.input.try_clone()?;
        Ok((self.passed, self.bytes, Cursor::new(left).chain(input)))
    }
}

/// Whether quotation marks or returns stand somewhere.
fn has_marks(bytes: &[u8]) -> bool {
    memchr2(b'"', b'\r', bytes).is_some()
}
