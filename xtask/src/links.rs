//! Checks links between the repository's texts: files and headings must exist.

use crate::Failure;
use crate::files::{read, repository};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Folders whose texts are checked; the root is the empty one.
const FOLDERS: [&str; 9] = [
    "",
    ".github",
    "benchmarks",
    "docs",
    "examples/cpp_controller",
    "fleet",
    "generated",
    "python",
    "robots",
];

/// Folders of packages, whose pages are also shown by a registry.
const PACKAGES: [&str; 14] = [
    "cli",
    "codegen",
    "core",
    "description",
    "exact",
    "identification",
    "interchange",
    "logs",
    "macros",
    "python",
    "report",
    "robot",
    "runtime",
    "simulation",
];

/// Addresses of files and folders of the repository.
const OWN_ADDRESSES: [&str; 2] = [
    "https://github.com/overact/overact/blob/main/",
    "https://github.com/overact/overact/tree/main/",
];

/// A link in a text.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Link {
    pub(crate) line: usize,
    pub(crate) target: String,
}

/// Fails with all broken links.
pub(crate) fn check() -> Result<(), Failure> {
    let texts = texts()?;
    let mut problems = broken(&texts);
    problems.extend(broken_addresses(&texts)?);
    if problems.is_empty() {
        println!("{} texts: all links lead somewhere", texts.len());
        return Ok(());
    }
    Err(problems.join("\n").into())
}

/// Every broken link to the repository on the front pages of the packages' documentation.
fn broken_addresses(texts: &BTreeMap<String, String>) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for folder in PACKAGES {
        let file = format!("{folder}/src/lib.rs");
        for link in addresses(&read(&file)?) {
            if let Some(why) = fault(&file, &link.target, texts) {
                problems.push(format!("{file}:{}: `{}`: {why}", link.line, link.target));
            }
        }
    }
    Ok(problems)
}

/// All addresses of the repository's files in a text.
fn addresses(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (at, content) in text.lines().enumerate() {
        for own in OWN_ADDRESSES {
            for (start, _) in content.match_indices(own) {
                let rest = &content[start..];
                let end = rest.find([')', '>', '"', ' ']).unwrap_or(rest.len());
                let target = rest[..end].to_owned();
                found.push(Link {
                    line: at + 1,
                    target,
                });
            }
        }
    }
    found
}

/// All texts by path relative to the root.
pub(crate) fn texts() -> Result<BTreeMap<String, String>, Failure> {
    let mut all = BTreeMap::new();
    for folder in FOLDERS.iter().chain(&PACKAGES) {
        let Ok(entries) = fs::read_dir(repository(folder)) else {
            continue;
        };
        for entry in entries {
            let path = Path::new(folder).join(entry?.file_name());
            if path.extension().is_some_and(|e| e == "md") {
                let name = path.display().to_string();
                let text = read(&name)?;
                all.insert(name, text);
            }
        }
    }
    Ok(all)
}

/// Every broken link with its file and line.
fn broken(texts: &BTreeMap<String, String>) -> Vec<String> {
    let mut problems = Vec::new();
    for (file, text) in texts {
        for link in links(text) {
            if let Some(why) = fault(file, &link.target, texts) {
                problems.push(format!("{file}:{}: `{}`: {why}", link.line, link.target));
            }
        }
    }
    problems
}

/// Why a link is broken, if it is.
fn fault(file: &str, target: &str, texts: &BTreeMap<String, String>) -> Option<String> {
    let own = OWN_ADDRESSES
        .iter()
        .find_map(|own| target.strip_prefix(own));
    if own.is_none() && is_foreign(target) {
        return None;
    }
    let location = own.unwrap_or(target);
    let (path, anchor) = location.split_once('#').unwrap_or((location, ""));
    if own.is_none() && !path.is_empty() && is_packaged(file) {
        return Some("a package's page has no relative links".to_owned());
    }
    let resolved = match (own, path) {
        (Some(_), path) => path.to_owned(),
        (None, "") => file.to_owned(),
        (None, path) => resolved(file, path)?,
    };
    if !texts.contains_key(&resolved) && !repository(&resolved).exists() {
        return Some("there is no such file".to_owned());
    }
    if anchor.is_empty() {
        return None;
    }
    let Some(text) = texts.get(&resolved) else {
        return Some(format!("`{resolved}` is no text with headings"));
    };
    let known = anchors(text);
    (!known.iter().any(|one| one == anchor)).then(|| format!("`{resolved}` has no such heading"))
}

/// Whether a text is the page of a package in a registry.
fn is_packaged(file: &str) -> bool {
    let folder = file.strip_suffix("/README.md");
    folder.is_some_and(|folder| PACKAGES.contains(&folder))
}

/// Whether a link leaves the repository.
pub(crate) fn is_foreign(target: &str) -> bool {
    ["http://", "https://", "mailto:", "data:"]
        .iter()
        .any(|scheme| target.starts_with(scheme))
}

/// Relative path from the root; a path that leaves the repository is returned unchanged and does
/// not exist.
pub(crate) fn resolved(file: &str, path: &str) -> Option<String> {
    let mut parts = PathBuf::from(file);
    parts.pop();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir if !parts.pop() => return Some(format!("outside/{path}")),
            Component::Normal(name) => parts.push(name),
            _ => {}
        }
    }
    Some(parts.display().to_string())
}

/// Numbered lines of a text outside of code.
pub(crate) fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    text.lines().enumerate().filter_map(move |(at, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        (!is_code && !is_fence).then_some((at + 1, line))
    })
}

/// All links of a text: `](target)`, `src="target"` and `href="target"`.
pub(crate) fn links(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (line, content) in prose(text) {
        let mut content = without_code(content);
        content = content.replace("src=\"", "](").replace("href=\"", "](");
        for part in content.split("](").skip(1) {
            let end = part.find([')', '"', ' ']).unwrap_or(part.len());
            let target = part[..end].to_owned();
            found.push(Link { line, target });
        }
    }
    found
}

/// Line without text in backquotes.
fn without_code(line: &str) -> String {
    let parts = line.split('`').enumerate();
    parts
        .filter(|(at, _)| at % 2 == 0)
        .map(|(_, part)| part)
        .collect()
}

/// Anchors of a text's headings: lower case letters, digits and hyphens; repeated ones are
/// numbered.
pub(crate) fn anchors(text: &str) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let headings = prose(text).filter(|(_, line)| line.starts_with('#'));
    let anchor = |(_, line): (usize, &str)| {
        let title = line.trim_start_matches('#').trim();
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        let slug: String = kept.collect::<String>().to_lowercase().replace(' ', "-");
        let count = seen.entry(slug.clone()).or_default();
        *count += 1;
        match *count {
            1 => slug,
            more => format!("{slug}-{}", more - 1),
        }
    };
    headings.map(anchor).collect()
}

#[cfg(test)]
mod tests {
    use super::{
        Link, OWN_ADDRESSES, PACKAGES, addresses, anchors, broken, broken_addresses, links,
        resolved, texts,
    };
    use crate::files::{read, repository, stems};
    use crate::metadata::packages;
    use std::collections::BTreeMap;

    #[test]
    fn all_links_of_the_repository_are_valid() {
        let texts = texts().expect("the texts");
        assert!(texts.len() > 20, "{:?}", texts.keys());
        assert_eq!(broken(&texts), Vec::<String>::new());
        let summary = &texts["docs/SUMMARY.md"];
        let named: Vec<String> = links(summary).into_iter().map(|link| link.target).collect();
        let pages = texts.keys().filter_map(|file| file.strip_prefix("docs/"));
        for page in pages.filter(|page| *page != "SUMMARY.md") {
            assert!(
                named.iter().any(|one| one == page),
                "docs/SUMMARY.md leaves {page} out"
            );
        }
    }

    #[test]
    fn the_gallery_links_every_robot() {
        let text = read("docs/gallery.md").expect("the gallery");
        for stem in stems("robots", "toml").expect("the robots") {
            for link in [
                format!("robots/{stem}.svg"),
                format!("../robots/{stem}.toml"),
            ] {
                assert!(
                    text.contains(&format!("]({link})")),
                    "{link} is not in the gallery"
                );
            }
        }
    }

    #[test]
    fn links_are_found_outside_of_code() {
        let text = "a [b](c.md#d) and `[e](f)`\n```\n[g](h)\n```\n<img src=\"i.svg\" alt=\"\">\n";
        let link = |line, target: &str| Link {
            line,
            target: target.to_owned(),
        };
        assert_eq!(links(text), [link(1, "c.md#d"), link(5, "i.svg")]);
        assert_eq!(
            anchors("# A `b`: c_d\n## X\n## X\n"),
            ["a-b-c_d", "x", "x-1"]
        );
    }

    #[test]
    fn broken_links_are_reported() {
        let texts = |text: &str| BTreeMap::from([("docs/a.md".to_owned(), text.to_owned())]);
        assert_eq!(
            broken(&texts("# A\n[x](#a) [y](../README.md) [z](https://b.c)")),
            [""; 0]
        );
        for (link, why) in [
            ("#b", "no such heading"),
            ("none.md", "no such file"),
            ("../../above.md", "no such file"),
            ("../Cargo.toml#b", "no text"),
        ] {
            let found = broken(&texts(&format!("# A\n[x]({link})")));
            assert!(found.len() == 1 && found[0].contains(why), "{found:?}");
            assert!(found[0].starts_with("docs/a.md:2: "), "{found:?}");
        }
        assert_eq!(
            resolved("docs/a.md", "../robots/b.md").as_deref(),
            Some("robots/b.md")
        );
    }

    #[test]
    fn package_pages_must_link_by_absolute_address() {
        let broken = |link: &str| {
            let text = format!("# A\n[x]({link})");
            broken(&BTreeMap::from([("core/README.md".to_owned(), text)]))
        };
        let main = "https://github.com/overact/overact";
        for good in [
            "#a".to_owned(),
            main.to_owned(),
            format!("{main}/blob/main/Cargo.toml"),
            format!("{main}/tree/main/robots"),
            format!("{main}/blob/main/core/README.md#a"),
        ] {
            assert_eq!(broken(&good), [""; 0], "{good}");
        }
        for (bad, why) in [
            ("../README.md".to_owned(), "no relative links"),
            (format!("{main}/blob/main/none.md"), "no such file"),
            (
                format!("{main}/blob/main/core/README.md#b"),
                "no such heading",
            ),
        ] {
            let found = broken(&bad);
            assert!(found.len() == 1 && found[0].contains(why), "{found:?}");
        }
    }

    #[test]
    fn addresses_are_found_in_comments() {
        let own = OWN_ADDRESSES[0];
        let text = format!("//! a <{own}a.md>,\n//! [b]: {own}b.md#c\n//! https://b.c/d\n");
        let found: Vec<(usize, String)> = addresses(&text)
            .into_iter()
            .map(|link| (link.line, link.target))
            .collect();
        assert_eq!(
            found,
            [(1, format!("{own}a.md")), (2, format!("{own}b.md#c"))]
        );
    }

    #[test]
    fn all_published_packages_are_checked() {
        let packages = packages().expect("the packages");
        let published = packages.iter().filter(|p| p.is_member && p.is_published);
        // The package for Python is in a workspace of its own.
        assert_eq!(published.count() + 1, PACKAGES.len());
        let texts = texts().expect("the texts");
        let found = broken_addresses(&texts).expect("the front pages");
        assert_eq!(found, [""; 0]);
        for folder in PACKAGES {
            let page = repository(folder).join("README.md");
            assert!(page.is_file(), "{}", page.display());
        }
    }
}
