//! Record of one import: contents used, ignored and reported, with equal entries counted.

use std::collections::BTreeMap;

/// Largest number of entries with the same treatment and reason; further ones are counted together.
const MOST_ENTRIES: usize = 200;

/// Name of the entry that counts further elements and attributes.
const FURTHER: &str = "further names";

/// Treatment of an element or attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Use {
    Honoured,
    /// Omitted, without effect on the dynamics.
    Ignored,
    /// Omitted, and the model may therefore differ from the file.
    Reported,
}

/// Equal elements or attributes of a file with the same treatment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// File name as the user gave it.
    pub file: String,
    /// Line of the first occurrence, counted from 1.
    pub line: usize,
    /// Name of the element, or of the key in formats without elements.
    pub element: String,
    /// Name of the attribute; `None` for a whole element.
    pub attribute: Option<String>,
    /// Reason for not using it; empty if it is used.
    pub reason: String,
    /// Number of occurrences.
    pub count: usize,
}

/// What an import used of its files, ordered by file and line.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Account {
    /// Contents that became part of the description.
    pub honoured: Vec<Entry>,
    /// Omitted contents without effect on rigid-body dynamics.
    pub ignored: Vec<Entry>,
    /// Omitted contents that may change the model.
    pub reported: Vec<Entry>,
}

/// Entries with equal keys are counted together: use, file, element, attribute, reason.
type Key = (Use, usize, String, Option<String>, String);

/// Entries with the byte offset of the first occurrence, and their count.
#[derive(Debug, Default)]
pub(crate) struct Ledger {
    entries: BTreeMap<Key, (usize, usize)>,
}

/// Entries with the same treatment and reason.
#[derive(Debug, Default)]
struct Listed {
    entries: usize,
    /// Index of the last one in its list.
    last: usize,
}

impl Ledger {
    /// Counts an element or attribute at a byte offset of a file.
    pub(crate) fn add(&mut self, key: Key, at: usize) {
        let entry = self.entries.entry(key).or_insert((at, 0));
        entry.0 = entry.0.min(at);
        entry.1 += 1;
    }

    /// Removes one occurrence that was counted as honoured.
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

    /// Entries by use; `locate` maps a file and byte offset to the file's name and a line.
    pub(crate) fn account(&self, locate: impl Fn(usize, usize) -> (String, usize)) -> Account {
        let mut account = Account::default();
        let mut ordered: Vec<_> = self.entries.iter().collect();
        ordered.sort_by_key(|((_, file, ..), (at, _))| (*file, *at));
        let mut seen: BTreeMap<(Use, &str), Listed> = BTreeMap::new();
        for ((kind, file, element, attribute, reason), (at, count)) in ordered {
            let list = match kind {
                Use::Honoured => &mut account.honoured,
                Use::Ignored => &mut account.ignored,
                Use::Reported => &mut account.reported,
            };
            let listed = seen.entry((*kind, reason)).or_default();
            listed.entries += 1;
            if listed.entries > MOST_ENTRIES + 1 {
                list[listed.last].count += count;
                continue;
            }
            listed.last = list.len();
            let is_further = listed.entries > MOST_ENTRIES;
            let (element, attribute) = if is_further {
                (FURTHER, None)
            } else {
                (element.as_str(), attribute.clone())
            };
            let (name, line) = locate(*file, *at);
            list.push(Entry {
                file: name,
                line,
                element: element.to_owned(),
                attribute,
                reason: reason.clone(),
                count: *count,
            });
        }
        account
    }
}

impl Entry {
    /// Element and attribute, as `joint damping`.
    #[must_use]
    pub fn subject(&self) -> String {
        match &self.attribute {
            Some(attribute) => format!("{} {attribute}", self.element),
            None => self.element.clone(),
        }
    }

    /// Reason, with the number of occurrences.
    #[must_use]
    pub fn counted_reason(&self) -> String {
        match self.count {
            1 => self.reason.clone(),
            count => format!("{} ({count} times)", self.reason),
        }
    }
}
