//! Exciting runs keep every limit, have more information than random and described ones, and can be
//! read back.

use overact::{Columns, Function, Model};
use overact_robot::{Error, Excitation, ExcitationEffort, LimitKind, Robot};
use overact_simulation::{Run, Trajectory, sample};
use std::time::Duration;

/// Search that takes about a second.
const EFFORT: ExcitationEffort = ExcitationEffort {
    runs: None,
    seed: 3,
    generations: 15,
    time: None,
};

fn library(name: &str) -> Robot {
    let path = format!("{}/../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Robot::from_toml(path).expect("a robot of the library")
}

fn excited(robot: &Robot) -> Excitation {
    robot.excite(&EFFORT, &|_, _| ()).expect("exciting runs")
}

/// Robot of the written description.
fn written(robot: &Robot, found: &Excitation) -> Robot {
    let text = robot.with_runs(found).expect("a description");
    Robot::from_text("excited.toml", &text).expect("a description without errors")
}

/// The largest magnitudes of each number in rows of `width`.
fn peaks(rows: &[f64], width: usize) -> Vec<f64> {
    let own = |at: usize| rows.iter().skip(at).step_by(width);
    (0..width)
        .map(|at| own(at).fold(0.0, |most: f64, value| most.max(value.abs())))
        .collect()
}

/// Asserts that the robot's runs keep all limits on a grid much finer than that of the search.
///
/// Limited quantities are computed with the model's functions only.
fn keeps_limits(robot: &Robot, found: &Excitation) {
    let experiment = robot.experiment().expect("runs");
    let plan = experiment.plan();
    for run in plan
        .runs
        .iter()
        .filter(|run| found.runs.contains(&run.name))
    {
        let mut parameters = plan.parameters.clone();
        if !run.payload {
            parameters[robot.model().info().sizes.parameters..].fill(0.0);
        }
        for (limit, largest) in found
            .limits
            .iter()
            .zip(largest(robot, found, run, &parameters))
        {
            for (peak, most) in largest.iter().zip(&limit.values) {
                let (kind, name) = (limit.kind.name(), &run.name);
                assert!(peak <= most, "{kind}: {peak} beyond {most} in {name}");
            }
        }
    }
}

/// Largest magnitudes in a run of each limited quantity; nothing for travel and condition.
fn largest(robot: &Robot, found: &Excitation, run: &Run, parameters: &[f64]) -> Vec<Vec<f64>> {
    const SAMPLES: usize = 10_007;
    let model = robot.model();
    let info = model.info();
    let sizes = info.sizes;
    let Trajectory::Periodic { fundamental_hz, .. } = &run.trajectory else {
        panic!("a series");
    };
    let motion = sample(
        model,
        &run.trajectory,
        fundamental_hz * SAMPLES as f64,
        SAMPLES,
    );
    let motion = motion.expect("a motion that the robot reaches");
    let ask = |function: Function, inputs: &[&[f64]]| {
        let (rows, columns) = function.shape(&sizes);
        let mut values = vec![0.0; SAMPLES * rows * columns];
        model
            .evaluate(function, inputs, &mut values)
            .expect("values");
        values
    };
    let actuated = |rows: Vec<f64>| -> Vec<f64> {
        let rows = rows.chunks_exact(sizes.joints);
        rows.flat_map(|row| info.actuated_joints.iter().map(|&joint| row[joint]))
            .collect()
    };
    let inputs: [&[f64]; 4] = [
        &motion.pose,
        &motion.twist,
        &motion.acceleration,
        parameters,
    ];
    let home = info.home_pose.iter().cycle();
    let away: Vec<f64> = motion
        .pose
        .iter()
        .zip(home)
        .map(|(at, home)| at - home)
        .collect();
    let of = |kind: LimitKind| match kind {
        LimitKind::Position => peaks(&away, sizes.pose),
        LimitKind::Velocity => peaks(
            &actuated(ask(Function::JointVelocities, &inputs[..2])),
            sizes.actuators,
        ),
        LimitKind::Acceleration => peaks(
            &actuated(ask(Function::JointAccelerations, &inputs[..3])),
            sizes.actuators,
        ),
        LimitKind::Torque => peaks(
            &ask(Function::InverseDynamics(Columns::Standard), &inputs),
            sizes.actuators,
        ),
        LimitKind::Travel | LimitKind::Condition => Vec::new(),
    };
    found.limits.iter().map(|limit| of(limit.kind)).collect()
}

#[test]
fn a_five_bar_is_excited_within_its_limits() {
    let robot = library("five_bar");
    let found = excited(&robot);
    let again = written(&robot, &found);
    keeps_limits(&again, &found);
    let kinds: Vec<&str> = found.limits.iter().map(|limit| limit.kind.name()).collect();
    assert_eq!(
        kinds,
        [
            "position",
            "velocity",
            "acceleration",
            "torque",
            "condition"
        ]
    );
    let described = found.described.as_ref().expect("runs of the description");
    let best = &found.found.cases[0];
    for other in [&described.cases[0], &found.random.cases[0]] {
        assert!(best.log_det > other.log_det + 1.0, "{best:?} {other:?}");
    }
    assert!(found.found.limits_used.iter().all(|used| *used <= 1.0));
    // The runs read back are those that were judged.
    let evaluated = again
        .excite(
            &ExcitationEffort {
                generations: 0,
                ..EFFORT
            },
            &|_, _| (),
        )
        .expect("runs");
    let own = &evaluated.described.expect("the computed runs").cases[0];
    assert!(
        (own.condition / best.condition - 1.0).abs() < 1e-6,
        "{own:?} {best:?}"
    );
}

#[test]
fn excitation_keeps_its_limits_and_the_validation_runs() {
    let robot = library("emps");
    let table = "\n[excitation]\nfundamental = \"0.5 Hz\"\nharmonics = 4\nruns = 2\nposition = \"50 mm\"\nvelocity = \"0.2 m/s\"\nacceleration = \"1 m/s^2\"\n";
    let text = format!("{}{table}", robot.source().text).replace(
        "\nname = \"validation\"",
        "\nname = \"excitation 1\"\nvalidation = true",
    );
    let robot = Robot::from_text("emps.toml", &text).expect("a robot");
    let found = excited(&robot);
    assert_eq!(found.runs, ["excitation 2", "excitation 3"]);
    let values: Vec<f64> = found.limits.iter().map(|limit| limit.values[0]).collect();
    assert_eq!(values[..3], [0.05, 0.2, 1.0]);
    let again = written(&robot, &found);
    keeps_limits(&again, &found);
    let names: Vec<String> = again
        .experiment()
        .expect("runs")
        .plan()
        .runs
        .iter()
        .map(|run| run.name.clone())
        .collect();
    assert_eq!(names, ["excitation 2", "excitation 3", "excitation 1"]);
    assert_eq!(again.held_out(), ["excitation 1"]);
    // Equal seeds give equal runs.
    assert_eq!(excited(&robot).tables, found.tables);
}

/// Also for chains, whose motors may reach a singularity like those of a platform.
#[test]
fn unsatisfiable_limits_are_reported_at_their_line() {
    for name in ["five_bar", "ankle"] {
        let robot = library(name);
        let text = format!("{}\n[excitation]\ncondition = 1\n", robot.source().text);
        let line = text
            .lines()
            .position(|line| line == "[excitation]")
            .map(|at| at + 1);
        let robot = Robot::from_text(name, &text).expect("a robot");
        let error: Error = robot.excite(&EFFORT, &|_, _| ()).expect_err("no motion");
        let problems = error.problems();
        assert_eq!(problems[0].line, line, "{error}");
        assert!(
            problems[0]
                .message
                .contains("condition (of the description)"),
            "{error}"
        );
        assert!(problems[0].help.is_some());
    }
}

#[test]
fn the_time_limit_ends_the_random_search() {
    let robot = library("planar_3prr");
    let table = "\n[excitation]\nharmonics = 30\nruns = 1\n";
    let text = format!("{}{table}", robot.source().text);
    let robot = Robot::from_text("planar_3prr.toml", &text).expect("a robot");
    let effort = ExcitationEffort {
        time: Some(Duration::from_millis(1)),
        ..EFFORT
    };
    let found = robot.excite(&effort, &|_, _| ()).expect("exciting runs");
    let count = found.hundred.len();
    assert!((1..100).contains(&count), "{count}");
    let output = format!("the time sufficed for only {count} random series, not 100");
    assert!(found.assumed.contains(&output), "{:?}", found.assumed);
    keeps_limits(&written(&robot, &found), &found);
}

#[test]
fn missing_speed_limits_are_reported() {
    let robot = library("five_bar");
    let (text, _) = robot
        .source()
        .text
        .split_once("[[experiment.run]]")
        .expect("runs");
    let bare = |limit: &str| {
        let text = format!("{text}\n[excitation]\nruns = 1\n{limit}");
        let robot = Robot::from_text("bare.toml", &text).expect("a robot");
        let output = excited(&robot).assumed.join("\n");
        output.contains("speeds have no limit") && output.contains("rad/s")
    };
    assert!(bare(""));
    assert!(!bare("velocity = \"9 rad/s\"\n"));
}

/// A slider on two cranks of a length that is too short for the described runs.
fn yoke_with_cranks_of(length: &str) -> Robot {
    let text = library("scotch_yoke").source().text.clone();
    let start = text.find("crank = \"").expect("the length of the cranks");
    let end = start + text[start..].find('\n').expect("a line");
    let text = format!("{}crank = \"{length}\"{}", &text[..start], &text[end..]);
    Robot::from_text("yoke.toml", &text).expect("a robot")
}

#[test]
fn small_robots_are_excited_within_their_reach() {
    let robot = yoke_with_cranks_of("1 mm");
    let found = excited(&robot);
    let limit = found
        .limits
        .iter()
        .find(|own| own.kind == LimitKind::Position);
    let reach = limit.expect("a limit of the position").values[0];
    assert!((1e-4..1e-3).contains(&reach), "{reach}");
    keeps_limits(&written(&robot, &found), &found);
}

#[test]
fn excitation_of_immovable_robots_is_rejected() {
    let robot = yoke_with_cranks_of("1e-7 m");
    let error = robot.excite(&EFFORT, &|_, _| ()).expect_err("no motion");
    let problems = error.problems();
    assert!(
        problems[0].message.contains("no motion around home"),
        "{problems:?}"
    );
}
