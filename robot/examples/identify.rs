//! Identifies a robot from logs, or from its virtual experiment without logs.
//!
//! `cargo run --release -p overact-robot --example identify -- robots/dualv.toml [LOG ...]`.

use overact_robot::{Error, Identifier, Robot, Runs};
use std::{path::Path, process::ExitCode};

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let description = arguments.next().unwrap_or("robots/dualv.toml".to_owned());
    let logs: Vec<String> = arguments.collect();
    match identified(&description, &logs) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn identified(description: &str, logs: &[String]) -> Result<(), Error> {
    let robot = Robot::from_toml(description)?;
    let runs = if logs.is_empty() {
        let experiment = robot.experiment()?;
        experiment.runs(&robot.held_out(), &|_, _| {})?
    } else {
        let files: Vec<(&Path, bool)> = logs.iter().map(|log| (Path::new(log), false)).collect();
        Runs {
            identified: robot.read_logs(&files, &|_| {})?,
            ..Runs::default()
        }
    };
    let result = Identifier::new(&robot).data(&runs).run()?;
    for estimate in &result.estimates {
        let (model, stage) = (estimate.model, estimate.stage.name());
        println!(
            "{model}, {stage}: error {:.3} %",
            estimate.relative_error_percent
        );
        for parameter in &estimate.parameters {
            let deviation = parameter.correlated_standard_deviation;
            let (name, unit) = (&parameter.name, &parameter.unit);
            println!("  {name} = {:.6} ± {deviation:.1e} {unit}", parameter.value);
        }
    }
    Ok(())
}
