//! Compares physically consistent estimates with base parameters, with ten times the described
//! torque noise.
//!
//! `cargo run --release -p overact-robot --example consistent -- robots/*.toml`.

use overact::Model;
use overact_identification::{Projection, estimate_projection, prepare};
use overact_robot::Robot;
use std::{error::Error, process::ExitCode, time::Instant};

/// Factor on the description's torque noise.
const NOISE: f64 = 10.0;

/// Smallest time of a few runs, ms.
fn milliseconds(run: impl Fn()) -> f64 {
    let once = || {
        let start = Instant::now();
        run();
        1e3 * start.elapsed().as_secs_f64()
    };
    (0..5).map(|_| once()).fold(f64::INFINITY, f64::min)
}

fn row(path: &str) -> Result<String, Box<dyn Error>> {
    let robot = Robot::from_toml(path)?;
    let mut experiment = robot.experiment()?;
    let noise = &mut experiment.plan_mut().torque_noise;
    noise.iter_mut().for_each(|deviation| *deviation *= NOISE);
    let runs = experiment.runs(&robot.held_out(), &|_, _| {})?;
    let settings = robot.settings(runs.sampling_frequency());
    let (model, info) = (robot.model(), robot.model().info());
    let projection = if info.sizes.actuators > info.sizes.dof {
        Projection::Platform
    } else {
        Projection::Joints
    };
    let prepared = prepare(model, &runs.identified, &[projection], &settings, &|_| {})?;
    let outcome = estimate_projection(&prepared, 0, &settings, None)?;
    let consistent = || prepared.consistent(0, &outcome.base, &settings.prior);
    let found = consistent().ok_or("no consistent estimate")?;
    let least = found.bodies.iter().map(|body| body.definiteness);
    Ok(format!(
        "| {} | {} | {} | {} | {:.4} | {:.4} | {:.1e} | {:.1} |",
        info.name,
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
    println!(
        "| robot | base parameters | standard parameters | bodies | error of the base parameters, % | of the consistent ones, % | least definite body | ms |\n|---|---:|---:|---:|---:|---:|---:|---:|"
    );
    let mut all = ExitCode::SUCCESS;
    for path in std::env::args().skip(1) {
        match row(&path) {
            Ok(row) => println!("{row}"),
            Err(error) => {
                eprintln!("{path}: {error}");
                all = ExitCode::FAILURE;
            }
        }
    }
    all
}
