//! Measured velocities instead of differences of the positions.

mod common;

use std::{fmt::Write as _, fs};

use common::EMPS;
use overact::Model;
use overact_identification::{Log, Mapping, Settings, Time, motion};
use overact_logs::read;

const FREQUENCY: f64 = 500.0;

/// Position (deg), velocity (deg/s) and force at a sample.
///
/// The velocity is not that of the position, to show which one is used.
fn sample(k: usize) -> [f64; 3] {
    let t = k as f64 / FREQUENCY;
    [t.sin(), 3.0 * (2.0 * t).cos(), t]
}

fn mapping(velocities: &[&str]) -> Mapping {
    Mapping {
        time: Time::Frequency(FREQUENCY),
        positions: vec![String::from("$1")],
        torques: vec![String::from("$3")],
        velocities: velocities.iter().map(|&name| name.to_owned()).collect(),
        position_scale: vec![1_f64.to_radians()],
        ..Mapping::for_robot(&EMPS.info())
    }
}

/// A log of this number of samples.
fn log(samples: usize, velocities: &[&str]) -> (Log, tempfile::TempDir) {
    let mut text = String::new();
    for k in 0..samples {
        let [position, velocity, force] = sample(k);
        let _ = writeln!(text, "{position} {velocity} {force}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.txt");
    fs::write(&path, text).expect("written");
    let log = read(&path, &mapping(velocities), false).unwrap_or_else(|error| panic!("{error}"));
    (log, folder)
}

#[test]
fn measured_velocities_are_filtered_and_differentiated() {
    let settings = Settings::for_bandwidth(5.0, FREQUENCY, &EMPS.info()).trimmed(FREQUENCY);
    // The second one stays in its file.
    for samples in [20_000, 530_000] {
        let (log, _folder) = log(samples, &["$2"]);
        assert_eq!(
            (log.has_velocities(), log.in_memory()),
            (true, samples < 100_000)
        );
        let motion = motion(&EMPS, &log, &settings, &|_, _| {}).expect("a motion");
        assert_eq!(motion.velocities.len(), motion.samples);
        for index in (0..motion.samples).step_by(997) {
            let t = motion.time(index);
            let velocity = 3.0_f64.to_radians() * (2.0 * t).cos();
            let acceleration = -6.0_f64.to_radians() * (2.0 * t).sin();
            assert!(
                (motion.pose[index] - t.sin().to_radians()).abs() < 1e-5,
                "{t}"
            );
            assert!((motion.twist[index] - velocity).abs() < 1e-5, "{t}");
            assert!(
                (motion.acceleration[index] - acceleration).abs() < 1e-4,
                "{t}"
            );
        }
    }
}

#[test]
fn without_velocities_positions_are_differentiated() {
    let settings = Settings::for_bandwidth(5.0, FREQUENCY, &EMPS.info()).trimmed(FREQUENCY);
    let (log, _folder) = log(20_000, &[]);
    assert!(!log.has_velocities());
    let motion = motion(&EMPS, &log, &settings, &|_, _| {}).expect("a motion");
    let t = motion.time(5000);
    assert!((motion.twist[5000] - t.cos().to_radians()).abs() < 1e-5);
    let beginning = log.beginning(100).expect("a beginning");
    assert!(!beginning.has_velocities());
}

#[test]
fn a_part_of_a_run_keeps_measured_velocities() {
    let (log, _folder) = log(20_000, &["2*$2/2"]);
    let beginning = log.beginning(100).expect("a beginning");
    assert!(beginning.has_velocities());
    let mut reader = beginning.reader().expect("a reader");
    let block = reader.next().expect("a block").expect("samples");
    assert_eq!(block.velocities.len(), 100);
    assert_eq!(block.velocities[7], sample(7)[1] * 1_f64.to_radians());
}

#[test]
fn every_actuator_needs_a_velocity_column() {
    let error = mapping(&["$2", "$3"]).check().expect_err("an error");
    assert_eq!(
        error.to_string(),
        "the mapping names 1 positions, but `velocities` has 2 entries\n  help: give one entry per actuator, or none"
    );
}
