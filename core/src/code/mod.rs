//! Error codes with their explanations: cause and remedy.
//!
//! Every rejected input has one of these codes. Programs distinguish errors by code, and `overact
//! explain CODE` prints the explanation. Codes are created only in the tables of this folder, so
//! each has an explanation. Numbers are permanent: the number of a code that is no longer used is
//! not reused.
//!
//! The hundreds give the area: 1 a description, 2 its mechanism, 3 logs, 4 an identification, 5 a
//! state, an experiment or an excitation, 6 the command line and its files, 9 overact itself.

mod command;
mod description;
mod identification;
mod logs;
mod mechanism;
mod states;

use core::fmt;

/// An error code, such as `OA102`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(u16);

/// Explanation of an error code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Explanation {
    /// The code.
    pub code: Code,
    /// The error, in a few words.
    pub title: &'static str,
    /// Cause of the error.
    pub cause: &'static str,
    /// Remedy.
    pub cure: &'static str,
}

/// Defines a table of codes with their explanations.
macro_rules! codes {
    ($($name:ident $number:literal $title:literal cause $cause:literal cure $cure:literal)*) => {
        impl $crate::code::Code {
            $(
                #[doc = concat!("`OA", stringify!($number), "`: ", $title, ".")]
                pub const $name: Self = Self($number);
            )*
        }

        /// The codes of this file in numerical order.
        pub(super) const TABLE: &[$crate::code::Explanation] = &[$(
            $crate::code::Explanation {
                code: $crate::code::Code::$name,
                title: $title,
                cause: $cause,
                cure: $cure,
            },
        )*];
    };
}
use codes;

/// The areas with their codes.
const AREAS: [(&str, &[Explanation]); 7] = [
    ("Descriptions", description::TABLE),
    ("Mechanisms", mechanism::TABLE),
    ("Logs", logs::TABLE),
    ("Identification", identification::TABLE),
    ("States, experiments, excitation", states::TABLE),
    ("Command line and files", command::TABLE),
    ("overact itself", command::INTERNAL_TABLE),
];

impl Code {
    /// All codes by area.
    #[must_use]
    pub const fn areas() -> &'static [(&'static str, &'static [Explanation])] {
        &AREAS
    }

    /// All codes in numerical order.
    pub fn all() -> impl Iterator<Item = &'static Explanation> {
        AREAS.iter().flat_map(|(_, table)| table.iter())
    }

    /// Parses a code; `OA102`, `oa102` and `102` are equal.
    #[must_use]
    pub fn named(text: &str) -> Option<Self> {
        let text = text.trim();
        let prefixed = text.get(..2).is_some_and(|p| p.eq_ignore_ascii_case("oa"));
        let digits = if prefixed { text.get(2..)? } else { text };
        let is_number = digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = is_number.then(|| digits.parse().ok()).flatten()?;
        let own = Self::all().find(|one| one.code.0 == number)?;
        Some(own.code)
    }

    /// The explanation of the code.
    #[must_use]
    pub fn explanation(self) -> &'static Explanation {
        Self::all()
            .find(|one| one.code == self)
            .unwrap_or(&command::INTERNAL_TABLE[0])
    }
}

impl fmt::Display for Code {
    /// Writes `OA102`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "OA{:03}", self.0)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::Code;
    use std::{format, string::ToString, vec::Vec};

    #[test]
    fn error_codes_are_unique_ordered_and_explained() {
        let numbers: Vec<u16> = Code::all().map(|one| one.code.0).collect();
        assert!(
            numbers.windows(2).all(|pair| pair[0] < pair[1]),
            "{numbers:?}"
        );
        for (area, table) in Code::areas() {
            let hundreds: Vec<u16> = table.iter().map(|one| one.code.0 / 100).collect();
            assert!(hundreds.windows(2).all(|pair| pair[0] == pair[1]), "{area}");
        }
        for one in Code::all() {
            assert_eq!(one.code.explanation(), one);
            for text in [one.cause, one.cure] {
                assert!(
                    text.ends_with('.') && text.len() > 15,
                    "{}: {text}",
                    one.code
                );
            }
            assert!(
                !one.title.is_empty() && !one.title.ends_with('.'),
                "{}",
                one.code
            );
        }
    }

    #[test]
    fn error_codes_are_parsed_from_their_names() {
        for one in Code::all() {
            let name = one.code.to_string();
            assert_eq!(Code::named(&name), Some(one.code));
            assert_eq!(
                Code::named(&format!(" {} ", name.to_lowercase())),
                Some(one.code)
            );
            assert_eq!(Code::named(&name[2..]), Some(one.code));
        }
        for other in [
            "", "OA", "OA000", "OA1", "OA0101", "E102", "OA+02", "ö102", "OA10ä",
        ] {
            assert_eq!(Code::named(other), None, "{other}");
        }
    }
}
