//! `identify` on the published EMPS benchmark, and with its processing of short runs.

mod common;

use common::{Bench, number, robot, shared};
use overact_tier::is_full;
use serde_json::Value;

#[test]
fn emps_logs_give_the_published_digits() {
    if !is_full() {
        return;
    }
    let (Some(data), Some(pulses)) = (
        shared("data/emps/DATA_EMPS.mat"),
        shared("data/emps/DATA_EMPS_PULSES.mat"),
    ) else {
        return;
    };
    let bench = Bench::new();
    let emps = robot("emps.toml");
    let arguments = [
        "identify",
        &emps,
        "--data",
        &data,
        "--cross-validate",
        &pulses,
    ];
    let document = bench.json(&arguments);
    // Base parameters only, by least squares and by instrumental variables from the simulated
    // robot.
    let estimates = document["estimates"].as_array().expect("a list");
    let how: Vec<&Value> = estimates.iter().map(|one| &one["estimator"]).collect();
    assert_eq!(how, ["least-squares", "instrumental-variables"]);
    let simulated = &document["errors_in_regressor"][0]["simulated"][0];
    let error = number(&simulated["torque_error_percent"]);
    assert!(
        (5.0..6.0).contains(&error),
        "published: 5.848 %, found {error}"
    );
    let estimate = &estimates[0];
    let digits = |value: &Value| format!("{:.4}", number(value));
    let expected = [
        ("m_1R", "95.1089", "0.1141"),
        ("fv_1", "203.5034", "0.5631"),
        ("fs_1", "20.3935", "0.4964"),
        ("off_1", "-3.1648", "1.4021"),
    ];
    for (at, (name, value, deviation)) in expected.iter().enumerate() {
        let parameter = &estimate["parameters"][at];
        assert_eq!(parameter["name"], *name);
        assert_eq!(digits(&parameter["value"]), *value);
        assert_eq!(
            digits(&parameter["relative_standard_deviation_percent"]),
            *deviation
        );
    }
    assert_eq!(digits(&estimate["relative_error_percent"]), "4.0834");
    assert_eq!(digits(&estimate["condition_number"]), "25.9883");
    assert_eq!(digits(&estimate["residual_norm"]), "108.7569");
    assert_eq!(digits(&estimate["residual_deviation"]), "2.1843");
    assert_eq!(
        digits(&document["cross_validation"][0]["residual_norm"]),
        "169.4876"
    );
    assert_eq!(
        digits(&document["cross_validation"][0]["relative_error_percent"]),
        "5.9824"
    );
    let text = bench.good(&arguments);
    assert!(
        text.contains(" 95.11 ") && text.contains("4.0834 %"),
        "{text}"
    );

    let asymmetric = bench.json(&[&arguments[..], &["--friction", "asymmetric"]].concat());
    let parameters = asymmetric["estimates"][0]["parameters"]
        .as_array()
        .expect("a list");
    let value =
        |name: &str| digits(&parameters.iter().find(|p| p["name"] == name).expect(name)["value"]);
    assert_eq!(value("m_1R"), "95.1540");
    assert_eq!(value("fv_pos_1"), "166.7061");
    assert_eq!(value("fs_pos_1"), "20.1440");
    assert_eq!(value("fv_neg_1"), "240.4236");
    assert_eq!(value("fs_neg_1"), "20.6277");
}

#[test]
fn kept_transients_of_the_position_filter_are_named() {
    // A run that ends in motion: the published processing keeps the filter's transient there.
    let bench = Bench::new();
    let robot = std::fs::read_to_string(robot("emps.toml")).expect("a description");
    assert!(robot.contains("skip_end = 0"));
    let short = robot.replace("duration = \"25 s\"", "duration = \"5 s\"");
    bench.write("short.toml", &short);
    bench.write(
        "trimmed.toml",
        &short.replace("skip_end = 0", "skip_end = 48"),
    );
    let verdict = |name: &str| {
        let words = bench.run(&["identify", name]).out;
        words.split_whitespace().collect::<Vec<&str>>().join(" ")
    };
    let kept = verdict("short.toml");
    assert!(kept.contains("DO NOT USE IT"), "{kept}");
    let advice = "is kept (`skip_end = 0`); set `skip_end = 48` to leave it out.";
    assert!(kept.contains(advice), "{kept}");
    assert!(!kept.contains("skip_start"), "{kept}");
    let trimmed = verdict("trimmed.toml");
    assert!(
        trimmed.contains("USE IT") && !trimmed.contains("DO NOT"),
        "{trimmed}"
    );
}
