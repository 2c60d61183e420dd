//! Lists of names in messages.

/// Largest number of names that a message lists.
const LISTED: usize = 10;

/// Names in words, each once.
pub(crate) fn listed<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    let mut each: Vec<&str> = Vec::new();
    for name in names {
        if !each.contains(&name) {
            each.push(name);
        }
    }
    let further = each.len().saturating_sub(LISTED);
    let mut all: Vec<String> = each
        .iter()
        .take(LISTED)
        .map(|name| format!("`{name}`"))
        .collect();
    if further > 0 {
        all.push(format!("{further} more joints"));
    }
    match all.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}
