//! Which tier of the tests runs.
//!
//! `cargo test --workspace` runs the default tier: every test, over few states, mechanisms and seeds.
//! `OVERACT_TESTS=full cargo test --workspace` runs the full tier: the same tests over many. A test
//! asks here how much it has to do; nothing else reads the variable.

/// The environment variable that chooses the tier.
pub const VARIABLE: &str = "OVERACT_TESTS";

/// Whether the full tier runs.
///
/// # Panics
///
/// If the variable has a value that names no tier: a misspelled one would run too little unnoticed.
#[must_use]
pub fn is_full() -> bool {
    let Some(value) = std::env::var_os(VARIABLE) else {
        return false;
    };
    match value.to_str() {
        Some("full") => true,
        Some("" | "default") => false,
        _ => panic!("{VARIABLE} is `default` or `full`, not {}", value.display()),
    }
}

/// How much the tier that runs has to do, of `[default, full]`.
#[must_use]
pub fn by_tier<T>([default, full]: [T; 2]) -> T {
    if is_full() { full } else { default }
}
