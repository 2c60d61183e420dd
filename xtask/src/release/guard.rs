//! Guard of a release: names everything that forbids to publish a tag, before anything is
//! published.

use crate::Failure;
use crate::files::{read, repository};
use crate::metadata::{cargo_command, packages};
use crate::release;
use std::path::Path;
use std::process::Command;

/// Variables that are set if the token of a registry is there; only their presence is read.
const TOKENS: [&str; 2] = ["CARGO_REGISTRY_TOKEN", "PYPI_TOKEN"];

/// A line that repeats the version of the crates.
struct VersionLine {
    file: &'static str,
    /// Text of the line before the version.
    prefix: &'static str,
}

/// Lines outside of the workspace that repeat the version.
const VERSION_LINES: [VersionLine; 4] = [
    VersionLine {
        file: "CITATION.cff",
        prefix: "version: ",
    },
    VersionLine {
        file: "fleet/Cargo.toml",
        prefix: "version = ",
    },
    VersionLine {
        file: "page/Cargo.toml",
        prefix: "version = ",
    },
    VersionLine {
        file: "python/Cargo.toml",
        prefix: "version = ",
    },
];

/// Fails with all reasons not to publish `tag`.
///
/// They are those of [`release::check`], a tag, version or date that does not match, a dirty tree,
/// a missing token, and yanked dependencies.
pub(crate) fn check(tag: &str) -> Result<(), Failure> {
    let packages = packages()?;
    let version = packages.iter().find(|p| p.is_member && p.is_published);
    let version = version.map(|p| p.version.as_str()).unwrap_or_default();
    let mut problems = release::problems(&packages)?;
    problems.extend(tag_problem(tag, version));
    for line in &VERSION_LINES {
        problems.extend(line.problem(&read(line.file)?, version));
    }
    problems.extend(dates(
        &read("CHANGELOG.md")?,
        &read("CITATION.cff")?,
        version,
    ));
    problems.extend(tree(&git(&["status", "--porcelain"])?));
    problems.extend(tagged_commit(tag)?);
    problems.extend(tokens(|name| std::env::var(name).ok()));
    let private = packages.iter().filter(|p| p.is_member && !p.is_published);
    let private: Vec<&str> = private.map(|p| p.name.as_str()).collect();
    problems.extend(yanked(&repository(""), &private)?);
    if problems.is_empty() {
        println!("{tag} may be published");
        return Ok(());
    }
    Err(problems.join("\n").into())
}

/// Whether the tag is `v` and the version of the packages.
fn tag_problem(tag: &str, version: &str) -> Option<String> {
    let message = format!(
        "the tag {tag} does not match version {version} of the packages: tag v{version}, or change `version` in Cargo.toml"
    );
    (tag != format!("v{version}")).then_some(message)
}

impl VersionLine {
    /// Why the line of a text does not state the version, if so.
    fn problem(&self, text: &str, version: &str) -> Option<String> {
        let Self { file, prefix } = self;
        let stated = text.lines().find_map(|line| line.strip_prefix(prefix));
        match stated.map(|stated| stated.trim().trim_matches('"')) {
            Some(stated) if stated == version => None,
            Some(stated) => Some(format!("{file}: version {stated}, not {version}")),
            None => Some(format!("{file}: no line `{prefix}{version}`")),
        }
    }
}

/// Checks that the changelog dates the version, and that the citation has the same date.
fn dates(changelog: &str, citation: &str, version: &str) -> Vec<String> {
    let heading = format!("## {version} - ");
    let Some(date) = changelog
        .lines()
        .find_map(|line| line.strip_prefix(&heading))
    else {
        return vec![format!(
            "CHANGELOG.md: no heading `{heading}` with the date of the release"
        )];
    };
    let date = date.trim();
    let mut problems = Vec::new();
    if !is_date(date) {
        problems.push(format!(
            "CHANGELOG.md: `{date}` is no date such as 2026-01-31"
        ));
    }
    let line = format!("date-released: {date}");
    if !citation.lines().any(|one| one.trim_end() == line) {
        problems.push(format!("CITATION.cff: no line `{line}`"));
    }
    problems
}

/// Whether a text is a date, year-month-day.
fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let lengths = parts.iter().map(|part| part.len());
    let in_range = |part: &str, most: u32| part.parse().is_ok_and(|n: u32| (1..=most).contains(&n));
    lengths.eq([4, 2, 2])
        && in_range(parts[0], 9999)
        && in_range(parts[1], 12)
        && in_range(parts[2], 31)
}

/// Problem for each changed file, from the output of `git status --porcelain`.
fn tree(status: &str) -> Vec<String> {
    let problem = |line: &str| {
        let file = line.get(3..).unwrap_or(line);
        format!("{file}: differs from the commit; commit or remove it")
    };
    status.lines().map(problem).collect()
}

/// Why the current commit is not that of the tag, if so.
fn tagged_commit(tag: &str) -> Result<Option<String>, Failure> {
    let reference = format!("refs/tags/{tag}^{{commit}}");
    let Ok(tagged) = git(&["rev-parse", "--verify", "--quiet", &reference]) else {
        return Ok(Some(format!("there is no tag {tag}")));
    };
    let head = git(&["rev-parse", "HEAD"])?;
    Ok((tagged != head).then(|| format!("{tag} is not the current commit: check it out first")))
}

/// Problem for each token that is missing or empty.
fn tokens(variable: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let missing = TOKENS
        .iter()
        .filter(|name| variable(name).is_none_or(|value| value.trim().is_empty()));
    missing
        .map(|name| format!("no token: set the variable {name} (a secret of the repository)"))
        .collect()
}

/// Problem for each dependency in Cargo.lock that its registry has yanked.
///
/// Cargo warns about them when it packages a crate; `private` are packages of the workspace that
/// it does not package.
fn yanked(folder: &Path, private: &[&str]) -> Result<Vec<String>, Failure> {
    let mut command = cargo_command();
    command.args(["package", "--workspace", "--no-verify", "--locked"]);
    command.args(private.iter().flat_map(|name| ["--exclude", name]));
    command.arg("--allow-dirty").current_dir(folder);
    let output = command.env("CARGO_TERM_COLOR", "never").output()?;
    let messages = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(format!("`cargo package` failed:\n{messages}").into());
    }
    let is_warning = |line: &&str| line.contains("is yanked in registry");
    let mut warnings: Vec<&str> = messages.lines().filter(is_warning).collect();
    warnings.sort_unstable();
    warnings.dedup();
    Ok(warnings.into_iter().map(str::to_owned).collect())
}

/// Output of git in the repository, without the last line break.
fn git(arguments: &[&str]) -> Result<String, Failure> {
    let output = Command::new("git")
        .args(arguments)
        .current_dir(repository(""))
        .output()
        .map_err(|error| format!("git: {error}"))?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        return Err(format!("`git {}` failed: {message}", arguments.join(" ")).into());
    }
    Ok(String::from_utf8(output.stdout)?.trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{TOKENS, VERSION_LINES, dates, tag_problem, tagged_commit, tokens, tree, yanked};
    use crate::files::read;
    use crate::metadata::target;
    use std::fs;

    #[test]
    fn the_tag_must_match_the_version() {
        assert_eq!(tag_problem("v1.2.0", "1.2.0"), None);
        for tag in ["1.2.0", "v1.2.1", "v1.2", "v1.2.0-rc.1", ""] {
            let problem = tag_problem(tag, "1.2.0").unwrap_or_default();
            assert!(problem.contains("tag v1.2.0"), "{problem}");
        }
    }

    #[test]
    fn repeated_version_numbers_must_match() {
        for line in &VERSION_LINES {
            let text = read(line.file).expect("a file with a version");
            let own = env!("CARGO_PKG_VERSION");
            assert_eq!(line.problem(&text, own), None);
            let other = line.problem(&text, "9.9.9").unwrap_or_default();
            assert!(other.ends_with("not 9.9.9"), "{other}");
            assert!(line.problem("name: none", own).is_some());
        }
    }

    #[test]
    fn changelog_and_citation_dates_must_match() {
        let changelog = "# Changelog\n\n## 1.2.0 - 2026-02-28\n";
        let citation = "version: 1.2.0\ndate-released: 2026-02-28\n";
        assert_eq!(dates(changelog, citation, "1.2.0"), [""; 0]);
        for (changelog, citation, problem) in [
            ("## 1.2.0\n", citation, "CHANGELOG.md: no heading"),
            (
                "## 1.1.0 - 2026-02-28\n",
                citation,
                "CHANGELOG.md: no heading",
            ),
            (changelog, "version: 1.2.0\n", "CITATION.cff: no line"),
            (
                changelog,
                "date-released: 2026-03-01\n",
                "CITATION.cff: no line",
            ),
        ] {
            let problems = dates(changelog, citation, "1.2.0");
            assert!(
                problems.len() == 1 && problems[0].starts_with(problem),
                "{problems:?}"
            );
        }
        for date in ["date open", "2026-13-01", "2026-1-1", "2026-01-32", ""] {
            let changelog = format!("## 1.2.0 - {date}\n");
            let problems = dates(&changelog, "", "1.2.0");
            assert!(problems[0].contains("is no date"), "{date}: {problems:?}");
        }
    }

    #[test]
    fn uncommitted_changes_are_reported() {
        assert_eq!(tree(""), [""; 0]);
        let problems = tree(" M Cargo.toml\n?? new file.txt\n");
        assert_eq!(problems.len(), 2);
        assert!(problems[0].starts_with("Cargo.toml: differs"));
        assert!(problems[1].starts_with("new file.txt: differs"));
    }

    #[test]
    fn a_missing_tag_is_reported() {
        let problem = tagged_commit("v0.0.0-never").expect("git");
        assert_eq!(problem.as_deref(), Some("there is no tag v0.0.0-never"));
    }

    #[test]
    fn empty_tokens_are_reported_as_missing() {
        let both = |name: &str| TOKENS.contains(&name).then(|| "a token".to_owned());
        assert_eq!(tokens(both), [""; 0]);
        assert_eq!(tokens(|_| None).len(), TOKENS.len());
        let problems = tokens(|name| Some(" ".repeat(usize::from(name == TOKENS[0]))));
        assert_eq!(problems.len(), TOKENS.len());
        assert!(problems[0].contains(TOKENS[0]), "{problems:?}");
    }

    /// A package with a locked dependency, and a registry that has it.
    #[test]
    fn a_yanked_dependency_is_detected() {
        let folder = target().expect("a target folder").join("xtask-yanked");
        let write = |path: &str, text: &str| {
            let file = folder.join(path);
            fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
            fs::write(file, text).expect("a file");
        };
        let checksum = "0".repeat(64);
        let entry = |yanked: bool| {
            format!(
                "{{\"name\":\"depo\",\"vers\":\"0.1.0\",\"deps\":[],\"cksum\":\"{checksum}\",\"features\":{{}},\"yanked\":{yanked}}}\n"
            )
        };
        let registry = folder.join("registry");
        write(
            "user/Cargo.toml",
            "[package]\nname = \"user\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\ndepo = \"0.1\"\n\n[workspace]\n",
        );
        write("user/src/lib.rs", "");
        write(
            "user/Cargo.lock",
            &format!(
                "version = 4\n\n[[package]]\nname = \"depo\"\nversion = \"0.1.0\"\nsource = \"registry+https://github.com/rust-lang/crates.io-index\"\nchecksum = \"{checksum}\"\n\n[[package]]\nname = \"user\"\nversion = \"0.1.0\"\ndependencies = [\n \"depo\",\n]\n"
            ),
        );
        write(
            "user/.cargo/config.toml",
            &format!(
                "[build]\ntarget-dir = {:?}\n\n[source.crates-io]\nreplace-with = \"own\"\n\n[source.own]\nlocal-registry = {registry:?}\n",
                folder.join("target")
            ),
        );
        write("registry/index/de/po/depo", &entry(false));
        assert_eq!(
            yanked(&folder.join("user"), &[]).expect("a packaged crate"),
            [""; 0]
        );
        write("registry/index/de/po/depo", &entry(true));
        let problems = yanked(&folder.join("user"), &[]).expect("a packaged crate");
        assert!(
            problems.len() == 1 && problems[0].contains("`depo v0.1.0`"),
            "{problems:?}"
        );
    }
}
