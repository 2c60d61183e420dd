//! Removes elements and attributes that a format's table does not honour, and records them.
//!
//! Readers then see honoured contents only.

use crate::{
    account::{Index, Rule, Table, Treatment, Use, is_neutral},
    files::{Files, Place},
    xml::Element,
};
use std::collections::BTreeSet;

/// Reason for names that are not in the table.
const UNKNOWN: &str = "not in the specification; not used";

/// Name of unknown contents of files outside the robot's folder.
const HIDDEN: &str = "?";

/// Reason for values without effect, which are not reported.
const NEUTRAL: &str = "this value has no effect";

/// Reason for text in elements that have none.
const TEXT: &str = "text is not used: values are attributes or elements";

/// Removes and records everything in a tree that the table does not honour.
pub(crate) fn keep_honoured(files: &Files, table: &Table, root: &mut Element) {
    let index = Index::new(table);
    if let Some(rule) = index.rule("", "", &root.name) {
        keep_inside(files, &index, rule, "", root);
    }
}

/// Prunes an element inside `outer`.
fn keep_inside(files: &Files, index: &Index, rule: &Rule, outer: &str, element: &mut Element) {
    let tag = element.name.clone();
    element.attributes.retain(|(name, value, place)| {
        let subject = Subject {
            element: &tag,
            attribute: Some(name),
            value,
            is_empty: false,
            place,
        };
        is_kept(files, rule.attribute(name), &subject, rule.names())
    });
    let (text, text_place) = &element.text;
    if rule.treatment == Treatment::Honoured && !text.is_empty() && !index.has_text(&tag) {
        files.record(Use::Reported, text_place, &tag, None, TEXT);
    }
    refuse_repetitions(files, index, outer, element);
    element.children.retain_mut(|child| {
        let rule = index.rule(outer, &tag, &child.name);
        let subject = Subject {
            element: &child.name,
            attribute: None,
            value: if has_parts(child) { "" } else { &child.text.0 },
            is_empty: is_empty(child),
            place: &child.place,
        };
        let names = index.names(outer, &tag);
        let is_kept = is_kept(files, rule.map(|rule| rule.treatment), &subject, names);
        let Some(rule) = rule else {
            return is_kept;
        };
        if rule.treatment == Treatment::Opaque {
            child.children.clear();
        }
        let is_open = [Treatment::Honoured, Treatment::Opaque, Treatment::Container];
        if is_open.contains(&rule.treatment) {
            keep_inside(files, index, rule, &tag, child);
        }
        is_kept
    });
}

/// Reports honoured elements that a parent has twice, of which readers would see the first only.
fn refuse_repetitions(files: &Files, index: &Index, outer: &str, element: &Element) {
    let mut seen = BTreeSet::new();
    for child in &element.children {
        let rule = index.rule(outer, &element.name, &child.name);
        let is_read = rule.is_some_and(|rule| rule.treatment == Treatment::Honoured);
        if is_read && !index.may_repeat(&child.name) && !seen.insert(child.name.as_str()) {
            let message = format!("<{}> has a second <{}>", element.name, child.name);
            files.report(&child.place, message, "keep one of them");
        }
    }
}

/// Whether an element has no contents, and therefore its default value.
fn is_empty(element: &Element) -> bool {
    element.text.0.is_empty() && !has_parts(element)
}

/// Whether an element has attributes or children.
fn has_parts(element: &Element) -> bool {
    !element.attributes.is_empty() || !element.children.is_empty()
}

/// An element or attribute of a file.
struct Subject<'s> {
    element: &'s str,
    attribute: Option<&'s str>,
    /// Value to compare with neutral ones; empty for elements with attributes or children.
    value: &'s str,
    /// Whether it is an element without contents.
    is_empty: bool,
    place: &'s Place,
}

/// Records the treatment of an element or attribute; true if readers are to see it.
///
/// An unknown name is compared with the `known` ones.
fn is_kept(
    files: &Files,
    treatment: Option<Treatment>,
    subject: &Subject<'_>,
    known: impl Iterator<Item = &'static str>,
) -> bool {
    let record = |kind, reason| {
        files.record(
            kind,
            subject.place,
            subject.element,
            subject.attribute,
            reason,
        );
    };
    match treatment {
        Some(Treatment::Honoured | Treatment::Opaque) => {
            record(Use::Honoured, "");
            return true;
        }
        Some(Treatment::Container) => {}
        Some(Treatment::Irrelevant(reason)) => record(Use::Ignored, reason),
        Some(Treatment::Reported { neutral, .. } | Treatment::Rejected { neutral, .. })
            if is_neutral(subject.value, neutral) || subject.is_empty && !neutral.is_empty() =>
        {
            record(Use::Ignored, NEUTRAL)
        }
        Some(Treatment::Reported { reason, .. }) => record(Use::Reported, reason),
        Some(Treatment::Rejected { reason, help, .. }) => {
            let element = subject.element;
            let message = match subject.attribute {
                Some(attribute) => format!("`{attribute}` of <{element}>: {reason}"),
                None => format!("<{element}>: {reason}"),
            };
            files.report(subject.place, message, help);
        }
        // The name itself may be a content that messages may not show.
        None if files.is_outside(subject.place.file) => {
            let names = match subject.attribute {
                Some(_) => (subject.element, Some(HIDDEN)),
                None => (HIDDEN, None),
            };
            files.record(Use::Reported, subject.place, names.0, names.1, UNKNOWN);
        }
        None => {
            let name = subject.attribute.unwrap_or(subject.element);
            let near = files.did_you_mean(name, known);
            let reason = near.as_ref().map(|near| format!("{UNKNOWN}; {near}"));
            record(Use::Reported, reason.as_deref().unwrap_or(UNKNOWN));
            if let Some(near) = near {
                files.suspect(subject.place, name, near);
            }
        }
    }
    false
}

/// Records a key of a format without XML elements.
pub(crate) fn record_key(
    files: &Files,
    table: &Table,
    format: &str,
    key: &str,
    value: &str,
    place: &Place,
) {
    let rule = Index::new(table).rule("", "", format);
    let subject = Subject {
        element: format,
        attribute: Some(key),
        value,
        is_empty: false,
        place,
    };
    let known = rule.into_iter().flat_map(Rule::names);
    let treatment = rule.and_then(|rule| rule.attribute(key));
    is_kept(files, treatment, &subject, known);
}
