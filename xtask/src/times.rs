//! The processor time of each test binary, so that the suite stays one that people run.

use crate::Failure;
use crate::metadata::{cargo, without_examples};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A test binary as cargo has built it.
struct Binary {
    /// Its package and its own name.
    name: String,
    file: PathBuf,
    /// The package's folder, in which cargo runs it.
    folder: PathBuf,
}

/// Builds all tests, runs one binary after the other and says what each took, at once on stderr and then
/// as a table, most first.
pub(crate) fn table(most: Option<&str>) -> Result<(), Failure> {
    let most: f64 = most.map_or(Ok(f64::INFINITY), str::parse)?;
    let mut rows = Vec::new();
    let mut failed = Vec::new();
    for binary in binaries()? {
        let before = children()?;
        let mut command = Command::new(&binary.file);
        command
            .current_dir(&binary.folder)
            .env("CARGO_MANIFEST_DIR", &binary.folder);
        let output = command.stdin(Stdio::null()).output()?;
        let seconds = children()? - before;
        eprintln!("{seconds:8.1} s  {}", binary.name);
        rows.push((seconds, binary.name.clone()));
        if !output.status.success() {
            failed.push(binary.name);
        }
    }
    let examples = "examples in the documentation".to_owned();
    // Asked for examples alone, cargo looks for them in libraries that say that they have none, too.
    let silent = without_examples()?;
    let excluded = silent.iter().flat_map(|name| ["--exclude", name]);
    let chosen: Vec<&str> = ["--workspace", "--quiet"]
        .into_iter()
        .chain(excluded)
        .collect();
    cargo(&[&["build"], chosen.as_slice()].concat())?;
    let before = children()?;
    if let Err(failure) = cargo(&[&["test", "--doc"], chosen.as_slice()].concat()) {
        eprintln!("{failure}");
        failed.push(examples.clone());
    }
    rows.push((children()? - before, examples));
    rows.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    for (seconds, name) in &rows {
        println!("{seconds:8.1} s  {name}");
    }
    let all: f64 = rows.iter().map(|(seconds, _)| seconds).sum();
    println!("{all:8.1} s  all {}", rows.len());
    if !failed.is_empty() {
        return Err(format!("failed: {}", failed.join(", ")).into());
    }
    if all > most {
        return Err(format!("{all:.1} s are more than {most:.1} s").into());
    }
    Ok(())
}

fn binaries() -> Result<Vec<Binary>, Failure> {
    let messages = cargo(&["test", "--workspace", "--no-run", "--message-format=json"])?;
    let mut binaries = Vec::new();
    for line in messages.lines() {
        let message: Value = serde_json::from_str(line)?;
        let is_test = message["profile"]["test"] == true;
        if let (true, Some(file), Some(manifest)) = (
            is_test,
            message["executable"].as_str(),
            message["manifest_path"].as_str(),
        ) {
            let folder = Path::new(manifest).parent().unwrap_or(Path::new("."));
            let package = folder.file_name().unwrap_or_default().to_string_lossy();
            let kind = message["target"]["kind"][0].as_str().unwrap_or_default();
            let name = message["target"]["name"].as_str().unwrap_or_default();
            binaries.push(Binary {
                name: format!("{package}: {kind} {name}"),
                file: file.into(),
                folder: folder.to_owned(),
            });
        }
    }
    Ok(binaries)
}

/// Seconds of the processor that all ended children of this process took, as Linux counts them.
fn children() -> Result<f64, Failure> {
    let text = fs::read_to_string("/proc/self/stat")?;
    // The second field is the program's name in parentheses; those of waited-for children are the
    // 16th and the 17th, in hundredths of a second.
    let (_, fields) = text.rsplit_once(')').ok_or("unexpected /proc/self/stat")?;
    let ticks = fields
        .split_whitespace()
        .skip(13)
        .take(2)
        .map(str::parse::<f64>);
    Ok(ticks.sum::<Result<f64, _>>()? / 100.0)
}
