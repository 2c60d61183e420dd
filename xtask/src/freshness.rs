//! Checks that `generated/` is up to date and small.
//!
//! The manifest contains hashes of the sources that each robot was generated from. With equal
//! sources the output is equal, and generating everything takes ten minutes on two processors.
//! Therefore only some robots are generated:
//!
//! - those that are kept as text;
//! - one in eight of the others, a different choice for each version of the generator;
//! - those whose sources changed.

use crate::Failure;
use crate::files::{read, repository, size, stems};
use crate::generated::{File, texts};
use crate::hash::{generator, hash};
use crate::manifest::{beginning, section, section_beginning};
use crate::robots::{Module, TEXT, several};

/// Largest size of `generated/`, bytes.
const LARGEST: u64 = 2_200_000;

/// One in this many robots with unchanged sources is generated.
const ONE_IN: u64 = 8;

const MANIFEST: &str = "generated/manifest.toml";

/// Compares the manifest and every file; reports the first different line of each.
pub(crate) fn check(all: bool) -> Result<(), Failure> {
    let generator = generator()?;
    let recorded = read(MANIFEST)?;
    let robots = stems("robots", "toml")?;
    let sections = sections(&recorded);
    let is_same_generator = sections[0] == beginning(generator);
    let mut chosen = Vec::new();
    for stem in &robots {
        let description = hash(&read(&format!("robots/{stem}.toml"))?);
        let start = section_beginning(stem, description);
        let is_same = is_same_generator && sections.iter().any(|own| own.starts_with(&start));
        let sample = hash(stem) ^ generator;
        let is_taken = TEXT.contains(&stem.as_str()) || sample.is_multiple_of(ONE_IN);
        if all || !is_same || is_taken {
            chosen.push(stem.clone());
        }
    }
    let modules = several(&chosen)?;
    let mut problems = manifest_problems(&sections, &robots, &modules);
    problems.extend(texts(modules).iter().filter_map(difference));
    problems.extend(strangers()?);
    let bytes = size(&repository("generated"))?;
    if bytes > LARGEST {
        problems.push(format!("generated/: {bytes} bytes, more than {LARGEST}"));
    }
    if problems.is_empty() {
        let (count, of) = (chosen.len(), robots.len());
        println!("generated/ is fresh: {bytes} bytes, {count} of {of} robots generated anew");
        if !is_same_generator {
            println!(
                "All were, since the generator's sources are not those of the manifest; `cargo xtask generated` \
                 writes their hash"
            );
        }
        return Ok(());
    }
    let problems = problems.join("\n");
    Err(
        format!("generated/ is not fresh; renew it with `cargo xtask generated`\n{problems}")
            .into(),
    )
}

/// Header of a manifest, and the section of each robot.
fn sections(manifest: &str) -> Vec<&str> {
    let starts = manifest.match_indices("\n[").map(|(at, _)| at);
    let of_robots = starts.filter(|at| {
        let name = manifest[at + 2..].split(']').next();
        name.is_some_and(|name| !name.contains('.'))
    });
    let mut starts: Vec<usize> = [0].into_iter().chain(of_robots).collect();
    starts.push(manifest.len());
    starts
        .windows(2)
        .map(|pair| &manifest[pair[0]..pair[1]])
        .collect()
}

/// Problems with sections: missing, superfluous or different from the modules.
fn manifest_problems(sections: &[&str], robots: &[String], modules: &[Module]) -> Vec<String> {
    let start = |stem: &str| format!("\n[{stem}]\n");
    let missing = robots.iter().filter(|stem| {
        let start = start(stem);
        sections
            .iter()
            .filter(|own| own.starts_with(&start))
            .count()
            != 1
    });
    let mut problems: Vec<String> = missing
        .map(|stem| format!("{MANIFEST}: not one section [{stem}]"))
        .collect();
    if sections.len() != robots.len() + 1 {
        let count = sections.len() - 1;
        problems.push(format!("{MANIFEST}: {count} robots, not {}", robots.len()));
    }
    for module in modules {
        let start = start(&module.stem);
        let found = sections.iter().find(|own| own.starts_with(&start));
        let of = format!("{MANIFEST}, [{}]", module.stem);
        problems.extend(found.and_then(|found| first_difference(&of, found, &section(module))));
    }
    problems
}

/// Files of modules that no task writes.
fn strangers() -> Result<Vec<String>, Failure> {
    let found = stems("generated/src", "rs")?.into_iter();
    let unknown = found.filter(|stem| stem != "lib" && !TEXT.contains(&stem.as_str()));
    Ok(unknown
        .map(|stem| format!("generated/src/{stem}.rs: no task writes it"))
        .collect())
}

/// First line in which a file differs from its expected text.
fn difference(file: &File) -> Option<String> {
    match read(&file.path) {
        Ok(found) => first_difference(&file.path, &found, &file.text),
        Err(failure) => Some(failure.to_string()),
    }
}

/// First line in which a text differs from the expected one.
fn first_difference(name: &str, found: &str, expected: &str) -> Option<String> {
    if found == expected {
        return None;
    }
    let mut pairs = found.lines().zip(expected.lines()).enumerate();
    let first = pairs.find(|(_, (found, expected))| found != expected);
    Some(match first {
        Some((at, (found, expected))) => format!(
            "{name}:{}: `{}`, should be `{}`",
            at + 1,
            found.trim(),
            expected.trim()
        ),
        None => format!("{name}: has another length than it should"),
    })
}

#[cfg(test)]
mod tests {
    use super::{manifest_problems, sections};
    use crate::manifest::text;
    use crate::robots::Module;

    fn module(stem: &str, text: &str) -> Module {
        Module {
            stem: stem.to_owned(),
            description: 7,
            text: text.to_owned(),
            functions: Vec::new(),
        }
    }

    #[test]
    fn manifest_sections_match_robots_and_differences_are_reported() {
        let text = text(&[module("a", "one"), module("b", "two")], 1);
        let sections = sections(&text);
        assert_eq!(sections.len(), 3);
        assert_eq!(sections.concat(), text);
        let robots = ["a", "b"].map(str::to_owned);
        let same = [module("a", "one"), module("b", "two")];
        assert!(manifest_problems(&sections, &robots, &same).is_empty());
        let other = manifest_problems(&sections, &robots, &[module("b", "three")]);
        assert_eq!(other.len(), 1);
        assert!(
            other[0].contains("[b]:5: `bytes = 3`, should be `bytes = 5`"),
            "{other:?}"
        );
        let more = ["a", "b", "c"].map(str::to_owned);
        let missing = manifest_problems(&sections, &more, &same);
        assert_eq!(missing[0], "generated/manifest.toml: not one section [c]");
    }
}
