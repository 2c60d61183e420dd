//! XML as a tree of elements with locations; no entities, bounded depth and size.

#[cfg(test)]
use crate::account::trace;
use crate::files::{Files, Place};

/// Largest depth of nested elements, including those of included files.
pub(crate) const DEPTH: usize = 400;
/// Largest number of attributes of an element.
const MOST_ATTRIBUTES: usize = 200;
/// Largest number of attributes before parsing, because the parser compares each with all others.
const PARSED_ATTRIBUTES: usize = 5_000;
/// Largest number of namespace declarations, which each element inherits.
const MOST_NAMESPACES: usize = 1_000;

/// An XML element.
#[derive(Debug, Clone)]
pub(crate) struct Element {
    /// Tag name.
    pub(crate) name: String,
    /// Attributes in file order: name, value, location of the value.
    pub(crate) attributes: Vec<(String, String, Place)>,
    /// Child elements.
    pub(crate) children: Vec<Element>,
    /// Trimmed text and its location; the location of the element if there is no text.
    pub(crate) text: (String, Place),
    /// Location of the start tag.
    pub(crate) place: Place,
}

/// Parses a file; `None` after an error.
pub(crate) fn parse(files: &Files, file: usize) -> Option<Element> {
    let text = files.text(file);
    check_tags(files, file, &text)?;
    let most = files.elements_left();
    let options = roxmltree::ParsingOptions {
        allow_dtd: false,
        // Elements and the text and comment nodes between them.
        nodes_limit: u32::try_from(3 * most + 3).unwrap_or(u32::MAX),
        ..roxmltree::ParsingOptions::default()
    };
    let document = match roxmltree::Document::parse_with_options(&text, options) {
        Ok(document) => document,
        Err(error) => {
            let place = place_of(&text, file, error.pos());
            let help = match error {
                roxmltree::Error::DtdDetected => {
                    "remove the document type and its entities: write out their contents"
                }
                roxmltree::Error::NodesLimitReached => {
                    files.count_elements(most);
                    "describe the robot in fewer elements"
                }
                _ => "the file has to be well-formed XML",
            };
            files.report(&place, format!("this is not valid XML: {error}"), help);
            return None;
        }
    };
    let elements = document.descendants().filter(roxmltree::Node::is_element);
    let count = elements.clone().count();
    if count > most {
        let place = Place { file, span: 0..1 };
        let help = "describe the robot in fewer elements";
        files.report(&place, "the files have too many elements", help);
        files.count_elements(most);
        return None;
    }
    files.count_elements(count);
    let mut crowded = elements.filter(|own| own.attributes().len() > MOST_ATTRIBUTES);
    if let Some(own) = crowded.next() {
        let start = own.range().start;
        let place = Place {
            file,
            span: start..start + 1,
        };
        let name = own.tag_name().name();
        let message = format!("`{name}` has more than {MOST_ATTRIBUTES} attributes");
        files.report(&place, message, "no element of a robot has so many");
        return None;
    }
    let found = element(document.root_element(), file, 0);
    if found.is_none() {
        too_deep(files, &Place { file, span: 0..1 });
    }
    found
}

/// Reports elements nested deeper than [`DEPTH`].
pub(crate) fn too_deep(files: &Files, place: &Place) {
    let message = format!("elements are nested more than {DEPTH} deep");
    files.report(place, message, "describe the robot in parts");
}

/// Rejects tags with too many attributes and files with too many namespaces, which parse slowly.
fn check_tags(files: &Files, file: usize, text: &str) -> Option<()> {
    let help = "no element of a robot has so many";
    let mut start = 0;
    for part in text.split('<') {
        if part.bytes().filter(|byte| *byte == b'=').count() > PARSED_ATTRIBUTES {
            let span = start..start + 1;
            let message = format!("a tag has more than {PARSED_ATTRIBUTES} attributes");
            files.report(&Place { file, span }, message, help);
            return None;
        }
        start += part.len() + 1;
    }
    if text.matches("xmlns").count() > MOST_NAMESPACES {
        let message = format!("the file declares more than {MOST_NAMESPACES} namespaces");
        let place = Place { file, span: 0..1 };
        files.report(&place, message, "remove the declarations");
        return None;
    }
    Some(())
}

/// Location of a line and column.
fn place_of(text: &str, file: usize, at: roxmltree::TextPos) -> Place {
    let line = (at.row as usize).saturating_sub(1);
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let rest = &text[start..];
    let column = (at.col as usize).saturating_sub(1);
    let inner = rest.char_indices().nth(column).map_or(0, |(byte, _)| byte);
    let span = start + inner..start + inner + 1;
    Place { file, span }
}

/// Converts a node with its children; `None` if nested too deep.
pub(crate) fn element(node: roxmltree::Node<'_, '_>, file: usize, depth: usize) -> Option<Element> {
    if depth > DEPTH {
        return None;
    }
    let attributes = node.attributes().map(|a| {
        let place = Place {
            file,
            span: a.range_value(),
        };
        (a.name().to_owned(), a.value().to_owned(), place)
    });
    let children = node.children().filter(|child| child.is_element());
    let children = children.map(|child| element(child, file, depth + 1));
    let start = node.range().start;
    let name = node.tag_name().name().to_owned();
    let place = Place {
        file,
        span: start..start + 1 + name.len(),
    };
    Some(Element {
        attributes: attributes.collect(),
        children: children.collect::<Option<Vec<_>>>()?,
        text: text(node, &place),
        place,
        name,
    })
}

/// Text of a node between its child elements and comments.
fn text(node: roxmltree::Node<'_, '_>, place: &Place) -> (String, Place) {
    let mut all = String::new();
    let mut span: Option<std::ops::Range<usize>> = None;
    for part in node.children().filter(roxmltree::Node::is_text) {
        let own = part.text().unwrap_or_default();
        let inside = own.trim();
        if inside.is_empty() {
            continue;
        }
        let range = part.range();
        // With character references, lengths in text and file differ; only the whole range is then
        // known.
        let before = own.len() - own.trim_start().len();
        let (start, end) = if own.len() == range.len() {
            (range.start + before, range.start + before + inside.len())
        } else {
            (range.start, range.end)
        };
        span = Some(span.map_or(start..end, |span| span.start..end));
        if !all.is_empty() {
            all.push(' ');
        }
        all.push_str(inside);
    }
    let place = span.map_or_else(
        || place.clone(),
        |span| Place {
            file: place.file,
            span,
        },
    );
    (all, place)
}

impl Element {
    /// Value of an attribute.
    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        self.attribute(name).map(|(value, _)| value)
    }

    /// Value of an attribute and its location.
    pub(crate) fn attribute(&self, name: &str) -> Option<(&str, &Place)> {
        #[cfg(test)]
        trace::attribute(&self.name, name);
        let mut all = self.attributes.iter();
        all.find(|(own, ..)| own == name)
            .map(|(_, value, place)| (value.as_str(), place))
    }

    /// First child element with a name.
    pub(crate) fn child(&self, name: &str) -> Option<&Self> {
        #[cfg(test)]
        trace::child(&self.name, name);
        self.children.iter().find(|child| child.name == name)
    }

    /// All child elements with a name.
    pub(crate) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Self> + 'a {
        #[cfg(test)]
        trace::child(&self.name, name);
        self.children.iter().filter(move |child| child.name == name)
    }

    /// Word in an attribute; `None` if it is absent, or not one of those allowed, which is an error.
    pub(crate) fn keyword(&self, files: &Files, name: &str, allowed: &[&str]) -> Option<&str> {
        let (word, place) = self.attribute(name)?;
        if allowed.contains(&word) {
            return Some(word);
        }
        let message = format!("`{word}` is not a value of `{name}` of `{}`", self.name);
        let help = format!("write {}", allowed.join(" or "));
        files.report(place, message, help);
        None
    }

    /// Number in an attribute; the default if it is absent or invalid.
    pub(crate) fn number(&self, files: &Files, name: &str, default: f64) -> f64 {
        self.numbers(files, name).map_or(default, |[value]| value)
    }

    /// `N` numbers in an attribute; `None` if it is absent or invalid.
    pub(crate) fn numbers<const N: usize>(&self, files: &Files, name: &str) -> Option<[f64; N]> {
        let (text, place) = self.attribute(name)?;
        match numbers(text).map(<[f64; N]>::try_from) {
            Some(Ok(values)) => Some(values),
            _ => {
                let message = format!("`{name}` of `{}` must be {}", self.name, expected(N));
                files.report(place, message, "write numbers with a decimal point, without units, and with blanks between them");
                None
            }
        }
    }

    /// List of numbers in an attribute.
    pub(crate) fn list(&self, files: &Files, name: &str) -> Option<Vec<f64>> {
        let (text, place) = self.attribute(name)?;
        let found = numbers(text);
        if found.is_none() {
            let message = format!(
                "`{name}` of `{}` must be a list of finite numbers",
                self.name
            );
            files.report(
                place,
                message,
                "write numbers with a decimal point, without units, and with blanks between them",
            );
        }
        found
    }

    /// Required attribute; reports an error if absent.
    pub(crate) fn required(&self, files: &Files, name: &str) -> Option<&str> {
        let found = self.get(name);
        if found.is_none() {
            let message = format!("`{}` has no `{name}`", self.name);
            files.report(&self.place, message, format!("write {name}=\"…\""));
        }
        found
    }
}

/// Words for an expected number of numbers, as in "must be 3 finite numbers".
pub(crate) fn expected(numbers: usize) -> String {
    match numbers {
        1 => String::from("a finite number"),
        _ => format!("{numbers} finite numbers"),
    }
}

/// Parses numbers separated by blanks or commas; `None` if one is not finite.
pub(crate) fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text
        .split([' ', '\t', '\n', '\r', ','])
        .filter(|word| !word.is_empty());
    let number = |word: &str| word.parse::<f64>().ok().filter(|value| value.is_finite());
    words.map(number).collect()
}
