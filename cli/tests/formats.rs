//! The same log in every format gives the same estimates in `overact identify`.
//!
//! Formats that are not built in are reported with their feature.

mod common;

use common::{Bench, list, number};
use serde_json::Value;
use std::path::Path;

/// A drive that moves like the log's second joint under the torque of its first.
const DRIVE: &str = r#"
name = "Drive"
gravity = [0, 0, "-9.81 m/s^2"]

[leg.axis]

[[leg.axis.joint]]
type = "prismatic"
alpha = "90 deg"
actuated = true
parameters = ["ia", "friction"]

[[place]]
name = "axis"
shape = "axis"

[identification]
filter_cutoff = "20 Hz"
decimation = 1
"#;

/// Samples of the log, at 100 Hz.
const COUNT: u32 = 200;

/// Names of the time, position and torque columns in a file.
type Columns = [&'static str; 3];

const MATRICES: Columns = ["t", "q(:,2)", "tau(:,1)"];
const FLAT: Columns = ["t", "q2", "tau1"];

/// Files that every build reads.
const ALWAYS: [(&str, Columns); 4] = [
    ("same.mat", MATRICES),
    ("same.npz", MATRICES),
    ("same.npy", ["$1", "$3", "$6"]),
    ("same.parquet", FLAT),
];

/// Files that require a feature.
const FEATURES: [(&str, Columns, &str); 7] = [
    ("same.h5", ["run/t", "run/q(:,2)", "run/tau(:,1)"], "hdf5"),
    ("same.h5", ["run.t", "run.q(:,2)", "run.tau(:,1)"], "hdf5"),
    ("same_v73.mat", MATRICES, "hdf5"),
    ("same_lz4.mcap", STATES, "mcap"),
    ("same_zstd.mcap", STATES, "mcap"),
    ("same_plain.mcap", STATES, "mcap"),
    ("same_rosbags.mcap", STATES, "mcap"),
];

const STATES: Columns = ["time", "position.elbow", "effort.shoulder"];

/// A file written by the usual libraries.
fn written(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../logs/tests/written");
    folder.join(name).display().to_string()
}

/// A bench with the drive, for a log with these columns.
fn bench([time, position, torque]: Columns) -> Bench {
    let bench = Bench::new();
    let data = format!(
        "\n[data]\ntime = \"{time}\"\npositions = [\"{position}\"]\nposition_scale = 0.01\ntorques = [\"{torque}\"]\n"
    );
    bench.write("drive.toml", &format!("{DRIVE}{data}"));
    bench
}

/// Names, values and standard deviations of the base parameters.
fn estimates(document: &Value) -> Vec<(String, [f64; 2])> {
    let base = list(&document["estimates"]);
    let base = base.iter().find(|one| one["stage"] == "base");
    let parameters = list(&base.expect("base parameters")["parameters"]);
    let one = |one: &Value| {
        let figures = ["value", "standard_deviation"].map(|key| number(&one[key]));
        (one["name"].as_str().expect("a name").to_owned(), figures)
    };
    parameters.iter().map(one).collect()
}

/// The same samples as text.
fn text() -> String {
    let row = |k: u32| {
        let [t, q, tau] = [
            f64::from(k) / 100.0,
            f64::from(k % 13) / 3.0,
            f64::from(k % 16) / 3.0,
        ];
        format!("{t},{q},{tau}\n")
    };
    format!("t,q2,tau1\n{}", (0..COUNT).map(row).collect::<String>())
}

fn identified(log: &str, columns: Columns) -> Vec<(String, [f64; 2])> {
    estimates(&bench(columns).json(&["identify", "drive.toml", "--data", log]))
}

/// Files that this build reads.
fn readable() -> impl Iterator<Item = (&'static str, Columns)> {
    let with = FEATURES
        .into_iter()
        .filter(|(_, _, feature)| match *feature {
            "mcap" => cfg!(feature = "mcap"),
            _ => cfg!(feature = "hdf5"),
        });
    ALWAYS
        .into_iter()
        .chain(with.map(|(name, columns, _)| (name, columns)))
}

#[test]
fn every_format_gives_the_same_estimates() {
    let own = bench(FLAT);
    own.write("same.csv", &text());
    let expected = estimates(&own.json(&["identify", "drive.toml", "--data", "same.csv"]));
    assert_eq!(expected.len(), 4, "{expected:?}");
    for (name, columns) in readable() {
        let found = identified(&written(name), columns);
        assert_eq!(found.len(), expected.len(), "{name}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.0, expected.0, "{name}");
            for (found, expected) in found.1.iter().zip(expected.1) {
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-6, "{name}: {found}, as text {expected}");
            }
        }
    }
}

#[test]
fn an_unsupported_format_is_reported_with_its_feature() {
    for (name, columns, feature) in FEATURES {
        let built_in = match feature {
            "mcap" => cfg!(feature = "mcap"),
            _ => cfg!(feature = "hdf5"),
        };
        if built_in {
            continue;
        }
        let bench = bench(columns);
        let log = written(name);
        let arguments = [
            "identify",
            "drive.toml",
            "--data",
            &log,
            "--parameters",
            "p.toml",
        ];
        let output = bench.bad(&arguments);
        assert!(
            output.contains("this build of overact does not support"),
            "{output}"
        );
        assert!(
            output.contains(&format!("--features {feature}")),
            "{output}"
        );
        assert!(output.contains(name), "{output}");
        let raw = output.chars().any(|one| one.is_control() && one != '\n');
        assert!(!raw, "{output:?}");
        assert_eq!(bench.files(), ["drive.toml"]);
    }
}
