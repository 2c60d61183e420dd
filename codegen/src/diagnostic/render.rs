//! Errors as text for people and as data for machines.

use super::{Diagnostic, Diagnostics, Source};
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use serde::Serialize;

/// An error with its place, ready for JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Located {
    /// What is wrong.
    pub message: String,
    /// The path as the user gave it.
    pub file: String,
    /// Line, counted from 1; absent if the error is no one place of the text.
    pub line: Option<usize>,
    /// Column in characters, counted from 1.
    pub column: Option<usize>,
    /// A way out.
    pub help: Option<String>,
}

impl Diagnostics {
    /// All errors as text without colours.
    #[must_use]
    pub fn render_plain(&self, source: &Source) -> String {
        self.render(source, &Renderer::plain())
    }

    /// All errors as text with a terminal's colours.
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
        let texts: Vec<String> = self
            .iter()
            .map(|d| render_one(d, source, renderer))
            .collect();
        texts.join("\n\n")
    }
}

fn render_one(diagnostic: &Diagnostic, source: &Source, renderer: &Renderer) -> String {
    let title = Level::ERROR.primary_title(diagnostic.message.as_str());
    let mut group = match &diagnostic.span {
        Some(span) => {
            let label = Some(diagnostic.label.as_str()).filter(|label| !label.is_empty());
            let annotation = AnnotationKind::Primary
                .span(source.first_line(span))
                .label(label);
            let snippet = Snippet::source(source.text.as_str()).path(source.name.as_str());
            title.element(snippet.annotation(annotation))
        }
        None => title.element(Origin::path(source.name.as_str())),
    };
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> (Source, Diagnostics) {
        let source = Source::new("robots/my.toml", "name = \"A\"\ngammma = 3\n");
        let diagnostic = Diagnostic::new("unknown key `gammma`", 11..17)
            .label("not a key of a joint")
            .help("did you mean `gamma`?");
        (source, diagnostic.into())
    }

    #[test]
    fn plain_text_shows_the_place() {
        let (source, errors) = example();
        let expected = "\
error: unknown key `gammma`
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
    fn data_has_line_and_column() {
        let (source, errors) = example();
        let located = errors.located(&source);
        assert_eq!(located.len(), 1);
        assert_eq!((located[0].line, located[0].column), (Some(2), Some(1)));
        assert_eq!(located[0].file, "robots/my.toml");
    }

    #[test]
    fn places_outside_the_text_do_no_harm() {
        let source = Source::new("a.toml", "ä");
        for span in [0..1, 1..1, 1..9, 7..9, Span { start: 2, end: 1 }] {
            let errors = Diagnostics::from(Diagnostic::new("wrong", span));
            assert!(errors.render_plain(&source).contains("wrong"));
        }
        let global = Diagnostics::from(Diagnostic::global("nothing there"));
        assert!(global.render_plain(&source).contains("a.toml"));
    }

    type Span = super::super::Span;
}
