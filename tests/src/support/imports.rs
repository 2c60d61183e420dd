//! Imports between the modules of a crate, from their tokens.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// Path of modules and a name, from the root of the crate.
type Names = Vec<String>;

/// A file and its imports from its own crate.
#[derive(Debug)]
pub struct Module {
    /// Path of its module: `kinematics`, `forward` for `kinematics/forward.rs`.
    pub path: Names,
    /// Targets of its paths, through re-exports; test code is ignored.
    pub imports: BTreeSet<Names>,
}

impl Module {
    /// Imports of a file's text.
    ///
    /// # Panics
    /// If the text is not Rust.
    #[must_use]
    pub fn of(path: &[&str], text: &str, reexports: &BTreeMap<Names, Names>) -> Self {
        let path: Names = path.iter().map(|&part| part.to_owned()).collect();
        let mut found = Vec::new();
        named(text.parse().expect("Rust"), &mut found);
        let whole = found.iter().filter_map(|names| absolute(&path, names));
        let imports = whole.map(|names| origin(names, reexports)).collect();
        Self { path, imports }
    }
}

/// All modules of a crate except its root and its tests.
///
/// # Panics
/// If the folder cannot be read.
#[must_use]
pub fn modules(source: &Path) -> Vec<Module> {
    let all: Vec<(Names, String)> = files(source)
        .into_iter()
        .map(|file| {
            let text = fs::read_to_string(&file).expect("a text");
            (path_of(source, &file), text)
        })
        .filter(|(path, _)| {
            let is_root = matches!(path.as_slice(), [one] if one == "lib" || one == "main");
            !is_root && path.iter().all(|module| module != "tests")
        })
        .collect();
    let mut reexports = BTreeMap::new();
    for (path, text) in &all {
        reexported(path, text.parse().expect("Rust"), &mut reexports);
    }
    all.iter()
        .map(|(path, text)| {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            Module::of(&path, text, &reexports)
        })
        .collect()
}

/// All Rust files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let below = |path: PathBuf| {
        if path.is_dir() {
            files(&path)
        } else {
            vec![path]
        }
    };
    let all = paths.into_iter().flat_map(below);
    all.filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .collect()
}

fn path_of(source: &Path, file: &Path) -> Names {
    let inside = file.strip_prefix(source).expect("a file of the crate");
    let stem = inside.with_extension("");
    let parts = stem.iter().map(|part| part.to_string_lossy().into_owned());
    parts.filter(|part| part != "mod").collect()
}

/// Whether the tokens around a name are those of a path.
fn is_colon(tokens: &[TokenTree], at: usize) -> bool {
    let is = |at: usize| matches!(tokens.get(at), Some(TokenTree::Punct(p)) if p.as_char() == ':');
    is(at) && is(at + 1)
}

/// All paths that begin with `crate`, `super` or `self`.
fn named(tokens: TokenStream, found: &mut Vec<Names>) {
    let all: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < all.len() {
        match &all[at] {
            TokenTree::Group(group) if group.to_string().replace(' ', "") == "[cfg(test)]" => {
                while at < all.len() && !ends_item(&all[at]) {
                    at += 1;
                }
            }
            TokenTree::Group(group) => named(group.stream(), found),
            TokenTree::Ident(word)
                if ["crate", "super", "self"].iter().any(|root| word == root)
                    && is_colon(&all, at + 1)
                    && !(at >= 2 && is_colon(&all, at - 2)) =>
            {
                tree(&all, at, &[], found);
            }
            _ => {}
        }
        at += 1;
    }
}

/// Whether an item ends here: a body, or a semicolon.
fn ends_item(token: &TokenTree) -> bool {
    match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        _ => false,
    }
}

/// Paths that begin at a token: one, or several if it ends in a group.
fn tree(tokens: &[TokenTree], mut at: usize, before: &[String], found: &mut Vec<Names>) {
    let mut path = before.to_vec();
    loop {
        match tokens.get(at) {
            Some(TokenTree::Ident(name)) => path.push(name.to_string()),
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                let inside: Vec<TokenTree> = group.stream().into_iter().collect();
                let is_comma =
                    |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ',');
                for part in inside.split(is_comma).filter(|part| !part.is_empty()) {
                    tree(part, 0, &path, found);
                }
                return;
            }
            _ => break,
        }
        if !is_colon(tokens, at + 1) {
            break;
        }
        at += 3;
    }
    found.push(path);
}

/// Path from the root of the crate; `None` if it leads above the root.
fn absolute(module: &[String], names: &[String]) -> Option<Names> {
    let mut whole = match names.first()?.as_str() {
        "crate" => Vec::new(),
        _ => module.to_vec(),
    };
    for name in names {
        match name.as_str() {
            "super" => drop(whole.pop()?),
            "crate" | "self" => {}
            _ => whole.push(name.clone()),
        }
    }
    Some(whole)
}

/// Collects the re-exports of a module from its own crate.
fn reexported(module: &[String], tokens: TokenStream, found: &mut BTreeMap<Names, Names>) {
    let all: Vec<TokenTree> = tokens.into_iter().collect();
    let is_word =
        |at: usize, word: &str| matches!(all.get(at), Some(TokenTree::Ident(i)) if i == word);
    for at in 0..all.len() {
        let public = is_word(at, "pub");
        let narrowed = matches!(all.get(at + 1), Some(TokenTree::Group(_)));
        let start = at + 1 + usize::from(narrowed);
        if !(public && is_word(start, "use")) {
            continue;
        }
        let mut paths = Vec::new();
        tree(&all, start + 1, &[], &mut paths);
        for path in paths {
            let Some(name) = path.last().cloned() else {
                continue;
            };
            if let Some(origin) = absolute(module, &path) {
                found.insert([module, &[name]].concat(), origin);
            }
        }
    }
}

/// Origin of a name through re-exports.
fn origin(mut names: Names, reexports: &BTreeMap<Names, Names>) -> Names {
    for _ in 0..4 {
        let known = (1..=names.len()).rev();
        let known = known.filter_map(|n| Some((n, reexports.get(&names[..n])?)));
        match known.take(1).next() {
            Some((length, to)) if *to != names => {
                names = [to.as_slice(), &names[length..]].concat();
            }
            _ => break,
        }
    }
    names
}
