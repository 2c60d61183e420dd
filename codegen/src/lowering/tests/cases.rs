//! Results of each pass on small expressions: one file for each case in `tests/lowering_cases/`.
//!
//! A file states the reason for the case, the passes, the starting point, the input and the
//! expected result. `OVERACT_BLESS=1 cargo test -p overact-codegen --lib lowering` rewrites the
//! expected results, which have to be reviewed.

use super::build::{Start, build};
use super::language::parse;
use super::listing::listing;
use crate::lowering::SearchLimits;
use crate::lowering::passes::{PARTS, PASSES, Pass};
use crate::lowering::schedule::schedule;
use std::fs;
use std::path::{Path, PathBuf};

/// A file, in parts.
struct Case {
    head: String,
    passes: Vec<Pass>,
    limits: SearchLimits,
    start: Start,
    given: String,
    expected: String,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lowering_cases")
}

/// The passes in a line such as `signs, selections`; also `none` and `all`.
fn passes(line: &str) -> Vec<Pass> {
    let known = || PASSES.into_iter().chain(PARTS);
    match line.trim() {
        "none" => Vec::new(),
        "all" => PASSES.to_vec(),
        line => line
            .split(',')
            .map(|name| {
                let mut found = known().filter(|pass| pass.name == name.trim());
                found.next().unwrap_or_else(|| panic!("no pass `{name}`"))
            })
            .collect(),
    }
}

fn read(text: &str) -> Case {
    let (head, rest) = text.split_once("given:\n").expect("`given:`");
    let (given, expected) = rest.split_once("expected:\n").expect("`expected:`");
    let field = |name: &str| {
        let prefix = format!("{name}: ");
        let line = head.lines().find_map(|line| line.strip_prefix(&prefix));
        line.unwrap_or_else(|| panic!("`{name}:`")).to_owned()
    };
    assert!(field("reason").len() > 20, "a reason in a sentence: {head}");
    Case {
        passes: passes(&field("passes")),
        limits: match field("effort").as_str() {
            "none" => SearchLimits::NONE,
            "quick" => SearchLimits::QUICK,
            "thorough" => SearchLimits::THOROUGH,
            other => panic!("no effort `{other}`"),
        },
        start: match field("start").as_str() {
            "arena" => Start::Arena,
            "nodes" => Start::Nodes,
            other => panic!("no start `{other}`"),
        },
        head: head.to_owned(),
        given: given.to_owned(),
        expected: expected.to_owned(),
    }
}

/// Result of the passes.
fn run(case: &Case) -> String {
    let mut built = build(&parse(&case.given), case.start);
    built.measure();
    built.dag.verify().expect("a sound start");
    let before = built.dag.total();
    for pass in &case.passes {
        (pass.run)(&mut built.dag, &case.limits);
        let sound = built.dag.verify();
        sound.unwrap_or_else(|broken| panic!("after `{}`: {broken}", pass.name));
    }
    // A graph can be scheduled when its angles are planned.
    if case.passes.iter().any(|pass| pass.name == "angles") {
        let program = schedule(&built.dag, &built.inputs, &built.output);
        let program = program.expect("an order of the nodes");
        program.verify().expect("a sound program");
    }
    let text = listing(&built.dag);
    let indented: String = text.lines().map(|line| format!("    {line}\n")).collect();
    format!("{indented}    cost {before} -> {}\n", built.dag.total())
}

#[test]
fn optimiser_cases_give_the_expected_programs() {
    let mut files: Vec<PathBuf> = fs::read_dir(folder())
        .expect("the folder of cases")
        .map(|entry| entry.expect("a file").path())
        .collect();
    files.sort();
    assert!(files.len() >= 40, "{} cases", files.len());
    let mut wrong = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).expect("a readable case");
        let case = read(&text);
        let name = file.file_stem().unwrap_or_default().display();
        let found = std::panic::catch_unwind(|| run(&case));
        let Ok(found) = found else {
            wrong.push(format!("{name}: see the panic above"));
            continue;
        };
        if found == case.expected {
            continue;
        }
        if std::env::var_os("OVERACT_BLESS").is_some() {
            let updated = format!("{}given:\n{}expected:\n{found}", case.head, case.given);
            fs::write(&file, updated).expect("a writable case");
        } else {
            let expected = &case.expected;
            wrong.push(format!("{name}: expected\n{expected}found\n{found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
