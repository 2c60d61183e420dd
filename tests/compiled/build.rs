//! Generates what the tests need compiled and `generated/` does not keep as text: the other robots of
//! `robots/`, and the DualV in each of its four partitions, the way a user's build script does.
//!
//! The default tier searches operations quickly, the full tier thoroughly, as the manifest of
//! `generated/` has them. The partitions differ in one line of the description, so the variants are made
//! from the one description here and not kept as copies.

use overact_codegen::{Effort, Request, Source, compile_with, emission};
use overact_tier::{VARIABLE, by_tier};
use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../robots");
    println!("cargo::rerun-if-env-changed={VARIABLE}");
    let effort = by_tier([Effort::Quick, Effort::Thorough]);
    for entry in fs::read_dir("../../robots")? {
        let path = entry?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_kept = Path::new(&format!("../../generated/src/{stem}.rs")).exists();
        if path.extension().is_some_and(|e| e == "toml") && !is_kept {
            write(&stem, &stem, &fs::read_to_string(&path)?, effort)?;
        }
    }
    let dualv = fs::read_to_string("../../robots/dualv.toml")?;
    for kept in [[1, 2, 3], [1, 2, 4], [1, 3, 4], [2, 3, 4]] {
        let [a, b, c] = kept;
        // The description's own partition is compared, token by token, with the checked-in module.
        let is_own = kept == [1, 2, 3];
        let effort = if is_own { Effort::Thorough } else { effort };
        let module = format!("dualv_kept_{a}{b}{c}");
        write(&module, "dualv", &with_kept(&dualv, kept), effort)?;
    }
    Ok(())
}

/// Writes the module of a description's text.
fn write(module: &str, stem: &str, text: &str, effort: Effort) -> Result<(), Box<dyn Error>> {
    let name = format!("robots/{stem}.toml");
    let source = Source::new(name.as_str(), text);
    let compiled = compile_with(&source, &Request::with_effort(effort))
        .map_err(|errors| errors.render_plain(&source))?;
    let file = Path::new(&env::var("OUT_DIR")?).join(format!("{module}.rs"));
    fs::write(file, emission::file(&compiled.model, &name))?;
    Ok(())
}

/// The description with other actuators kept in case 2.
fn with_kept(text: &str, kept: [usize; 3]) -> String {
    let names = kept.map(|leg| format!("\"leg{leg}\"")).join(", ");
    let line = |line: &str| {
        if line.starts_with("kept_actuators = ") {
            format!("kept_actuators = [{names}]\n")
        } else {
            format!("{line}\n")
        }
    };
    text.lines().map(line).collect()
}
