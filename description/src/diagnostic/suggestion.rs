//! Suggestions for misspelled names.

/// Largest number of candidates: a damaged file may lack thousands of names among thousands.
const MOST: usize = 500;
/// Largest length of a compared name, in bytes.
const LONGEST: usize = 100;

/// The candidate closest to `name` by edit distance, if it is close enough.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A single letter is close to every other one, which means nothing.
    let length = name.chars().count();
    let limit = (length / 3).max(1).min(length.saturating_sub(1));
    if name.len() > LONGEST {
        return None;
    }
    let near = candidates
        .into_iter()
        .take(MOST)
        .filter(|c| c.len() <= LONGEST)
        .map(|c| (distance(name, c), c))
        .filter(|(d, _)| *d <= limit);
    // `min_by_key` keeps the first of equals, so the result is deterministic.
    near.min_by_key(|(d, _)| *d).map(|(_, candidate)| candidate)
}

/// "did you mean `alpha`?", if a candidate is close.
#[must_use]
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    nearest(name, candidates).map(|candidate| format!("did you mean `{candidate}`?"))
}

/// Edit distance with insertions, deletions, replacements and swaps of neighbours, ignoring case.
fn distance(a: &str, b: &str) -> usize {
    strsim::osa_distance(&a.to_lowercase(), &b.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn similar_names_are_suggested() {
        let names = ["gamma", "alpha", "theta", "b", "d", "r"];
        assert_eq!(nearest("alhpa", names), Some("alpha"));
        assert_eq!(nearest("Theta", names), Some("theta"));
        assert_eq!(nearest("mass", names), None);
        assert_eq!(
            did_you_mean("gama", names).as_deref(),
            Some("did you mean `gamma`?")
        );
    }

    #[test]
    fn transpositions_count_as_one_edit() {
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("abc", "acb"), 1);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
