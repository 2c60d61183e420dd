//! The tokens of an expression.

use crate::diagnostic::Span;
use crate::expressions::value::Fault;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TokenKind {
    Number,
    Name,
    /// One of + - * / ^ ( ) and the comma.
    Symbol(char),
}

/// A token and its bytes in the expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Token<'t> {
    pub(crate) kind: TokenKind,
    pub(crate) text: &'t str,
    pub(crate) span: Span,
}

impl Token<'_> {
    pub(crate) fn is(&self, symbol: char) -> bool {
        self.kind == TokenKind::Symbol(symbol)
    }
}

/// Splits an expression into tokens.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token<'_>>, (Fault, Span)> {
    let mut list = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match first {
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            '0'..='9' | '.' => (TokenKind::Number, number_length(rest)),
            c if c.is_ascii_alphabetic() || c == '_' => (TokenKind::Name, name_length(rest)),
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => (TokenKind::Symbol(first), 1),
            c => {
                let fault = Fault::new(format!("unexpected character `{c}` in an expression"));
                return Err((fault.help(substitute(c)), at..at + c.len_utf8()));
            }
        };
        list.push(Token {
            kind,
            text: &rest[..length],
            span: at..at + length,
        });
        at += length;
    }
    Ok(list)
}

/// Replacement for a character that looks like mathematics but is not allowed.
fn substitute(c: char) -> &'static str {
    match c {
        '°' => "write degrees as `deg`, for instance \"90 deg\"",
        '·' | '×' => "write products with `*`",
        'π' => "write `pi`",
        'µ' | 'μ' => "write micrometres as `um`",
        '²' | '³' => "write powers with `^`, for instance `m/s^2`",
        '−' | '–' => "write the minus sign as `-`",
        _ => "an expression consists of numbers with units, names, + - * / ^ and parentheses",
    }
}

/// Length of a name, or of a leg's name with that of one of its variables: `left.q1`.
fn name_length(text: &str) -> usize {
    let end = word_length(text);
    let variable = text[end..].strip_prefix('.');
    match variable.filter(|rest| rest.starts_with(|c: char| c.is_ascii_alphabetic())) {
        Some(rest) => end + 1 + word_length(rest),
        None => end,
    }
}

fn word_length(text: &str) -> usize {
    text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .unwrap_or(text.len())
}

/// Length of a decimal number with an optional exponent.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = text.get(from..).unwrap_or("");
        from + rest
            .find(|c: char| !(c.is_ascii_digit() || c == '_'))
            .unwrap_or(rest.len())
    };
    let mut end = digits(0);
    if text[end..].starts_with('.') {
        end = digits(end + 1);
    }
    if text[end..].starts_with(['e', 'E']) {
        let signed = text[end + 1..].starts_with(['+', '-']);
        let start = end + 1 + usize::from(signed);
        let exponent = digits(start);
        // "2 em" has a unit and no exponent.
        if exponent > start {
            end = exponent;
        }
    }
    end
}
