//! Text edits that leave the rest of a file unchanged, byte for byte.

use crate::geometry::digits::fine;
use roxmltree::Node;
use std::ops::Range;

/// Replacements of byte ranges.
#[derive(Debug, Default)]
pub(super) struct Patch {
    edits: Vec<(Range<usize>, String)>,
}

impl Patch {
    /// Whether there are no edits.
    pub(super) fn is_empty(&self) -> bool {
        self.edits.is_empty()
    }

    /// Text with all edits applied.
    pub(super) fn applied(mut self, text: &str) -> String {
        self.edits
            .sort_by_key(|(range, _)| (range.start, range.end));
        let mut new = String::with_capacity(text.len() + 1000);
        let mut at = 0;
        for (range, with) in self.edits {
            new.push_str(&text[at..range.start]);
            new.push_str(&with);
            at = range.end;
        }
        new.push_str(&text[at..]);
        new
    }

    fn replace(&mut self, range: Range<usize>, with: impl Into<String>) {
        self.edits.push((range, with.into()));
    }

    /// Sets an attribute, or adds it after the element's last attribute.
    pub(super) fn set(&mut self, node: Node<'_, '_>, name: &str, value: &str) {
        match node.attribute_node(name) {
            Some(attribute) => self.replace(attribute.range_value(), value),
            None => {
                let behind = node.attributes().next_back().map(|last| last.range().end);
                let behind =
                    behind.unwrap_or_else(|| node.range().start + 1 + node.tag_name().name().len());
                self.replace(behind..behind, format!(" {name}=\"{value}\""));
            }
        }
    }

    /// Replaces an attribute by one with another name.
    pub(super) fn rename(&mut self, node: Node<'_, '_>, from: &str, to: &str, value: &str) {
        match node.attribute_node(from) {
            Some(attribute) => self.replace(attribute.range(), format!("{to}=\"{value}\"")),
            None => self.set(node, to, value),
        }
    }

    /// Removes an attribute and the blanks before it.
    pub(super) fn remove(&mut self, text: &str, node: Node<'_, '_>, name: &str) {
        let Some(attribute) = node.attribute_node(name) else {
            return;
        };
        let range = attribute.range();
        let before = text[..range.start].trim_end().len();
        self.replace(before..range.end, "");
    }

    /// Appends a child element, on its own line if the other children have theirs.
    pub(super) fn append(&mut self, text: &str, node: Node<'_, '_>, element: &str) {
        match node.children().rfind(Node::is_element) {
            Some(last) => {
                let range = last.range();
                let line = text[..range.start].rfind('\n').map_or(0, |at| at + 1);
                let indent = &text[line..range.start];
                let between = if indent.trim().is_empty() && line > 0 {
                    format!("\n{indent}")
                } else {
                    String::new()
                };
                self.replace(range.end..range.end, format!("{between}{element}"));
            }
            None => {
                let range = node.range();
                let own = &text[range.clone()];
                let name = node.tag_name().name();
                match own.strip_suffix("/>") {
                    Some(open) => {
                        let from = range.start + open.trim_end().len();
                        self.replace(from..range.end, format!(">{element}</{name}>"));
                    }
                    None => {
                        let close = range.start + own.rfind("</").unwrap_or(own.len());
                        self.replace(close..close, element.to_owned());
                    }
                }
            }
        }
    }
}

/// Element whose start tag begins at a byte offset.
pub(super) fn element_at<'a, 'i>(
    document: &'a roxmltree::Document<'i>,
    start: usize,
) -> Option<Node<'a, 'i>> {
    let mut all = document.descendants();
    all.find(|node| node.is_element() && node.range().start == start)
}

/// Formats numbers with blanks between them, rounded as far as their precision allows.
pub(super) fn numbers(values: &[f64]) -> String {
    let scale = values.iter().copied().map(f64::abs).fold(0.0, f64::max);
    let shown: Vec<String> = values.iter().map(|value| fine(*value, scale)).collect();
    shown.join(" ")
}
