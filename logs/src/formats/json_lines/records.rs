//! Splits a file into JSON objects, in bounded memory.

use std::{
    io::{ErrorKind, Read},
    ops::Range,
};

use memchr::{memchr, memchr_iter};

use crate::bytes::byte_source::Opened;

/// Largest size of an object in bytes.
const LARGEST: usize = 1 << 20;

/// Bytes read at once.
const BUFFER: usize = 1 << 17;

/// Arrangement of the objects in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// One object per line.
    Lines,
    /// Successive objects, each of one or more lines.
    Successive,
    /// One list of objects.
    List,
}

/// A defect of a file, with its line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) line: usize,
    pub(super) what: String,
    pub(super) help: Option<&'static str>,
}

/// An object of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record<'a> {
    /// Its first line, counted from 1.
    pub(super) line: usize,
    pub(super) text: &'a [u8],
}

/// The remaining objects of a file.
#[derive(Debug)]
pub(super) struct Records {
    input: Opened,
    form: Form,
    buffer: Vec<u8>,
    /// Bytes read but not consumed.
    left: Range<usize>,
    /// Whether the file has been read to its end.
    is_whole: bool,
    /// Line of the next byte, and number of consumed bytes.
    line: usize,
    bytes: u64,
    /// Progress in a list.
    place: Place,
}

/// Position between the objects of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// Before the list.
    Start,
    /// After the opening bracket, or after a comma.
    Item,
    /// After an object.
    Separator,
    /// After the list.
    End,
}

impl Form {
    /// Arrangement of the objects of a file.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn of(input: Opened) -> Result<Self, Fault> {
        let mut records = Records::new(input, Self::Successive);
        records.skip_blanks()?;
        if records.peek() == Some(b'[') {
            return Ok(Self::List);
        }
        // A broken first object is reported when it is read.
        Ok(match records.next() {
            Ok(Some(record)) if memchr(b'\n', record.text).is_some() => Self::Successive,
            _ => Self::Lines,
        })
    }
}

impl Records {
    /// The objects of a file from its start.
    pub(super) fn new(input: Opened, form: Form) -> Self {
        Self {
            input,
            form,
            buffer: vec![0; BUFFER],
            left: 0..0,
            is_whole: false,
            line: 1,
            bytes: 0,
            place: Place::Start,
        }
    }

    /// Number of consumed bytes.
    pub(super) const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Reads the next object; `None` at the end.
    ///
    /// # Errors
    /// A file that cannot be read further.
    pub(super) fn next(&mut self) -> Result<Option<Record<'_>>, Fault> {
        self.skip_blanks()?;
        if self.form == Form::List {
            self.pass_separators()?;
        }
        if self.peek().is_none() {
            return match (self.form, self.place) {
                (Form::List, Place::Start | Place::Item | Place::Separator) => {
                    let help = "if the log was cut off while it was written, end it with `]`";
                    Err(self.fault("the list of objects has no end", Some(help)))
                }
                _ => Ok(None),
            };
        }
        let length = match self.form {
            Form::Lines => self.line_length()?,
            Form::Successive | Form::List => self.object_length()?,
        };
        self.place = Place::Separator;
        let line = self.line;
        let text = self.left.start..self.left.start + length;
        self.pass(length);
        let text = &self.buffer[text];
        Ok(Some(Record { line, text }))
    }

    /// Consumes brackets and commas of a list up to the next object.
    fn pass_separators(&mut self) -> Result<(), Fault> {
        while let Some(byte) = self.peek() {
            self.place = match (self.place, byte) {
                (Place::Start, b'[') | (Place::Separator, b',') => Place::Item,
                (Place::Item, b'{') => return Ok(()),
                (Place::Separator | Place::Item, b']') => Place::End,
                (Place::End, _) => {
                    return Err(self.fault("the file goes on after its list of objects", None));
                }
                (Place::Separator, _) => {
                    return Err(self.fault("there is no comma between two objects", None));
                }
                (Place::Start | Place::Item, _) => {
                    return Err(self.fault("the list has an item that is not an object", None));
                }
            };
            self.pass(1);
            self.skip_blanks()?;
        }
        Ok(())
    }

    /// Length of the next line.
    fn line_length(&mut self) -> Result<usize, Fault> {
        let mut searched = 0;
        loop {
            let left = &self.buffer[self.left.clone()];
            match memchr(b'\n', &left[searched..]) {
                Some(at) => return Ok(searched + at),
                None if self.is_whole => return Ok(left.len()),
                None => searched = left.len(),
            }
            self.fill()?;
        }
    }

    /// Length of the next object, by its braces.
    fn object_length(&mut self) -> Result<usize, Fault> {
        let (mut searched, mut depth) = (0, 0_usize);
        let (mut is_text, mut is_escaped) = (false, false);
        loop {
            let left = &self.buffer[self.left.clone()];
            for (at, byte) in left.iter().enumerate().skip(searched) {
                match byte {
                    _ if is_escaped => is_escaped = false,
                    b'\\' => is_escaped = is_text,
                    b'"' => is_text = !is_text,
                    _ if is_text => {}
                    b'{' | b'[' => depth += 1,
                    b'}' | b']' if depth <= 1 => return Ok(at + 1),
                    b'}' | b']' => depth -= 1,
                    b'\n' if depth == 0 => return Ok(at),
                    _ => {}
                }
            }
            if self.is_whole {
                return Ok(left.len());
            }
            searched = left.len();
            self.fill()?;
        }
    }

    /// The next byte.
    fn peek(&self) -> Option<u8> {
        self.buffer[self.left.clone()].first().copied()
    }

    /// Consumes blanks, line ends and the byte order mark.
    fn skip_blanks(&mut self) -> Result<(), Fault> {
        loop {
            let left = &self.buffer[self.left.clone()];
            let is_blank = |byte: &&u8| byte.is_ascii_whitespace();
            let mark = b"\xef\xbb\xbf";
            let count = match self.bytes {
                0 if left.starts_with(mark) => mark.len(),
                _ => left.iter().take_while(is_blank).count(),
            };
            if count == 0 && (!left.is_empty() || self.is_whole) {
                return Ok(());
            }
            self.pass(count);
            if self.left.is_empty() && !self.is_whole {
                self.fill()?;
            }
        }
    }

    fn pass(&mut self, count: usize) {
        let end = self.left.start + count;
        self.line += memchr_iter(b'\n', &self.buffer[self.left.start..end]).count();
        self.left.start = end;
        self.bytes += count as u64;
    }

    /// Reads more bytes after the remaining ones.
    fn fill(&mut self) -> Result<(), Fault> {
        let count = self.left.len();
        if count > LARGEST {
            let what = format!("an object has more than {} kB", LARGEST >> 10);
            let help = "write an object for each sample, one per line";
            return Err(self.fault(&what, Some(help)));
        }
        self.buffer.copy_within(self.left.clone(), 0);
        self.left = 0..count;
        if self.buffer.len() < count + BUFFER {
            self.buffer.resize(count + BUFFER, 0);
        }
        let read = loop {
            match self.input.read(&mut self.buffer[count..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => {
                    let what = format!("the file can't be read: {error}");
                    return Err(self.fault(&what, None));
                }
                Ok(read) => break read,
            }
        };
        self.left.end += read;
        self.is_whole = read == 0;
        Ok(())
    }

    /// A defect at the next byte.
    fn fault(&self, what: &str, help: Option<&'static str>) -> Fault {
        Fault {
            line: self.line,
            what: what.to_owned(),
            help,
        }
    }
}
