//! Valid names for a description, close to those of the file.

use std::collections::BTreeSet;

/// Names in use.
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// Valid name that is not yet in use.
    pub(crate) fn unique(&mut self, name: &str) -> String {
        let word = word(name);
        let mut own = word.clone();
        let mut number = 2;
        while !self.taken.insert(own.clone()) {
            own = format!("{word}_{number}");
            number += 1;
        }
        own
    }
}

/// Converts a name to letters, digits and underscores, beginning with a letter and not a reserved
/// word.
pub(crate) fn word(name: &str) -> String {
    let sound = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let text: String = name.chars().map(sound).collect();
    let text = text.trim_matches('_');
    let text = if text.is_empty() { "joint" } else { text };
    let reserved = ["base", "ground", "payload", "platform"];
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) && !reserved.contains(&text) {
        text.to_owned()
    } else {
        format!("j_{text}")
    }
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn imported_names_become_unique_identifiers() {
        let mut names = Names::default();
        assert_eq!(names.unique("toe_b_1/2"), "toe_b_1_2");
        assert_eq!(names.unique("toe_b_1\\2"), "toe_b_1_2_2");
        assert_eq!(names.unique("1"), "j_1");
        assert_eq!(names.unique("关节"), "joint");
        assert_eq!(names.unique("base"), "j_base");
    }
}
