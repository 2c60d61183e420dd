//! Times the block evaluator for a robot's regressor in the layout of rows, for comparison with
//! `benchmark.py`.
//!
//! `cargo run --release --example rows ../robots/dualv.toml 1000000`.

use overact::{Columns, Function, Model};
use overact_codegen::interpreter::{Evaluator, Rows};
use overact_robot::Robot;
use std::{error::Error, time::Instant};

const ROUNDS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("name a description")?;
    let samples: usize = arguments.next().ok_or("say how many samples")?.parse()?;
    let robot = Robot::from_toml(file)?;
    let model = robot.model().model();
    let function = model
        .served(Function::IdmRedPlatform(Columns::Standard))
        .ok_or("no identification model")?;
    let home = robot.model().info().home_pose;
    // A motion around home; only its reachability matters.
    let row = |width: usize, base: &[f64]| -> Vec<f64> {
        let number = |at: usize| {
            let home = base.get(at % width).copied().unwrap_or_default();
            home + 0.05 * (at as f64 * 0.7).sin()
        };
        (0..samples * width).map(number).collect()
    };
    let inputs = function.program.inputs.iter();
    let inputs: Vec<Vec<f64>> = inputs
        .map(|array| match array.name.as_str() {
            "pose" | "joints" => row(array.len(), home),
            _ => row(array.len(), &[]),
        })
        .collect();
    let rows: Vec<Rows<'_>> = inputs
        .iter()
        .map(|values| Rows {
            values,
            shared: false,
        })
        .collect();
    let mut output = vec![1.0; samples * function.program.entries.len()];
    let mut evaluator = Evaluator::new(&function.program);
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let begin = Instant::now();
        let done = evaluator.evaluate(samples, &rows, &mut output);
        done.map_err(|failed| format!("a state without a value: {failed:?}"))?;
        best = best.min(begin.elapsed().as_secs_f64());
    }
    let each = best / samples as f64 * 1e9;
    println!("the evaluator itself: {each:.1} ns a sample ({samples} samples)");
    Ok(())
}
