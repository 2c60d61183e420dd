//! Source text, spans, collected errors, and their rendering.
//!
//! A stage that finds an error records a [`Diagnostic`] and continues, so that one run shows all
//! errors of a description. Nothing is printed here. Errors are rendered as plain text for
//! `compile_error!`, styled text for a terminal, or data for programs.

mod internal;
mod render;
mod spanned;
mod suggestion;

pub use internal::InternalError;
pub use overact_core::{Code, Explanation};
pub use render::{Located, visible};
pub use spanned::Spanned;
pub use suggestion::{did_you_mean, nearest};

use std::ops::Range;

/// A range of bytes in a source text.
pub type Span = Range<usize>;

/// A text and its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The path as the user gave it.
    pub name: String,
    /// The text.
    pub text: String,
}

/// A position in a text, for messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
}

impl Source {
    /// A text with its name.
    #[must_use]
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            text: text.into(),
        }
    }

    /// Line and column of the start of a span; a start after the end of the text counts as the end.
    #[must_use]
    pub fn position(&self, span: &Span) -> Position {
        let before = &self.text[..self.boundary(span.start)];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        Position {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// The last character boundary at or before a byte.
    fn boundary(&self, at: usize) -> usize {
        let mut at = at.min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    }

    /// The part of a span on its first line, at character boundaries.
    fn first_line(&self, span: &Span) -> Span {
        let start = self.boundary(span.start);
        let end = self.boundary(span.end.max(start)).max(start);
        let length = self.text[start..end]
            .find(['\n', '\r'])
            .unwrap_or(end - start);
        start..start + length
    }
}

/// One error.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// The error code, under which the error is explained.
    pub code: Code,
    /// Description of the error in one sentence.
    pub message: String,
    /// Location; `None` for an error of the text as a whole.
    pub span: Option<Span>,
    /// The text under the caret: what is or should be there, possibly empty.
    pub label: String,
    /// A remedy.
    pub help: Option<String>,
    /// Kind of the error, for programs.
    pub kind: DiagnosticKind,
}

/// Kinds of errors that programs distinguish without reading the message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum DiagnosticKind {
    /// An error that is described by its message only.
    #[default]
    Plain,
    /// The legs allow the platform more motions than described, and the actuators drive all of
    /// them.
    ///
    /// The robot is valid, but has more degrees of freedom.
    NotHeld,
}

/// Largest number of characters of a message.
const LONGEST_MESSAGE: usize = 800;

/// Shortens a message that contains a very long value, in the middle.
fn short(message: String) -> String {
    let count = message.chars().count();
    if count <= LONGEST_MESSAGE {
        return message;
    }
    let half = LONGEST_MESSAGE / 2;
    let start: String = message.chars().take(half).collect();
    let end: String = message.chars().skip(count - half).collect();
    format!("{start}…{end}")
}

impl Diagnostic {
    /// An error at a location.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>, span: Span) -> Self {
        Self {
            code,
            message: short(message.into()),
            span: Some(span),
            label: String::new(),
            help: None,
            kind: DiagnosticKind::Plain,
        }
    }

    /// An error of the text as a whole.
    #[must_use]
    pub fn global(code: Code, message: impl Into<String>) -> Self {
        Self {
            code,
            message: short(message.into()),
            span: None,
            label: String::new(),
            help: None,
            kind: DiagnosticKind::Plain,
        }
    }

    /// Sets the location, if known.
    #[must_use]
    pub fn at(self, span: Option<Span>) -> Self {
        Self { span, ..self }
    }

    /// Sets the text under the caret.
    #[must_use]
    pub fn label(self, label: impl Into<String>) -> Self {
        Self {
            label: short(label.into()),
            ..self
        }
    }

    /// Adds a remedy.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(short(help.into())),
            ..self
        }
    }

    /// Sets the kind, for programs.
    #[must_use]
    pub fn kind(self, kind: DiagnosticKind) -> Self {
        Self { kind, ..self }
    }

    /// Adds a remedy, if there is one.
    #[must_use]
    pub fn maybe_help(self, help: Option<String>) -> Self {
        Self {
            help: help.or(self.help),
            ..self
        }
    }
}

/// All errors found so far, sorted by location.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    internal: Option<Box<InternalError>>,
}

impl Diagnostics {
    /// No errors.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an error, unless the same error at the same location exists.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let same = |d: &Diagnostic| d.message == diagnostic.message && d.span == diagnostic.span;
        if !self.list.iter().any(same) {
            let start = |d: &Diagnostic| d.span.as_ref().map_or(0, |s| s.start);
            let at = self
                .list
                .partition_point(|d| start(d) <= start(&diagnostic));
            self.list.insert(at, diagnostic);
        }
    }

    /// Adds all errors of another collection.
    pub fn append(&mut self, other: Self) {
        self.internal = self.internal.take().or(other.internal);
        for diagnostic in other.list {
            self.push(diagnostic);
        }
    }

    /// Removes all errors of some codes, which may follow from the error at a location, and says
    /// there how many they are.
    pub(crate) fn fold(&mut self, cause: &Span, follows: &[Code]) {
        let before = self.list.len();
        self.list.retain(|error| !follows.contains(&error.code));
        let removed = before - self.list.len();
        let cause = { self.list.iter_mut() }.find(|error| error.span.as_ref() == Some(cause));
        if let (1.., Some(cause)) = (removed, cause) {
            let rest = match removed {
                1 => String::from("One further error may follow from it and is not listed."),
                _ => format!("{removed} further errors may follow from it and are not listed."),
            };
            cause.help = Some(match &cause.help {
                Some(help) => format!("{help} {rest}"),
                None => rest,
            });
        }
    }

    /// Whether there is an error at exactly this location.
    #[must_use]
    pub fn has_error_at(&self, span: &Span) -> bool {
        self.list.iter().any(|d| d.span.as_ref() == Some(span))
    }

    /// Whether there is no error.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Number of errors.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The errors, sorted by location.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// The value if there is no error.
    ///
    /// # Errors
    /// The collection itself, if it is not empty.
    pub fn into_result<T>(self, value: T) -> Result<T, Self> {
        if self.is_empty() {
            Ok(value)
        } else {
            Err(self)
        }
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self {
            list: vec![diagnostic],
            internal: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let source = Source::new("a.toml", "ä = 1\nµß = 2\n");
        assert_eq!(source.position(&(0..1)), Position { line: 1, column: 1 });
        assert_eq!(source.position(&(12..13)), Position { line: 2, column: 4 });
        assert_eq!(
            source.position(&(900..901)),
            Position { line: 3, column: 1 }
        );
    }

    #[test]
    fn long_values_are_shortened_in_the_middle() {
        let diagnostic_of = |value: &str| {
            Diagnostic::global(Code::UNKNOWN_KEY, format!("there is no `{value}` here"))
        };
        let value = "é".repeat(100_000);
        let both = diagnostic_of(&value).help(value).label("short");
        for text in [&both.message, both.help.as_ref().expect("a help")] {
            assert_eq!(text.chars().count(), LONGEST_MESSAGE + 1);
        }
        assert!(both.message.starts_with("there is no `é") && both.message.ends_with("é` here"));
        assert_eq!(diagnostic_of("x").message, "there is no `x` here");
        assert_eq!(both.label, "short");
    }

    #[test]
    fn errors_are_sorted_and_deduplicated() {
        let mut all = Diagnostics::new();
        assert!(all.clone().into_result(()).is_ok());
        all.push(Diagnostic::new(Code::SYNTAX, "second", 5..6));
        all.push(Diagnostic::new(Code::SYNTAX, "first", 1..2));
        all.push(Diagnostic::new(Code::SYNTAX, "second", 5..6));
        let messages: Vec<_> = all.iter().map(|d| d.message.as_str()).collect();
        assert_eq!(messages, ["first", "second"]);
        assert!(all.into_result(()).is_err());
    }
}
