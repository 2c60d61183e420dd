//! Runs of one drive in files of any format.
#![allow(dead_code, reason = "each test file uses its part")]

use std::{fs, path::Path};

use overact::{Info, Sizes};
use overact_logs::read;
use overact_logs::{Error, Log, Mapping, Time};

/// A robot of one prismatic joint.
pub(crate) const fn info() -> Info<'static> {
    Info {
        name: "drive",
        sizes: Sizes {
            pose: 1,
            dof: 1,
            actuators: 1,
            joints: 1,
            parameters: 0,
            base_parameters: 0,
            payload_parameters: 0,
        },
        legs: &["1"],
        actuators: &["1"],
        actuated_joints: &[0],
        actuator_is_revolute: &[false],
        coordinates: &["x"],
        parameters: &[],
        payload_parameters: &[],
        home_pose: &[0.0],
        home_joints: &[0.0],
        kept_actuators: &[0],
    }
}

/// A mapping of one drive with time in `t`.
pub(crate) fn timed(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Column(String::from("t")),
        positions: vec![position.to_owned()],
        torques: vec![torque.to_owned()],
        ..Mapping::for_robot(&info())
    }
}

/// The same at 10 Hz.
pub(crate) fn untimed(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Frequency(10.0),
        ..timed(position, torque)
    }
}

/// Reads the run `name` of these files.
pub(crate) fn run(name: &str, files: &[(&str, &[u8])], mapping: &Mapping) -> Result<Log, String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, content) in files {
        fs::write(folder.path().join(name), content).expect("written");
    }
    let prefix = format!("{}/", folder.path().display());
    let path = name.split('+').map(|part| format!("{prefix}{part}"));
    let path = path.collect::<Vec<_>>().join("+");
    let log = read(Path::new(&path), mapping, false);
    log.map_err(|error: Error| error.to_string().replace(&prefix, ""))
}

/// Reads `q` of one file and `tau` of another one.
pub(crate) fn joined(first: (&str, &[u8]), second: (&str, &[u8])) -> Result<Log, String> {
    let name = format!("{}+{}", first.0, second.0);
    let log = run(&name, &[first, second], &timed("q", "tau"))?;
    // The folder is deleted, so the log must be in memory.
    assert!(log.in_memory());
    Ok(log)
}

/// Positions and torques.
pub(crate) fn loaded(log: &Log) -> (Vec<f64>, Vec<f64>) {
    log.load().unwrap_or_else(|error| panic!("{error}"))
}

/// Positions, torques and the sampling frequency.
pub(crate) fn numbers(log: Result<Log, String>) -> (Vec<f64>, Vec<f64>, f64) {
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    let (positions, torques) = loaded(&log);
    (positions, torques, log.sampling_frequency())
}
