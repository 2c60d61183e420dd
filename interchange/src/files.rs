//! Input files and their errors, each with file and line; all errors are collected.

use crate::account::{Account, Ledger, Use};
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics, Source, Span};
use std::{
    cell::{Cell, RefCell},
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
};

/// Largest total size of an import's files, bytes. Mesh files are never opened.
const MOST_BYTES: u64 = 16 << 20;
/// Largest total number of elements in an import's files.
const MOST_ELEMENTS: usize = 500_000;

/// Largest number of errors kept for a file, because each new one is compared with all others.
const MOST_ERRORS: usize = 1_000;

/// Location in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    /// Number of the file, in reading order.
    pub(crate) file: usize,
    /// Byte range.
    pub(crate) span: Span,
}

/// All errors, by file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Errors(pub Vec<(Source, Diagnostics)>);

/// Files of one import and the errors found in them.
#[derive(Debug)]
pub(crate) struct Files {
    read: RefCell<Vec<(PathBuf, Source, Diagnostics)>>,
    /// Remaining byte budget.
    bytes_left: Cell<u64>,
    /// Remaining element budget.
    elements_left: Cell<usize>,
    ledger: RefCell<Ledger>,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            read: RefCell::default(),
            bytes_left: Cell::new(MOST_BYTES),
            elements_left: Cell::new(MOST_ELEMENTS),
            ledger: RefCell::default(),
        }
    }
}

impl Files {
    /// Reads a file; `None` after an error, which is reported where the file is named.
    pub(crate) fn read(&self, path: &Path, named_at: Option<&Place>) -> Option<usize> {
        let is_included = named_at.is_some();
        let (text, error) = match read(path, is_included, self.bytes_left.get()) {
            Ok(text) => {
                let left = self.bytes_left.get().saturating_sub(text.len() as u64);
                self.bytes_left.set(left);
                (text, None)
            }
            Err(error) => (String::new(), Some(error)),
        };
        let name = path.display().to_string();
        let message = error.map(|error| format!("`{name}` can't be read: {error}"));
        if let (Some(message), Some(place)) = (&message, named_at) {
            self.report(place, message.clone(), "give the file, or remove its name");
            return None;
        }
        let source = Source::new(name, text);
        let mut all = self.read.borrow_mut();
        all.push((path.to_owned(), source, Diagnostics::new()));
        let at = all.len() - 1;
        if let Some(message) = message {
            all[at].2.push(Diagnostic::global(Code::FOREIGN, message));
            return None;
        }
        Some(at)
    }

    /// Remaining element budget.
    pub(crate) fn elements_left(&self) -> usize {
        self.elements_left.get()
    }

    /// Subtracts elements from the budget.
    pub(crate) fn count_elements(&self, count: usize) {
        let left = self.elements_left.get().saturating_sub(count);
        self.elements_left.set(left);
    }

    /// Text of a file.
    pub(crate) fn text(&self, file: usize) -> String {
        self.read.borrow()[file].1.text.clone()
    }

    /// Folder of a file.
    pub(crate) fn folder(&self, file: usize) -> PathBuf {
        let all = self.read.borrow();
        all[file].0.parent().map(Path::to_owned).unwrap_or_default()
    }

    /// Number of files read.
    pub(crate) fn count(&self) -> usize {
        self.read.borrow().len()
    }

    /// Path of a file.
    pub(crate) fn path(&self, file: usize) -> PathBuf {
        self.read.borrow()[file].0.clone()
    }

    /// Name of a file as the user gave it.
    pub(crate) fn name(&self, file: usize) -> String {
        self.read.borrow()[file].1.name.clone()
    }

    /// Paths of all files read.
    pub(crate) fn paths(&self) -> Vec<PathBuf> {
        self.read
            .borrow()
            .iter()
            .map(|(path, ..)| path.clone())
            .collect()
    }

    /// All files read, in reading order.
    pub(crate) fn sources(&self) -> Vec<Source> {
        let all = self.read.borrow();
        all.iter().map(|(_, source, _)| source.clone()).collect()
    }

    /// Line of a location, counted from 1.
    pub(crate) fn line(&self, place: &Place) -> usize {
        self.read.borrow()[place.file].1.position(&place.span).line
    }

    /// Reports an error at a location.
    pub(crate) fn report(
        &self,
        place: &Place,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let error = Diagnostic::new(Code::FOREIGN, message, place.span.clone()).help(help);
        let errors = &mut self.read.borrow_mut()[place.file].2;
        if errors.len() < MOST_ERRORS {
            errors.push(error);
        }
    }

    /// Records the treatment of an element or attribute.
    pub(crate) fn record(
        &self,
        kind: Use,
        place: &Place,
        element: &str,
        attribute: Option<&str>,
        reason: &str,
    ) {
        let attribute = attribute.map(str::to_owned);
        let key = (
            kind,
            place.file,
            element.to_owned(),
            attribute,
            reason.to_owned(),
        );
        self.ledger.borrow_mut().add(key, place.span.start);
    }

    /// Reports an element or attribute that was read but has no effect on the description.
    pub(crate) fn demote(
        &self,
        place: &Place,
        element: &str,
        attribute: Option<&str>,
        reason: &str,
    ) {
        self.ledger
            .borrow_mut()
            .retract(place.file, element, attribute);
        self.record(Use::Reported, place, element, attribute, reason);
    }

    /// Summary of what was used of the files and what was not.
    pub(crate) fn account(&self) -> Account {
        self.ledger.borrow().account(|file, at| {
            let place = Place { file, span: at..at };
            (self.name(file), self.line(&place))
        })
    }

    /// Adds errors of a file that were found elsewhere.
    pub(crate) fn note(&self, file: usize, errors: &Diagnostics) {
        for error in errors {
            self.read.borrow_mut()[file].2.push(error.clone());
        }
    }

    /// Reports an error about the first file as a whole.
    pub(crate) fn refuse(&self, message: impl Into<String>, help: impl Into<String>) {
        if let Some(first) = self.read.borrow_mut().first_mut() {
            first
                .2
                .push(Diagnostic::global(Code::FOREIGN, message).help(help));
        }
    }

    /// Whether there are no errors.
    pub(crate) fn is_clean(&self) -> bool {
        self.read
            .borrow()
            .iter()
            .all(|(.., errors)| errors.is_empty())
    }

    /// All errors, for files with errors only.
    pub(crate) fn into_errors(self) -> Errors {
        let wrong = |(_, source, errors): (PathBuf, Source, Diagnostics)| {
            (!errors.is_empty()).then_some((source, errors))
        };
        Errors(
            self.read
                .into_inner()
                .into_iter()
                .filter_map(wrong)
                .collect(),
        )
    }
}

/// Reads a text of at most `most` bytes.
///
/// An included file must be a regular file: a device may have no end, and a pipe may block.
fn read(path: &Path, is_included: bool, most: u64) -> io::Result<String> {
    if is_included && !path.metadata()?.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let mut text = String::new();
    File::open(path)?.take(most + 1).read_to_string(&mut text)?;
    if text.len() as u64 > most {
        let message = format!("the files of a robot may have {MOST_BYTES} bytes together");
        return Err(io::Error::other(message));
    }
    Ok(text)
}
