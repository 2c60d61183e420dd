//! The payload is identified in closed loop, while the controller does not know it.

use overact::Error;
use overact_controller::payload::{EVERY, PayloadObserver};
use overact_controller::{ACTUATORS, Controller, Load, Motion, SAMPLING_HZ};
use overact_robot::Robot;
use overact_simulation::{Control, Desired, Experiment, Run, simulate_controlled};
use overact_tier::by_tier;
use std::path::Path;

/// Mass of the payload in the description, kg, and its centre, m.
const MASS: f64 = 5.42;
const CENTRE: f64 = -0.127 / MASS;

/// Controller with observer, and what it found.
struct Observed {
    controller: Controller,
    observer: PayloadObserver,
    torques: [f64; ACTUATORS],
    samples: u32,
    changes: Vec<f64>,
    /// Mass and standard deviation at each estimation.
    masses: Vec<[f64; 2]>,
}

fn numbers<const N: usize>(slice: &[f64]) -> [f64; N] {
    slice.try_into().expect("as many as the robot has")
}

impl Control for Observed {
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
        let measured = numbers(measured);
        // The torques so far led to these positions.
        let changed = self
            .observer
            .step(&measured, &self.torques)
            .expect("a sample");
        let time = f64::from(self.samples) / SAMPLING_HZ;
        if changed {
            self.changes.push(time);
        }
        if self.samples.is_multiple_of(EVERY) {
            self.masses.push(self.observer.mass().expect("a mass"));
        }
        self.samples += 1;
        self.torques = self.controller.step(&motion, &measured)?;
        torques.copy_from_slice(&self.torques);
        Ok(())
    }
}

/// Runs a validation trajectory with the controller of the unloaded robot.
fn run(robot: &Robot, plan: &Experiment, run: &Run) -> Observed {
    let start = [0.0; 3];
    let mut control = Observed {
        controller: Controller::new(Load::Unloaded),
        observer: PayloadObserver::new(start).expect("an observer"),
        torques: [0.0; ACTUATORS],
        samples: 0,
        changes: Vec::new(),
        masses: Vec::new(),
    };
    let alone = Experiment {
        feed_forward: false,
        runs: vec![run.clone()],
        ..plan.clone()
    };
    simulate_controlled(robot.model(), &alone, run, &mut control).expect("a run");
    control
}

#[test]
fn the_payload_is_identified_while_the_robot_moves() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/dualv.toml");
    let robot = Robot::from_toml(file).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let mut plan = experiment.plan().clone();
    plan.duration_s = by_tier([2.0, plan.duration_s]);
    let held = robot.held_out();
    let runs: Vec<Run> = { plan.runs.iter() }
        .filter(|run| held.contains(&run.name))
        .cloned()
        .collect();
    for own in &runs {
        let found = run(&robot, &plan, own);
        let [mass, deviation] = found.observer.mass().expect("a mass");
        let truth = if own.payload { MASS } else { 0.0 };
        let known = found.masses.iter().position(|[mass, deviation]| {
            1.96 * deviation < 0.05 * MASS && (mass - truth).abs() < 0.05 * MASS
        });
        let known = known.expect("a narrow interval") as f64 * f64::from(EVERY) / SAMPLING_HZ;
        println!(
            "{}: {mass:.3} ± {:.3} kg, truth {truth}; within 5 % and as narrow after {known:.2} s; changes at {:?} s",
            own.name,
            1.96 * deviation,
            found.changes
        );
        assert!((mass - truth).abs() < 0.02 * MASS, "{mass}");
        assert!(known < 1.0, "{known}");
        let payload = found.observer.payload().expect("a payload");
        if own.payload {
            assert!((payload.centre[0] - CENTRE).abs() < 0.005, "{payload:?}");
        }
        assert!(payload.mass > 0.0);
    }
}
