//! Checks and packages the crates for publication.

pub(crate) mod guard;
mod licence;
mod registry;

use crate::Failure;
use crate::files::read;
use crate::metadata::{Package, cargo, packages};
use licence::is_permitted;

/// Checks all packages; reports all problems.
pub(crate) fn check() -> Result<(), Failure> {
    let packages = packages()?;
    let problems = problems(&packages)?;
    if problems.is_empty() {
        println!(
            "{} packages: versions, licences, Rust versions and pages are sound",
            packages.len()
        );
        return Ok(());
    }
    Err(problems.join("\n").into())
}

/// Problems of versions, licences, Rust versions and of the registry's pages.
pub(crate) fn problems(packages: &[Package]) -> Result<Vec<String>, Failure> {
    let mut problems = versions(packages, &read("CHANGELOG.md")?);
    problems.extend(licences(packages));
    problems.extend(rust_versions(packages));
    let published = packages.iter().filter(|p| p.is_member && p.is_published);
    problems.extend(published.flat_map(registry::faults));
    Ok(problems)
}

/// Packages all published crates and builds each from its archive; `--no-verify` skips the builds.
pub(crate) fn package(options: &[&str]) -> Result<(), Failure> {
    let packages = packages()?;
    let private = packages.iter().filter(|p| p.is_member && !p.is_published);
    let excluded = private.flat_map(|p| ["--exclude", p.name.as_str()]);
    let arguments = ["package", "--workspace"].into_iter().chain(excluded);
    let arguments: Vec<&str> = arguments.chain(options.iter().copied()).collect();
    cargo(&arguments).map(drop)
}

/// Checks that published packages have one version, listed in the changelog, complete metadata and
/// published dependencies.
fn versions(packages: &[Package], changelog: &str) -> Vec<String> {
    let published: Vec<&Package> = packages
        .iter()
        .filter(|p| p.is_member && p.is_published)
        .collect();
    let Some(first) = published.first() else {
        return vec!["no package is published".to_owned()];
    };
    let mut problems = Vec::new();
    let section = format!("## {}", first.version);
    // The date follows when the version is released.
    let is_section = |line: &str| {
        let rest = line.strip_prefix(&section);
        let is_own = rest.is_some_and(|rest| rest.trim().is_empty() || rest.starts_with(" - "));
        is_own || line.trim_end() == "## Unreleased"
    };
    if !changelog.lines().any(is_section) {
        problems.push(format!("CHANGELOG.md: no section `## {}`", first.version));
    }
    for package in &published {
        let Package { name, version, .. } = package;
        if *version != first.version {
            problems.push(format!("{name}: version {version}, not {}", first.version));
        }
        if package.description.is_none() || package.licence.is_none() {
            problems.push(format!("{name}: a description and a licence are needed"));
        }
        for what in &package.lacks {
            problems.push(format!("{name}: lacks {what}"));
        }
        for (sibling, requirement) in &package.siblings {
            if !published.iter().any(|p| p.name == *sibling) {
                problems.push(format!(
                    "{name}: depends on {sibling}, which is not published"
                ));
            }
            if *requirement != format!("^{}", first.version) {
                problems.push(format!("{name}: asks for {sibling} {requirement}"));
            }
        }
    }
    problems
}

/// Checks that every dependency has a compatible licence.
fn licences(packages: &[Package]) -> Vec<String> {
    let is_bad = |p: &&Package| !p.licence.as_deref().is_some_and(is_permitted);
    let problem = |p: &Package| {
        let licence = p.licence.as_deref().unwrap_or("none");
        format!("{} {}: licence {licence}", p.name, p.version)
    };
    packages.iter().filter(is_bad).map(problem).collect()
}

/// Checks that no dependency requires a newer Rust than the workspace.
fn rust_versions(packages: &[Package]) -> Vec<String> {
    let own = packages.iter().find(|p| p.is_member);
    let Some(promised) = own.and_then(|p| p.rust_version.as_deref()) else {
        return vec!["the workspace has no rust-version".to_owned()];
    };
    let problem = |p: &Package| {
        let asked = p.rust_version.as_deref()?;
        (number(asked) > number(promised)).then(|| {
            format!(
                "{} {}: needs Rust {asked}, promised is {promised}",
                p.name, p.version
            )
        })
    };
    packages.iter().filter_map(problem).collect()
}

/// Components of a version; missing ones are zero.
fn number(version: &str) -> [u64; 3] {
    let mut parts = version.split('.').map(|part| part.parse().unwrap_or(0));
    std::array::from_fn(|_| parts.next().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::{licences, rust_versions, versions};
    use crate::metadata::Package;

    fn package(name: &str) -> Package {
        Package::named(name)
    }

    #[test]
    fn consistent_packages_have_no_problem() {
        let upper = Package {
            siblings: vec![("lower".to_owned(), "^1.2.0".to_owned())],
            ..package("upper")
        };
        let packages = [package("lower"), upper];
        assert!(versions(&packages, "## 1.2.0\n").is_empty());
        assert!(versions(&packages, "## 1.2.0 - 2026-01-31\n").is_empty());
        assert!(!versions(&packages, "## 1.2.0-rc.1\n## 1.2.01\n").is_empty());
        assert!(licences(&packages).is_empty());
        assert!(rust_versions(&packages).is_empty());
    }

    #[test]
    fn all_release_problems_are_reported() {
        let old = Package {
            version: "1.1.0".to_owned(),
            description: None,
            lacks: vec!["LICENSE-MIT"],
            ..package("old")
        };
        let private = Package {
            is_published: false,
            ..package("private")
        };
        let upper = Package {
            siblings: vec![("private".to_owned(), "^1.1.0".to_owned())],
            ..package("upper")
        };
        let found = versions(&[package("lower"), old, private, upper], "## 1.1.0\n");
        assert_eq!(
            found,
            [
                "CHANGELOG.md: no section `## 1.2.0`",
                "old: version 1.1.0, not 1.2.0",
                "old: a description and a licence are needed",
                "old: lacks LICENSE-MIT",
                "upper: depends on private, which is not published",
                "upper: asks for private ^1.1.0",
            ]
        );
        let strange = Package {
            licence: Some("GPL-3.0".to_owned()),
            ..package("strange")
        };
        assert_eq!(licences(&[strange]), ["strange 1.2.0: licence GPL-3.0"]);
        let newer = Package {
            rust_version: Some("1.90.1".to_owned()),
            ..package("newer")
        };
        assert_eq!(
            rust_versions(&[package("own"), newer]),
            ["newer 1.2.0: needs Rust 1.90.1, promised is 1.89"]
        );
    }
}
