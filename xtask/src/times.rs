//! Processor time of each test binary.

use crate::Failure;
use crate::binaries::binaries;
use crate::metadata::{cargo, without_examples};
use std::fs;

/// Builds all tests, runs the binaries one after the other and prints their times, at last as a
/// sorted table.
pub(crate) fn table(most: Option<&str>) -> Result<(), Failure> {
    let most: f64 = most.map_or(Ok(f64::INFINITY), str::parse)?;
    let mut rows = Vec::new();
    let mut failed = Vec::new();
    for binary in binaries()? {
        let before = children()?;
        let output = binary.command().output()?;
        let seconds = children()? - before;
        eprintln!("{seconds:8.1} s  {}", binary.name);
        rows.push((seconds, binary.name.clone()));
        if !output.status.success() {
            failed.push(binary.name);
        }
    }
    let examples = "examples in the documentation".to_owned();
    // If only examples are requested, cargo would also search libraries without any.
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

/// Processor time of all ended child processes on Linux, s.
fn children() -> Result<f64, Failure> {
    let text = fs::read_to_string("/proc/self/stat")?;
    // The second field is the program's name in parentheses. Fields 16 and 17 are the times of
    // waited-for children, in hundredths of a second.
    let (_, fields) = text.rsplit_once(')').ok_or("unexpected /proc/self/stat")?;
    let ticks = fields
        .split_whitespace()
        .skip(13)
        .take(2)
        .map(str::parse::<f64>);
    Ok(ticks.sum::<Result<f64, _>>()? / 100.0)
}
