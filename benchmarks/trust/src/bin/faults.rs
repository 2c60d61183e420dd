//! `faults ROBOTS…`: each fault over many draws of the noise: grades, and errors of usable values.

use clap::Parser;
use overact_trust::{
    Failure, Subject,
    faults::{Draws, FaultRow, header, rows},
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Prints the fault table.
#[derive(Debug, Parser)]
struct Arguments {
    /// Descriptions with virtual experiments
    #[arg(value_name = "TOML", required = true)]
    robots: Vec<PathBuf>,
    /// Draws of the noise for each fault
    #[arg(long, default_value_t = 10)]
    draws: u64,
    /// Only faults whose names contain one of these words
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Draws that are identified at once
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Shorten all runs to this part of their duration
    #[arg(long, default_value_t = 0.25)]
    part: f64,
    /// Write the rows as JSON, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn of_robot(arguments: &Arguments, path: &Path) -> Result<Vec<FaultRow>, Failure> {
    let mut subject = Subject::load(path)?;
    subject.shorten(arguments.part);
    let wanted = |name: &str| {
        arguments.only.is_empty()
            || arguments
                .only
                .iter()
                .any(|part| name.contains(part.as_str()))
    };
    let print = |row: &FaultRow| println!("{row}");
    let draws = Draws {
        part: arguments.part,
        count: arguments.draws,
    };
    rows(path, &subject, draws, &wanted, &print)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads)
        .build_global()?;
    let mut all = Vec::new();
    println!("{}", header());
    for path in &arguments.robots {
        all.extend(of_robot(arguments, path)?);
    }
    if let Some(path) = &arguments.json {
        fs::write(path, serde_json::to_string_pretty(&all)?)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
