//! Imports run downwards: the modules at the top of each crate have an order, and none imports from one
//! behind it.

use proc_macro2::{TokenStream, TokenTree};
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// The order of a crate's modules, from the bottom up.
struct House {
    folder: &'static str,
    order: &'static [&'static str],
}

const HOUSES: [House; 6] = [
    House {
        folder: "codegen",
        order: &[
            "parallel",
            "effort",
            "diagnostic",
            "cas",
            "description",
            "mechanism",
            "derivation",
            "lowering",
            "evaluation",
            "selection",
            "model",
            "request",
            "checked",
            "compile",
            "emission",
            "internals",
        ],
    },
    House {
        folder: "identification",
        order: &[
            "error",
            "significant",
            "blocks",
            "thresholds",
            "series",
            "data",
            "filters",
            "settings",
            "monitor",
            "kinematics",
            "regression",
            "estimation",
            "calibration",
            "validation",
            "result",
            "assessment",
            "identify",
        ],
    },
    House {
        folder: "simulation",
        order: &[
            "error",
            "conditioning",
            "trajectory",
            "drives",
            "experiment",
            "train",
            "controller",
            "reference",
            "validation",
            "plant",
            "sensors",
            "run",
            "log",
            "excitation",
        ],
    },
    House {
        folder: "report",
        order: &[
            "escape",
            "units",
            "published",
            "terminal",
            "beside",
            "numbers",
            "plot",
            "page",
        ],
    },
    House {
        folder: "robot",
        order: &[
            "error",
            "interpreted",
            "compiled_file",
            "robot",
            "settings",
            "calibration",
            "experiment",
            "check",
            "runs",
            "tracking",
            "partitions",
            "identifier",
        ],
    },
    House {
        folder: "cli",
        order: &[
            "failure", "names", "output", "note", "effort", "progress", "states", "drawing",
            "report", "commands", "guarded",
        ],
    },
];

/// The path of a folder of the workspace.
fn workspace(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(folder)
}

/// All files of Rust below a folder, in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let below = |path: PathBuf| match path.is_dir() {
        true => files(&path),
        false => vec![path],
    };
    let all = paths.into_iter().flat_map(below);
    all.filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect()
}

/// The modules in which a file lies: `kinematics`, `forward` for `kinematics/forward.rs`.
fn modules(source: &Path, file: &Path) -> Vec<String> {
    let inside = file.strip_prefix(source).expect("a file of the crate");
    let stem = inside.with_extension("");
    let parts = stem.iter().map(|part| part.to_string_lossy().into_owned());
    parts.filter(|part| part != "mod").collect()
}

/// Names at the root of the crate that tokens of a file name, where `depth` is the depth of its module.
/// What only tests see is left out.
fn named(tokens: TokenStream, depth: usize, found: &mut BTreeSet<String>) {
    let all: Vec<TokenTree> = tokens.into_iter().collect();
    let is_colon =
        |at: usize| matches!(all.get(at), Some(TokenTree::Punct(p)) if p.as_char() == ':');
    let is_word =
        |at: usize, word: &str| matches!(all.get(at), Some(TokenTree::Ident(i)) if *i == word);
    let mut at = 0;
    while at < all.len() {
        if let TokenTree::Group(group) = &all[at] {
            if group.to_string().replace(' ', "") == "[cfg(test)]" {
                while at < all.len() && !ends_item(&all[at]) {
                    at += 1;
                }
            } else {
                named(group.stream(), depth, found);
            }
            at += 1;
            continue;
        }
        let mut root = at;
        let mut supers = 0;
        while is_word(root, "super") && is_colon(root + 1) {
            (root, supers) = (root + 3, supers + 1);
        }
        if is_word(at, "crate") && is_colon(at + 1) {
            roots(&all, at + 3, found);
        } else if supers > 0 && supers == depth {
            roots(&all, root, found);
        }
        at = root.max(at + 1);
    }
}

/// Whether an item ends here: a body, or a semicolon.
fn ends_item(token: &TokenTree) -> bool {
    match token {
        TokenTree::Group(group) => group.delimiter() == proc_macro2::Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        _ => false,
    }
}

/// The first names of what follows `crate::`: one, or each of a group.
fn roots(tokens: &[TokenTree], at: usize, found: &mut BTreeSet<String>) {
    match tokens.get(at) {
        Some(TokenTree::Ident(name)) => {
            found.insert(name.to_string());
        }
        Some(TokenTree::Group(group)) => {
            let inside: Vec<TokenTree> = group.stream().into_iter().collect();
            let mut first = true;
            for token in inside {
                match token {
                    TokenTree::Ident(name) if first => {
                        found.insert(name.to_string());
                        first = false;
                    }
                    TokenTree::Punct(punct) if punct.as_char() == ',' => first = true,
                    _ => {}
                }
            }
        }
        _ => {}
    }
}

/// What is wrong with the imports of a file, by the order of its crate.
fn wrong(house: &House, modules: &[String], text: &str) -> Vec<String> {
    let mut found = BTreeSet::new();
    let tokens = text.parse().expect("Rust");
    named(tokens, modules.len(), &mut found);
    let place = |name: &str| house.order.iter().position(|module| *module == name);
    let own = modules.first().map_or("", String::as_str);
    let Some(floor) = place(own) else {
        return vec![format!(
            "`{own}` has no place in the order of {}",
            house.folder
        )];
    };
    let complaint = |name: &String| match place(name) {
        Some(other) if other <= floor => None,
        Some(_) => Some(format!("{} imports up, from `{name}`", modules.join("/"))),
        None => Some(format!(
            "{} imports `{name}`, which is no module, from the crate's root",
            modules.join("/")
        )),
    };
    found.iter().filter_map(complaint).collect()
}

#[test]
fn imports_run_downwards() {
    let mut all = Vec::new();
    for house in &HOUSES {
        let source = workspace(house.folder).join("src");
        let mut seen = BTreeSet::new();
        for file in files(&source) {
            let modules = modules(&source, &file);
            let is_root = matches!(modules.as_slice(), [one] if one == "lib" || one == "main");
            let is_test = modules.iter().any(|module| module == "tests");
            if is_root || is_test {
                continue;
            }
            seen.insert(modules[0].clone());
            let text = fs::read_to_string(&file).expect("a text");
            let complaints = wrong(house, &modules, &text);
            all.extend(
                complaints
                    .into_iter()
                    .map(|one| format!("{}: {one}", house.folder)),
            );
        }
        let gone = house.order.iter().filter(|module| !seen.contains(**module));
        all.extend(gone.map(|module| format!("{}: there is no `{module}`", house.folder)));
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
}

#[test]
fn an_import_from_above_is_seen() {
    let house = House {
        folder: "house",
        order: &["low", "high"],
    };
    let complaints = |text: &str, file: &[&str]| {
        let modules: Vec<String> = file.iter().map(|part| (*part).to_owned()).collect();
        wrong(&house, &modules, text).len()
    };
    assert_eq!(complaints("use crate::{low::A, high::B};", &["high"]), 0);
    assert_eq!(complaints("use crate::{low::A, high::B};", &["low"]), 1);
    assert_eq!(complaints("fn a() { super::high::b(); }", &["low"]), 1);
    assert_eq!(complaints("use super::super::high;", &["low", "room"]), 1);
    assert_eq!(complaints("use super::high;", &["low", "room"]), 0);
    assert_eq!(complaints("use crate::Thing;", &["high"]), 1);
    assert_eq!(
        complaints("// crate::high\npub(crate) fn a() {}", &["low"]),
        0
    );
    assert_eq!(
        complaints("#[cfg(test)] mod tests { use crate::high; }", &["low"]),
        0
    );
    assert_eq!(complaints("", &["attic"]), 1);
}
