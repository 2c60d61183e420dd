//! Path of the runtime crate in generated Rust.

use std::fmt;

/// The path of the crate `overact` in generated Rust.
///
/// It is `::overact` by default; it differs if the crate is renamed or re-exported by another
/// crate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Runtime {
    path: String,
}

impl Default for Runtime {
    fn default() -> Self {
        Self {
            path: "::overact".to_owned(),
        }
    }
}

impl Runtime {
    /// The crate at a path, such as `::my_robotics::overact` or `crate::vendor::overact`.
    ///
    /// # Errors
    /// A text that is not a path, or a path that depends on the scope, such as `self`.
    pub fn new(path: &str) -> Result<Self, NotAPath> {
        let refused = || NotAPath(path.to_owned());
        let parser = syn::Path::parse_mod_style;
        let parsed = syn::parse::Parser::parse_str(parser, path).map_err(|_| refused())?;
        let mut names = parsed
            .segments
            .iter()
            .map(|segment| segment.ident.to_string());
        let is_relative = names.any(|name| ["self", "super", "Self"].contains(&&*name));
        if is_relative {
            Err(refused())
        } else {
            Ok(Self {
                path: path.trim().to_owned(),
            })
        }
    }

    /// The path.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.path
    }
}

/// A text that is not a crate's path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotAPath(String);

impl fmt::Display for NotAPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let path = &self.0;
        write!(
            f,
            "`{path}` is not a path of the crate that generated code calls, such as `::overact` or `crate::vendor::overact`"
        )
    }
}

impl std::error::Error for NotAPath {}

#[cfg(test)]
mod tests {
    use super::Runtime;

    #[test]
    fn runtime_paths_are_validated() {
        for path in ["::overact", "overact", "crate::vendor::overact", " ::a::b "] {
            assert_eq!(Runtime::new(path).expect("a path").path(), path.trim());
        }
        for text in [
            "",
            "::",
            "a b",
            "a::<u8>",
            "super::overact",
            "self::a",
            "\"",
            "a::b;",
        ] {
            let refused = Runtime::new(text).expect_err("no path").to_string();
            assert!(refused.contains("::overact"), "{refused}");
        }
    }
}
