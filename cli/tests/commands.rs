//! `new`, `check`, `inspect`, `generate` and the exit codes.

mod common;

use common::{Bench, number, robot};
use overact_tier::by_tier;
use serde_json::Value;

fn same(text: &str) -> String {
    text.to_owned()
}

#[test]
fn templates_pass_check_and_are_not_overwritten() {
    for template in ["planar-4rrr", "serial-2r"] {
        let bench = Bench::with(template, same);
        assert!(bench.good(&["check", "my.toml"]).ends_with(", ok\n"));
        let before = bench.read("my.toml");
        assert!(
            bench
                .bad(&["new", template, "my.toml"])
                .contains("not overwritten")
        );
        assert_eq!(bench.read("my.toml"), before);
    }
    let bench = Bench::new();
    let unknown = bench.run(&["new", "planar-4rr", "my.toml"]);
    assert_eq!(unknown.code, Some(2));
    assert!(unknown.err.contains("planar-4rrr") && unknown.err.contains("serial-2r"));
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn check_prints_sizes_or_all_errors() {
    let bench = Bench::new();
    let dualv = robot("dualv.toml");
    let line = bench.good(&["check", &dualv]);
    let expected = "DualV, 4 legs, 12 joints, 4 actuators, 3 degrees of freedom, ok\n";
    assert_eq!(line, format!("{dualv}: {expected}"));
    let document = bench.json(&["check", &dualv, &robot("emps.toml")]);
    assert_eq!(document["robots"][1]["robot"], "Emps");

    let broken = "name = \"A\"\nsumary = \"s\"\n[platform]\nmotion = \"planer\"\n";
    bench.write("two.toml", broken);
    let text = bench.bad(&["check", "two.toml"]);
    assert!(
        text.contains("two.toml:2:1") && text.contains("did you mean `summary`"),
        "{text}"
    );
    assert!(text.contains("two.toml:4:"), "{text}");
    assert!(!text.contains('\u{1b}'), "a pipe has no colours");
    bench.write("syntax.toml", "name = \n");
    assert!(
        bench
            .bad(&["check", "syntax.toml"])
            .contains("syntax.toml:1:")
    );
    let text = bench.bad(&["check", "none.toml"]);
    assert!(
        text.contains("can't be read") && text.contains("none.toml"),
        "{text}"
    );
    // Valid files are still reported; the exit code is that of the invalid one.
    let both = bench.run(&["check", &dualv, "two.toml"]);
    assert_eq!(
        (both.code, both.out),
        (Some(1), format!("{dualv}: {expected}"))
    );
}

/// A second motor in every leg is redundancy that may be unintended.
#[test]
fn undeclared_redundancy_is_noted() {
    let bench = Bench::with("planar-3rrr", |text| {
        let text = text.replace("d = \"l_1\"", "d = \"l_1\"\nactuated = true");
        // Its names are those of legs with one actuator each.
        text.replace("kept_actuators = [\"leg1\", \"leg2\", \"leg3\"]", "")
    });
    let checked = bench.run(&["check", "my.toml"]);
    assert_eq!(checked.code, Some(0), "{}", checked.err);
    let note = "note: my.toml: 6 actuators (leg1_1, leg1_2, leg2_1, leg2_2, leg3_1, leg3_2) drive 3 degrees of freedom";
    assert!(checked.err.starts_with(note), "{}", checked.err);
    let document = bench.json(&["check", "my.toml"]);
    let note = document["robots"][0]["note"].as_str().expect("a note");
    // Its proposal resolves the note.
    let (_, proposal) = note.split_once("write ").expect("a proposal");
    let (key, _) = proposal.split_once(" in [platform]").expect("a table");
    let text = bench.read("my.toml");
    bench.write(
        "my.toml",
        &text.replace("[platform]", &format!("[platform]\n{key}")),
    );
    let checked = bench.run(&["check", "my.toml"]);
    assert_eq!((checked.code, checked.err.as_str()), (Some(0), ""));
    // Another redundancy is an error.
    bench.write(
        "my.toml",
        &text.replace("[platform]", "[platform]\nredundancy = 1"),
    );
    let checked = bench.run(&["check", "my.toml"]);
    assert_eq!(checked.code, Some(1));
    for words in [
        "a redundancy of 1 means 4 actuators for 3 coordinates, but the robot has 6",
        "leg1_1, leg1_2, leg2_1",
        "redundancy = 3",
    ] {
        assert!(checked.err.contains(words), "{words} in {}", checked.err);
    }
}

#[test]
fn usage_errors_have_their_own_exit_code() {
    let bench = Bench::new();
    let dualv = robot("dualv.toml");
    let usages: [&[&str]; 7] = [
        &[],
        &["chek"],
        &["check"],
        &["evaluate", "my.toml", "joints"],
        &["generate", "--check", &dualv],
        &["simulate", &dualv],
        &["inspect", &dualv, "--svg", "-"],
    ];
    for usage in usages {
        let outcome = bench.run(usage);
        assert_eq!(
            (outcome.code, outcome.out.as_str()),
            (Some(2), ""),
            "{usage:?}"
        );
        assert!(!outcome.err.is_empty());
        if usage.is_empty() {
            continue;
        }
        let json = bench.run(&[usage, &["--json"]].concat());
        assert_eq!((json.code, json.out.as_str()), (Some(2), ""), "{usage:?}");
        let document: Value = serde_json::from_str(&json.err).expect("errors as JSON");
        let message = document["errors"][0]["message"]
            .as_str()
            .expect("a message");
        assert!(
            !message.is_empty() && !message.starts_with("error"),
            "{message}"
        );
    }
    assert_eq!(bench.run(&["--help"]).code, Some(0));
}

#[test]
fn inspect_describes_sizes_parameters_and_functions() {
    let bench = Bench::new();
    let effort = by_tier(["none", "quick"]);
    let document = bench.json(&["inspect", &robot("dualv.toml"), "--effort", effort]);
    assert_eq!(document["robot"], "DualV");
    for (key, size) in [("dof", 3), ("actuators", 4), ("joints", 12)] {
        assert_eq!(document[key], size);
    }
    let parameters = document["parameters"].as_array().expect("a list");
    assert_eq!(parameters.len(), 68);
    assert_eq!(parameters[67], "m_payload");
    let base = document["base_parameters"].as_array().expect("a list");
    assert_eq!(base.len(), 49);
    let zz = base
        .iter()
        .find(|b| b["name"] == "zz_1_leg2R")
        .expect("a base parameter");
    let terms: Vec<(String, f64)> = zz["regrouping"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|t| {
            (
                t["parameter"].as_str().expect("a name").to_owned(),
                number(&t["coefficient"]),
            )
        })
        .collect();
    assert_eq!(terms[0], ("zz_1_leg2".to_owned(), 1.0));
    assert!(
        terms.contains(&("m_2_leg2".to_owned(), 0.0784)),
        "{terms:?}"
    );
    let functions = document["functions"].as_array().expect("a list");
    let find = |name: &str| {
        functions
            .iter()
            .find(|f| f["function"] == name)
            .expect("a function")
    };
    check_function(find("idm_red_platform"));
    check_calls(&document);
    let from = find("idm_red_actuators_base_from_actuators");
    assert_eq!(
        (&from["columns"], &from["from"]),
        (&"base".into(), &"actuators".into())
    );
    let names: Vec<&str> = from["inputs"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|i| i["name"].as_str())
        .collect();
    assert_eq!(
        names,
        [
            "actuators",
            "actuator_velocities",
            "actuator_accelerations",
            "start"
        ]
    );
    assert!(number(&document["conditioning"]["home"]) > 1.0);
    assert_eq!(
        document["conditioning"]["partitions"]
            .as_array()
            .map(Vec::len),
        Some(4)
    );
    let text = bench.good(&["inspect", &robot("dualv.toml"), "--effort", "none"]);
    assert!(
        text.contains("zz_1_leg1R   = zz_1_leg1 + ia_1_leg1 - 0.28 mx_2_leg1 + 0.0784 m_2_leg1")
    );
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
}

fn check_function(function: &Value) {
    assert_eq!(function["name"], "idm_red_platform");
    assert_eq!(
        (&function["columns"], &function["from"]),
        (&"standard".into(), &"pose".into())
    );
    assert_eq!(function["outputs"][0]["shape"], serde_json::json!([3, 64]));
    let counts = [
        "additions",
        "multiplications",
        "divisions",
        "square_roots",
        "trigonometric_pairs",
        "arc_tangents",
        "signs",
        "guards",
        "negations",
        "intermediates",
    ];
    assert!(counts.iter().all(|key| function[key].is_u64()));
    let sum: u64 = counts[..3]
        .iter()
        .filter_map(|key| function[key].as_u64())
        .sum();
    assert_eq!(function["operations"], sum);
    assert_eq!(function["iterations"], serde_json::json!([]));
}

/// Forward kinematics is part of functions of the actuators: by iteration, or in closed form.
fn check_calls(document: &Value) {
    let functions = document["functions"].as_array().expect("functions");
    let named = |name: &str| {
        let found = functions.iter().find(|f| f["function"] == name);
        found.unwrap_or_else(|| panic!("{name}"))
    };
    let function = named("idm_red_platform_from_actuators");
    let step = &function["iterations"][0];
    assert_eq!(step["function"], "pose_from_actuators");
    assert!(step["within"].is_null());
    // Each step evaluates both, and solves for the displacement.
    let evaluated = ["actuator_positions", "inverse_jacobian"]
        .iter()
        .filter_map(|name| named(name)["operations"].as_u64())
        .sum::<u64>();
    assert!(step["operations"].as_u64() > Some(evaluated), "{step}");
    assert!(named("joints")["arc_tangents"].as_u64() > Some(0));
}

#[test]
fn generate_check_detects_stale_files() {
    let bench = Bench::with("serial-2r", same);
    let code = bench.good(&["generate", "--effort", "quick", "my.toml"]);
    assert!(code.starts_with("// @generated by overact from my.toml"));
    bench.good(&["generate", "--effort", "quick", "my.toml", "-o", "out/"]);
    assert_eq!(bench.read("out/my.rs"), code);
    bench.good(&[
        "generate", "--effort", "quick", "my.toml", "-o", "out", "--check",
    ]);
    bench.write("out/my.rs", "old");
    let text = bench.bad(&[
        "generate", "--effort", "quick", "my.toml", "-o", "out", "--check",
    ]);
    assert!(text.contains("overact generate my.toml -o"), "{text}");
    assert_eq!(bench.read("out/my.rs"), "old");
    bench.write("twin.toml", &bench.read("my.toml"));
    let text = bench.bad(&[
        "generate",
        "--effort",
        "quick",
        "my.toml",
        "twin.toml",
        "-o",
        "out",
    ]);
    assert!(text.contains("MySerialRobot"), "{text}");
    bench.write("my.toml", "name = 1");
    bench.bad(&["generate", "--effort", "quick", "my.toml", "-o", "out"]);
    assert_eq!(bench.read("out/my.rs"), "old", "untouched on error");
}
