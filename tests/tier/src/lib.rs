//! Tier of the tests.
//!
//! `cargo test --workspace` runs the default tier: every test, with few states, mechanisms and
//! seeds. `OVERACT_TESTS=full` runs the full tier: the same tests with many. `OVERACT_TESTS=night`
//! also runs tests that take minutes of compilation, and leaves out no repetition. Only this crate reads the variables.

/// Environment variable for the number of random robots or draws of noise.
pub const COUNT: &str = "OVERACT_RANDOM_COUNT";

/// Environment variable for the tier.
pub const VARIABLE: &str = "OVERACT_TESTS";

/// The tiers, the smallest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Tier {
    Default,
    Full,
    Night,
}

/// The current tier.
///
/// # Panics
///
/// If the variable has an unknown value, which would otherwise run too little unnoticed.
fn tier() -> Tier {
    let Some(value) = std::env::var_os(VARIABLE) else {
        return Tier::Default;
    };
    match value.to_str() {
        Some("night") => Tier::Night,
        Some("full") => Tier::Full,
        Some("" | "default") => Tier::Default,
        _ => panic!(
            "{VARIABLE} is `default`, `full` or `night`, not {}",
            value.display()
        ),
    }
}

/// Whether the full or nightly tier runs.
#[must_use]
pub fn is_full() -> bool {
    tier() >= Tier::Full
}

/// Whether the nightly tier runs, which omits nothing.
#[must_use]
pub fn is_night() -> bool {
    tier() == Tier::Night
}

/// Value for the current tier, from `[default, full]`.
#[must_use]
pub fn by_tier<T>([default, full]: [T; 2]) -> T {
    if is_full() { full } else { default }
}

/// Value for the current tier, from `[default, full, night]`.
#[must_use]
pub fn by_tiers<T>([default, full, night]: [T; 3]) -> T {
    match tier() {
        Tier::Default => default,
        Tier::Full => full,
        Tier::Night => night,
    }
}

/// Subset of many robots for the current tier.
///
/// All in the nightly tier, every eighth one in the full tier. The default tier has none, since its
/// tests have a few of their own.
#[must_use]
pub fn of_many<T>(all: impl IntoIterator<Item = T>) -> Vec<T> {
    match tier() {
        Tier::Default => Vec::new(),
        Tier::Full => all.into_iter().step_by(8).collect(),
        Tier::Night => all.into_iter().collect(),
    }
}

/// Number of random robots or draws of noise: from the environment, or that of the tier, from
/// `[default, full, night]`.
///
/// # Panics
///
/// If the variable is not a number.
#[must_use]
pub fn drawn([default, full, night]: [u64; 3]) -> u64 {
    let Some(count) = std::env::var_os(COUNT) else {
        return by_tiers([default, full, night]);
    };
    let number = count.to_str().and_then(|text| text.parse().ok());
    number.unwrap_or_else(|| panic!("{COUNT} is a number, not {}", count.display()))
}
