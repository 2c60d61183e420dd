//! Messages for unusable input: location and remedy.

mod common;

use std::{fs, path::Path};

use common::{EMPS, PAIR};
use overact::Model;
use overact_identification::{
    Dataset, Error, Gain, Log, Mapping, Settings, Time, identify, motion,
};
use overact_logs::read;

/// Text of an error, without the test's folder.
fn text<T: std::fmt::Debug>(result: Result<T, Error>, folder: &Path) -> String {
    result
        .expect_err("an error")
        .to_string()
        .replace(&format!("{}/", folder.display()), "")
}

/// Reads `content` as the CSV file `log.csv` of the one-drive robot.
fn csv(content: &str) -> (Result<Log, Error>, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.csv");
    fs::write(&path, content).expect("written");
    (
        read(&path, &Mapping::for_robot(&EMPS.info()), false),
        folder,
    )
}

#[test]
fn a_valid_file_is_read() {
    let (log, _folder) =
        csv("# a comment\ntime, q_1, other, tau_1\n0,1,x,3\n0.1,2,y,4\n0.2,5,z,6\n");
    let log = log.expect("a log");
    let (positions, torques) = log.load().expect("numbers");
    assert_eq!(positions, [1.0, 2.0, 5.0]);
    assert_eq!(torques, [3.0, 4.0, 6.0]);
    assert!((log.sampling_frequency() - 10.0).abs() < 1e-12);
}

#[test]
fn implausible_values_are_reported_with_their_line() {
    let (log, folder) = csv("time,q_1,tau_1\n0,1,3\n0.1,2,1e300\n0.2,5,6\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv:3: sample 1: `tau_1` is 1e300, which is not plausible\n  help: cut the run there, or check how the log was written"
    );
}

#[test]
fn a_missing_file_is_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let mapping = Mapping::for_robot(&EMPS.info());
    for name in ["none.csv", "none.mat"] {
        let text = text(
            read(&folder.path().join(name), &mapping, false),
            folder.path(),
        );
        assert_eq!(
            text,
            format!(
                "{name}: the file can't be read: No such file or directory (os error 2)\n  help: \
                 check the path, which is relative to the folder in which the program was started"
            )
        );
    }
}

#[test]
fn all_missing_columns_are_reported() {
    let (log, folder) = csv("Time,q1,torque\n0,0,0\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv: there are no columns `time`, `q_1`, `tau_1`; the file has `Time`, `q1`, `torque`\n  \
         help: did you mean `Time` for `time`, `q1` for `q_1`?"
    );
}

#[test]
fn duplicate_columns_are_rejected() {
    let (log, folder) = csv("# comment\ntime,q_1,other,q_1,other,tau_1\n0,0,0,0,0,0\n");
    let text = text(log, folder.path());
    let expected = "log.csv: the file has 2 columns `q_1`";
    assert!(text.starts_with(expected), "{text}");
    assert!(!text.contains("`other`"), "{text}");
}

#[test]
fn invalid_cells_are_reported_by_line_and_column() {
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n0.1,abc,NaN\n0.2,1\n0.3,,2\n");
    let error = log.clone().expect_err("an error");
    assert_eq!(error.problems[0].line, Some(3));
    assert_eq!(error.problems[0].column_name(), Some("q_1"));
    assert_eq!(
        text(log, folder.path()),
        "log.csv:3: column `q_1`: `abc` is not a number\n  help: cut the log before or after this line, or fill the gap\n\
         log.csv:3: column `tau_1`: `NaN` is not a finite number\n\
         log.csv:4: column `tau_1`: the line ends before this column\n\
         log.csv:5: column `q_1`: the cell is empty"
    );
}

#[test]
fn lines_with_extra_cells_are_rejected() {
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n0.1,1,0,5\n0.2,,2,1\n0.3,1,1,\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv:3: the line has 4 columns, but the header names 3, here and in one line further down\n  help: if commas are decimal marks, separate the columns by semicolons or tabs; otherwise name every column"
    );
    // A separator at line ends is no column.
    let (log, _folder) = csv("time,q_1,tau_1\n0,0,0,\n0.1,1,0,\n0.2,2,1,\n");
    assert_eq!(log.expect("a log").samples(), 3);
    let (log, folder) = csv("# time q_1 tau_1\n0 0 0\n0.1 1 0\n0.2 2 1 7\n");
    let text = text(log, folder.path());
    assert!(
        text.starts_with("log.csv:4: the line has 4 columns, but the first one has 3"),
        "{text}"
    );
}

#[test]
fn repeated_header_lines_are_reported_once() {
    // A line of units is no error.
    let (log, _folder) = csv("time,q_1,tau_1\ns,rad,Nm\n0,0,0\n0.1,1,0\n");
    assert_eq!(log.expect("a log").samples(), 2);
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n0.1,1,0\ntime,q_1,tau_1\n0.2,2,1\n");
    let text = text(log, folder.path());
    assert!(
        text.starts_with(
            "log.csv:4: the line repeats the names of the columns: `time`, `q_1`, `tau_1`\n"
        ),
        "{text}"
    );
    assert_eq!(text.matches("log.csv").count(), 1, "{text}");
}

#[test]
fn nonuniform_time_is_located() {
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n0.1,0,0\n0.2,0,0\n0.4,0,0\n0.5,0,0\n0.6,0,0\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv:5: the time is not uniform: between samples 2 and 3 it steps by 0.200000000 s, \
         expected 0.100000000 s\n  help: set `resample = \"10 Hz\"` in [data] to interpolate at uniform times, or cut the run where samples are missing"
    );
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n0,0,0\n");
    assert!(
        text(log, folder.path()).contains("most samples have the time of the sample before them")
    );
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n1e-10,0,0\n3e-10,0,0\n");
    assert!(text(log, folder.path()).contains("it steps by 0.0000000001 s"));
}

#[test]
fn empty_files_are_errors() {
    let (log, folder) = csv("time,q_1,tau_1\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv: the run is empty\n  help: give a log with the samples of a whole motion"
    );
    let (log, folder) = csv("");
    assert_eq!(
        text(log, folder.path()),
        "log.csv: the file is empty\n  help: give a log with the samples of a whole motion"
    );
    let (log, folder) = csv("time,q_1,tau_1\n0,0,0\n");
    assert_eq!(
        text(log, folder.path()),
        "log.csv: the run has a single sample\n  help: give a log with the samples of a whole motion"
    );
}

#[test]
fn invalid_mappings_are_rejected() {
    let mapping = Mapping {
        time: Time::Column(String::from("time")),
        positions: vec![String::from("a"), String::from("b")],
        torques: vec![String::from("c")],
        velocities: Vec::new(),
        position_scale: vec![1.0, 0.0],
        position_offset: Vec::new(),
        torque_gain: vec![Gain::Value(f64::NAN)],
        resample: None,
        transmission: Vec::new(),
        rotating: Vec::new(),
    };
    let error = read(Path::new("x.csv"), &mapping, false).expect_err("an error");
    assert_eq!(error.problems.len(), 4);
    assert_eq!(
        error.problems[0].to_string(),
        "the mapping names 2 positions, but `torques` has 1 entry\n  help: give one entry per actuator"
    );
    let (_, folder) = csv("time,q_1,tau_1\n0,0,0\n");
    let mut mapping = Mapping::for_robot(&EMPS.info());
    mapping.torque_gain = vec![Gain::Variable(String::from("gtau"))];
    let log = read(&folder.path().join("log.csv"), &mapping, false);
    assert_eq!(
        text(log, folder.path()),
        "log.csv: the torque gain is the variable `gtau`, but a text has no variables\n  help: give the gain as a number"
    );
}

#[test]
fn broken_mat_files_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.mat");
    let mapping = Mapping::for_robot(&EMPS.info());
    let mut broken = b"MATLAB 5.0 MAT-file".to_vec();
    fs::write(&path, &broken).expect("written");
    assert!(
        text(read(&path, &mapping, false), folder.path())
            .starts_with("log.mat: the file is not a MATLAB v5 file: ")
    );
    broken.resize(4000, 0xff);
    fs::write(&path, &broken).expect("written");
    assert!(
        text(read(&path, &mapping, false), folder.path())
            .starts_with("log.mat: the file is not a MATLAB v5 file: ")
    );
    fs::write(&path, b"MATLAB 7.3 MAT-file, Platform: GLNXA64").expect("written");
    let output = text(read(&path, &mapping, false), folder.path());
    let expected = if cfg!(feature = "hdf5") {
        "log.mat: the HDF5 file can't be read: "
    } else {
        "log.mat: the file is of MATLAB's version 7.3, which is HDF5, which this build of overact does not support\n  help: \
         install the command with the feature `hdf5`: `cargo install --locked overact-cli --features hdf5`, or \
         `cargo run --release --features hdf5 -- …` in a clone; or save it in MATLAB with `save(..., '-v7')`"
    };
    assert!(output.starts_with(expected), "{output}");
    let Some(path) = common::shared("data/emps/DATA_EMPS.mat") else {
        return;
    };
    let mapping = Mapping {
        positions: vec![String::from("qmm")],
        torques: vec![String::from("vir(:,2)")],
        ..mapping
    };
    let text = text(
        read(&path, &mapping, false),
        path.parent().expect("a folder"),
    );
    assert!(
        text.contains("there are no variables `time`, `qmm`, `vir(:,2)`; the file has "),
        "{text}"
    );
    assert!(text.contains("`qm` for `qmm`"), "{text}");
}

fn settings() -> Settings {
    Settings::for_sampling_frequency(100.0, &PAIR.info())
}

#[test]
fn short_runs_and_runs_of_other_robots_are_rejected() {
    let log = Log::new("run 1", 100.0, 1, vec![0.0; 20], vec![0.0; 20], false).expect("a log");
    let settings = Settings {
        skip_start: 30,
        filter_cutoff_hz: 60.0,
        ..settings()
    };
    let text = text(motion(&PAIR, &log, &settings, &|_, _| {}), Path::new("-"));
    assert_eq!(
        text,
        "run 1: the run has 1 actuator, the robot `pair` has 2\n  help: map one position and one torque column to each actuator\n\
         run 1: the run has 20 samples; the filters, the decimation and the skipped samples need at least 55\n  help: record a longer run, or lower `skip_start`, `skip_end` or `decimation` of [identification]; the run lasts 0.2 s: is the time in minutes? It must be in seconds\n\
         run 1: the cutoff frequency of 60 Hz is not below half the sampling frequency, 50 Hz\n  help: is the time in milliseconds? It must be in seconds: divide the column by 1000. Else give `filter_cutoff` of [identification] about ten times the bandwidth of the motion"
    );
}

#[test]
fn samples_outside_the_workspace_are_located() {
    // The mass leaves its reach of 5 m after 1.5 s.
    let positions: Vec<f64> = (0..200)
        .flat_map(|k| {
            let x = f64::from(k) * 5.0 / 150.0 + 1e-9;
            [x, -2.0 * x]
        })
        .collect();
    let log = Log::new("run 2", 100.0, 2, positions.clone(), positions, false).expect("a log");
    let text = text(motion(&PAIR, &log, &settings(), &|_, _| {}), Path::new("-"));
    assert_eq!(
        text,
        "run 2: sample 150 (t = 1.5000 s) is outside the workspace: the pose is out of reach of leg `leg1`\n  \
         help: check the units, signs and offsets of the positions, the geometry and the home pose"
    );
}

#[test]
fn all_invalid_settings_are_reported_together() {
    let bad = Settings {
        filter_cutoff_hz: -1.0,
        filter_order: 0,
        decimation: 0,
        r_sigma: 1.0,
        kept_actuators: vec![0, 7],
        ..settings()
    };
    let error = bad.check(&PAIR.info()).expect_err("problems");
    assert_eq!(error.problems.len(), 5);
    assert_eq!(
        error.problems[4].to_string(),
        "the kept actuators [0, 7] are not a choice of 1 among the 2 actuators\n  help: the choice consists of different indices from 0 to 1"
    );
}

#[test]
fn invalid_experiments_are_rejected() {
    let run = |experiment: &[Log], model: &dyn Model| {
        let dataset = Dataset {
            runs: experiment,
            validation: &[],
            true_values: None,
            variants: &[],
            scales: None,
        };
        identify(model, &dataset, &settings(), &|_| {})
            .expect_err("an error")
            .to_string()
    };
    assert_eq!(
        run(&[], &PAIR),
        "there is no training run\n  help: give at least one log with --data, or runs in [[experiment.run]]"
    );
    let loaded = Log::new("run 3", 100.0, 1, vec![0.0; 200], vec![0.0; 200], true).expect("a log");
    assert_eq!(
        run(&[loaded], &EMPS),
        "run 3: the run carries a payload, but the description of `emps` has none\n  help: describe the payload in [platform.payload], or declare the run unloaded"
    );
    let still = Log::new("run 4", 100.0, 2, vec![0.0; 400], vec![0.0; 400], false).expect("a log");
    let dataset = Dataset {
        runs: &[still],
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    // At rest only the offset has a column, and it explains zero torques.
    let result = identify(&PAIR, &dataset, &settings(), &|_| {}).expect("an estimate");
    assert!(result.warnings.iter().any(|warning| warning
        == "platform projection: `m_platformR` is not identifiable: its column is zero on these data"));
}
