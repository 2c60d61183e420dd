//! `consistent ROBOTS…`: physically consistent estimates beside base parameters, for noisy virtual runs.

use clap::Parser;
use overact_identification::{Prepared, Settings, estimate_projection, prepare};
use overact_trust::{Failure, Subject, draw};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

/// Estimates what a robot can have.
#[derive(Debug, Parser)]
struct Arguments {
    /// Descriptions with virtual experiments
    #[arg(value_name = "TOML", required = true)]
    robots: Vec<PathBuf>,
    /// Multiple of the description's torque noise
    #[arg(long, default_value_t = 10.0)]
    noise: f64,
}

/// The smallest time of a few runs, ms.
fn milliseconds(run: impl Fn()) -> f64 {
    let once = || {
        let start = Instant::now();
        run();
        1e3 * start.elapsed().as_secs_f64()
    };
    (0..5).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn row(path: &Path, noise: f64) -> Result<String, Failure> {
    let subject = Subject::load(path)?;
    let records = draw::records(&subject, &subject.experiment, 1.0)?;
    let logs = draw::logs(&subject, &records, noise, 1)?;
    let settings: &Settings = &subject.settings;
    let projections = subject.projections();
    let prepared: Prepared = prepare(subject.model(), &logs, &projections, settings, &|_| {})?;
    let outcome = estimate_projection(&prepared, 0, settings, None)?;
    let consistent = || prepared.consistent(0, &outcome.base, &settings.prior);
    let found = consistent().ok_or("no consistent estimate")?;
    let least = found.bodies.iter().map(|body| body.definiteness);
    Ok(format!(
        "| {} | {} | {} | {} | {:.4} | {:.4} | {:.1e} | {:.1} |",
        subject.info().name,
        outcome.base.parameters.len(),
        found.parameters.len(),
        found.bodies.len(),
        found.base_relative_error_percent,
        found.relative_error_percent,
        least.fold(f64::INFINITY, f64::min),
        milliseconds(|| drop(consistent())),
    ))
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    println!(
        "| robot | base parameters | standard parameters | bodies | error of the base parameters, % | of the consistent ones, % | least definite body | ms |\n|---|---:|---:|---:|---:|---:|---:|---:|"
    );
    let mut all = ExitCode::SUCCESS;
    for path in &arguments.robots {
        match row(path, arguments.noise) {
            Ok(row) => println!("{row}"),
            Err(error) => {
                eprintln!("{}: {error}", path.display());
                all = ExitCode::FAILURE;
            }
        }
    }
    all
}
