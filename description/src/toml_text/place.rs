//! Location of a key in a description, for errors that are found after parsing.

use crate::diagnostic::{Source, Span};
use toml::de::{DeTable, DeValue};

/// A part of a path: a key, or the index of an element.
enum PathPart<'p> {
    Key(&'p str),
    Element(usize),
}

/// Location of a value by its path, such as `experiment.run[1].terms[0].harmonic`.
///
/// For a missing value it is that of the table or list around it.
#[must_use]
pub fn place(source: &Source, path: &str) -> Option<Span> {
    let (document, _) = DeTable::parse_recoverable(&source.text);
    let mut parts = parts(path).into_iter();
    let Some(PathPart::Key(first)) = parts.next() else {
        return None;
    };
    let mut at = document.get_ref().get(first)?;
    for part in parts {
        let within = match (part, at.get_ref()) {
            (PathPart::Key(key), DeValue::Table(table)) => table.get(key),
            (PathPart::Element(index), DeValue::Array(array)) => array.get(index),
            _ => None,
        };
        let Some(within) = within else { break };
        at = within;
    }
    Some(at.span())
}

fn parts(path: &str) -> Vec<PathPart<'_>> {
    path.split(['.', '['])
        .map(|part| match part.strip_suffix(']').map(str::parse) {
            Some(Ok(index)) => PathPart::Element(index),
            _ => PathPart::Key(part),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::place;
    use crate::diagnostic::Source;

    #[test]
    fn keys_or_their_parent_tables_are_located() {
        let text = "[a]\nb = 1\n[[a.run]]\nt = [{ h = 7 }, { h = 8 }]\n[[a.run]]\nt = []\n";
        let source = Source::new("my.toml", text);
        let found = |path: &str| {
            let span = place(&source, path).unwrap();
            (source.position(&span).line, &text[span])
        };
        assert_eq!(found("a.b"), (2, "1"));
        assert_eq!(found("a.run[0].t[1].h"), (4, "8"));
        assert_eq!(found("a.run[0].t[1].missing"), (4, "{ h = 8 }"));
        assert_eq!(found("a.run[1].t[4].h").0, 6);
        assert_eq!(found("a.run[1].missing").0, 5);
        assert_eq!(found("a.missing").0, 1);
        assert!(place(&source, "missing.b").is_none());
    }
}
