//! `evaluate`: states in, values out.

mod common;

use common::{Bench, number, robot};
use serde_json::{Value, json};

fn bench() -> Bench {
    let bench = Bench::new();
    let state = |pose: [f64; 3]| {
        json!({ "pose": pose, "twist": [0.1, 0.2, -0.3], "acceleration": [1.0, 2.0, 3.0],
            "torques": [1.0, 2.0, 3.0, 4.0], "note": "ignored" })
    };
    let states = [state([0.02, -0.03, 0.1]), state([-0.05, 0.04, -0.2])];
    bench.write("states.json", &Value::from(states.to_vec()).to_string());
    bench
}

/// Flat values of a function at all states.
fn values(bench: &Bench, arguments: &[&str]) -> Vec<Vec<f64>> {
    let dualv = robot("dualv.toml");
    let name = arguments[0];
    let document = bench.json(&[&["evaluate", &dualv], arguments].concat());
    let row = |result: &Value| {
        let (_, values) = result
            .as_object()
            .and_then(|o| o.iter().next())
            .expect(name);
        values.as_array().expect(name).iter().map(number).collect()
    };
    document["results"]
        .as_array()
        .expect(name)
        .iter()
        .map(row)
        .collect()
}

fn far(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.fold(0.0, |far, (a, b)| far.max((a - b).abs()))
}

#[test]
fn pose_joint_and_actuator_inputs_give_equal_results() {
    let bench = bench();
    let states = ["--states", "states.json"];
    let ask = |function: &str| values(&bench, &[&[function][..], &states].concat());
    let pose = ask("idm_red_platform");
    let joints = values(
        &bench,
        &[
            "idm_red_platform",
            "--from",
            "joints",
            "--states",
            "states.json",
        ],
    );
    assert!(far(&pose, &joints) < 1e-12);
    assert_eq!(ask("idm_red_platform_from_joints"), joints);

    let (q, v, a) = (
        ask("actuator_positions"),
        ask("joint_velocities"),
        ask("joint_accelerations"),
    );
    let actuated = |all: &[f64]| [all[0], all[3], all[6], all[9]];
    let states: Vec<Value> = (0..2)
        .map(|i| json!({ "actuators": q[i], "actuator_velocities": actuated(&v[i]), "actuator_accelerations": actuated(&a[i]) }))
        .collect();
    bench.write("actuators.json", &Value::from(states).to_string());
    let actuators = values(&bench, &["idm_red_platform", "--states", "actuators.json"]);
    assert!(far(&pose, &actuators) < 1e-10);
    // A function of the pose computes it from the actuators.
    let jacobian = values(&bench, &["inverse_jacobian", "--states", "actuators.json"]);
    assert!(far(&ask("inverse_jacobian"), &jacobian) < 1e-11);
}

#[test]
fn csv_states_give_the_results_of_json_states() {
    let bench = bench();
    let csv = "pose[0],pose[1],pose[2],torques[0],torques[1],torques[2],torques[3],note\n\
        0.02,-0.03,0.1,1,2,3,4,a\n-0.05,0.04,-0.2,1,2,3,4,\n";
    bench.write("states.csv", csv);
    let dualv = robot("dualv.toml");
    let run =
        |states: &str| bench.good(&["evaluate", &dualv, "project_platform", "--states", states]);
    let text = run("states.csv");
    assert_eq!(text, run("states.json"));
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some("project_platform[0],project_platform[1],project_platform[2]")
    );
    assert_eq!(lines.count(), 2);
    bench.good(&[
        "evaluate",
        &dualv,
        "joints",
        "--states",
        "states.csv",
        "-o",
        "joints.csv",
    ]);
    assert_eq!(bench.read("joints.csv").lines().count(), 3);
}

#[test]
fn columns_and_kept_actuators_are_selectable() {
    let bench = bench();
    let dualv = robot("dualv.toml");
    let common = [
        "evaluate",
        &dualv,
        "idm_red_actuators",
        "--states",
        "states.json",
    ];
    let document = bench.json(&[&common[..], &["--columns", "base"]].concat());
    assert_eq!(document["function"], "idm_red_actuators_base");
    assert_eq!(document["shapes"]["idm_red_actuators"], json!([3, 49]));
    assert_eq!(document["parameters"].as_array().map(Vec::len), Some(49));
    let ask = |kept: &str| {
        values(
            &bench,
            &[
                "idm_red_actuators",
                "--states",
                "states.json",
                "--kept",
                kept,
            ],
        )
    };
    let (all, other) = (ask("leg1,leg2,leg3"), ask("leg1,leg2,leg4"));
    assert!(far(&all, &values(&bench, &common[2..])) < 1e-12);
    assert!(far(&all, &other) > 1e-3);
    let text = bench.bad(&[&common[..], &["--kept", "leg1,leg2,leg9"]].concat());
    assert!(text.contains("there is no actuator `leg9`"), "{text}");
    assert!(
        bench
            .bad(&[&common[..], &["--kept", "leg1,leg2"]].concat())
            .contains("3 actuators")
    );
}

#[test]
fn invalid_states_are_rejected_without_output() {
    let bench = bench();
    let planar = robot("planar_3rrr.toml");
    let bad = |function: &str, states: &str| {
        bench.bad(&[
            "evaluate", &planar, function, "--states", states, "-o", "out.csv",
        ])
    };
    assert!(bad("idm_red_platfrm", "states.json").contains("did you mean `idm_red_platform`"));
    assert!(bad("joints", "none.json").contains("none.json"));
    let text = bad("inverse_dynamics", "states.json");
    assert!(
        text.contains("state 1 of 2: missing `parameters`; the state has ")
            && text.contains("`parameters` (")
            && text.contains("`--parameters FILE`"),
        "{text}"
    );
    bench.write("named.csv", "x,y,phi\n0,0,0\n");
    let text = bad("joints", "named.csv");
    assert!(
        text.contains("missing `pose`; the state has `phi`, `x`, `y`")
            && text.contains("the function takes `pose[0]` to `pose[2]`"),
        "{text}"
    );
    let text = bench.bad(&[
        "evaluate",
        &planar,
        "mass_matrix",
        "--states",
        "named.csv",
        "--parameters",
        "none.toml",
    ]);
    assert!(
        text.contains("`overact identify my.toml --parameters"),
        "{text}"
    );
    bench.write("few.csv", "twist[0]\n1\n");
    let text = bad("idm_red_platform", "few.csv");
    assert!(
        text.contains("missing `pose`, `twist`, `acceleration`") || text.contains("`twist` has 1"),
        "{text}"
    );
    bench.write("far.json", "[{\"pose\":[0,0,0]},{\"pose\":[3,0,0]}]");
    let text = bad("joints", "far.json");
    assert!(
        text.contains("state 2 of 2") && text.contains("out of reach of leg `leg"),
        "{text}"
    );
    bench.write("nan.csv", "pose[0],pose[1],pose[2]\n0,0,nan\n");
    let text = bad("joints", "nan.csv");
    assert!(
        text.contains("nan.csv:2") && text.contains("not a finite number"),
        "{text}"
    );
    bench.write("broken.json", "[{\"pose\":");
    assert!(bad("joints", "broken.json").contains("not JSON"));
    assert!(!bench.path("out.csv").exists());
}

#[test]
fn serial_robots_accept_joint_or_pose_names() {
    let bench = Bench::new();
    bench.write(
        "a.json",
        r#"[{"joints":[0.1],"joint_velocities":[2],"joint_accelerations":[3]}]"#,
    );
    bench.write("b.json", r#"{"pose":0.1,"twist":2,"acceleration":3}"#);
    let emps = robot("emps.toml");
    let run =
        |states: &str| bench.json(&["evaluate", &emps, "idm_red_platform", "--states", states]);
    let document = run("a.json");
    assert_eq!(document["results"], run("b.json")["results"]);
    assert_eq!(
        document["parameters"],
        json!(["m_1", "ia_1", "fv_1", "fs_1", "off_1"])
    );
    assert_eq!(
        document["results"][0]["idm_red_platform"],
        json!([3.0, 3.0, 2.0, 1.0, 1.0])
    );
}

#[test]
fn quaternions_are_normalised_and_zero_is_rejected() {
    let bench = Bench::new();
    let state = |q: [f64; 4]| json!({ "pose": [0.0, 0.0, 0.5, q[0], q[1], q[2], q[3]] });
    let states = [[0.8, 0.6, 0.0, 0.0], [0.08, 0.06, 0.0, 0.0]].map(state);
    bench.write("states.json", &Value::from(states.to_vec()).to_string());
    let platform = robot("spherical_4rrr.toml");
    let free = robot("hexapod.toml");
    let ask = |robot: &str| {
        let function = ["inverse_jacobian", "--states", "states.json"];
        bench.json(&[&["evaluate", robot], &function[..]].concat())["results"].clone()
    };
    let answers = ask(&free);
    assert_eq!(answers[0], answers[1]);

    let zero = json!([{ "pose": [0.0, 0.0, 0.0, 0.0] }]);
    bench.write("zero.json", &zero.to_string());
    let run = bench.run(&[
        "evaluate",
        &platform,
        "inverse_jacobian",
        "--states",
        "zero.json",
    ]);
    assert_eq!(run.code, Some(1), "{}", run.err);
    assert!(run.err.contains("quaternion"), "{}", run.err);
}

#[test]
fn singular_states_and_malformed_rows_are_rejected() {
    let bench = Bench::new();
    // The rods are in the plane of their joints, where the first angle of a joint is undetermined.
    bench.write("flat.json", r#"[{ "pose": [0, 0, 0, 1, 0, 0, 0] }]"#);
    let hexapod = robot("hexapod.toml");
    let message = bench.bad(&["evaluate", &hexapod, "joints", "--states", "flat.json"]);
    assert!(message.contains("leg `leg1` is singular here"), "{message}");
    let fast = r#"[{ "pose": [0, 0, 0], "twist": [1e200, 0, 0], "acceleration": [0, 0, 0] }]"#;
    bench.write("fast.json", fast);
    let dualv = robot("dualv.toml");
    let ask = ["evaluate", &dualv, "idm_red_platform", "--states"];
    let message = bench.bad(&[&ask[..], &["fast.json"]].concat());
    assert!(message.contains("is too large for a number"), "{message}");
    bench.write("more.csv", "pose[0],pose[1],pose[2]\n0,0,0\n0,0,0,1\n");
    let message = bench.bad(&["evaluate", &dualv, "joints", "--states", "more.csv"]);
    assert!(
        message.contains("more.csv:3") && message.contains("4 cells in a line, but 3 names"),
        "{message}"
    );
}
