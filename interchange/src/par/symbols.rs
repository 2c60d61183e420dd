//! Check of the values that the user gives to symbols.

use super::text::Entries;
use crate::{files::Files, options::Options};
use std::collections::BTreeSet;

/// Rejects values of symbols that the file does not have, and second values; `None` after an error.
pub(super) fn check(files: &Files, entries: &Entries, options: &Options) -> Option<()> {
    let texts = entries.values().flat_map(|(_, values)| values);
    let words = texts.flat_map(|(text, _)| text.split(|c: char| !c.is_alphanumeric() && c != '_'));
    let words: BTreeSet<&str> = words.collect();
    for (at, (name, _)) in options.values.iter().enumerate() {
        if !words.contains(name.as_str()) {
            let near = files.did_you_mean(name, words.iter().copied());
            let help = near.unwrap_or_else(|| "name symbols of the file".to_owned());
            files.refuse(format!("`--value`: the file has no symbol `{name}`"), help);
        } else if options.values[..at].iter().any(|(own, _)| own == name) {
            let message = format!("`--value` gives two values of `{name}`");
            files.refuse(message, "give one of them");
        }
    }
    files.is_clean().then_some(())
}
