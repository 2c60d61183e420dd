//! The same log in every format gives the same numbers.
//!
//! The files were written by NumPy, SciPy, PyArrow, h5py, mcap and rosbags (`written/same_log.py`),
//! and are written again if Python has these libraries.

mod common;
#[path = "../../logs/tests/common/drive.rs"]
mod drive;

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use common::EMPS;
use overact::Model;
use overact_identification::{Dataset, Gain, Log, Mapping, Settings, Time, identify};
use overact_logs::read;

/// Two joints, with velocities.
fn mapping(time: &str, [positions, velocities, torques]: [[&str; 2]; 3]) -> Mapping {
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    Mapping {
        time: Time::Column(time.to_owned()),
        positions: names(positions),
        torques: names(torques),
        velocities: names(velocities),
        position_scale: vec![1.0; 2],
        torque_gain: vec![Gain::Value(1.0); 2],
        ..Mapping::for_robot(&EMPS.info())
    }
}

fn matrices(prefix: &str) -> Mapping {
    let names =
        ["q", "dq", "tau"].map(|name| [1, 2].map(|column| format!("{prefix}{name}(:,{column})")));
    let names = names
        .each_ref()
        .map(|two| two.each_ref().map(String::as_str));
    mapping(&format!("{prefix}t"), names)
}

/// The files of every supported format, with the names of their columns.
fn files() -> Vec<(&'static str, Mapping)> {
    let flat = [["q1", "q2"], ["dq1", "dq2"], ["tau1", "tau2"]];
    let numbered = [["$2", "$3"], ["$4", "$5"], ["$6", "$7"]];
    let mut files = vec![
        ("same.npy", mapping("$1", numbered)),
        ("same.npz", matrices("")),
        ("same.mat", matrices("")),
        ("same.parquet", mapping("t", flat)),
    ];
    if cfg!(feature = "hdf5") {
        files.push(("same.h5", matrices("run.")));
        files.push(("same.h5", matrices("/run/")));
        files.push(("same_v73.mat", matrices("")));
        let mut inside = matrices("");
        inside.positions = ["data.q(:,1)", "gain/2*data.q(:,2)"]
            .map(String::from)
            .to_vec();
        inside.torque_gain[0] = Gain::Variable(String::from("gain"));
        inside.torques[0] = String::from("tau(:,1)/2");
        files.push(("same_v73.mat", inside));
    }
    if cfg!(feature = "mcap") {
        let joints = |topics: [&str; 3]| {
            let lists = ["position", "velocity", "effort"];
            let mut names = [const { [const { String::new() }; 2] }; 3];
            for ((names, topic), list) in names.iter_mut().zip(topics).zip(lists) {
                *names = ["shoulder", "elbow"].map(|joint| format!("{topic}{list}.{joint}"));
            }
            names
        };
        let called = |time: &str, topics| {
            let names = joints(topics);
            mapping(
                time,
                names
                    .each_ref()
                    .map(|two| two.each_ref().map(String::as_str)),
            )
        };
        for name in [
            "same_lz4.mcap",
            "same_rosbags.mcap",
            "same_zstd.mcap",
            "same_plain.mcap",
        ] {
            files.push((name, called("time", [""; 3])));
            files.push((name, called("log_time", [""; 3])));
        }
        let topics = ["/joint_states.", "/joint_states.", "/torques."];
        files.push(("same_zstd.mcap", called("time", topics)));
    }
    files
}

fn assert_expected_log(log: &Log, name: &str) {
    let mut reader = log
        .reader()
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let block = reader.next().expect("a block").expect("samples");
    assert_eq!((log.samples(), log.note()), (200, None), "{name}");
    assert!((log.sampling_frequency() - 100.0).abs() < 1e-6, "{name}");
    for k in 0..200_u32 {
        let at = |numbers: &[f64]| [numbers[2 * k as usize], numbers[2 * k as usize + 1]];
        let number = f64::from(k);
        let position = [number * number / 7.0, f64::from(k % 13) / 3.0];
        let velocity = [number / 9.0, f64::from(k % 5) / 11.0];
        let effort = [f64::from(k % 16) / 3.0, -number / 17.0];
        assert_eq!(at(&block.positions), position, "{name}, sample {k}");
        assert_eq!(at(&block.velocities), velocity, "{name}, sample {k}");
        assert_eq!(at(&block.torques), effort, "{name}, sample {k}");
    }
}

fn assert_all_formats_equal(folder: &Path) {
    for (name, mapping) in files() {
        let log = read(&folder.join(name), &mapping, false);
        assert_expected_log(&log.unwrap_or_else(|error| panic!("{error}")), name);
    }
}

/// Estimates and residual of a drive with the second joint's motion and the first one's torque.
fn estimated(path: &Path, mapping: &Mapping) -> Vec<f64> {
    let own = Mapping {
        positions: mapping.positions[1..].to_vec(),
        torques: mapping.torques[..1].to_vec(),
        torque_gain: mapping.torque_gain[..1].to_vec(),
        position_scale: vec![0.01],
        velocities: Vec::new(),
        ..mapping.clone()
    };
    let run = read(path, &own, false).unwrap_or_else(|error| panic!("{error}"));
    let mut settings = Settings::for_bandwidth(1.0, 100.0, &EMPS.info());
    (settings.decimation, settings.filter_cutoff_hz) = (1, 20.0);
    let dataset = Dataset {
        runs: &[run],
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    let result = identify(&EMPS, &dataset, &settings, &|_| {});
    let result = result.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let first = result.estimates.first().expect("an estimate");
    let parameters = first.parameters.iter();
    let values = parameters.flat_map(|one| [one.value, one.standard_deviation]);
    values.collect()
}

/// The same samples as text.
fn text(path: &Path) {
    let rows = (0..200_u32).map(|k| {
        let number = f64::from(k);
        let [t, q, tau] = [
            number / 100.0,
            f64::from(k % 13) / 3.0,
            f64::from(k % 16) / 3.0,
        ];
        format!("{t},{q},{tau}\n")
    });
    let rows: String = rows.collect();
    std::fs::write(path, format!("t,q2,tau1\n{rows}")).expect("written");
}

#[test]
fn every_format_gives_the_same_estimates() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("same.csv");
    text(&path);
    let flat = [["q1", "q2"], ["dq1", "dq2"], ["tau1", "tau2"]];
    let expected = estimated(&path, &mapping("t", flat));
    assert!(expected.len() >= 6, "{expected:?}");
    for (name, mapping) in files() {
        let own = estimated(&kept().join(name), &mapping);
        assert_eq!(own.len(), expected.len(), "{name}");
        for (own, expected) in own.iter().zip(&expected) {
            let off = (own / expected - 1.0).abs();
            assert!(off < 1e-6, "{name}: {own}, as text {expected}");
        }
    }
}

fn kept() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../logs/tests/written")
}

#[test]
fn every_format_gives_the_same_numbers() {
    assert_all_formats_equal(&kept());
}

#[test]
fn newly_written_files_of_every_format_give_the_same_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let python = std::env::var("OVERACT_PYTHON").unwrap_or_else(|_| String::from("python3"));
    let output = Command::new(python)
        .arg(kept().join("same_log.py"))
        .arg(folder.path())
        .output();
    let Ok(output) = output else {
        eprintln!("skipped: there is no Python here");
        return;
    };
    let shown_output = String::from_utf8_lossy(&output.stderr);
    if shown_output.contains("ModuleNotFoundError") {
        eprintln!(
            "skipped: {}",
            shown_output.lines().last().unwrap_or_default()
        );
        return;
    }
    assert!(output.status.success(), "{shown_output}");
    assert_all_formats_equal(folder.path());
}

#[cfg(not(feature = "mcap"))]
#[test]
fn unsupported_formats_are_reported_with_their_feature() {
    for (name, feature) in [
        ("same_lz4.mcap", "mcap"),
        ("same.h5", "hdf5"),
        ("same_v73.mat", "hdf5"),
    ] {
        if feature == "hdf5" && cfg!(feature = "hdf5") {
            continue;
        }
        let shown_output = read(&kept().join(name), &matrices(""), false).expect_err(name);
        let shown_output = shown_output.to_string();
        assert!(
            shown_output.contains("which this build of overact does not support"),
            "{shown_output}"
        );
        assert!(
            shown_output.contains(&format!("--features {feature}")),
            "{shown_output}"
        );
    }
}
