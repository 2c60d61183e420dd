//! Rules of the registry for a package's page, which it applies only when a package is published.

use crate::metadata::Package;

/// Largest number of keywords, and of categories.
const MOST: usize = 5;

/// Largest length of a keyword.
const LONGEST: usize = 20;

/// Categories of <https://crates.io/category_slugs> that packages of this repository use.
///
/// The registry ignores unknown ones without an error.
const CATEGORIES: [&str; 10] = [
    "algorithms",
    "command-line-utilities",
    "development-tools::procedural-macro-helpers",
    "mathematics",
    "no-std::no-alloc",
    "parser-implementations",
    "science",
    "science::robotics",
    "simulation",
    "visualization",
];

/// All faults of a published package's page.
pub(crate) fn faults(package: &Package) -> Vec<String> {
    let Package { name, page, .. } = package;
    let mut faults = Vec::new();
    for (what, list) in [
        ("keywords", &page.keywords),
        ("categories", &page.categories),
    ] {
        if list.is_empty() || list.len() > MOST {
            faults.push(format!("{name}: {} {what}, not 1 to {MOST}", list.len()));
        }
    }
    for keyword in page.keywords.iter().filter(|word| !is_keyword(word)) {
        faults.push(format!("{name}: `{keyword}` cannot be a keyword"));
    }
    let is_unknown = |category: &&String| !CATEGORIES.contains(&category.as_str());
    for category in page.categories.iter().filter(is_unknown) {
        faults.push(format!("{name}: unknown category `{category}`"));
    }
    if page.readme.as_deref() != Some("README.md") {
        faults.push(format!("{name}: has no README.md of its own"));
    }
    if !page.has_docs_rs_settings {
        faults.push(format!("{name}: has no [package.metadata.docs.rs]"));
    }
    faults
}

/// Whether the registry accepts a keyword.
fn is_keyword(word: &str) -> bool {
    let is_permitted = |c: char| c.is_ascii_alphanumeric() || "-_+".contains(c);
    word.len() <= LONGEST
        && word.starts_with(|c: char| c.is_ascii_alphanumeric())
        && word.chars().all(is_permitted)
}

#[cfg(test)]
mod tests {
    use super::{faults, is_keyword};
    use crate::metadata::{Package, Page, packages};

    #[test]
    fn registry_keywords_are_validated() {
        for good in ["robotics", "no-std", "3d", "c++"] {
            assert!(is_keyword(good), "{good}");
        }
        for bad in [
            "",
            "parallel robot",
            "-std",
            "a-keyword-that-is-long",
            "größe",
        ] {
            assert!(!is_keyword(bad), "{bad}");
        }
    }

    #[test]
    fn all_faults_of_a_registry_page_are_reported() {
        let mut package = Package::named("one");
        assert_eq!(faults(&package), [""; 0]);
        package.page = Page {
            keywords: vec!["two words".to_owned()],
            categories: vec!["robots".to_owned()],
            readme: Some("../README.md".to_owned()),
            has_docs_rs_settings: false,
        };
        assert_eq!(
            faults(&package),
            [
                "one: `two words` cannot be a keyword",
                "one: unknown category `robots`",
                "one: has no README.md of its own",
                "one: has no [package.metadata.docs.rs]",
            ]
        );
        package.page.keywords = vec!["a".to_owned(); 6];
        package.page.categories.clear();
        let found = faults(&package);
        assert_eq!(found[0], "one: 6 keywords, not 1 to 5");
        assert_eq!(found[1], "one: 0 categories, not 1 to 5");
    }

    #[test]
    fn published_packages_have_valid_registry_pages() {
        let packages = packages().expect("the packages");
        let published = packages.iter().filter(|p| p.is_member && p.is_published);
        let found: Vec<String> = published.flat_map(faults).collect();
        assert_eq!(found, [""; 0]);
    }
}
