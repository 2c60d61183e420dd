//! Virtual experiments of a DualV whose legs have rotor inertia only.
//!
//! They use the nine parameters of Table 2, friction at the motors, and the trajectories of
//! `robots/dualv.toml`.
#![allow(dead_code, reason = "each test file uses its part")]

#[path = "../../../simulation/tests/support/mod.rs"]
mod support;

use std::collections::BTreeMap;

use overact::{
    Error, Function, Info, Model, SampleError,
    forward::{Measured, Workspace, gauss_newton},
};
use overact_identification::{Log, Settings};
use overact_simulation::{Experiment, Record, Run, Term, Trajectory, simulate};
use support::{Robot, mechanisms};

/// The robot, with forward kinematics.
pub(crate) struct DualV(Robot<mechanisms::DualV>);

impl DualV {
    pub(crate) fn new() -> Self {
        Self(Robot::new(mechanisms::DualV))
    }
}

impl Model for DualV {
    fn info(&self) -> Info<'_> {
        self.0.info()
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        if function != Function::JointVelocities {
            return self.0.evaluate(function, inputs, output);
        }
        // The joints are the motors: q̇ = J v.
        for (sample, rates) in output.chunks_exact_mut(4).enumerate() {
            let mut jacobian = [0.0; 12];
            let pose = &inputs[0][3 * sample..3 * sample + 3];
            self.0
                .evaluate(Function::InverseJacobian, &[pose], &mut jacobian)
                .map_err(|error| SampleError { sample, ..error })?;
            let twist = &inputs[1][3 * sample..3 * sample + 3];
            for (rate, row) in rates.iter_mut().zip(jacobian.chunks_exact(3)) {
                *rate = row.iter().zip(twist).map(|(j, v)| j * v).sum();
            }
        }
        Ok(())
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let mut found = pose.to_vec();
        gauss_newton(
            Measured {
                positions: actuators,
                is_revolute: &[true; 4],
            },
            &mut found,
            Workspace {
                actuators: &mut [0.0; 4],
                inverse_jacobian: &mut [0.0; 12],
                normal: &mut [0.0; 9],
                step: &mut [0.0; 3],
            },
            |pose, reached, jacobian| {
                self.evaluate(Function::ActuatorPositions, &[pose], reached)
                    .and_then(|()| self.evaluate(Function::InverseJacobian, &[pose], jacobian))
                    .map_err(|error| error.error)
            },
            |pose, step| pose.iter_mut().zip(step).for_each(|(x, s)| *x += s),
        )?;
        pose.copy_from_slice(&found);
        Ok(())
    }
}

/// True values by name: Table 2, case 1, and friction.
pub(crate) fn truth() -> BTreeMap<String, f64> {
    let mut truth: BTreeMap<String, f64> = [
        ("ia_1_leg1", 0.0445),
        ("ia_1_leg2", 0.0481),
        ("ia_1_leg3", 0.0481),
        ("ia_1_leg4", 0.0507),
        ("zz_platform", 0.0206),
        ("m_platform", 1.92),
        ("mx_platform", 0.0),
        ("my_platform", 0.0),
        ("zz_payload", 0.0161),
        ("mx_payload", -0.127),
        ("my_payload", 0.0),
        ("m_payload", 5.42),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into();
    for (leg, (fv, fs)) in [(0.03, 0.12), (0.02, 0.10), (0.04, 0.15), (0.03, 0.11)]
        .into_iter()
        .enumerate()
    {
        truth.insert(format!("fv_1_leg{}", leg + 1), fv);
        truth.insert(format!("fs_1_leg{}", leg + 1), fs);
    }
    truth
}

/// An angle or a length in a description's format, in SI units.
fn quantity(text: &str) -> f64 {
    let (number, unit) = text.split_once(' ').expect("a unit");
    let factor = match unit {
        "mm" => 1e-3,
        "deg" => 1_f64.to_radians(),
        _ => 1.0,
    };
    number.parse::<f64>().expect("a number") * factor
}

/// The runs of `robots/dualv.toml`; rotations are scaled by `rotation`.
pub(crate) fn runs(rotation: f64) -> Vec<Run> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/dualv.toml");
    let text = std::fs::read_to_string(path).expect("the description");
    let table: toml::Table = text.parse().expect("TOML");
    let runs = table["experiment"]["run"].as_array().expect("runs");
    runs.iter()
        .map(|run| {
            let text = |value: &toml::Value| value.as_str().expect("text").to_owned();
            let terms = run["terms"].as_array().expect("terms").iter().map(|term| {
                let coordinate = text(&term["coordinate"]);
                let scale = if coordinate == "phi" { rotation } else { 1.0 };
                Term {
                    harmonic: term["harmonic"].as_integer().expect("a number") as u32,
                    amplitude: scale * quantity(&text(&term["amplitude"])),
                    phase_rad: quantity(&text(&term["phase"])),
                    coordinate,
                }
            });
            Run {
                name: text(&run["name"]),
                payload: run
                    .get("payload")
                    .is_some_and(|p| p.as_bool() == Some(true)),
                duration_s: None,
                trajectory: Trajectory::Periodic {
                    fundamental_hz: quantity(&text(&run["fundamental"])),
                    terms: terms.collect(),
                },
            }
        })
        .collect()
}

/// The experiment of these runs at 1 kHz.
pub(crate) fn experiment(robot: &DualV, rotation: f64, seed: u64) -> Experiment {
    let info = robot.info();
    let truth = truth();
    let all = info.parameters.iter().chain(info.payload_parameters);
    Experiment {
        sampling_hz: 1000.0,
        duration_s: 6.0,
        parameters: all.map(|parameter| truth[parameter.name]).collect(),
        encoder_resolution: vec![1e-5; 4],
        torque_noise: vec![0.1; 4],
        seed,
        runs: runs(rotation),
        ..Experiment::default()
    }
}

/// Usual settings for motion up to 10 Hz.
pub(crate) fn settings(robot: &DualV) -> Settings {
    Settings {
        filter_cutoff_hz: 100.0,
        decimation: 10,
        ..Settings::for_bandwidth(10.0, 1000.0, &robot.info())
    }
}

/// Simulates the experiment.
pub(crate) fn records(robot: &DualV, experiment: &Experiment) -> Vec<Record> {
    simulate(robot, experiment, &|_, _| {}).unwrap_or_else(|error| panic!("{error}"))
}

/// A record as a run; `change` may alter positions and torques, samples × 4 each.
pub(crate) fn log(record: Record, change: impl FnOnce(&mut Vec<f64>, &mut Vec<f64>)) -> Log {
    let (mut positions, mut torques) = (record.positions, record.torques);
    change(&mut positions, &mut torques);
    Log::new(
        record.name,
        record.sampling_hz,
        4,
        positions,
        torques,
        record.payload,
    )
    .expect("a run")
}

/// All records as runs.
pub(crate) fn logs(records: Vec<Record>) -> Vec<Log> {
    records
        .into_iter()
        .map(|record| log(record, |_, _| {}))
        .collect()
}
