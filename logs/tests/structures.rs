//! Structures, arrays of structures and cell arrays of MATLAB.

mod common;
#[path = "common/drive.rs"]
mod drive;

use std::path::{Path, PathBuf};

use common::shared;
use drive::{loaded, timed};
use overact_logs::{Mapping, Time, read};

/// Files of `written/structures.py`.
fn files() -> Vec<PathBuf> {
    let names: &[&str] = if cfg!(feature = "hdf5") {
        &["structures.mat", "structures_v73.mat"]
    } else {
        &["structures.mat"]
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/written");
    names.iter().map(|name| folder.join(name)).collect()
}

fn mapping(time: &str, position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Column(time.to_owned()),
        ..timed(position, torque)
    }
}

/// Checks that columns have the positions `scale` k / 3 and the torques k / 9 - 1.
fn check(path: &Path, mapping: &Mapping, scale: f64) {
    let log = read(path, mapping, false).unwrap_or_else(|error| panic!("{error}"));
    let (positions, torques) = loaded(&log);
    assert_eq!(
        (log.samples(), log.sampling_frequency().round()),
        (12, 10.0)
    );
    for k in 0..12 {
        let exact = scale * k as f64 / 3.0;
        assert!((positions[k] - exact).abs() < 1e-12, "{}", path.display());
        assert!((torques[k] - (k as f64 / 9.0 - 1.0)).abs() < 1e-12);
    }
}

#[test]
fn matlab_structures_with_time_are_read() {
    for path in files() {
        let [values, torques] = ["out.signals(1).values(:,2)", "out.signals(2).values"];
        check(&path, &mapping("out.time", values, torques), 1.0);
        check(&path, &mapping("out.time", "q(:,2)", "tau"), 1.0);
        let sum = "2*out.signals(1).values(:,2) - out.signals(1).values(:,2)";
        check(
            &path,
            &mapping("out.time", sum, "out.signals(2).values(:,1)"),
            1.0,
        );
    }
    let cube = "out.signals(3).values(2,1,:)";
    check(&files()[0], &mapping("out.time", cube, "tau"), 1.0);
    check(
        &files()[0],
        &mapping("out(1).time", "cube(2,:)", "tau"),
        1.0,
    );
}

#[test]
fn recorder_signals_are_read_by_path_and_name() {
    for path in files() {
        check(
            &path,
            &mapping("rec.X.Data", "rec.Y(1).Data", "rec.Y(2).Data"),
            1.0,
        );
        let [position, torque] = ["\"Model Root\"/\"q\"", "\"Model Root\"/\"tau\""];
        check(&path, &mapping("rec.X.Data", position, torque), 1.0);
        let message = read(&path, &mapping("rec.X.Data", position, "same"), false);
        let message = message.expect_err("two of this name").to_string();
        assert!(
            message.contains("several signals are called `same`")
                && message.contains("`rec.Y(3).Data` or `rec.Y(4).Data`"),
            "{message}"
        );
    }
}

#[test]
fn cell_arrays_and_nested_structures_are_read() {
    for path in files() {
        check(
            &path,
            &mapping("runs{2}.t", "runs{2}.q(:,2)", "runs{2}.tau"),
            2.0,
        );
        check(
            &path,
            &mapping("runs{3}", "runs{1}.q(:,2) * 3", "runs{1}.tau"),
            3.0,
        );
    }
    let path = &files()[0];
    let [position, torque] = ["deep.a.b.c{1}.q(:,2)", "deep.a.b.c{1}.tau"];
    check(path, &mapping("out.time", position, torque), 1.0);
    let message = read(
        path,
        &mapping("out.time", "out.signals(1).values", "tau"),
        false,
    );
    let message = message.expect_err("a matrix").to_string();
    assert!(
        message.contains("`out.signals(1).values(:,1)` is the first"),
        "{message}"
    );
}

#[test]
fn a_simulink_file_is_read() {
    let Some(path) = shared("cases/logs/simulink_struct.mat") else {
        return;
    };
    let [position, torque] = [
        "logsout.signals(1).values(:,2)",
        "logsout.signals(2).values(:,1)",
    ];
    let log = read(&path, &mapping("logsout.time", position, torque), false);
    assert_eq!(
        log.unwrap_or_else(|error| panic!("{error}")).samples(),
        10_000
    );
}
