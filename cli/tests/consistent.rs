//! Physically consistent parameters: written by `identify`, read by `simulate` and `evaluate`.

mod common;

use common::{Bench, number};
use serde_json::{Value, json};

/// Identification of a shortened five-bar robot.
fn bench() -> (Bench, Value) {
    let bench = Bench::with("point-2rr", |text| {
        let short = text.replacen("duration = \"10 s\"", "duration = \"2 s\"", 1);
        assert_ne!(short, text);
        short
    });
    let document = bench.json(&["identify", "my.toml", "--parameters", "parameters.toml"]);
    (bench, document)
}

#[test]
fn consistent_parameters_are_used_for_control_and_simulation() {
    let (bench, document) = bench();
    let consistent = &document["consistent"][0];
    let error = |key: &str| number(&consistent[key]);
    let (own, base) = (
        error("relative_error_percent"),
        error("base_relative_error_percent"),
    );
    assert!(own >= base && own < 1.05 * base, "{own} {base}");
    for body in consistent["bodies"].as_array().expect("bodies") {
        assert!(number(&body["definiteness"]) > 0.0, "{body}");
    }
    let parameters = consistent["parameters"].as_array().expect("parameters");
    for one in parameters {
        let name = one["name"].as_str().expect("a name");
        let is_positive = ["m_", "ia_", "fv_", "fs_"]
            .iter()
            .any(|symbol| name.starts_with(symbol));
        assert!(!is_positive || number(&one["value"]) > 0.0, "{one}");
    }
    // The file gives the same torques as its numbers as inputs.
    let pose: Vec<f64> = vec![0.05, 0.3];
    let state = json!({ "pose": pose, "twist": [0.1, 0.2], "acceleration": [1.0, -2.0] });
    bench.write("states.json", &json!([state]).to_string());
    let ask = |more: &[&str]| {
        let start = ["evaluate", "my.toml", "inverse_dynamics", "--states"];
        bench.json(&[&start[..], more].concat())["results"].clone()
    };
    let read = ask(&["states.json", "--parameters", "parameters.toml"]);
    let values: Vec<f64> = parameters.iter().map(|one| number(&one["value"])).collect();
    let mut explicit = state.clone();
    explicit["parameters"] = json!(values);
    bench.write("explicit.json", &json!([explicit]).to_string());
    assert_eq!(read, ask(&["explicit.json"]));
    // A robot with these parameters can be simulated.
    let run = [
        "simulate",
        "my.toml",
        "-o",
        "logs/",
        "--parameters",
        "parameters.toml",
    ];
    bench.good(&run);
}

#[test]
fn parameter_files_of_other_robots_are_rejected() {
    let (bench, _) = bench();
    let text = bench.read("parameters.toml");
    let output = |text: &str| {
        bench.write("other.toml", text);
        let run = bench.run(&[
            "simulate",
            "my.toml",
            "-o",
            "logs/",
            "--parameters",
            "other.toml",
        ]);
        assert_eq!(run.code, Some(1));
        run.err
    };
    let shortened: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("fv_"))
        .collect();
    assert!(output(&shortened.join("\n")).contains("missing parameters: fv_"));
    assert!(
        output(&format!("{text}nonsense = 1\n")).contains("the robot has no parameter `nonsense`")
    );
    // Inconsistent estimates cause a warning with line, and the command continues as far as
    // possible.
    let place = text.lines().position(|line| line.starts_with("fv_"));
    let place = place.expect("viscous friction");
    let symbol = |line: &str| line.split('=').next().unwrap_or_default().to_owned();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[place] = symbol(&lines[place]) + "= -1.5";
    bench.write("negative.toml", &lines.join("\n"));
    let wanted = format!("warning: negative.toml:{}: `fv_", place + 1);
    let generated = ["generate", "my.toml", "--effort", "none", "-o", "my.rs"];
    let read = [&generated[..], &["--parameters", "negative.toml"]].concat();
    let failed = bench.run(&read);
    assert_eq!(failed.code, Some(0), "{}", failed.err);
    assert!(
        failed.err.contains(&wanted) && failed.err.contains("= -1.5 is negative"),
        "{}",
        failed.err
    );
    let outputs = bench.run(&["identify", "my.toml", "--parameters", "my.toml"]);
    assert_eq!(outputs.code, Some(2), "{}", outputs.err);
    assert!(outputs.err.contains("my.toml"));
}
