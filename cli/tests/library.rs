//! Every command on every robot of `robots/`.
//!
//! Values are compared with generator-independent facts: power of friction, linearity in the
//! accelerations, and true parameters of the virtual experiments.

mod common;

use common::{Bench, list, names, number, robot, robots};
use overact_tier::{by_tier, of_many};
use serde_json::{Value, json};
use std::{
    fs,
    path::{Path, PathBuf},
};

fn file(name: &str) -> String {
    robot(&format!("{name}.toml"))
}

#[test]
fn all_robots_pass_check() {
    let robots = robots();
    let files: Vec<String> = robots.iter().map(|name| file(name)).collect();
    let mut arguments = vec!["check"];
    arguments.extend(files.iter().map(String::as_str));
    let document = Bench::new().json(&arguments);
    let checked = list(&document["robots"]);
    assert_eq!(checked.len(), robots.len());
    for (one, file) in checked.iter().zip(&files) {
        assert_eq!(one["file"], file.as_str());
        let size = |key: &str| one[key].as_u64().unwrap_or_else(|| panic!("{key}: {one}"));
        assert!(
            size("dof") >= 1 && size("actuators") >= size("dof"),
            "{one}"
        );
        assert!(size("joints") >= size("actuators"), "{one}");
    }
}

#[test]
fn all_robots_are_inspected_drawn_and_evaluated() {
    let bench = Bench::new();
    for name in robots_of_the_tier() {
        let document = bench.json(&[
            "inspect",
            &file(&name),
            "--effort",
            "none",
            "--svg",
            "drawing.svg",
        ]);
        assert_regroupings(&name, &document);
        for function in list(&document["functions"]) {
            assert!(function["operations"].is_u64(), "{name}: {function}");
        }
        let home = number(&document["conditioning"]["home"]);
        assert!((1.0..1e4).contains(&home), "{name}: {home}");
        assert_drawing(&name, &bench.read("drawing.svg"));
        assert_evaluation(&name, &bench, &document);
    }
}

#[test]
fn drawings_and_robots_correspond() {
    let drawings = fs::read_dir(drawings()).expect("the drawings").count();
    assert_eq!(drawings, robots().len());
    for name in robots() {
        assert!(drawing_of(&name).is_file(), "{name}");
    }
}

fn drawings() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/robots")
}

fn drawing_of(name: &str) -> PathBuf {
    drawings().join(format!("{name}.svg"))
}

/// Base parameters are standard parameters, and regroup only such.
fn assert_regroupings(name: &str, document: &Value) {
    let parameters = names(&document["parameters"]);
    let base = list(&document["base_parameters"]);
    assert!(!base.is_empty() && base.len() <= parameters.len(), "{name}");
    for one in base {
        let terms = list(&one["regrouping"]);
        let own = terms[0]["parameter"].as_str().expect("a name");
        assert_eq!(number(&terms[0]["coefficient"]), 1.0, "{name}: {one}");
        let shown = one["name"].as_str().expect("a name");
        let is_regrouped = terms.len() > 1;
        let expected = if is_regrouped {
            format!("{own}R")
        } else {
            own.to_owned()
        };
        assert_eq!(shown, expected, "{name}");
        for term in terms {
            let of = term["parameter"].as_str().expect("a name");
            assert!(parameters.contains(&of), "{name}: {of}");
            assert!(number(&term["coefficient"]).is_finite(), "{name}: {one}");
        }
    }
}

/// The drawing equals that in `docs/robots` and is well-formed.
fn assert_drawing(name: &str, svg: &str) {
    let kept = fs::read_to_string(drawing_of(name)).unwrap_or_default();
    assert!(
        kept == svg,
        "docs/robots/{name}.svg: renew it with `overact inspect robots/{name}.toml --svg docs/robots/{name}.svg`"
    );
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    assert!(
        svg.matches("http").count() <= 1,
        "{name}: only its own namespace"
    );
    let mut open: Vec<&str> = Vec::new();
    for tag in svg.split('<').skip(1) {
        let inside = tag.split('>').next().unwrap_or_default();
        let word = inside
            .split([' ', '/'])
            .find(|w| !w.is_empty())
            .unwrap_or_default();
        if inside.starts_with('/') {
            assert_eq!(open.pop(), Some(word), "{name}");
        } else if !inside.ends_with('/') {
            open.push(word);
        }
    }
    assert!(open.is_empty(), "{name}: {open:?}");
}

/// At home, the identification model is linear in the accelerations, and friction has the right
/// power.
fn assert_evaluation(name: &str, bench: &Bench, inspected: &Value) {
    let home: Vec<f64> = list(&inspected["home_pose"]).iter().map(number).collect();
    let dof = list(&inspected["coordinates"]).len();
    let rates: Vec<f64> = (0..dof).map(|i| 0.3 + 0.1 * i as f64).collect();
    let state = |times: f64| {
        let accelerations: Vec<f64> = (0..dof).map(|i| times * (1.0 + 0.2 * i as f64)).collect();
        // Without a platform the joints are the pose.
        match inspected["functions"][0]["from"].as_str() {
            Some("joints") => json!({ "joints": home, "joint_velocities": rates,
                "joint_accelerations": accelerations }),
            _ => json!({ "pose": home, "twist": rates, "acceleration": accelerations }),
        }
    };
    let states: Value = [0.0, 1.0, 2.0].map(state).to_vec().into();
    bench.write("states.json", &states.to_string());
    let ask = [
        "evaluate",
        &file(name),
        "idm_red_platform",
        "--states",
        "states.json",
    ];
    let document = bench.json(&ask);
    let parameters = names(&document["parameters"]);
    let shape = json!([dof, parameters.len()]);
    assert_eq!(document["shapes"]["idm_red_platform"], shape, "{name}");
    assert!(
        names(&inspected["parameters"]).starts_with(&parameters),
        "{name}"
    );
    let values = |result: &Value| -> Vec<f64> {
        let values = list(&result["idm_red_platform"]);
        assert_eq!(values.len(), dof * parameters.len(), "{name}");
        // A number that is not finite would be null.
        values.iter().map(number).collect()
    };
    let models: Vec<Vec<f64>> = list(&document["results"]).iter().map(values).collect();
    let [none, once, twice] = &models[..] else {
        panic!("{name}: {} results", models.len());
    };
    assert!(none != once, "{name}: accelerations count");
    let size = twice.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
    for ((none, once), twice) in none.iter().zip(once).zip(twice) {
        let bend = twice - 2.0 * once + none;
        assert!(bend.abs() < 1e-9 * size, "{name}: {bend}");
    }
    assert_friction(name, &parameters, none, &rates);
}

/// Power of friction per unit parameter: rate squared (viscous), magnitude of the rate (Coulomb),
/// rate (offset).
fn assert_friction(name: &str, parameters: &[&str], model: &[f64], rates: &[f64]) {
    let power = |parameter: &str| -> Option<f64> {
        let column = parameters.iter().position(|p| *p == parameter)?;
        let rows = model.chunks(parameters.len()).zip(rates);
        Some(rows.map(|(row, rate)| row[column] * rate).sum())
    };
    let mut moving = 0;
    for joint in parameters.iter().filter_map(|p| p.strip_prefix("fv_")) {
        let viscous = power(&format!("fv_{joint}")).unwrap_or_default();
        let rate = viscous.sqrt();
        let near = |p: f64| (p - rate).abs() < 1e-9 * (1.0 + rate);
        let of = |symbol: &str| power(&format!("{symbol}_{joint}")).unwrap_or(rate);
        assert!(near(of("fs")), "{name}: {joint}: {} {rate}", of("fs"));
        assert!(
            near(of("off").abs()),
            "{name}: {joint}: {} {rate}",
            of("off")
        );
        moving += usize::from(rate > 1e-3);
    }
    assert!(moving > 0, "{name}: no joint moves");
}

/// Several modules at once; `overact-tests` compares them with `generated/`.
#[test]
fn all_modules_are_generated() {
    let bench = Bench::new();
    let robots = robots_of_the_tier();
    let files: Vec<String> = robots.iter().map(|name| file(name)).collect();
    let mut arguments = vec!["generate", "--effort", "none", "-o", "out/"];
    arguments.extend(files.iter().map(String::as_str));
    bench.good(&arguments);
    for name in robots {
        let code = bench.read(&format!("out/{name}.rs"));
        let header = format!("// @generated by overact from {name}.toml");
        assert!(code.starts_with(&header), "{name}");
        assert_eq!(
            code.matches("impl ::overact::Model for").count(),
            1,
            "{name}"
        );
        for function in [
            "joints",
            "inverse_jacobian",
            "idm_red_platform_base",
            "inverse_dynamics",
            "mass_matrix",
            "bias",
        ] {
            let signature = format!("pub fn {function}(");
            assert_eq!(code.matches(&signature).count(), 1, "{name}: {function}");
        }
        let statements = code
            .lines()
            .filter(|line| !line.trim_start().starts_with("///"));
        for line in statements {
            assert!(
                !line.contains("NaN") && !line.contains("unsafe"),
                "{name}: {line}"
            );
        }
    }
}

/// Description with runs of `duration`, and base parameters only.
///
/// Elimination is slow for large robots and tested with small ones.
fn shortened(name: &str, duration: &str) -> String {
    let text = fs::read_to_string(file(name)).expect("a robot");
    let line = |line: &str| match line.split(" = ").next() {
        Some("duration") => format!("duration = \"{duration}\"\n"),
        Some("essential") => String::new(),
        Some("[identification]") => format!("{line}\nessential = false\n"),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Small robots of the default tier, for which derivation, runs and modules are fast.
///
/// They are a tree of one joint and one of six, a closed loop, a robot with a guided slider and a
/// redundant one.
const SMALL: [&str; 5] = ["emps", "five_bar", "rx90", "scotch_yoke", "three_leg_point"];

/// Those and some others in the full tier, all in the nightly tier.
///
/// `overact-tests` generates and compiles all of them in any tier.
fn robots_of_the_tier() -> Vec<String> {
    let of_many = of_many(robots()).into_iter();
    let others = of_many.filter(|name| !SMALL.contains(&name.as_str()));
    SMALL.map(str::to_owned).into_iter().chain(others).collect()
}

#[test]
fn all_robots_are_simulated() {
    let bench = Bench::new();
    for name in robots_of_the_tier() {
        let text = shortened(&name, "0.25 s");
        bench.write("my.toml", &text);
        let description: toml::Table = text.parse().expect("TOML");
        let experiment = &description["experiment"];
        let run = experiment["run"][0]["name"].as_str().expect("a name");
        let document = bench.json(&["simulate", "my.toml", "--run", run, "-o", "log.csv"]);
        let summary = &document["runs"][0];
        let frequency = number(&summary["sampling_hz"]);
        let log = bench.read("log.csv");
        let mut lines = log.lines();
        let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
        let actuators = (header.len() - 1) / 2;
        assert_eq!(list(&summary["tracking_error"]).len(), actuators, "{name}");
        assert_eq!(header[0], "time", "{name}");
        for (position, torque) in header[1..].iter().zip(&header[1 + actuators..]) {
            let of = position.strip_prefix("q_").expect("a position");
            assert_eq!(*torque, format!("tau_{of}"), "{name}");
        }
        let rows: Vec<Vec<f64>> = lines.map(numbers).collect();
        assert_eq!(rows.len() as f64, (0.25 * frequency).round(), "{name}");
        assert_eq!(summary["samples"], rows.len(), "{name}");
        for (at, row) in rows.iter().enumerate() {
            assert_eq!(row.len(), header.len(), "{name}");
            assert!(row.iter().all(|v| v.is_finite()), "{name}: {row:?}");
            assert!((row[0] - at as f64 / frequency).abs() < 1e-9, "{name}");
        }
        let moves = |column: usize| rows[0][column] != rows[rows.len() - 1][column];
        assert!((1..=actuators).all(moves), "{name}: every actuator moves");
        // Controlled robots stay near their trajectory.
        let errors = list(&summary["tracking_error"]).iter().map(number);
        assert!(errors.fold(0.0, f64::max) < 0.05, "{name}: {summary}");
    }
}

fn numbers(line: &str) -> Vec<f64> {
    let cells = line.split(',').map(str::parse);
    cells.collect::<Result<_, _>>().expect("numbers")
}

/// At least 95 % of the base parameters are within three honest standard deviations, for each robot
/// and model.
#[test]
fn all_robots_are_identified() {
    let bench = Bench::new();
    let (mut all, mut within) = (0, 0);
    for name in robots_of_the_tier() {
        let text = shortened(&name, by_tier(["1 s", "2 s"]));
        // Settings of published work for a measured log do not suit a short virtual run.
        if ["standstill_velocity", "filter_torques", "filter_equations"]
            .iter()
            .any(|key| text.contains(key))
        {
            continue;
        }
        bench.write("my.toml", &text);
        let document = bench.json(&["identify", "my.toml"]);
        let by_least_squares = |e: &&Value| e["estimator"] == "least-squares";
        let all_estimates = list(&document["estimates"]).iter();
        let estimates: Vec<&Value> = all_estimates.filter(by_least_squares).collect();
        let models: Vec<&str> = estimates
            .iter()
            .filter_map(|e| e["model"].as_str())
            .collect();
        let redundant = ["platform", "actuators"];
        assert!(
            models == ["joints"] || models == redundant,
            "{name}: {models:?}"
        );
        for estimate in estimates {
            assert_eq!(estimate["stage"], "base", "{name}");
            let error = number(&estimate["relative_error_percent"]);
            assert!(error < 10.0, "{name}: {error} %");
            let parameters = list(&estimate["parameters"]);
            let inside = count_within_three_deviations(&name, parameters);
            println!("{name}: {inside} of {}", parameters.len());
            assert!(20 * inside >= 19 * parameters.len(), "{name}: {inside}");
            within += inside;
            all += parameters.len();
        }
    }
    println!("all: {within} of {all}");
    assert!(20 * within >= 19 * all, "{within} of {all}");
}

/// `evaluate`, `simulate` and `generate` read the consistent parameters of `identify --parameters`.
///
/// `evaluate` gives the same torques as for these numbers as inputs.
#[test]
fn all_robots_read_their_identified_parameters() {
    let bench = Bench::new();
    let all = robots_of_the_tier();
    // Every fourth robot, because this takes most of the library's test time.
    for name in all.into_iter().step_by(4).take(by_tier([1, usize::MAX])) {
        // Most of a period is necessary for six joints that rest in turn.
        bench.write("my.toml", &shortened(&name, "4 s"));
        let identified = bench.json(&["identify", "my.toml", "--parameters", "parameters.toml"]);
        let consistent = &identified["consistent"][0];
        let bodies = list(&consistent["bodies"]);
        let definite = |body: &Value| number(&body["definiteness"]) > 0.0;
        assert!(bodies.iter().all(definite), "{name}: {consistent}");
        let inspected = bench.json(&["inspect", "my.toml", "--effort", "none"]);
        let found = list(&consistent["parameters"]);
        let value = |wanted: &&str| -> f64 {
            let own = found.iter().find(|one| one["name"] == **wanted);
            // A payload that no run carries does not exist.
            if own.is_none() && wanted.ends_with("_payload") {
                return 0.0;
            }
            number(&own.unwrap_or_else(|| panic!("{name}: {wanted}"))["value"])
        };
        let values: Vec<f64> = names(&inspected["parameters"]).iter().map(value).collect();
        let home: Vec<f64> = list(&inspected["home_pose"]).iter().map(number).collect();
        let dof = list(&inspected["coordinates"]).len();
        let rates: Vec<f64> = (0..dof).map(|i| 0.1 + 0.1 * i as f64).collect();
        let state = match inspected["functions"][0]["from"].as_str() {
            Some("joints") => json!({ "joints": home, "joint_velocities": rates,
                "joint_accelerations": rates }),
            _ => json!({ "pose": home, "twist": rates, "acceleration": rates }),
        };
        let mut explicit = state.clone();
        explicit["parameters"] = json!(values);
        bench.write("states.json", &json!([state]).to_string());
        bench.write("explicit.json", &json!([explicit]).to_string());
        let ask = |more: &[&str]| {
            let start = ["evaluate", "my.toml", "inverse_dynamics", "--states"];
            bench.json(&[&start[..], more].concat())["results"].clone()
        };
        let read = ask(&["states.json", "--parameters", "parameters.toml"]);
        let torques = list(&read[0]["inverse_dynamics"]);
        assert!(torques.iter().any(|torque| number(torque) != 0.0), "{name}");
        // Two parsers may round the last digit differently.
        let output = ask(&["explicit.json"]);
        let output = list(&output[0]["inverse_dynamics"]).iter().map(number);
        let largest = output
            .clone()
            .fold(0.0, |largest: f64, torque| largest.max(torque.abs()));
        for (torque, output) in torques.iter().zip(output) {
            let miss = (number(torque) - output).abs();
            assert!(miss <= 1e-12 * largest, "{name}: {torque} is not {output}");
        }
        bench.good(&[
            "simulate",
            "my.toml",
            "-o",
            "logs/",
            "--parameters",
            "parameters.toml",
        ]);
        let generate = ["generate", "my.toml", "--effort", "none", "-o", "my.rs"];
        bench.good(&[&generate[..], &["--parameters", "parameters.toml"]].concat());
        let code = bench.read("my.rs");
        assert!(code.contains("fn inverse_dynamics("), "{name}");
    }
}

/// Number of parameters within three honest standard deviations of the truth.
///
/// Some must be well determined and near the truth, so that wide intervals cannot compensate for
/// bad values. The single torque of Stephenson's six-bar, a function of one angle, determines one.
fn count_within_three_deviations(name: &str, parameters: &[Value]) -> usize {
    let (mut within, mut determined) = (0, 0);
    for parameter in parameters {
        let of = |key: &str| number(&parameter[key]);
        let (truth, deviation) = (of("true_value"), of("correlated_standard_deviation"));
        assert!(deviation >= of("standard_deviation"), "{name}: {parameter}");
        let error = (of("value") - truth).abs();
        within += usize::from(error <= 3.0 * deviation);
        if 100.0 * deviation < 5.0 * of("value").abs() {
            determined += 1;
            let largest = 0.05 * truth.abs() + 5.0 * deviation;
            assert!(error < largest, "{name}: {parameter}");
        }
    }
    let is_determined = match name {
        "stephenson" => determined >= 1,
        _ => determined >= 3 && 7 * determined >= parameters.len(),
    };
    assert!(is_determined, "{name}: {determined}");
    within
}
