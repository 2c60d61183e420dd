//! Input files and their errors, each with file and line; all errors are collected.

use crate::{
    account::{Account, Ledger, Use},
    listing::listed,
};
use overact_description::diagnostic::{Code, Diagnostic, Diagnostics, Source, Span, did_you_mean};
use std::{
    cell::{Cell, RefCell},
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
};

/// Largest total size of an import's files, bytes. Mesh files have a limit of their own.
const MOST_BYTES: u64 = 16 << 20;
/// Largest total number of elements in an import's files.
const MOST_ELEMENTS: usize = 500_000;

/// Largest number of errors kept for a file; further ones are counted.
const MOST_ERRORS: usize = 200;

/// Largest number of misspelt names that are added to the errors.
const MOST_MISSPELT: usize = 5;

/// Largest number of unknown names that are compared with all others for a suggestion.
const MOST_SUGGESTIONS: usize = 50;

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

/// A file, its line numbers and its errors.
#[derive(Debug)]
struct InputFile {
    path: PathBuf,
    source: Source,
    /// Byte offset of each line.
    line_starts: Vec<usize>,
    errors: Diagnostics,
    /// Number of errors that are not kept.
    further_errors: usize,
    /// Whether it is outside the folder of the first file, so that no message may show its contents.
    is_outside: bool,
}

/// Files of one import and the errors found in them.
#[derive(Debug)]
pub(crate) struct Files {
    read: RefCell<Vec<InputFile>>,
    /// Remaining byte budget.
    bytes_left: Cell<u64>,
    /// Remaining element budget.
    elements_left: Cell<usize>,
    /// Number of names that may still be compared with all others.
    suggestions_left: Cell<usize>,
    ledger: RefCell<Ledger>,
    /// Unknown names that are similar to known ones, which are errors if the import fails.
    misspelt: RefCell<Vec<(usize, Diagnostic)>>,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            read: RefCell::default(),
            bytes_left: Cell::new(MOST_BYTES),
            elements_left: Cell::new(MOST_ELEMENTS),
            suggestions_left: Cell::new(MOST_SUGGESTIONS),
            ledger: RefCell::default(),
            misspelt: RefCell::default(),
        }
    }
}

impl InputFile {
    /// Text for messages: blank for a file whose contents they may not show.
    fn shown(&self) -> Source {
        let Source { name, text } = &self.source;
        if !self.is_outside {
            return self.source.clone();
        }
        let blank = text.split('\n').map(|line| " ".repeat(line.len()));
        Source::new(name.clone(), blank.collect::<Vec<_>>().join("\n"))
    }

    /// Adds the first error of a file whose contents messages may not show, and counts the others.
    fn push_hidden(&mut self, error: &Diagnostic) {
        if !self.errors.is_empty() {
            self.further_errors += 1;
            return;
        }
        let message = "this file can't be used, and its contents are not shown";
        let help = "it is outside the robot's folder: copy it into the folder to see the error";
        let shown = match &error.span {
            Some(span) => Diagnostic::new(Code::FOREIGN, message, span.clone()),
            None => Diagnostic::global(Code::FOREIGN, message),
        };
        self.errors.push(shown.help(help));
    }
}

impl Files {
    /// Reads a file that the user names; `None` after an error.
    pub(crate) fn read_given(&self, path: &Path) -> Option<usize> {
        let file = self.read(path, None)?;
        self.read.borrow_mut()[file].is_outside = false;
        Some(file)
    }

    /// Reads a file; `None` after an error, which is reported where the file is named.
    ///
    /// Messages do not show the contents of a file outside the folder of the first.
    pub(crate) fn read(&self, path: &Path, named_at: Option<&Place>) -> Option<usize> {
        let may_be_pipe = named_at.is_none() && is_standard_input(path);
        let (text, error) = match read(path, may_be_pipe, self.bytes_left.get()) {
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
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
        let mut all = self.read.borrow_mut();
        let first = all.first();
        let is_outside = first.is_some_and(|first| !is_beside(&first.path, path));
        all.push(InputFile {
            path: path.to_owned(),
            line_starts: line_starts.collect(),
            source: Source::new(name, text),
            errors: Diagnostics::new(),
            further_errors: 0,
            is_outside,
        });
        let at = all.len() - 1;
        if let Some(message) = message {
            all[at]
                .errors
                .push(Diagnostic::global(Code::FOREIGN, message));
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
        self.read.borrow()[file].source.text.clone()
    }

    /// Folder of a file.
    pub(crate) fn folder(&self, file: usize) -> PathBuf {
        let all = self.read.borrow();
        all[file]
            .path
            .parent()
            .map(Path::to_owned)
            .unwrap_or_default()
    }

    /// Number of files read.
    pub(crate) fn count(&self) -> usize {
        self.read.borrow().len()
    }

    /// Path of a file.
    pub(crate) fn path(&self, file: usize) -> PathBuf {
        self.read.borrow()[file].path.clone()
    }

    /// Name of a file as the user gave it.
    pub(crate) fn name(&self, file: usize) -> String {
        self.read.borrow()[file].source.name.clone()
    }

    /// Whether messages may not show the contents of a file.
    pub(crate) fn is_outside(&self, file: usize) -> bool {
        self.read.borrow()[file].is_outside
    }

    /// Paths of all files read.
    pub(crate) fn paths(&self) -> Vec<PathBuf> {
        self.read
            .borrow()
            .iter()
            .map(|file| file.path.clone())
            .collect()
    }

    /// All files read, in reading order, for messages.
    pub(crate) fn sources(&self) -> Vec<Source> {
        let all = self.read.borrow();
        all.iter().map(InputFile::shown).collect()
    }

    /// Line of a location, counted from 1.
    pub(crate) fn line(&self, place: &Place) -> usize {
        let all = self.read.borrow();
        let starts = &all[place.file].line_starts;
        starts.partition_point(|start| *start <= place.span.start)
    }

    /// Reports an error at a location.
    pub(crate) fn report(
        &self,
        place: &Place,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let error = Diagnostic::new(Code::FOREIGN, message, place.span.clone()).help(help);
        self.push(place.file, error);
    }

    /// Adds an error of a file, or counts it if the file has too many.
    fn push(&self, file: usize, error: Diagnostic) {
        if let Some(own) = self.read.borrow_mut().get_mut(file) {
            if own.is_outside {
                own.push_hidden(&error);
            } else if own.errors.len() < MOST_ERRORS {
                own.errors.push(error);
            } else {
                own.further_errors += 1;
            }
        }
    }

    /// Keeps an unknown name that is similar to a known one, in case the import fails.
    pub(crate) fn suspect(&self, place: &Place, name: &str, near: String) {
        let message = format!("`{name}` is unknown and was not read");
        let error = Diagnostic::new(Code::FOREIGN, message, place.span.clone()).help(near);
        let mut misspelt = self.misspelt.borrow_mut();
        if misspelt.len() < MOST_MISSPELT {
            misspelt.push((place.file, error));
        }
    }

    /// Suggests the candidate closest to an unknown name, for the first unknown names only.
    pub(crate) fn did_you_mean<'a>(
        &self,
        name: &str,
        candidates: impl IntoIterator<Item = &'a str>,
    ) -> Option<String> {
        let left = self.suggestions_left.get().checked_sub(1)?;
        self.suggestions_left.set(left);
        did_you_mean(name, candidates)
    }

    /// Help for an unknown joint: the closest name, or the names of the first joints.
    pub(crate) fn joint_help<'a>(
        &self,
        name: &str,
        joints: impl Iterator<Item = &'a str> + Clone,
    ) -> String {
        if let Some(near) = self.did_you_mean(name, joints.clone()) {
            return near;
        }
        match listed(joints) {
            none if none.is_empty() => "the file has no joints".to_owned(),
            names => format!("the joints of the file are {names}"),
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
            self.push(file, error.clone());
        }
    }

    /// Reports an error about the first file as a whole.
    pub(crate) fn refuse(&self, message: impl Into<String>, help: impl Into<String>) {
        self.push(0, Diagnostic::global(Code::FOREIGN, message).help(help));
    }

    /// Whether there are no errors.
    pub(crate) fn is_clean(&self) -> bool {
        self.read.borrow().iter().all(|file| file.errors.is_empty())
    }

    /// All errors, for files with errors only.
    pub(crate) fn into_errors(self) -> Errors {
        for (file, error) in self.misspelt.take() {
            self.push(file, error);
        }
        let wrong = |file: InputFile| {
            let source = file.shown();
            let InputFile {
                mut errors,
                further_errors,
                ..
            } = file;
            if further_errors > 0 {
                let end = source.text.len();
                let message = format!("{further_errors} more errors are not shown");
                let help = "correct the errors above first";
                let more = Diagnostic::new(Code::FOREIGN, message, end..end).help(help);
                errors.push(more);
            }
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

/// Whether a file is in the folder of another or below, also after symbolic links.
pub(crate) fn is_beside(first: &Path, path: &Path) -> bool {
    let folder = first.parent().filter(|own| !own.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).canonicalize();
    match (folder, path.canonicalize()) {
        (Ok(folder), Ok(path)) => path.starts_with(folder),
        // A missing file has no contents.
        _ => true,
    }
}

/// Whether a path means standard input or an open file of this process, which may be pipes.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    let folders = ["/dev/fd", "/proc/self/fd"];
    let is_named = [Path::new("-"), Path::new("/dev/stdin")].contains(&path);
    is_named || folders.iter().any(|folder| path.starts_with(folder))
}

/// Reads a text of at most `most` bytes.
///
/// Without `may_be_pipe` it must be a regular file: a device may have no end, and a pipe may block.
fn read(path: &Path, may_be_pipe: bool, most: u64) -> io::Result<String> {
    if may_be_pipe && path == Path::new("-") {
        return bounded(io::stdin(), most);
    }
    let existing = path.metadata()?;
    if existing.is_dir() {
        let message = "it is a folder, not a regular file";
        return Err(io::Error::other(message));
    }
    if !existing.is_file() && !may_be_pipe {
        return Err(io::Error::other("it is not a regular file"));
    }
    bounded(File::open(path)?, most)
}

/// Reads a text; an error if it has more than `most` bytes.
fn bounded(input: impl Read, most: u64) -> io::Result<String> {
    let mut text = String::new();
    let read = input.take(most + 1).read_to_string(&mut text);
    read.map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => io::Error::other("it is not text in UTF-8: save it as UTF-8"),
        _ => error,
    })?;
    if text.len() as u64 > most {
        let message = format!("the files of a robot may have {MOST_BYTES} bytes together");
        return Err(io::Error::other(message));
    }
    Ok(text)
}
