//! Searches exciting runs and plots how well they determine the parameters.
//!
//! The plots compare them with the description's own runs and a hundred random ones, and show the
//! runs with their limits: `cargo run --release -p overact-robot --example excitation --
//! robots/dualv.toml docs/excitation_dualv.svg`.

use overact::{Columns, Function, Model};
use overact_report::{Plot, chart_sheet};
use overact_robot::{CaseOfRuns, Error, Excitation, ExcitationEffort, LimitKind, Robot};
use overact_simulation::{Trajectory, sample};
use std::process::ExitCode;

/// Samples per period in the plots.
const SAMPLES: usize = 400;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let (Some(description), Some(file)) = (arguments.next(), arguments.next()) else {
        eprintln!("a description and the file to write");
        return ExitCode::FAILURE;
    };
    let drawn = drawn(&description).map_err(|error| error.to_string());
    let written = drawn.and_then(|svg| std::fs::write(file, svg).map_err(|e| e.to_string()));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn drawn(description: &str) -> Result<String, Error> {
    let robot = Robot::from_toml(description)?;
    let found = robot.excite(&ExcitationEffort::default(), &|_, _| {})?;
    let again = Robot::from_text("excited.toml", &robot.with_runs(&found)?)?;
    let mut plots = Vec::new();
    for case in 0..found.found.cases.len() {
        plots.extend(compared(&found, case));
    }
    for run in &found.runs {
        plots.extend(motion(&again, &found, run));
    }
    Ok(chart_sheet(&plots, 3))
}

/// Condition number, largest and median relative standard deviation in one projection, of all
/// compared runs.
fn compared(found: &Excitation, case: usize) -> Vec<Plot> {
    type Figure = fn(&CaseOfRuns) -> f64;
    let figures: [(&str, Figure); 3] = [
        ("condition number", |one| one.condition),
        ("largest relative deviation", |one| {
            one.deviations.map_or(f64::NAN, |all| all[2])
        }),
        ("median relative deviation", |one| {
            one.deviations.map_or(f64::NAN, |all| all[1])
        }),
    ];
    let model = found.found.cases[case].model;
    let plot = |(name, of): (&str, Figure)| {
        let mut all: Vec<f64> = found.hundred.iter().map(|one| of(&one[case])).collect();
        all.sort_by(f64::total_cmp);
        let places: Vec<f64> = (1..=all.len()).map(|place| place as f64).collect();
        let own = found
            .described
            .iter()
            .map(|own| (&own.cases[case], "by hand"));
        let others = [
            (&found.random.cases[case], "best random"),
            (&found.found.cases[case], "found"),
        ];
        for (one, what) in own.clone().chain(others) {
            println!("{model}, {name}, {what}: {:.3e}", of(one));
        }
        println!(
            "{model}, {name}, hundred random: {:.3e} to {:.3e}",
            all.first().copied().unwrap_or(f64::NAN),
            all.last().copied().unwrap_or(f64::NAN)
        );
        Plot {
            title: format!("{model}: {name}"),
            axes: [
                String::from("a hundred random ones, in order"),
                String::new(),
            ],
            logarithmic: true,
            curves: vec![(String::from("random"), places, all)],
            dots: true,
            rules: own
                .chain(others)
                .map(|(one, what)| (of(one), what.to_owned()))
                .collect(),
        }
    };
    figures.into_iter().map(plot).collect()
}

/// A run over a period: positions, speeds and torques relative to their limits.
fn motion(robot: &Robot, found: &Excitation, run: &str) -> Vec<Plot> {
    let Ok(experiment) = robot.experiment() else {
        return Vec::new();
    };
    let plan = experiment.plan();
    let Some(own) = plan.runs.iter().find(|own| own.name == run) else {
        return Vec::new();
    };
    let Trajectory::Periodic { fundamental_hz, .. } = &own.trajectory else {
        return Vec::new();
    };
    let (model, frequency) = (robot.model(), fundamental_hz * SAMPLES as f64);
    let info = model.info();
    let sizes = info.sizes;
    let Ok(motion) = sample(model, &own.trajectory, frequency, SAMPLES) else {
        return Vec::new();
    };
    let mut parameters = plan.parameters.clone();
    if !own.payload {
        parameters[sizes.parameters..].fill(0.0);
    }
    let ask = |function: Function, inputs: &[&[f64]]| {
        let (rows, columns) = function.shape(&sizes);
        let mut values = vec![0.0; SAMPLES * rows * columns];
        let result = model.evaluate(function, inputs, &mut values);
        result.map(|()| values).unwrap_or_default()
    };
    let states: [&[f64]; 4] = [
        &motion.pose,
        &motion.twist,
        &motion.acceleration,
        &parameters,
    ];
    let joints = ask(Function::JointVelocities, &states[..2]);
    let actuated = joints.chunks_exact(sizes.joints);
    let rates: Vec<f64> = actuated
        .flat_map(|row| info.actuated_joints.iter().map(|&joint| row[joint]))
        .collect();
    let home = info.home_pose.iter().cycle();
    let away = motion.pose.iter().zip(home).map(|(at, home)| at - home);
    let all = [
        (
            LimitKind::Position,
            away.collect(),
            sizes.pose,
            info.coordinates,
        ),
        (LimitKind::Velocity, rates, sizes.actuators, info.actuators),
        (
            LimitKind::Torque,
            ask(Function::InverseDynamics(Columns::Standard), &states),
            sizes.actuators,
            info.actuators,
        ),
    ];
    let drawn = |(kind, values, width, names): (LimitKind, Vec<f64>, usize, &[&str])| {
        let limit = found.limits.iter().find(|limit| limit.kind == kind)?;
        let time: Vec<f64> = (0..SAMPLES).map(|k| k as f64 / frequency).collect();
        let curve = |(at, name): (usize, &&str)| {
            let most = limit.values.get(at).copied().unwrap_or(f64::NAN);
            let own = values.iter().skip(at).step_by(width);
            (
                (*name).to_owned(),
                time.clone(),
                own.map(|v| v / most).collect(),
            )
        };
        Some(Plot {
            title: format!("{run}: {} by its limit", kind.name()),
            axes: [String::from("t (s)"), String::new()],
            curves: names.iter().enumerate().map(curve).collect(),
            rules: [-1.0, 1.0].map(|at| (at, String::from("limit"))).to_vec(),
            ..Plot::default()
        })
    };
    all.into_iter().filter_map(drawn).collect()
}
