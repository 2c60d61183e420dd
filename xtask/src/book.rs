//! Documentation as a book: the page of all errors, and `docs/` with pages from other folders.

use crate::Failure;
use crate::files::{read, repository, write};
use crate::links::{is_foreign, links, resolved, texts};
use overact_codegen::diagnostic::Code;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The page of all errors.
const ERRORS: &str = "docs/errors.md";

/// Target of links from the book to files outside of it.
const REPOSITORY: &str = "https://github.com/overact/overact/blob/main";

/// Pages from other folders, with their names in the book.
const BORROWED: [(&str, &str); 1] = [("robots/README.md", "keys.md")];

/// Writes the page of all errors, and the source of the book in `target/book`, for `mdbook build
/// target/book`.
pub(crate) fn write_all() -> Result<(), Failure> {
    write(ERRORS, &errors())?;
    let pages = texts()?;
    let own = pages.iter().filter(|(file, _)| file.starts_with("docs/"));
    let borrowed = BORROWED
        .iter()
        .filter_map(|(file, _)| pages.get_key_value(*file));
    for (file, text) in own.chain(borrowed) {
        let name = in_book(file).unwrap_or_default();
        let text = if *file == *ERRORS {
            errors()
        } else {
            text.clone()
        };
        write(
            &format!("target/book/docs/{name}"),
            &redirected(file, &text),
        )?;
    }
    write(
        "target/book/book.toml",
        &read("docs/book.toml")?
            .replace("src = \".\"", "src = \"docs\"")
            .replace("\"book.css\"", "\"docs/book.css\""),
    )?;
    copy_assets(&repository("docs"), &repository("target/book/docs"))
}

/// Fails unless the page of all errors is up to date.
pub(crate) fn check() -> Result<(), Failure> {
    if read(ERRORS)? == errors() {
        Ok(())
    } else {
        Err(format!("{ERRORS}: renew it with `cargo xtask book`").into())
    }
}

/// The page of all errors.
fn errors() -> String {
    let mut text = String::from(
        "# Every error\n\nEach error has a code: `error[OA102]` on a terminal, `\"code\": \"OA102\"` with `--json`. \
         `overact explain OA102` prints its entry on this page. The meaning of a code never changes. \
         `cargo xtask book` writes this page.\n",
    );
    for (area, table) in Code::areas() {
        let _ = write!(text, "\n## {area}\n");
        for one in *table {
            let _ = write!(
                text,
                "\n### {}: {}\n\n{}\n\n**Remedy.** {}\n",
                one.code,
                one.title,
                escaped(one.cause),
                escaped(one.cure)
            );
        }
    }
    text
}

/// Escapes brackets outside of backquotes.
fn escaped(text: &str) -> String {
    let part = |(at, part): (usize, &str)| match at % 2 {
        0 => part
            .replace('[', "\\[")
            .replace(']', "\\]")
            .replace('*', "\\*")
            .replace('_', "\\_"),
        _ => format!("`{part}`"),
    };
    text.split('`').enumerate().map(part).collect()
}

/// Name of a file's page in the book, if it has one.
fn in_book(file: &str) -> Option<&str> {
    let borrowed = BORROWED.iter().find(|(path, _)| *path == file);
    borrowed
        .map(|(_, name)| *name)
        .or_else(|| file.strip_prefix("docs/"))
}

/// Page with links to pages of the book, or else to the repository.
fn redirected(file: &str, text: &str) -> String {
    let mut text = text.to_owned();
    let mut targets: Vec<String> = links(&text).into_iter().map(|link| link.target).collect();
    targets.sort();
    targets.dedup();
    for target in targets {
        let (path, anchor) = target.split_once('#').unwrap_or((&target, ""));
        if is_foreign(&target) || path.is_empty() {
            continue;
        }
        let resolved = resolved(file, path).unwrap_or_default();
        let place = match in_book(&resolved) {
            Some(name) => name.to_owned(),
            None => format!("{REPOSITORY}/{resolved}"),
        };
        let anchor = match anchor {
            "" => String::new(),
            _ => format!("#{anchor}"),
        };
        for (open, close) in [("](", ")"), ("src=\"", "\""), ("href=\"", "\"")] {
            text = text.replace(
                &format!("{open}{target}{close}"),
                &format!("{open}{place}{anchor}{close}"),
            );
        }
    }
    text
}

/// Copies pictures, styles and their folders.
fn copy_assets(from: &Path, to: &Path) -> Result<(), Failure> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type()?.is_dir() {
            copy_assets(&path, &target)?;
        } else if path
            .extension()
            .is_some_and(|e| e == "svg" || e == "png" || e == "css")
        {
            fs::create_dir_all(to)?;
            fs::copy(&path, &target)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Code, check, escaped, read, redirected};

    #[test]
    fn the_error_page_is_fresh() {
        check().expect("a fresh page");
    }

    /// Explanations must only name keys that exist.
    #[test]
    fn explanations_name_existing_keys_only() {
        let manual = [
            "robots/README.md",
            "docs/cli.md",
            "docs/functions.md",
            "docs/rust.md",
        ]
        .map(|file| read(file).expect(file));
        for one in Code::all() {
            let text = format!("{} `` {}", one.cause, one.cure);
            let quoted = text.split('`').enumerate().filter(|(at, _)| at % 2 == 1);
            for (_, word) in
                quoted.filter(|(_, word)| word.chars().all(|c| c.is_alphanumeric() || c == '_'))
            {
                let known = manual.iter().any(|manual| manual.contains(word));
                assert!(known || word.is_empty(), "{}: `{word}`", one.code);
            }
        }
    }

    #[test]
    fn links_are_redirected_into_the_book_or_to_the_repository() {
        let text = "[a](../robots/README.md#data) [b](trust.md) [c](../robots/tx40.toml) [d](#e)";
        let expected = "[a](keys.md#data) [b](trust.md) [c](https://github.com/overact/overact/blob/main/robots/tx40.toml) [d](#e)";
        assert_eq!(redirected("docs/x.md", text), expected);
        let picture = "[p](../docs/description/leg.svg) [q](../docs/logs.md)";
        assert_eq!(
            redirected("robots/README.md", picture),
            "[p](description/leg.svg) [q](logs.md)"
        );
    }

    #[test]
    fn toml_table_names_are_not_links() {
        assert_eq!(escaped("see [data] and `[a]`"), "see \\[data\\] and `[a]`");
    }
}
