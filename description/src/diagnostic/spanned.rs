//! Values with their location in the text.

use super::Span;

/// A value and its location in the description.
#[derive(Debug, Clone, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its location; for a missing value, that of the table to which it belongs.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value at a location.
    #[must_use]
    pub const fn new(value: T, span: Span) -> Self {
        Self { value, span }
    }
}
