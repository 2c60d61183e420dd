//! Estimates whether a robot's base was tilted when its logs were recorded.
//!
//! It estimates the direction of gravity from one run, and plots the effect of tilts on the
//! prediction of another. The example replaces the description's line `gravity = [...]`, by a vector
//! of 9.81 m/s².
//!
//! ```text
//! cargo run --release -p overact-robot --example tilt -- \
//!     robots/dvrk_mtm.toml TRAINING TEST docs/dvrk_mtm.svg
//! ```

use nalgebra::{Matrix2, Vector2};
use overact::Model;
use overact_identification::{
    Identification, Log, Projection, Stage, estimate_projection, prepare,
};
use overact_report::{Plot, chart_sheet};
use overact_robot::{Identifier, Robot};
use std::{error::Error, path::Path, process::ExitCode};

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.81;

/// Number of plotted steps from no tilt to twice the estimated one; even.
const STEPS: u32 = 10;

/// Step of the finite differences, rad.
const STEP: f64 = 0.03;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [description, training, test, file] = &arguments[..] else {
        eprintln!("a description, a log to identify from, another one, and the file to write");
        return ExitCode::FAILURE;
    };
    match run(description, [training, test], file) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Estimates the tilt, prints the errors, and writes the plots.
fn run(description: &str, logs: [&String; 2], file: &str) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(description)?;
    let plain = Robot::from_text(description, &text)?;
    let files = logs.map(|log| (Path::new(log.as_str()), false));
    let logs = plain.read_logs(&files, &|_| {})?;
    let tilt = estimate_tilt(&text, &logs[..1])?;
    println!(
        "tilt of gravity in the base's frame: {:.2} deg towards x, {:.2} deg towards y",
        tilt.x.to_degrees(),
        tilt.y.to_degrees()
    );
    let (mut tilts, mut all) = (Vec::new(), Vec::new());
    for step in 0..=STEPS {
        let factor = 2.0 * f64::from(step) / f64::from(STEPS);
        let robot = tilted(&text, tilt * factor)?;
        let (training, test) = logs.split_at(1);
        let result = Identifier::new(&robot)
            .runs(training)
            .validation(test)
            .run()?;
        tilts.push((tilt * factor).norm().to_degrees());
        all.push([Stage::Base, Stage::Consistent].map(|stage| errors(&result, stage)));
    }
    for (name, step) in [("as described", 0), ("gravity tilted", STEPS as usize / 2)] {
        for (stage, errors) in ["base", "consistent"].iter().zip(&all[step]) {
            let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
            println!("{name}, {stage}: {errors:.1?}, mean {mean:.2} %");
        }
    }
    let names = plain.model().info().actuators.iter();
    let names: Vec<String> = names.map(|name| (*name).to_owned()).collect();
    std::fs::write(file, chart_sheet(&plots(&names, &tilts, &all), 3))?;
    Ok(())
}

/// Robot with gravity tilted by two angles (rad), towards x and y.
fn tilted(text: &str, tilt: Vector2<f64>) -> Result<Robot, overact_robot::Error> {
    let [x, y] = [tilt.x, tilt.y].map(|angle| -GRAVITY * angle.sin());
    let z = -(GRAVITY * GRAVITY - x * x - y * y).sqrt();
    let line = |line: &str| {
        if line.starts_with("gravity = ") {
            format!("gravity = [\"{x:.9} m/s^2\", \"{y:.9} m/s^2\", \"{z:.9} m/s^2\"]\n")
        } else {
            format!("{line}\n")
        }
    };
    let text: String = text.lines().map(line).collect();
    Robot::from_text("tilted.toml", &text)
}

/// Tilt (rad) with the smallest residual, by one Newton step with finite differences.
///
/// The residual of each row of Γ is divided by its value without tilt.
fn estimate_tilt(text: &str, runs: &[Log]) -> Result<Vector2<f64>, Box<dyn Error>> {
    let residuals = |tilt: Vector2<f64>| -> Result<Vec<f64>, Box<dyn Error>> {
        let robot = tilted(text, tilt)?;
        let settings = robot.settings(runs[0].sampling_frequency());
        let kind = match robot.model().info().sizes {
            sizes if sizes.actuators > sizes.dof => Projection::Platform,
            _ => Projection::Joints,
        };
        let prepared = prepare(robot.model(), runs, &[kind], &settings, &|_| {})?;
        let base = estimate_projection(&prepared, 0, &settings, None)?.base;
        Ok(base.lines.iter().map(|line| line.residual_norm).collect())
    };
    let scales = residuals(Vector2::zeros())?;
    let value = |tilt: Vector2<f64>| -> Result<f64, Box<dyn Error>> {
        let own = residuals(tilt)?;
        let each = own.iter().zip(&scales).map(|(own, scale)| own / scale);
        Ok(each.map(|part| part * part).sum())
    };
    let (x, y) = (Vector2::new(STEP, 0.0), Vector2::new(0.0, STEP));
    let here = value(Vector2::zeros())?;
    let (right, left) = (value(x)?, value(-x)?);
    let (up, down) = (value(y)?, value(-y)?);
    let both = value(x + y)?;
    let square = STEP * STEP;
    let slope = Vector2::new(right - left, up - down) / (2.0 * STEP);
    let across = (both - right - up + here) / square;
    let curvature = Matrix2::new(
        (right - 2.0 * here + left) / square,
        across,
        across,
        (up - 2.0 * here + down) / square,
    );
    let step = curvature.lu().solve(&slope).ok_or("no tilt is best")?;
    Ok(-step)
}

/// Relative error of each actuator's torque on the validation run, percent.
fn errors(result: &Identification, stage: Stage) -> Vec<f64> {
    let own = result
        .cross_validation
        .iter()
        .find(|one| one.stage == stage);
    let torques = own.iter().flat_map(|one| &one.torques);
    torques.map(|one| one.relative_error_percent).collect()
}

/// Plots the validation error of each actuator over multiples of the estimated tilt.
fn plots(names: &[String], tilts: &[f64], all: &[[Vec<f64>; 2]]) -> Vec<Plot> {
    let plot = |(joint, name): (usize, &String)| {
        let stages = ["base parameters", "consistent"].into_iter().enumerate();
        let curves = stages.map(|(stage, what)| {
            let own = all.iter().filter_map(|one| one[stage].get(joint).copied());
            (what.to_owned(), tilts.to_vec(), own.collect())
        });
        Plot {
            title: format!("Joint {name} of the test run: error, %"),
            axes: [String::from("tilt of gravity (deg)"), String::from("%")],
            curves: curves.collect(),
            ..Plot::default()
        }
    };
    names.iter().enumerate().map(plot).collect()
}
