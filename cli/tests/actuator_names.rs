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
fn what_is_printed_is_what_is_taken() {
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
fn a_name_that_means_no_actuator_is_refused_alike() {
    let written = bench("[\"leg1_1\", \"leg2\", \"leg3_1\"]");
    let said = written.bad(&["check", "my.toml"]);
    assert!(said.contains("there is no actuator `leg2`"), "{said}");
    let bench = bench("[\"leg1_1\", \"leg2_1\", \"leg3_1\"]");
    bench.write("states.csv", "pose[0],pose[1],pose[2]\n0,0,0\n");
    let function = [
        "evaluate",
        "my.toml",
        "inverse_jacobian",
        "--states",
        "states.csv",
    ];
    let said = bench.bad(&[&function[..], &["--kept", "leg1_1,leg2,leg3_1"]].concat());
    assert!(said.contains("there is no actuator `leg2`"), "{said}");
    assert!(said.contains("the actuators are leg1_1, leg1_2"), "{said}");
}
