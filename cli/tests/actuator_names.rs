//! Actuator names are the same in all commands and files.

mod common;

use common::{Bench, names};

/// A robot in which some legs have two motors and one has one.
fn bench(kept: &str) -> Bench {
    Bench::with("planar-3rrr", |text| {
        let text = text.replace("d = \"l_1\"", "d = \"l_1\"\nactuated = true");
        let own = "kept_actuators = [\"leg1\", \"leg2\", \"leg3\"]";
        assert!(text.contains(own));
        text.replace(own, &format!("kept_actuators = {kept}"))
    })
}

#[test]
fn printed_actuator_names_are_accepted_as_input() {
    let bench = bench("[\"leg1_1\", \"leg2_1\", \"leg3_2\"]");
    let document = bench.json(&["inspect", "my.toml", "--effort", "none"]);
    let all = names(&document["actuator_names"]);
    assert_eq!(
        all,
        ["leg1_1", "leg1_2", "leg2_1", "leg2_2", "leg3_1", "leg3_2"]
    );
    assert_eq!(
        names(&document["kept_actuators"]),
        ["leg1_1", "leg2_1", "leg3_2"]
    );
    let table = bench.good(&["inspect", "my.toml", "--effort", "none"]);
    assert!(table.contains("motor leg1_1"), "{table}");
    bench.write("states.csv", "pose[0],pose[1],pose[2]\n0,0,0\n");
    let evaluate = |kept: &str| {
        let function = [
            "evaluate",
            "my.toml",
            "inverse_jacobian",
            "--states",
            "states.csv",
        ];
        bench.good(&[&function[..], &["--kept", kept]].concat())
    };
    // The older spelling of descriptions has the same meaning.
    assert_eq!(
        evaluate("leg1_1,leg2_1,leg3_2"),
        evaluate("leg1.1,leg2.1,leg3.2")
    );
    let dotted = self::bench("[\"leg1.1\", \"leg2.1\", \"leg3.2\"]");
    let document = dotted.json(&["inspect", "my.toml", "--effort", "none"]);
    assert_eq!(
        names(&document["kept_actuators"]),
        ["leg1_1", "leg2_1", "leg3_2"]
    );
}

#[test]
fn unknown_actuator_names_get_the_same_error_in_all_commands() {
    let written = bench("[\"leg1_1\", \"leg2\", \"leg3_1\"]");
    let message = written.bad(&["check", "my.toml"]);
    assert!(message.contains("there is no actuator `leg2`"), "{message}");
    let bench = bench("[\"leg1_1\", \"leg2_1\", \"leg3_1\"]");
    bench.write("states.csv", "pose[0],pose[1],pose[2]\n0,0,0\n");
    let function = [
        "evaluate",
        "my.toml",
        "inverse_jacobian",
        "--states",
        "states.csv",
    ];
    let message = bench.bad(&[&function[..], &["--kept", "leg1_1,leg2,leg3_1"]].concat());
    assert!(message.contains("there is no actuator `leg2`"), "{message}");
    assert!(
        message.contains("the actuators are leg1_1, leg1_2"),
        "{message}"
    );
}
