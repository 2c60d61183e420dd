//! `overact-trust ROBOTS…`: the coverage table, see the library.

use clap::Parser;
use overact_trust::{Cell, DrawIntervals, Failure, Noise, Subject, Tally, measure, table};
use rayon::prelude::*;
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

/// Counts how often 95 % intervals contain the truth.
#[derive(Debug, Parser)]
struct Arguments {
    /// Descriptions with virtual experiments
    #[arg(value_name = "TOML", required = true)]
    robots: Vec<PathBuf>,
    /// Draws of each robot
    #[arg(long, default_value_t = 30)]
    draws: u64,
    /// Number of the first draw
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// Draws that are made at once
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Shorten all runs to this part of their duration
    #[arg(long, default_value_t = 1.0)]
    part: f64,
    /// Noise as TORQUE:ENCODER, multiples of the description's
    #[arg(long, value_delimiter = ',', default_value = "1:1,10:1,1:10", value_parser = noise)]
    noise: Vec<Noise>,
    /// Write the cells as JSON, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

fn noise(text: &str) -> Result<Noise, String> {
    let both = text
        .split_once(':')
        .ok_or("give TORQUE:ENCODER, like 10:1")?;
    let number = |text: &str| text.parse::<f64>().map_err(|error| error.to_string());
    Ok(Noise {
        torque: number(both.0)?,
        encoder: number(both.1)?,
    })
}

fn cells(arguments: &Arguments, path: &Path) -> Result<Vec<Cell>, Failure> {
    let mut subject = Subject::load(path)?;
    subject.shorten(arguments.part);
    let start = Instant::now();
    let draws = arguments.first..arguments.first + arguments.draws;
    let one = |draw| measure(&subject, draw, &arguments.noise);
    let all: Vec<Result<Vec<DrawIntervals>, Failure>> = draws.into_par_iter().map(one).collect();
    let mut tally = Tally::default();
    for (number, draw) in (arguments.first..).zip(all) {
        match draw {
            Ok(draw) => tally.add(draw),
            Err(error) => eprintln!("{}: draw {number}: {error}", subject.info().name),
        }
    }
    eprintln!(
        "{}: {:.0} s",
        subject.info().name,
        start.elapsed().as_secs_f64()
    );
    Ok(tally.cells(subject.info().name))
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads)
        .build_global()?;
    let mut all = Vec::new();
    for path in &arguments.robots {
        all.extend(cells(arguments, path)?);
    }
    print!("{}", table::markdown(&all));
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
