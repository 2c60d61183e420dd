//! Section 5.4 of the paper, end to end.
//!
//! The virtual robot is identified, the parameters become constants of the controller's modules,
//! and the controller follows validation trajectories. It is compared with a PD controller alone.
//! Tracking errors are those of Table 4.

use overact::{Columns, Error, Function, Model};
use overact_codegen::{Choice, Effort, Request, backends::rust};
use overact_controller::{ACTUATORS, Controller, Load, Motion, loaded, unloaded};
use overact_robot::{CompiledFile, Identifier, Robot};
use overact_simulation::{Control, Desired, Experiment, Run, simulate, simulate_controlled};
use overact_tier::{by_tier, is_full};
use std::path::Path;

const HERE: &str = env!("CARGO_MANIFEST_DIR");

fn dualv() -> Robot {
    Robot::from_toml(Path::new(HERE).join("../../robots/dualv.toml")).unwrap()
}

/// The firmware's controller in the simulation's loop.
struct OnBoard(Controller);

impl Control for OnBoard {
    fn step(
        &mut self,
        desired: &Desired<'_>,
        measured: &[f64],
        torques: &mut [f64],
    ) -> Result<(), Error> {
        let motion = Motion {
            pose: numbers(desired.pose),
            twist: numbers(desired.twist),
            acceleration: numbers(desired.acceleration),
        };
        let found = self.0.step(&motion, &numbers(measured))?;
        torques.copy_from_slice(&found);
        Ok(())
    }
}

fn numbers<const N: usize>(slice: &[f64]) -> [f64; N] {
    slice.try_into().expect("as many as the robot has")
}

fn load(run: &Run) -> Load {
    if run.payload {
        Load::Loaded
    } else {
        Load::Unloaded
    }
}

#[test]
fn checked_in_modules_are_fresh() {
    let all = ["actuator_positions", "inverse_dynamics", "project_torques"];
    let platform = ["pose_from_actuators", "project_platform", "idm_red_payload"];
    let modules = [
        (
            "unloaded",
            include_str!("../src/unloaded.rs"),
            &all[..],
            true,
        ),
        ("loaded", include_str!("../src/loaded.rs"), &all[1..2], true),
        (
            "platform",
            include_str!("../src/platform.rs"),
            &platform[..],
            false,
        ),
    ];
    for (name, text, functions, has_parameters) in modules {
        let choice = Choice::new(functions.iter().copied()).unwrap();
        let request = Request {
            functions: Some(&choice),
            otherwise: Effort::Thorough,
            ..Request::default()
        };
        let folder = Path::new(HERE);
        let description = folder.join("../../robots/dualv.toml");
        let parameters = folder.join(format!("{name}.toml"));
        let made = if has_parameters {
            CompiledFile::with_parameters(&description, &parameters, &request)
        } else {
            CompiledFile::read(&description, &request)
        };
        let parameters = if has_parameters {
            format!(" --parameters examples/controller/{name}.toml")
        } else {
            String::new()
        };
        let functions = functions.join(",");
        let label = format!("robots/dualv.toml{parameters} --functions {functions}");
        let expected = rust::file(&made.unwrap().model, &label);
        // The full texts would fill the screen.
        let same = expected == text;
        assert!(
            same,
            "src/{name}.rs is stale: run examples/controller/generate"
        );
    }
}

/// Largest errors of each actuator in a validation run, rad.
///
/// They are those of PD alone, the firmware's controller, and the simulation's own with the true
/// parameters.
fn tracking(robot: &Robot, plan: &Experiment, run: &Run) -> [Vec<f64>; 3] {
    let alone = |feed_forward| Experiment {
        feed_forward,
        runs: vec![run.clone()],
        ..plan.clone()
    };
    let own = |feed_forward| {
        let records = simulate(robot.model(), &alone(feed_forward), &|_, _| {}).unwrap();
        records[0].tracking_error.clone()
    };
    let mut board = OnBoard(Controller::new(load(run)));
    let record = simulate_controlled(robot.model(), &alone(false), run, &mut board).unwrap();
    [own(false), record.tracking_error, own(true)]
}

#[test]
fn computed_torque_tracks_better_than_pd() {
    let robot = dualv();
    let experiment = robot.experiment().unwrap();
    let mut plan = experiment.plan().clone();
    plan.duration_s = by_tier([0.6, plan.duration_s]);
    let held = robot.held_out();
    let runs: Vec<Run> = { plan.runs.iter() }
        .filter(|run| held.contains(&run.name))
        .cloned()
        .collect();
    assert_eq!(runs.len(), 2);
    for run in &runs {
        let [pd, board, ideal] = tracking(&robot, &plan, run);
        let [pd, board, ideal] =
            [pd, board, ideal].map(|all| all.iter().map(|e| 1e3 * e).collect::<Vec<_>>());
        println!(
            "{}, mrad: PD {pd:.3?}, on board {board:.3?}, true parameters {ideal:.3?}",
            run.name
        );
        for ((pd, board), ideal) in pd.iter().zip(board).zip(ideal) {
            // Table 4 has reductions of 55.9 % to 76.6 %, for a flexible robot with torque ripple.
            assert!(board < 0.1 * pd, "{}: {board} of {pd} mrad", run.name);
            assert!(board < 1.5 * ideal, "{}: {board}, {ideal} mrad", run.name);
        }
    }
}

/// Inverse dynamics with constant parameters compared with the true parameters, along the
/// validation runs.
#[test]
fn constant_parameter_torques_match_the_true_parameters() {
    let robot = dualv();
    let experiment = robot.experiment().unwrap();
    let plan = experiment.plan();
    let truth = plan.parameters.clone();
    compare(&robot, plan, &truth, 0.01);
}

#[test]
fn a_new_identification_gives_the_constant_parameters() {
    if !is_full() {
        return;
    }
    let robot = dualv();
    let experiment = robot.experiment().unwrap();
    let runs = experiment.runs(&robot.held_out(), &|_, _| {}).unwrap();
    let result = Identifier::new(&robot).data(&runs).run().unwrap();
    let consistent = &result.consistent[0].parameters;
    let info = robot.model().info();
    let all = info.parameters.iter().chain(info.payload_parameters);
    let value = |name: &str| consistent.iter().find(|one| one.name == name);
    let values: Vec<f64> = all.map(|one| value(one.name).unwrap().value).collect();
    compare(&robot, experiment.plan(), &values, 1e-6);
}

/// Asserts that the torques equal those of `parameters`, up to a fraction of the largest torque.
fn compare(robot: &Robot, plan: &Experiment, parameters: &[f64], part: f64) {
    let own = robot.model().info().sizes.parameters;
    for run in &plan.runs {
        let mut parameters = parameters.to_vec();
        if !run.payload {
            parameters[own..].fill(0.0);
        }
        let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
        let frequency = 20.0;
        let samples =
            overact_simulation::sample(robot.model(), &run.trajectory, frequency, 40).unwrap();
        let states = samples
            .pose
            .chunks_exact(3)
            .zip(samples.twist.chunks_exact(3));
        for ((pose, twist), acceleration) in states.zip(samples.acceleration.chunks_exact(3)) {
            let mut expected = [0.0; ACTUATORS];
            let function = Function::InverseDynamics(Columns::Standard);
            let inputs = [pose, twist, acceleration, &parameters];
            robot
                .model()
                .evaluate(function, &inputs, &mut expected)
                .unwrap();
            let (pose, twist) = (&numbers(pose), &numbers(twist));
            let acceleration = &numbers(acceleration);
            let found = match load(run) {
                Load::Unloaded => unloaded::DualV::inverse_dynamics(pose, twist, acceleration),
                Load::Loaded => loaded::DualV::inverse_dynamics(pose, twist, acceleration),
            };
            for (found, expected) in found.unwrap().iter().zip(expected) {
                worst = worst.max((found - expected).abs());
                largest = largest.max(expected.abs());
            }
        }
        assert!(
            worst < part * largest,
            "{}: {worst:e} of {largest:e} N m",
            run.name
        );
    }
}
