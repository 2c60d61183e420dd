//! Assembles the page.
//!
//! `overact-page-assembly bind MODULE.wasm FOLDER` writes the script that calls the WebAssembly, as
//! the `wasm-bindgen` command does. `overact-page-assembly page STATIC ROBOTS FOLDER` adds the
//! static files, the descriptions, and `overact.html`, a single file that needs no server.

mod one_file;

use std::{collections::BTreeMap, error::Error, fs, path::Path, process::ExitCode};
use wasm_bindgen_cli_support::Bindgen;

const HELP: &str = "\
overact-page-assembly bind MODULE.wasm FOLDER
overact-page-assembly page STATIC ROBOTS FOLDER";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        ["bind", module, folder] => bind(module, folder),
        ["page", files, robots, folder] => page(files.as_ref(), robots.as_ref(), folder.as_ref()),
        _ => {
            eprintln!("{HELP}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Writes `overact.js` and `overact_bg.wasm`.
fn bind(module: &str, folder: &str) -> Result<(), Box<dyn Error>> {
    let mut binding = Bindgen::new();
    binding
        .input_path(module)
        .out_name("overact")
        .typescript(false);
    // A plain script, which works in Node and in a worker made from text.
    let written = binding
        .no_modules(true)
        .and_then(|binding| binding.generate(folder));
    written.map_err(|error| format!("{error:?}").into())
}

/// Writes all other files.
fn page(files: &Path, robots: &Path, folder: &Path) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(files)? {
        let entry = entry?;
        fs::copy(entry.path(), folder.join(entry.file_name()))?;
    }
    fs::write(folder.join("robots.js"), robots_script(robots)?)?;
    one_file::write(folder)
}

/// Script with all descriptions, sorted by name.
fn robots_script(robots: &Path) -> Result<String, Box<dyn Error>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(robots)? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            all.insert(stem.into_owned(), fs::read_to_string(&path)?);
        }
    }
    let texts = serde_json::to_string(&all)?;
    Ok(format!(
        "// Descriptions that come along.\n'use strict';\n\nconst ROBOTS = {texts};\n"
    ))
}
