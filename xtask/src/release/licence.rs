//! Licence expressions, and the licences that dependencies may have.

/// Licences compatible with MIT and Apache-2.0, those of this repository.
///
/// CC0-1.0 has no conditions; like MIT, it does not grant patents. A macro of a hash function for
/// WebAssembly uses it.
const PERMITTED: [&str; 10] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Zlib",
];

/// Whether an expression like `(MIT OR Apache-2.0) AND Unicode-3.0` permits a choice; old manifests
/// write `/` for `OR`.
pub(crate) fn is_permitted(expression: &str) -> bool {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut at = 0;
    let permitted = any_of(&words, &mut at);
    permitted && at == words.len()
}

/// Alternatives; `AND` binds more tightly than `OR`.
fn any_of(words: &[&str], at: &mut usize) -> bool {
    let mut permitted = all_of(words, at);
    while words.get(*at) == Some(&"OR") {
        *at += 1;
        permitted |= all_of(words, at);
    }
    permitted
}

fn all_of(words: &[&str], at: &mut usize) -> bool {
    let mut permitted = one(words, at);
    while words.get(*at) == Some(&"AND") {
        *at += 1;
        permitted &= one(words, at);
    }
    permitted
}

fn one(words: &[&str], at: &mut usize) -> bool {
    let Some(&word) = words.get(*at) else {
        // An incomplete expression permits nothing.
        *at = words.len() + 1;
        return false;
    };
    *at += 1;
    if word == "(" {
        let permitted = any_of(words, at);
        let is_closed = words.get(*at) == Some(&")");
        *at += 1;
        return permitted && is_closed;
    }
    if words.get(*at) == Some(&"WITH") {
        let exception = words.get(*at + 1).copied().unwrap_or_default();
        *at += 2;
        return PERMITTED.contains(&format!("{word} WITH {exception}").as_str());
    }
    PERMITTED.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::is_permitted;

    #[test]
    fn spdx_expressions_are_evaluated() {
        for good in [
            "MIT",
            "MIT/Apache-2.0",
            "GPL-3.0 OR MIT",
            "(MIT OR GPL-3.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception OR GPL-3.0",
        ] {
            assert!(is_permitted(good), "{good}");
        }
        for bad in [
            "",
            "GPL-3.0",
            "MIT AND GPL-3.0",
            "MIT AND (GPL-3.0 OR LGPL-3.0)",
            "MIT OR",
            "(MIT",
            "MIT MIT",
            "MIT WITH Classpath-exception-2.0",
        ] {
            assert!(!is_permitted(bad), "{bad}");
        }
    }
}
