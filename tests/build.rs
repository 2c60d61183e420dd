//! Generates the DualV in each of its four partitions, the way a user's build script does.
//!
//! The partitions differ in one line of the description, so the variants are made from the one
//! description here and not kept as copies.

use overact_codegen::{Effort, Request, Source, compile_with, emission};
use std::error::Error;
use std::path::Path;
use std::{env, fs};

const DESCRIPTION: &str = "../robots/dualv.toml";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={DESCRIPTION}");
    println!("cargo::rerun-if-changed=build.rs");
    let text = fs::read_to_string(DESCRIPTION)?;
    let folder = env::var("OUT_DIR")?;
    for kept in [[1, 2, 3], [1, 2, 4], [1, 3, 4], [2, 3, 4]] {
        let source = Source::new(DESCRIPTION, with_kept(&text, kept));
        let compiled = compile_with(&source, &Request::with_effort(Effort::Thorough))
            .map_err(|errors| errors.render_plain(&source))?;
        let [a, b, c] = kept;
        let file = Path::new(&folder).join(format!("dualv_kept_{a}{b}{c}.rs"));
        fs::write(file, emission::file(&compiled.model, "robots/dualv.toml"))?;
    }
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
