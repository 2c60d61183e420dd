//! The record of one import: what was used, ignored and reported, equal entries counted together.

use std::collections::BTreeMap;

/// What became of an element or attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Use {
    Honoured,
    /// Left out without an effect on the dynamics.
    Ignored,
    /// Left out; the model may differ from the file's.
    Reported,
}

/// Equal elements or attributes of a file, of which the same became.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The file, as it was named.
    pub file: String,
    /// The line of the first of them, from 1.
    pub line: usize,
    /// Name of the element, or of the key in formats without elements.
    pub element: String,
    /// Name of the attribute; none of a whole element.
    pub attribute: Option<String>,
    /// Why it is not used; empty of what is.
    pub reason: String,
    /// How many there are.
    pub count: usize,
}

/// What an import used of its files, in the order of files and lines.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// What became part of the description.
    pub honoured: Vec<Entry>,
    /// What was left out and has no effect on the dynamics of rigid bodies.
    pub ignored: Vec<Entry>,
    /// What was left out although the model may differ without it.
    pub reported: Vec<Entry>,
}

/// What entries are counted together by: use, file, element, attribute, reason.
type Key = (Use, usize, String, Option<String>, String);

/// Entries with the byte at which the first of them stands, and their count.
#[derive(Debug, Default)]
pub(crate) struct Ledger {
    entries: BTreeMap<Key, (usize, usize)>,
}

impl Ledger {
    /// Counts an element or attribute at a byte of a file.
    pub(crate) fn add(&mut self, key: Key, at: usize) {
        let entry = self.entries.entry(key).or_insert((at, 0));
        entry.0 = entry.0.min(at);
        entry.1 += 1;
    }

    /// Takes one of what counts as used back.
    pub(crate) fn retract(&mut self, file: usize, element: &str, attribute: Option<&str>) {
        let key = (
            Use::Honoured,
            file,
            element.to_owned(),
            attribute.map(str::to_owned),
            String::new(),
        );
        if let Some(entry) = self.entries.get_mut(&key) {
            entry.1 -= 1;
            if entry.1 == 0 {
                self.entries.remove(&key);
            }
        }
    }

    /// The entries by use; `locate` gives the name of a file and the line of a byte in it.
    pub(crate) fn account(&self, locate: impl Fn(usize, usize) -> (String, usize)) -> Account {
        let mut account = Account::default();
        let mut ordered: Vec<_> = self.entries.iter().collect();
        ordered.sort_by_key(|((_, file, ..), (at, _))| (*file, *at));
        for ((kind, file, element, attribute, reason), (at, count)) in ordered {
            let (name, line) = locate(*file, *at);
            let list = match kind {
                Use::Honoured => &mut account.honoured,
                Use::Ignored => &mut account.ignored,
                Use::Reported => &mut account.reported,
            };
            list.push(Entry {
                file: name,
                line,
                element: element.clone(),
                attribute: attribute.clone(),
                reason: reason.clone(),
                count: *count,
            });
        }
        account
    }
}

impl Entry {
    /// The element and attribute: `joint damping`.
    #[must_use]
    pub fn subject(&self) -> String {
        match &self.attribute {
            Some(attribute) => format!("{} {attribute}", self.element),
            None => self.element.clone(),
        }
    }

    /// The reason, with how often it applies.
    #[must_use]
    pub fn counted_reason(&self) -> String {
        match self.count {
            1 => self.reason.clone(),
            count => format!("{} ({count} times)", self.reason),
        }
    }
}
