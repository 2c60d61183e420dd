//! Rendering of errors as text and as data.

use super::{Diagnostic, Diagnostics, Source};
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use overact_core::text::is_invisible;
use serde::Serialize;
use std::collections::HashMap;

/// An error with its location, for JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Located {
    /// The error code, such as `OA102`.
    pub code: String,
    /// Description of the error.
    pub message: String,
    /// The path as the user gave it.
    pub file: String,
    /// Line, counted from 1; `None` for an error of the text as a whole.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: Option<usize>,
    /// A remedy.
    pub help: Option<String>,
}

impl Diagnostics {
    /// All errors as plain text.
    #[must_use]
    pub fn render_plain(&self, source: &Source) -> String {
        self.render(source, &Renderer::plain())
    }

    /// All errors as text with terminal colours.
    #[must_use]
    pub fn render_styled(&self, source: &Source) -> String {
        self.render(source, &Renderer::styled())
    }

    /// All errors as data.
    #[must_use]
    pub fn located(&self, source: &Source) -> Vec<Located> {
        let locate = |d: &Diagnostic| {
            let position = d.span.as_ref().map(|span| source.position(span));
            Located {
                code: d.code.to_string(),
                message: d.message.clone(),
                file: source.name.clone(),
                line: position.map(|p| p.line),
                column: position.map(|p| p.column),
                help: d.help.clone(),
            }
        };
        self.iter().map(locate).collect()
    }

    fn render(&self, source: &Source, renderer: &Renderer) -> String {
        let mut places: HashMap<&str, Vec<&Diagnostic>> = HashMap::new();
        for diagnostic in self.iter() {
            places
                .entry(&diagnostic.message)
                .or_default()
                .push(diagnostic);
        }
        let mut texts: Vec<String> = Vec::new();
        let mut left = 0;
        for diagnostic in self.iter() {
            let same = &places[diagnostic.message.as_str()];
            let is_repeated = same.len() > REPEATED;
            if is_repeated && !std::ptr::eq(same[0], diagnostic) {
                continue;
            }
            if texts.len() == SHOWN {
                left += 1;
                continue;
            }
            let others = if is_repeated { &same[1..] } else { &[] };
            texts.push(render_one(diagnostic, others, source, renderer));
        }
        if left > 0 {
            texts.push(format!(
                "{left} further errors are not shown; `overact check --json` lists all"
            ));
        }
        texts.join("\n\n")
    }
}

/// Replaces invisible characters, and those that change the writing direction, by a mark.
///
/// A file name must not rearrange a message.
#[must_use]
pub fn visible(text: &str) -> String {
    text.split('\n')
        .map(visible_in_line)
        .collect::<Vec<_>>()
        .join("\n")
}

/// The same for a text of one line, such as a file name.
fn visible_in_line(text: &str) -> String {
    let shown = |c: char| if is_invisible(c) { '\u{fffd}' } else { c };
    text.chars().map(shown).collect()
}

/// Largest number of errors that are shown; each takes a time that grows with the text.
const SHOWN: usize = 100;

/// Number of locations above which an error is shown once, with the line numbers of the others.
const REPEATED: usize = 3;

/// Line numbers of errors: the first few.
fn lines(others: &[&Diagnostic], source: &Source) -> String {
    let of = |d: &&Diagnostic| Some(source.position(d.span.as_ref()?).line.to_string());
    let numbers: Vec<String> = others.iter().filter_map(of).take(8).collect();
    let rest = others.len() - numbers.len();
    let more = match rest {
        0 => String::new(),
        _ => format!(" and at {rest} more places"),
    };
    format!("the same in lines {}{more}", numbers.join(", "))
}

fn render_one(
    diagnostic: &Diagnostic,
    others: &[&Diagnostic],
    source: &Source,
    renderer: &Renderer,
) -> String {
    let message = visible(&diagnostic.message);
    let label = visible(&diagnostic.label);
    let help = diagnostic.help.as_deref().map(visible);
    let code = diagnostic.code.to_string();
    let title = Level::ERROR
        .primary_title(message.as_str())
        .id(code.as_str());
    let path = visible_in_line(&source.name);
    let mut group = match &diagnostic.span {
        Some(span) => {
            let label = Some(label.as_str()).filter(|label| !label.is_empty());
            let annotation = AnnotationKind::Primary
                .span(source.first_line(span))
                .label(label);
            let snippet = Snippet::source(source.text.as_str()).path(path.as_str());
            title.element(snippet.annotation(annotation))
        }
        None => title.element(Origin::path(path.as_str())),
    };
    if let Some(help) = &help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    let repeated = (!others.is_empty()).then(|| lines(others, source));
    if let Some(repeated) = &repeated {
        group = group.element(Level::NOTE.message(repeated.as_str()));
    }
    renderer.render(&[group])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;

    fn example() -> (Source, Diagnostics) {
        let source = Source::new("robots/my.toml", "name = \"A\"\ngammma = 3\n");
        let diagnostic = Diagnostic::new(Code::UNKNOWN_KEY, "unknown key `gammma`", 11..17)
            .label("not a key of a joint")
            .help("did you mean `gamma`?");
        (source, diagnostic.into())
    }

    #[test]
    fn plain_text_shows_the_source_location() {
        let (source, errors) = example();
        let expected = "\
error[OA102]: unknown key `gammma`
 --> robots/my.toml:2:1
  |
2 | gammma = 3
  | ^^^^^^ not a key of a joint
  |
  = help: did you mean `gamma`?";
        assert_eq!(errors.render_plain(&source), expected);
        assert!(errors.render_styled(&source).contains('\u{1b}'));
    }

    #[test]
    fn control_characters_of_file_names_are_not_printed() {
        let source = Source::new("a\u{1b}[31m\n.toml", "name = \"A\"");
        let located = Diagnostic::new(Code::UNKNOWN_KEY, "unknown", 0..4);
        for error in [located, Diagnostic::global(Code::UNKNOWN_KEY, "unknown")] {
            let message = Diagnostics::from(error).render_plain(&source);
            assert!(
                !message.contains('\u{1b}') && message.contains("[31m\u{fffd}.toml"),
                "{message}"
            );
        }
    }

    #[test]
    fn invisible_characters_of_a_file_are_not_printed() {
        let source = Source::new("a.toml", "name = \"A\"");
        let errors: Diagnostics =
            Diagnostic::new(Code::UNKNOWN_KEY, "no actuator `\u{202e}a`", 0..4)
                .label("not \u{1b}[31mred")
                .help("the actuators are \u{2066}b, c\u{200b}")
                .into();
        let message = errors.render_plain(&source);
        assert!(
            !message.chars().any(|c| c != '\n' && is_invisible(c)),
            "{message:?}"
        );
        assert!(
            message.contains("the actuators are \u{fffd}b, c\u{fffd}"),
            "{message}"
        );
    }

    #[test]
    fn repeated_errors_are_shown_once() {
        let source = Source::new("a.toml", "x\n".repeat(20));
        let mut errors = Diagnostics::new();
        for line in 0..14 {
            errors.push(Diagnostic::new(
                Code::UNKNOWN_KEY,
                "wrong",
                2 * line..2 * line + 1,
            ));
        }
        errors.push(Diagnostic::new(Code::UNKNOWN_KEY, "other", 30..31));
        let text = errors.render_plain(&source);
        assert_eq!(text.matches("error[OA102]: ").count(), 2, "{text}");
        let note = "= note: the same in lines 2, 3, 4, 5, 6, 7, 8, 9 and at 5 more places";
        assert!(text.contains(note), "{text}");
        assert_eq!(errors.located(&source).len(), 15);
    }

    #[test]
    fn only_the_first_hundred_errors_are_shown() {
        let source = Source::new("a.toml", "x\n".repeat(120));
        let mut errors = Diagnostics::new();
        for line in 0..120 {
            let span = 2 * line..2 * line + 1;
            let message = format!("wrong in part {line}");
            errors.push(Diagnostic::new(Code::UNKNOWN_KEY, message, span));
        }
        let text = errors.render_plain(&source);
        assert_eq!(text.matches("error[OA102]: ").count(), 100);
        let end = "\n\n20 further errors are not shown; `overact check --json` lists all";
        assert!(text.ends_with(end), "{text}");
        assert_eq!(errors.located(&source).len(), 120);
    }

    #[test]
    fn located_errors_have_line_and_column() {
        let (source, errors) = example();
        let located = errors.located(&source);
        assert_eq!(located.len(), 1);
        assert_eq!((located[0].line, located[0].column), (Some(2), Some(1)));
        assert_eq!(located[0].file, "robots/my.toml");
    }

    #[test]
    fn spans_outside_the_text_are_rendered() {
        let source = Source::new("a.toml", "ä");
        for span in [0..1, 1..1, 1..9, 7..9, Span { start: 2, end: 1 }] {
            let errors = Diagnostics::from(Diagnostic::new(Code::UNKNOWN_KEY, "wrong", span));
            assert!(errors.render_plain(&source).contains("wrong"));
        }
        let global = Diagnostics::from(Diagnostic::global(Code::INCOMPLETE, "nothing there"));
        assert!(global.render_plain(&source).contains("a.toml"));
    }

    type Span = super::super::Span;
}
