//! `simulate` and `identify`: virtual experiments and logs.

mod common;

use common::{Bench, number};
use overact_tier::by_tier;
use serde_json::Value;

/// The serial robot with a shorter experiment.
fn serial() -> Bench {
    Bench::with("serial-2r", |text| {
        text.replace("duration = \"10 s\"", "duration = \"5 s\"")
    })
}

#[test]
fn strict_identification_fails_for_unusable_results() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let log = bench.read("log_identification.csv");
    bench.write(
        "swapped.csv",
        &log.replacen("tau_1,tau_2", "tau_2,tau_1", 1),
    );
    let identify = |log: &str| bench.run(&["identify", "my.toml", "--data", log, "--strict"]);
    assert_eq!(identify("log_identification.csv").code, Some(0));
    let refused = identify("swapped.csv");
    assert_eq!(refused.code, Some(3), "{}", refused.err);
    assert!(refused.err.contains("not to be used"), "{}", refused.err);
    assert!(
        refused.out.to_lowercase().contains("do not use it"),
        "the result is written"
    );
}

#[test]
fn basic_checks_keep_estimates_and_skip_fault_hypotheses() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let identify = |scope: &str| -> Value {
        let log = "log_identification.csv";
        bench.json(&["identify", "my.toml", "--data", log, "--checks", scope])
    };
    let (all, basic) = (identify("all"), identify("basic"));
    let values = |document: &Value| -> Vec<Value> {
        let estimates = document["estimates"].as_array().expect("estimates");
        let base = estimates
            .iter()
            .find(|one| one["stage"] == "base" && one["estimator"] == "least-squares");
        let parameters = base.expect("base parameters")["parameters"].as_array();
        let own = parameters.expect("parameters").iter();
        own.map(|one| serde_json::json!([one["name"], one["value"], one["interval_95"]]))
            .collect()
    };
    assert!(!values(&all).is_empty());
    assert_eq!(values(&all), values(&basic));
    assert_eq!(basic["settings"]["checks"], "basic");
    assert!(basic["timings"].is_null());
    let kinds = |document: &Value| -> Vec<String> {
        let checks = document["checks"].as_array().expect("checks").iter();
        checks.map(|one| one["kind"].to_string()).collect()
    };
    assert!(kinds(&all).iter().any(|kind| kind.contains("delay")));
    assert!(!kinds(&basic).iter().any(|kind| kind.contains("delay")));
    assert!(kinds(&basic).iter().all(|kind| kinds(&all).contains(kind)));
    let warned = |document: &Value| {
        let sentence = document["verdicts"][0]["rests_on"].as_str();
        sentence.is_some_and(|sentence| sentence.contains("Only the basic checks were run"))
    };
    assert!(warned(&basic) && !warned(&all));
}

#[test]
fn times_of_stages_and_checks_are_reported_on_request() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let identify = |more: &[&str]| {
        let all = ["identify", "my.toml", "--data", "log_identification.csv"];
        bench.json(&[&all[..], more].concat())
    };
    let names = |document: &Value, checks: bool| -> Vec<String> {
        let all = document["timings"].as_array().expect("times").iter();
        let own = all.filter(|one| one["is_check"] == checks);
        own.map(|one| {
            assert!(one["seconds"].as_f64().is_some_and(|time| time >= 0.0));
            one["stage"].as_str().expect("a name").to_owned()
        })
        .collect()
    };
    let basic = identify(&["--timings", "--checks", "basic"]);
    let all = identify(&["--timings"]);
    let [few, many] = [&basic, &all].map(|document| names(document, false));
    for stage in [
        "description",
        "logs",
        "base parameters",
        "estimates and intervals",
    ] {
        assert!(few.iter().any(|own| own == stage), "{stage}: {few:?}");
    }
    assert!(!few.iter().any(|own| own.contains("hypotheses")), "{few:?}");
    assert!(
        many.iter().any(|own| own == "fault hypotheses: tests"),
        "{many:?}"
    );
    assert!(many.iter().any(|own| own == "position noise"), "{many:?}");
    assert!(names(&all, true).iter().any(|own| own == "delays"));
    let log = ["identify", "my.toml", "--data", "log_identification.csv"];
    let text = bench.good(&[&log[..], &["--timings", "--checks", "basic"]].concat());
    assert!(text.contains("Times of the stages"), "{text}");
    assert!(text.contains("check: raw samples"), "{text}");
}

#[test]
fn a_constant_position_is_reported_as_locked_or_dead_encoder() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let log = bench.read("log_identification.csv");
    let dead = log.lines().enumerate().map(|(line, text)| {
        let mut cells: Vec<&str> = text.split(',').collect();
        if line > 0 {
            cells[2] = "0.5";
        }
        cells.join(",")
    });
    let dead: Vec<String> = dead.collect();
    bench.write("dead.csv", &dead.join("\n"));
    let refused = bench.run(&["identify", "my.toml", "--data", "dead.csv", "--strict"]);
    assert_eq!(refused.code, Some(3), "{}", refused.err);
    let words = "the position of joint 2 does not change in any training run";
    assert!(refused.err.contains(words), "{}", refused.err);
    // The round-off of a constant position is no motion.
    assert!(!refused.err.contains("fastest motion"), "{}", refused.err);
}

#[test]
fn the_result_lists_sessions_of_logs() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let logs = ["log_identification.csv", "log_validation.csv"];
    let identify = |sessions: &[&str]| {
        let mut arguments = vec!["identify", "my.toml", "--json", "--data", logs[0], logs[1]];
        arguments.extend(sessions);
        bench.run(&arguments)
    };
    let result = |sessions: &[&str]| -> Value {
        let outcome = identify(sessions);
        assert_eq!(outcome.code, Some(0), "{}", outcome.err);
        serde_json::from_str(&outcome.out).expect("JSON")
    };
    let (two, one) = (result(&["--sessions", "mon", "tue"]), result(&[]));
    assert_eq!(two["runs"][1]["session"], "tue");
    assert!(one["runs"][1]["session"].is_null());
    let assumed = |result: &Value, words: &str| result["assumptions"].to_string().contains(words);
    let [between, without] = ["variation between them", "do not contain changes"];
    assert!(assumed(&two, between) && !assumed(&two, without));
    assert!(assumed(&one, without) && !assumed(&one, between));
    let wrong = identify(&["--sessions", "mon"]);
    assert_eq!(wrong.code, Some(2), "{}", wrong.err);
    assert!(wrong.err.contains("names 1 for 2 logs"), "{}", wrong.err);
    let made = bench.run(&["identify", "my.toml", "--sessions", "mon"]);
    assert_eq!(made.code, Some(2), "{}", made.err);
    assert!(made.err.contains("give logs"), "{}", made.err);
}

#[test]
fn simulated_logs_give_the_estimates_of_the_virtual_experiment() {
    let bench = serial();
    let made = bench.run(&["simulate", "my.toml", "-o", "log.csv"]);
    assert_eq!(
        (made.code, made.err.as_str()),
        (Some(0), ""),
        "a pipe shows no progress"
    );
    assert_eq!(
        bench.files(),
        ["log_identification.csv", "log_validation.csv", "my.toml"]
    );
    let log = bench.read("log_identification.csv");
    assert_eq!(log.lines().next(), Some("time,q_1,q_2,tau_1,tau_2"));
    assert_eq!(log.lines().count(), 5001);
    let one = bench.good(&["simulate", "my.toml", "--run", "identification"]);
    assert_eq!(one, log);

    let (logs, others) = ("log_identification.csv", "log_validation.csv");
    let measured = bench.json(&[
        "identify",
        "my.toml",
        "--data",
        logs,
        "--cross-validate",
        others,
    ]);
    let made = bench.json(&["identify", "my.toml", "--cross-validate", "validation"]);
    let value =
        |document: &Value, i: usize| number(&document["estimates"][0]["parameters"][i]["value"]);
    for i in 0..13 {
        // The sampling frequency of a log follows from its rounded times.
        let (a, b) = (value(&measured, i), value(&made, i));
        assert!((a - b).abs() <= 1e-9 * b.abs(), "{a} {b}");
    }
    let parameter = &made["estimates"][0]["parameters"][0];
    assert_eq!(parameter["name"], "zz_1R");
    assert!((number(&parameter["true_value"]) - 0.292).abs() < 1e-12);
    assert!(number(&parameter["error_percent"]).abs() < 3.0);
    assert!(
        measured["estimates"][0]["parameters"][0]
            .get("true_value")
            .is_none()
    );
    assert!(number(&made["cross_validation"][0]["relative_error_percent"]) < 5.0);
}

#[test]
fn the_json_result_has_its_documented_keys() {
    let bench = Bench::with("planar-4rrr", |text| {
        text.replace("duration = \"4 s\"", "duration = \"2 s\"")
    });
    let document = bench.json(&["identify", "my.toml", "--seed", "7"]);
    for key in ["robot", "runs", "estimates", "cross_validation", "warnings"] {
        assert!(document.get(key).is_some(), "{key}");
    }
    let estimates = document["estimates"].as_array().expect("a list");
    let models: Vec<(&str, &str)> = estimates
        .iter()
        .filter_map(|e| Some((e["model"].as_str()?, e["stage"].as_str()?)))
        .collect();
    let all = |model| ["base", "recommended", "essential"].map(|stage| (model, stage));
    let weighted = [all("platform"), all("actuators")].concat();
    assert_eq!(models[..6], weighted);
    // Ordinary least squares follow the weighted ones.
    assert_eq!(models[6..], [("platform", "base"), ("actuators", "base")]);
    for (place, one) in estimates.iter().enumerate() {
        let is_weighted = place < 6;
        let how = ["ordinary-least-squares", "least-squares"][usize::from(is_weighted)];
        assert_eq!(
            (&one["estimator"], &one["weighted"]),
            (&how.into(), &is_weighted.into())
        );
    }
    assert_eq!(
        estimates[3]["kept_actuators"],
        serde_json::json!(["leg1", "leg2", "leg3"])
    );
    for key in ["relative_error_percent", "condition_number", "equations"] {
        assert!(estimates[0][key].is_number(), "{key}");
    }
    let payload = estimates[0]["parameters"]
        .as_array()
        .expect("a list")
        .last()
        .expect("one");
    assert_eq!(payload["name"], "m_payload");
    for key in [
        "value",
        "standard_deviation",
        "relative_standard_deviation_percent",
        "true_value",
    ] {
        assert!(payload[key].is_number(), "{key}");
    }
    let interval: Vec<f64> = payload["interval_95"]
        .as_array()
        .expect("two numbers")
        .iter()
        .map(number)
        .collect();
    let value = number(&payload["value"]);
    assert!(interval.len() == 2 && interval[0] < value && value < interval[1]);
    assert!(
        (number(&payload["value"]) / 5.4 - 1.0).abs() < 0.02,
        "{payload}"
    );
}

#[test]
fn partitions_are_ranked() {
    let duration = by_tier(["duration = \"1 s\"", "duration = \"2 s\""]);
    let bench = Bench::with("planar-4rrr", |text| {
        text.replace("duration = \"4 s\"", duration)
    });
    let document = bench.json(&["partitions", "my.toml"]);
    let partitions = document["partitions"].as_array().expect("a list");
    assert_eq!(partitions.len(), 4);
    let ratios: Vec<f64> = partitions
        .iter()
        .map(|p| number(&p["deviation_ratio"]))
        .collect();
    assert!(ratios.is_sorted() && ratios[0] > 0.0, "{ratios:?}");
    assert_eq!(document["platform"]["deviation_ratio"], 1.0);
    let text = serial().bad(&["partitions", "my.toml"]);
    assert!(text.contains("so there is no choice"), "{text}");
}

#[test]
fn the_report_names_all_parameters_that_hidden_faults_shift() {
    let bench = serial();
    bench.good(&["simulate", "my.toml", "-o", "log.csv"]);
    let log = ["identify", "my.toml", "--data", "log_identification.csv"];
    let json = bench.good(&[&log[..], &["--json", "--report", "report.html"]].concat());
    let result: Value = serde_json::from_str(&json).expect("a JSON document");
    let checks = result["checks"].as_array().expect("checks").iter();
    let limits = checks
        .filter(|check| check["passed"] == true)
        .filter_map(|check| check["detectable"].as_array())
        .flatten()
        .filter(|limit| limit["also"].is_array() && number(&limit["size"]).is_finite());
    let page = bench.read("report.html");
    let table = page.split("All parameters that these faults shift").nth(1);
    let table = table.and_then(|rest| rest.split("</details>").next());
    let table = table.expect("a table");
    let mut count = 0;
    for limit in limits {
        for other in limit["also"].as_array().expect("shifts") {
            let name = other["parameter"].as_str().expect("a name");
            let words = format!("<code>{name}</code> by {:.0} σ", number(&other["moves"]));
            assert!(
                number(&limit["size"]) > 1.0 || table.contains(&words),
                "{words}"
            );
            count += 1;
        }
    }
    assert!(count > 0, "no fault shifts several parameters");
}

#[test]
fn invalid_logs_are_rejected_without_output() {
    let bench = serial();
    let bad = |log: &str| {
        bench.write("log.csv", log);
        let text = bench.bad(&[
            "identify",
            "my.toml",
            "--data",
            "log.csv",
            "-o",
            "report.txt",
        ]);
        assert!(text.contains("log.csv"), "{text}");
        text
    };
    let header = "time,q_1,q_2,tau_1,tau_2\n";
    let text = bad("time,q1,q_2,tau_1\n0,0,0,0\n");
    assert!(
        text.contains("`q_1`, `tau_2`") && text.contains("did you mean `q1` for `q_1`"),
        "{text}"
    );
    assert!(bad(&format!("{header}0,0,0,0,0\n0.001,0,NaN,0,0\n")).contains("log.csv:3"));
    let rows = |time: fn(usize) -> f64, count: usize| {
        let row = |i: usize| format!("{},{},0,1,2\n", time(i), (i as f64 * 0.01).sin());
        header.to_owned() + &(0..count).map(row).collect::<String>()
    };
    assert!(
        bad(&rows(
            |i| i as f64 * 1e-3 + if i > 50 { 5e-3 } else { 0.0 },
            100
        ))
        .contains("not uniform")
    );
    assert!(bad(&rows(|i| i as f64 * 1e-3, 10)).contains("need at least"));
    assert!(bad("").contains("the file is empty"));
    let text = bench.bad(&["identify", "my.toml", "--data", "none.csv", "also.csv"]);
    assert!(
        text.contains("none.csv") && text.contains("also.csv"),
        "{text}"
    );
    assert!(!bench.path("report.txt").exists());
}

#[test]
fn invalid_experiments_are_rejected_without_output() {
    let bench = serial();
    bench.write("log_identification.csv", "old");
    let text = bench.bad(&[
        "simulate",
        "my.toml",
        "--run",
        "identificaton",
        "-o",
        "log.csv",
    ]);
    assert!(text.contains("did you mean `identification`"), "{text}");
    let far = Bench::with("planar-4rrr", |text| {
        text.replace("\"40 mm\"", "\"900 mm\"")
    });
    let text = far.bad(&["simulate", "my.toml", "-o", "far/"]);
    assert!(
        text.contains("run `unloaded`") && text.contains("run `loaded`"),
        "{text}"
    );
    assert!(
        text.contains("out of reach") && text.contains("my.toml"),
        "{text}"
    );
    assert!(!far.path("far").exists());
    let text = bench.bad(&[
        "simulate",
        "my.toml",
        "--run",
        "validation",
        "-o",
        "none/log.csv",
    ]);
    assert!(text.contains("its folder does not exist"), "{text}");
    assert_eq!(bench.read("log_identification.csv"), "old");
    let robot = Bench::with("serial-2r", |text| {
        text.split("# A virtual experiment")
            .next()
            .unwrap_or_default()
            .to_owned()
    });
    assert!(
        robot
            .bad(&["identify", "my.toml"])
            .contains("no virtual experiment")
    );
    assert!(
        robot
            .bad(&["simulate", "my.toml", "-o", "log.csv"])
            .contains("no virtual experiment")
    );
}

/// Full tier only; every tier tests the same digits through the library, and logs of a robot.
#[test]
fn online_replay_reports_estimates_over_time() {
    let bench = serial();
    let run = |arguments: &[&str]| {
        let all = [&["identify", "my.toml", "--seed", "3"], arguments].concat();
        bench.json(&all)
    };
    let document = run(&["--online"]);
    let base = &document["estimates"][0]["parameters"];
    let count = base.as_array().expect("a list").len();
    let online = document["online"].as_array().expect("estimates over time");
    let last = online.last().expect("an estimate");
    for key in ["run", "time", "values", "standard_deviations", "change"] {
        assert!(last.get(key).is_some(), "{key}");
    }
    for place in 0..count {
        let (found, expected) = (
            number(&last["values"][place]),
            number(&base[place]["value"]),
        );
        assert!(
            (found - expected).abs() <= 1e-10 * expected.abs().max(1e-2),
            "{found} {expected}"
        );
    }
    assert!(run(&[]).get("online").is_none());
    let forgetful = run(&["--online", "--forgetting", "directional:0.99"]);
    let last = forgetful["online"]
        .as_array()
        .expect("a list")
        .last()
        .expect("an estimate");
    let wider = |place: usize| {
        let own = number(&last["standard_deviations"][place]);
        own / number(&base[place]["correlated_standard_deviation"])
    };
    let ratios: Vec<f64> = (0..count).map(wider).collect();
    assert!(ratios.iter().any(|ratio| *ratio > 1.2), "{ratios:?}");
    assert!(ratios.iter().all(|ratio| *ratio > 0.9), "{ratios:?}");
    let text = bench.good(&["identify", "my.toml", "--online", "--report", "report.html"]);
    assert!(text.contains("Online estimation"), "{text}");
    assert!(bench.read("report.html").contains("figure-online"));
    for rule in ["exponential", "directional:2", "none:1", "slowly:0.9"] {
        let arguments = ["identify", "my.toml", "--online", "--forgetting", rule];
        assert_eq!(bench.run(&arguments).code, Some(2), "{rule}");
    }
}
