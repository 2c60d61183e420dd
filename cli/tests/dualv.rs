//! The paper's robot from the command line.
//!
//! Tests cover logs of the virtual experiment, the nine parameters of Table 2 in both projections,
//! and Tables 2 to 4 with published values. They also cover a trajectory that crosses a singularity
//! of the kept actuators.

mod common;

use common::{Bench, NINE, list, number, robot};
use overact_tier::by_tier;
use serde_json::Value;
use std::fs;

/// Description with runs of a duration, changed by `edit`.
fn described(duration: &str, edit: impl Fn(String) -> String) -> Bench {
    let text = fs::read_to_string(robot("dualv.toml")).expect("the description");
    let text = text.replace("10 s", duration);
    let bench = Bench::new();
    bench.write("my.toml", &edit(text));
    bench
}

/// Description with half the sampling frequency and as many equations.
fn sampled_half_as_often(text: &str) -> String {
    text.replace("\"5 kHz\"", "\"2.5 kHz\"")
        .replace("decimation = 50", "decimation = 25")
}

/// Essential estimates of both projections.
fn essential(document: &Value) -> Vec<&Value> {
    let estimates = list(&document["estimates"]).iter();
    estimates
        .filter(|estimate| estimate["stage"] == "essential")
        .collect()
}

#[test]
fn dualv_logs_reproduce_the_parameters_and_tables_of_the_paper() {
    let bench = described(by_tier(["1.5 s", "4 s"]), |text| {
        by_tier([sampled_half_as_often(&text), text])
    });
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let published = robot("published/dualv.toml");
    let arguments = [
        "identify",
        "my.toml",
        "--data",
        "log_unloaded_1.csv",
        "log_unloaded_2.csv",
        "--payload-data",
        "log_loaded_1.csv",
        "log_loaded_2.csv",
        "--cross-validate",
        "log_trajectory_1.csv",
        "--cross-validate-payload",
        "log_trajectory_2.csv",
        "--tracking",
        "--tables",
        "--published",
        published.as_str(),
        "--report",
        "report.json",
    ];
    let text = bench.good(&arguments);
    let document: Value = serde_json::from_str(&bench.read("report.json")).expect("JSON");
    let cases = essential(&document);
    assert_eq!(cases.len(), 2);
    for case in cases {
        let model = case["model"].as_str().expect("a name");
        let parameters = list(&case["parameters"]);
        let names: Vec<&str> = parameters
            .iter()
            .filter_map(|parameter| parameter["name"].as_str())
            .collect();
        assert_eq!(names, NINE.map(|(name, _)| name), "{model}");
        for (parameter, (name, truth)) in parameters.iter().zip(NINE) {
            let error = 100.0 * (number(&parameter["value"]) / truth - 1.0).abs();
            assert!(error < 2.0, "{model} {name}: {error} %");
        }
        if model == "actuators" {
            let worst = number(&case["partition"]["largest"]);
            assert!(worst < 30.0, "{worst}");
        }
    }
    for verdict in list(&document["verdicts"]) {
        assert_eq!(verdict["grade"], "use", "{verdict}");
    }
    // Table 3 also contains the torques of eq. (26), which differ from the least-norm ones.
    for one in list(&document["cross_validation"]) {
        for entry in list(&one["table"]) {
            let (least, closure) = (&entry["least_norm_percent"], &entry["closure_percent"]);
            assert!(number(closure) != number(least), "{entry}");
        }
    }
    assert_tables(&text);
}

/// Tables 2 to 4, each with a number of the paper in its line.
fn assert_tables(text: &str) {
    let titles = [
        "Parameters, compared with",
        "Torque errors in percent of the torques, compared with",
        "Largest tracking errors in 1e-3 m or rad, compared with",
    ];
    for title in titles {
        assert!(text.contains(title), "{title} is not in\n{text}");
    }
    let line = |start: &str, number: &str| {
        let mut lines = text.lines();
        let found = lines.any(|line| line.starts_with(start) && line.contains(number));
        assert!(found, "{start} {number} in\n{text}");
    };
    line(
        "log_trajectory_1.csv  platform projection, eq. (26), published",
        "9.1",
    );
    line("m_payload", "5.42");
    line("zz_1_leg4R", "0.0507");
    for controller in [
        "computed torque, platform projection",
        "computed torque, actuator projection",
    ] {
        assert!(text.contains(controller), "{controller}");
    }
}

/// Runs through (-0.10, 0.16) m, -6.06 degrees, where rows 1 to 3 of J_p^inv are dependent though
/// the robot is regular.
fn crossing(text: String) -> String {
    let (before, _) = text.split_once("[[experiment.run]]").expect("runs");
    let run = |name: &str, payload: bool, turn: f64| {
        format!(
            r#"[[experiment.run]]
name = "{name}"
payload = {payload}
fundamental = "1.0 Hz"
terms = [
    {{ coordinate = "x", harmonic = 1, amplitude = "105 mm", phase = "{} deg" }},
    {{ coordinate = "x", harmonic = 3, amplitude = "12 mm", phase = "{} deg" }},
    {{ coordinate = "y", harmonic = 1, amplitude = "165 mm", phase = "{turn} deg" }},
    {{ coordinate = "y", harmonic = 4, amplitude = "8 mm", phase = "{turn} deg" }},
    {{ coordinate = "phi", harmonic = 2, amplitude = "9 deg", phase = "{} deg" }},
    {{ coordinate = "phi", harmonic = 5, amplitude = "7 deg", phase = "{turn} deg" }},
]
"#,
            180.0 + turn,
            40.0 - turn,
            2.0 * turn - 30.0
        )
    };
    let runs = [
        ("one", false, 10.0),
        ("two", false, 75.0),
        ("three", true, -20.0),
        ("four", true, 130.0),
    ];
    let runs = runs.map(|(name, payload, turn)| run(name, payload, turn));
    format!("{before}{}", runs.concat())
}

#[test]
fn a_crossed_singularity_of_the_kept_actuators_is_reported() {
    let bench = described(by_tier(["1.5 s", "3 s"]), crossing);
    let document = bench.json(&["identify", "my.toml"]);
    let verdict = |subject: &str| {
        let mut verdicts = list(&document["verdicts"]).iter();
        let found = verdicts.find(|verdict| verdict["subject"] == subject);
        found.unwrap_or_else(|| panic!("no verdict on {subject}"))
    };
    assert_eq!(verdict("actuator projection")["grade"], "no");
    let reasons = verdict("actuator projection")["reasons"].to_string();
    assert!(
        reasons.contains("crosses a singularity of the kept actuators"),
        "{reasons}"
    );
    // Its error is the smaller one although its parameters are wrong; the report must explain that.
    let cases = essential(&document);
    let error = |case: usize| number(&cases[case]["relative_error_percent"]);
    assert!(error(1) < error(0), "{} {}", error(0), error(1));
    let worst = |case: usize| {
        let parameters = list(&cases[case]["parameters"]).iter();
        let known = parameters.filter(|one| NINE.iter().any(|(name, _)| one["name"] == *name));
        let misses = known.map(|one| number(&one["error_percent"]).abs());
        misses.fold(0.0, f64::max)
    };
    assert!(
        worst(0) < 2.0 && worst(1) > 10.0,
        "{} {}",
        worst(0),
        worst(1)
    );
    assert!(reasons.contains("outweigh all others"), "{reasons}");
    let output = |before: &str| -> f64 {
        let (_, rest) = reasons.split_once(before).expect(before);
        let (percent, _) = rest.split_once(" %").expect("percent");
        percent.parse().expect("a number")
    };
    // To three digits.
    assert!((output("its relative error of ") / error(1) - 1.0).abs() < 5e-3);
    assert!((output("is lower than the ") / error(0) - 1.0).abs() < 5e-3);
}
