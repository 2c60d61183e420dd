//! Which tier of the tests runs.
//!
//! `cargo test --workspace` runs the default tier: every test, over few states, mechanisms and seeds.
//! `OVERACT_TESTS=full cargo test --workspace` runs the full tier: the same tests over many, and
//! `OVERACT_TESTS=night` what takes minutes of compiling besides. A test asks here how much it has to do;
//! nothing else reads the variables.

/// The environment variable that chooses how many robots, or draws of noise, are taken at random.
pub const COUNT: &str = "OVERACT_RANDOM_COUNT";

/// The environment variable that chooses the tier.
pub const VARIABLE: &str = "OVERACT_TESTS";

/// The tiers, the smallest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Tier {
    Default,
    Full,
    Night,
}

/// The tier that runs.
///
/// # Panics
///
/// If the variable has a value that names no tier: a misspelled one would run too little unnoticed.
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

/// Whether the full tier runs, or that of the night.
#[must_use]
pub fn is_full() -> bool {
    tier() >= Tier::Full
}

/// Whether the tier of the night runs, which leaves out nothing.
#[must_use]
pub fn is_night() -> bool {
    tier() == Tier::Night
}

/// How much the tier that runs has to do, of `[default, full]`.
#[must_use]
pub fn by_tier<T>([default, full]: [T; 2]) -> T {
    if is_full() { full } else { default }
}

/// Those of many robots of which the tier takes its part: all at night, every second one in the full tier, none in the
/// default one, whose tests have a few of their own.
#[must_use]
pub fn of_many<T>(all: impl IntoIterator<Item = T>) -> Vec<T> {
    match tier() {
        Tier::Default => Vec::new(),
        Tier::Full => all.into_iter().step_by(2).collect(),
        Tier::Night => all.into_iter().collect(),
    }
}

/// How many robots, or draws of noise, are taken at random: as many as is asked for, or as the tier has.
///
/// # Panics
///
/// If what is asked for is no number.
#[must_use]
pub fn drawn(by_tier: [u64; 2]) -> u64 {
    let Some(count) = std::env::var_os(COUNT) else {
        return self::by_tier(by_tier);
    };
    let number = count.to_str().and_then(|text| text.parse().ok());
    number.unwrap_or_else(|| panic!("{COUNT} is a number, not {}", count.display()))
}
