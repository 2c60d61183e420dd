//! Tests that the tables agree with the readers and with MuJoCo's schema.

mod corpus;
mod pages;

use crate::{
    account::{Index, MJCF, PAR, Rule, SDF, Table, Treatment, URDF, YAML, trace},
    files::Files,
    model::Model,
    options::Options,
};
use std::collections::BTreeSet;

/// Reader of a format.
type Read = fn(&Files, usize, &Options) -> Option<Model>;

/// Reads valid files and returns the attributes and children that were requested.
fn asked(read: Read, texts: &[(&str, String)]) -> (Pairs, Pairs) {
    drop(trace::take());
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in texts {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    for (name, _) in texts
        .iter()
        .filter(|(name, _)| !name.starts_with("included"))
    {
        let files = Files::default();
        let file = files.read(&folder.path().join(name), None).expect("a file");
        let options = Options {
            fix_base: true,
            ..Options::default()
        };
        let model = read(&files, file, &options);
        assert!(model.is_some(), "{name}: {:?}", files.into_errors());
    }
    trace::take()
}

type Pairs = BTreeSet<(String, String)>;

/// Asserts that a reader requests exactly the honoured attributes and elements of a table.
fn agree(table: &Table, read: Read, texts: &[(&str, String)]) {
    let (attributes, children) = &asked(read, texts);
    let mut wrong = Vec::new();
    // MJCF defaults are read as a whole.
    let rules = || table.rules.iter().filter(|rule| rule.within != "default");
    for rule in rules() {
        for element in rule.elements.split_whitespace() {
            for attribute in honoured(rule) {
                if !attributes.contains(&(element.to_owned(), attribute.to_owned())) {
                    wrong.push(format!(
                        "`{attribute}` of <{element}> is honoured but not read"
                    ));
                }
            }
            let is_read = children.iter().any(|(_, child)| child == element)
                || attributes.iter().any(|(of, _)| of == element)
                || rule.within.is_empty();
            if rule.treatment == Treatment::Honoured && !is_read {
                wrong.push(format!("<{element}> is honoured but not read"));
            }
        }
    }
    for (element, attribute) in attributes {
        let is_honoured = table.rules.iter().any(|rule| {
            rule.elements.split_whitespace().any(|own| own == element)
                && honoured(rule).any(|own| own == attribute)
        });
        if !is_honoured {
            wrong.push(format!(
                "`{attribute}` of <{element}> is read but not honoured"
            ));
        }
    }
    let index = Index::new(table);
    for (parent, child) in children {
        let is_inside = |within: &str| within == parent || within.ends_with(&format!("/{parent}"));
        let is_given = table.rules.iter().any(|rule| {
            rule.within.split_whitespace().any(is_inside)
                && rule.elements.split_whitespace().any(|own| own == child)
        });
        if !is_given && index.rule("", parent, child).is_none() {
            wrong.push(format!(
                "<{child}> in <{parent}> is read but not in the table"
            ));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn honoured(rule: &Rule) -> impl Iterator<Item = &'static str> {
    let own = rule.attributes.iter();
    let own = own.filter(|(_, treatment)| *treatment == Treatment::Honoured);
    own.flat_map(|(names, _)| names.split_whitespace())
}

#[test]
fn the_mjcf_reader_agrees_with_its_table() {
    agree(&MJCF, crate::mjcf::read, &corpus::mjcf());
}

#[test]
fn the_urdf_reader_agrees_with_its_table() {
    agree(&URDF, crate::urdf::read, &corpus::urdf());
}

#[test]
fn the_sdformat_reader_agrees_with_its_table() {
    agree(&SDF, crate::sdf::read, &corpus::sdf());
}

/// Asserts that each key of a format without XML elements occurs in its reader's source.
fn are_in(table: &Table, source: &str) {
    for rule in table.rules {
        for key in honoured(rule) {
            assert!(
                source
                    .to_ascii_uppercase()
                    .contains(&format!("\"{key}\"").to_ascii_uppercase()),
                "{key}"
            );
        }
    }
}

#[test]
fn par_and_yaml_keys_are_read() {
    are_in(&PAR, include_str!("../par/mod.rs"));
    are_in(&YAML, include_str!("../urdf/yaml.rs"));
}

#[test]
fn every_table_entry_has_one_treatment() {
    for table in [&MJCF, &URDF, &SDF, &PAR, &YAML] {
        let mut seen = BTreeSet::new();
        for rule in table.rules {
            let mut names = BTreeSet::new();
            for (attributes, _) in rule.attributes {
                for name in attributes.split_whitespace() {
                    assert!(names.insert(name), "{name} of {}", rule.elements);
                }
            }
            for element in rule.elements.split_whitespace() {
                for parent in rule.within.split_whitespace() {
                    assert!(seen.insert((parent, element)), "{element} in {parent}");
                }
            }
        }
    }
}

/// `mujoco_4.txt` is the output of `mj_printSchema` in MuJoCo 4.0.
///
/// Each line has an element with its attributes, indented within its parent.
#[test]
fn the_mjcf_table_covers_the_mujoco_schema() {
    let index = Index::new(&MJCF);
    let mut parents: Vec<(&str, Option<&Rule>)> = Vec::new();
    let mut missing = Vec::new();
    for line in include_str!("mujoco_4.txt").lines() {
        let depth = (line.len() - line.trim_start().len()) / 2;
        let (element, attributes) = line.trim_start().split_once(':').expect("an element");
        parents.truncate(depth);
        let (parent, around) = parents.last().copied().unwrap_or(("", None));
        // The schema does not distinguish the world body from others.
        let parent = if (parent, element) == ("mujoco", "body") {
            "worldbody"
        } else {
            parent
        };
        // Omitted elements have no rules for their children.
        let is_open =
            |rule: &Rule| [Treatment::Honoured, Treatment::Container].contains(&rule.treatment);
        if depth > 0 && !around.is_some_and(is_open) {
            parents.push((element, None));
            continue;
        }
        let rule = index.rule("", parent, element);
        if rule.is_none() {
            missing.push(format!("<{element}> in <{parent}>"));
        }
        for attribute in attributes.split_whitespace() {
            let is_missing = |rule: &Rule| is_open(rule) && rule.attribute(attribute).is_none();
            if rule.is_some_and(is_missing) {
                missing.push(format!("`{attribute}` of <{element}> in <{parent}>"));
            }
        }
        parents.push((element, rule));
    }
    assert!(missing.is_empty(), "{missing:#?}");
}
