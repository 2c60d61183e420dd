//! Counts with singular or plural nouns.

/// `1 leg`, `2 legs`.
///
/// ```
/// assert_eq!(overact_robot::counted(1, "leg", "legs"), "1 leg");
/// ```
#[must_use]
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
