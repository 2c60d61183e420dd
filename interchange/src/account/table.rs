//! Table type: how import treats each element and attribute of a format.

use std::collections::{BTreeMap, BTreeSet};

/// Treatment of an element or attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Treatment {
    /// Read.
    Honoured,
    /// Its attributes are read; its children are not checked against the table.
    Opaque,
    /// Has no meaning of its own; its attributes and children have their own treatments.
    Container,
    /// Omitted, without effect on rigid-body dynamics.
    Irrelevant(&'static str),
    /// Omitted and reported because it changes the model, unless its value is neutral.
    Reported {
        neutral: &'static str,
        reason: &'static str,
    },
    /// The file is rejected, unless the value is neutral.
    Rejected {
        neutral: &'static str,
        reason: &'static str,
        help: &'static str,
    },
}

/// Treatment of elements of a format, and of their attributes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rule {
    /// Names of possible parent elements, separated by blanks; empty for any parent.
    ///
    /// `a/b` is a parent `b` inside `a`; its children are those of such rules only.
    pub(crate) within: &'static str,
    /// Names of the elements, separated by blanks.
    pub(crate) elements: &'static str,
    pub(crate) treatment: Treatment,
    /// Attribute names, separated by blanks, with their treatment.
    pub(crate) attributes: &'static [(&'static str, Treatment)],
}

/// Table of a format.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Table {
    pub(crate) rules: &'static [Rule],
    /// Names of honoured elements that a parent may have several times, separated by blanks.
    pub(crate) repeatable: &'static str,
    /// Names of honoured elements whose text is read, separated by blanks.
    pub(crate) texts: &'static str,
}

/// Rules of a table by element name.
pub(crate) struct Index {
    repeatable: BTreeSet<&'static str>,
    texts: BTreeSet<&'static str>,
    by_parent: BTreeMap<(&'static str, &'static str), &'static Rule>,
    /// Parents that are given with the element around them.
    paths: BTreeSet<&'static str>,
    by_name: BTreeMap<&'static str, &'static Rule>,
}

impl Index {
    pub(crate) fn new(table: &Table) -> Self {
        let (mut by_parent, mut by_name) = (BTreeMap::new(), BTreeMap::new());
        let parents = table.rules.iter();
        let parents = parents.flat_map(|rule| rule.within.split_whitespace());
        for rule in table.rules {
            for name in rule.elements.split_whitespace() {
                if rule.within.is_empty() {
                    by_name.insert(name, rule);
                }
                for parent in rule.within.split_whitespace() {
                    by_parent.insert((parent, name), rule);
                }
            }
        }
        Self {
            repeatable: table.repeatable.split_whitespace().collect(),
            texts: table.texts.split_whitespace().collect(),
            by_parent,
            paths: parents.filter(|parent| parent.contains('/')).collect(),
            by_name,
        }
    }

    /// Whether a parent may have several honoured elements of a name.
    pub(crate) fn may_repeat(&self, name: &str) -> bool {
        self.repeatable.contains(name)
    }

    /// Whether the text of an honoured element is read.
    pub(crate) fn has_text(&self, name: &str) -> bool {
        self.texts.contains(name)
    }

    /// Names of the elements that a parent inside `outer` may have.
    pub(crate) fn names(&self, outer: &str, parent: &str) -> impl Iterator<Item = &'static str> {
        let place = self.place(outer, parent);
        let own = self.by_parent.keys();
        let own = own.filter(move |(within, _)| *within == place);
        let anywhere = self.by_name.keys().copied();
        own.map(|(_, name)| *name).chain(anywhere)
    }

    /// Name under which the rules of a parent's elements are given.
    fn place(&self, outer: &str, parent: &str) -> String {
        let path = format!("{outer}/{parent}");
        if self.paths.contains(path.as_str()) {
            path
        } else {
            parent.to_owned()
        }
    }

    /// Rule of an element in a parent, which is in `outer`; `None` if the element is unknown.
    pub(crate) fn rule(&self, outer: &str, parent: &str, name: &str) -> Option<&'static Rule> {
        let place = self.place(outer, parent);
        let found = self.by_parent.get(&(place.as_str(), name));
        found.or_else(|| self.by_name.get(name)).copied()
    }
}

impl Rule {
    /// Names of all attributes.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        let all = self.attributes.iter();
        all.flat_map(|(names, _)| names.split_whitespace())
    }

    /// Treatment of an attribute; `None` if it is unknown.
    pub(crate) fn attribute(&self, name: &str) -> Option<Treatment> {
        let mut all = self.attributes.iter();
        let found = all.find(|(names, _)| names.split_whitespace().any(|own| own == name));
        found.map(|(_, treatment)| *treatment)
    }
}

/// Treatment of elements and of their attributes, see [`Rule`].
pub(super) const fn rule(
    within: &'static str,
    elements: &'static str,
    treatment: Treatment,
    attributes: &'static [(&'static str, Treatment)],
) -> Rule {
    Rule {
        within,
        elements,
        treatment,
        attributes,
    }
}

/// Treatment of elements without attributes of their own.
pub(super) const fn whole(
    within: &'static str,
    elements: &'static str,
    treatment: Treatment,
) -> Rule {
    rule(within, elements, treatment, &[])
}

/// Treatment of a value that changes the model unless it is neutral.
pub(super) const fn unless(neutral: &'static str, reason: &'static str) -> Treatment {
    Treatment::Reported { neutral, reason }
}

/// Treatment of contents that always change the model.
pub(super) const fn reported(reason: &'static str) -> Treatment {
    unless("", reason)
}

/// Treatment of contents that make the file unreadable.
pub(super) const fn rejected(reason: &'static str, help: &'static str) -> Treatment {
    Treatment::Rejected {
        neutral: "",
        reason,
        help,
    }
}

/// Neutral value of 4 × 4 matrices.
pub(super) const IDENTITY: &str = "identity";

/// Neutral value of gravity: 9.81 m/s² against z.
pub(super) const USUAL_GRAVITY: &str = "usual gravity";

/// Whether a value consists of neutral numbers or words, or is a neutral vector or matrix.
///
/// A value without words is not neutral.
pub(crate) fn is_neutral(value: &str, neutral: &str) -> bool {
    if neutral.is_empty() || value.trim().is_empty() {
        return false;
    }
    let numbers = || -> Vec<Option<f64>> {
        let words = value.split([' ', '\t', '\n', '\r', ',']);
        let words = words.filter(|word| !word.is_empty());
        words.map(|word| word.parse().ok()).collect()
    };
    if neutral == USUAL_GRAVITY {
        return numbers() == [Some(0.0), Some(0.0), Some(-9.81)];
    }
    if neutral == IDENTITY {
        let numbers = numbers();
        let mut entries = numbers.iter().enumerate();
        return numbers.len() == 16
            && entries.all(|(at, value)| *value == Some(if at % 5 == 0 { 1.0 } else { 0.0 }));
    }
    let is_one_of = |word: &str| neutral.split_whitespace().any(|own| own == word);
    let is_number = |word: &str| {
        let given = word.parse::<f64>();
        let mut own = neutral.split_whitespace().map(str::parse::<f64>);
        given.is_ok_and(|given| own.any(|own| own == Ok(given)))
    };
    let mut words = value
        .split([' ', '\t', '\n', '\r', ','])
        .filter(|word| !word.is_empty());
    words.all(|word| is_one_of(word) || is_number(word))
}

#[cfg(test)]
mod tests {
    use super::is_neutral;

    #[test]
    fn neutral_values_are_compared_as_numbers_or_words() {
        assert!(is_neutral("0.0 0 -0", "0"));
        assert!(is_neutral("False", "false False 0"));
        assert!(!is_neutral("0 1e-9", "0"));
        assert!(!is_neutral("true", "false"));
        assert!(!is_neutral("anything", ""));
        assert!(!is_neutral(" ", "0"));
        assert!(is_neutral("0 0 -9.810", super::USUAL_GRAVITY));
        assert!(!is_neutral("0 -9.81 0", super::USUAL_GRAVITY));
        let rows = |first: &str| format!("{first} 0 1 0 0 0 0 1 0 0 0 0 1");
        assert!(is_neutral(&rows("1 0 0 0"), super::IDENTITY));
        assert!(!is_neutral(&rows("0 1 0 0"), super::IDENTITY));
    }
}
