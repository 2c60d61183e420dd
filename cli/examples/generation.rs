//! How long generation takes for every robot of `robots/`, and the compilation of its module alone.
//!
//! `cargo run --release -p overact-cli --example generation [ROBOT ...]` prints a Markdown table. Generation
//! is measured inside of this program, from text to text, with both efforts. A module is compiled by
//! cargo as a library of its own in a scratch crate, in release with `opt-level = 3`; its dependency
//! `overact` has been compiled before.

use overact_codegen::{Effort, Request, Source, compile_with, emission};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    time::{Duration, Instant},
};

/// What goes wrong ends the measurement.
type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let only: Vec<String> = env::args().skip(1).collect();
    let scratch = tempfile::tempdir()?;
    prepare(scratch.path(), &folder)?;
    println!("| robot | legs | generation, quick | generation, thorough | module | compilation |");
    println!("|---|---:|---:|---:|---:|---:|");
    for path in robots(&folder)? {
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if !only.is_empty() && !only.contains(&name) {
            continue;
        }
        let (quick, _, _) = generated(&path, Effort::Quick)?;
        let (thorough, code, legs) = generated(&path, Effort::Thorough)?;
        fs::write(scratch.path().join("src/lib.rs"), &code)?;
        let compiled = build(scratch.path())?;
        println!(
            "| {name} | {legs} | {} | {} | {:.0} kB, {} lines | {} |",
            seconds(quick),
            seconds(thorough),
            code.len() as f64 / 1e3,
            code.lines().count(),
            seconds(compiled),
        );
    }
    Ok(())
}

fn robots(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut robots = Vec::new();
    for entry in fs::read_dir(folder.join("robots"))? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            robots.push(path);
        }
    }
    robots.sort();
    Ok(robots)
}

/// Time from a description's text to the text of its module, the text, and the number of legs.
fn generated(path: &Path, effort: Effort) -> Result<(Duration, String, usize), Failure> {
    let source = Source::new(path.display().to_string(), fs::read_to_string(path)?);
    let start = Instant::now();
    let model = compile_with(&source, &Request::with_effort(effort))
        .map_err(|errors| errors.render_plain(&source))?;
    let code = emission::file(&model, "robot.toml");
    Ok((start.elapsed(), code, model.mechanism.legs.len()))
}

/// A crate for the modules, whose dependency is compiled.
fn prepare(scratch: &Path, folder: &Path) -> Result<(), Failure> {
    let runtime = folder.canonicalize()?.join("runtime");
    let manifest = format!(
        "[package]\nname = \"scratch\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
         [dependencies]\noveract = {{ path = {:?}, default-features = false, features = [\"std\"] }}\n\n\
         [profile.release]\nopt-level = 3\nincremental = false\n\n[workspace]\n",
        runtime.display().to_string()
    );
    fs::create_dir(scratch.join("src"))?;
    fs::write(scratch.join("Cargo.toml"), manifest)?;
    fs::write(scratch.join("src/lib.rs"), "")?;
    build(scratch)?;
    Ok(())
}

/// Builds the crate and says how long that takes.
fn build(scratch: &Path) -> Result<Duration, Failure> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let start = Instant::now();
    let output = Command::new(cargo)
        .args(["build", "--release", "--quiet"])
        .current_dir(scratch)
        .env("CARGO_TARGET_DIR", scratch.join("target"))
        .output()?;
    let elapsed = start.elapsed();
    match output.status.success() {
        true => Ok(elapsed),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.2} s", time.as_secs_f64())
}
