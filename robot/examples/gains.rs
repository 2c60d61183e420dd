//! Identifies wrong drive gains by means of a weighed payload, in virtual runs.
//!
//! It prints the errors of the gains and of the jointly estimated parameters in standard
//! deviations. `cargo run --release -p overact-robot --example gains -- 10 robots/rx90.toml
//! robots/dualv.toml` draws ten times.

use overact::Model;
use overact_identification::{Identification, Log, Stage};
use overact_robot::{Identifier, Robot, Runs};
use rand_distr::{Distribution, StandardNormal, Uniform};
use rand_pcg::Pcg64;
use std::{error::Error, process::ExitCode};

/// Any error.
type Failure = Box<dyn Error>;

/// Smallest and largest relative error of a gain.
const WRONG: [f64; 2] = [0.12, 0.33];

/// Payload of a serial robot: mass, first moments and inertias, fixed to the last body.
const PAYLOAD: &str = "m_payload = 5\nmx_payload = 0.25\nmy_payload = -0.1\nmz_payload = 0.9\n\
                       xx_payload = 0.18\nyy_payload = 0.2\nzz_payload = 0.03\n";

/// Description with a payload of known mass, which is added if there is none.
fn with_payload(text: &str) -> Result<String, Failure> {
    let mass = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("m_payload = "));
        line.map(|line| line.replace("m_payload = ", ""))
    };
    let mut text = text.to_owned();
    if mass(&text).is_none() {
        let starts: Vec<usize> = { text.match_indices("[[experiment.run]]") }
            .map(|(at, _)| at)
            .collect();
        let [first, second, ..] = starts[..] else {
            return Err("the description needs two runs".into());
        };
        // The first run again, with the payload.
        let run = &text[first..second];
        let loaded = run.replacen("name = \"", "payload = true\nname = \"loaded_", 1);
        let body = "[[leg.arm.joint]]\nname = \"payload\"\ntype = \"fixed\"\n\n[[place]]";
        text = text.replacen("[[place]]", body, 1) + "\n" + &loaded;
        let parameters = "[experiment.parameters]\n";
        text = text.replacen(parameters, &format!("{parameters}{PAYLOAD}"), 1);
    }
    let mass = mass(&text).ok_or("the description has no payload")?;
    let known = format!("[identification]\ngains = true\nknown = {{ m_payload = {mass} }}");
    Ok(text.replacen("[identification]", &known, 1))
}

/// Results of a draw: errors in standard deviations, and the largest relative error of a gain.
#[derive(Default)]
struct Misses {
    gains: Vec<f64>,
    /// Masses estimated together with the gains.
    masses: Vec<f64>,
    /// All parameters estimated together with the gains.
    parameters: Vec<f64>,
    /// Estimated relative to true mass of the payload, with the torques that the gains give.
    weighed: f64,
    largest: f64,
}

fn misses(result: &Identification, gains: &[f64]) -> Result<Misses, Failure> {
    let mut run_misses = Misses::default();
    for (own, truth) in result.gains.iter().zip(gains) {
        run_misses.gains.push((own.factor - truth) / own.deviation);
        run_misses.largest = run_misses.largest.max((own.factor / truth - 1.0).abs());
    }
    for own in &result.gain_parameters {
        let mut all = result.base_parameters.iter();
        let known = all.find(|one| one.name == own.name);
        let Some(truth) = known.and_then(|one| one.true_value) else {
            continue;
        };
        let miss = (own.value - truth) / own.deviation;
        run_misses.parameters.push(miss);
        if own.name.starts_with("m_") {
            run_misses.masses.push(miss);
        }
    }
    let mut base = result.by_least_squares();
    let base = base.find(|one| one.stage == Stage::Base);
    let parameters = base.map_or(&[][..], |one| &one.parameters);
    let weighed = parameters.iter().find(|one| one.name == "m_payload");
    let weighed = weighed.ok_or("the payload's mass is not estimated")?;
    run_misses.weighed = weighed.error_percent.unwrap_or(f64::NAN) / 100.0;
    Ok(run_misses)
}

/// Runs as logged with such gains, with torque noise of these standard deviations (N m).
fn logged(
    runs: &[Log],
    (gains, noise): (&[f64], &[f64]),
    random: &mut Pcg64,
) -> Result<Vec<Log>, Failure> {
    let mut logs = Vec::new();
    for run in runs {
        let (positions, mut torques) = run.load()?;
        for row in torques.chunks_exact_mut(gains.len()) {
            for ((torque, gain), deviation) in row.iter_mut().zip(gains).zip(noise) {
                let normal: f64 = StandardNormal.sample(random);
                *torque = (*torque + deviation * normal) / gain;
            }
        }
        let (frequency, n) = (run.sampling_frequency(), gains.len());
        logs.push(Log::new(
            run.name(),
            frequency,
            n,
            positions,
            torques,
            run.payload(),
        )?);
    }
    Ok(logs)
}

fn largest(misses: &[f64]) -> f64 {
    misses.iter().map(|miss| miss.abs()).fold(0.0, f64::max)
}

/// Prints a row for each draw.
fn rows(path: &str, draws: u64) -> Result<(), Failure> {
    let text = with_payload(&std::fs::read_to_string(path)?)?;
    let rendered = |error: overact_robot::Error| error.render(false);
    let robot = Robot::from_text(path, &text).map_err(rendered)?;
    let mut experiment = robot.experiment().map_err(rendered)?;
    let noise = std::mem::take(&mut experiment.plan_mut().torque_noise);
    // A serial robot needs all of its runs.
    let held_out = robot.held_out();
    let exact = experiment.runs(&held_out, &|_, _| {}).map_err(rendered)?;
    let name = robot.model().info().name.to_owned();
    let n = robot.model().info().sizes.actuators;
    let parts = Uniform::new(WRONG[0], WRONG[1])?;
    let sides = Uniform::new(-1.0, 1.0)?;
    let mut squares = (0.0, 0.0);
    for draw in 1..=draws {
        let mut random = Pcg64::new(u128::from(draw), 0x6761_696e);
        let gain = |_| 1.0 + f64::copysign(parts.sample(&mut random), sides.sample(&mut random));
        let gains: Vec<f64> = (0..n).map(gain).collect();
        let runs = Runs {
            identified: logged(&exact.identified, (&gains, &noise), &mut random)?,
            validation: Vec::new(),
            true_values: exact.true_values.clone(),
        };
        let result = Identifier::new(&robot)
            .data(&runs)
            .run()
            .map_err(rendered)?;
        let own = misses(&result, &gains)?;
        let gains: Vec<String> = gains.iter().map(|gain| format!("{gain:.2}")).collect();
        println!(
            "| {name} | {draw} | {} | {:.2} | {:.2} | {} | {:.2} of {} | {:.2} |",
            gains.join(", "),
            100.0 * own.largest,
            largest(&own.gains),
            match own.masses[..] {
                [] => String::from("-"),
                _ => format!("{:.2}", largest(&own.masses)),
            },
            largest(&own.parameters),
            own.parameters.len(),
            100.0 * own.weighed.abs(),
        );
        squares.0 += own.gains.iter().map(|miss| miss * miss).sum::<f64>();
        squares.1 += own.gains.len() as f64;
    }
    let size = (squares.0 / f64::max(squares.1, 1.0)).sqrt();
    eprintln!("{name}: gains are off by {size:.2} deviations, as a root mean square");
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let draws = arguments.first().and_then(|draws| draws.parse().ok());
    let (Some(draws), Some(robots)) = (draws, arguments.get(1..)) else {
        eprintln!("how often is drawn, and descriptions with virtual experiments");
        return ExitCode::FAILURE;
    };
    println!(
        "| robot | draw | gains | gains off by at most, % | gains, deviations | masses, deviations | all parameters, deviations | the weighed mass is off by, % |\n|---|---:|---|---:|---:|---:|---:|---:|"
    );
    let mut all = ExitCode::SUCCESS;
    for path in robots {
        if let Err(error) = rows(path, draws) {
            eprintln!("{path}: {error}");
            all = ExitCode::FAILURE;
        }
    }
    all
}
